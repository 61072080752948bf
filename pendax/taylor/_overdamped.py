"""The overdamped pendulum once its velocity has relaxed: a slow motion of the angle alone.

After a few times 1/β, v is a function of θ, v = (f − v̇)/β with f = τ − ε sin θ, and steps need
no longer resolve 1/β.  In time counted in β/(ε + |τ|), with w that time's dθ/dt, this is

    w = f/(ε + |τ|) − δ ẇ,    δ = (ε + |τ|)/β²,

solved by iteration: each sweep is a Taylor series with ẇ from the one before, and right to one
more power of δ.  Rejected: the full series from a state off that curve, whose terms grow
like (β t)^n/n! from the last digit on; an implicit method, with its Jacobians and low order.
"""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
from jax import lax

from ..special._elementary import sin_cos_of_any
from ._series import Scene, Sine, State, largest, sine_and_cosine, torque_series
from ._step import STABLE, Method, method, plain

# δ below which five sweeps leave less than eps: the error is 42 δ⁵ (Catalan's numbers).
LARGEST = 1e-3 / 4
_SWEEPS = 5


def overdamped(
    order: int, rtol: float, atol: float, longest: float = STABLE, sweeps: int = _SWEEPS
) -> Method:
    """Steps on the slow curve: they take θ, and give v whatever it was."""

    def quickest(scene):
        return strength(scene) / scene.beta

    def series(order, scene, state):
        return _series(order, sweeps, scene, state)

    return method(series, order, rtol, atol, quickest, longest, plain)


def is_overdamped(scene: Scene):
    """Whether the slow curve exists, and is known to all digits."""
    return strength(scene) < LARGEST * scene.beta * scene.beta


def strength(scene: Scene):
    """What the slow motion's rate is, times β."""
    most = scene.epsilon
    for force in (None if scene.tau is None else largest(scene.tau), scene.dry):
        most = most if force is None else most + force
    if isinstance(scene.tau, Sine):
        # A fast clock makes w as steep as a strong force.
        return jnp.maximum(most, scene.tau.frequency * scene.beta)
    return most


@partial(jax.jit, static_argnums=(0, 1))
def _series(order: int, sweeps: int, scene: Scene, state: State):
    most = strength(scene)
    rate, delta = most / scene.beta, most / (scene.beta * scene.beta)
    epsilon = scene.epsilon / most
    tau = [x / most for x in torque_series(scene.tau, 1 / rate, order)]
    sine, cosine = sin_cos_of_any(state.theta)

    def sweep(_, before):
        w: list[Any] = []
        theta: list[Any] = [state.theta]
        sines: list[Any] = [sine]
        cosines: list[Any] = [cosine]
        for n in range(order + 1):
            f = -epsilon * sines[n]
            if n < len(tau):
                f = f + tau[n]
            w.append(f - delta * (n + 1) * before[n + 1])
            theta.append(w[n] / (n + 1))
            following = sine_and_cosine(theta, sines, cosines)
            sines.append(following[0])
            cosines.append(following[1])
        return jnp.stack([*w, jnp.zeros_like(rate)])

    # A loop, that its program be small.
    w = lax.fori_loop(0, sweeps, sweep, jnp.zeros(order + 2, rate.dtype))
    return rate, list(w[: order + 1]), None
