"""A scene without a clock, from saved time to saved time by Taylor's method."""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from ._columns import by_columns
from ._overdamped import is_overdamped, overdamped
from ._series import STABLE, Method, Scene, State, for_tangents, order_for, taylor

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
    rtol: float,
    atol: float,
    stiff: bool,
    moving_times: bool,
) -> tuple[State, March]:
    """[`march`][] with derivatives of every mode and order; NaN where it did not arrive.

    `moving_times`: whether `ts`, too, may be differentiated.
    """

    def solve(tangents, scene, start, ts, most):
        most, options = most.astype(jnp.int32), {"stiff": stiff, "tangents": tangents}
        return march(scene, start, ts, most, rtol=rtol, atol=atol, **options)

    # With the parameters, as all that is traced must be, and so a floating number.
    most = max_steps.astype(ts.dtype)
    states, (reached, end) = with_derivatives(solve, scene, start, ts, most, moving_times)
    return State(*(jnp.where(reached, x, jnp.nan) for x in states)), end


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
        late = ts - lax.stop_gradient(ts)
        states = jax.vmap(partial(_later, scene))(states, late)
    return states, said


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
    *,
    rtol: float,
    atol: float,
    stiff: bool,
    tangents: bool = False,
) -> tuple[State, tuple[Bool[Array, " times"], March]]:
    """The states at `ts`, monotone away from 0, which of them were reached, and the end.

    `start` holds at 0.  Steps end on saved times.  `stiff`: whether the program has the
    overdamped motion in it; a lane takes it where its own β is large enough, once what
    relaxes like e^(−βt) is below a rounding.  `tangents`: whether steps are to be as short as
    those of perturbations, the motion's own being at rest perhaps.
    """
    full, slow = (
        kind(order, rtol, atol, for_tangents(order, rtol, atol) if tangents else STABLE)
        for kind, order in ((taylor, order_for(rtol, atol)), (overdamped, 8))
    )

    def to_next(at: March, t):
        if not stiff:
            at = until(full, scene, at, t, max_steps)
        else:
            relaxed = _relaxed(scene)
            target = jnp.where(t > 0, jnp.maximum(at.t, jnp.minimum(t, relaxed)), t)
            at = until(full, scene, at, target, max_steps)
            at = until(slow, scene, at, t, max_steps)
        return at, (at.state, at.going & (at.t == t))

    zero = jnp.zeros_like(ts[0])
    end, (states, reached) = lax.scan(
        to_next, March(zero, start, jnp.zeros((), jnp.int32), jnp.ones((), bool)), ts
    )
    return states, (reached, end)


def _relaxed(scene: Scene):
    """When v has become a function of θ, 2e-28 of the rest being left; never, if damped less."""
    return lax.stop_gradient(jnp.where(is_overdamped(scene), 64 / scene.beta, jnp.inf))


def until(
    method: Method, scene: Scene, at: March, target: Scalar, max_steps: Int[Array, ""] | int
) -> March:
    """Steps to `target`, unless `most` have been taken or one can't be."""
    direction = lax.stop_gradient(jnp.sign(target - at.t))

    def unfinished(at: March):
        return (at.t != target) & at.going & (at.steps < max_steps)

    def step(at: March):
        h = direction * method.size(scene, at.state)
        last = ~(jnp.abs(h) < jnp.abs(target - at.t))
        after = jnp.where(last, target, at.t + h)
        # The step that is made is the difference of the times as they are rounded.
        state = method.step(scene, at.state, after - at.t)
        fine = jnp.isfinite(state.theta) & jnp.isfinite(state.v) & (after != at.t)
        return March(after, state, at.steps + 1, fine & ~jnp.isnan(h))

    return lax.while_loop(unfinished, step, at)


_COUNTABLE = 2**31 - 128  # in int32, and a float32


def budget(scene: Scene, start: State, ts) -> Int[Array, "*lanes"]:
    """Many times the steps that the scene can need: a bound on its rates times the span."""
    span = jnp.max(jnp.abs(ts))
    fastest = jnp.abs(start.v) + 2 * jnp.sqrt(scene.epsilon)
    beta = 0.0 if scene.beta is None else scene.beta
    if scene.tau is not None:
        # τ accelerates until the damping, or the end, stops it.
        fastest = fastest + jnp.abs(scene.tau) * jnp.minimum(span, 1 / jnp.maximum(beta, 1 / span))
    rate = jnp.sqrt(scene.epsilon) + fastest + beta
    most = 1000 + 4 * ts.size + 20 * span * rate
    return jnp.minimum(most, _COUNTABLE).astype(jnp.int32)
