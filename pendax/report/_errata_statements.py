"""Statements and programs of Suzuki & Suzuki that do not hold, each beside what is found."""

from functools import lru_cache

import numpy as np

from .. import Pendulum, critical_torque, frequency, harmonics, mean_velocity, settle, simulate
from .. import tension as tension_of
from ._claim import Erratum, Proof
from ._computed import integral, jacobi, solved
from ._errata_formulas import SOLVED

_LAST, _SAMPLES = 1600.0, 32768  # s; the record of appendix D
_BIN = 2 * np.pi / _LAST
_SHOWN = np.array([0.5, 1.6, 1.9, 1.981, 1.9962, 1.999995, 1.9991])  # v0 of chapter 6 (a)–(g)
_OBSERVED = np.array([1, 3, 5, 7, 9, 17, 13])  # and the highest harmonic listed
_THROWN = np.array([2.40, 2.60, 2.80, 2.95, 3.15])  # v0 of §8.2.3 (e)–(i), the second (e)
_TORQUES = np.arange(-1, 41) / 100  # as its heading has them; its text starts at 0.01
_NEAR = np.arange(7900, 8001) / 1e4  # torques around the change-over of v0 = 0.2
_RUNNING = np.array([0.21, 0.22, 0.3, 0.5, 0.9])  # torques under which v0 = 1.98 runs


@lru_cache
def _ends() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The well for β = 0.04; those of §8.2.3, NaN for running; whether v0 = 0.2 is captured."""
    v0, tau = (x.ravel() for x in np.broadcast_arrays(_THROWN[:, None], _TORQUES))
    v0 = np.concatenate([[2.3], v0, np.full(_NEAR.size, 0.2)])
    tau = np.concatenate([[0.0], tau, _NEAR])
    end = settle(Pendulum(1.0, np.where(v0 == 2.3, 0.04, 0.16), tau), v0)
    well = np.where(np.asarray(end.running) == 0, end.well, np.nan)
    grid = well[1 : 1 + _THROWN.size * _TORQUES.size].reshape(_THROWN.size, -1)
    return well[:1], grid, np.isfinite(well[-_NEAR.size :])


@lru_cache
def _late() -> tuple[np.ndarray, np.ndarray]:
    """Of β = 0.16: the mean velocity of the running motions, and where three others rest."""
    import diffrax

    tau = np.append(_RUNNING, [0.05, 0.10, 0.20])
    v0 = np.append(np.full(_RUNNING.size, 1.98), _THROWN[[0, 1, 4]])
    solver, pendulum = diffrax.Dopri8(), Pendulum(1.0, 0.16, tau)
    run = simulate(pendulum, np.array([400.0, 800.0]), v0, solver=solver, rtol=1e-12, atol=1e-12)
    theta = np.asarray(run.theta)
    return np.diff(theta[: _RUNNING.size, :])[:, 0] / 400, theta[_RUNNING.size :, 1]


@lru_cache
def _power() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Spectra as in appendix D of v0 = 1.92, of the same and of `_SHOWN` with whole periods in
    the record, and of v0 = 2.001 less its mean rotation; v0 and the numbers of periods."""
    v0 = np.concatenate([[1.92, 1.92], _SHOWN, [2.001]])
    periods = np.asarray(frequency(Pendulum(), v0)) / _BIN
    whole = np.append(periods[0], np.round(periods[1:]))
    pace = whole / periods  # another ε changes the pace and leaves the shape
    ts = np.arange(_SAMPLES) * _LAST / _SAMPLES
    theta = np.array(simulate(Pendulum(pace**2), ts, v0 * pace).theta)
    theta[-1] -= whole[-1] * _BIN * ts
    return np.abs(np.fft.rfft(theta)) ** 2 / _SAMPLES, v0, whole


def _lines(lane: int, n: np.ndarray) -> np.ndarray:
    """Amplitudes of the n-th harmonics, rad, in a record of whole periods."""
    power, _, whole = _power()
    return 2 * np.sqrt(power[lane, n * int(whole[lane])] / _SAMPLES)


def _pushed() -> Proof:
    v0, ts = np.array([[2.01], [2.10], [2.20]]), np.array([1.9, 2.0, 2.2, 2.3])
    theta, v = solved(v0, ts)
    *_, am = jacobi(v0 / 2 * ts, (2 / v0) ** 2)
    right = v0**2 - 2 + 3 * np.cos(2 * am)  # in units of mg; a string has 0 at least
    return Proof(0.0, right, tension_of(Pendulum(), theta, v, 1.0, 1.0), SOLVED)


