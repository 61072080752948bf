"""The scene: which terms the equation of motion has, and what they are worth."""

from collections.abc import Callable

import equinox as eqx
import jax
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from ._arrays import aligned, inexact, require
from ._torque import SampledTorque


class Pendulum(eqx.Module):
    """A pendulum of any amplitude: θ̈ + β θ̇ + c sign θ̇ + ε sin θ = τ.

    **Arguments:**

    - `epsilon`: ε = g/l > 0, the square of the small-angle angular frequency, 1/s².
    - `beta`: the viscous damping β ≥ 0, 1/s.  `None`: the scene has no such term.
    - `tau`: the torque τ, 1/s², a number or a function of time, a [`SampledTorque`][] for one
      that was recorded.  `None`: no such term.
    - `dry`: the dry friction c ≥ 0 of a bearing, 1/s², against the motion however slow it is;
      where the pendulum is at rest and |τ − ε sin θ| ≤ c, it stays.  `None`: no such term.

    A term that is `None` is absent from the pytree and from every compiled program.
    Arrays are scenes side by side; their shapes broadcast with those of the initial
    values.

    **Raises:** `ValueError` for ε ≤ 0, β < 0 or c < 0 where their values can be seen; under a
    transformation such a scene gives NaN in its own lane.
    """

    epsilon: Float[Array, "..."]
    beta: Float[Array, "..."] | None
    tau: Float[Array, "..."] | Callable | None
    dry: Float[Array, "..."] | None

    def __init__(
        self,
        epsilon: ArrayLike = 1.0,
        beta: ArrayLike | None = None,
        tau: ArrayLike | Callable | None = None,
        dry: ArrayLike | None = None,
    ):
        for name, x in (("epsilon", epsilon), ("beta", beta), ("dry", dry)):
            if callable(x):
                raise ValueError(
                    f"Argument `{name}` must be a number: `tau` alone may be a function."
                )
        require("epsilon", epsilon, "positive", lambda x: (x > 0) & np.isfinite(x))
        require("beta", beta, "zero or positive", lambda x: (x >= 0) & np.isfinite(x))
        require("dry", dry, "zero or positive", lambda x: (x >= 0) & np.isfinite(x))
        self.epsilon = inexact(epsilon)
        self.beta = inexact(beta)
        self.tau = as_pytree(tau) if callable(tau) else inexact(tau)
        self.dry = inexact(dry)

    @classmethod
    def from_si(
        cls,
        length: ArrayLike,
        gravity: ArrayLike = 9.80665,
        mass: ArrayLike | None = None,
        damping: ArrayLike | None = None,
        torque: ArrayLike | Callable | None = None,
        dry: ArrayLike | None = None,
    ) -> "Pendulum":
        """The scene of a point mass on a rod: ε = g/l, and β, τ, c = η, T, T_c over m l².

        **Arguments:** `length` l, m; `gravity` g, m/s²; `mass` m, kg, needed with any
        of the next; `damping` η, N m s; `torque` T, N m, a number or a function of time; `dry` T_c,
        N m, the torque of dry friction.

        **Raises:** `ValueError` for l, g or m ≤ 0, η or T_c < 0, or a missing mass.
        Suzuki & Suzuki §1.1, §7.1, §8.1.
        """
        given = {"length": length, "gravity": gravity, "mass": mass, "damping": damping, "dry": dry}
        given |= {} if callable(torque) else {"torque": torque}
        aligned(**{name: x for name, x in given.items() if x is not None})
        for name, x in (("length", length), ("gravity", gravity), ("mass", mass)):
            require(name, x, "positive", lambda x: (x > 0) & np.isfinite(x))
        for name, x in (("damping", damping), ("dry", dry)):
            require(name, x, "zero or positive", lambda x: (x >= 0) & np.isfinite(x))
        if mass is None and not (damping is None and torque is None and dry is None):
            raise ValueError("Argument `mass` must be given with `damping`, `torque` or `dry`.")
        epsilon = inexact(gravity) / inexact(length)
        if mass is None:
            return cls(epsilon)
        inertia = inexact(mass) * inexact(length) ** 2
        beta, dry = (None if x is None else inexact(x) / inertia for x in (damping, dry))
        if isinstance(torque, SampledTorque) and torque.inertia is None:
            torque = SampledTorque(torque.ts, torque.torque, inertia, torque.bias)
            return cls(epsilon, beta, torque, dry)
        if callable(torque):
            torque = jax.tree_util.Partial(_over, as_pytree(torque), inertia)
            return cls(epsilon, beta, torque, dry)
        return cls(epsilon, beta, None if torque is None else inexact(torque) / inertia, dry)

    @property
    def is_free(self) -> bool:
        """Whether there is neither friction nor torque: the scene with a closed form."""
        return self.beta is None and self.tau is None and self.dry is None


def as_pytree(tau: Callable) -> Callable:
    """A plain function has to become a pytree to pass through `jit`."""
    leaves = jax.tree.leaves(tau)
    return jax.tree_util.Partial(tau) if any(leaf is tau for leaf in leaves) else tau


def _over(torque: Callable, inertia: Float[Array, "..."], t: Float[Array, "..."]):
    return torque(t) / inertia


def require_free(pendulum: object, what: str) -> None:
    """ValueError for a scene with friction or torque, or for no scene at all."""
    if not isinstance(pendulum, Pendulum):
        raise ValueError(
            f"Argument `pendulum` must be a Pendulum, but got {type(pendulum).__name__}."
        )
    if not pendulum.is_free:
        terms = [name for name in ("beta", "tau", "dry") if getattr(pendulum, name) is not None]
        raise ValueError(
            f"Argument `pendulum` must have neither friction nor torque for {what}, "
            f"but got one with {' and '.join(f'`{name}`' for name in terms)}."
        )
