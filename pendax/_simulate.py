"""One door to a trajectory."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from ._arrays import aligned, common, widened
from ._motion import motion
from ._pendulum import Pendulum, require_free
from ._results import Result, where


class Trajectory(eqx.Module):
    """θ(t) and θ̇(t) at given times.

    `ts` has the times, of any shape; `theta` and `v` have the shape of the lanes
    followed by that of `ts`; `result` has the shape of the lanes.  θ is unwrapped.
    """

    ts: Float[Array, "*times"]
    theta: Float[Array, "*lanes_and_times"]
    v: Float[Array, "*lanes_and_times"]
    result: Result


def simulate(
    pendulum: Pendulum,
    ts: ArrayLike,
    v0: ArrayLike,
    theta0: ArrayLike = 0.0,
    *,
    t0: ArrayLike = 0.0,
) -> Trajectory:
    """The motion through (θ0, v0) at time `t0`, in closed form.

    **Arguments:**

    - `pendulum`: the scene, undamped and untorqued; ε in 1/s².
    - `ts`: times, s, in any order and of either sign.
    - `v0`, `theta0`: angular velocity, rad/s, and angle, rad, at `t0`, s.

    The leaves of the scene, `v0`, `theta0` and `t0` broadcast; times that differ from
    lane to lane come through `jax.vmap`.

    **Returns:** a [`Trajectory`][], libration, rotation and the separatrix alike.
    There is no solver in the compiled program, and no kink anywhere: θ and v are
    analytic functions of all arguments, and so are their derivatives of every order.

    **Raises:** `ValueError` for a scene with damping or torque.  NaN and ε ≤ 0 under a
    transformation give NaN in their own lane, and its `result` says so.

    Suzuki & Suzuki §2.3, §3.1.  From θ0 = 0 within 16 eps of |θ| plus the effect of one
    eps in each argument, for |v0 − 2√ε| down to the last float.
    """
    require_free(pendulum, "its motion in closed form")
    (ts,) = common(ts=ts)
    times, epsilon, v0, theta0, t0 = _lanes(ts, pendulum.epsilon, v0, theta0, t0)
    theta, v = widened(motion)(epsilon, times - t0, v0, theta0)
    lanes = tuple(range(theta.ndim - ts.ndim, theta.ndim))
    bad = ~jnp.all(jnp.isfinite(theta) & jnp.isfinite(v), axis=lanes)
    return Trajectory(ts, theta, v, where(bad, Result.not_a_number, Result.successful))


def _lanes(ts: Float[Array, "..."], *lanes: ArrayLike) -> list[Float[Array, "..."]]:
    """`ts` behind the axes of the lanes, all of one rank and dtype.

    They are not broadcast: what depends on the lane alone is computed once for all times.
    """
    names = ("epsilon", "v0", "theta0", "t0")
    lane = common(**dict(zip(names, lanes, strict=True)))
    shape = lane[0].shape + (1,) * ts.ndim
    behind = [jnp.reshape(x, shape) for x in lane]
    times = jnp.reshape(ts, (1,) * lane[0].ndim + ts.shape)
    return aligned(ts=times, **dict(zip(names, behind, strict=True)))
