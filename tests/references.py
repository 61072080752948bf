"""Reference values in high precision, by mpmath and by Arb; nothing here is pendax's."""

import math

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


def derivatives(u, name, parameter) -> dict[tuple[int, int], list]:
    """Of sn, cn, dn, ph by u and the parameter `name`: (i, j) -> four Arb balls, i + j <= 2;
    (0, 0) has sn, cn, dn alone.

    By central differences of step 2^-80 of the functions' own scale, so good to 2^-160,
    of theta functions in Arb, at the precision that this takes.
    """
    u, parameter = float(u), float(parameter)
    small = abs(parameter) if name == "m1" and 0 < abs(parameter) < 1 else 1.0
    bits = 500 + 3 * math.ceil(-math.log2(small))
    bits += 5 * math.ceil(-math.log2(abs(u))) if 0 < abs(u) < 1 else 0
    step_m = flint.arb(2) ** -80 * flint.arb(max(small, abs(parameter)) if small == 1 else small)
    step_u = flint.arb(2) ** -80 * flint.arb(abs(u) if 0 < abs(u) < 1 else 1)
    if (name, parameter) in (("m", 1), ("m1", 0)):  # the scale is e^-2u here
        bits, step_m = 4000, flint.arb(2) ** -1000
    if u == 0:
        bits, step_u = bits + 1500, flint.arb(2) ** -300
    with flint.ctx.workprec(bits):
        values = {}
        for i in (-1, 0, 1):
            for j in (-1, 0, 1):
                p = flint.arb(parameter) + j * step_m
                m, m1 = (p, 1 - p) if name == "m" else (1 - p, p)
                values[i, j] = ball_jacobi(flint.arb(u) + i * step_u, m, m1)

        def combined(weights, divisor):
            terms = range(3)
            return [sum(w * values[k][n] for k, w in weights.items()) / divisor for n in terms]

        d = {
            (0, 0): list(values[0, 0]),
            (1, 0): combined({(1, 0): 1, (-1, 0): -1}, 2 * step_u),
            (0, 1): combined({(0, 1): 1, (0, -1): -1}, 2 * step_m),
            (2, 0): combined({(1, 0): 1, (-1, 0): 1, (0, 0): -2}, step_u**2),
            (0, 2): combined({(0, 1): 1, (0, -1): 1, (0, 0): -2}, step_m**2),
            (1, 1): combined(
                {(1, 1): 1, (-1, -1): 1, (1, -1): -1, (-1, 1): -1}, 4 * step_u * step_m
            ),
        }
        # ph from sn and cn: ph_x = cn sn_x - sn cn_x.
        sn, cn, _ = d[0, 0]
        for x in ((1, 0), (0, 1)):
            d[x].append(cn * d[x][0] - sn * d[x][1])
        for x, y in (((1, 0), (1, 0)), ((1, 0), (0, 1)), ((0, 1), (0, 1))):
            both = d[x[0] + y[0], x[1] + y[1]]
            turn = d[y][1] * d[x][0] - d[y][0] * d[x][1]
            both.append(turn + cn * both[0] - sn * both[1])
        return d


def ball_jacobi(u: flint.arb, m: flint.arb, m1: flint.arb) -> tuple:
    """sn, cn, dn for m + m1 = 1 in Arb, by DLMF 22.2, 22.17 and 22.5."""
    if m1 < 0:
        k = m.sqrt()
        sn, cn, dn = ball_jacobi(k * u, 1 / m, -m1 / m)
        return sn / k, dn, cn
    if m < 0:
        k = m1.sqrt()
        sn, cn, dn = ball_jacobi(k * u, -m / m1, 1 / m1)
        return sn / (dn * k), cn / dn, 1 / dn
    if m1 == 0:
        return u.tanh(), 1 / u.cosh(), 1 / u.cosh()
    if m == 0:
        return u.sin(), u.cos(), flint.arb(1)
    quarter = flint.arb.pi() / (2 * flint.arb(1).agm(m1.sqrt()))
    height = flint.arb.pi() / (2 * flint.arb(1).agm(m.sqrt()))
    tau = flint.acb(0, height / quarter)
    t1, t2, t3, t4 = flint.acb(u / (2 * quarter)).modular_theta(tau)
    _, b, c, d = flint.acb(0).modular_theta(tau)
    return (c / b * t1 / t4).real, (d / b * t2 / t4).real, (d / c * t3 / t4).real


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
