"""Where fates change: the starts that end on a saddle, as values of the torque or the damping.

Whether a saddle is passed is monotone in the torque and in the damping, so halving finds
where it turns, to the last digits.  Its derivatives are those of

    g = v − W(y)

at a time shortly before, y being the distance to the saddle there and W(y) the velocity that
ends on it, its stable manifold, as a series.  g = 0 on the boundary, and g is smooth where
the fate is not.
"""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, ArrayLike, Bool, Float

from .._arrays import common, whole
from .._pendulum import Pendulum
from ..taylor import Scene, State, marched, no_tangent, polynomial
from ._follow import CAPTURED, GOING, RUNNING, follow, is_captured
from ._implicit import implicit
from ._retrapping import retrapping
from ._saddle import before, saddle, stable, well_of
from ._scene import require_damped
from ._settle import fate

FloatArray = Float[Array, "..."]
Scalar = Float[Array, ""]

_HALVINGS = 60
_MOST = 100_000  # steps
_LARGEST = 1e8  # of β/√ε, and the reciprocal of the smallest


class Start(NamedTuple):
    """All that decides a fate, of ε = 1."""

    beta: Scalar
    tau: Scalar
    v0: Scalar
    theta0: Scalar


class Boundary(NamedTuple):
    """The value of τ or β, if there is one, and when its motion is close to which well's end."""

    value: Scalar
    exists: Bool[Array, ""]
    t: Scalar
    well: Scalar


def critical_torque(pendulum: Pendulum, v0: ArrayLike, theta0: ArrayLike = 0.0) -> FloatArray:
    """The torque at which the motion from (θ0, v0) turns from captured to running.

    **Arguments:** the `pendulum`, with damping and a constant torque or none, whose value is not
    used.  `v0`, rad/s, and `theta0`, rad; shapes broadcast.

    **Returns:** τ_c, 1/s², from [`retrapping_torque`][] to ε: τ_r for starts that pass the first
    saddle there, else the torque at which they end on it; ε where nothing runs below.  A
    start against the torque, v0 < 0, may turn more than once: one of the values.  For
    negative torques it is −τ_c of (−θ0, −v0).

    **Raises:** `ValueError` for β = `None` or 0 and for τ a function of time.  NaN, and under a
    transformation β ≤ 0 and ε ≤ 0, give NaN in their own lane.

    **Accuracy:** 1e-12 ε; derivatives 1e-9, in every mode and order, by the implicit function
    theorem.  Suzuki & Suzuki §8.2.
    """
    require_damped(pendulum, "its critical torque", positive=True)
    lanes = common(epsilon=pendulum.epsilon, beta=pendulum.beta, v0=v0, theta0=theta0)
    return _critical(*lanes)


def well_boundaries(
    pendulum: Pendulum, v0: ArrayLike, theta0: ArrayLike = 0.0, *, over: str, count: int
) -> FloatArray:
    """The torques, or the dampings, at which the motion from (θ0, v0) changes wells.

    **Arguments:**

    - `pendulum`, with damping and a constant torque or none; the value it has of `over` is not
      used.
    - `v0`, rad/s, and `theta0`, rad; shapes broadcast, with the leaves of the pendulum.
    - `over`: "tau" or "beta"; `count`: how many.

    **Returns:** shape of the lanes followed by `count`.  `[…, k]` is where the start ends on the
    saddle between well n + k and the next in the direction of v0, n being the well of θ0: just
    beside it, it passes that saddle or stays.  With v0 ≥ 0 torques grow with k, towards
    τ_r, geometrically, so that some twelve differ from it in float64; dampings fall with k.
    NaN where there is none, |τ| ≤ ε and 1e-8 ≤ β/√ε ≤ 1e8 being searched, or because past the
    first saddle it runs for ever.

    **Raises:** `ValueError` for β = `None` or 0, τ a function of time, another `over`, `count` < 1.

    **Accuracy:** 1e-12 ε for torques, 1e-12 relative for dampings, times what the motion on the
    way magnifies; derivatives 1e-9, in every mode and order, by the implicit function theorem.
    Suzuki & Suzuki §7.2, §8.2.
    """
    if over not in ("tau", "beta"):
        raise ValueError(f'Argument `over` must be "tau" or "beta", but got {over!r}.')
    require_damped(pendulum, "its wells", positive=over == "tau")
    count = whole("count", count, 1)
    tau = 0.0 if pendulum.tau is None or over == "tau" else pendulum.tau
    beta = 1.0 if over == "beta" else pendulum.beta
    lanes = common(epsilon=pendulum.epsilon, beta=beta, tau=tau, v0=v0, theta0=theta0)
    return _wells(over, count, *lanes)


