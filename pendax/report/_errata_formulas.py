"""Misprinted formulas of Suzuki & Suzuki, each beside the motion solved or another way to it."""

import numpy as np

from .. import Pendulum, amplitude, frequency, geometry, harmonics
from ..special import ellipk
from ._claim import Erratum, Proof
from ._computed import Numbers, integral, jacobi, solved

SOLVED = 1e-8  # rad or rad/s: above the errors of the solver and of the quadratures

_EPSILON = np.array([[0.5], [1.0], [9.81]])  # 1/s², three pendulums
_W0 = np.sqrt(_EPSILON)
_TIMES = np.array([0.3, 0.6, 0.8, 1.4])  # s, all but t = 1, where √(εt) is √ε t
_KAPPA = np.array([[0.6], [0.8], [0.95]])
_RISING = np.array([0.2, 0.4, 0.6, 0.7])  # s, before any of these three is at the top


def force_on_rod(v0: Numbers, ts: np.ndarray, theta0: Numbers, epsilon: Numbers) -> np.ndarray:
    """Tension, N, for 1 kg and 1 m, from second differences of the bob's position."""
    step = 3e-3  # s: the stencil is off by 2e-9 N, of up to 9
    around = (ts[:, None] + step * np.arange(-2, 3)).ravel()
    theta, _ = solved(v0, around, theta0, epsilon)
    bob = (np.sin(theta) - 1j * np.cos(theta)).reshape(theta.shape[0], -1, 5)  # x + iy
    acceleration = bob @ np.array([-1, 16, -30, 16, -1]) / (12 * step**2)
    return -np.real((acceleration + 1j * np.asarray(epsilon)) * np.conj(bob[..., 2]))


def _phases() -> Proof:
    released, later = np.array([[1.0], [2.0], [2.8]]), 0.37
    series = harmonics(Pendulum(_EPSILON), 0.0, released, count=41)
    n = np.arange(1, 42)
    # Of sines from the bottom, taken from the turning point.
    cosines = np.asarray(series.amplitude) * np.sin(n * np.pi / 2)
    turned = n * np.asarray(series.frequency)[..., None] * _TIMES[:, None]
    delta = np.asarray(series.frequency)[..., None] * later
    theta, _ = solved(0.0, _TIMES + later, released, _EPSILON)
    printed = np.sum(cosines * np.cos(turned + delta), -1)
    return Proof(printed, np.sum(cosines * np.cos(turned + n * delta), -1), theta, SOLVED)


def _third_harmonic() -> Proof:
    v0 = np.array([0.05, 0.1, 0.2])
    first, _, third = np.asarray(harmonics(Pendulum(), v0, count=3).amplitude).T
    return Proof(-(first**3) / 192, first**3 / 192, third, 0.01 * third)


def _speed_squared() -> Proof:
    released = np.array([[1.0], [2.0], [2.8]])
    theta, v = solved(0.0, _TIMES, released, _EPSILON)
    once = _EPSILON * (np.cos(theta) - np.cos(released))
    return Proof(once, 2 * once, v**2, SOLVED)


def _argument_of_sn() -> Proof:
    modulus = np.array([[0.3], [0.7], [1.0]])
    theta, _ = solved(2 * _W0 * modulus, _TIMES, 0.0, _EPSILON)

    def angle(u: np.ndarray) -> np.ndarray:
        return 2 * np.arcsin(modulus * jacobi(u, modulus**2)[0])

    return Proof(angle(np.sqrt(_EPSILON * _TIMES)), angle(_W0 * _TIMES), theta, SOLVED)


def _sign_of_cn() -> Proof:
    modulus, ts = np.array([[0.25], [0.6], [0.95]]), np.array([3.0, 3.5, 4.0, 4.5])
    _, v = solved(2 * modulus, ts)  # on its way back
    sn, cn, *_ = jacobi(ts + 0 * modulus, modulus**2)
    return Proof(np.sqrt(1 - sn**2), cn, v / (2 * modulus), SOLVED)


def _differential() -> Proof:
    m, fixed = np.array([[0.1], [0.5], [0.9]]), np.array([0.0, 0.3, 0.6, 0.95])
    printed = 1 / np.sqrt((1 - fixed**2) * (1 - m * fixed**2))  # ∫₀¹ dz leaves ξ where it is
    nodes = np.cos((np.arange(80) + 0.5) * np.pi / 160)  # Chebyshev's, for dξ/√(1 − ξ²)
    found = np.mean(1 / np.sqrt(1 - m * nodes**2), -1, keepdims=True) * np.pi / 2
    return Proof(printed, found + 0 * printed, ellipk(m) + 0 * printed, 1e-10)


def _small_amplitude() -> Proof:
    v0 = np.array([0.1, 0.4, 0.8]) * _W0
    truth = np.asarray(amplitude(Pendulum(_EPSILON), v0))
    return Proof(2 * v0 / _W0, v0 / _W0, truth, 0.03 * truth)


