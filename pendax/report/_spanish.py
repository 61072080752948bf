"""Claims of the Spanish source, "Dinámica Péndulo Simple «solución exacta»", sections 1 to 4."""

from math import comb

import numpy as np

from ._claim import Check, Claim
from ._computed import (
    amplitude,
    arrival,
    complete,
    frequency,
    integral,
    jacobi,
    motion,
    solved,
    solved_period,
    solver_error,
)

_G, _L, _M = 9.81, 0.5, 0.2  # m/s², m and kg
EPSILON = _G / _L


def _one_period(top):
    """Times, θ and v of a swing of the amplitude `top` released from rest there, 256 of each."""
    speed = 2 * np.sqrt(EPSILON) * np.sin(top / 2)
    period = 2 * np.pi / frequency(speed, EPSILON)
    ts = period * np.arange(256) / 256
    return ts, *motion(0.0, ts, top, EPSILON)


def _twice_differentiated(ts, x):
    """By its Fourier series, of one period: to rounding."""
    n = np.fft.fftfreq(ts.size, 1 / ts.size)
    rate = 2 * np.pi / (ts[1] * ts.size)
    return np.fft.ifft(-((n * rate) ** 2) * np.fft.fft(x)).real


def _acceleration(sign) -> Check:
    ts, theta, _ = _one_period(1.2)
    pull = _M * _G * np.sin(theta)
    return Check(sign * pull, _M * _L * _twice_differentiated(ts, theta), 1e-9, -pull)


def _moment() -> Check:
    ts, theta, _ = _one_period(2.0)
    claimed = -_M * _G * _L * np.sin(theta)
    return Check(claimed, _M * _L**2 * _twice_differentiated(ts, theta), 1e-9)


def _pull(top):
    """Tension along the rod, N, from the bob's accelerations in x and y."""
    ts, theta, v = _one_period(top)
    x, y = np.sin(theta), -np.cos(theta)
    forces = (_M * _L * _twice_differentiated(ts, s) for s in (x, y))
    horizontal, vertical = forces
    return theta, v, -(horizontal * x + (vertical + _M * _G) * y)


def _radial() -> Check:
    theta, v, pull = _pull(np.radians(60))
    return Check(_M * _L * v**2 + _M * _G * np.cos(theta), pull, 1e-9)


def _extremes() -> Check:
    top = np.radians(60)
    _, v, pull = _pull(top)
    claimed = [_M * _G + _M * _L * np.max(v**2), _M * _G * np.cos(top)]
    return Check(claimed, [pull.max(), pull.min()], 1e-9)


def _string() -> Check:
    held = [_pull(np.radians(degrees))[2].min() >= 0 for degrees in (60, 120, 170)]
    return Check(np.ones(3), held, 0, [1, 0, 0])


_TOPS = np.radians([30.0, 90.0, 150.0])
_SPEEDS = 2 * np.sqrt(EPSILON) * np.sin(_TOPS / 2)


def _conserved() -> Check:
    theta, v = solved(_SPEEDS, np.linspace(0, 5, 41), 0.0, EPSILON)
    claimed = (1 - np.cos(_TOPS))[:, None]
    return Check(claimed, v**2 / (2 * EPSILON) + 1 - np.cos(theta), 1e-9)


def _velocity(boxed: bool) -> Check:
    theta, v = solved(_SPEEDS, np.linspace(0.02, 0.2, 10), 0.0, EPSILON)  # upwards
    root = np.sqrt(np.cos(theta) - np.cos(_TOPS)[:, None])
    right = np.sqrt(2 * EPSILON) * root
    return Check(np.sqrt(2 * EPSILON * root) if boxed else right, v, 1e-9, right)


def _oscillates() -> Check:
    energy = np.array([0.3, 0.99, 1.01, 2.0])  # of 2mgL
    theta = solved(2 * np.sqrt(energy), np.linspace(0, 30, 61))[0]
    return Check(energy < 1, np.all(np.abs(theta) < np.pi, -1), 0)


