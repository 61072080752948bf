"""The integrals of the third kind: Π(n; φ | m), and Carlson's RJ for every p."""

from functools import partial

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, ArrayLike, Float

from .._arrays import common, widened
from ._carlson import rc
from ._cpu import DOZENS, in_blocks, where_needed
from ._domain import fenced
from ._duplication import ordered, rf, rj
from ._either import with_parameter
from ._elementary import reciprocal
from ._incomplete import at_quarter, one_less, per_turn
from ._integral import integral
from ._quarters import reduced

FloatArray = Float[Array, "..."]


def ellippiinc(
    n: ArrayLike, phi: ArrayLike, m: ArrayLike | None = None, *, m1: ArrayLike | None = None
) -> FloatArray:
    """Incomplete elliptic integral of the third kind,
    Π(n; φ | m) = ∫₀^φ dθ / ((1 − n sin²θ) √(1 − m sin²θ)).

    **Arguments:**

    - `n`: the characteristic, any real numbers.  **The sign is that of DLMF, Boost and
      Mathematica; the Spanish source's H(k, n, φ) of table 5.2.1 has 1 + n sin²θ and is
      Π(−n; φ | k²).**
    - `phi`: the amplitude φ, rad, any real numbers.
    - `m`: the parameter k² (not the modulus k), m ≤ 1; beyond, as long as m sin²φ ≤ 1 and
      |φ| ≤ π/2.  Or `m1` = 1 − m instead, for m so near to 1 that 1 − m has lost its digits.

    Shapes broadcast.

    **Returns:** Π, odd and quasi-periodic in φ; past a pole, n sin²φ > 1, the Cauchy
    principal value; inf on the pole.  For m = 1 ±inf from |φ| = π/2 on, for which its
    float stands.  The gradient is NaN where the value is infinite; NaN (value and gradient)
    outside the domain.

    **Raises:** `ValueError` unless exactly one of `m` and `m1` is given.

    Within 10 eps of |Π| + |n ∂Π/∂n| + |φ ∂Π/∂φ| + |m ∂Π/∂m| for |φ| up to 1e6, m and n from
    -1e10, m1 down to 1e-300 (float32: 1e4, 1e-36).  DLMF 19.2.7, 19.25.14, 19.7.
    """
    return with_parameter(_piinc, m, m1, phi=phi, n=n)


def ellippi(n: ArrayLike, m: ArrayLike | None = None, *, m1: ArrayLike | None = None) -> FloatArray:
    """Complete elliptic integral of the third kind, Π(n | m) = Π(n; π/2 | m).

    **Arguments:** as [`ellippiinc`][], sign of n included; shapes broadcast.

    **Returns:** Π: inf at n = 1; for n > 1 the Cauchy principal value; at m = 1 inf for
    n ≤ 1 and −inf above.  The gradient is NaN where the value is infinite; NaN (value and
    gradient) for m > 1.

    **Raises:** `ValueError` unless exactly one of `m` and `m1` is given.

    Within 10 eps of |Π| + |n ∂Π/∂n| + |m ∂Π/∂m|, domain as [`ellippiinc`][].  DLMF 19.2.8.
    """
    return with_parameter(_pi, m, m1, n=n)


def elliprj(x: ArrayLike, y: ArrayLike, z: ArrayLike, p: ArrayLike) -> FloatArray:
    """Carlson's RJ(x, y, z, p) = 3/2 ∫₀^∞ dt / (√((t + x)(t + y)(t + z)) (t + p)).

    **Arguments:** `x`, `y`, `z` ≥ 0, one of them 0 at most, `p` ≠ 0.  Shapes broadcast.

    **Returns:** RJ, the Cauchy principal value where p < 0; inf where two are 0; 0 where one
    is inf; NaN (value and gradient) for p = 0 and where x, y or z is negative.

    Within 20 eps of |RJ| + Σ |x ∂RJ/∂x| for arguments from 1e-300 to 1e300 (float32: 1e±36)
    where the result is a float; derivatives in an argument that is 0 as [`elliprf`][].
    DLMF 19.16.2; by Carlson's duplication, p out of range by 19.21.12.
    """
    return widened(_rj)(*common(x=x, y=y, z=z, p=p))


