"""From one passage of the bottom to the next: what damping takes from the energy, and when.

The energy that is lost is β times I = ∫ v² dt, a series of its own: the difference of two
energies would have no digits left where β is small.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from ..special._cpu import stage
from ._series import Scene, State, scaled_series
from ._step import LAST, integrated, polynomial, reach

Scalar = Float[Array, ""]

_ORDER, _TOLERANCE = 12, 1e-17


class Passage(NamedTuple):
    """The `time` it took, I, and whether it came from above with v > 0, by 2π further on."""

    time: Scalar
    action: Scalar
    over: Bool[Array, ""]


@jax.jit  # traced once
def passage(scene: Scene, energy: Scalar, start: State) -> Passage:
    """From `start`, 0 ≤ θ < 2π and v ≥ 0, of that energy, to θ = 2π, or to θ = 0 with v < 0."""
    # Relative to the amplitude, for the smallest of swings.
    amplitude = jnp.minimum(1.0, jnp.sqrt(energy / scene.epsilon))
    amplitude = lax.stop_gradient(amplitude)

    def step(carry):
        t, state, action, _ = carry
        h = stage(_size, *lax.stop_gradient((scene, state, amplitude)))
        after, gained = _after(scene, state, h)
        ends = (after.theta >= 2 * jnp.pi) | ((after.theta <= 0) & (after.v < 0))
        # Without a way out a number that is not finite would go on for ever.
        ends = ends | ~(h > 0) | ~jnp.isfinite(after.theta)
        beyond = h * _fraction(state.theta, after.theta)
        old, new = (t, state, action), (t + h, after, action + gained)
        return (*jax.tree.map(lambda x, y: jnp.where(ends, x, y), old, new), (beyond, ends))

    zero = jnp.zeros_like(energy)
    begin = (zero, start, zero, (zero, zero != 0))
    t, state, action, (h, _) = lax.while_loop(lambda carry: ~carry[-1][1], step, begin)
    over = state.theta > jnp.pi
    target = jnp.where(over, 2 * jnp.pi, 0.0)

    def newton(_, carry):
        h, _ = carry
        near, gained = _after(scene, state, h)
        return h - (near.theta - target) / near.v, gained

    h, gained = lax.fori_loop(0, 6, newton, (h, zero))
    return Passage(t + h, action + gained, over)


def _fraction(theta: Scalar, after: Scalar) -> Scalar:
    """Where between the two the bottom is, roughly."""
    return (jnp.where(theta > jnp.pi, 2 * jnp.pi, 0.0) - theta) / (after - theta)


def _size(scene: Scene, state: State, amplitude: Scalar) -> Scalar:
    rate, v, _ = scaled_series(_ORDER, scene, state)
    return reach([jnp.abs(x) / amplitude for x in v[-LAST:]], _ORDER, _TOLERANCE) / rate


def _after(scene: Scene, state: State, h: Scalar) -> tuple[State, Scalar]:
    """The state after h, and ∫ v² dt until then."""
    theta, v, action = (stage(f, scene, state, h) for f in (_theta, _velocity, _action))
    return State(theta, v), action


def _theta(scene: Scene, state: State, h: Scalar) -> Scalar:
    rate, v, _ = scaled_series(_ORDER, scene, state)
    return state.theta + h * rate * polynomial(integrated(v[:-1]), h * rate)


def _velocity(scene: Scene, state: State, h: Scalar) -> Scalar:
    rate, v, _ = scaled_series(_ORDER, scene, state)
    return rate * polynomial(v, h * rate)


def _action(scene: Scene, state: State, h: Scalar) -> Scalar:
    rate, v, _ = scaled_series(_ORDER, scene, state)
    square = [sum(v[k] * v[n - k] for k in range(n + 1)) for n in range(_ORDER)]
    return h * rate * rate * polynomial(integrated(square), h * rate)
