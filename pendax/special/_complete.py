"""The complete integrals K and E, for every real parameter up to 1."""

from functools import partial

import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._arrays import common, widened
from ._cpu import in_blocks
from ._landen import LN2, Ladder, ladder, log_nome, nome16


def ellipk(m: ArrayLike) -> Float[Array, "..."]:
    """Complete elliptic integral of the first kind, K(m) = F(pi/2 | m).

    **Arguments:** `m`, the parameter k^2 (not the modulus k), any shape, m <= 1.

    **Returns:** K, the shape of `m`: inf at m = 1, as is its derivative, NaN (value and
    gradient) above, 0 at -inf.

    Near m = 1 use [`ellipkm1`][], which takes 1 - m.  Within 3 eps relative for m from
    -1e300 to the float below 1 (float32: 3.2 eps, from -1e36).
    DLMF 19.2.8, computed by 19.8.5 and the Landen ladder.
    """
    (m,) = common(m=m)
    return widened(lambda m: _k(m, 1 - m))(m)


def ellipkm1(p: ArrayLike) -> Float[Array, "..."]:
    """Complete elliptic integral of the first kind around m = 1, K(1 - p).

    **Arguments:** `p`, the complement 1 - m, any shape, p >= 0.

    **Returns:** K, the shape of `p`: inf at p = 0, and at the subnormal numbers, which
    XLA takes for 0; NaN (value and gradient) below; 0 at inf.

    Within 3 eps relative for p from the smallest normal number to 1e300 (float32: 3.2 eps, to
    1e36).
    """
    (p,) = common(p=p)
    return widened(lambda p: _k(1 - p, p))(p)


def ellipe(m: ArrayLike) -> Float[Array, "..."]:
    """Complete elliptic integral of the second kind, E(m) = E(pi/2 | m).

    **Arguments:** `m`, the parameter k^2 (not the modulus k), any shape, m <= 1.

    **Returns:** E, the shape of `m`: 1 at m = 1, where the derivative is -inf, NaN (value
    and gradient) above, inf at -inf.

    Within 3 eps relative for m from -1e300 to 1 (float32: -1e36).  DLMF 19.2.8.
    """
    (m,) = common(m=m)
    return widened(lambda m: _e(m, 1 - m))(m)


def _inside(which, slope):
    """K or E where m1 > 0, in blocks.  Its derivatives are those of its steps, and `slope`
    for m < -1 and m > 1/2, where those would form 1 / m1^2."""

    def steps(m, m1):
        return _complete(m, jnp.where(m1 > 0, m1, 1))[which]

    value = jax.jit(in_blocks(lambda m, m1: (steps(m, m1),)))

    @jax.custom_jvp
    def call(m, m1):
        return value(m, m1)[0]

    @call.defjvp
    def _(primals, tangents):
        m, m1 = primals
        far = (m < -1) | ((m > 0.5) & (m1 > 0))
        near = ~far & (m1 > 0)
        moved = [jnp.where(near, x, 0) for x in tangents]
        near = [jnp.where(near, x, safe) for x, safe in zip(primals, (0, 1), strict=True)]
        by_steps = jax.jvp(jax.jit(steps), near, moved)[1]
        away = [jnp.where(far, x, safe) for x, safe in zip(primals, (-2, 3), strict=True)]
        by_slope = slope(*away) * jnp.where(far, tangents[0], 0)
        return call(*primals), by_steps + by_slope

    return call


# DLMF 19.4.1 and 19.4.2.
_k_inside = _inside(0, lambda m, m1: (_e_inside(m, m1) / m1 - _k_inside(m, m1)) / (2 * m))
_e_inside = _inside(1, lambda m, m1: (_e_inside(m, m1) - _k_inside(m, m1)) / (2 * m))


def _k(m, m1):
    return edged(_k_inside(m, m1), m1, jnp.inf, -jnp.inf)


def _e(m, m1):
    return edged(_e_inside(m, m1), m1, 1.0, jnp.inf)


@partial(jax.custom_jvp, nondiff_argnums=(2, 3))
def edged(inside, m1, at_one, slope):
    """`inside` for m1 > 0; at m1 = 0 `at_one`, whose derivative in m1 is `slope`; NaN with
    a NaN gradient for m1 < 0."""
    del slope
    return jnp.where(m1 > 0, inside, jnp.where(m1 == 0, at_one, jnp.nan))


@edged.defjvp
def _edged_jvp(at_one, slope, primals, tangents):
    inside, m1 = primals
    d_inside, d_m1 = tangents
    edge = jnp.where(m1 == 0, slope, jnp.nan) * (1 - jnp.where(m1 > 0, 0, m1))
    return edged(inside, m1, at_one, slope), (
        jnp.where(m1 > 0, 1, 0) * d_inside + jnp.where(m1 > 0, 0, edge) * d_m1
    )


def _complete(
    m: Float[Array, "..."], m1: Float[Array, "..."]
) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    """(K, E) for arguments of one dtype; m + m1 = 1, each as exact as known; m1 > 0.

    With the ladder of p, |p| <= 1/2 or so, P = prod(1 + l_n) and
    S = sum 2^(n-1) c_n^2 (DLMF 19.8.6), every term positive for p > 0:

        -1 <= m <= 1/2   p = m     K = pi P / 2,         E = K (1 - S)
        1/2 < m < 1      p = m1    K = -ln(q) P / 2,     E = 1 / P + K S
        m < -1           p = 1/m1  the same, K / sqrt(m1) and E sqrt(m1)  (DLMF 19.7.2)

    The second line's E is Legendre's relation (DLMF 19.7.1) solved for E: it replaces
    E = K (1 - S(m)), whose difference loses the digits of K as m -> 1.
    """
    circular = (m >= -1) & (m <= 0.5)
    negative = m < -1
    divisor = jnp.where(negative, m1, 1)
    p = jnp.where(circular, m, jnp.where(negative, 1 / divisor, m1))
    scale = jnp.sqrt(divisor)
    rungs = ladder(p)

    # Where 1 / m1 is no normal number any more, 4 / m1 still is, and 16 q is 1 / m1.
    last = divisor > 0.25 / jnp.finfo(m.dtype).tiny
    q16 = jnp.where(circular, 1, jnp.where(last, 4 / divisor, nome16(rungs)))
    half_period = log_nome(q16) + jnp.where(last, 2 * LN2, 0)
    quarter = jnp.where(circular, 0.5 * jnp.pi, 0.5 * half_period)
    k = quarter * rungs.product
    s = _squares(p, rungs)
    e = jnp.where(circular, k * (1 - s), 1 / rungs.product + k * s)
    return jnp.where(jnp.isinf(m1), 0, k / scale), jnp.where(jnp.isinf(m1), jnp.inf, e * scale)


def _squares(p: Float[Array, "..."], rungs: Ladder) -> Float[Array, "..."]:
    """S = sum 2^(n-1) c_n^2 of the AGM of 1 and sqrt(1 - p); c_n = l_n a_n, c_0^2 = p."""
    mean = 0.5 * (1 + rungs.root)
    total = 0.5 * p
    power = 1.0
    for this, following in zip(rungs.rungs, (*rungs.rungs[1:], None), strict=True):
        c = this * mean
        total = total + power * (c * c)
        power *= 2
        if following is not None:
            mean = mean / (1 + following)
    return total
