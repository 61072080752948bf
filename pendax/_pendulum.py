"""The scene: which terms the equation of motion has, and what they are worth."""

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from ._arrays import NUMBERS, common, floating, require


class Pendulum(eqx.Module):
    """A pendulum of any amplitude: θ̈ + β θ̇ + ε sin θ = τ.

    **Arguments:**

    - `epsilon`: ε = g/l > 0, the square of the small-angle angular frequency, 1/s².
    - `beta`: the viscous damping β ≥ 0, 1/s.  `None`: the scene has no such term.
    - `tau`: the torque τ, 1/s², a number or a function of time.  `None`: no such term.

    A term that is `None` is absent from the pytree and from every compiled program.
    Arrays are scenes side by side; their shapes broadcast with those of the initial
    values.

    **Raises:** `ValueError` for ε ≤ 0 or β < 0 where their values can be seen; under a
    transformation such a scene gives NaN in its own lane.
    """

    epsilon: Float[Array, "..."]
    beta: Float[Array, "..."] | None
    tau: Float[Array, "..."] | Callable | None

    def __init__(
        self,
        epsilon: ArrayLike = 1.0,
        beta: ArrayLike | None = None,
        tau: ArrayLike | Callable | None = None,
    ):
        require("epsilon", epsilon, "positive", lambda x: (x > 0) & np.isfinite(x))
        require("beta", beta, "zero or positive", lambda x: (x >= 0) & np.isfinite(x))
        self.epsilon = _inexact(epsilon)
        self.beta = _inexact(beta)
        self.tau = _as_pytree(tau) if callable(tau) else _inexact(tau)

    @property
    def is_free(self) -> bool:
        """Whether there is neither damping nor torque: the scene with a closed form."""
        return self.beta is None and self.tau is None


def _inexact(x):
    """Numbers as floating arrays, Python's own weakly typed; all else as it is."""
    if not isinstance(x, NUMBERS):
        return x
    if isinstance(x, int | float):
        return jnp.asarray(float(x))
    return jnp.asarray(x, floating(x))


def _as_pytree(tau: Callable) -> Callable:
    """A plain function has to become a pytree to pass through `jit`."""
    leaves = jax.tree.leaves(tau)
    return jax.tree_util.Partial(tau) if any(leaf is tau for leaf in leaves) else tau


def require_free(pendulum: object, what: str) -> None:
    """ValueError for a scene with damping or torque, or for no scene at all."""
    if not isinstance(pendulum, Pendulum):
        raise ValueError(
            f"Argument `pendulum` must be a Pendulum, but got {type(pendulum).__name__}."
        )
    if not pendulum.is_free:
        terms = [name for name in ("beta", "tau") if getattr(pendulum, name) is not None]
        raise ValueError(
            f"Argument `pendulum` must have neither damping nor torque for {what}, "
            f"but got one with {' and '.join(f'`{name}`' for name in terms)}."
        )


def energy(pendulum: Pendulum, theta: ArrayLike, v: ArrayLike) -> Float[Array, "..."]:
    """½ v² + ε (1 − cos θ), per unit of m l², 1/s²; damping and torque are not in it.

    The potential is computed as 2 ε sin²(θ/2): 1 − cos θ loses the digits of a small θ.
    Shapes broadcast.
    """
    theta, v, epsilon = common(theta=theta, v=v, epsilon=pendulum.epsilon)
    return 0.5 * v * v + 2 * epsilon * jnp.sin(0.5 * theta) ** 2
