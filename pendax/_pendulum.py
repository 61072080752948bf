"""The scene: which terms the equation of motion has, and what they are worth."""

from collections.abc import Callable

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from ._arrays import aligned, inexact, require


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
        self.epsilon = inexact(epsilon)
        self.beta = inexact(beta)
        self.tau = as_pytree(tau) if callable(tau) else inexact(tau)

    @classmethod
    def from_si(
        cls,
        length: ArrayLike,
        gravity: ArrayLike = 9.80665,
        mass: ArrayLike | None = None,
        damping: ArrayLike | None = None,
        torque: ArrayLike | Callable | None = None,
    ) -> "Pendulum":
        """The scene of a point mass on a rod: ε = g/l, β = η/(m l²), τ = T/(m l²).

        **Arguments:** `length` l, m; `gravity` g, m/s²; `mass` m, kg, needed with either
        of the next two; `damping` η, N m s; `torque` T, N m, a number or a function of time.

        **Raises:** `ValueError` for l, g or m ≤ 0, η < 0, or a missing mass.
        Suzuki & Suzuki §1.1, §7.1, §8.1.
        """
        given = {"length": length, "gravity": gravity, "mass": mass, "damping": damping}
        given |= {} if callable(torque) else {"torque": torque}
        aligned(**{name: x for name, x in given.items() if x is not None})
        for name, x in (("length", length), ("gravity", gravity), ("mass", mass)):
            require(name, x, "positive", lambda x: (x > 0) & np.isfinite(x))
        require("damping", damping, "zero or positive", lambda x: (x >= 0) & np.isfinite(x))
        if mass is None and not (damping is None and torque is None):
            raise ValueError("Argument `mass` must be given with `damping` or `torque`.")
        epsilon = inexact(gravity) / inexact(length)
        if mass is None:
            return cls(epsilon)
        inertia = inexact(mass) * inexact(length) ** 2
        beta = None if damping is None else inexact(damping) / inertia
        if callable(torque):
            return cls(epsilon, beta, jax.tree_util.Partial(_over, as_pytree(torque), inertia))
        return cls(epsilon, beta, None if torque is None else inexact(torque) / inertia)

    @property
    def is_free(self) -> bool:
        """Whether there is neither damping nor torque: the scene with a closed form."""
        return self.beta is None and self.tau is None


def as_pytree(tau: Callable) -> Callable:
    """A plain function has to become a pytree to pass through `jit`."""
    leaves = jax.tree.leaves(tau)
    return jax.tree_util.Partial(tau) if any(leaf is tau for leaf in leaves) else tau


def _over(torque: Callable, inertia: Float[Array, "..."], t: Float[Array, "..."]):
    return torque(t) / inertia


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
