"""The inverse of sn."""

from functools import partial

import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, ArrayLike, Float

from ._either import with_parameter
from ._jacobi import jacobi_and_slopes
from ._kinds import kind, scales
from ._landen import climb

FloatArray = Float[Array, "..."]


def arcsn(x: ArrayLike, m: ArrayLike | None = None, *, m1: ArrayLike | None = None) -> FloatArray:
    """The u within a quarter period of 0 with sn(u | m) = x, which is F(arcsin x | m).

    **Arguments:**

    - `x`: |x| <= 1, and m x^2 <= 1.
    - `m`: the parameter k^2 (not the modulus k), any real numbers.
    - `m1`: the complement 1 - m, instead of `m`, for m so near to 1 that 1 - m has lost
      its digits.

    Shapes broadcast.

    **Returns:** u; at |x| = 1 it is the quarter period K(m), +-inf for m = 1, and the
    derivative in x is infinite.  For m > 1 the quarter period K(1/m)/sqrt(m) is reached at
    m x^2 = 1, and the derivatives in x and m are infinite there.  NaN (value and gradient)
    outside, be it by one rounding: clip measured values first.

    **Raises:** `ValueError` unless exactly one of `m` and `m1` is given.

    Within 8 eps of |u| + |x du/dx| + |m du/dm|.  DLMF 22.15; computed by 22.7, upside down.
    """
    return with_parameter(_arcsn, m, m1, x=x)


@jax.custom_jvp
def _arcsn(x: FloatArray, m: FloatArray, m1: FloatArray) -> FloatArray:
    return _value(x, m, m1)


@partial(_arcsn.defjvp, symbolic_zeros=True)
def _arcsn_jvp(primals, tangents):
    # From sn(u(x, m) | m) = x.
    x, m, m1 = primals
    dx, dm, _ = tangents
    u = _arcsn(x, m, m1)
    cn2, dn2 = _squares(x, m, m1)
    tangent = jnp.zeros_like(u)
    if not isinstance(dx, SymbolicZero):
        tangent = tangent + dx / (jnp.sqrt(cn2) * jnp.sqrt(dn2))
    if not isinstance(dm, SymbolicZero):
        *_, of_ph, _ = jacobi_and_slopes(u, m, m1)
        tangent = tangent - of_ph / jnp.sqrt(dn2) * dm
    return u, tangent


def _squares(x, m, m1):
    """cn^2 and dn^2, without a cancellation where they vanish."""
    cn2 = (1 - x) * (1 + x)
    return cn2, jnp.where((m > 0.5) & (m <= 2), m1 + m * cn2, 1 - m * x * x)


@jax.jit
def _value(x: FloatArray, m: FloatArray, m1: FloatArray) -> FloatArray:
    cn2, dn2 = _squares(x, m, m1)
    return inverse(x, jnp.sqrt(cn2), jnp.sqrt(dn2), m, m1)


def inverse(
    sn: FloatArray, cn: FloatArray, dn: FloatArray, m: FloatArray, m1: FloatArray
) -> FloatArray:
    """The u within a quarter period of 0 with these functions, cn and dn >= 0.

    Down the ladder: with h = 1 below, Gauss's step is

    s' = 2 s / ((1 + l) (h + d)),  c' = 2 c / ((h + d) d'),  d' = sqrt(1 + l^2 s'^2),

    with the sign of l^2 turned where it descends to the circular functions; there u is
    the angle of (s, c) at the foot, else asinh s.  Not to be differentiated.
    """
    is_, of_m = kind(m, m1), scales(m, m1)
    rungs, _ = climb(of_m.p, of_m.square)
    scale = jnp.where(is_.negative | is_.reciprocal, 1 / of_m.size, 1)

    # sn, cn, dn of the ladder's own parameter, over h.
    s = scale * sn
    c = jnp.where(is_.reciprocal, dn, cn)
    d = jnp.where(is_.ascends, jnp.where(is_.negative, 1, dn), jnp.where(is_.reciprocal, cn, dn))
    endless = (cn == 0) & (dn == 0)
    h = jnp.where(is_.ascends & ~endless, cn, 1)
    sign = jnp.where(is_.ascends, 1, -1)
    for rung in rungs:
        s, c = 2 * s / ((1 + rung) * (h + d)), 2 * c / (h + d)
        d, h = jnp.sqrt(1 + sign * (rung * s) * (rung * s)), 1
        c = c / d
    w = jnp.where(is_.ascends, jnp.arcsinh(s), jnp.arctan2(jnp.where(is_.ascends, 0, s), c))
    return jnp.where(endless, sn * jnp.inf, w / of_m.factor)
