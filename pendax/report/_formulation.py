"""Claims of Suzuki & Suzuki's chapter 1 and sections 2.1 and 2.2: small angles, energy, and the
equation of motion integrated."""

import numpy as np

from .. import Pendulum, simulate, tension
from ._claim import Check, Claim
from ._computed import (
    amplitude,
    arrival,
    elementwise,
    frequency,
    height,
    integral,
    jacobi,
    lines,
    motion,
    solved,
    solved_period,
)


@elementwise
def _si_motion(t, v0, mass, length):
    run = simulate(Pendulum.from_si(length, 9.81, mass), t, v0)
    return run.theta, run.v


@elementwise
def _tension(theta, v):
    return tension(Pendulum(), theta, v, 1.0, 1.0)


def _slope(of, x, step=1e-2):
    """d/dx by Richardson's extrapolation, to 1e-11 or so."""
    one, two, four = ((of(x + n * step) - of(x - n * step)) / (2 * n * step) for n in (1, 2, 4))
    return (64 * one - 20 * two + four) / 45


def _newton() -> Check:
    mass, length, t = np.array([[0.1], [2.0]]), np.array([[0.5], [1.3]]), np.linspace(0, 3, 13)
    theta = _si_motion(t, 4.0, mass, length)[0]
    torque = -mass * 9.81 * length * np.sin(theta)
    change = _slope(lambda t: _si_motion(t, 4.0, mass, length)[1], t, 2e-3)
    return Check(torque / (mass * length**2), change, 1e-8)


def _string() -> Check:
    v0 = np.array([1.0, 2.01, 2.1, 2.2])
    theta, v = motion(v0[:, None], np.linspace(0, 12, 241))
    return Check(np.ones(4), np.all(_tension(theta, v) >= 0, -1), 0, v0 < np.sqrt(2))


_SMALL = np.array([0.05, 0.1, 0.2])


def _small_frequency() -> Check:
    first = lines(_SMALL, frequency(_SMALL))[:, 0]
    # the next term of ω is 3 α1⁴ ω0/1024
    return Check(np.sqrt(1 - first**2 / 8), frequency(_SMALL), first**4 * 3 / 1000)


def _small_period() -> Check:
    top = amplitude(_SMALL)  # the next term of T is 11 α⁴ T0/3072
    claimed = 2 * np.pi * (1 + top**2 / 16)
    return Check(claimed, solved_period(_SMALL, claimed), 2 * np.pi * top**4 * 11 / 3000)


def _cosine(n):
    """The n-th cosine amplitude of swings released from rest."""
    top = amplitude(_SMALL)
    phase = 2 * np.pi * np.arange(64) / 64
    theta = motion(0.0, phase / frequency(_SMALL)[:, None], top[:, None])[0]
    return 2 * np.mean(theta * np.cos(n * phase), -1)


def _third() -> Check:
    first = _cosine(1)
    # "≈": the correction is of the order of α1², relative
    return Check(-(first**3) / 192, _cosine(3), np.abs(first**5) / 1920)


def _phases() -> Check:
    v0, delta, phase = 1.6, 0.5, np.linspace(0, 6, 13)
    omega = frequency(v0)
    a1, _, a3, _, a5 = lines(v0, omega)[0, :5]
    # a cosine series: a quarter of a period later
    later = (phase + delta + 0.5 * np.pi) / omega

    def series(n):  # α_n cos(nωt + its phase), of the printed phase and of the right one
        return np.stack([np.cos(n * phase + delta), np.cos(n * (phase + delta))])

    claimed, right = a1 * series(1) - a3 * series(3) + a5 * series(5)
    return Check(claimed, motion(v0, later)[0], 1e-3, right)  # α7 is 3e-4


def _harmonic() -> Check:
    t, a = np.linspace(0, 20, 21), 1e-3
    return Check(a * np.cos(t), solved([0.0], t, a)[0][0], 20 * a**3 / 16 + 1e-11)


def _work() -> Check:
    v0, t = np.array([0.5, 1.5, 1.9, 2.5]), np.linspace(0, 20, 41)
    theta, v = solved(v0, t)
    return Check(1 - np.cos(theta), 0.5 * (v0[:, None] ** 2 - v * v), 1e-10)


def _taylor() -> Check:
    theta = np.linspace(-1.5, 1.5, 13)
    x = theta**2
    series = x / 2 - x**2 / 24 + x**3 / 720 - x**4 / 40320
    return Check(series, height(theta, 1.0), x**5 / 3628800 + 1e-15)  # the next term


