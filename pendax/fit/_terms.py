"""The numbers of a scene that a fit may find, by name."""

from collections.abc import Mapping
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from .._arrays import floating
from .._pendulum import Pendulum
from .._torque import SampledTorque

OF_SCENE = ("epsilon", "beta", "tau", "dry")
OF_TORQUE = ("inertia", "bias")
POSITIVE = frozenset({"epsilon", "inertia"})
MAY_VANISH = frozenset({"beta", "dry"})
LEAST = 1e-3  # of √ε, and of ε: friction to begin with, where the guess is 0


def numbers_of(guess: object) -> dict[str, Any]:
    """As they are in the guess; ValueError for lanes of them."""
    if not isinstance(guess, Pendulum):
        raise ValueError(f"Argument `guess` must be a Pendulum, but got {type(guess).__name__}.")
    found = {name: getattr(guess, name) for name in OF_SCENE}
    if isinstance(guess.tau, SampledTorque):
        found |= {name: getattr(guess.tau, name) for name in OF_TORQUE}
    found = {name: x for name, x in found.items() if x is not None and not callable(x)}
    for name, x in found.items():
        if jnp.ndim(x):
            raise ValueError(
                f"Argument `guess` must have numbers, but its {name} has shape {jnp.shape(x)}: "
                "jax.vmap fits many."
            )
    return found


def with_numbers(scene: Pendulum, numbers: Mapping[str, Array]) -> Pendulum:
    """The scene with those of `numbers` that are its own."""

    def leaves(scene):
        own = [getattr(scene, name) for name in OF_SCENE if name in numbers]
        torque = [getattr(scene.tau, name) for name in OF_TORQUE if name in numbers]
        return own + torque

    values = [numbers[name] for name in (*OF_SCENE, *OF_TORQUE) if name in numbers]
    return eqx.tree_at(leaves, scene, values)


def widened(guess: Pendulum) -> Pendulum:
    """With all of a recorded torque in the default precision, in which a fit is made."""
    if not isinstance(guess.tau, SampledTorque):
        return guess
    tau = jax.tree.map(lambda x: jnp.asarray(x, floating(1.0)), guess.tau)
    return eqx.tree_at(lambda p: p.tau, guess, tau)


def scales(start: Mapping[str, Array], epsilon: Float[Array, ""]) -> dict[str, Array]:
    """Natural units of what is searched additively."""
    inertia = start.get("inertia", jnp.ones_like(epsilon))
    return {"tau": epsilon, "v0": jnp.sqrt(epsilon), "bias": epsilon * inertia}


def begun(start: dict[str, Array], epsilon: Float[Array, ""]) -> dict[str, Array]:
    """A friction of 0 would stay there."""
    least = {"beta": LEAST * jnp.sqrt(epsilon), "dry": LEAST * epsilon}
    return {
        name: jnp.where(x == 0, least[name], x) if name in least else x for name, x in start.items()
    }
