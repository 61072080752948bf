"""The derivatives with respect to m, without a cancellation at any m.

With N = int_0^u sd^2, DLMF 22.16 gives d ph / d m = -dn N / 2.  The textbook form of N,
(E(u) - m1 u - m sn cd) / (m m1), is 0/0 at both ends.  Gauss's transformation (the step
of `steps`) turns it into a recursion whose every rung is a small positive correction,

    N = (1 + l)^3 / (2 (1 - l)) ((1 + l) l N' + z' - s c h / (d d')),

s, c, d, h and N' at the rung below, z' its argument and d' the d of this one; ascending,
Jacobi's imaginary transformation changes the sign of z' - s c h / (d d') and nothing
else.  l -> 0 leaves (z - sin z cos z) / 2 and (sinh z cosh z - z) / 2.
"""

import jax.numpy as jnp
from jaxtyping import Array, Float

from ._kinds import Kind, Scales, kind
from ._landen import climb
from ._steps import endless, foot, parity, steps

FloatArray = Float[Array, "..."]

LARGEST = 0.25  # of the floats: what stands for a slope beyond them
_LITTLE = 2e-3  # u^2 max(1, |m|): below, the series has the digits, above, the ladder


def _little(u, m):
    return u * u * jnp.maximum(1, jnp.abs(m)) < _LITTLE


def slopes(
    u: FloatArray,
    w: FloatArray,
    turns: FloatArray,
    functions: tuple[FloatArray, ...],
    m: FloatArray,
    m1: FloatArray,
    scales: Scales,
) -> tuple[FloatArray, FloatArray]:
    """(d ph / d m, (d dn / d m) / sn); `functions` are sn, cn, dn of u.

    One follows from the other, (d dn / d m) / sn = -(sn / 2 + m cn d ph / d m) / dn, where
    dn is not small, and the other from the one where cn is not.  On the hyperbolic side
    both are small, so each is computed: at dn = 0 the two poles of d dn / d m are
    taken together to -((1 + l)^2 s h / (2 d^2) - m cn M) / 2, M = N less its last term.

    negative     int sd^2(u | m) = m1^-3/2 int sn^2(z | mu), mu = -m / m1, z = sqrt(m1) u
    reciprocal   (d dn / d m) / sn = -cn (u + m^-3/2 N(sqrt(m) u | 1/m)) / 2
    """
    sn, cn, dn = functions
    is_ = kind(m, m1)
    b, c = _integral(w, turns, m, is_, scales)
    size = scales.size
    negative = size * size * (dn * u - sn * cn - scales.p * size * b * (dn * dn))
    reciprocal = cn * u + size * size * size * b
    # Out of range, but not inf, which times a tangent of 0 is no longer 0.
    largest = jnp.where(w < 0, -1, 1) * LARGEST * jnp.finfo(w.dtype).max
    b = jnp.where(endless(w, is_), largest, b * jnp.where(is_.swings, parity(turns), 1))
    c = jnp.where(endless(w, is_), largest, c * jnp.where(is_.swings, 1, parity(turns)))
    little = _little(u, m)
    ph = jnp.where(little, _series(u, m), -0.5 * jnp.where(is_.negative, negative, b))
    dn_small = is_.reciprocal & ~little
    by_ph = -(0.5 * sn + m * cn * ph) / jnp.where(dn_small, 1, dn)
    by_dn = -0.5 * jnp.where(is_.reciprocal, reciprocal, c)
    by_dn = jnp.where((is_.hyperbolic | is_.reciprocal) & ~little, by_dn, by_ph)
    from_dn = -(0.5 * sn + dn * by_dn) / (jnp.where(dn_small, m, 1) * jnp.where(dn_small, cn, 1))
    return jnp.where(dn_small, from_dn, ph), by_dn


