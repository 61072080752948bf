"""Dry friction and recorded torques: smooth motions, joined where their equation changes.

The friction c against the motion is a constant torque as long as v keeps its sign, which is
`way`: from one turning point to the next the equation is that of a torque τ − c·way.  Where v
comes to nothing, the force f = τ − ε sin θ decides: |f| ≤ c holds the pendulum (`way` 0) until
a torque that changes lets go of it; else it goes on in the direction of f.  A recorded torque is
a straight line between its samples, and no step goes over one.

Steps are held fixed when they are differentiated, but for those that end at a turning point:
its time is where v(t; p) = 0, by Newton's steps that are differentiated.  A smoothed sign of v
was rejected: it creeps where it should hold, its steps are as small as what it is smoothed over,
and its derivatives know nothing of the switching.

Filippov, Differential Equations with Discontinuous Righthand Sides (1988), §10; Müller, J. Appl.
Math. Mech. 59 (1995) 1079, for derivatives through the switching.
"""

from typing import Any, NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from .._torque import SampledTorque
from ..special._elementary import sin_cos_of_any
from ._series import Ramp, Scene, State
from ._step import Method

Scalar = Float[Array, ""]


class Stretch(NamedTuple):
    """Where a motion has come: at rest, or going one `way`, on one line of a recorded torque."""

    t: Scalar
    state: State
    way: Scalar
    line: Int[Array, ""]
    steps: Int[Array, ""]
    going: Bool[Array, ""]  # not once a number was not finite, or nothing moved on


def is_switched(scene: Scene) -> bool:
    return scene.dry is not None or isinstance(scene.tau, SampledTorque)


def begun(scene: Scene, start: State, t0: Scalar) -> Stretch:
    line = jnp.zeros((), jnp.int32)
    going = jnp.ones((), bool)
    if isinstance(scene.tau, SampledTorque):
        line, going = scene.tau.piece(t0), t0 >= scene.tau.ts[0]
    way = way_of(scene, start, _torque(scene, line, t0)[0])
    return Stretch(t0, start, way, line, jnp.zeros((), jnp.int32), going)


def way_of(scene: Scene, state: State, tau: Any) -> Scalar:
    """The sign of v; of what is at rest that of v to come, 0 where friction holds it."""
    moving = lax.stop_gradient(jnp.sign(state.v))
    if scene.dry is None:
        return moving
    force, held = _force(scene, state.theta, tau)
    return jnp.where(state.v == 0, jnp.where(jnp.abs(force) > held, jnp.sign(force), 0), moving)


def _force(scene: Scene, theta: Scalar, tau: Any) -> tuple[Scalar, Scalar]:
    """τ − ε sin θ, and the most that friction holds.

    A rounding more: what has come to the edge, or begins on it, stays, and what is let go of has
    an acceleration.
    """
    weight = scene.epsilon * sin_cos_of_any(theta)[0]
    rounding = 8 * jnp.finfo(theta.dtype).eps * (jnp.abs(tau) + jnp.abs(weight) + scene.dry)
    return lax.stop_gradient((tau - weight, scene.dry + rounding))


def momentary(scene: Scene, t: Scalar, state: State) -> tuple[Scene, Scalar]:
    """The smooth equation that holds at a time, and 1, or 0 where friction holds the pendulum."""
    line = scene.tau.piece(t) if isinstance(scene.tau, SampledTorque) else None
    tau, slope = _torque(scene, line, t)
    if scene.dry is None:
        return _smooth(scene, tau, slope, None), jnp.ones_like(t)
    way = way_of(scene, state, tau)
    return _smooth(scene, tau, slope, way), jnp.abs(way)


def until(
    method: Method, scene: Scene, at: Stretch, target: Scalar, max_steps: Int[Array, ""]
) -> Stretch:
    """On to `target`, unless `max_steps` have been taken or one can't be."""

    def unfinished(at: Stretch):
        return (at.t < target) & at.going & (at.steps < max_steps)

    return lax.while_loop(unfinished, lambda at: advanced(method, scene, at, target), at)


