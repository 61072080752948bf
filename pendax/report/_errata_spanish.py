"""Misprints of the Spanish source, each beside the motion, an integral or a series summed."""

import numpy as np

from .. import Pendulum, frequency, period, period_series, potential
from ..special import arcsn, ellipe, ellipk, ellippiinc
from ._claim import Erratum, Proof
from ._computed import integral, jacobi, solved
from ._errata_formulas import SOLVED, force_on_rod

_EPSILON = np.array([[0.5], [1.0], [9.81]])  # g/L, 1/s², three pendulums
_W0 = np.sqrt(_EPSILON)
_RELEASED = np.array([[1.2], [2.0], [2.8]])  # θ_max, rad
_MODULUS = np.sin(_RELEASED / 2)
_TIMES = np.array([0.3, 0.6, 0.8, 1.4])  # s
_M = np.array([[0.1], [0.5], [0.9]])
_N = np.arange(1, 400)
_SQUARES = np.cumprod(((2 * _N - 1) / (2 * _N)) ** 2)  # (1/2)², (1·3/2·4)², …, of K's series


def _speed() -> Proof:
    theta, v = solved(0.0, _TIMES, _RELEASED, _EPSILON)
    fallen = np.cos(theta) - np.cos(_RELEASED)
    omega = np.asarray(frequency(Pendulum(_EPSILON), 0.0, _RELEASED))
    right = -np.sign(np.sin(omega * _TIMES)) * np.sqrt(2 * _EPSILON) * np.sqrt(fallen)
    return Proof(np.sqrt(2 * _EPSILON * np.sqrt(fallen)), right, v, SOLVED)


def _angle(u: np.ndarray, released: np.ndarray) -> np.ndarray:
    modulus = np.sin(released / 2)
    return 2 * np.arcsin(modulus * jacobi(u, modulus**2)[0])


def _from_rest(ts: np.ndarray, released: np.ndarray) -> np.ndarray:
    quarter = np.asarray(ellipk(np.sin(released / 2) ** 2))
    return _angle(quarter - _W0 * ts, released)


def _released_at_rest() -> Proof:
    theta, _ = solved(0.0, _TIMES, _RELEASED, _EPSILON)
    return Proof(_angle(_W0 * _TIMES, _RELEASED), _from_rest(_TIMES, _RELEASED), theta, SOLVED)


def _sine_of_the_arcsine() -> Proof:
    theta, _ = solved(2 * _W0 * _MODULUS, _TIMES, 0.0, _EPSILON)
    phi = np.arcsin(jacobi(_W0 * _TIMES, _MODULUS**2)[0])
    printed = jacobi(phi, _MODULUS**2)[0]  # what was applied to both sides, to sin⁻¹ sn
    return Proof(printed, np.sin(phi), np.sin(theta / 2) / _MODULUS, SOLVED)


def _first_kind(end: np.ndarray) -> np.ndarray:
    return integral(lambda u: 1 / np.sqrt(1 - _M[..., None] * np.sin(u) ** 2), end)


def _upper_limit() -> Proof:
    phi = np.array([0.5, 0.9, 1.2, 1.5])
    return Proof(_first_kind(np.sin(phi)), _first_kind(phi), arcsn(np.sin(phi), _M), 1e-10)


def _third_kind() -> Proof:
    n, phi, m = np.array([0.2, 0.4, 0.6, -0.7]), np.array(1.1), _M[..., None]

    def printed(n: np.ndarray) -> np.ndarray:
        def integrand(u: np.ndarray) -> np.ndarray:
            squared = np.sin(u) ** 2
            return 1 / ((1 + n[:, None] * squared) * np.sqrt(1 - m * squared))

        return integral(integrand, phi)

    return Proof(printed(n), printed(-n), ellippiinc(n, phi, _M), 1e-10)


def _complete_not_incomplete() -> Proof:
    x = np.array([0.2, 0.5, 0.7, 0.8])
    series = np.pi / 2 * (1 + np.sum(_SQUARES * x[:, None] ** (2 * _N), -1))
    complete = np.asarray(ellipk(x**2)) + 0 * _M
    return Proof(arcsn(x, _M), complete, series + 0 * _M, 1e-10)


def _second_kind() -> Proof:
    from_one = np.sum(_SQUARES * _M**_N / (2 * _N - 1), -1)
    printed, right = (np.pi / 2 * (1 - (first + from_one)) for first in (-1, 0))
    return Proof(printed, right, ellipe(_M[:, 0]), 1e-10)


