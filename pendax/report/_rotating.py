"""Claims of Suzuki & Suzuki's chapter 3: rotation, and both sides of v0 = 2."""

import numpy as np

from .. import fit_critical_law
from ._claim import Check, Claim
from ._computed import (
    arrival,
    complete,
    frequency,
    integral,
    jacobi,
    solved,
    solved_period,
    solver_error,
)
from ._formulation import roots

_FIG_10 = {"10a": 2.3, "10b": 2.1, "10c": 2.01}


def _curve(v0) -> Check:
    t, kappa = np.linspace(0, 30, 61), 2 / v0
    sn, cn, _, _ = jacobi(t / kappa, kappa**2)
    claimed = 2 * np.unwrap(np.arctan2(sn, cn))  # 2 am: half a second apart, less than π
    return Check(claimed, solved([v0], t)[0][0], solver_error([v0], 30)[0])


def _plotted(name: str) -> Claim:
    v0 = _FIG_10[name]
    says = f"v0 = {v0}: the curve through the origin of sin(θ/2) = sn(√ε t/κ, κ), κ = 2√ε/v0"
    quantity = "θ, rad, 2 am, unwrapped / solver, t = 0 … 30"
    return Claim("3.1 Fig10a-c", says, quantity, lambda: _curve(v0), (name,))


_V0 = np.array([2.01, 2.1, 2.3])
_KAPPA = 2 / _V0[:, None]


def _speed() -> Check:
    theta, v = solved(_V0, np.linspace(0, 30, 61))
    claimed = np.sqrt(_V0[:, None] ** 2 - 4 * np.sin(theta / 2) ** 2)
    return Check(claimed, v, solver_error(_V0, 30))


def _time(printed: bool) -> Check:
    theta, square = np.linspace(0, 2.5, 11), (_KAPPA**2)[..., None]

    def integrals(other):
        upper = np.sin(theta / 2) + 0 * _KAPPA
        return integral(lambda x: 1 / np.sqrt((1 - other * x**2) * (1 - square * x**2)), upper)

    found, right = arrival(theta, _V0[:, None]) / _KAPPA, integrals(1.0)
    return Check(integrals(square) if printed else right, found, 1e-12, right)


def _branches() -> Check:
    """How many of the angles with that sine are the motion's."""
    t = np.linspace(1, 29, 15)
    first = 2 * np.arcsin(jacobi(t / _KAPPA, _KAPPA**2)[0])[..., None]
    turns = 4 * np.pi * np.arange(-1, 8)
    solutions = np.concatenate([first + turns, 2 * np.pi - first + turns], -1)
    hit = np.abs(solutions - solved(_V0, t)[0][..., None]) < 1e-6
    framed = (solutions >= 0) & (solutions <= 20 * np.pi)  # of Appendix G
    return Check(framed.sum(-1), hit.sum(-1), 0, 1)


_FAST = np.array([2.001, 2.005, 2.01, 2.05, 2.1, 2.3, 2.5, 3.0, 3.5, 4.0, 5.0, 8.0])


def _period() -> Check:
    epsilon, kappa = np.array([[0.25], [1.0], [9.81]]), 2 / _FAST
    claimed = 2 * kappa / np.sqrt(epsilon) * complete(kappa**2)
    starts = (_FAST * np.sqrt(epsilon)).ravel()
    found = solved_period(starts, claimed.ravel(), 2 * np.pi, np.repeat(epsilon, _FAST.size))
    return Check(claimed, found.reshape(claimed.shape), 2 * solver_error(_FAST, 15)[:, 0])


def _turn_frequency() -> Check:
    kappa = 2 / _FAST
    claimed = np.pi / (kappa * complete(kappa**2))
    return Check(claimed, frequency(_FAST), 1e-13 * claimed / (_FAST - 2))  # a rounding of κ²


def _zero() -> Check:
    t = 2.0 ** -np.array([20, 30, 40, 50])
    # 1/ω grows without bound, by the source's law ln(4/√t)/π
    growth = np.diff(1 / frequency(2 + t)) / (10 * np.log(2))
    return Check(0.5 / np.pi, growth, 1e-5)


_T = (2 + 10.0 ** -np.arange(2, 15, 2)) - 2  # what is left of them beside 2, exactly


def _log_law() -> Check:
    claimed = np.pi / np.log(4 / np.sqrt(_T))
    return Check(claimed, frequency(2 + _T), claimed * (0.25 * _T + 1e-14))  # the next term


def _ratio() -> Check:
    t = 10.0 ** -np.arange(1, 4)
    corrected = 2 + t - t / (2 * np.log(4 / np.sqrt(t)))  # to t²
    return Check(2, frequency(2 + t) / frequency(2 - t), t**2, corrected)


def _limit_ratio() -> Check:
    t = 1e-12
    return Check(2, frequency(2 + t) / frequency(2 - t), 2 * t)  # 2 (1 + t/2)


def _distance() -> Check:
    v0 = 2 + 10.0 ** -np.arange(2, 5)
    t = 16 * np.exp(-2 * np.pi / frequency(v0))  # from the law ω_u = π/ln(4 t^(−1/2))
    return Check(2 - v0, t, 0.1 * t, v0 - 2)


