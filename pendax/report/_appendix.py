"""Claims of Suzuki & Suzuki's appendices A to G: elliptic integrals and functions, programs."""

from functools import cache

import numpy as np

from ._claim import Check, Claim
from ._computed import (
    complete,
    frequency,
    incomplete,
    integral,
    jacobi,
    lines,
    motion,
    solved,
    solver_error,
)
from ._numerical import panel_claim


def _first_kind() -> Check:
    modulus, phi = np.array([[0.2], [0.9]]), np.array([-1.5, -0.7, 0.3, 1.0, 1.5])
    m = modulus[..., None] ** 2
    by_quadrature = integral(lambda x: 1 / np.sqrt(1 - m * np.sin(x) ** 2), phi + 0 * modulus)
    return Check(by_quadrature, incomplete(phi, modulus**2), 1e-14)


def _inverse() -> Check:
    m, phi = np.array([[0.04], [0.5], [0.99]]), np.linspace(-9, 9, 20)
    found = np.stack(jacobi(incomplete(phi, m), m)[:3])
    dn = np.sqrt(1 - m * np.sin(phi) ** 2)
    return Check(np.stack([np.sin(phi) + 0 * m, np.cos(phi) + 0 * m, dn]), found, 1e-13)


def _periods() -> Check:
    m, u = np.array([[0.2], [0.6], [0.99]]), np.linspace(-3, 3, 13)
    quarter = complete(m)
    sn, cn, dn = jacobi(u, m)[:3]
    later, half = jacobi(u + 4 * quarter, m), jacobi(u + 2 * quarter, m)
    return Check(np.stack([sn, cn, dn]), np.stack([later[0], later[1], half[2]]), 1e-13)


def _sn_curves() -> Check:
    m, phi = np.array([0, 0.2, 0.4, 0.6, 0.8, 1])[:, None], np.linspace(0, 1.5, 16)
    u = integral(lambda x: 1 / np.sqrt(1 - m[..., None] * np.sin(x) ** 2), phi + 0 * m)
    return Check(np.sin(phi), jacobi(u, m)[0], 1e-13)


@cache
def _program_d() -> np.ndarray:
    """App. D's squares as they are plotted, list2[[n]] over 2π n/1600: n = 1 is the constant."""
    theta = motion(1.92, np.arange(32768) * (1600 / 32768))[0]
    return np.concatenate([[np.nan], np.abs(np.fft.fft(theta, norm="ortho")) ** 2])


def _plotted_peak() -> Check:
    step = 2 * np.pi / 1600
    plotted = step * np.nanargmax(_program_d()[:16384])
    return Check(plotted, frequency(1.92), 0.5 * step, plotted - step)


def _even_lines() -> Check:
    even = frequency(1.92) * np.array([2, 4, 6, 8])
    channel = np.round(even * 1600 / (2 * np.pi)).astype(int) + 1
    found = 32768 * lines(1.92, frequency(1.92))[0, 1:8:2] ** 2 / 4
    # 1e-4 is the lower end of its logarithmic axis
    return Check(_program_d()[channel], found, 1e-4, np.zeros(4))


def _program_g1() -> Check:
    t, v0 = np.linspace(0, 100, 41), np.array([[0.2], [1.6], [1.92], [1.98], [1.998]])
    theta = 2 * np.arcsin(v0 / 2 * jacobi(t, v0**2 / 4)[0])
    return Check(theta, solved(v0[:, 0], t)[0], solver_error(v0[:, 0], 100))


def _contours() -> Check:
    t = np.linspace(1, 29, 15)[:, None]
    sn, _, _, am = jacobi(t * 2.1 / 2, (2 / 2.1) ** 2)
    first = 2 * np.arcsin(sn)
    n = np.arange(-1, 6)
    drawn = np.sort(np.concatenate([first + 4 * np.pi * n, 2 * np.pi - first + 4 * np.pi * n], 1))
    inside = np.where((drawn >= 0) & (drawn <= 20 * np.pi), drawn, np.nan)
    # ten curves at each t; NaN, last, are outside the frame
    return Check(np.sort(inside)[:, :10], solved([2.1], t[:, 0])[0].T, 1e-8, 2 * am)


def _odd() -> Check:
    return Check(-incomplete(0.7, 0.3), incomplete(-0.7, 0.3), 1e-15)


CLAIMS = (
    Claim("A,B", "F(φ, k) = ∫dφ/√(1 − k² sin²φ)",
          "F, quadrature / Carlson's, k = 0.2, 0.9, |φ| ≤ 1.5", _first_kind),
    Claim("A,B", "F(−φ, k) = −F(φ, k)", "F, φ = 0.7, k² = 0.3", _odd),
    Claim("A,B", "sn, cn, dn are sin φ, cos φ and √(1 − k² sin²φ) of φ = am u, the inverse of F",
          "sn, cn, dn of F(φ), k² = 0.04, 0.5, 0.99, |φ| ≤ 9", _inverse),
    Claim("A,B", "sn and cn have the period 4K, dn 2K",
          "functions a period on, k² = 0.2, 0.6, 0.99, |u| ≤ 3",
          _periods),
    Claim("A,B", "Plot of sn(u, m) for m = 0, 0.2, 0.4, 0.6, 0.8, 1",
          "sn(u, m), am u = 0 … 1.5, u by quadrature", _sn_curves, ("B",)),
    Claim("C-H", "D: 2 ArcSin[k JacobiSN[t, k²]] is the motion",
          "θ(t), rad, program / solver, v0 = 0.2 … 1.998, t = 0 … 100", _program_g1, ("D",),
          ("S2-44",)),
    Claim("C-H", "D, v0 = 1.92: list2[[n]] is plotted over 2π n/1600",
          "ω of the highest peak, rad/s", _plotted_peak, ("D",), ("S2-40",)),
    Claim("C-H", "D, v0 = 1.92: the spectrum of t = 0 … 1600 is that of the motion",
          "power at 2ω, 4ω, 6ω, 8ω, rad²", _even_lines, ("D",), ("S2-41",)),
    panel_claim("E", "C-H", "E: NDSolve's θ(t)", figures=("E",), errata=("S2-42",)),
    Claim("C-H", "G, v0 = 2.1: ContourPlot of sin(θ/2) = sn(t/κ, κ) draws θ(t) in 0 … 20π",
          "the ten angles drawn at each of 15 t / θ(t), rad", _contours, ("G",), ("S2-43",)),
)  # fmt: skip
