"""The nome."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from ._complete import edged
from ._either import with_parameter
from ._landen import ladder, log_nome, nome16


def ellipnome(m: ArrayLike | None = None, *, m1: ArrayLike | None = None) -> Float[Array, "..."]:
    """The nome q = exp(-pi K(1 - m) / K(m)).

    **Arguments:** `m`, the parameter k^2 (not the modulus k), any shape, 0 <= m <= 1; or
    `m1` = 1 - m instead, for m so near to 1 that 1 - m has lost its digits.

    **Returns:** q, the shape of the parameter: 0 at m = 0 (with the derivative 1/16), 1 at
    m = 1 (with an infinite one); NaN (value and gradient) outside.

    **Raises:** `ValueError` unless exactly one of `m` and `m1` is given.

    Within 8 eps of |q| + |m dq/dm|.  DLMF 19.5.7 for m <= 1/2; beyond, the same for m1 and
    ln q(m) ln q(m1) = pi^2.
    """
    return with_parameter(_nome, m, m1)


@jax.jit
def _nome(m: Float[Array, "..."], m1: Float[Array, "..."]) -> Float[Array, "..."]:
    far = (m > 0.5) & (m1 > 0)
    p = jnp.where(far, m1, jnp.where((m >= 0) & (m <= 0.5), m, 0.25))
    q16 = nome16(ladder(p))
    near_one = jnp.exp(-(jnp.pi**2) / log_nome(jnp.where(far, q16, 0.25)))
    q = jnp.where(far, near_one, q16 / 16)
    below = jnp.where(m >= 0, 1, m)
    q = jnp.where(m >= 0, q, jnp.nan * (below * below * below))  # its derivatives NaN, too
    return edged(q, m1, 1.0, -jnp.inf)
