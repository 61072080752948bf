"""Statements and programs of Suzuki & Suzuki that do not hold, each beside what is found."""

from functools import lru_cache

import numpy as np

from .. import Pendulum, critical_torque, frequency, harmonics, mean_velocity, settle, simulate
from ._claim import Erratum, Proof
from ._computed import integral, jacobi, motion, solved
from ._errata_formulas import SOLVED, force_on_rod

_LAST, _SAMPLES = 1600.0, 32768  # s; the record of appendix D
_BIN = 2 * np.pi / _LAST
_SHOWN = np.array([0.5, 1.6, 1.9, 1.981, 1.9962, 1.999995, 1.9991])  # v0 of chapter 6 (a)–(g)
_OBSERVED = np.array([1, 3, 5, 7, 9, 17, 13])  # and the highest harmonic listed
_THROWN = np.array([2.40, 2.60, 2.80, 2.95, 3.15])  # v0 of §8.2.3 (e)–(i), the second (e)
_TORQUES = np.arange(-1, 41) / 100  # as its heading has them; its text starts at 0.01
_NEAR = np.arange(7900, 8001) / 1e4  # torques around the change-over of v0 = 0.2
_BELOW = np.arange(2000, 2101) / 1e4  # and of v0 = 1.98
_RUNNING = np.array([0.21, 0.22, 0.3, 0.5, 0.9])  # torques under which v0 = 1.98 runs