def _energy() -> Check:
    v0, theta0 = np.array([0.5, 1.0, 1.5, 1.5]), np.array([-0.7, -0.7, -0.7, -1.5])
    theta, v = solved(v0, np.linspace(0, 10, 21), theta0)
    claimed = 0.5 * v0**2 + 1 - np.cos(theta0)
    return Check(claimed[:, None], 0.5 * v * v + height(theta, 1.0), 1e-10)


def _turning() -> Check:
    levels = np.array([0.5, 1.0, 1.5, 2.0])
    return Check(np.arccos(1 - levels), amplitude(np.sqrt(2 * levels)), 1e-14)


def _above() -> Check:
    levels = np.array([2.5, 3.0])
    v0 = np.sqrt(2 * levels)
    return Check(levels - 2, 0.5 * motion(v0, arrival(np.pi, v0))[1] ** 2, 1e-13)


def _separatrices() -> Check:
    epsilon, t = np.array([0.25, 1.0, 4.0]), np.linspace(0, 4, 21)
    theta, v = solved(2 * np.sqrt(epsilon), t, 0.0, epsilon)
    level = np.sqrt(2 * epsilon[:, None] * (2 - (1 - np.cos(theta))))
    return Check(level, v, 1e-8)  # at t = 4/√ε the solver is off by e⁸ · 1e-12


def _levels() -> Check:
    energy = np.arange(1, 8) / 2
    theta, v = solved(np.sqrt(2 * energy), np.linspace(0, 8, 41))
    return Check(2 * (energy[:, None] - (1 - np.cos(theta))), v * v, 1e-10)


def _barrier() -> Check:
    epsilon = np.array([0.5, 1.0, 3.0])
    theta = np.linspace(-np.pi, np.pi, 101)
    return Check(2 * epsilon, height(theta, epsilon[:, None]).max(-1), 1e-14)


MODULI = np.array([0.3, 0.8, 0.95])


def _speed() -> Check:
    theta, v = solved(2 * MODULI, np.linspace(0, 20, 41))
    top = 2 * np.arcsin(MODULI)[:, None]
    printed = np.cos(theta) - np.cos(top)
    return Check(printed, v * v, 1e-9, 2 * printed)


def _half_angle_speed() -> Check:
    theta, v = solved(2 * MODULI, np.linspace(0, 20, 41))
    square = MODULI[:, None] ** 2 - np.sin(theta / 2) ** 2
    return Check(4 * square, v * v, 1e-9)


def _first_integral() -> Check:
    modulus, z = MODULI[:, None, None], np.linspace(0, 0.9, 10)
    u = integral(
        lambda x: 1 / np.sqrt((1 - x**2) * (1 - modulus**2 * x**2)), z + 0 * MODULI[:, None]
    )
    return Check(u, arrival(2 * np.arcsin(MODULI[:, None] * z), 2 * MODULI[:, None]), 1e-12)


_U = np.linspace(0.1, 9.1, 19)


def roots(of_cn: bool, m) -> Check:
    """cn or dn of the parameters `m` by sn, and as they are; the sign of cn by am."""
    sn, cn, dn, am = jacobi(_U, m)
    if not of_cn:
        return Check(np.sqrt(1 - m * sn**2), dn, 1e-12)
    root = np.sqrt(1 - sn**2)
    return Check(root, cn, 1e-12, np.where(np.abs(np.mod(am, 2 * np.pi) - np.pi) < np.pi / 2,
                                           -root, root))  # fmt: skip


def _derivatives() -> Check:
    m = MODULI[:, None] ** 2
    sn, cn, dn, _ = jacobi(_U, m)
    found = [_slope(lambda u, i=i: jacobi(u, m)[i], _U) for i in range(3)]
    return Check(np.stack([cn * dn, -sn * dn, -m * sn * cn]), np.stack(found), 1e-8)


