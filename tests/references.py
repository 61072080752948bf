"""Reference values in high precision, by mpmath and by Arb; nothing here is pendax's."""

import flint
import mpmath as mp
import numpy as np

DIGITS = 60


def exact(x) -> mp.mpf:
    """The float as it is."""
    return mp.mpf(float(x))


def complement(m1) -> tuple[mp.mpf, int]:
    """1 - m1 and the digits that hold it."""
    m1 = exact(m1)
    digits = DIGITS + (int(-mp.log10(abs(m1))) + 10 if m1 != 0 and abs(m1) < 1 else 0)
    with mp.workdps(digits):
        return 1 - m1, digits


def ellipj(u, m=None, m1=None) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """sn, cn, dn of floats, by mpmath's theta functions; m > 1 by DLMF 22.17."""
    m, digits = (exact(m), DIGITS) if m1 is None else complement(m1)
    with mp.workdps(digits):
        return jacobi(exact(u), m)


def jacobi(u: mp.mpf, m: mp.mpf) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
    """The same for high-precision arguments, in the precision of the caller."""
    if u == 0:
        return mp.mpf(0), mp.mpf(1), mp.mpf(1)
    if m == 1:
        return mp.tanh(u), mp.sech(u), mp.sech(u)
    if m > 1:
        k = mp.sqrt(m)
        sn, cn, dn = jacobi(k * u, 1 / m)
        return sn / k, dn, cn
    return tuple(mp.ellipfun(name, u, m=m).real for name in ("sn", "cn", "dn"))


def quarter_period(m=None, m1=None) -> mp.mpf:
    """The real quarter period of sn in u, for any m but 1."""
    m, digits = (exact(m), DIGITS) if m1 is None else complement(m1)
    with mp.workdps(digits):
        if m < 1:
            return mp.pi / (2 * mp.agm(1, mp.sqrt(1 - m)))
        return mp.pi / (2 * mp.agm(mp.sqrt(m), mp.sqrt(m - 1)))


def frequencies(epsilon: float, v0: np.ndarray) -> tuple[list, list]:
    """(ω, t) in Arb balls for θ0 = 0 and the floats as given: 200 bits, any number of them."""
    with flint.ctx.workprec(300):
        four = 4 * flint.arb(epsilon)
        separatrix = four.sqrt()
        omega, t = [], []
        for x in v0.tolist():
            v = flint.arb(x)
            gap = four - v * v
            if gap > 0:
                omega.append(separatrix.agm(gap.sqrt()) / 2)
            elif gap < 0:
                omega.append(v.agm((-gap).sqrt()))
            else:
                omega.append(flint.arb(0))
            t.append(abs(gap) / (v + separatrix))
        return omega, t


def relative_errors(got: np.ndarray, reference: list) -> np.ndarray:
    """got/reference − 1, in eps of the dtype of `got`; 0 where both are 0."""
    eps = float(np.finfo(got.dtype).eps)
    with flint.ctx.workprec(300):
        return np.array(
            [
                float(flint.arb(float(g)) / r - 1) / eps if r != 0 else (0.0 if g == 0 else np.inf)
                for g, r in zip(got, reference, strict=True)
            ]
        )