def _integral(
    w: FloatArray, turns: FloatArray, m: FloatArray, is_: Kind, scales: Scales
) -> tuple[FloatArray, FloatArray]:
    """dn N of the ladder's own parameter, and what replaces it where dn passes zero.

    Ascending, N and z are carried divided by the cosh c at the foot: dn c and N / c have
    the size of 1 where dn and N leave the range of the floats.
    """
    rungs, product = climb(scales.p, scales.square)
    at = foot(w, is_)
    climbed = steps(at, is_, scales)[::-1]
    sign = jnp.where(is_.ascends, -1, 1)
    # Descending, z counts the turns; ascending, they are added below.
    z = w + jnp.where(is_.ascends, 0, turns * jnp.pi)
    inverse = 1 / jnp.where(is_.ascends, at.c, 1)
    z = z * inverse
    n = jnp.zeros_like(w)
    for rung, below, here in zip(rungs[:0:-1], climbed[:1:-1], climbed[-2:0:-1], strict=True):
        s, g, d, h = below
        pole = s * jnp.where(is_.ascends, g, at.c * g) * h / (d * here.d)
        n = _weight(rung) * ((1 + rung) * rung * n + sign * (z - pole))
        z = z * (1 + rung)
    rung, (s, g, d, h), top = rungs[0], climbed[1], climbed[0]
    weight = _weight(rung)
    m_over_c = weight * ((1 + rung) * rung * n + sign * z)
    ascending = s * h / (d * d)
    pole = jnp.where(is_.ascends, ascending, s * at.c * g * h / (d * top.h))
    dn_c = top.d / jnp.where(is_.ascends, top.g, top.h)
    cn_c = top.h / top.g
    # 1 / p meets dn and cn, of the size of its root or more, in two halves: its own
    # derivative, 1 / p^2, leaves the range of the floats where theirs does not.
    half, turned = _turned(turns, is_, scales, product)
    of_dn = dn_c * m_over_c + (dn_c * inverse * half) * (half * turned)
    of_cn = cn_c * m_over_c + (cn_c * inverse * half) * (half * turned)
    swinging = 0.5 * (1 + rung) * (1 + rung) * ascending - m * of_cn
    return of_dn - sign * weight * pole, swinging


def _weight(rung):
    return 0.5 * (1 + rung) * (1 + rung) * (1 + rung) / (1 - rung)


def _turned(turns, is_, scales, product):
    """N over the half periods taken off where the ladder ascends, and a factor of it
    that is taken out twice, |p|^-1/2.

    N(2 K) = 2 (E - m1 K) / (m m1) with the E = 1 / product + K S of `ellipe`, p = m1, is
    2 (1 / (p product) - K (1/2 - (S - p/2) / p)) / (1 - p).
    """
    rungs, _ = climb(scales.p, scales.square)
    t1 = 0.25 * rungs[0]
    t2 = 0.125 * t1 * (rungs[0] * (1 + rungs[1])) ** 2
    t3 = 0.125 * t2 * (rungs[1] * (1 + rungs[2])) ** 2
    turned = is_.ascends & (turns != 0)
    p = jnp.where(turned, scales.p, 0.5)
    sign = jnp.where(p < 0, -1, 1)
    k = 0.5 * jnp.where(turned, scales.half_period, 1) * product
    whole = 2 * (sign / product - sign * p * k * (0.5 - (t1 + t2 + t3))) / (1 - p)
    return 1 / jnp.sqrt(sign * p), jnp.where(turned, turns * whole, 0)


def _series(u, m):
    """d ph / d m for little u: the Maclaurin series of am u, differentiated."""
    x = u * u
    c5 = (4 + 2 * m) / 120
    c7 = (16 + m * (88 + 3 * m)) / 5040
    c9 = (64 + m * (1824 + m * (1224 + 4 * m))) / 362880
    c11 = (256 + m * (31616 + m * (92304 + m * (14752 + 5 * m)))) / 39916800
    return u * x * (-1 / 6 + x * (c5 - x * (c7 - x * (c9 - x * c11))))
