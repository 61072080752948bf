"""What is fitted, and the numbers without unit or bounds in which it is searched."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

Vector = Float[Array, " parameters"]


class Parameters(eqx.Module):
    """Fitted arrays by name, each searched as x, 0 at its start.

    One that has to be `positive` is start · eˣ, or start · (1 + x)² if it `may_vanish`: eˣ would
    keep for ever what a short stretch has taken for nothing.  Any other is start + scale · x.
    Never out of range, and steps in x of the order of one.
    """

    start: dict[str, Float[Array, "..."]]
    scale: dict[str, Float[Array, ""]]
    positive: frozenset[str] = eqx.field(static=True)
    may_vanish: frozenset[str] = eqx.field(static=True)
    names: tuple[str, ...] = eqx.field(static=True)  # in order: a pytree's are sorted

    @property
    def size(self) -> int:
        return sum(x.size for x in self.start.values())

    @property
    def has_sign(self) -> Bool[Array, " parameters"]:
        """Of each element, whether it has to be positive."""
        signed = self.positive | self.may_vanish
        return self.joined(
            {name: jnp.full(x.shape, name in signed) for name, x in self.start.items()}
        )

    def split(self, vector: Vector) -> dict[str, Float[Array, "..."]]:
        """The elements of one vector as the arrays they are."""
        parts, first = {}, 0
        for name in self.names:
            start = self.start[name]
            parts[name] = vector[first : first + start.size].reshape(start.shape)
            first += start.size
        return parts

    def joined(self, parts: dict[str, Any]) -> Array:
        return jnp.concatenate([jnp.ravel(parts[name]) for name in self.names])

    def at(self, x: Vector) -> Vector:
        """The values, one after the other, at x."""
        values = {}
        for name, step in self.split(x).items():
            start = self.start[name]
            if name in self.positive:
                values[name] = start * jnp.exp(step)
            elif name in self.may_vanish:
                values[name] = start * (1 + step) ** 2
            else:
                values[name] = start + self.scale[name] * step
        return self.joined(values)
