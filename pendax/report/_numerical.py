"""Claims of Suzuki & Suzuki's chapters 5, 6 and 9: numerical solutions and their spectra."""

from functools import cache, partial

import numpy as np

from ._claim import Check, Claim
from ._computed import (
    SIZE,
    TIMES,
    amplitude,
    frequency,
    height,
    lines,
    motion,
    solved,
    solver_error,
    spectrum,
)

CUT = 1.7e-3  # rad; with 1.63e-3 … 1.74e-3 six of the source's seven lists come out

_PANELS = {  # numbers as the source lists them, and for how long they are compared
    "5.2a": ("0.1, 0.2 … 0.5", np.arange(1, 6) / 10, 60),
    "5.2b": ("1.4, 1.5, 1.6", np.array([1.4, 1.5, 1.6]), 60),
    "5.2c": ("1.91, 1.92, 1.93", np.array([1.91, 1.92, 1.93]), 60),
    "5.2d": ("1.982, 1.984 … 1.990", 1.98 + 0.002 * np.arange(1, 6), 60),
    "5.2e": ("1.9992, 1.9993 … 1.9997", 1.9991 + 1e-4 * np.arange(1, 7), 60),
    "5.2f": ("1.99992, 1.99993 … 1.99999", 1.99991 + 1e-5 * np.arange(1, 9), 60),
    "5.2h": ("2.00001, 2.00002 … 2.0001", 2 + 1e-5 * np.arange(1, 11), 60),
    "5.2i": ("2.02, 2.03, 2.04, 2.05, 2.07, 2.08", 2 + np.array([2, 3, 4, 5, 7, 8]) / 100, 60),
    "5.2j": ("2.10, 2.12 … 2.20", 2.08 + 0.02 * np.arange(1, 7), 60),
    "E": ("1.999992, 1.999993 … 1.999999", 1.999991 + 1e-6 * np.arange(1, 9), 100),
    "9": ("0.1, 1, 1.9, 1.999, 2.001, 2.1", np.array([0.1, 1, 1.9, 1.999, 2.001, 2.1]), 100),
}  # fmt: skip


def _curves(panel: str) -> Check:
    _, v0, end = _PANELS[panel]
    ts = np.linspace(0, end, TIMES)
    return Check(solved(v0, ts)[0], motion(v0[:, None], ts)[0], solver_error(v0, end))


def panel_claim(panel: str, id: str, says: str = "NDSolve's θ(t)", **more) -> Claim:
    says = f"{says}, v0 = {_PANELS[panel][0]}"
    return Claim(id, says, "θ(t), rad, solver / closed form", partial(_curves, panel), **more)


def _square_like() -> Check:
    v0 = np.array([0.3, 1.5, 1.92, 1.986, 1.9995, 1.99996])  # one of each of the panels a to f
    share = np.arange(256) / 256
    theta = motion(v0[:, None], 2 * np.pi / frequency(v0)[:, None] * share)[0]
    fill = np.mean(np.abs(theta), -1) / amplitude(v0)  # 2/π for a sine, 1 for a square wave
    return Check(np.ones(5), np.sign(np.diff(fill)), 0)


def _departs() -> Check:
    ts = np.linspace(0, 60, TIMES)
    apart = np.abs(solved([2.0], ts)[0] - motion(2.0, ts)[0])
    return Check(1, apart.max() > 1, 0)


def _increases() -> Check:
    v0 = np.concatenate([_PANELS[f"5.2{panel}"][1] for panel in "hij"])
    theta = solved(v0, np.linspace(0, 60, TIMES))[0]
    return Check(np.ones(v0.size), np.all(np.diff(theta) > 0, -1), 0)


def _orbits() -> Check:
    v0 = np.concatenate([np.arange(10, 20) / 10, 1.9 + np.arange(1, 10) / 100, [1.99, 2, 2.01]])
    theta, v = solved(v0, np.linspace(0, 30, TIMES))
    # Energy drifts by less than 1e-12 a step, 40 steps at most.
    return Check(v * v, v0[:, None] ** 2 - 2 * height(theta, 1.0), 1e-10)


def _bounded() -> Check:
    v0 = np.array([0.5, 1.5, 1.9, 1.97, 1.99, 1.9999, 2.0001, 2.01, 2.2])
    theta = solved(v0, np.linspace(0, 60, TIMES))[0]
    return Check(v0 < 2, np.all(np.abs(theta) < np.pi, -1), 0)


def _highest_omega() -> Check:
    ts = np.arange(SIZE) * (100 / SIZE)  # T = 100 s
    return Check(2 * np.pi / 100 * SIZE, spectrum(ts, np.sin(ts))[0][-1], 1e-9)


def _channels() -> Check:
    ts, v0 = np.arange(SIZE) * (100 / SIZE), np.array([0.2, 1.0, 1.6])
    channel = [np.argmax(spectrum(ts, row)[1]) for row in motion(v0[:, None], ts)[0]]
    # A peak is in the nearest channel.
    return Check(2 * np.pi / 100 * np.asarray(channel), frequency(v0), np.pi / 100)


