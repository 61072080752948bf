"""The amplitude less its half turns, with sine and cosine."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from ._elementary import sin_cos

FloatArray = Float[Array, "..."]

# π/2 in three parts (Cody and Waite): multiples of the first two up to 2^20 (float32: 2^13)
# are exact, and what is left of φ has its digits however near it comes to 0.
_PARTS = {
    "float64": (1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21),
    "float32": (1.5703125, 0.0004837512969970703, 7.549789954891882e-08),
}


@jax.custom_jvp
def reduced(phi: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(turns, s, c): φ = turns π + r, |r| ≤ π/2, s = sin r, c = cos r ≥ 0.

    c comes from the distance to the quarter turn, which keeps its digits beside it.  Beyond
    2^52 no digit is left, and s and c are any sine and cosine.
    """
    quarters = jnp.round(phi * (2 / jnp.pi))
    rest = phi
    for part in _PARTS[phi.dtype.name]:
        rest = rest - quarters * part
    sin, cos = sin_cos(jnp.clip(rest, -1, 1))
    turned = quarters - 2 * jnp.floor(0.5 * quarters) != 0
    side = jnp.where(rest < 0, 1, -1)  # where the nearest quarter turn is, seen from 0
    turns = 0.5 * jnp.where(turned, quarters - side, quarters)
    return turns, jnp.where(turned, side * cos, sin), jnp.where(turned, jnp.abs(sin), cos)


@reduced.defjvp
def _reduced_jvp(primals, tangents):
    turns, s, c = reduced(*primals)
    return (turns, s, c), (jnp.zeros_like(turns), c * tangents[0], -s * tangents[0])
