"""The two numbers that vanish where the motion changes kind,

    rise = v0² + 4ε sin²(θ0/2) = 4ε m     twice the energy; 0 at rest at the bottom
    gap  = 4ε cos²(θ0/2) − v0² = 4ε m1    0 on the separatrix, negative in rotation

formed without cancellation, from the floats as given.  m = sin²(θ_max/2) in libration;
m1 = 1 − m is never computed as such.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from ._arrays import difference_of_products
from .special._elementary import QUARTER, less_quarters, power_of_two, sin_cos
from .special._steps import parity

FloatArray = Float[Array, "..."]


class HalfAngle(NamedTuple):
    """Sine and cosine of θ/2 − nπ, cosine >= 0, and n: the number of the well."""

    sin: FloatArray
    cos: FloatArray
    well: FloatArray


@jax.custom_jvp
def half_angle(theta: FloatArray) -> HalfAngle:
    """To the last digit of the float as given, θ near odd multiples of π included.

    Up to |θ| of 10⁶ (float32: 10³); beyond, to one eps of θ.
    """
    quarters, rest = less_quarters(0.5 * theta)
    sin, cos = sin_cos(rest)
    odd = parity(quarters) < 0
    side = jnp.where(rest < 0, -1, 1)
    return HalfAngle(
        jnp.where(odd, -side * cos, sin),
        jnp.where(odd, jnp.abs(sin), cos),
        0.5 * (quarters + jnp.where(odd, side, 0)),
    )


def turned_by(turns: FloatArray, half: FloatArray) -> FloatArray:
    """`half` + π `turns`, rounded once up to 10⁶ turns (float32: 10³): an energy computed
    from a rotation's angle knows no more of it than its last digit."""
    first, *parts = (2 * part for part in QUARTER[jnp.dtype(half.dtype).name])
    return turns * first + (turns * sum(parts) + half)


@half_angle.defjvp
def _half_angle_jvp(primals, tangents):
    at = half_angle(*primals)
    slopes = 0.5 * at.cos * tangents[0], -0.5 * at.sin * tangents[0]
    return at, HalfAngle(*slopes, jnp.zeros_like(at.well))


def rise_and_gap(
    epsilon: FloatArray, v0: FloatArray, theta0: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """v0² + 4ε sin²(θ0/2) and 4ε cos²(θ0/2) − v0²."""
    sin, cos, _ = half_angle(theta0)
    four = 4 * epsilon
    return v0 * v0 + four * sin * sin, gap_of(four, v0, sin, cos)


@jax.custom_jvp
def gap_of(four: FloatArray, v0: FloatArray, sin: FloatArray, cos: FloatArray) -> FloatArray:
    """four cos² − v0², sin² + cos² = 1, to the last digit for these floats as given: from
    the bottom for those of the caller; elsewhere cos is a rounding off that of θ0.

    v0² is an error-free product: right also where √ε is no float, and
    (2√ε − v0)(2√ε + v0) would put the separatrix one float off.  cos² is used where it
    is the smaller of the two, else 1 − sin²: each loses nothing near its own zero.
    """
    bottom = difference_of_products(four, None, v0, v0) - four * sin * sin
    top = difference_of_products(four * cos, cos, v0, v0)
    return jnp.where(cos * cos < sin * sin, top, bottom)


@gap_of.defjvp
def _gap_jvp(primals, tangents):
    # Differentiating `bottom` would send an infinite slope at gap = 0 through sin * sin.
    four, v0, sin, cos = primals
    d_four, d_v0, _, d_cos = tangents
    slope = cos * cos * d_four + 2 * four * cos * d_cos - 2 * v0 * d_v0
    return gap_of(four, v0, sin, cos), slope


@jax.custom_jvp
def hypotenuse(x: FloatArray, y: FloatArray) -> FloatArray:
    """√(x² + y²) without over- or underflow; its derivative at 0, where it has a kink, is 0."""
    large = jnp.maximum(jnp.abs(x), jnp.abs(y))
    at_zero = large == 0
    quotient = jnp.minimum(jnp.abs(x), jnp.abs(y)) / jnp.where(at_zero, 1, large)
    return large * jnp.sqrt(1 + quotient * quotient)


@hypotenuse.defjvp
def _hypotenuse_jvp(primals, tangents):
    (x, y), (dx, dy) = primals, tangents
    size = hypotenuse(x, y)
    divisor = jnp.where(size == 0, 1, size)
    return size, (x / divisor) * dx + (y / divisor) * dy


def scaled(epsilon: FloatArray, v0: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(unit, ε/unit², v0/unit), unit a power of two near the larger of √ε and |v0|.

    Exact, and neither v0² nor a product of two velocities can then over- or underflow.
    """
    speed = jnp.maximum(jnp.sqrt(epsilon), jnp.abs(v0))
    _, exponent = jnp.frexp(lax.stop_gradient(speed))
    limit = jnp.finfo(v0.dtype).maxexp - 24  # both 2^±limit are normal numbers
    exponent = jnp.clip(exponent, -limit, limit)
    unit, inverse = (power_of_two(n, v0.dtype) for n in (exponent, -exponent))
    return unit, epsilon * inverse * inverse, v0 * inverse
