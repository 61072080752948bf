"""Claims of Suzuki & Suzuki's sections 2.3 to 2.8: the swing, its period and its largest angle."""

import numpy as np

from .. import fit_critical_law
from ..special import ellipkm1
from ._claim import Check, Claim
from ._computed import (
    amplitude,
    arrival,
    complete,
    elementwise,
    frequency,
    integral,
    jacobi,
    lines,
    motion,
    solved,
    solved_period,
    solver_error,
)
from ._formulation import MODULI

_beside = elementwise(ellipkm1)


def _solution(printed: bool) -> Check:
    epsilon, modulus, t = 4.0, MODULI, np.linspace(0, 15, 31)
    v0 = 2 * modulus * np.sqrt(epsilon)

    def formula(u):
        sn, cn, _, _ = jacobi(u, modulus[:, None] ** 2)
        return np.stack([2 * np.arcsin(modulus[:, None] * sn), v0[:, None] * cn])

    found, right = np.stack(solved(v0, t, 0.0, epsilon)), formula(np.sqrt(epsilon) * t)
    error = 2 * solver_error(2 * modulus, 30)
    return Check(formula(np.sqrt(epsilon * t)) if printed else right, found, error, right)


def _top() -> Check:
    t = np.linspace(0, 6, 25)
    return Check(2 * np.arcsin(np.tanh(t)), solved([2.0], t)[0][0], 1e-8)  # e⁶ · 1e-12, and steps


def _endless() -> Check:
    short = 10.0 ** -np.arange(1, 9)  # of π
    claimed = -np.log(np.tan(short / 4))  # 2 arcsin(tanh u) = π − δ
    rounding = 1e-14 + 1e-15 / short  # of π − δ
    return Check(claimed, arrival(np.pi - short, 2.0), rounding)


_FIG_5 = {
    "5a": ("1.7, 1.75 … 1.95", 1.65 + 0.05 * np.arange(1, 7)),
    "5b": ("1.995, 1.996, 1.997, 1.998", 1.994 + 1e-3 * np.arange(1, 5)),
    "5c": ("1.9990, 1.9992, 1.9994, 1.9996", 1.9988 + 2e-4 * np.arange(1, 5)),
    "5d": ("1.999990, 1.999992 … 1.999998", 1.999988 + 2e-6 * np.arange(1, 6)),
}


def _curves(v0) -> Check:
    t = np.linspace(0, 60, 61)
    modulus = v0[:, None] / 2
    claimed = 2 * np.arcsin(modulus * jacobi(t, modulus**2)[0])
    return Check(claimed, solved(v0, t)[0], solver_error(v0, 60))


def _plotted(name: str, id: str) -> Claim:
    says, v0 = _FIG_5[name]
    says = f"θ(t) = 2 arcsin(k sn(t, k)) for v0 = {says}"
    return Claim(id, says, "θ(t), rad, formula / solver, t = 0 … 60", lambda: _curves(v0), (name,))


_FIG_6 = np.array([0.2, 1.6, 1.92, 1.98, 1.998])


def _sine() -> Check:
    found = lines(0.2, frequency(0.2))[0]
    return Check(np.zeros(5), found[1:6] / found[0], 1e-3)  # a thousandth of the sine


def _growth() -> Check:
    found = lines(_FIG_6, frequency(_FIG_6))
    return Check(np.ones((4, 4)), np.sign(np.diff(found[:, 2:9:2] / found[:, :1], axis=0)), 0)


def _square_wave() -> Check:
    v0 = 2.0 - np.array([1e-12, 1e-15])
    quarter = 0.5 * np.pi / frequency(v0)
    area = integral(lambda t: motion(v0[:, None], t)[0], quarter) / amplitude(v0)
    # mean|θ|/θ_max is 1 − c/K up to terms of the order of √(2 − v0)
    return Check(1.0, np.diff(area)[0] / np.diff(quarter)[0], 1e-5)


def _odd_only() -> Check:
    found = lines(_FIG_6, frequency(_FIG_6))
    return Check(np.zeros((5, 15)), found[:, 1::2] / found[:, :1], 1e-12)


_FIG_7 = np.concatenate([1.8 + 0.05 * np.arange(4), 1.96 + 0.01 * np.arange(4)])


def _closed() -> Check:
    period = 2 * np.pi / frequency(_FIG_7)
    theta, v = solved(_FIG_7, period[:, None] * np.array([1.0, 2.0]))
    tolerance = solver_error(_FIG_7, 30) * np.ones(2)
    return Check(np.stack([0 * v, _FIG_7[:, None] + 0 * v]), np.stack([theta, v]), tolerance)