def advanced(method: Method, scene: Scene, at: Stretch, target: Scalar) -> Stretch:
    """A step: to `target`, the end of a line, a turning point or a release at most."""
    line = at.line
    knot = scene.tau.ts[line + 1] if isinstance(scene.tau, SampledTorque) else target
    end = jnp.minimum(target, knot)
    tau, slope = _torque(scene, at.line, at.t)
    if scene.dry is None:
        after, state = _free(method, _smooth(scene, tau, slope, None), at, end)
        way = at.way
    else:
        after, state, way = _rubbing(method, scene, tau, slope, at, end)
    if isinstance(scene.tau, SampledTorque):
        line = jnp.where((after >= knot) & (at.line + 2 < scene.tau.ts.size), line + 1, line)
    # Nothing is lost where only the way has changed, or the line.
    moved = (after > at.t) | (way != at.way) | (line != at.line)
    fine = jnp.isfinite(state.theta) & jnp.isfinite(state.v) & moved
    return Stretch(after, state, way, line, at.steps + 1, fine)


def _free(method: Method, scene: Scene, at: Stretch, end: Scalar):
    known = method.series(scene, at.state)
    after = at.t + method.size(scene, at.state, known)
    after = jnp.where(after < end, after, end)
    return after, method.step(scene, at.state, after - at.t, known)


def _rubbing(method: Method, scene: Scene, tau, slope, at: Stretch, end: Scalar):
    smooth = _smooth(scene, tau, slope, at.way)
    h = method.turn(smooth, at.state, at.way, end - at.t)
    after = at.t + jnp.abs(h)
    # What turns at the end to a rounding turns in the next step.
    turned = (h <= 0) & (after < end)
    after = jnp.where(after < end, after, end)
    state = method.step(smooth, at.state, after - at.t)
    reached = tau if slope is None else tau + slope * (after - at.t)
    landed, late = method.landed(_smooth(scene, reached, slope, at.way), state)
    # Of the time nothing is late but its derivatives.
    after = after + jnp.where(turned, late - lax.stop_gradient(late), 0)
    state = State(*(jnp.where(turned, x, y) for x, y in zip(landed, state, strict=True)))
    # What slowed it down takes it back, unless friction alone did that.
    force, held = _force(scene, state.theta, reached)
    way = jnp.where(turned, jnp.where(at.way * force >= -held, 0, -at.way), at.way)

    # At rest nothing moves until the torque has come to the edge of what friction holds.
    rest = at.way == 0
    release, onwards = end, jnp.zeros_like(way)
    if slope is not None:
        onwards = lax.stop_gradient(jnp.sign(slope))
        force = tau - scene.epsilon * sin_cos_of_any(at.state.theta)[0]
        steep = jnp.where(slope == 0, 1, slope)
        release = at.t + jnp.maximum((onwards * scene.dry - force) / steep, 0)
        released = (slope != 0) & (release < end)
        release = jnp.where(released, release, end)
        onwards = jnp.where(released, onwards, 0)
    still = State(at.state.theta, jnp.zeros_like(at.state.v))
    state = State(*(jnp.where(rest, x, y) for x, y in zip(still, state, strict=True)))
    return jnp.where(rest, release, after), state, jnp.where(rest, onwards, way)


def _torque(scene: Scene, line, t: Scalar) -> tuple[Any, Any]:
    """τ at t and its slope, `None` where it has none."""
    if isinstance(scene.tau, SampledTorque):
        value, slope = scene.tau.line(line)
        return value + slope * (t - scene.tau.ts[line]), slope
    return (jnp.zeros_like(t) if scene.tau is None else scene.tau), None


def _smooth(scene: Scene, tau, slope, way) -> Scene:
    """The equation of a motion one way, from a moment on at which the torque is `tau`."""
    tau = tau if way is None else tau - way * scene.dry
    return Scene(scene.epsilon, scene.beta, tau if slope is None else Ramp(tau, slope))