def _both_ways() -> Check:
    theta, v = solved(_SPEEDS, np.linspace(0, 5, 41), 0.0, EPSILON)
    constant = -EPSILON * np.cos(_TOPS)[:, None]
    return Check(2 * (EPSILON * np.cos(theta) + constant), v**2, 1e-8)


def _time() -> Check:
    modulus, share = np.sin(_TOPS / 2)[:, None], np.linspace(0, 0.95, 9)
    phi = np.arcsin(share) + 0 * modulus
    claimed = integral(lambda x: 1 / np.sqrt(1 - modulus[..., None] ** 2 * np.sin(x) ** 2), phi)
    return Check(claimed, arrival(2 * np.arcsin(modulus * share), 2 * modulus), 1e-13)


def _formula(released: bool) -> Check:
    t, modulus = np.linspace(0, 5, 41), np.sin(_TOPS / 2)[:, None]

    def swing(u):
        return 2 * np.arcsin(modulus * jacobi(u, modulus**2)[0])

    u, quarter = np.sqrt(EPSILON) * t, complete(modulus**2)
    starts = (np.zeros(3), t, _TOPS) if released else (_SPEEDS, t, 0.0)
    error = solver_error(2 * modulus[:, 0], 5 * np.sqrt(EPSILON))
    corrected = swing(quarter - u) if released else None
    return Check(swing(u), solved(*starts, EPSILON)[0], error, corrected)


def _resembles() -> Check:
    u = np.linspace(0, 4 * np.pi, 61)
    return Check(np.sin(u), jacobi(u, 0.05**2)[0], 0.01)  # a line's width in a plot


def _plotted() -> Check:
    u, moduli = np.linspace(0, 12, 61), np.array([0.05, 0.9])
    found = np.sin(solved(2 * moduli, u)[0] / 2) / moduli[:, None]
    return Check(jacobi(u, moduli[:, None] ** 2)[0], found, 1e-8)


def weights(count: int) -> np.ndarray:
    """((2n)!/(2²ⁿ n!²))², n = 0 … count − 1."""
    return np.array([(comb(2 * n, n) / 4**n) ** 2 for n in range(count)])


def _quarter() -> Check:
    modulus = np.sin(_TOPS / 2)
    square = (modulus**2)[:, None]
    quarter = integral(
        lambda x: 1 / np.sqrt(1 - square * np.sin(x) ** 2), np.full(3, 0.5 * np.pi)
    ) / np.sqrt(EPSILON)
    found = solved_period(_SPEEDS, 4 * quarter, 0.0, EPSILON) / 4
    return Check(quarter, found, solver_error(2 * modulus, 10)[:, 0])


def _series() -> Check:
    top = np.radians([15.0, 45.0, 90.0, 135.0, 150.0])
    m = np.sin(top / 2) ** 2
    claimed = np.sum(weights(500) * m[:, None] ** np.arange(500), -1)
    return Check(claimed, 1 / frequency(2 * np.sqrt(m)), 1e-13)


def _modulus() -> Check:
    return Check(np.sin(_TOPS / 2), np.sin(amplitude(_SPEEDS, EPSILON) / 2), 1e-14)


