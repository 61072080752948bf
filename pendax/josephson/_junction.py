"""A Josephson junction in SI units, and the pendulum that moves as its phase does."""

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._arrays import NUMBERS, aligned, common, concrete, inexact, require
from .._pendulum import Pendulum, as_pytree
from ..fate import retrapping_torque
from ._first_order import phase_after

FloatArray = Float[Array, "..."]

_PLANCK, _CHARGE = 6.62607015e-34, 1.602176634e-19  # J s and C, exact since 2019
FLUX_QUANTUM = _PLANCK / (2 * _CHARGE)  # h/2e, V s
REDUCED = FLUX_QUANTUM / (2 * np.pi)  # ħ/2e


class Evolution(eqx.Module):
    """Phase, rad, unwrapped, and voltage, V, at the times `ts`, s.

    `phase` and `voltage` have the shape of the lanes followed by that of `ts`.
    """

    ts: Float[Array, "*times"]
    phase: Float[Array, "*lanes_and_times"]
    voltage: Float[Array, "*lanes_and_times"]


class JosephsonJunction(eqx.Module):
    """A junction with its resistance and, perhaps, its capacitance in parallel (RCSJ, RSJ).

    Its phase φ obeys I = (ħC/2e) φ̈ + (ħ/2eR) φ̇ + Ic sin φ, a pendulum's equation
    (Suzuki & Suzuki §8.3):

    | junction | pendulum |
    |---|---|
    | phase difference φ | angle θ |
    | voltage V = (ħ/2e) φ̇ | angular velocity θ̇ |
    | current I | torque T |
    | supercurrent Ic sin φ | gravity's torque m g l sin θ |
    | critical current Ic | critical torque m g l |
    | capacitance, ħC/2e | moment of inertia m l² |
    | conductance, ħ/2eR | damping η |
    | plasma frequency ω_p = √(2e Ic/ħC) | small-angle frequency √ε |
    | time in 1/ω_p: β = 1/(ω_p R C) = 1/√β_c, τ = I/Ic | ε = 1 |

    **Arguments:**

    - `critical_current`: Ic > 0, A.
    - `resistance`: R > 0, Ω.
    - `capacitance`: C > 0, F.  `None`: the first-order (RSJ, overdamped) junction, whose
      programs have no second-order term.

    Arrays are junctions side by side; their shapes broadcast.

    **Raises:** `ValueError` for what is not positive, and for what no superconductor has but a
    wrong unit gives: Ic > 10 A, Ic R > 1 V (a gap is below 0.1 V), C > 1 µF.  Under a
    transformation what is not positive gives NaN in its own lane.
    """

    critical_current: FloatArray
    resistance: FloatArray
    capacitance: FloatArray | None

    def __init__(
        self,
        critical_current: ArrayLike,
        resistance: ArrayLike,
        capacitance: ArrayLike | None = None,
    ):
        given = {"critical_current": critical_current, "resistance": resistance}
        given |= {} if capacitance is None else {"capacitance": capacitance}
        for name, x in given.items():
            require(name, x, "positive", lambda x: (x > 0) & np.isfinite(x))
        if all(isinstance(x, NUMBERS) for x in given.values()):
            aligned(**given)
        _require_si(critical_current, resistance, capacitance)
        self.critical_current = inexact(critical_current)
        self.resistance = inexact(resistance)
        self.capacitance = inexact(capacitance)

    @property
    def characteristic_voltage(self) -> FloatArray:
        """Ic R, V."""
        current, resistance, _ = self._leaves()
        return current * resistance

    @property
    def stewart_mccumber(self) -> FloatArray:
        """β_c = 2e Ic R² C/ħ; 0 without a capacitance."""
        current, resistance, capacitance = self._leaves()
        if capacitance is None:
            return jnp.zeros_like(current * resistance)
        # In this order nothing leaves the range of float32.
        return (current * resistance) * (resistance * (capacitance * (1 / REDUCED)))

    @property
    def damping(self) -> FloatArray:
        """β = 1/√β_c of the pendulum with ε = 1; infinite without a capacitance."""
        return jax.lax.rsqrt(self.stewart_mccumber)

    @property
    def plasma_frequency(self) -> FloatArray:
        """ω_p = √(2e Ic/ħC), rad/s; infinite without a capacitance."""
        current, _, capacitance = self._leaves()
        if capacitance is None:
            return jnp.full_like(current, jnp.inf)
        return jnp.sqrt(current * (1 / REDUCED)) * jax.lax.rsqrt(capacitance)

    @property
    def retrapping_current(self) -> FloatArray:
        """Ir = Ic τ_r(β), A, where a falling current loses the voltage; Ic without hysteresis."""
        current, _, capacitance = self._leaves()
        return current if capacitance is None else current * retrapping_torque(self.damping)

    def pendulum(self, current: ArrayLike | Callable) -> Pendulum:
        """The scene ε = 1, β = 1/√β_c, τ = I/Ic, whose time is ω_p t.

        **Arguments:** `current` I, A, a number or a function of the time in s.

        **Raises:** `ValueError` for a junction without capacitance: its motion has no second
        derivative; [`JosephsonJunction.evolve`][] is for it.
        """
        if self.capacitance is None:
            raise ValueError(
                "A junction without `capacitance` is no pendulum: the equation of its phase is "
                "of first order. `evolve` has its phase and voltage over time."
            )
        if callable(current):
            torque = jax.tree_util.Partial(
                _relative, as_pytree(current), self.plasma_frequency, self.critical_current
            )
            return Pendulum(1.0, self.damping, torque)
        require_amperes(current, self)
        unit, i = aligned(critical_current=self.critical_current, current=current)
        return Pendulum(1.0, self.damping, i / unit)

    def voltage(self, velocity: ArrayLike) -> FloatArray:
        """V = (ħ/2e) ω_p θ̇ = β Ic R θ̇, V, of the pendulum's θ̇ (time in 1/ω_p)."""
        unit, v = aligned(unit=self._unit(), velocity=velocity)
        return unit * v

    def velocity(self, voltage: ArrayLike) -> FloatArray:
        """θ̇ of the pendulum (time in 1/ω_p) at a voltage V, V."""
        unit, volts = aligned(unit=self._unit(), voltage=voltage)
        return volts / unit

    def evolve(self, ts: ArrayLike, current: ArrayLike, phase0: ArrayLike = 0.0) -> Evolution:
        """Phase and voltage of a first-order junction over time, in closed form.

        **Arguments:** `ts`, s, of any shape and either sign; `current` I, A, constant; `phase0`,
        rad, at t = 0.  The junction's leaves, `current` and `phase0` broadcast: they are the lanes.

        **Returns:** an [`Evolution`][], lanes first.  Running (|I| > Ic), relaxing, and I = Ic
        between them are one analytic function.

        **Raises:** `ValueError` for a junction with capacitance, whose motion is that of
        [`simulate`][]`(junction.pendulum(current), plasma_frequency * ts, …)`; for currents beyond
        1000 Ic, which are no amperes.

        **Accuracy:** some eps of |f| + Σ |x ∂f/∂x|.  φ is twice the argument of
        cosh λs + (iτ + e^(−iφ0)) sinh(λs)/2λ, 4λ² = 1 − τ², s = 2e Ic R t/ħ; V is its derivative.
        """
        if self.capacitance is not None:
            raise ValueError(
                "A junction with `capacitance` has no closed form: follow it by "
                "simulate(junction.pendulum(current), junction.plasma_frequency * ts, v0); its "
                "voltage is junction.voltage(run.v)."
            )
        require_amperes(current, self)
        (ts,) = common(ts=ts)
        lanes = common(
            critical_current=self.critical_current,
            resistance=self.resistance,
            current=current,
            phase0=phase0,
        )
        shape = lanes[0].shape
        behind = {str(i): x.reshape(shape + (1,) * ts.ndim) for i, x in enumerate(lanes)}
        ts, unit, ohms, i, phase0 = aligned(ts=ts, **behind)
        volts = unit * ohms * positive(unit, ohms)
        phase, rate = phase_after(i / unit, volts * (ts * (1 / REDUCED)), phase0)
        return Evolution(ts.reshape(ts.shape[len(shape) :]), phase, volts * rate)

    def _unit(self) -> FloatArray:
        if self.capacitance is None:
            raise ValueError("A junction without `capacitance` is no pendulum.")
        return self.characteristic_voltage * self.damping

    def parameters(self) -> dict[str, FloatArray]:
        """Ic, R and, with a capacitance, β."""
        given = {"critical_current": self.critical_current, "resistance": self.resistance}
        return given if self.capacitance is None else given | {"damping": self.damping}

    def _leaves(self) -> list:
        """Of one rank and dtype."""
        leaves = {"critical_current": self.critical_current, "resistance": self.resistance}
        if self.capacitance is None:
            return [*aligned(**leaves), None]
        return aligned(**leaves, capacitance=self.capacitance)


