"""The parameter, as m or as m1 = 1 - m."""

from collections.abc import Callable
from typing import Any

from jaxtyping import ArrayLike

from .._arrays import aligned, widened


def with_parameter(
    kernel: Callable, m: ArrayLike | None, m1: ArrayLike | None, **others: ArrayLike
) -> Any:
    """kernel(*others, m, m1) of arrays of one dtype and rank, exactly one of the last two given.

    The one that is given is exact, and the other is 1 less it, rounded.
    """
    if (m is None) == (m1 is None):
        raise ValueError(
            "Arguments `m` and `m1` must be given one without the other, but got "
            + ("neither." if m is None else "both.")
        )
    arrays = aligned(**others, **({"m": m} if m1 is None else {"m1": m1}))

    def call(*arrays):
        *before, given = arrays
        return kernel(*before, *((given, 1 - given) if m1 is None else (1 - given, given)))

    return widened(call)(*arrays)