def _well_at_004() -> Proof:
    return Proof(1, 2, _ends()[0], 0.1)


def _lowest_wells() -> Proof:
    return Proof(0, 1, np.nanmin(_ends()[1], -1)[:4], 0.1)


def _lowest_well_at_315() -> Proof:
    return Proof(0, 2, np.nanmin(_ends()[1][4:, 2:], -1), 0.1)


def _resting_angles() -> Proof:
    tau = np.array([0.05, 0.10, 0.20])
    wells = 2 * np.pi * _ends()[1][[0, 1, 4], np.searchsorted(_TORQUES, tau - 0.005)]
    return Proof(wells, wells + np.arcsin(tau), _late()[1], SOLVED)


def _last_captured() -> Proof:
    found = critical_torque(Pendulum(1.0, 0.16), np.array([0.2]))
    return Proof(0.6, found, np.max(_NEAR[_ends()[2]], keepdims=True), 1e-4)


def _mean_velocities(which: slice) -> Proof:
    found = np.asarray(mean_velocity(Pendulum(1.0, 0.16, _RUNNING)))
    return Proof(0.0, found[which], _late()[0][which], 0.016)  # half a turn in 400 s


def _fundamental() -> Proof:
    end = np.array([np.pi / 2])
    quarter = integral(lambda u: 1 / np.sqrt(1 - (0.25 * np.sin(u)) ** 2), end)
    return Proof(1.0, frequency(Pendulum(), 0.5), np.pi / 2 / quarter, _BIN)


def _highest_above_the_cut() -> Proof:
    n = np.arange(1, 22, 2)
    found = np.stack([_lines(lane, n) for lane in range(2, 2 + _SHOWN.size)])
    seen = np.arange(_SHOWN.size), _OBSERVED // 2
    after = seen[0], seen[1] + 1
    cut = np.sqrt(np.min(found[seen][:-1]) * np.max(found[after][:-1]))  # of the other six lists
    return Proof(_OBSERVED[-1], 11, np.max(n[found[-1] > cut], keepdims=True), 0.5)


def _separatrix() -> Proof:
    w0, ts = np.array([[1.0], [2.0], [3.0]]), np.array([40.0, 50.0, 60.0, 80.0])
    computed, _ = solved(2 * w0, ts, 0.0, w0**2)
    theory = 4 * np.arctan(np.exp(w0 * ts)) - np.pi
    *_, am = jacobi(w0 * ts, np.array(1.0))
    farthest = (np.max(np.abs(x - np.pi), -1) for x in (computed, theory, 2 * am))
    printed, right, truth = farthest
    return Proof(printed, right, truth, SOLVED)


def _lines_of_rotation() -> Proof:
    right = np.asarray(harmonics(Pendulum(), 2.001, count=5).amplitude)
    return Proof(0.0, right, _lines(-1, np.arange(1, 6)), SOLVED)


def _shifted_bins() -> Proof:
    power, v0, whole = _power()
    n = np.array([1, 3, 5])
    ends = np.round(whole[0] * np.stack([n - 0.9, n + 0.9])).astype(int).T
    bins = np.array([low + np.argmax(power[0, low:high]) for low, high in ends])
    truth = n * np.asarray(frequency(Pendulum(), v0[0]))
    return Proof((bins + 1) * _BIN, bins * _BIN, truth, _BIN / 2)


def _leakage() -> Proof:
    power, v0, whole = _power()
    n = np.array([9, 11, 13, 15])
    bins = np.round(n * whole[0]).astype(int)
    amplitude = np.asarray(harmonics(Pendulum(), v0[0], count=15).amplitude)[n - 1]
    truth = _SAMPLES * amplitude**2 / 4
    return Proof(power[0, bins], power[1, n * int(whole[1])], truth, 0.01 * truth)


def _contours() -> Proof:
    v0, ts = np.array([[2.01], [2.10], [2.30]]), np.array([4.0, 9.0, 14.0, 19.0])
    sn, _, _, am = jacobi(v0 / 2 * ts, (2 / v0) ** 2)
    rising = 2 * np.arcsin(sn)[..., None] + 4 * np.pi * np.arange(5)
    drawn = np.concatenate([rising, 2 * np.pi - rising], -1) % (20 * np.pi)
    order = np.argsort(np.abs(drawn - 2 * am[..., None]), -1)
    others = np.take_along_axis(drawn, order[..., 1:], -1)
    theta, _ = solved(v0, ts)
    return Proof(others, 2 * am[..., None], theta[..., None], SOLVED)