def positive(*arrays: FloatArray) -> FloatArray:
    """A factor 1, or NaN where one of them isn't positive, or is infinite."""
    factor = jnp.ones_like(arrays[0])
    for x in arrays:
        factor = jnp.where((x > 0) & (x < jnp.inf), factor, jnp.nan)
    return factor


def require_junction(junction: object) -> None:
    if not isinstance(junction, JosephsonJunction):
        raise ValueError(
            f"Argument `junction` must be a JosephsonJunction, but got {type(junction).__name__}."
        )
    junction._leaves()  # numbers, and of shapes that broadcast


def require_amperes(current: object, junction: JosephsonJunction) -> None:
    """ValueError for currents that are so large, in units of Ic, that they can't be in A."""
    seen, unit = concrete(current), concrete(junction.critical_current)
    if seen is None or unit is None or not np.issubdtype(seen.dtype, np.number):
        return
    known, unit = np.abs(seen[np.isfinite(seen)]), unit[unit > 0]
    if known.size and unit.size and known.max() > 1000 * unit.max():
        raise ValueError(
            "Argument `current` must be in A, as the junction's `critical_current`, but it reaches "
            f"{known.max() / unit.max():.3g} times that."
        )


def _require_si(critical_current, resistance, capacitance) -> None:
    """ValueError for orders of magnitude that only a wrong unit explains."""
    require("critical_current", critical_current, "in A, 10 at most", lambda x: x <= 10)
    require("capacitance", capacitance, "in F, 1e-6 at most", lambda x: x <= 1e-6)
    current, ohms = concrete(critical_current), concrete(resistance)
    if current is not None and ohms is not None:
        volts = np.max(np.asarray(current * ohms, float), initial=0.0)
        if volts > 1:
            raise ValueError(
                "Arguments `critical_current` and `resistance` must be in A and Ω, with a product "
                f"of 1 V at most (superconductors stay below 0.1 V), but got {volts:.6g} V."
            )


def _relative(current: Callable, plasma_frequency: FloatArray, critical_current: FloatArray, t):
    return current(t / plasma_frequency) / critical_current