def third(s: FloatArray, c: FloatArray, n: FloatArray, m: FloatArray, m1: FloatArray) -> FloatArray:
    """Π for a sine, and a cosine ≥ 0.

    Everywhere F + n/3 s³ RJ(c², Δ², 1, p), p = 1 − n s², moved by DLMF 19.21.12 so that no
    large terms are left to cancel:

        p < 0; n < −1, m ≥ 0    s RC(c² Δ², p q) − m/3n s³ RJ(…, q),  q = 1 − (m / n) s²
        n < −1, m < 0           F / (1 − n) − n / (1 − n) (s c RC(Δ², p q)
                                + m1 / (1 − n) s³/3 RJ(…, q)),  q = c² + m1 s² / (1 − n)
    """
    cc, ss, one = c * c, s * s, jnp.ones_like(s)
    square, p = one_less(m, m1, s, c), one_less(n, 1 - n, s, c)
    by_one = (p < 0) | ((n < -1) & (m >= 0))
    by_cosine = (n < -1) & (m < 0)
    share = 1 / (1 - jnp.where(by_cosine, n, 0))
    divisor = jnp.where(by_one, n, -1)
    ratio = m / divisor
    q = jnp.where(by_one, one_less(ratio, ((divisor - 1) + m1) / divisor, s, c), p)
    q = jnp.where(by_cosine, cc + m1 * ss * share, q)
    of_rf = jnp.where(by_one, 0, share)
    of_rj = jnp.where(by_one, -ratio, jnp.where(by_cosine, (1 - share) * share * m1, n))
    of_rc = jnp.where(by_one, 1, jnp.where(by_cosine, (1 - share) * c, 0))
    x = jnp.where(by_one, cc * square, jnp.where(by_cosine, square, 1))
    y = jnp.where(by_one | by_cosine, p * q, 1)
    on_it = p == 0
    q, y = jnp.where(on_it, 1, q), jnp.where(on_it, 1, y)
    value = of_rf * rf(cc, square, one) + 1 / 3 * of_rj * ss * rj(cc, square, one, q)
    rest = where_needed(by_one | by_cosine, lambda *x: of_rc * rc(*x), x, y)
    return s * jnp.where(on_it, jnp.inf, value + rest)


def _whole(n, m, m1):
    """Π(n | m); sin and cos are here exact."""
    return third(jnp.ones_like(n), jnp.zeros_like(n), n, m, m1)


def _incomplete(phi, n, m, m1):
    turns, s, c = reduced(phi)
    value = per_turn(turns, _whole, n, m, m1) + third(s, c, n, m, m1)
    on_pole = (one_less(n, 1 - n, s, c) == 0) | ((n == 1) & (turns != 0))
    upwards = on_pole | (jnp.isinf(phi) & (n <= 1) & (m1 >= 0))
    at_end = (m1 == 0) & at_quarter(phi)
    sign = jnp.where(at_end & (n > 1), -jnp.inf, jnp.inf)
    value = jnp.where(upwards | at_end, lax.stop_gradient(sign * phi), value)
    none = (jnp.isinf(n) & ~jnp.isinf(phi)) | (jnp.isinf(m1) & (m1 > 0))
    return jnp.where(none, 0, value)


def _integrand(phi, n, m, m1):
    _, s, c = reduced(phi)
    return 1 / (one_less(n, 1 - n, s, c) * jnp.sqrt(one_less(m, m1, s, c)))


_piinc = jax.jit(integral(_incomplete, _integrand))
_pi_whole = integral(_whole)


