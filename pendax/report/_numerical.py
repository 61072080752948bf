"""Claims of Suzuki & Suzuki's chapters 5, 6 and 9: numerical solutions and their spectra."""

from functools import cache, partial

import numpy as np

from ._claim import Check, Claim
from ._computed import (
    SIZE,
    TIMES,
    amplitude,
    complete,
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
    listed, _, end = _PANELS[panel]
    says, quantity = f"{says}, v0 = {listed}", f"θ(t), rad, solver / closed form, t = 0 … {end}"
    return Claim(id, says, quantity, partial(_curves, panel), **more)


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


_ORBITS = {
    "a": ("1.0, 1.1 … 1.5", np.arange(10, 16) / 10, 30),
    "b": ("1.6, 1.7, 1.8, 1.9", np.arange(16, 20) / 10, 30),
    "c": ("1.91, 1.92 … 1.97", np.arange(191, 198) / 100, 30),
    "d": ("1.980, 1.981 … 1.990", np.arange(1980, 1991) / 1000, 30),
    "e": ("2.0", np.array([2.0]), 12),
    "f": ("2.01", np.array([2.01]), 30),
}


def _orbit(panel: str) -> Check:
    _, v0, end = _ORBITS[panel]
    theta, v = solved(v0, np.linspace(0, end, TIMES))
    energy = v0[:, None] ** 2 - 2 * height(theta, 1.0)
    # Energy drifts by less than 1e-12 a step, 40 steps at most.
    return Check(v * v, energy, 1e-10)


def _reach(panel: str) -> Check:
    _, v0, end = _ORBITS[panel]
    far = np.max(np.abs(solved(v0, np.linspace(0, end, TIMES))[0]), -1)
    # beside the separatrix 4 e⁻¹² is left, 2e-5
    return Check(np.sign(v0 - 2), np.where(np.abs(far - np.pi) < 1e-4, 0, np.sign(far - np.pi)), 0)


def _orbit_claims(panel: str) -> tuple[Claim, Claim]:
    listed, _, end = _ORBITS[panel]
    which = {"e": "nears ±π", "f": "is open"}.get(panel, "is closed, |θ| < π")
    id, figures, says = "5.3a-f", (f"5.3{panel}",), f"({panel}) v0 = {listed}: the orbit v(θ)"
    quantity = f"v², (rad/s)², of the solver's orbit / of its energy, t = 0 … {end}"
    sign = f"sign of the largest |θ| − π, 0 within 1e-4, t = 0 … {end}"
    return (
        Claim(id, says, quantity, partial(_orbit, panel), figures),
        Claim(id, f"{says} {which} (read with §5.1)", sign, partial(_reach, panel), figures),
    )


def _bounded() -> Check:
    v0 = np.array([0.5, 1.5, 1.9, 1.97, 1.99, 1.9999, 2.0001, 2.01, 2.2])
    theta = solved(v0, np.linspace(0, 60, TIMES))[0]
    return Check(v0 < 2, np.all(np.abs(theta) < np.pi, -1), 0)


def _highest_omega() -> Check:
    ts = np.arange(SIZE) * (100 / SIZE)  # T = 100 s
    sampling = 2 * np.pi / 100 * SIZE
    return Check(sampling, spectrum(ts, np.sin(ts))[0][-1], 1e-9, sampling / 2)


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
    quantity = f"highest line, cut at {CUT} rad, chosen so that six of the seven lists come out"
    wrong, corrected = (("S2-29",), 11) if v0 == 1.9991 else ((), None)
    panel = (f"ch6{'abcdefg'[index]}",)

    def check() -> Check:
        return Check(last, _above_cut()[index], 0, corrected)

    return Claim("6a-i", says, quantity, check, panel, wrong)


def _rotating_lines() -> Check:
    n, m = np.arange(1, 5), (2 / 2.001) ** 2
    corrected = 2 / (n * np.cosh(n * np.pi * complete(1 - m) / complete(m)))
    return Check(np.zeros(4), lines(2.001, frequency(2.001))[0, :4], CUT, corrected)


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


CLAIMS = (
    Claim("5.1", "The maximum ω of N data over T is 2πN/T",
          "largest ω of the spectrum, rad/s, N = 1024, T = 100 s", _highest_omega,
          errata=("S2-15",)),
    Claim("5.1", "The spectrum's ω is the channel number times 2π/T",
          "ω of the highest peak, rad/s, v0 = 0.2, 1, 1.6, T = 100 s", _channels),
    Claim("5.1", "θ stays between −π and π for v0 < 2√ε, and is unlimited for v0 > 2√ε",
          "1 where |θ| < π for t = 0 … 60, v0 = 0.5 … 1.9999 and 2.0001, 2.01, 2.2", _bounded),
    *(panel_claim(f"5.2{x}", "5.2a-f", figures=(f"5.2{x}",)) for x in "abcdef"),
    Claim("5.2a-f", "As v0 approaches 2.0, the shape of θ(t) becomes square-like",
          "sign of the change of mean|θ|/θ_max from panel to panel", _square_like,
          ("5.2a", "5.2b", "5.2c", "5.2d", "5.2e", "5.2f")),
    Claim("5.2g", "v0 = 2: the numerical result does not agree with the theory, may be wrong",
          "1 if the solver's θ departs by more than 1 rad up to t = 60", _departs, ("5.2g",),
          ("S2-30",)),
    *(panel_claim(f"5.2{x}", f"5.2{x}", figures=(f"5.2{x}",)) for x in "hij"),
    Claim("5.2h", "For v0 > 2 the value of θ increases with increasing t: it rotates",
          "1 where θ only increases, t = 0 … 60, the 22 v0", _increases, ("5.2h", "5.2i", "5.2j")),
    *(claim for panel in _ORBITS for claim in _orbit_claims(panel)),
    *(_listed(index) for index in range(7)),
    Claim("6a-i", "v0 = 0.5: the fundamental is observed at ω = 1 (caption; in the text ω ≈ 1)",
          "ω, rad/s, to a channel of Appendix D's spectrum", _fundamental, ("ch6a",), ("S2-28",)),
    Claim("6a-i", "In the small limit of v0, ω0 = √ε", "ω, rad/s, v0 = 1e-6, ε = 0.25, 1, 9.81",
          _small_limit),
    Claim("6a-i", "The frequency of the fundamental mode rapidly decreases towards v0 = 2",
          "sign of the change of ω from panel to panel", _falling, _CHAPTER_6),
    Claim("6j", "v0 = 2.001: the motion is no more an oscillatory one, the spectrum has no lines",
          "amplitudes of the lines ω, 2ω, 3ω, 4ω of θ − ωt, rad", _rotating_lines, ("ch6j",),
          ("S2-31",)),
    panel_claim("9", "9", "Numbers agree excellently with the exact solutions"),
    Claim("9", "Numbers agree excellently with the exact solutions (read with v0 = 2 of §5.2 (g))",
          "θ(t), rad, solver / closed form, v0 = 2, t = 0 … 60", _on_separatrix, ("5.2g",),
          ("S2-30",)),
)  # fmt: skip
