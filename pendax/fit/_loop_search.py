"""The search for a junction's parameters in its running points and its currents of transition."""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from ..josephson import JosephsonJunction
from ..josephson._iv_curve import running_voltage
from ._judgement import Judgement, judged
from ._minimise import by_optimiser, least_squares
from ._parameters import Parameters
from ._search import rooted, total

SHARP = 2e-3  # of Ic: the error of a switching current that was measured once
SLOW = 5 * SHARP  # of one of retrapping, which noise and leakage move more
CLOSE = 0.01  # of the largest voltage: the unit of the residuals

Pair = Float[Array, "2"]


class Points(NamedTuple):
    """Means of neighbouring running points; `weight`: how many there are, over the mean number."""

    current: Float[Array, " bins"]
    voltage: Float[Array, " bins"]
    weight: Float[Array, " bins"]


class Edges(NamedTuple):
    """Currents, A, where the voltage appears and where it vanishes, and how far measured
    ones lie apart there; `switched` and `retrapped` are 0 where they were not measured.

    For positive currents and for negative ones, sign left out.
    """

    switching: Pair
    retrapping: Pair
    switched: Pair
    retrapped: Pair
    gap: Float[Array, ""]


class Outcome(NamedTuple):
    x: Float[Array, " parameters"]
    history: Float[Array, " steps"]
    judgement: Judgement
    loss: Float[Array, ""]
    off: Float[Array, " bins"]  # measured less modelled, over the largest voltage


class LoopSearch(eqx.Module):
    """`edges`: of a loop with hysteresis, else `None`; `held` has what is not fitted, by name."""

    points: Points
    edges: Edges | None
    held: dict[str, Array]
    parameters: Parameters
    largest: Float[Array, ""]
    loss: Callable | None = eqx.field(static=True)
    optimiser: Any = eqx.field(static=True)
    steps: int = eqx.field(static=True)

    @eqx.filter_jit
    def run(
        self,
        x: Float[Array, " parameters"],
        used: Bool[Array, " bins"],
        share: Float[Array, ""],
        most: Int[Array, ""],
    ) -> Outcome:
        """`most` steps from x on, with the points `used`, counted as `share` of their number."""

        def of_values(values):
            r, off = self._residuals(values, used, share)
            return r, (r, off)

        def residuals(x):
            r, _ = of_values(self.parameters.at(x))
            return r if self.loss is None else rooted(self.loss, r)

        found = least_squares(residuals, x, self.steps, most)
        if self.optimiser is not None:

            def loss(x):
                return total(self.loss, of_values(self.parameters.at(x))[0])

            found = by_optimiser(loss, found.x, self.optimiser, self.steps)
        values = self.parameters.at(found.x)
        jacobian, (r, off) = jax.jacfwd(of_values, has_aux=True)(values)
        count = share * jnp.sum(used).astype(r.dtype)
        if self.edges is not None:
            count = count + jnp.sum(self.edges.switched + self.edges.retrapped)
        judgement = judged(
            r,
            jacobian,
            count,
            values,
            self.parameters.has_sign,
            self.loss,
            self._variances(r, count),
        )
        return Outcome(found.x, found.history, judgement, total(self.loss, r), off)

    def _variances(self, r, count):
        """Of voltages as they scatter, of currents of transition as they were resolved."""
        if self.edges is None:
            return None
        bins = self.points.current.size
        edges = jnp.sum(self.edges.switched + self.edges.retrapped)
        scatter = jnp.sum(r[:bins] ** 2) / jnp.maximum(count - edges - 1, 1)
        return jnp.where(jnp.arange(r.size) < bins, scatter, 1)

    def _junction(self, values) -> tuple[JosephsonJunction, Array]:
        at = self.held | self.parameters.split(values)
        leaves = at["critical_current"], at["resistance"], at.get("capacitance")
        return JosephsonJunction(*leaves), at["current_offset"]

    def _off(self, values):
        junction, zero = self._junction(values)
        current = self.points.current - zero
        leaves = [jnp.broadcast_to(x, current.shape) for x in junction.parameters().values()]
        return (self.points.voltage - running_voltage(current, *leaves)) / self.largest

    def _residuals(self, values, used, share):
        all_off = self._off(values)
        off = jnp.where(used, all_off, 0)
        parts = [off * jnp.sqrt(share * self.points.weight) / CLOSE]
        if self.edges is not None:
            junction, zero = self._junction(values)
            unit, sign = junction.critical_current, jnp.asarray([1, -1], zero.dtype)
            edges = self.edges
            for model, data, there, error in (
                (unit, edges.switching, edges.switched, SHARP),
                (junction.retrapping_current, edges.retrapping, edges.retrapped, SLOW),
            ):
                unsure = jnp.hypot(error * unit, self.edges.gap / 12**0.5)
                parts.append(there * (data - sign * zero - model) / unsure)
        return jnp.concatenate(parts), all_off
