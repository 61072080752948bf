"""A scene without a clock, from saved time to saved time by Taylor's method."""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from .._torque import SampledTorque
from . import _switched as switched
from ._analytic import Analytic
from ._columns import by_columns
from ._overdamped import is_overdamped, overdamped
from ._series import Scene, State, largest, since
from ._step import STABLE, Method, for_tangents, order_for, taylor
from ._switched import Stretch, is_switched, momentary

Scalar = Float[Array, ""]


class March(NamedTuple):
    """Where a march has come, and how."""

    t: Scalar
    state: State
    steps: Int[Array, ""] | int = 0
    going: Bool[Array, ""] | bool = True  # not once a number was not finite, or a step too short


def marched(
    scene: Scene,
    start: State,
    ts: Float[Array, " times"],
    max_steps: Int[Array, ""],
    *,
    t0: Scalar | None = None,
    rtol: float,
    atol: float,
    stiff: bool,
    moving_times: bool,
    moving_start: bool = False,
) -> tuple[State, March | Stretch]:
    """[`march`][] with derivatives of every mode and order; NaN where it did not arrive.

    `moving_times`: whether `ts`, too, may be differentiated.  `t0`: when `start` holds, for a
    scene that has a clock; `moving_start`: whether it may be differentiated.
    """
    t0 = jnp.zeros_like(ts[0]) if t0 is None else t0
    if moving_start:
        # On from t0 to where it is held fixed: at a saved time there no step would move with it.
        fixed = lax.stop_gradient(t0)
        start, t0 = _moved(scene, start, t0, fixed - t0), fixed

    def solve(tangents, scene, start, ts, extra):
        most, options = extra[0].astype(jnp.int32), {"stiff": stiff, "tangents": tangents}
        return march(scene, start, ts, most, extra[1], rtol=rtol, atol=atol, **options)

    # With the parameters, as all that is traced must be, and so a floating number.
    extra = max_steps.astype(ts.dtype), t0
    states, (reached, end) = with_derivatives(solve, scene, start, ts, extra, moving_times)
    # A factor, that derivatives are NaN as well.
    return State(*(x * jnp.where(reached, 1, jnp.nan) for x in states)), end


def with_derivatives(
    solve: Callable, scene: Scene, start: State, ts, extra, moving_times: bool
) -> tuple[State, Any]:
    """States of `solve(tangents, scene, start, ts, extra)` and what else it says.

    In every mode and order; `tangents`: whether it is being differentiated.
    """
    leaves, treedef = jax.tree.flatten((scene, start, lax.stop_gradient(ts), extra))
    value, careful = (
        partial(lambda tangents, p: solve(tangents, *jax.tree.unflatten(treedef, p)), tangents)
        for tangents in (False, True)
    )
    states, said = by_columns(value, leaves, careful)
    if moving_times:
        fixed = lax.stop_gradient(ts)
        states = jax.vmap(partial(_moved, scene))(states, fixed, ts - fixed)
    return states, said


def _moved(scene: Scene, state: State, at: Scalar, late: Scalar) -> State:
    """A state that holds at `at`, a time later that is zero but for its derivatives."""
    if is_switched(scene):
        # The line through τ there; along it the time moves by `late` alone, or it counts twice.
        scene, moving = momentary(scene, at, state)
        late = moving * late
    return _later(since(scene, at), state, late)


@jax.custom_jvp
def _later(scene: Scene, state: State, h: Scalar) -> State:
    """The state after an h that is zero, whose derivatives are not."""
    return state


@_later.defjvp
def _(primals, tangents):
    step = taylor(_LATER, 1.0, 1.0).step
    return _later(*primals), jax.jvp(step, primals, tangents)[1]


_LATER = 6  # derivatives in the time are right up to this order


