"""The inverse of sn: F in Jacobi's form."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from ._duplication import rf
from ._either import with_parameter
from ._integral import integral

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

    Within 8 eps of |u| + |x du/dx| + |m du/dm|.  DLMF 22.15, 19.25.31; Jacobi's form of the
    first integral of the Spanish source's table 5.2.1, [`ellipkinc`][] being Legendre's.
    """
    return with_parameter(_arcsn, m, m1, x=x)


def inverse(sn: FloatArray, cn2: FloatArray, dn2: FloatArray) -> FloatArray:
    """The u within a quarter period of 0 with this sn, cn² and dn²."""
    endless = (cn2 == 0) & (dn2 == 0)
    u = sn * rf(jnp.where(endless, 1, cn2), jnp.where(endless, 1, dn2), jnp.ones_like(cn2))
    return jnp.where(endless, jnp.copysign(jnp.inf, sn), u)


def _squares(x, m, m1):
    """cn² and dn², without a cancellation where they vanish."""
    cn2 = (1 - x) * (1 + x)
    return cn2, jnp.where((m > 0.5) & (m <= 2), m1 + m * cn2, 1 - m * x * x)


def _value(x, m, m1):
    return inverse(x, *_squares(x, m, m1))


def _integrand(x, m, m1):
    cn2, dn2 = _squares(x, m, m1)
    return 1 / (jnp.sqrt(cn2) * jnp.sqrt(dn2))


_arcsn = jax.jit(integral(_value, _integrand))
