"""Where a polynomial first comes down to zero: the end of a motion in one direction."""

from typing import Any

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

Scalar = Float[Array, ""]

_DIPS = 6  # Newton steps to the bottom of a dip
_ROOTS = 8  # and to a zero: the next step of a march begins nearer to what is not found


def first_zero(coefficients: list[Any], end: Scalar) -> tuple[Scalar, Bool[Array, ""]]:
    """(x, whether it is a zero): the first in (0, end], else how far there is certainly none.

    Coefficients in rising powers of x, positive to the right of 0.  No more than one minimum lies
    within: it is looked for where the polynomial falls at 0 and rises at `end`.  A zero that
    Newton's steps don't reach, next to a minimum, is left to be found from a nearer start.

    All is elementwise and of a fixed length: it becomes one loop with the series before it.
    """
    slopes = [n * x for n, x in enumerate(coefficients)][1:]
    last, slope = _with_slope(coefficients, end)
    dips = (last > 0) & (slopes[0] < 0) & (slope > 0)
    x, low, high = 0.5 * end, jnp.zeros_like(end), end
    for _ in range(_DIPS):
        slope, bend = _with_slope(slopes, x)
        low, high = jnp.where(slope <= 0, x, low), jnp.where(slope > 0, x, high)
        x = _within(x - slope / bend, low, high)
    bottom = _with_slope(coefficients, x)[0]
    right = jnp.where(dips, x, end)
    there = jnp.where(dips, bottom, last) <= 0

    low, high = jnp.zeros_like(end), right
    # From 0, where it is positive whatever its rounding says.
    x = _within(-coefficients[0] / jnp.where(slopes[0] < 0, slopes[0], jnp.nan), low, high)
    before = x
    for _ in range(_ROOTS):
        value, slope = _with_slope(coefficients, x)
        low, high = jnp.where(value > 0, x, low), jnp.where(value > 0, high, x)
        before, x = x, _within(x - value / slope, low, high)
    sure = jnp.abs(x - before) <= 32 * jnp.finfo(end.dtype).eps * end
    found = there & (sure | (low == 0))
    return jnp.where(found, x, jnp.where(there, low, end)), found


def _within(x, low, high):
    """x, or the middle where it is not between them (or not a number)."""
    return jnp.where((x >= low) & (x <= high), x, 0.5 * (low + high))


def _with_slope(coefficients, x):
    value, slope = coefficients[-1], jnp.zeros_like(x)
    for a in coefficients[-2::-1]:
        slope = slope * x + value
        value = value * x + a
    return value, slope