CLAIMS = (
    Claim("S0 1.1-1.3", "1.1: m L θ̈ = −mg sin θ",
          "force along the arc, N, formula / m L θ̈, θ_max = 1.2 rad",
          lambda: _acceleration(-1)),
    Claim("S0 1.1-1.3", "1.1: F_T = mg sin θ",
          "force along the arc, N, printed / m L θ̈, θ_max = 1.2 rad",
          lambda: _acceleration(1), errata=("S0-11",)),
    Claim("S0 1.1-1.3", "1.1: m v²/L = T − mg cos θ",
          "T, N, formula / from accelerations, θ_max = 60°", _radial, ("es1.1",)),
    Claim("S0 1.1-1.3", "1.1: T is largest at the bottom, mg + m v²/L, least at the ends, mg cos θ",
          "T, N, formula / from accelerations, θ_max = 60°", _extremes, ("es1.1",), ("S0-13",)),
    Claim("S0 1.1-1.3", "The mass hangs on a string or a rod, 0 < θ_max < π: a string",
          "1 if a string stays tight, θ_max = 60°, 120°, 170°", _string, ("es1.1",), ("S0-13",)),
    Claim("S0 1.1-1.3", "1.2: −mgL sin θ = I θ̈, I = mL²",
          "torque, N m, formula / I θ̈, θ_max = 2 rad",
          _moment, errata=("S0-12",)),
    Claim("S0 1.1-1.3", "1.3, 2: 1 − cos θ_max = (L/2g) θ̇² + 1 − cos θ",
          "energy over mgL, at the end / along the motion, θ_max = 30°, 90°, 150°", _conserved,
          errata=("S0-14",)),
    Claim("S0 3.1", "3: E < E_p: it oscillates, 0 < θ_max < π (E_p being the barrier, 2mgL)",
          "1 where |θ| < π up to t = 30, E/E_p = 0.3, 0.99, 1.01, 2", _oscillates,
          errata=("S0-15", "S0-16")),
    Claim("S0 3.1", "θ̇ = √(2g/L) √(cos θ − cos θ_max)",
          "θ̇, rad/s, upwards, formula / solver, θ_max = 30°, 90°, 150°",
          lambda: _velocity(False), errata=("S0-1",)),
    Claim("S0 3.1", "boxed: √(2g/L √(cos θ − cos θ_max))",
          "θ̇, rad/s, upwards, formula / solver, θ_max = 30°, 90°, 150°", lambda: _velocity(True),
          errata=("S0-1",)),
    Claim("S0 3.1", "½θ̇² = (g/L) cos θ + C, C = −(g/L) cos θ_max",
          "θ̇², (rad/s)², formula / solver, θ_max = 30°, 90°, 150°",
          _both_ways),
    Claim("S0 3.2", "(3.6): √(g/L) t = ∫dφ/√(1 − k² sin²φ), sin φ = sin(θ/2)/k",
          "√(g/L) t, quadrature / arrival at θ, θ_max = 30°, 90°, 150°", _time),
    Claim("S0 3.2", "k = sin(θ_max/2)", "k, formula / from the largest angle, 30°, 90°, 150°",
          _modulus),
    Claim("S0 3.2", "θ = 2 arcsin(k sn(√(g/L) t, k))",
          "θ, rad, formula / solver from the bottom, t = 0 … 5",
          lambda: _formula(False), errata=("S0-3",)),
    Claim("S0 3.2", "At t = 0 it is at rest at θ_max (the condition from which C comes)",
          "θ, rad, formula / solver from rest at θ_max = 30°, 90°, 150°, t = 0 … 5",
          lambda: _formula(True),
          errata=("S0-2",)),
    Claim("S0 3.2.1", "sn for k = 0.05 looks like a sine",
          "sin u / sn u, u = 0 … 4π, to a line's width",
          _resembles, ("es3.2.1",)),
    Claim("S0 3.2.1", "Plot of sn for k = 0.05 and 0.9",
          "sn u / sin(θ/2)/k by the solver, u = 0 … 12",
          _plotted, ("es3.2.1",)),
    Claim("S0 4", "T/4 = √(L/g) K(k)", "T/4, s, quadrature / solver's first return, 30°, 90°, 150°",
          _quarter),
    Claim("S0 4", "T = T0 Σ ((2n)!/(2²ⁿ n!²))² sin²ⁿ(θ_max/2)",
          "T/T0, 500 terms / AGM, θ_max = 15° … 150°", _series, ("es4",), ("S0-10", "S0-17")),
)  # fmt: skip
