"""What a state (θ, v) is worth: energies, the phase curve, the tension of the rod."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from ._arrays import common, require, widened
from ._gap import half_angle, rise_and_gap
from ._pendulum import Pendulum, require_free

FloatArray = Float[Array, "..."]


def energy(pendulum: Pendulum, theta: ArrayLike, v: ArrayLike) -> FloatArray:
    """½ v² + ε (1 − cos θ), per unit of m l², 1/s²; damping and torque are not in it.

    `theta` in rad, `v` in rad/s; shapes broadcast.
    """
    theta, v, epsilon = common(theta=theta, v=v, epsilon=pendulum.epsilon)
    return widened(lambda v, *x: 0.5 * v * v + _potential(*x))(v, theta, epsilon)


def potential(pendulum: Pendulum, theta: ArrayLike) -> FloatArray:
    """ε (1 − cos θ), per unit of m l², 1/s²; the torque is not in it.

    `theta` in rad; shapes broadcast.  Computed as 2 ε sin²(θ/2): 1 − cos θ loses the
    digits of a small θ.  Suzuki & Suzuki §1.2.
    """
    return widened(_potential)(*common(theta=theta, epsilon=pendulum.epsilon))


def _potential(theta: FloatArray, epsilon: FloatArray) -> FloatArray:
    sin = half_angle(theta).sin
    return 2 * epsilon * sin * sin


def velocity(pendulum: Pendulum, theta: ArrayLike, energy: ArrayLike) -> FloatArray:
    """The phase curve v(θ; E) = √(2 (E − ε (1 − cos θ))) ≥ 0, rad/s.

    **Arguments:** `theta`, rad; `energy` E as [`energy`][] gives it, 1/s².  Shapes
    broadcast.  The separatrix is E = 2ε, where v = 2√ε |cos(θ/2)|.

    **Returns:** v; the other half of the curve is −v.  NaN (value and gradient) where the
    energy does not reach; 0 with an infinite derivative at a turning point.

    The root is taken of 2E − 4ε + 4ε cos²(θ/2) where that cancels less.  Suzuki & Suzuki
    §1.3; the Spanish source's (3.1), whose box has its outer root too far.
    """
    arrays = common(theta=theta, energy=energy, epsilon=pendulum.epsilon)
    return widened(_velocity)(*arrays)


def _velocity(theta: FloatArray, energy: FloatArray, epsilon: FloatArray) -> FloatArray:
    sin, cos, _ = half_angle(theta)
    four = 4 * epsilon
    low = 2 * energy - four * sin * sin
    high = (2 * energy - four) + four * cos * cos
    return jnp.sqrt(jnp.where(cos < jnp.abs(sin), high, low))


def tension(
    pendulum: Pendulum, theta: ArrayLike, v: ArrayLike, mass: ArrayLike, length: ArrayLike
) -> FloatArray:
    """Tension of the rod N = m (l v² + g cos θ), g = ε l, in newtons.

    **Arguments:** `theta`, rad; `v`, rad/s; `mass` m, kg; `length` l, m.  Shapes broadcast.

    **Returns:** N, negative where the rod pushes: there a string would be slack, from
    [`slack_angle`][] on.

    **Raises:** `ValueError` for m or l ≤ 0.  The Spanish source's §1.1 (radial equation).
    """
    for name, x in (("mass", mass), ("length", length)):
        require(name, x, "positive", lambda x: (x > 0) & np.isfinite(x))
    theta, v, epsilon, mass, length = common(
        theta=theta, v=v, epsilon=pendulum.epsilon, mass=mass, length=length
    )
    sin, cos, _ = widened(half_angle)(theta)
    return mass * length * (v * v + epsilon * (cos - sin) * (cos + sin))


def slack_angle(pendulum: Pendulum, v0: ArrayLike, theta0: ArrayLike = 0.0) -> FloatArray:
    """The angle from the bottom at which a string would go slack, rad.

    **Arguments:** as for [`frequency`][]: the undamped, untorqued motion through (θ0, v0).

    **Returns:** θ in (π/2, π), where v² + ε cos θ = 0; NaN if a string stays tight, for
    E = ½v² + ε (1 − cos θ) up to ε and from 5ε/2 on.

    cos θ = ⅔ (1 − E/ε), taken as θ = 2 atan2(√(ε + 2E), √(5ε − 2E)).
    """
    require_free(pendulum, "the angle at which a string goes slack")
    arrays = common(epsilon=pendulum.epsilon, v0=v0, theta0=theta0)
    return widened(_slack_angle)(*arrays)


def _slack_angle(epsilon: FloatArray, v0: FloatArray, theta0: FloatArray) -> FloatArray:
    rise, gap = rise_and_gap(epsilon, v0, theta0)
    top = epsilon + gap  # 5ε − 2E, from the side on which it vanishes
    slack = (rise > 2 * epsilon) & (top > 0)
    inside = jnp.where(slack, 1, jnp.nan)  # as a factor, for the derivatives
    top, bottom = jnp.sqrt(inside * top), jnp.sqrt(inside * (epsilon + rise))
    return 2 * jnp.arctan2(bottom, top)