@jax.jit
def _critical(epsilon: FloatArray, beta: FloatArray, v0: FloatArray, theta0: FloatArray):
    def one(beta, v0, theta0):
        edge = retrapping(beta)
        # Where there is no hysteresis, another scene.
        safe = jnp.where(edge < 1, beta, 1)
        start = Start(safe, jnp.ones_like(beta), v0, theta0)
        above = lax.stop_gradient(retrapping(safe)) * (1 + 8 * jnp.finfo(beta.dtype).eps)
        found = _boundary("tau", None, start, above, jnp.ones_like(beta))
        always = _passes(lax.stop_gradient(start._replace(tau=above)), None)
        inside = jnp.where(found.exists, found.value, 1)
        return jnp.where((edge < 1) & ~always, inside, edge)

    return _of_unit(one, epsilon, 2, (beta, v0, theta0))


@partial(jax.jit, static_argnums=(0, 1))
def _wells(over: str, count: int, epsilon, beta, tau, v0, theta0):
    def one(beta, tau, v0, theta0):
        forward = jnp.where(v0 < 0, -1, 1).astype(v0.dtype)
        start = Start(beta, forward * tau, forward * v0, forward * theta0)
        first = lax.stop_gradient(jnp.round(start.theta0 / (2 * jnp.pi)))
        wells = first + jnp.arange(count, dtype=v0.dtype)
        ends = jnp.ones_like(v0), jnp.ones_like(v0)
        ends = (-ends[0], ends[1]) if over == "tau" else (_LARGEST * ends[0], ends[1] / _LARGEST)
        found = jax.vmap(lambda well: _boundary(over, well, start, *ends))(wells)
        # What runs has no wells left to change between.
        scene = (beta, found.value) if over == "tau" else (found.value, start.tau)
        runs = scene[1] > retrapping(scene[0]) * (1 + 1e-9)
        past = runs & (jnp.arange(count) > 0) | (jnp.abs(scene[1]) > 1)
        value = jnp.where(found.exists & ~past, found.value, jnp.nan)
        return forward * value if over == "tau" else value

    power = 2 if over == "tau" else 1
    return _of_unit(one, epsilon, power, (beta, tau, v0, theta0))


def _of_unit(one: Callable, epsilon: FloatArray, power: int, lanes) -> FloatArray:
    """`one` lane of ε = 1, for all of them; β first, then τ if there is one, v0 and θ0."""
    fine = (epsilon > 0) & (epsilon < jnp.inf) & (lanes[0] > 0)
    for x in lanes:
        fine = fine & jnp.isfinite(x)
    root = jnp.sqrt(jnp.where(fine, epsilon, 1))
    units = [root, root * root, root, jnp.ones_like(root)][-len(lanes) :]
    units[0] = root
    safe = [jnp.where(fine, x / unit, 1) for x, unit in zip(lanes, units, strict=True)]
    found = jax.vmap(one)(*(x.ravel() for x in safe))
    found = found.reshape(epsilon.shape + found.shape[1:])
    # A factor, for the derivatives.
    factor = jnp.where(fine, root**power, jnp.nan)
    return factor.reshape(factor.shape + (1,) * (found.ndim - factor.ndim)) * found