def march(
    scene: Scene,
    start: State,
    ts: Float[Array, " times"],
    max_steps: Int[Array, ""],
    t0: Scalar,
    *,
    rtol: float,
    atol: float,
    stiff: bool,
    tangents: bool = False,
) -> tuple[State, tuple[Bool[Array, " times"], March | Stretch]]:
    """The states at `ts`, monotone away from `t0`, which of them were reached, and the end.

    `start` holds at `t0`.  Steps end on saved times.  `stiff`: whether the program has the
    overdamped motion in it; a lane takes it where its own β is large enough, once what
    relaxes like e^(−βt) is below a rounding.  `tangents`: whether steps are to be as short as
    those of perturbations, the motion's own being at rest perhaps.
    """
    on: Callable
    begin: Callable
    most, longest, on, begin = (14 if tangents else 20), STABLE, until, _begun
    if is_switched(scene):
        # A step has room for one turning point, where roundings show, and lines are mostly short.
        longest, on, begin = 1.0, switched.until, switched.begun
        most = 10 if isinstance(scene.tau, SampledTorque) else 12 if tangents else 16
    order = order_for(rtol, atol, most)
    least = min(rtol, atol) if tangents else None
    of_full, of_slow = (
        min(longest, for_tangents(n, rtol, atol)) if tangents else longest for n in (order, 8)
    )
    full = taylor(order, rtol, atol, of_full, least)
    slow = overdamped(8, rtol, atol, of_slow)

    def to_next(at: Any, t):
        if not stiff:
            at = on(full, scene, at, t, max_steps)
        else:
            relaxed = t0 + _relaxed(scene)
            target = jnp.where(t > t0, jnp.maximum(at.t, jnp.minimum(t, relaxed)), t)
            at = on(full, scene, at, target, max_steps)
            at = on(slow, scene, at, t, max_steps)
        return at, (at.state, at.going & (at.t == t))

    end, (states, reached) = lax.scan(to_next, begin(scene, start, t0), ts)
    return states, (reached, end)


def _begun(scene: Scene, start: State, t0: Scalar) -> March:
    return March(t0, start, jnp.zeros((), jnp.int32), jnp.ones((), bool))


def _relaxed(scene: Scene):
    """When v has become a function of θ, 2e-28 of the rest being left; never, if damped less.

    Where it turns on its way, it begins once more.
    """
    long = 64 if scene.dry is None else 128
    return lax.stop_gradient(jnp.where(is_overdamped(scene), long / scene.beta, jnp.inf))


def until(
    method: Method, scene: Scene, at: March, target: Scalar, max_steps: Int[Array, ""] | int
) -> March:
    """Steps to `target`, unless `most` have been taken or one can't be."""
    direction = lax.stop_gradient(jnp.sign(target - at.t))

    def unfinished(at: March):
        return (at.t != target) & at.going & (at.steps < max_steps)

    def step(at: March):
        now = since(scene, at.t)
        known = method.series(now, at.state)
        h = direction * method.size(now, at.state, known)
        last = ~(jnp.abs(h) < jnp.abs(target - at.t))
        after = jnp.where(last, target, at.t + h)
        # The step that is made is the difference of the times as they are rounded.
        state = method.step(now, at.state, after - at.t, known)
        fine = jnp.isfinite(state.theta) & jnp.isfinite(state.v) & (after != at.t)
        return March(after, state, at.steps + 1, fine & ~jnp.isnan(h))

    return lax.while_loop(unfinished, step, at)


_COUNTABLE = 2**31 - 128  # in int32, and a float32


def budget(scene: Scene, start: State, ts) -> Int[Array, "*lanes"]:
    """Many times the steps that the scene can need: a bound on its rates times the span.

    `ts` count from when `start` holds.  Backwards, damping makes v grow like e^(β|t|).
    """
    span = jnp.max(jnp.abs(ts))
    fastest = jnp.abs(start.v) + 2 * jnp.sqrt(scene.epsilon)
    beta = 0.0 if scene.beta is None else scene.beta
    most = 1000 + 4 * ts.size
    if scene.tau is not None:
        # τ accelerates until the damping, or the end, stops it.
        longest = jnp.minimum(span, 1 / jnp.maximum(beta, 1 / span))
        fastest = fastest + _most(scene.tau, ts) * longest
    if isinstance(scene.tau, Analytic):
        fastest = fastest + scene.tau.quickness()
    if isinstance(scene.tau, SampledTorque):
        most = most + 2 * scene.tau.ts.size
    grown = beta * jnp.max(-ts)
    grows = grown > 0
    fastest = fastest * jnp.where(grows, jnp.expm1(grown) / jnp.where(grows, grown, 1), 1)
    rate = jnp.sqrt(scene.epsilon) + fastest + beta
    most = most + 20 * span * rate
    return jnp.fmin(most, _COUNTABLE).astype(jnp.int32)


def _most(tau: Any, ts) -> Float[Array, "*lanes"]:
    """The most that |τ| is; of a function of time, twice what is met in a look at some."""
    if not isinstance(tau, Analytic):
        return largest(tau)
    # Uneven, or all of them might be its zeros; the ends are two of them.
    part = np.append(np.arange(16) * (0.5 * np.sqrt(5) - 0.5) % 1, 1)
    some = jnp.asarray(part, ts.dtype) * ts[jnp.argmax(jnp.abs(ts))]
    return 2 * jnp.max(jnp.abs(jax.vmap(tau)(tau.clock + some)))