@jax.jit
def _pi(n: FloatArray, m: FloatArray, m1: FloatArray) -> FloatArray:
    n, m, m1 = jnp.broadcast_arrays(n, m, m1)
    valid = (m1 > 0) & (n != 1) & ~jnp.isinf(n) & ~jnp.isinf(m)
    outside = jnp.where(n > 1, -jnp.inf, jnp.where(jnp.isinf(n), 0, jnp.inf))
    outside = jnp.where(m1 > 0, jnp.where(n == 1, jnp.inf, 0), outside)
    outside = jnp.where((m1 >= 0) & ~jnp.isnan(n), outside, jnp.nan)
    safe = (jnp.where(valid, x, at) for x, at in ((n, 0), (m, 0), (m1, 1)))
    return fenced(_pi_whole(*safe), valid, outside, n, m)


def _rj_fenced(inside, x, y, z, p):
    ((_, middle, _),) = ordered(x, y, z)
    none_below = (x >= 0) & (y >= 0) & (z >= 0) & (p != 0) & ~jnp.isnan(p)
    endless = jnp.isinf(x) | jnp.isinf(y) | jnp.isinf(z) | jnp.isinf(p)
    valid = none_below & ~endless & (middle > 0)
    outside = jnp.where(endless, jnp.nan, lax.stop_gradient(jnp.inf * p))
    outside = jnp.where(none_below, jnp.where(middle > 0, 0, outside), jnp.nan)
    safe = (jnp.where(valid, t, 1) for t in (x, y, z, p))
    return fenced(inside(*safe), valid, outside, x, y, z, p)


@jax.custom_jvp
def _rj_everywhere(x: FloatArray, y: FloatArray, z: FloatArray, p: FloatArray) -> FloatArray:
    return _rj_value(x, y, z, p)[0]


@_rj_everywhere.defjvp
def _rj_jvp(primals, tangents):
    return _rj_everywhere(*primals), jax.jvp(partial(_rj_fenced, _rj_inside), primals, tangents)[1]


_rj = jax.jit(_rj_everywhere)


@partial(in_blocks, most=DOZENS)
def _rj_value(x, y, z, p):
    def inside(x, y, z, p):
        usual = (p > 0) & (p <= 8 * jnp.maximum(x, jnp.maximum(y, z)))
        return lax.cond(jnp.all(usual), rj, _rj_inside, x, y, z, p)

    return (_rj_fenced(inside, x, y, z, p),)


def _rj_inside(x, y, z, p):
    """With x ≤ y ≤ z, DLMF 19.21.12 about z for p < 0 and for a large p: about the middle one
    (19.20.14), p < 0 leaves a difference of two large numbers to derivatives."""
    ((x, y, z),) = ordered(x, y, z)
    past, large = p < 0, p > 8 * z
    over = reciprocal(jnp.where(past, z - p, jnp.where(large, p - z, z)))
    rest, share = (z - y) * over, z * over
    unit = jnp.where(past | large, lax.stop_gradient(_unit(y, z)), 1)
    x, y, z, p = (t * unit for t in (x, y, z, p))
    per_z, away = reciprocal(z), (z - x) * rest
    # z − away, a sum of positive terms.
    q_past = (y + x * (z - y) * per_z - p) * share
    q = jnp.where(past, q_past, jnp.where(large, z + away, p))
    last = rj(x, y, z, q)

    # Where a first argument of RC leaves the range of the floats, it is 0, derivatives too.
    largest = float(jnp.finfo(p.dtype).max)
    least = x * (y * per_z)
    least = jnp.where(least > 1e8 / largest, least, 0)
    far = jnp.clip(p, -largest / 8, largest / 8) * (q * per_z)
    of_rc = rc(*(jnp.where(past | large, t, 1) for t in (least, far)))
    moved = jnp.where(past, -3, 3) * (rf(x, y, z) - of_rc) - away * last
    return jnp.where(past | large, moved * over, last * unit) * jnp.sqrt(unit)


def _unit(y, z):
    """1 / z, for products of RJ and an argument to stay floats; where y would not, some
    power of 2."""
    exponent = jnp.finfo(z.dtype).maxexp
    away = jnp.where(z > 2.0 ** (0.6 * exponent), 2.0 ** (-0.3 * exponent), jnp.ones_like(z))
    return jnp.where(y > 2.0 ** (-0.9 * exponent) * z, 1 / z, away)
