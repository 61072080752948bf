"""When an angle is reached: the inverse of the undamped, untorqued motion."""

from functools import partial

import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, ArrayLike, Float

from ._arrays import common, widened
from ._exact import angular_frequency
from ._gap import gap_of, half_angle, hypotenuse
from ._motion import motion
from ._pendulum import Pendulum, require_free
from .special._arcsn import inverse

FloatArray = Float[Array, "..."]


def time_to(
    pendulum: Pendulum, theta: ArrayLike, v0: ArrayLike, theta0: ArrayLike = 0.0
) -> FloatArray:
    """The first time t ≥ 0 at which the motion through (θ0, v0) reaches the angle θ, s.

    **Arguments:** the undamped, untorqued `pendulum`; `theta`, rad, unwrapped, so that in
    a rotation θ0 + 2π n is n turns away; `v0`, rad/s, and `theta0`, rad, at t = 0.  Shapes
    broadcast.

    **Returns:** t; NaN for an angle that is never reached.  Within a few roundings of the
    turning point θ counts as reached.  The derivatives are those of the implicit
    function, infinite at a turning point.

    **Raises:** `ValueError` for a scene with damping or torque.

    √ε t = F(φ | m) − F(φ0 | m), sin φ = sin(θ/2)/k, is the Spanish source's (3.6) from any
    start; φ enters with its cosine θ̇/(2√ε k), which keeps its digits near turning points.
    """
    require_free(pendulum, "the time to an angle")
    arrays = common(epsilon=pendulum.epsilon, theta=theta, v0=v0, theta0=theta0)
    return widened(_time_to)(*arrays)


@jax.custom_jvp
def _time_to(
    epsilon: FloatArray, theta: FloatArray, v0: FloatArray, theta0: FloatArray
) -> FloatArray:
    return _value(epsilon, theta, v0, theta0)


@partial(_time_to.defjvp, symbolic_zeros=True)
def _time_to_jvp(primals, tangents):
    # From θ(t(θ, …); …) = θ.
    epsilon, _, v0, theta0 = primals
    t = _time_to(*primals)
    full = [
        jnp.zeros_like(x) if isinstance(dx, SymbolicZero) else dx
        for x, dx in zip(primals, tangents, strict=True)
    ]
    at, moved = jax.jvp(
        motion, (epsilon, t, v0, theta0), (full[0], jnp.zeros_like(t), full[2], full[3])
    )
    return t, (full[1] - moved.theta) / at.v


@jax.jit
def _value(
    epsilon: FloatArray, theta: FloatArray, v0: FloatArray, theta0: FloatArray
) -> FloatArray:
    root = jnp.sqrt(jnp.where(epsilon > 0, epsilon, jnp.nan))
    s0, c0, well0 = half_angle(theta0)
    s1, c1, well1 = half_angle(theta)
    m1 = gap_of(4 * epsilon, v0, s0, c0) / (4 * epsilon)
    w0 = v0 / (2 * root)
    k = hypotenuse(w0, s0)
    # In the mirror, if need be, the motion starts upwards.
    up = jnp.where(v0 == 0, s0 <= 0, v0 > 0)
    side = jnp.where(up, 1, -1).astype(w0.dtype)
    s0, s1, w0, turns = side * s0, side * s1, jnp.abs(w0), side * (well1 - well0)
    ahead = side * (theta - theta0)

    # W² = C² − m1 near the top; elsewhere from that of the start, which m1 forgets when small.
    high = c1 < jnp.abs(s1)
    square = jnp.where(high, c1 * c1 - m1, w0 * w0 - (s1 - s0) * (s1 + s0))
    rounding = jnp.where(high, c1, jnp.abs(s1) * k + w0 * w0)
    rounding = 8 * jnp.finfo(k.dtype).eps * rounding
    w1 = jnp.sqrt(jnp.maximum(square, 0))
    rests = k == 0
    size = jnp.where(rests, 1, k)
    first, last = (
        inverse(jnp.clip(s / size, -1, 1), (w / size) ** 2, c * c)
        for s, w, c in ((s0, w0, c0), (s1, w1, c1))
    )
    omega = angular_frequency(epsilon, v0, theta0) / root
    half_swing = jnp.pi / omega  # 2K; in rotation half the time of a turn

    swing = jnp.where(ahead >= 0, last - first, half_swing - last - first)
    swing = jnp.where((turns == 0) & (square >= -rounding), swing, jnp.nan)
    turn = jnp.where(ahead >= 0, last - first + 2 * half_swing * turns, jnp.nan)
    u = jnp.where(m1 < 0, turn, jnp.where(rests, jnp.nan, swing))
    u = jnp.where(ahead == 0, 0, jnp.maximum(u, 0))
    return jnp.where(jnp.isinf(u), jnp.nan, u) / root
