"""The undamped, untorqued pendulum in closed form.

Everything here depends on two numbers that vanish where the motion changes kind,

    rise = v0² + 4ε sin²(θ0/2) = 4ε m     twice the energy; 0 at rest at the bottom
    gap  = 4ε cos²(θ0/2) − v0² = 4ε m1    0 on the separatrix, negative in rotation

so they are formed without cancellation, from the floats as given.  m = sin²(θ_max/2)
in libration; m1 = 1 − m is never computed as such.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, ArrayLike, Float

from ._arrays import common, difference_of_products, widened
from ._pendulum import Pendulum, require_free
from .special import ellipj
from .special._agm import agm

FloatArray = Float[Array, "..."]


def frequency(pendulum: Pendulum, v0: ArrayLike, theta0: ArrayLike = 0.0) -> FloatArray:
    """Angular frequency ω = 2π/T of the motion through (θ0, v0), rad/s.

    **Arguments:** the undamped, untorqued `pendulum`; `v0` = θ̇(0), rad/s, either sign;
    `theta0`, rad.  Shapes broadcast.

    **Returns:** ω = π√ε / (2 K(m)) in libration, π√ε / (κ K(κ²)), κ² = 1/m, in
    rotation, where T is the time for 2π; 0 on the separatrix; √ε at rest.

    **Raises:** `ValueError` for a scene with damping or torque.  ε ≤ 0 under a
    transformation gives NaN.

    Computed as AGM(2√ε, √gap) / 2 and AGM(√rise, √−gap), which are those formulas
    without K, gap = 4ε cos²(θ0/2) − v0² with an error-free v0².  Within 4 eps relative
    for θ0 = 0.  On the separatrix itself the derivative is −inf towards v0 (the limit
    from the librating side), and second derivatives are not finite.
    Suzuki & Suzuki §2.6, §3.2; DLMF 19.8.5.
    """
    require_free(pendulum, "its frequency")
    arrays = common(epsilon=pendulum.epsilon, v0=v0, theta0=theta0)
    return widened(_frequency)(*arrays)


def period(pendulum: Pendulum, v0: ArrayLike, theta0: ArrayLike = 0.0) -> FloatArray:
    """Period T = 2π/ω, s: a full swing in libration, one turn in rotation.

    Arguments, errors and accuracy as for [`frequency`][]; inf on the separatrix.
    """
    return 2 * jnp.pi / frequency(pendulum, v0, theta0)


def amplitude(pendulum: Pendulum, v0: ArrayLike, theta0: ArrayLike = 0.0) -> FloatArray:
    """Largest angle from the bottom of the well, θ_max = 2 arcsin √m, rad.

    Arguments and errors as for [`frequency`][].  π on the separatrix, where the
    derivative is infinite; inf in rotation.  At rest it is 0, and the derivative, which
    jumps there, is taken as 0.  Computed as 2 atan2(√rise, √gap), which keeps its digits
    near π.  Suzuki & Suzuki §2.8 (its blue line is v0/√ε, not 2 v0/√ε).
    """
    require_free(pendulum, "its amplitude")
    arrays = common(epsilon=pendulum.epsilon, v0=v0, theta0=theta0)
    return widened(_amplitude)(*arrays)


@jax.jit
def _frequency(epsilon: FloatArray, v0: FloatArray, theta0: FloatArray) -> FloatArray:
    unit, epsilon, v0 = _scaled(jnp.where(epsilon > 0, epsilon, jnp.nan), v0)
    rise, gap = rise_and_gap(epsilon, v0, theta0)
    rotates = gap < 0
    first = jnp.sqrt(jnp.where(rotates, rise, 4 * epsilon))
    mean = _agm_sqrt(first, jnp.where(rotates, -gap, gap))
    return jnp.where(rotates, mean, 0.5 * mean) * unit


@jax.jit
def _amplitude(epsilon: FloatArray, v0: FloatArray, theta0: FloatArray) -> FloatArray:
    _, epsilon, v0 = _scaled(jnp.where(epsilon > 0, epsilon, jnp.nan), v0)
    rise, gap = rise_and_gap(epsilon, v0, theta0)
    rest, rotates = rise == 0, gap < 0
    up = jnp.where(rest, 0, jnp.sqrt(jnp.where(rest, 1, rise)))
    angle = 2 * jnp.arctan2(up, jnp.sqrt(jnp.where(rotates, 1, gap)))
    return jnp.where(rotates, jnp.inf, angle)


def rise_and_gap(
    epsilon: FloatArray, v0: FloatArray, theta0: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """v0² + 4ε sin²(θ0/2) and 4ε cos²(θ0/2) − v0²."""
    sin, cos = jnp.sin(0.5 * theta0), jnp.cos(0.5 * theta0)
    four = 4 * epsilon
    return v0 * v0 + four * sin * sin, _gap(four, v0, sin, cos)


@jax.custom_jvp
def _gap(four: FloatArray, v0: FloatArray, sin: FloatArray, cos: FloatArray) -> FloatArray:
    """four cos² − v0², sin² + cos² = 1, to the last digit of the floats as given.

    v0² is an error-free product: right also where √ε is no float, and
    (2√ε − v0)(2√ε + v0) would put the separatrix one float off.  cos² is used where it
    is the smaller of the two, else 1 − sin²: each loses nothing near its own zero.
    """
    bottom = difference_of_products(four, jnp.ones_like(v0), v0, v0) - four * sin * sin
    top = difference_of_products(four * cos, cos, v0, v0)
    return jnp.where(cos * cos < sin * sin, top, bottom)


@_gap.defjvp
def _gap_jvp(primals, tangents):
    # Differentiating `bottom` would send an infinite slope at gap = 0 through sin * sin.
    four, v0, sin, cos = primals
    d_four, d_v0, _, d_cos = tangents
    slope = cos * cos * d_four + 2 * four * cos * d_cos - 2 * v0 * d_v0
    return _gap(four, v0, sin, cos), slope


def _scaled(epsilon: FloatArray, v0: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(unit, ε/unit², v0/unit), unit a power of two near the larger of √ε and |v0|.

    Exact, and neither v0² nor a product of two velocities can then over- or underflow.
    """
    speed = jnp.maximum(jnp.sqrt(epsilon), jnp.abs(v0))
    _, exponent = jnp.frexp(lax.stop_gradient(speed))
    limit = jnp.finfo(v0.dtype).maxexp - 24  # both 2^±limit are normal numbers
    exponent = jnp.clip(exponent, -limit, limit)
    one = jnp.ones_like(v0)
    unit, inverse = jnp.ldexp(one, exponent), jnp.ldexp(one, -exponent)
    return unit, epsilon * inverse * inverse, v0 * inverse


