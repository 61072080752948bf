"""A torque that was measured: samples joined by straight lines."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float, Int

from ._arrays import common, concrete, inexact, require


class SampledTorque(eqx.Module):
    """τ(t) = (T(t) + bias)/inertia of a measured torque T: a function of time for a `Pendulum`.

    **Arguments:**

    - `ts`, `torque`: times, s, increasing, and the torque at them, N m, or in 1/s² without
      `inertia`; straight lines between.  One axis.
    - `inertia`: m l², or J, kg m².  `None`: `torque` is τ itself.
    - `bias`: what is added to `torque`, in its unit.  `None`: nothing.

    Outside `ts` it is NaN: nothing is known of it.  `inertia` and `bias` are numbers that
    [`fit_trajectory`][] finds, where they are not `None`.

    **Raises:** `ValueError` for times that don't increase, samples that are not finite, shapes
    that don't agree, an inertia that is not positive.
    """

    ts: Float[Array, " samples"]
    torque: Float[Array, " samples"]
    inertia: Float[Array, ""] | None
    bias: Float[Array, ""] | None

    def __init__(
        self,
        ts: ArrayLike,
        torque: ArrayLike,
        inertia: ArrayLike | None = None,
        bias: ArrayLike | None = None,
    ):
        require("inertia", inertia, "positive", lambda x: (x > 0) & np.isfinite(x))
        require("bias", bias, "finite", np.isfinite)
        for name, x in (("inertia", inertia), ("bias", bias)):
            if x is not None and jnp.ndim(x):
                raise ValueError(f"Argument `{name}` must be one number, but got {jnp.shape(x)}.")
        if jnp.ndim(ts) != 1 or jnp.shape(ts) != jnp.shape(torque) or jnp.size(ts) < 2:
            raise ValueError(
                "Arguments `ts` and `torque` must have one axis of two or more samples, the same, "
                f"but got {jnp.shape(ts)} and {jnp.shape(torque)}."
            )
        for name, x in (("ts", ts), ("torque", torque)):
            values = concrete(x)
            if values is not None and not np.isfinite(values).all():
                raise ValueError(
                    f"Argument `{name}` must be finite, but got {values[~np.isfinite(values)][0]}."
                )
        seen = concrete(ts)
        if seen is not None and (np.diff(seen) <= 0).any():
            i = int(np.argmax(np.diff(seen) <= 0))
            raise ValueError(f"Argument `ts` must increase, but got {seen[i + 1]} after {seen[i]}.")
        self.ts, self.torque = common(ts=ts, torque=torque)
        self.inertia, self.bias = inexact(inertia), inexact(bias)

    def __call__(self, t: ArrayLike) -> Float[Array, "..."]:
        """τ(t), 1/s², of any shape."""
        t = jnp.asarray(t, self.ts.dtype)
        i = self.piece(t)
        value, slope = self.line(i)
        inside = jnp.where((t >= self.ts[0]) & (t <= self.ts[-1]), 1, jnp.nan)
        return inside * (value + slope * (t - self.ts[i]))

    def require_within(self, *times: ArrayLike) -> None:
        """ValueError for times, where they can be seen, at which the torque is not known."""
        known = concrete(self.ts)
        for t in times:
            seen = concrete(t)
            if known is None or seen is None or seen.size == 0:
                continue
            outside = (seen < known[0]) | (seen > known[-1])
            if outside.any():
                raise ValueError(
                    f"Argument `ts` must be within the times of the torque, {known[0]:.6g} to "
                    f"{known[-1]:.6g}, from `t0` on, but got {seen[outside].flat[0]:.6g}."
                )

    def piece(self, t: Float[Array, "..."]) -> Int[Array, "..."]:
        """The number of the straight line that t is on."""
        after = jnp.searchsorted(self.ts, t, side="right").astype(jnp.int32)
        return jnp.clip(after - 1, 0, self.ts.size - 2)

    def line(self, i: Int[Array, "..."]) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
        """Of the i-th line, τ at its start and the slope."""
        start, end = self._scaled(self.torque[i]), self._scaled(self.torque[i + 1])
        return start, (end - start) / (self.ts[i + 1] - self.ts[i])

    def largest(self) -> Float[Array, ""]:
        return jnp.max(jnp.abs(self._scaled(self.torque)))

    def _scaled(self, torque):
        torque = torque if self.bias is None else torque + self.bias
        return torque if self.inertia is None else torque / self.inertia