def _lost_digits() -> Proof:
    ts = np.array([[15.0, 16.0, 17.0, 18.0]] * 3)
    sn, _, dn, _ = jacobi(ts, np.array(1.0))
    truth = 4 * np.arctan(np.exp(ts)) - np.pi
    return Proof(2 * np.arcsin(sn), 2 * np.arctan2(sn, dn), truth, 1e-14)


# A table, a misprint a row.
# fmt: off
ERRATA: tuple[Erratum, ...] = (
    Erratum("S2-20", "statement", "§1.1", "a stretchable, massless string",
            "unstretchable; and a rod for √2 < v₀/√ε < √5, as in §3, §4.3, §7, §8: it has to push",
            _pushed),
    Erratum("S2-21", "statement", "§7.2", "v₀ = 2.3: n = 1 for β = 0.04",
            "n = 2, as from β = 0.0268873 to 0.0451370", _well_at_004),
    Erratum("S2-22", "statement", "§8.2.3 (e)–(h), v₀ = 2.40, 2.60, 2.80, 2.95",
            "stable points around θ = 0, …",
            "none at n = 0 for τ = −0.01 … 0.40: the lowest is n = 1", _lowest_wells),
    Erratum("S2-23", "statement", "§8.2.3 (i), v₀ = 3.15", "stable points around θ = 0, 2π, …, 12π",
            "for τ = 0.01 … 0.40 n = 2 … 6; n = 1 needs τ < 0.0077623, n = 0 τ < −0.5505",
            _lowest_well_at_315),
    Erratum("S2-24", "statement", "§8.2.3", "stable points around θ = 2πn",
            "θ = 2πn + arcsin τ, 0.20 rad further at τ = 0.20", _resting_angles),
    Erratum("S2-25", "statement", "§8.2.1", "τ = sin θ_s for τ ≤ 0.6, at least for small β and v₀",
            "for every captured state; with β = 0.16, v₀ = 0.2 up to τ_c = 0.7969354203",
            _last_captured),
    Erratum("S2-26", "statement", "§8.2.2", "v₀ = 1.98 changes around τ = 0.21; runs for τ > 0.22",
            "τ_c = 0.2058702779: at 0.21 it runs, with a mean v of 0.928114",
            lambda: _mean_velocities(slice(0, 2))),
    Erratum("S2-27", "statement", "§8.3 (3), (4)", "at rest for τ < τ_c = ε, running above",
            "from rest only; for β < 1.1930459188 it can run from τ_r(β) on, 0.2024279883 at 0.16",
            lambda: _mean_velocities(slice(2, 5))),
    Erratum("S2-28", "statement", "§6 (a), caption", "v₀ = 0.5: the fundamental is at ω = 1",
            "0.9840588759", _fundamental),
    Erratum("S2-29", "statement", "§6 (f)", "v₀ = 1.9991: up to 13ω mainly observed",
            "up to 11ω, by the cut at a_n = 1.7e-3 rad that gives the other lists; a₁₃ = 8.75e-4",
            _highest_above_the_cut),
    Erratum("S2-30", "statement", "§5.2 (g); §9",
            "v₀ = 2: the numerical result does not agree with the theory",
            "the theory is right, π − θ → 4e^(−t); any solver leaves the saddle at t ≈ ln(1/error)",
            _separatrix),
    Erratum("S2-31", "statement", "§6 (j)", "v₀ = 2.001: non-oscillatory",
            "v has the period 2π/0.6492118185; θ − ωt all harmonics, under the ramp's leakage",
            _lines_of_rotation),
    Erratum("S2-40", "program", "App. D, In[4]", "{2π n/1600, Abs[list2[[n]]]^2}, n = 0 … 32768",
            "n − 1, as lists start at 1: lines are 0.003927 rad/s too high, and n = 0 is no number",
            _shifted_bins),
    Erratum("S2-41", "program", "App. D", "tmax = 1600, which is no whole number of periods",
            "whole periods, or a window: the leakage hides the high harmonics", _leakage),
    Erratum("S2-42", "text", "App. E; contents",
            "“Geometry from Graphics” over an NDSolve listing; C.1 … C.5",
            "a listing of §5.2; the appendices are C, D, E, G, H, and there is no F", None),
    Erratum("S2-43", "program", "App. G", "ContourPlot of sin(θ/2) == JacobiSN: all branches",
            "θ = 2 JacobiAmplitude[t/κ, κ²]: one curve of ten", _contours),
    Erratum("S2-44", "program", "§2.3; App. D, In[2]", "2 ArcSin[k sn]",
            "right, but half the digits of π − θ are lost for k → 1: 2 atan2(k sn, dn)",
            _lost_digits),
)
# fmt: on
