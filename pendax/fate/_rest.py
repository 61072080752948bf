"""Where dry friction brings a pendulum to rest, ε = 1 and τ ≥ 0.

It is followed from one turning point to the next until friction holds it.  Going one way, σ, its
equation is that of the torque σ τ − c, of which two things are known before their time:

- Damped so much that it creeps, it never turns again, and takes for ever to the edge of the band,
  θ* = arcsin(σ τ − c): where it is x before θ* and slower than ½βx, and cos ≤ ¼β² on all of x,
  since the line v = ½βx is crossed downwards alone.
- Past a saddle of τ − c, downhill, and with τ − c above τ_r, it runs for ever.
"""

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from ..taylor import Scene, State, advanced, begun, by_columns, order_for, taylor
from ._follow import CAPTURED, GOING, RUNNING, is_captured
from ._retrapping import retrapping
from ._saddle import saddle, well_of

Scalar = Float[Array, ""]

_LONGEST = 0.5  # radians of t: short enough for derivatives as well


class Rest(NamedTuple):
    end: Int[Array, ""]
    well: Scalar


class _Creep(NamedTuple):
    """Whether it does, to which angle."""

    sure: Bool[Array, ""]
    theta: Scalar


def rest(beta, tau, dry, start: State, most, rtol: float) -> tuple[tuple[Scalar, Scalar], Rest]:
    """Angle and time, with derivatives of every mode and order, and how it came there."""

    def found(p):
        beta, tau, dry, theta, v, most = p
        scene, most = Scene(jnp.ones_like(beta), beta, tau, dry), most.astype(jnp.int32)
        return _followed(scene, State(theta, v), most, rtol)

    return by_columns(found, [beta, tau, dry, *start, jnp.asarray(most).astype(beta.dtype)])


def _followed(scene: Scene, start: State, most, rtol: float):
    method = taylor(order_for(rtol, rtol, 12), rtol, rtol, _LONGEST)
    at = saddle(jnp.minimum(scene.tau, 1))
    push = scene.tau - scene.dry
    hill = saddle(jnp.clip(push, 0, 1))
    runs = push > retrapping(scene.beta)

    def end_of(before, after):
        crept = _creep(scene, after)
        held = (after.way == 0) | crept.sure | _without(scene, at, after.state)
        over = well_of(hill, after.state.theta) > well_of(hill, before.state.theta)
        running = (after.way > 0) & (before.way > 0) & (over & runs | (push > 1))
        return jnp.where(held, CAPTURED, jnp.where(running, RUNNING, GOING))

    def unfinished(carry):
        now, end = carry
        return (end == GOING) & now.going & (now.steps < most)

    def step(carry):
        now, _ = carry
        after = advanced(method, scene, now, jnp.full_like(now.t, jnp.inf))
        return after, end_of(now, after)

    begin = begun(scene, start, jnp.zeros_like(start.v))
    now, end = lax.while_loop(unfinished, step, (begin, end_of(begin, begin)))
    crept = _creep(scene, now)
    well = well_of(at, now.state.theta)
    bottom = 2 * jnp.pi * well + jnp.arcsin(jnp.minimum(scene.tau, 1))
    theta = jnp.where(crept.sure, crept.theta, now.state.theta)
    theta = jnp.where(_without(scene, at, now.state) & (now.way != 0), bottom, theta)
    # That of a step that made it certain is a matter of steps.
    t = jnp.where(now.way == 0, now.t, lax.stop_gradient(now.t))
    return (theta, t), Rest(end, lax.stop_gradient(well_of(at, theta)))


def _without(scene: Scene, at, state: State) -> Bool[Array, ""]:
    """Whether there is no friction after all, and the damping alone has caught it."""
    return (scene.dry == 0) & (scene.beta > 0) & (scene.tau <= 1) & is_captured(scene, at, state)


def _creep(scene: Scene, now) -> _Creep:
    """Seen in the direction in which it goes."""
    angle, speed = now.way * now.state.theta, now.way * now.state.v
    push = now.way * scene.tau - scene.dry
    inside = (now.way != 0) & (jnp.abs(push) < 1) & (scene.beta > 0)
    edge = jnp.arcsin(jnp.where(inside, push, 0))
    well = lax.stop_gradient(jnp.ceil((angle - edge) / (2 * jnp.pi)))
    ahead = edge + 2 * jnp.pi * well
    x, near = ahead - angle, angle - 2 * jnp.pi * well
    steepest = jnp.where((near <= 0) & (edge >= 0), 1, jnp.maximum(jnp.cos(near), jnp.cos(edge)))
    slow = (speed >= 0) & (speed < 0.5 * scene.beta * x) & (x < jnp.pi + 2 * edge)
    sure = inside & slow & (steepest <= 0.25 * scene.beta * scene.beta)
    return _Creep(sure, now.way * ahead)
