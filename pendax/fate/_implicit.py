"""What is solved for, with derivatives of every mode and order by the implicit function theorem."""

from collections.abc import Callable
from typing import Any

import jax
from jax import lax


def implicit(find: Callable[[Any], Any], change: Callable[[Any, Any, Any], Any], p: Any) -> Any:
    """x = find(p), whose tangent is `change(x, p, dp)`, linear in dp; `p` holds all that is traced.

    `change` may be differentiated in turn, and x in it is this function again.
    """

    @jax.custom_jvp
    def value(p):
        return lax.stop_gradient(find(p))

    @value.defjvp
    def _(primals, tangents):
        (p,), (dp,) = primals, tangents
        x = implicit(find, change, p)
        return x, change(x, p, dp)

    return value(p)
