"""Claims of the Spanish source's section 5: elliptic integrals, their series, the order of the
equation."""

from math import factorial

import numpy as np

from ..special import ellipe, ellipeinc, ellippiinc
from ._claim import Check, Claim
from ._computed import complete, elementwise, incomplete, integral, jacobi, solved
from ._spanish import EPSILON, weights

_second, _second_incomplete = elementwise(ellipe), elementwise(ellipeinc)
_third = elementwise(ellippiinc)


_PHI, _MODULUS = np.array([0.3, 0.8, 1.3]), 0.8


def _legendre(power, n=0.0):
    return lambda x: (1 - _MODULUS**2 * np.sin(x) ** 2) ** power / (1 + n * np.sin(x) ** 2)


def _jacobi(power, n=0.0):
    return lambda v: (1 - (_MODULUS * v) ** 2) ** power / np.sqrt(1 - v**2) / (1 + n * v**2)


def _forms() -> Check:
    m, x = _MODULUS**2, np.sin(_PHI)
    found = [incomplete(_PHI, m), _second_incomplete(_PHI, m)]
    legendre = [integral(_legendre(power), _PHI) for power in (-0.5, 0.5)]
    jacobi_form = [integral(_jacobi(power), x) for power in (-0.5, 0.5)]
    return Check(np.stack([legendre, jacobi_form]), np.stack(found), 1e-12)


def _third_kind() -> Check:
    n, m = 0.4, _MODULUS**2
    phi = np.append(_PHI, 0.5 * np.pi)
    by_phi = integral(_legendre(-0.5, n), phi)
    return Check(by_phi, _third(-n, phi, m), 1e-13)


def _inverse_sine() -> Check:
    x = np.sin(_PHI)
    return Check(x, jacobi(integral(_jacobi(-0.5), x), _MODULUS**2)[0], 1e-12)


def _limit(upper) -> Check:
    claimed, right = (integral(_legendre(-0.5), x) for x in (upper, _PHI))
    return Check(claimed, incomplete(_PHI, _MODULUS**2), 1e-13, right)


_M_SERIES = np.array([0.04, 0.25, 0.64])
_N = np.arange(400)


def _double(n: int) -> int:
    """n!!, 1 for n = −1 and 0."""
    return 1 if n < 1 else n * _double(n - 2)


def _ratios(form: int) -> np.ndarray:
    """The source's three ways to write the coefficients; exact for 80 terms, then as the first."""
    later = weights(400)[80:]
    if form == 0:
        first = [(factorial(2 * n) / (4**n * factorial(n) ** 2)) ** 2 for n in range(80)]
    elif form == 1:
        first = [(_double(2 * n - 1) / _double(2 * n)) ** 2 for n in range(80)]
    else:
        first = [1.0] + [
            (factorial(2 * n - 1) / (2 ** (2 * n - 1) * factorial(n) * factorial(n - 1))) ** 2
            for n in range(1, 80)
        ]
    return np.concatenate([first, later])


def _sums(terms) -> np.ndarray:
    return 0.5 * np.pi * np.sum(terms * _M_SERIES[:, None] ** _N, -1)


def _k_series() -> Check:
    claimed = [_sums(_ratios(form)) for form in range(3)]
    return Check(np.stack(claimed), complete(_M_SERIES), 1e-13)


def _e_series(from_zero: bool) -> Check:
    terms = -_ratios(1) / (2 * _N - 1)
    if from_zero:  # 1 − Σ from n = 0 on, whose first term is −1
        return Check(_sums(terms) + 0.5 * np.pi, _second(_M_SERIES), 1e-13, _sums(terms))
    claimed = [_sums(_ratios(form) / (1 - 2 * _N)) for form in range(3)]
    return Check(np.stack(claimed), _second(_M_SERIES), 1e-13)


def _binomial() -> Check:
    u = np.linspace(0, 1.5, 7)
    z = _M_SERIES[:, None] * np.sin(u) ** 2
    terms = np.sqrt(weights(400)) * z[..., None] ** _N
    # dn of the u whose amplitude that is
    dn = jacobi(incomplete(u, _M_SERIES[:, None]), _M_SERIES[:, None])[2]
    return Check(np.sum(terms, -1), 1 / dn, 1e-12)


