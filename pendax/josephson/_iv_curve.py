"""Voltage over current, swept up and down."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._arrays import common, concrete, whole, widened
from ..fate._mean_velocity import of_lanes
from ._driven import driven
from ._first_order import mean_voltage
from ._junction import JosephsonJunction, positive, require_amperes, require_junction

FloatArray = Float[Array, "..."]


class IVCurve(eqx.Module):
    """Voltages, V, at currents, A, on the way up and on the way down.

    Both have the shape of the lanes followed by that of `current`, and are in its order.
    `error_up` and `error_down`: with a drive, the uncertainty of the averages, V; else `None`.
    """

    current: Float[Array, "*currents"]
    voltage_up: Float[Array, "*lanes_and_currents"]
    voltage_down: Float[Array, "*lanes_and_currents"]
    error_up: Float[Array, "*lanes_and_currents"] | None = None
    error_down: Float[Array, "*lanes_and_currents"] | None = None


def iv_curve(
    junction: JosephsonJunction,
    current: ArrayLike,
    *,
    drive: tuple[ArrayLike, ...] | None = None,
    periods: int = 512,
) -> IVCurve:
    """The I–V curve of a junction that a current source sweeps, with its hysteresis.

    Without a drive these are the two branches of a loop from beyond −Ic to beyond Ic and
    back, whatever part of it `current` shows: on the way up the voltage is 0 from −Ir to Ic, on the
    way down from Ir to −Ic, ends included, with Ir = Ic τ_r(β) the retrapping current
    ([`retrapping_torque`][]); elsewhere it is that of the running state
    ([`mean_velocity`][]).  Hysteresis ends where β_c = 1/β*² = 0.7026; near the critical current
    of an overdamped junction, V = R √(I² − Ic²).

    **Arguments:**

    - `junction`: its leaves, and the drive's, broadcast; they are the lanes: n capacitances, shape
      (n,), give voltages of shape (n, currents).
    - `current`: I, A, a number or one axis, rising or falling.
    - `drive`: (amplitude, frequency) in A and Hz of a current A sin 2πft besides I.
    - `periods`: of the drive, that are averaged where a junction with capacitance does not lock.

    **With a drive** Shapiro's steps appear at V = n h f/2e.  A first-order junction's mean
    voltage follows exactly from a single period, up and down alike.  With a capacitance the
    current goes through its values in the order of the sweep, and the junction goes on from where
    it was; at the first current it starts at rest, or with V = R I where |I| > Ic.
    Once it repeats itself from period to period, or in two, three or four of them, it is locked,
    and the voltage exact, but for what its error says: a passage so slow that it looks the same.
    Elsewhere it is averaged over `periods`, after perturbations have decayed.  This takes longest,
    a minute for 50 currents, for β_c of 0.001 to 0.01: leave such a capacitance out.

    **Raises:** `ValueError` for currents that are neither rising nor falling, and for
    orders of magnitude that only a wrong unit explains: currents beyond 1000 Ic or all below
    Ic/100, frequencies with h f/2e below 1e-4 Ic R (where the voltage is the average of the curve
    without a drive along a period) or above 1e4 Ic R.  Under a transformation currents are
    not checked, and frequencies out of range, infinities, and parameters that are not positive
    give NaN.  NaN, too, is what takes too long: a period of more than 2 million steps, some
    (|I| + A + Ic)/Ic > 4e5 (h f/2e)/(Ic R), and perturbations that take more than a million
    periods to decay.

    **Accuracy:** without a drive 1e-13 of |V| + Σ |x ∂V/∂x| over the current, Ic, R and C, which
    is 1e-13 relative but next to Ir.  Differentiable in all of these, in every mode
    and order; the jumps at Ic and Ir have no derivative, and are left out.  With a drive as
    `error_up` and `error_down` say; derivatives of a first-order junction everywhere,
    those of one with capacitance on steps, and NaN between them, where an average over
    a finite time has none that converges.  Suzuki & Suzuki §8.3.
    """
    require_junction(junction)
    (current,) = common(current=current)
    if current.ndim > 1:
        raise ValueError(
            f"Argument `current` must have one axis at most, but got shape {current.shape}."
        )
    _require_sweep(current, junction)
    periods = whole("periods", periods, 16)
    if drive is None:
        return autonomous(junction, current)
    return IVCurve(current, *driven(junction, current, drive, periods))


@jax.jit
def autonomous(junction: JosephsonJunction, current: FloatArray) -> IVCurve:
    """Without a drive, of whatever currents in any order."""
    lanes = common(**junction.parameters())
    # The current behind the axes of the lanes.
    behind = {str(i): x.reshape(x.shape + (1,) * current.ndim) for i, x in enumerate(lanes)}
    return IVCurve(current, *widened(_branches)(*common(current=current, **behind)))


def running_voltage(
    current: FloatArray, critical: FloatArray, resistance: FloatArray, *beta: FloatArray
) -> FloatArray:
    """V of the running state, 0 where there is none; arrays of one shape."""
    critical = critical * positive(critical, resistance, *beta)
    if beta:
        v = of_lanes(*(x.ravel() for x in (beta[0], current / critical)))
        running = critical * resistance * (beta[0] * v.reshape(current.shape))
    else:
        running = mean_voltage(current, critical, resistance)
    return jnp.where(jnp.isfinite(current), running, jnp.nan)


def _branches(current: FloatArray, critical: FloatArray, resistance: FloatArray, *beta: FloatArray):
    running = running_voltage(current, critical, resistance, *beta)
    # Coming from zero current, it rests up to the critical one.
    rests = jnp.abs(current) <= critical
    up = jnp.where(rests & (current > 0), 0 * running, running)
    down = jnp.where(rests & (current < 0), 0 * running, running)
    return up, down


def _require_sweep(current: FloatArray, junction: JosephsonJunction) -> None:
    seen, unit = concrete(current), concrete(junction.critical_current)
    if seen is None or seen.size == 0:
        return
    known = seen[~np.isnan(seen)]
    steps = np.diff(known)
    if (steps > 0).any() and (steps < 0).any():
        raise ValueError(
            "Argument `current` must rise or fall throughout, as a sweep does, but it rises to "
            f"{known[1:][steps > 0][0]:.6g} A and falls to {known[1:][steps < 0][0]:.6g} A. "
            "Sort it; both branches are given at every current."
        )
    require_amperes(current, junction)
    if unit is None or unit.size == 0 or known.size < 2 or not np.any(known):
        return
    share = np.max(np.abs(known)) / np.min(unit)
    if share < 0.01:
        raise ValueError(
            "Argument `current` must be in A, as the junction's `critical_current`, but it stays "
            f"below {share:.3g} of that."
        )
