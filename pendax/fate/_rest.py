"""Where dry friction brings a pendulum to rest, ε = 1 and τ ≥ 0.

It is followed from one turning point to the next until friction holds it.  Going one way, σ, its
equation is that of the torque σ τ − c, of which two things are known before their time:

- Damped so much that it creeps, it never turns again, and takes for ever to the edge of the band,
  θ* = arcsin(σ τ − c): where it is x before θ* and slower than ½βx, and cos ≤ ¼β² on all of x,
  since the line v = ½βx is crossed downwards alone.
- Past a saddle of τ − c, downhill, and with τ − c above τ_r, it runs for ever.
"""

from collections.abc import Callable
from typing import NamedTuple

import jax
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
    scene = Scene(jnp.ones_like(dry), beta, tau, dry)
    p, treedef = jax.tree.flatten((scene, start, jnp.asarray(most).astype(dry.dtype)))

    def found(p):
        scene, start, most = jax.tree.unflatten(treedef, p)
        return _followed(scene, start, most.astype(jnp.int32), rtol)

    return by_columns(found, p)


def _followed(scene: Scene, start: State, most, rtol: float):
    method = taylor(order_for(rtol, rtol, 12), rtol, rtol, _LONGEST)
    tau = jnp.zeros_like(scene.dry) if scene.tau is None else jnp.minimum(scene.tau, 1)
    at, runs = saddle(tau), _runs(scene)

    def end_of(before, after):
        held = (after.way == 0) | _creep(scene, after).sure | _without(scene, at, after.state)
        return jnp.where(held, CAPTURED, jnp.where(runs(before, after), RUNNING, GOING))

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
    bottom = 2 * jnp.pi * well + jnp.arcsin(tau)
    theta = jnp.where(crept.sure, crept.theta, now.state.theta)
    theta = jnp.where(_without(scene, at, now.state) & (now.way != 0), bottom, theta)
    # That of a step that made it certain is a matter of steps.
    t = jnp.where(now.way == 0, now.t, lax.stop_gradient(now.t))
    return (theta, t), Rest(end, lax.stop_gradient(well_of(at, theta)))


def _runs(scene: Scene) -> Callable:
    """Whether it has just been made certain that it will for ever."""
    if scene.tau is None:
        return lambda before, after: jnp.zeros_like(after.going)
    push = scene.tau - scene.dry
    hill = saddle(jnp.clip(push, 0, 1))
    least = 0 if scene.beta is None else retrapping(scene.beta)

    def runs(before, after):
        over = well_of(hill, after.state.theta) > well_of(hill, before.state.theta)
        return (after.way > 0) & (before.way > 0) & (over & (push > least) | (push > 1))

    return runs


def _without(scene: Scene, at, state: State) -> Bool[Array, ""]:
    """Whether there is no friction after all, and the damping alone has caught it."""
    if scene.beta is None:
        return jnp.zeros_like(scene.dry, bool)
    damped = (scene.dry == 0) & (scene.beta > 0)
    if scene.tau is not None:
        damped = damped & (scene.tau <= 1)
    return damped & is_captured(scene, at, state)


def _creep(scene: Scene, now) -> _Creep:
    """Seen in the direction in which it goes."""
    if scene.beta is None:
        return _Creep(jnp.zeros_like(now.going), now.state.theta)
    angle, speed = now.way * now.state.theta, now.way * now.state.v
    push = -scene.dry if scene.tau is None else now.way * scene.tau - scene.dry
    inside = (now.way != 0) & (jnp.abs(push) < 1) & (scene.beta > 0)
    edge = jnp.arcsin(jnp.where(inside, push, 0))
    well = lax.stop_gradient(jnp.ceil((angle - edge) / (2 * jnp.pi)))
    ahead = edge + 2 * jnp.pi * well
    x, near = ahead - angle, angle - 2 * jnp.pi * well
    steepest = jnp.where((near <= 0) & (edge >= 0), 1, jnp.maximum(jnp.cos(near), jnp.cos(edge)))
    slow = (speed >= 0) & (speed < 0.5 * scene.beta * x) & (x < jnp.pi + 2 * edge)
    sure = inside & slow & (steepest <= 0.25 * scene.beta * scene.beta)
    return _Creep(sure, now.way * ahead)