def _wallis(n, claimed, corrected=None) -> Check:
    found = integral(lambda x: np.sin(x) ** n[:, None], np.full(n.size, 0.5 * np.pi))
    return Check(claimed, found, 1e-13, corrected)


def _even() -> Check:
    n = np.array([2, 4, 6, 8])
    return _wallis(n, np.cumprod((n - 1) / n) * 0.5 * np.pi)


def _printed_odd() -> Check:
    n = np.array([3, 5, 7])  # (2/1)(4/3)(6/5) … as it begins
    return _wallis(n, np.cumprod((n - 1) / (n - 2)) * 0.5 * np.pi, np.cumprod((n - 1) / n))


def _first_order() -> Check:
    start, t = np.array([0.3, 1.0, 2.5]), np.linspace(0.02, 0.2, 10)
    theta, p = solved([3.0, 5.0, 8.0], t, start, EPSILON)
    constant = 0.5 * np.array([3.0, 5.0, 8.0]) ** 2 - EPSILON * np.cos(start)
    return Check(EPSILON * np.cos(theta) + constant[:, None], 0.5 * p**2, 1e-8)


CLAIMS = (
    Claim("S0 5.1-5.2", "(5.3)–(5.5): sn is the inverse of ∫dv/(√(1 − v²) √(1 − k²v²))",
          "sn, k = 0.8, am u = 0.3, 0.8, 1.3", _inverse_sine, ("es3.2.1",)),
    Claim("S0 5.1-5.2", "(5.7): sn⁻¹(sin φ, k) = ∫du/√(1 − k² sin²u) from 0 to φ",
          "F, quadrature / Carlson's, k = 0.8, φ = 0.3, 0.8, 1.3", lambda: _limit(_PHI)),
    Claim("S0 5.1-5.2", "(5.7): sn⁻¹(sin φ, k) = ∫du/√(1 − k² sin²u) from 0 to sin φ, as printed",
          "F, quadrature / Carlson's, k = 0.8, φ = 0.3, 0.8, 1.3", lambda: _limit(np.sin(_PHI)),
          errata=("S0-4",)),
    Claim("S0 5.1-5.2", "F and E in Legendre's and in Jacobi's form",
          "F and E, k = 0.8, φ = 0.3, 0.8, 1.3",
          _forms),
    Claim("S0 5.1-5.2", "Π with 1 + n sin²u, incomplete and complete",
          "Π, n = 0.4, k = 0.8, quadrature / Π(−n | k²) of DLMF 19.2.7", _third_kind,
          errata=("S0-5",)),
    Claim("S0 5.1-5.2", "F(x) = K: three series of K(k), the same one",
          "K, 400 terms / AGM, k = 0.2, 0.5, 0.8", _k_series, errata=("S0-6",)),
    Claim("S0 5.1-5.2", "Series of E(k): forms 1, 3, 4 and 5",
          "E, 400 terms / AGM, k = 0.2, 0.5, 0.8", lambda: _e_series(False)),
    Claim("S0 5.1-5.2", "Series of E(k), form 2: π/2 (1 − Σ from n = 0)",
          "E, 400 terms / AGM, k = 0.2, 0.5, 0.8", lambda: _e_series(True), errata=("S0-7",)),
    Claim("S0 5.3", "(1 − z)^(−1/2) by the binomial series, z = k² sin²u",
          "1/√(1 − z), 400 terms / 1/dn, u = 0 … 1.5, k = 0.2, 0.5, 0.8", _binomial,
          errata=("S0-8",)),
    Claim("S0 5.3", "∫sinⁿu du from 0 to π/2 is (1/2)(3/4) … ((n − 1)/n) π/2 for even n",
          "integral, n = 2, 4, 6, 8", _even),
    Claim("S0 5.3", "∫sinⁿu du from 0 to π/2 is (2/1)(4/3)(6/5) … π/2 for odd n",
          "integral, n = 3, 5, 7", _printed_odd, errata=("S0-9",)),
    Claim("S0 5.4", "p = θ̇: p dp/dθ = −(g/L) sin θ, so ½p² = (g/L) cos θ + C",
          "½p², (rad/s)², formula / solver, θ0 = 0.3, 1, 2.5, θ̇0 = 3, 5, 8", _first_order),
)  # fmt: skip
