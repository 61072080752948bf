"""The undamped pendulum in Arb balls: by F(φ | m) and Jacobi functions of a shifted argument."""

import math
from itertools import combinations_with_replacement

import flint
import references

ARGUMENTS = range(4)  # ε, t, v0, θ0


def motion(epsilon, t, v0, theta0) -> tuple[flint.arb, flint.arb]:
    """θ (unwrapped) and θ̇ for balls, in the precision of the caller."""
    root = epsilon.sqrt()
    half = theta0 / 2
    s0, c0, w0 = half.sin(), half.cos(), v0 / (2 * root)
    m = s0 * s0 + w0 * w0
    m1 = c0 * c0 - w0 * w0
    u = root * t
    if m1 < 0:
        direction = 1 if v0 > 0 else -1
        k = m.sqrt()
        mu, mu1 = 1 / m, -m1 / m
        quarter = flint.arb.pi() / (2 * flint.arb(1).agm(mu1.sqrt()))
        x = k * u + direction * first_kind(half, mu, quarter)
        turns = nearest(x / (2 * quarter))
        sn, cn, dn = references.ball_jacobi(x - 2 * quarter * turns, mu, mu1)
        am = flint.arb.atan2(sn, cn)
        return 2 * direction * (am + turns * flint.arb.pi()), 2 * root * direction * k * dn
    well = nearest(half / flint.arb.pi())
    s0 = -s0 if well % 2 else s0
    if m == 0:
        return theta0, flint.arb(0)
    k = m.sqrt()
    phi = flint.arb.atan2(s0, w0)
    if m1 == 0:
        # On the separatrix: sin(θ/2) = ± tanh.
        if w0 == 0:
            return theta0, flint.arb(0)
        sign = 1 if w0 > 0 else -1
        x = u + sign * s0.atanh()
        return (
            2 * (well * flint.arb.pi() + sign * flint.arb.atan2(x.sinh(), flint.arb(1))),
            2 * root * sign / x.cosh(),
        )
    quarter = flint.arb.pi() / (2 * flint.arb(1).agm(m1.sqrt()))
    x = u + first_kind(phi, m, quarter)
    turns = nearest(x / (2 * quarter))
    sn, cn, dn = references.ball_jacobi(x - 2 * quarter * turns, m, m1)
    sign = -1 if turns % 2 else 1
    theta = flint.arb.atan2(sign * k * sn, dn)
    return 2 * (theta + well * flint.arb.pi()), 2 * root * sign * k * cn


def first_kind(phi, m, quarter):
    """F(φ | m), 0 <= m < 1, any real φ."""
    turns = nearest(phi / flint.arb.pi())
    rest = phi - turns * flint.arb.pi()
    return flint.acb.elliptic_f(flint.acb(rest), flint.acb(m)).real + 2 * quarter * turns


def nearest(x: flint.arb) -> int:
    """Of a ball around an odd half either neighbour: none of the callers cares which."""
    up = x + flint.arb(0.5)
    return int((up.floor().unique_fmpz() or up.mid().floor().unique_fmpz()) or 0)


def derivatives(point, order=2) -> dict[tuple[int, ...], tuple]:
    """Of θ and v by (ε, t, v0, θ0) at floats: a sorted tuple of argument numbers -> (θ…, v…).

    By central differences, of step 2^-80 of each argument's own scale or of the distance to
    the separatrix if that is smaller.
    """
    point = [float(x) for x in point]
    epsilon, t, v0, theta0 = point
    with flint.ctx.workprec(2200):
        cos = (flint.arb(theta0) / 2).cos()
        gap = float(abs(cos * cos - flint.arb(v0) ** 2 / (4 * flint.arb(epsilon))))
    scales = [abs(epsilon), max(abs(t), 1e-3 / math.sqrt(epsilon)), math.sqrt(epsilon), 1.0]
    spread = math.sqrt(epsilon) * abs(t) if gap < 1e-3 else 0
    small = 100 + 2 * math.ceil(-math.log2(gap)) if gap > 0 else 100
    if gap < 1e-14:
        small += math.ceil(3 * min(spread, 60 - math.log(gap + 1e-40)))
    shift = 60 + small
    with flint.ctx.workprec(700 + 4 * shift):
        at = [flint.arb(x) for x in point]
        steps = [flint.arb(x) * flint.arb(2) ** -shift for x in scales]
        values = {}

        def value(offset):
            if offset not in values:
                moved = [x + n * h for x, n, h in zip(at, offset, steps, strict=True)]
                values[offset] = motion(*moved)
            return values[offset]

        def offset(*moves):
            total = [0, 0, 0, 0]
            for i, n in moves:
                total[i] += n
            return tuple(total)

        zero = offset()
        result = {(): value(zero)}
        for i in range(4):
            up, down = value(offset((i, 1))), value(offset((i, -1)))
            result[i,] = tuple((a - b) / (2 * steps[i]) for a, b in zip(up, down, strict=True))
            if order > 1:
                result[i, i] = tuple(
                    (a + b - 2 * c) / steps[i] ** 2
                    for a, b, c in zip(up, down, value(zero), strict=True)
                )
        if order > 1:
            for i, j in combinations_with_replacement(range(4), 2):
                if i != j:
                    corners = [
                        value(offset((i, a), (j, b)))
                        for a, b in ((1, 1), (-1, -1), (1, -1), (-1, 1))
                    ]
                    result[i, j] = tuple(
                        (p + q - r - s) / (4 * steps[i] * steps[j])
                        for p, q, r, s in zip(*corners, strict=True)
                    )
        return result


def magnitude(row, d, f, order=()):
    """|g| + Σ |x ∂g/∂x| of the derivative `order` of θ (f = 0) or v (f = 1)."""
    slopes = (d[tuple(sorted((*order, i)))][f] for i in ARGUMENTS)
    return abs(float(d[order][f])) + sum(
        abs(x * float(slope)) for x, slope in zip(row, slopes, strict=True)
    )


def units(row):
    return [abs(row[0]), *(max(abs(x), 1) for x in row[1:])]