def _rotation_integral() -> Proof:
    theta, _ = solved(2 * _W0 / _KAPPA, _RISING, 0.0, _EPSILON)
    m = _KAPPA[..., None] ** 2
    printed = integral(lambda xi: 1 / (1 - m * xi**2), np.sin(theta / 2))
    right = integral(lambda xi: 1 / np.sqrt((1 - xi**2) * (1 - m * xi**2)), np.sin(theta / 2))
    return Proof(printed, right, _W0 * _RISING / _KAPPA, SOLVED)


def _single_valued() -> Proof:
    ts = np.array([2.0, 3.0, 4.0, 5.0])
    theta, _ = solved(2 * _W0 / _KAPPA, ts, 0.0, _EPSILON)
    sn, _, _, am = jacobi(_W0 * ts / _KAPPA, _KAPPA**2)
    return Proof(2 * np.arcsin(sn), 2 * am, theta, SOLVED)


def _ratio_of_frequencies() -> Proof:
    t = np.array([0.1, 0.01, 0.001])
    above, below = frequency(Pendulum(), np.stack([2 + t, 2 - t]))
    found = 2 * (1 + t / 2 - t / (4 * np.log(4 / np.sqrt(t))))
    return Proof(2.0, found, above / below, t**2)


def _distance() -> Proof:
    v0 = 2 + np.array([1e-3, 1e-4, 1e-5])
    inverted = 16 * np.exp(-2 * np.pi / np.asarray(frequency(Pendulum(), v0)))  # ω = π/ln(4/√t)
    return Proof(2 - v0, v0 - 2, inverted, 0.01 * inverted)


def _angle_at_the_top() -> Proof:
    theta, v = solved(2 * _W0, _TIMES, 0.0, _EPSILON)
    points = geometry(Pendulum(_EPSILON), theta, v)
    phi = np.arcsin(np.tanh(_W0 * _TIMES))
    to_bob, to_pivot = np.asarray(points.P) - points.E, -np.asarray(points.E)
    truth = np.arctan2(to_bob[..., 0], np.sum(to_bob * to_pivot, -1))
    return Proof(phi / 2, phi, truth, SOLVED)


def _free_fall() -> Proof:
    v0, gravity = 2 * _W0 / _KAPPA, 9.81
    length = gravity / _EPSILON
    squared = length**2 * (4 * _EPSILON / _KAPPA**2 - 4 * _EPSILON)
    once = squared / (_EPSILON * length)
    half_turn = np.pi / np.asarray(frequency(Pendulum(_EPSILON), v0))
    theta, v = solved(v0, half_turn, 0.0, _EPSILON)
    at_top = length * np.where(np.abs(theta - np.pi) < 1e-6, v, np.nan)  # m/s
    fallen = integral(lambda t: gravity * t, at_top / gravity)  # until it is as fast
    return Proof(once, once / 2, fallen, 1e-6)  # m, of up to 70


def _argument_in_rotation() -> Proof:
    theta, _ = solved(2 * _W0 / _KAPPA, _RISING, 0.0, _EPSILON)
    printed = jacobi(np.sqrt(_EPSILON * _RISING), _KAPPA**2)[0]
    right = jacobi(_W0 * _RISING / _KAPPA, _KAPPA**2)[0]
    return Proof(printed, right, np.sin(theta / 2), SOLVED)


def _largest_frequency() -> Proof:
    lasts, counts = np.array([10.0, 100.0, 1600.0]), (32, 64, 256)

    def highest(count: int) -> int:  # bin in which a line of any bin can show
        rows = np.cos(2 * np.pi * np.outer(np.arange(count), np.arange(count)) / count)
        return int(np.max(np.argmax(np.abs(np.fft.fft(rows)).round(6), -1)))

    truth = 2 * np.pi / lasts * [highest(count) for count in counts]
    sampling = 2 * np.pi * np.array(counts) / lasts
    return Proof(sampling, sampling / 2, truth, 1e-9)


