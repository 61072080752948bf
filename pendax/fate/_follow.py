"""A scene of ε = 1 followed step by step until its fate is sealed, and what seals it.

Where |τ| ≤ 1: at the distance y before the saddle that ends a well, the potential is by

    D(y) = κ (1 − cos y) − τ (y − sin y),    κ = √(1 − τ²),

below the saddle's.  Energy only falls: what has ½v² < D stays in this well.  So does, energy
apart, what has 0 ≤ v ≤ ½βy close to the saddle, or anywhere in the well where β² > 3.03: the
line v = ½βy is crossed downwards alone, as long as the force is below ¼β²y, and the force
is at most ½τy² (y ≤ π), and at most 0.756 y; and v = 0 is crossed downwards where the force
is negative alone, to the right of the bottom, and so with ½v² < D.  Overdamped motions are
sealed by it at once.
"""

from collections.abc import Callable
from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from ..special._elementary import sin_cos_of_any
from ..taylor import Scene, State, order_for, taylor
from ._saddle import Saddle, before, well_of

Scalar = Float[Array, ""]

GOING, CAPTURED, RUNNING = 0, 1, 2


class Followed(NamedTuple):
    """Where it was left, and why: GOING where `most` steps were too few."""

    t: Scalar
    state: State
    steps: Int[Array, ""]
    end: Int[Array, ""]


def is_captured(scene: Scene, at: Saddle, state: State) -> Bool[Array, ""]:
    y = before(at, state.theta, well_of(at, state.theta))
    sine, cosine = sin_cos_of_any(0.5 * y)
    depth = 2 * at.kappa * sine**2 - at.tau * (y - 2 * sine * cosine)
    square = scene.beta * scene.beta
    near = jnp.minimum(0.5 * square / jnp.maximum(at.tau, 1e-9), jnp.pi)
    reach = jnp.where(square > 3.03, 2 * jnp.pi, near)
    slow = (state.v >= 0) & (state.v < 0.5 * scene.beta * y) & (y <= reach)
    return (0.5 * state.v * state.v < depth) | slow


def follow(
    scene: Scene,
    start: State,
    end_of: Callable[[State, State], Int[Array, ""]],
    first: Int[Array, ""],
    most: Int[Array, ""] | int,
    rtol: float,
) -> Followed:
    """Steps until `end_of(before, after)` is not GOING; none where `first` isn't."""
    method = taylor(order_for(rtol, rtol), rtol, rtol)

    def unfinished(at: Followed):
        return (at.end == GOING) & (at.steps < most)

    def step(at: Followed):
        h = method.size(scene, at.state)
        after = method.step(scene, at.state, h)
        fine = jnp.isfinite(after.theta) & jnp.isfinite(after.v) & (h > 0)
        steps = jnp.where(fine, at.steps + 1, most)
        return Followed(at.t + h, after, steps, jnp.where(fine, end_of(at.state, after), GOING))

    begin = Followed(jnp.zeros_like(start.v), start, jnp.zeros((), jnp.int32), first)
    return lax.while_loop(unfinished, step, begin)