def _binomial() -> Proof:
    theta = np.array([0.1, 0.3, 1.2, 1.4])  # not the variable of integration: z stays
    printed = np.pi / 2 / np.sqrt(1 - _M * np.sin(theta) ** 2)
    right = _first_kind(np.array([np.pi / 2]))
    return Proof(printed, right, ellipk(_M), 1e-10)


def _wallis() -> Proof:
    odd, even = np.array([3, 5, 7]), np.array([4, 6, 8])
    product = [np.pi / 2 * np.prod(np.arange(2, n, 2) / np.arange(1, n - 1, 2)) for n in odd]
    printed = np.append(product, np.full(3, np.pi / 4))  # at even n ∫ sin² is the error
    of_odd = [np.prod(np.arange(2, n, 2) / np.arange(3, n + 1, 2)) for n in odd]
    of_even = [np.pi / 2 * np.prod(np.arange(1, n, 2) / np.arange(2, n + 1, 2)) for n in even]
    powers = np.append(odd, even)[:, None]
    truth = integral(lambda u: np.sin(u) ** powers, np.array(np.pi / 2))
    return Proof(printed, np.append(of_odd, of_even), truth, 1e-12)


def _restoring_force() -> Proof:
    step = 1e-3
    ts = np.array([0.3 - step, 0.3 + step, 0.8 - step, 0.8 + step])
    theta, v = solved(0.0, ts, _RELEASED, _EPSILON)
    acceleration = np.diff(v)[:, ::2] / (2 * step)
    force = _EPSILON * np.sin((theta[:, ::2] + theta[:, 1::2]) / 2)
    return Proof(force, -force, acceleration, 1e-3)


def _string_pushed() -> Proof:
    released, ts = np.array([[1.8], [2.3], [2.8]]), np.array([0.05, 0.1, 0.2, 0.3])
    right = _EPSILON * (3 * np.cos(_from_rest(ts, released)) - 2 * np.cos(released))
    return Proof(0.0, right, force_on_rod(0.0, ts, released, _EPSILON), 1e-7)


def _barrier() -> Proof:
    theta, _ = solved(0.0, _TIMES, _RELEASED, _EPSILON)
    printed = np.asarray(potential(Pendulum(_EPSILON), theta))
    swings, rotates = 0 * _EPSILON, 3 * _EPSILON
    for _ in range(12):
        middle = (swings + rotates) / 2
        end, _ = solved(np.sqrt(2 * middle), 10 / _W0, 0.0, _EPSILON)
        over = np.abs(end) > np.pi
        swings, rotates = np.where(over, swings, middle), np.where(over, middle, rotates)
    return Proof(printed, 2 * _EPSILON, (swings + rotates) / 2, 1e-3 * _EPSILON)


def _slow_series() -> Proof:
    released = np.radians([90.0, 150.0, 170.0])
    sums = np.asarray(period_series(released, 1300).value)
    exact = np.asarray(period(Pendulum(), 0.0, released))[:, None] / (2 * np.pi)
    needed = 1 + np.sum(np.abs(sums - exact) > 1e-6 * exact, -1)  # the sums rise to it
    return Proof(4, np.array([16, 141, 1239]), needed, 0.5)