# A table, a misprint a row.
# fmt: off
ERRATA: tuple[Erratum, ...] = (
    Erratum("S2-1", "formula", "§1.1, (5)",
            "α₁ cos(ωt + δ) + α₃ cos(3ωt + δ) + α₅ cos(5ωt + δ) + …, |α₁| > |α₂| > |α₃|",
            "phases δ, 3δ, 5δ, …: a shift in time; and |α₁| > |α₃| > |α₅|", _phases,
            "θ(t), rad, from rest at 1, 2, 2.8 rad; ε = 0.5, 1, 9.81; t = 0.67 … 1.77 s"),
    Erratum("S2-2", "remark", "§1.1, (6)", "T = T₀(1 + α²/16), α₃ ≈ −α₁³/192",
            "hold, with α = α₁, in the cosines of (5); in sines, as from §2 on, α₃ ≈ +α₁³/192",
            _third_harmonic, "α₃, rad, of the sine series, v₀ = 0.05, 0.1, 0.2, ε = 1"),
    Erratum("S2-3", "formula", "§2.1", "v² = ε(cos θ − cos θ_max)",
            "v² = 2ε(cos θ − cos θ_max), as (1) has it", _speed_squared,
            "v², rad²/s², from rest at 1, 2, 2.8 rad; ε = 0.5, 1, 9.81; t = 0.3 … 1.4 s"),
    Erratum("S2-4", "formula", "§2.3", "sn(u = √(εt), k); for k = 1 tanh(√(εt))",
            "u = √ε t, the time outside the root", _argument_of_sn,
            "θ(t), rad, k = 0.3, 0.7, 1; ε = 0.5, 1, 9.81; t = 0.3 … 1.4 s"),
    Erratum("S2-5", "formula", "§2.2; §3.1, note", "cn u = √(1 − sn² u)",
            "cn u = ±√(1 − sn² u), negative for am u from π/2 to 3π/2, modulo 2π", _sign_of_cn,
            "cn u / the solver's v/v₀, k = 0.25, 0.6, 0.95; u = t = 3 … 4.5 s"),
    Erratum("S2-6", "formula", "§2.6", "K = ∫₀¹ dz / (√(1 − ξ²) √(1 − k²ξ²))",
            "dξ: as printed, ξ stays where it is", _differential,
            "K(k), k² = 0.1, 0.5, 0.9; as printed with ξ = 0 … 0.95"),
    Erratum("S2-7", "formula", "§2.8, Fig. 10", "small angles: θ_max = 2v₀/√ε",
            "θ_max = v₀/√ε, within 3 % up to v₀ = 0.8 √ε", _small_amplitude,
            "θ_max, rad, v₀/√ε = 0.1, 0.4, 0.8; ε = 0.5, 1, 9.81"),
    Erratum("S2-8", "formula", "§3.1", "∫ dφ / (√(1 − κ²ξ²) √(1 − κ²ξ²)) from 0 to sin(θ/2)",
            "∫ dξ / (√(1 − ξ²) √(1 − κ²ξ²))", _rotation_integral,
            "√ε t/κ, κ = 0.6, 0.8, 0.95; ε = 0.5, 1, 9.81; t = 0.2 … 0.7 s"),
    Erratum("S2-9", "formula", "§3.1", "sin(θ/2) = sn(√ε t/κ, κ), θ a multi-valued function of t",
            "θ = 2 am(√ε t/κ, κ), single-valued; v = v₀ dn(√ε t/κ, κ)", _single_valued,
            "θ(t), rad, κ = 0.6, 0.8, 0.95; ε = 0.5, 1, 9.81; t = 2 … 5 s"),
    Erratum("S2-10", "formula", "§3.3", "ω_u/ω_l = 2 at the same t",
            "2 [1 + t/2 − t/(4 ln(4/√t)) + O(t²)]: 2 only for t → 0", _ratio_of_frequencies,
            "ω_u/ω_l, t = 0.1, 0.01, 0.001 rad/s, ε = 1"),
    Erratum("S2-11", "formula", "§3.3, last line", "t = 2 − v₀", "t = v₀ − 2 (as under Fig. 12)",
            _distance, "t, rad/s, that gives ω_u, v₀ = 2.001, 2.0001, 2.00001, ε = 1"),
    Erratum("S2-12", "formula", "§4.2", "∠OEP = φ/2", "∠OEP = θ/2 = φ", _angle_at_the_top,
            "∠OEP, rad, k = 1; ε = 0.5, 1, 9.81; t = 0.3 … 1.4 s"),
    Erratum("S2-13", "formula", "§4.3", "DE = V²/(2g) = V²/(εl)",
            "DE = V²/(2εl), as the next line has it", _free_fall,
            "DE, m, l = (9.81 m/s²)/ε / integrated fall; κ = 0.6, 0.8, 0.95; ε = 0.5, 1, 9.81"),
    Erratum("S2-14", "formula", "§4.3", "sin(θ/2) = sn(√(εt), κ)", "sin(θ/2) = sn(√ε t/κ, κ)",
            _argument_in_rotation,
            "sin(θ/2), κ = 0.6, 0.8, 0.95; ε = 0.5, 1, 9.81; t = 0.2 … 0.7 s"),
    Erratum("S2-15", "formula", "§5.1; App. D", "the maximum ω_max = 2πN/T",
            "πN/T (Nyquist); 2πN/T is the sampling frequency", _largest_frequency,
            "ω, rad/s, N = 32, 64, 256 in T = 10, 100, 1600 s"),
    Erratum("S2-16", "text", "§2.7", "ω = ω₁", "ω = ω_l, the lower one, beside ω_u", None),
)
# fmt: on