def _boundary(over: str, well: Scalar | None, start: Start, low: Scalar, high: Scalar) -> Boundary:
    """Between `low`, which must not pass the end of `well`, and `high`, which must.

    Without a `well`, running is asked for.
    """

    def at(p: Start, value):
        return p._replace(**{over: value})

    def find(p):
        p, well, low, high = p

        def halve(_, ends):
            low, high = ends
            middle = 0.5 * (low + high) if over == "tau" else jnp.sqrt(low * high)
            passes = _passes(at(p, middle), well)
            return jnp.where(passes, low, middle), jnp.where(passes, middle, high)

        exists = ~_passes(at(p, low), well) & _passes(at(p, high), well)
        _, value = lax.fori_loop(0, _HALVINGS, halve, (low, high))
        return Boundary(value, exists, *_approach(at(p, value), well))

    def change(found: Boundary, p, dp):
        def off(value, p):
            return _off(at(p, value), found.t, found.well)

        value, zero = found.value, jnp.zeros_like(found.value)
        _, slope = jax.jvp(lambda value: off(value, p[0]), (value,), (jnp.ones_like(value),))
        _, moved = jax.jvp(partial(off, value), (p[0],), (dp[0],))
        moved = -moved / jnp.where(found.exists, slope, 1)
        moved = jnp.where(found.exists, moved, 0)
        return Boundary(moved, no_tangent(found.exists), zero, zero)

    return implicit(find, change, (start, well, low, high))


def _passes(start: Start, well: Scalar | None) -> Bool[Array, ""]:
    """Whether the end of `well` is passed at the first go, v0 ≥ 0; without one, whether it runs."""
    beta, tau, v0, theta0 = start
    scene, at, begin = Scene(jnp.ones_like(beta), beta, tau), saddle(tau), State(theta0, v0)
    if well is None:
        return fate(beta, tau, begin, _MOST, _rtol(tau))[0] == RUNNING

    def end_of(_, state: State):
        failed = (state.v < 0) | is_captured(scene, at, state)
        passed = before(at, state.theta, well) <= 0
        return jnp.where(passed, RUNNING, jnp.where(failed, CAPTURED, GOING))

    return follow(scene, begin, end_of, end_of(begin, begin), _MOST, _rtol(tau)).end == RUNNING


def _approach(start: Start, well: Scalar | None) -> tuple[Scalar, Scalar]:
    """When the motion is first within reach of W before the end of `well`, or of any."""
    beta, tau, v0, theta0 = start
    scene, at, begin = Scene(jnp.ones_like(beta), beta, tau), saddle(tau), State(theta0, v0)
    slopes = stable(at, beta)
    reach = jnp.minimum(0.3, 0.1 * slopes[0] / jnp.maximum(jnp.abs(slopes[1]), 1e-9))

    def which(state):
        return well_of(at, state.theta) if well is None else well

    def end_of(_, state: State):
        y = before(at, state.theta, which(state))
        return jnp.where((y <= reach) & (state.v >= 0), CAPTURED, GOING)

    found = follow(scene, begin, end_of, end_of(begin, begin), _MOST, _rtol(tau))
    return found.t, which(found.state)


def _off(start: Start, t: Scalar, well: Scalar) -> Scalar:
    """g: how much faster it is at `t` than what ends on the saddle."""
    beta, tau, v0, theta0 = start
    scene, at = Scene(jnp.ones_like(beta), beta, tau), saddle(tau)
    options = {"rtol": _rtol(tau), "atol": _rtol(tau), "stiff": False, "moving_times": False}
    states, _ = marched(scene, State(theta0, v0), t[None], jnp.asarray(_MOST), **options)
    y = before(at, states.theta[0], well)
    return states.v[0] - y * polynomial(stable(at, beta), y)


def _rtol(x: Scalar) -> float:
    return float(jnp.finfo(x.dtype).eps) ** 0.9