def _ellipse() -> Check:
    t, m = np.linspace(0, 30, 61), (_FIG_7[:, None] / 2) ** 2
    sn, cn, _, _ = jacobi(t, m)
    claimed = np.stack([2 * np.arcsin(np.sqrt(m) * sn), _FIG_7[:, None] * cn])
    return Check(claimed, np.stack(solved(_FIG_7, t)), solver_error(_FIG_7, 30))


_FIG_8 = np.array([0.2, 0.6, 1.0, 1.4, 1.8, 1.9, 1.95, 1.98, 1.99, 1.995, 1.998, 1.999])


def _period() -> Check:
    epsilon, v0 = np.array([[0.25], [1.0], [9.81]]), _FIG_8
    claimed = 4 / np.sqrt(epsilon) * complete((v0 / 2) ** 2)
    starts = (v0 * np.sqrt(epsilon)).ravel()
    found = solved_period(starts, claimed.ravel(), 0.0, np.repeat(epsilon, v0.size))
    return Check(claimed, found.reshape(claimed.shape), 2 * solver_error(v0, 30)[:, 0])


def _frequencies() -> Check:
    claimed = np.pi / (2 * complete((_FIG_8 / 2) ** 2))
    return Check(claimed, frequency(_FIG_8), 1e-13 / (2 - _FIG_8))  # a rounding of k²


def _complete_integral() -> Check:
    modulus = np.array([0.1, 0.5, 0.9])
    square = (modulus**2)[:, None]
    claimed = integral(lambda x: 1 / np.sqrt(1 - square * np.sin(x) ** 2), 0 * modulus + np.pi / 2)
    return Check(claimed, complete(modulus**2), 1e-13)


def _zero() -> Check:
    v0 = 2 - 10.0 ** -np.arange(2, 16)
    t, omega = 2 - v0, frequency(v0)
    law = 0.5 * np.pi / np.log(4 / np.sqrt(t))  # which tends to 0
    held = np.concatenate([np.diff(omega) < 0, (omega > 0) & (omega < law * (1 + t))])
    return Check(np.ones(held.size), held, 0)


_T = 2 - (2 - 10.0 ** -np.arange(2, 15, 2))  # what is left of them beside 2, exactly


def _log_k() -> Check:
    log = np.log(4 / np.sqrt(_T))
    return Check(log, _beside(_T), 0.25 * _T * log + 1e-14)  # the next term, t (ln(4/√t) − 1)/4


def _log_law() -> Check:
    claimed = 0.5 * np.pi / np.log(4 / np.sqrt(_T))
    return Check(claimed, frequency(2 - _T), claimed * (0.25 * _T + 1e-14))  # the next term


def _fitted_law() -> Check:
    t = np.geomspace(1e-12, 1e-6, 40)
    v0 = np.concatenate([2 - t, 2 + t])
    law = fit_critical_law(v0, frequency(v0)).lower
    # both letters are off by the next term, t/4, and B by its logarithm as well
    return Check([np.pi / 2, 4], np.stack([law.amplitude, law.scale]), [1e-6, 1e-4])


_STARTS = np.arange(1, 20) / 10


def _largest() -> Check:
    v0 = _STARTS
    theta = solved(v0, 0.5 * np.pi / frequency(v0)[:, None])[0][:, 0]
    return Check(2 * np.arcsin(v0 / 2), theta, solver_error(v0, 10)[:, 0])


def _blue_line() -> Check:
    v0 = _STARTS[:8]
    return Check(2 * v0, amplitude(v0), 0.03 * amplitude(v0), v0)


def _coincide() -> Check:
    v0 = _STARTS[:8]
    return Check(np.ones(8), amplitude(v0) / v0, 0.03)  # 3 %, a line's width or two in the plot


_FALLS = "1 where ω is less than before, 1 where 0 < ω < (π/2)/ln(4/√t) (1 + t), t = 1e-2 … 1e-15"

