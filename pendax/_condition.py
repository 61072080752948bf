"""How much a trajectory magnifies what is changed on its way."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from ._arrays import common
from ._pendulum import Pendulum
from ._recorded import with_record
from ._simulate import require_monotone, simulate


def condition(
    pendulum: Pendulum,
    ts: ArrayLike,
    v0: ArrayLike,
    theta0: ArrayLike = 0.0,
    *,
    t0: ArrayLike = 0.0,
    **options: Any,
) -> Float[Array, "*lanes_and_times"]:
    """κ(t), the largest norm of ∂(θ, v/√ε)(t) / ∂(θ, v/√ε)(s) over s from t0 to t.

    A change of 1e-12 rad somewhere on the way, be it a rounding or a solver's error, is one of
    some κ · 1e-12 rad at t: κ is about 1 for a damped fall into a well, grows like t for a swing,
    and by many powers of ten where a start grazes the separatrix or the motion is chaotic.  A
    trajectory is lost where κ reaches the reciprocal of its tolerance.

    **Arguments:** as those of [`simulate`][], `options` too, a solver's `rtol` for example;
    `ts` one axis of times in s, monotone away from `t0`.  s runs over `t0` and `ts`: ten times
    a period see every peak.

    **Returns:** the 2-norm, of the shape of the lanes followed by that of `ts`; NaN from where
    on `simulate` has NaN.

    **Raises:** what `simulate` raises for its arguments.  Time and memory grow with the square
    and the first power of the number of times.
    """
    (ts,) = common(ts=ts)
    if ts.ndim > 1:
        raise ValueError(f"Argument `ts` must have one axis at most, but got shape {ts.shape}.")
    require_monotone(ts, t0)
    start, *_ = common(v0=v0, theta0=theta0, t0=t0, epsilon=pendulum.epsilon)
    pendulum = with_record(pendulum, jnp.result_type(ts, start))
    return _condition(pendulum, ts, v0, theta0, t0, options)


@eqx.filter_jit
def _condition(pendulum, ts, v0, theta0, t0, options):
    options = {"throw": False} | options
    times = jnp.atleast_1d(ts)
    epsilon, v0, theta0, t0 = common(
        epsilon=pendulum.epsilon, v0=v0, theta0=theta0, t0=t0 + 0 * times[0]
    )
    run = simulate(pendulum, times, v0, theta0, t0=t0, **options)
    lanes = jnp.broadcast_to(v0, run.theta.shape[:-1])
    root = jnp.sqrt(epsilon)

    def before(first, states):
        return jnp.moveaxis(
            jnp.concatenate([(first + 0 * lanes)[..., None], states[..., :-1]], -1), -1, 0
        )

    def between(since, until, theta, v):
        """The fundamental matrix from one time to the next."""

        def flow(theta, w):
            run = simulate(pendulum, until, w * root, theta, t0=since, **options)
            return jnp.stack([run.theta, run.v / root])

        def along(direction):
            change = direction[0] + 0 * lanes, direction[1] + 0 * lanes
            return jax.jvp(flow, (theta, v / root), change)[1]

        return jax.vmap(along, out_axes=-1)(jnp.eye(2, dtype=times.dtype))

    each = times.reshape((1,) * lanes.ndim + times.shape)
    starts = before(t0, each + 0 * lanes[..., None])
    matrices = jax.vmap(between)(
        starts, times, before(theta0, run.theta), before(v0, run.v)
    )  # times, 2, *lanes, 2
    matrices = jnp.moveaxis(matrices, 1, -2)

    def onwards(products, i):
        unit = jnp.eye(2, dtype=times.dtype)
        products = products.at[i].set(jnp.broadcast_to(unit, products[0].shape))
        products = jnp.einsum("...ab,n...bc->n...ac", matrices[i], products)
        return products, jnp.maximum(jnp.max(_norm(products), 0), 1)  # s = t among them

    nothing = jnp.zeros_like(matrices)
    _, kappa = jax.lax.scan(onwards, nothing, jnp.arange(times.size))
    return jnp.moveaxis(kappa, 0, -1).reshape(lanes.shape + ts.shape)


def _norm(matrix: Float[Array, "*lanes 2 2"]) -> Float[Array, "*lanes"]:
    """The larger singular value."""
    a, b, c, d = (matrix[..., i, j] for i in range(2) for j in range(2))
    return 0.5 * (jnp.hypot(a + d, b - c) + jnp.hypot(a - d, b + c))