CLAIMS = (
    Claim("1.1a", "I θ̈ = −mgl sin θ, or θ̈ + ε sin θ = 0 with ε = g/l",
          "θ̈, rad/s², torque over m l² / of the motion, m = 0.1, 2, l = 0.5, 1.3, t = 0 … 3",
          _newton, ("1",)),
    Claim("1.1a", "The bob is suspended from a string (read with the v0 of §3, 4.3, 5, 7 and 8)",
          "1 if a string stays tight, v0 = 1, 2.01, 2.1, 2.2", _string, ("1",), ("S2-20",)),
    Claim("1.1b", "ω² = ω0² (1 − α1²/8)", "ω, rad/s, v0 = 0.05, 0.1, 0.2", _small_frequency),
    Claim("1.1b", "T = T0 (1 + α²/16)", "T, s, v0 = 0.05, 0.1, 0.2", _small_period,
          errata=("S2-2",)),
    Claim("1.1b", "α3 ≈ −α1³/192 (cosine series)",
          "α3, rad, of swings from rest, with the energy of v0 = 0.05, 0.1, 0.2", _third,
          errata=("S2-2",)),
    Claim("1.1b", "θ = α1 cos(ωt + δ) + α3 cos(3ωt + δ) + α5 cos(5ωt + δ) + …",
          "θ, rad, δ = 0.5, v0 = 1.6, ωt = 0 … 6", _phases, errata=("S2-1",)),
    Claim("1.1b", "In the limit θ → 0 the motion is θ = α1 cos(ω0 t + δ)",
          "θ(t), rad, from rest at 1e-3 rad, t = 0 … 20", _harmonic),
    Claim("1.2 Fig 2", "½v² + ε(1 − cos θ) is constant, and U = ε(1 − cos θ)",
          "U/ε, formula / kinetic energy lost, v0 = 0.5, 1.5, 1.9, 2.5, t = 0 … 20", _work, ("2",)),
    Claim("1.2 Fig 2", "U ≈ ε(θ²/2 − θ⁴/24 + θ⁶/720 − θ⁸/40320)",
          "U/ε, |θ| ≤ 1.5", _taylor, ("2",)),
    Claim("1.2 Fig 2", "E = ½v0² + ε(1 − cos θ0) of a start (θ0, v0)",
          "E, 1/s², of the start / along the motion, θ0 = −0.7, −1.5, v0 = 0.5 … 1.5, t = 0 … 10",
          _energy),
    Claim("1.2 Fig 2", "Lines of constant energy E/ε = 0.5 … 3.0 over U",
          "θ where E/ε = 0.5, 1, 1.5, 2 meet U, rad / largest angle", _turning, ("2",)),
    Claim("1.2 Fig 2", "Those of E/ε = 2.5 and 3.0 are above U everywhere",
          "E/ε − 2 / ½v²/ε at θ = π", _above, ("2",)),
    Claim("1.3a Fig 3", "E = 2ε, ε varied: curves that separate inside from outside",
          "v, rad/s, of the curve / of the motion from 2√ε, ε = 0.25, 1, 4, t = 0 … 4",
          _separatrices, ("3",)),
    Claim("1.3b Fig 4", "Trajectories ½v² + ε(1 − cos θ) = E for E = 0.5, 1.0 … 3.5",
          "v², (rad/s)², of the curve / of the motion, t = 0 … 8", _levels, ("4",)),
    Claim("1.3b Fig 4", "E = 2ε is the highest energy of the potential",
          "largest U, 1/s², ε = 0.5, 1, 3", _barrier, ("4",)),
    Claim("2.1-2.2", "v² = ε(cos θ − cos θ_max)",
          "v², (rad/s)², formula / solver, k = 0.3, 0.8, 0.95, t = 0 … 20", _speed,
          errata=("S2-3",)),
    Claim("2.1-2.2", "(1): θ̇ = 2√ε √(sin²(θ_max/2) − sin²(θ/2))",
          "v², (rad/s)², formula / solver, k = 0.3, 0.8, 0.95, t = 0 … 20", _half_angle_speed),
    Claim("2.1-2.2", "(2)–(4): √ε t = ∫dξ/(√(1 − ξ²) √(1 − k²ξ²)) up to sin(θ/2)/k",
          "t, s, quadrature / arrival at θ, k = 0.3, 0.8, 0.95", _first_integral),
    Claim("2.1-2.2", "cn(u) = √(1 − sn²(u))", "cn, u = 0.1 … 9.1, k = 0.3, 0.8, 0.95",
          lambda: roots(True, MODULI[:, None] ** 2),
          errata=("S2-5",)),
    Claim("2.1-2.2", "cos(θ/2) = √(1 − k² sn²(u)) = dn(u)", "dn, u = 0.1 … 9.1, k = 0.3, 0.8, 0.95",
          lambda: roots(False, MODULI[:, None] ** 2)),
    Claim("2.1-2.2", "sn′ = cn dn, cn′ = −sn dn, dn′ = −k² sn cn",
          "derivatives / differences, u = 0.1 … 9.1, k = 0.3, 0.8, 0.95", _derivatives),
)  # fmt: skip