@lru_cache
def _ends() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The well for β = 0.04; those of §8.2.3, NaN for running; the last torques of `_NEAR` and of
    `_BELOW` that let the pendulum be captured."""
    v0, tau = (x.ravel() for x in np.broadcast_arrays(_THROWN[:, None], _TORQUES))
    v0 = np.concatenate([[2.3], v0, np.full(_NEAR.size, 0.2), np.full(_BELOW.size, 1.98)])
    tau = np.concatenate([[0.0], tau, _NEAR, _BELOW])
    end = settle(Pendulum(1.0, np.where(v0 == 2.3, 0.04, 0.16), tau), v0)
    well = np.where(np.asarray(end.running) == 0, end.well, np.nan)
    grid = well[1 : 1 + _THROWN.size * _TORQUES.size].reshape(_THROWN.size, -1)
    captured = np.isfinite(well[-_NEAR.size - _BELOW.size :])
    last = np.array([np.max(_NEAR[captured[: _NEAR.size]]), np.max(_BELOW[captured[_NEAR.size :]])])
    return well[:1], grid, last


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
    *_, am = jacobi(v0 / 2 * ts, (2 / v0) ** 2)
    right = v0**2 - 2 + 3 * np.cos(2 * am)  # in units of mg; a string has 0 at least
    return Proof(0.0, right, force_on_rod(v0, ts, 0.0, 1.0), 1e-7)


def _well_at_004() -> Proof:
    return Proof(1, 2, _ends()[0], 0.1)


def _lowest_wells() -> Proof:
    return Proof(0, 1, np.nanmin(_ends()[1], -1)[:4], 0.1)


def _lowest_wells_at_315() -> Proof:
    wells = _ends()[1][4]
    return Proof(0, [1, 2], np.array([np.nanmin(wells[:2]), np.nanmin(wells[2:])]), 0.1)


def _resting_angles() -> Proof:
    tau = np.array([0.05, 0.10, 0.20])
    wells = 2 * np.pi * _ends()[1][[0, 1, 4], np.searchsorted(_TORQUES, tau - 0.005)]
    return Proof(wells, wells + np.arcsin(tau), _late()[1], SOLVED)


def _last_captured() -> Proof:
    found = critical_torque(Pendulum(1.0, 0.16), 0.2)
    return Proof([0.6, 0.8], found, _ends()[2][0], 1e-4)


def _change_over() -> Proof:
    found = critical_torque(Pendulum(1.0, 0.16), 1.98)
    return Proof(0.21, found, _ends()[2][1], 1e-4)


def _mean_velocities() -> Proof:
    found = np.asarray(mean_velocity(Pendulum(1.0, 0.16, _RUNNING)))
    return Proof(0.0, found, _late()[0], 0.016)  # half a turn in 400 s


def _fundamental() -> Proof:
    end = np.array([np.pi / 2])
    quarter = integral(lambda u: 1 / np.sqrt(1 - (0.25 * np.sin(u)) ** 2), end)
    return Proof(1.0, frequency(Pendulum(), 0.5), np.pi / 2 / quarter, 1e-9)


def _highest_above_the_cut() -> Proof:
    n = np.arange(1, 22, 2)
    found = np.stack([_lines(lane, n) for lane in range(2, 2 + _SHOWN.size)])
    seen = np.arange(_SHOWN.size), _OBSERVED // 2
    after = seen[0], seen[1] + 1
    cuts = np.max(found[after][:-1]), 0.999 * np.min(found[seen][:-1])  # of the other six lists
    truth = np.array([np.max(n[found[-1] > cut]) for cut in cuts])
    return Proof(_OBSERVED[-1], 11, np.where(cuts[0] < cuts[1], truth, np.nan), 0.5)


def _separatrix() -> Proof:
    import diffrax

    ts = np.array([5.0, 10.0, 15.0, 20.0])
    options = {"solver": diffrax.Dopri8(), "rtol": 1e-6, "atol": 1e-6}
    gap = np.pi - np.asarray(simulate(Pendulum(), ts, 2.0, **options).theta)
    _, v = motion(2.0, ts)  # 2 cos(θ/2), which loses nothing at the top
    scale = np.exp(ts)
    return Proof(scale * gap, 4 - 4 / 3 / scale**2, scale * 2 * np.arcsin(v / 2), SOLVED)


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
    ts = np.array([15.0, 16.0, 17.0, 18.0])
    sn, _, dn, _ = jacobi(ts, np.array(1.0))
    scale, truth = np.exp(ts), 4 * np.arctan(np.exp(-ts))
    printed, right = np.pi - 2 * np.arcsin(sn), np.pi - 2 * np.arctan2(sn, dn)
    return Proof(scale * printed, scale * right, scale * truth, 1e-6)


# A table, a misprint a row.
# fmt: off
ERRATA: tuple[Erratum, ...] = (
    Erratum("S2-20", "statement", "§1.1", "a stretchable, massless string",
            "unstretchable; and a rod for √2 < v₀/√ε < √5, as in §3, §4.3, §7, §8: it has to push",
            _pushed, "tension/(mg) / from accelerations, v₀ = 2.01, 2.1, 2.2; t = 1.9 … 2.3 s"),
    Erratum("S2-21", "statement", "§7.2", "v₀ = 2.3: n = 1 for β = 0.04", "n = 2", _well_at_004,
            "n, v₀ = 2.3, β = 0.04 1/s"),
    Erratum("S2-22", "statement", "§8.2.3 (e)–(h), v₀ = 2.40, 2.60, 2.80, 2.95",
            "stable points around θ = 0, …",
            "none at n = 0 for τ = −0.01 … 0.40: the lowest is n = 1", _lowest_wells,
            "lowest n, τ = −0.01 … 0.40, v₀ = 2.4, 2.6, 2.8, 2.95, β = 0.16"),
    Erratum("S2-23", "statement", "§8.2.3 (i), v₀ = 3.15", "stable points around θ = 0, 2π, …, 12π",
            "n = 2 … 6 for τ = 0.01 … 0.40; for τ = −0.01 and 0 n = 1; n = 0 for none",
            _lowest_wells_at_315, "lowest n, τ = −0.01, 0 / 0.01 … 0.40, v₀ = 3.15, β = 0.16"),
    Erratum("S2-24", "statement", "§8.2.3", "stable points around θ = 2πn",
            "θ = 2πn + arcsin τ, 0.20 rad further at τ = 0.20", _resting_angles,
            "θ at rest, rad, τ = 0.05, 0.1, 0.2; v₀ = 2.4, 2.6, 3.15, β = 0.16"),
    Erratum("S2-25", "remark", "§8.2.1",
            "around τ = 0.6–0.8; τ = sin θ_s for τ ≤ 0.6, at least for small β and small v₀",
            "both hold; 0.6 is no limit: sin θ_s = τ for every captured state, up to τ_c ≈ 0.797",
            _last_captured, "τ of the change-over, 1/s², β = 0.16, v₀ = 0.2: 0.6, 0.8 / τ_c"),
    Erratum("S2-26", "remark", "§8.2.2", "v₀ = 1.98: around τ = 0.21; v ≠ 0 for τ > 0.22",
            "both hold; but τ_c ≈ 0.206, the change-over, is less than 0.21, and at 0.21 it runs",
            _change_over, "τ of the change-over, 1/s², β = 0.16, v₀ = 1.98: 0.21 / τ_c"),
    Erratum("S2-27", "statement", "§8.3 (2)–(4)",
            "a steady angle up to τ_c = ε; for τ > τ_c it rotates",
            "true from rest only: for small β it can rotate from τ_r(β) < ε on; β = 0.16: at 0.21",
            _mean_velocities, "mean v, rad/s, τ = 0.21, 0.22, 0.3, 0.5, 0.9; v₀ = 1.98, β = 0.16"),
    Erratum("S2-28", "statement", "§6 (a), caption", "v₀ = 0.5: the fundamental is at ω = 1",
            "ω ≈ 0.984", _fundamental, "ω, rad/s, v₀ = 0.5, ε = 1"),
    Erratum("S2-29", "statement", "§6 (f)", "v₀ = 1.9991: up to 13ω mainly observed",
            "up to 11ω, by every cut of the amplitudes that gives the other six lists",
            _highest_above_the_cut, "highest n above the cut, the least / the largest possible"),
    Erratum("S2-30", "remark", "§5.2 (g); §9",
            "v₀ = 2: “does not agree with the theoretical prediction”",
            "it does not, and the theory is right: π − θ → 4e^(−t); a solver's error grows as e^t",
            _separatrix,
            "e^t (π − θ), rad, Dopri8 to 1e-6 / 4 − (4/3) e^(−2t); t = 5, 10, 15, 20 s"),
    Erratum("S2-31", "statement", "§6 (j)", "v₀ = 2.001: non-oscillatory",
            "v has a period; θ − ωt has all harmonics, which the ramp's leakage hides",
            _lines_of_rotation, "amplitudes of n = 1 … 5, rad, of θ − ωt, v₀ = 2.001"),
    Erratum("S2-40", "program", "App. D, In[4]", "{2π n/1600, Abs[list2[[n]]]^2}, n = 0 … 32768",
            "n − 1, as lists start at 1: lines are 2π/1600 rad/s too high, and n = 0 is no number",
            _shifted_bins, "ω of the lines 1, 3, 5, rad/s, v₀ = 1.92"),
    Erratum("S2-41", "program", "App. D", "tmax = 1600, which is no whole number of periods",
            "whole periods, or a window: the leakage hides the high harmonics", _leakage,
            "power, rad², of the lines 9, 11, 13, 15, v₀ = 1.92"),
    Erratum("S2-42", "text", "App. E; contents",
            "“Geometry from Graphics” over an NDSolve listing; C.1 … C.5",
            "a listing of §5.2; the appendices are C, D, E, G, H, and there is no F", None),
    Erratum("S2-43", "program", "App. G", "ContourPlot of Sin[θ/2] == JacobiSN[t/κ, κ²]",
            "draws all branches: θ = 2 JacobiAmplitude[t/κ, κ²] is one curve of ten", _contours,
            "θ(t), rad, the nine others / the one, v₀ = 2.01, 2.1, 2.3; t = 4 … 19 s"),
    Erratum("S2-44", "remark", "§2.3; App. D, In[2]", "θ = 2 ArcSin[k sn]",
            "holds, but half the digits of π − θ are lost for k → 1; 2 atan2(k sn, dn) keeps them",
            _lost_digits, "e^t (π − θ), rad, in float64, k = 1; t = 15, 16, 17, 18 s"),
)
# fmt: on
