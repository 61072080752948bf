"""A torque that is a function of time, as JAX records it: operations, and numbers as leaves.

What a function reads from closures, globals and attributes may be another number at the next call,
or may be traced.  Programs that are kept for the function itself would go on with the old number,
and derivatives by what it hides would be lost, both without a word.  So it is recorded at each
call, and records that read alike are equal: they share a program, though the functions be new.
"""

from collections.abc import Callable
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jax.extend.core import ClosedJaxpr, jaxpr_as_fun
from jaxtyping import Array, Float, Shaped

from ._arrays import NUMBERS
from ._pendulum import Pendulum
from ._reading import Operations
from ._torque import SampledTorque


class Recorded(eqx.Module):
    """τ(t) of one time."""

    numbers: list[Shaped[Array, "..."]]  # real, complex ones in two: derivatives are by numbers
    operations: Operations = eqx.field(static=True)

    def __call__(self, t: Float[Array, ""]) -> Float[Array, ""]:
        jaxpr, numbers = self.operations.jaxpr, iter(self.numbers)
        given = [
            lax.complex(next(numbers), next(numbers)) if _is_complex(_dtype(var)) else next(numbers)
            for var in (*jaxpr.constvars, *jaxpr.invars[:-1])
        ]
        count = len(jaxpr.constvars)
        run = jaxpr_as_fun(ClosedJaxpr(jaxpr, given[:count]))
        (tau,) = run(*given[count:], jnp.asarray(t, self.dtype))
        return jnp.asarray(tau)  # a constant is a literal

    @property
    def dtype(self) -> Any:
        (result,) = self.operations.jaxpr.outvars
        return _dtype(result)


def with_record(pendulum: Pendulum, dtype: Any) -> Pendulum:
    """The scene with its τ(t), if it has one, recorded: before any program that is kept."""
    tau = pendulum.tau
    if not callable(tau) or isinstance(tau, SampledTorque):
        return pendulum
    return eqx.tree_at(lambda p: p.tau, pendulum, recorded(tau, dtype))


def recorded(tau: Callable, dtype: Any) -> Recorded:
    """`tau` of a time of this `dtype`.

    **Raises:** `ValueError` where it isn't one real number as a function of one time.
    """
    if isinstance(tau, Recorded) and tau.dtype == dtype:
        return tau
    leaves, rest = eqx.partition(tau, eqx.is_array)
    leaves, treedef = jax.tree.flatten(leaves)

    def number(leaves, t):
        return _number(eqx.combine(jax.tree.unflatten(treedef, leaves), rest)(t), dtype)

    try:
        closed = jax.make_jaxpr(number)(leaves, jnp.zeros((), dtype))
    except jax.errors.JAXTypeError as error:
        raise ValueError(
            "Argument `tau` must be a function that JAX can trace: of jnp.sin, jnp.where and the "
            "like, not of NumPy's or math's functions, nor of an `if` on t."
        ) from error
    numbers = [part for x in (*closed.consts, *leaves) for part in _real(jnp.asarray(x))]
    return Recorded(numbers, Operations(closed.jaxpr, rest))


def _number(found: Any, dtype: Any) -> Array:
    if not isinstance(found, NUMBERS):
        raise ValueError(f"Argument `tau` must return one real number, but got {_named(found)}.")
    found = jnp.asarray(found)
    if found.shape:
        raise ValueError(
            f"Argument `tau` must return one real number, but got shape {found.shape}. Lanes, each "
            "with a torque of its own, come through `jax.vmap`."
        )
    if _is_complex(found.dtype):
        raise ValueError(
            f"Argument `tau` must return one real number, but got {found.dtype}; jnp.real(…) is."
        )
    return found.astype(dtype)


def _named(found: Any) -> str:
    return "None" if found is None else f"a {type(found).__name__}"


def _dtype(atom: Any) -> Any:
    return atom.aval.dtype


def _is_complex(dtype: Any) -> bool:
    return jnp.issubdtype(dtype, jnp.complexfloating)


def _real(x: Array) -> list[Array]:
    return [lax.real(x), lax.imag(x)] if _is_complex(x.dtype) else [x]