CLAIMS = (
    Claim("2.3", "θ = 2 arcsin(k sn(u, k)), v = v0 cn(u, k), u = √ε t, k = v0/(2√ε)",
          "θ and v, formula / solver, ε = 4, k = 0.3, 0.8, 0.95, t = 0 … 15",
          lambda: _solution(False)),
    Claim("2.3", "the same with the printed u = √(εt)",
          "θ and v, formula / solver, ε = 4, k = 0.3, 0.8, 0.95, t = 0 … 15",
          lambda: _solution(True), errata=("S2-4",)),
    Claim("2.3", "k = 1: θ = 2 arcsin(tanh(√ε t))", "θ(t), rad, formula / solver, ε = 1, t = 0 … 6",
          _top),
    Claim("2.3", "k = 1: it takes an infinite time from θ = 0 to θ = π",
          "t, s, to π − 0.1 … π − 1e-8, by tanh / by an elliptic integral", _endless),
    *(_plotted(name, id) for name, id in
      (("5a", "2.3 Fig5a"), ("5b", "Fig5b"), ("5c", "Fig5c"), ("5d", "Fig5d"))),
    Claim("2.4 Fig6a-e", "The sine wave is found at small v0",
          "harmonics 2 … 6 over the first, v0 = 0.2", _sine, ("6a",)),
    Claim("2.4 Fig6a-e", "Higher harmonics are enhanced as v0 approaches 2",
          "sign of the change of lines 3, 5, 7, 9 over line 1 from plot to plot", _growth,
          ("6a", "6b", "6c", "6d", "6e")),
    Claim("2.4 Fig6a-e", "The spectra have the lines ω, 3ω, 5ω …",
          "amplitudes of 2ω, 4ω … 30ω over that of ω, the five v0", _odd_only,
          ("6a", "6b", "6c", "6d", "6e")),
    Claim("2.4 Fig6a-e", "Near v0 = 2 the form changes to a square wave",
          "mean|θ|/θ_max, extrapolated to v0 = 2", _square_wave, ("6e",)),
    Claim("2.4 Fig6a-e", "The frequency of the first harmonic is reduced to zero at v0 = 2",
          _FALLS, _zero),
    Claim("2.5 Fig7a,b", "Trajectories (θ, v) of v0 = 1.80 … 1.95 and 1.96 … 1.99",
          "θ and v, formula / solver, t = 0 … 30", _ellipse, ("7a", "7b")),
    Claim("2.5 Fig7a,b", "They are closed",
          "θ, rad, of up to 2.2 … 2.9, and v after one and two periods / at the start",
          _closed, ("7a", "7b")),
    Claim("2.6 Fig8a-c", "T = 4 K(k)/√ε",
          "T, s, formula / solver's first return, ε = 0.25, 1, 9.81, v0/√ε = 0.2 … 1.999", _period),
    Claim("2.6 Fig8a-c", "ω = π√ε/(2 K(k))", "ω, rad/s, by K / by the AGM, v0 = 0.2 … 1.999",
          _frequencies, ("8",)),
    Claim("2.6 Fig8a-c", "K(k) = ∫dφ/√(1 − k² sin²φ) from 0 to π/2",
          "K, quadrature / AGM, k = 0.1, 0.5, 0.9", _complete_integral, errata=("S2-6",)),
    Claim("2.6 Fig8a-c", "ω → 0 for v0 → 2 − 0", _FALLS, _zero, ("8",)),
    Claim("2.7 Fig9", "EllipticK[1 − t] ≈ ln(4 t^(−1/2)) for t → 0",
          "K, t = 1e-2 … 1e-14, to the next term", _log_k),
    Claim("2.7 Fig9", "ω_l ≈ (π/2)/ln(4 t^(−1/2)), t = 2 − v0",
          "ω, rad/s, t = 1e-2 … 1e-14, to the next term", _log_law, ("9",), ("S2-16",)),
    Claim("2.7 Fig9", "A = π/2 and B = 4 in ω_l ≈ A/ln(B t^(−1/2))",
          "A and B, law / fitted for t = 1e-12 … 1e-6", _fitted_law, ("9",)),
    Claim("2.8 Fig10", "θ_max = 2 arcsin(v0/(2√ε))",
          "θ_max, rad, formula / solver after a quarter of T, v0 = 0.1 … 1.9", _largest, ("10",)),
    Claim("2.8 Fig10", "Small angles: the blue line θ_max = 2 v0/√ε",
          "θ_max, rad, v0 = 0.1 … 0.8, to 3 %", _blue_line, ("10",), ("S2-7",)),
    Claim("2.8 Fig10", "The curve almost coincides with the (right) line v0/√ε for v0 < 0.8",
          "curve over line, v0 = 0.1 … 0.8, to 3 %", _coincide, ("10",), ("S2-7",)),
)  # fmt: skip