_LISTS = ((0.5, 1), (1.6, 3), (1.9, 5), (1.981, 7), (1.9962, 9), (1.9991, 13), (1.999995, 17))
_STARTS = np.array([v0 for v0, _ in _LISTS] + [1.9999985, 1.9999999])


@cache
def _above_cut() -> np.ndarray:
    n = np.arange(1, 31)
    found = lines(_STARTS, frequency(_STARTS)) > CUT
    return np.max(np.where(found, n, 0), -1)


def _listed(index: int) -> Claim:
    v0, last = _LISTS[index]
    says = f"v0 = {v0}: odd harmonics up to {last}ω are mainly observed"
    quantity = f"highest harmonic above {CUT} rad, one threshold for all lists"
    wrong = ("S2-29",) if v0 == 1.9991 else ()
    panel = (f"ch6{'abcdefg'[index]}",)
    return Claim("6a-i", says, quantity, lambda: Check(last, _above_cut()[index], 0), panel, wrong)


def _rotating_lines() -> Check:
    return Check(np.zeros(4), lines(2.001, frequency(2.001))[0, :4], CUT)


def _small_limit() -> Check:
    epsilon = np.array([0.25, 1.0, 9.81])
    return Check(np.sqrt(epsilon), frequency(1e-6, epsilon), 1e-12)  # (v0²/ε)/16 relative


def _falling() -> Check:
    return Check(-np.ones(8), np.sign(np.diff(frequency(_STARTS))), 0)


def _fundamental() -> Check:
    # to the spacing of channels of App. D's spectrum
    return Check(1.0, frequency(0.5), np.pi / 1600)


def _on_separatrix() -> Check:
    ts = np.linspace(0, 60, TIMES)
    return Check(solved([2.0], ts)[0][0], motion(2.0, ts)[0], 0.01)  # a line's width in a plot


_CHAPTER_6 = tuple(f"ch6{panel}" for panel in "abcdefghi")
_ORBITS = tuple(f"5.3{panel}" for panel in "abcdef")


CLAIMS = (
    Claim("5.1", "The maximum ω of N data over T is 2πN/T",
          "largest ω of the spectrum, rad/s", _highest_omega, errata=("S2-15",)),
    Claim("5.1", "The spectrum's ω is the channel number times 2π/T",
          "ω of the highest peak, rad/s", _channels),
    Claim("5.1", "θ stays between −π and π for v0 < 2√ε, and is unlimited for v0 > 2√ε",
          "1 where |θ| < π throughout", _bounded),
    *(panel_claim(f"5.2{x}", "5.2a-f", figures=(f"5.2{x}",)) for x in "abcdef"),
    Claim("5.2a-f", "As v0 approaches 2.0, the shape of θ(t) becomes square-like",
          "sign of the change of mean|θ|/θ_max from panel to panel", _square_like,
          ("5.2a", "5.2b", "5.2c", "5.2d", "5.2e", "5.2f")),
    Claim("5.2g", "v0 = 2: the numerical result does not agree with the theory, may be wrong",
          "1 if the solver's θ departs by more than 1 rad", _departs, ("5.2g",), ("S2-30",)),
    *(panel_claim(f"5.2{x}", f"5.2{x}", figures=(f"5.2{x}",)) for x in "hij"),
    Claim("5.2h", "For v0 > 2 the value of θ increases with increasing t: it rotates",
          "1 where θ only increases", _increases, ("5.2h", "5.2i", "5.2j")),
    Claim("5.3a-f", "The orbits v(θ) for v0 = 1.0 … 1.99, 2.0 and 2.01",
          "v², (rad/s)², of the solver's orbit / of its energy", _orbits, _ORBITS),
    *(_listed(index) for index in range(7)),
    Claim("6a-i", "v0 = 0.5: the fundamental harmonic is observed at ω = 1 (caption)",
          "ω, rad/s", _fundamental, ("ch6a",), ("S2-28",)),
    Claim("6a-i", "In the small limit of v0, ω0 = √ε", "ω, rad/s", _small_limit),
    Claim("6a-i", "The frequency of the fundamental mode rapidly decreases towards v0 = 2",
          "sign of the change of ω from panel to panel", _falling, _CHAPTER_6),
    Claim("6j", "v0 = 2.001: the motion is no more an oscillatory one, the spectrum has no lines",
          "amplitudes of the lines ω, 2ω, 3ω, 4ω, rad", _rotating_lines, ("ch6j",), ("S2-31",)),
    panel_claim("9", "9", "Numbers agree excellently with the exact solutions"),
    Claim("9", "Numbers agree excellently with the exact solutions, v0 = 2 included",
          "θ(t), rad, solver / closed form, v0 = 2", _on_separatrix, ("5.2g",), ("S2-30",)),
)  # fmt: skip