@jax.custom_jvp
def _agm_sqrt(a: FloatArray, square: FloatArray) -> FloatArray:
    """AGM(a, √square) for a > 0, square ≥ 0; 0 at square = 0."""
    empty = square == 0
    return jnp.where(empty, 0 * a, agm(a, jnp.sqrt(jnp.where(empty, a * a, square))))


@_agm_sqrt.defjvp
def _agm_sqrt_jvp(primals, tangents):
    # Away from square = 0 these are the derivatives of the mean.  At 0 the one in
    # `square` is infinite; the iteration would make it 0 * inf.
    a, square = primals
    empty = square == 0
    b = jnp.sqrt(jnp.where(empty, a * a, square))
    _, in_a = jax.jvp(agm, (a, b), (jnp.ones_like(a), jnp.zeros_like(b)))
    _, in_b = jax.jvp(agm, (a, b), (jnp.zeros_like(a), jnp.ones_like(b)))
    slope_a = jnp.where(empty, 0, in_a)
    slope_square = jnp.where(empty, jnp.inf, 0.5 * in_b / b)
    return _agm_sqrt(a, square), slope_a * tangents[0] + slope_square * tangents[1]


class Motion(NamedTuple):
    theta: FloatArray
    v: FloatArray


@jax.jit
def motion(epsilon: FloatArray, t: FloatArray, v0: FloatArray, theta0: FloatArray) -> Motion:
    """θ (unwrapped) and θ̇ a time t after (θ0, v0); arguments of one rank and dtype.

    S = sin(θ/2), C = cos(θ/2), W = θ̇/(2√ε) of the motion that passes the bottom at
    t = 0 with the same energy are k sn, dn, k cn of (√ε t | m), m = k² of any size.
    The addition theorem (DLMF 22.8.1) composes it with the initial S0, C0, W0; no
    incomplete integral is needed.  In rotation sn, cn, dn are those of the reciprocal
    parameter, whose amplitude counts the turns (Suzuki & Suzuki §2.3, §3.1).
    """
    epsilon = jnp.where(epsilon > 0, epsilon, jnp.nan)
    root = jnp.sqrt(epsilon)
    rise, gap = rise_and_gap(epsilon, v0, theta0)
    rotates = gap < 0
    safe_rise = jnp.where(rotates, rise, 4 * epsilon)
    k = jnp.sqrt(safe_rise) / (2 * root)
    m1 = gap / jnp.where(rotates, safe_rise, 4 * epsilon)
    u = root * t * k  # k is 1 where the pendulum librates
    x, y, z, ph = ellipj(u, m1=jnp.where(rotates, -m1, m1))
    s, c, d = jnp.where(rotates, x / k, x), jnp.where(rotates, z, y), jnp.where(rotates, y, z)

    # The angle from the well it starts in: there C0 >= 0.
    well = 2 * jnp.pi * lax.stop_gradient(jnp.round(theta0 / (2 * jnp.pi)))
    start = theta0 - well
    s0, c0, w0 = jnp.sin(0.5 * start), jnp.cos(0.5 * start), v0 / (2 * root)
    unit = c * c + (s * c0) ** 2  # = 1 - s^2 s0^2, without its subtraction
    sin = (s * w0 * c0 + s0 * c * d) / unit
    cos = (d * c0 - s * c * s0 * w0) / unit
    w = (c * w0 - s * d * s0 * c0) / unit

    # From the bottom, a rotation has turned by 2 ph; it never differs from the true
    # angle by as much as the half turn that would miscount.
    angle = 2 * jnp.arctan2(sin, cos)
    turned = start + 2 * jnp.where(v0 < 0, -1, 1).astype(ph.dtype) * ph
    turns = jnp.round((turned - angle) / (4 * jnp.pi))
    turns = jnp.where(rotates, lax.stop_gradient(turns), 0)
    return Motion(well + (angle + 4 * jnp.pi * turns), 2 * root * w)
