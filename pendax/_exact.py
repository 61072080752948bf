"""Frequency, period and amplitude of the undamped, untorqued pendulum in closed form."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from ._arrays import common, widened
from ._gap import gap_of, half_angle, hypotenuse, rise_and_gap, scaled
from ._pendulum import Pendulum, require_free
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
    for θ0 = 0, else 8 eps of |ω| + Σ |x ∂ω/∂x|, a rounding of θ0 included.  On the
    separatrix itself the derivative is −inf towards v0 (the limit from the librating
    side), and second derivatives are not finite.
    Suzuki & Suzuki §2.6, §3.2; DLMF 19.8.5.
    """
    require_free(pendulum, "its frequency")
    arrays = common(epsilon=pendulum.epsilon, v0=v0, theta0=theta0)
    return widened(angular_frequency)(*arrays)


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
def angular_frequency(epsilon: FloatArray, v0: FloatArray, theta0: FloatArray) -> FloatArray:
    unit, epsilon, v0 = scaled(jnp.where(epsilon > 0, epsilon, jnp.nan), v0)
    rise, gap = rise_and_gap(epsilon, v0, theta0)
    rotates = gap < 0
    first = jnp.sqrt(jnp.where(rotates, rise, 4 * epsilon))
    mean = _agm_sqrt(first, jnp.where(rotates, -gap, gap))
    return jnp.where(rotates, mean, 0.5 * mean) * unit


@jax.jit
def _amplitude(epsilon: FloatArray, v0: FloatArray, theta0: FloatArray) -> FloatArray:
    _, epsilon, v0 = scaled(jnp.where(epsilon > 0, epsilon, jnp.nan), v0)
    sin, cos, _ = half_angle(theta0)
    gap = gap_of(4 * epsilon, v0, sin, cos)
    up = hypotenuse(v0, 2 * jnp.sqrt(epsilon) * sin)
    rotates = gap < 0
    return jnp.where(rotates, jnp.inf, 2 * jnp.arctan2(up, jnp.sqrt(jnp.where(rotates, 1, gap))))


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