# A table, a misprint a row.
# fmt: off
ERRATA: tuple[Erratum, ...] = (
    Erratum("S0-1", "formula", "§3.1, boxed", "dθ/dt = √((2g/L) √(cos θ − cos θ_max))",
            "dθ/dt = ±√(2g/L) √(cos θ − cos θ_max)", _speed,
            "dθ/dt, rad/s, θ_max = 1.2, 2, 2.8 rad; g/L = 0.5, 1, 9.81; t = 0.3 … 1.4 s"),
    Erratum("S0-2", "formula", "§3.1, §3.2",
            "released at rest at θ_max at t = 0, but θ = 2 sin⁻¹(k sn(√(g/L) t, k))",
            "from rest θ = 2 sin⁻¹(k sn(K − √(g/L) t, k)); as printed θ(0) = 0, v(0) = 2k√(g/L)",
            _released_at_rest,
            "θ(t), rad, θ_max = 1.2, 2, 2.8 rad; g/L = 0.5, 1, 9.81; t = 0.3 … 1.4 s"),
    Erratum("S0-3", "remark", "§3.2, end",
            "from sin⁻¹(sn(…)) = sin⁻¹(…) to sn(sn⁻¹(sn(…))) = sn(sn⁻¹(…)); sn[√(g/L) t]",
            "an identity; but what undoes sin⁻¹ is sin, sn(sin⁻¹ x) ≠ x; and sn[√(g/L) t, k]",
            _sine_of_the_arcsine,
            "sin φ, as printed sn φ, k = sin(θ_max/2); g/L = 0.5, 1, 9.81; t = 0.3 … 1.4 s"),
    Erratum("S0-4", "formula", "§5.1, (5.7), twice", "∫ du/√(1 − k² sin² u) from 0 to sin φ",
            "from 0 to φ", _upper_limit,
            "sn⁻¹(sin φ, k), φ = 0.5, 0.9, 1.2, 1.5; k² = 0.1, 0.5, 0.9"),
    Erratum("S0-5", "remark", "§5.2.1",
            "H(k, n, φ), Π(k, n) of 1/(1 + n sin² u); H₁(k, n, φ) = ∫ from 0 to x",
            "hold by this definition: the usual Π(n; φ | k²) has 1 − n sin² u; H₁(k, n, x)",
            _third_kind, "Π(n; φ | k²) / H(k, n, φ), H(k, −n, φ), n = −0.7 … 0.6; φ = 1.1"),
    Erratum("S0-6", "formula", "§5.2.2", "F(x) = (π/2) [1 + (1/2)² x² + …]",
            "K(x): the complete integral of modulus x", _complete_not_incomplete,
            "series / F(x, k), K(x), x = 0.2, 0.5, 0.7, 0.8; k² = 0.1, 0.5, 0.9"),
    Erratum("S0-7", "formula", "§5.2.2, E(k), second form",
            "(π/2) (1 − Σ from n = 0 of ((2n − 1)!!/(2n)!!)² k²ⁿ/(2n − 1))",
            "from n = 1: the term n = 0 makes it E + π/2", _second_kind,
            "E(k), k² = 0.1, 0.5, 0.9"),
    Erratum("S0-8", "formula", "§5.3", "z = k² sin² θ",
            "z = k² sin² u, of the variable integrated over", _binomial,
            "K(k), k² = 0.1, 0.5, 0.9; as printed with θ = 0.1 … 1.4"),
    Erratum("S0-9", "formula", "§5.3", "∫ sin² u du = (2/1)(4/3)(6/5)…((n − 1)/n)(π/2), n ∈ ℤ⁻ odd",
            "∫ sinⁿ u du = (2/3)(4/5)…((n − 1)/n), n ∈ ℤ⁺ odd; with π/2 for even n only", _wallis,
            "∫ sinⁿ u du from 0 to π/2, n = 3, 5, 7; 4, 6, 8"),
    Erratum("S0-10", "text", "§4", "ver 4.2.1", "ver 5.3", None),
    Erratum("S0-11", "formula", "§1.1", "F_T = mg sin θ; mα·L, with α not yet defined",
            "F_T = −mg sin θ; m L θ̈", _restoring_force,
            "F_T/(mL), rad/s², t = 0.3, 0.8 s; θ_max = 1.2, 2, 2.8 rad; g/L = 0.5, 1, 9.81"),
    Erratum("S0-12", "text", "§1.2", "momento angular M", "momento de fuerza M, the torque", None),
    Erratum("S0-13", "remark", "§1.1, radial",
            "cuerda o varilla; the tension is least at the ends, T = mg cos θ",
            "holds; but that is negative for θ_max > 90°, where cos θ < (2/3) cos θ_max: no string",
            _string_pushed,
            "T, N, 1 kg, 1 m / from accelerations, θ_max = 1.8, 2.3, 2.8; t = 0.05 … 0.3 s"),
    Erratum("S0-14", "text", "§1.3, §2", "the energy follows the Lagrangian at once",
            "d/dt ∂ℒ/∂θ̇ = ∂ℒ/∂θ and the heading of §2 are missing", None),
    Erratum("S0-15", "text", "§3, §5.1", "EDO Segundo grado; arccoseno",
            "de segundo orden; arcoseno", None),
    Erratum("S0-16", "formula", "§3", "oscillates for E < E_p",
            "for E < 2mgL, the height of the barrier", _barrier,
            "E/(mL²), 1/s², where swings end, g/L = 0.5, 1, 9.81; E_p at t = 0.3 … 1.4 s"),
    Erratum("S0-17", "remark", "§4",
            "T/T₀ = 1 + (1/2)² k² + (1·3/2·4)² k⁴ + (1·3·5/2·4·6)² k⁶ + …, 0 < k < 1",
            "holds, but is slow: for 1e-6, 16 terms at 90°, 141 at 150°, 1239 at 170°",
            _slow_series, "terms for 1e-6 of T, printed / needed, θ_max = 90°, 150°, 170°"),
)
# fmt: on