_BOTH = np.array([0.2, 0.6, 1.0, 1.4, 1.8, 1.95, 1.99, 2.01, 2.05, 2.2, 2.6, 3.0])


def _both_sides() -> Check:
    swings, modulus = _BOTH < 2, np.minimum(_BOTH / 2, 2 / _BOTH)
    quarter = complete(modulus**2)
    omega = np.where(swings, np.pi / (2 * quarter), np.pi / (modulus * quarter))
    found = solved_period(_BOTH, 2 * np.pi / omega, np.where(swings, 0.0, 2 * np.pi))
    return Check(omega, 2 * np.pi / found, solver_error(_BOTH, 20)[:, 0])


def _cusp() -> Check:
    t = np.geomspace(1e-12, 1e-6, 40)
    v0 = np.concatenate([2 - t, 2 + t])
    law = fit_critical_law(v0, frequency(v0))
    found = np.stack([law.lower.amplitude, law.upper.amplitude, law.ratio])
    return Check([np.pi / 2, np.pi, 2], found, 1e-6)  # the next term, t/4


CLAIMS = (
    Claim("3.1 Fig10a-c", "θ̇ = √(v0² − 4ε sin²(θ/2))",
          "v, rad/s, formula / solver, v0 = 2.01, 2.1, 2.3, t = 0 … 30",
          _speed),
    Claim("3.1 Fig10a-c", "√ε t/κ = ∫dφ/(√(1 − κ²ξ²) √(1 − κ²ξ²)) up to sin(θ/2), as printed",
          "u, quadrature / arrival at θ = 0 … 2.5, v0 = 2.01, 2.1, 2.3", lambda: _time(True),
          errata=("S2-8",)),
    Claim("3.1 Fig10a-c", "ξ = sin(φ/2) in (2√ε/κ) t = ∫dφ/√(1 − κ² sin²(φ/2))",
          "u, quadrature / arrival at θ = 0 … 2.5, v0 = 2.01, 2.1, 2.3", lambda: _time(False),
          errata=("S2-8",)),
    *(_plotted(name) for name in _FIG_10),
    Claim("3.1 Fig10a-c", "Note: cn(u, κ) = √(1 − sn²(u, κ))",
          "cn, u = 0.1 … 9.1, κ = 2/2.01, 2/2.1, 2/2.3",
          lambda: roots(True, _KAPPA**2), errata=("S2-5",)),
    Claim("3.1 Fig10a-c", "Note: dn(u, κ) = √(1 − κ² sn²(u, κ))",
          "dn, u = 0.1 … 9.1, κ = 2/2.01, 2/2.1, 2/2.3",
          lambda: roots(False, _KAPPA**2)),
    Claim("3.1 Fig10a-c", "The angle θ is a multi-valued function of t",
          "angles with that sine in 0 … 20π / of the motion, at 15 times, v0 = 2.01, 2.1, 2.3",
          _branches,
          ("10a", "10b", "10c"), ("S2-9",)),
    Claim("3.2 Fig11", "T = 2κ K(κ)/√ε",
          "T, s, formula / solver's first turn, ε = 0.25, 1, 9.81, v0/√ε = 2.001 … 8", _period),
    Claim("3.2 Fig11", "ω = π√ε/(κ K(κ))", "ω, rad/s, by K / by the AGM, v0 = 2.001 … 8",
          _turn_frequency, ("11",)),
    Claim("3.2 Fig11", "ω → 0 for v0 → 2 + 0",
          "growth of 1/ω, s, by the law / found, while t falls to a fraction 1/e, t = 2⁻²⁰ … 2⁻⁵⁰",
          _zero, ("11",)),
    Claim("3.3 Fig12", "ω_u ≈ π/ln(4 t^(−1/2)), t = v0 − 2",
          "ω, rad/s, t = 1e-2 … 1e-14, to the next term", _log_law, ("12",)),
    Claim("3.3 Fig12", "ω_u/ω_l = 2 at the same t", "ω_u/ω_l, t = 0.1, 0.01, 0.001", _ratio,
          ("12",), ("S2-10",)),
    Claim("3.3 Fig12", "ω_u/ω_l = 2 in the limit t → 0", "ω_u/ω_l, t = 1e-12", _limit_ratio),
    Claim("3.3 Fig12", "the plot is over t = 2 − v0",
          "t, rad/s, printed / by the law from ω_u, v0 = 2.01, 2.001, 2.0001",
          _distance, ("12",), ("S2-11",)),
    Claim("Fig13", "ω(v0) for v0 < 2 and v0 > 2",
          "ω, rad/s, formula / solver's first return, v0 = 0.2 … 3",
          _both_sides, ("13",)),
    Claim("Fig13", "v0 = 2 is critical: ω falls to 0 by the law A/ln(B t^(−1/2)) on both sides",
          "A_l, A_u and A_u/A_l, law / fitted for t = 1e-12 … 1e-6", _cusp, ("13",)),
)  # fmt: skip
