"""The incomplete integrals of the first and second kind, F(φ | m) and E(φ | m)."""

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, ArrayLike, Float

from ._complete import _e, _k
from ._cpu import where_needed
from ._duplication import rd, rf, rf_and_rd
from ._either import with_parameter
from ._integral import integral
from ._quarters import reduced

FloatArray = Float[Array, "..."]


def ellipkinc(
    phi: ArrayLike, m: ArrayLike | None = None, *, m1: ArrayLike | None = None
) -> FloatArray:
    """Incomplete elliptic integral of the first kind, F(φ | m) = ∫₀^φ dθ / √(1 − m sin²θ).

    **Arguments:**

    - `phi`: the amplitude φ, rad, any real numbers.
    - `m`: the parameter k² (not the modulus k), m ≤ 1; beyond, as long as m sin²φ ≤ 1 and
      |φ| ≤ π/2.
    - `m1`: the complement 1 − m, instead of `m`, for m so near to 1 that 1 − m has lost its
      digits.

    Shapes broadcast.

    **Returns:** F, odd and quasi-periodic in φ: F(φ + π) = F(φ) + 2 K.  For m = 1 ±inf from
    |φ| = π/2 on, for which its float stands, and the gradient is NaN where the value is
    infinite; NaN (value and gradient) outside the domain.

    **Raises:** `ValueError` unless exactly one of `m` and `m1` is given.

    Within 10 eps of |F| + |φ ∂F/∂φ| + |m ∂F/∂m| for |φ| up to 1e6, m from -1e10, m1 down to
    1e-300 (float32: 1e4, 1e-36).  DLMF 19.2.4, 19.25.5; the first integral of the Spanish
    source's table 5.2.1, in Jacobi's form [`arcsn`][].
    """
    return with_parameter(_kinc, m, m1, phi=phi)


def ellipeinc(
    phi: ArrayLike, m: ArrayLike | None = None, *, m1: ArrayLike | None = None
) -> FloatArray:
    """Incomplete elliptic integral of the second kind, E(φ | m) = ∫₀^φ √(1 − m sin²θ) dθ.

    **Arguments:** as [`ellipkinc`][].

    **Returns:** E, odd and quasi-periodic in φ: E(φ + π) = E(φ) + 2 E(m); NaN (value and
    gradient) outside the domain.

    **Raises:** `ValueError` unless exactly one of `m` and `m1` is given.

    Within 10 eps of |E| + |φ ∂E/∂φ| + |m ∂E/∂m|, as [`ellipkinc`][].  DLMF 19.2.5, computed
    by 19.25.9 for m < 0 and by 19.25.10 for m ≥ 0, in which all terms are positive.
    """
    return with_parameter(_einc, m, m1, phi=phi)


@jax.custom_jvp
def one_less(x: FloatArray, x1: FloatArray, s: FloatArray, c: FloatArray) -> FloatArray:
    """1 − x sin² of a sine and cosine, x1 = 1 − x; without a cancellation for x ≤ 1.  To
    derivatives x1 is 1 − x, as in [`integral`][]: their −sin² would be −1 + cos²."""
    by_cosine = (x > 0.5) & (s * s > c * c)
    return jnp.where(by_cosine, x1 + x * (c * c), 1 - (x * s) * s)


@one_less.defjvp
def _one_less_jvp(primals, tangents):
    x, _, s, c = primals
    dx, _, ds, dc = tangents
    by_cosine = (x > 0.5) & (s * s > c * c)
    turned = jnp.where(by_cosine, (x * c) * dc, -(x * s) * ds)
    return one_less(*primals), 2 * turned - s * s * dx


def per_turn(turns: FloatArray, complete, *parameters: FloatArray) -> FloatArray:
    """2 turns complete(parameters…), 0 where there are none."""
    none = turns == 0

    def some(turns, *parameters):
        safe = [jnp.where(none, 0, x) for x in parameters[:-1]]
        return jnp.where(none, 0, 2 * turns * complete(*safe, jnp.where(none, 1, parameters[-1])))

    return where_needed(~none, some, turns, *parameters)


def _first(phi, m, m1):
    turns, s, c = reduced(phi)
    value = s * rf(c * c, one_less(m, m1, s, c), jnp.ones_like(phi))
    value = per_turn(turns, _k, m, m1) + value
    far = jnp.isinf(m1) & (m1 > 0)
    endless = (m1 == 0) & at_quarter(phi) | jnp.isinf(phi) & (m1 >= 0) & ~far
    value = jnp.where(endless, lax.stop_gradient(jnp.inf * phi), value)
    return jnp.where(far & ~jnp.isinf(phi), 0, value)


def _first_integrand(phi, m, m1):
    _, s, c = reduced(phi)
    return 1 / jnp.sqrt(one_less(m, m1, s, c))


def _second(phi, m, m1):
    turns, s, c = reduced(phi)
    square, one = one_less(m, m1, s, c), jnp.ones_like(phi)
    by_delta = (m > 0) & (m1 >= 0)
    pair = jnp.where(by_delta, one, square), jnp.where(by_delta, square, one)
    of_rf, of_rd = jnp.where(by_delta, m1, 1), jnp.where(by_delta, m1, -1) * (m / 3)
    value = rf_and_rd(c * c, *pair, of_rf, (of_rd * s) * s)
    value = value + jnp.where(by_delta, m * c / jnp.sqrt(square), 0)
    value = per_turn(turns, _e, m, m1) + s * value
    endless = (jnp.isinf(phi) | jnp.isinf(m1)) & (m1 >= 0)
    return jnp.where(endless, jnp.where(phi == 0, 0, jnp.inf * phi), value)


def _second_integrand(phi, m, m1):
    _, s, c = reduced(phi)
    return jnp.sqrt(one_less(m, m1, s, c))


def _second_by_m(phi, m, m1):
    turns, s, c = reduced(phi)
    third = rd(c * c, one_less(m, m1, s, c), jnp.ones_like(phi))
    return per_turn(turns, _e_by_m, m, m1) - 1 / 6 * (s * s * s) * third


def _second_by_m_integrand(phi, m, m1):
    _, s, c = reduced(phi)
    return -0.5 * (s * s) / jnp.sqrt(one_less(m, m1, s, c))


def _e_by_m(m, m1):
    return jax.jvp(_e, (m, m1), (jnp.ones_like(m), -jnp.ones_like(m)))[1]


def at_quarter(phi: FloatArray) -> jax.Array:
    """|φ| ≥ π/2, for which its float stands."""
    return jnp.abs(phi) >= np.asarray(np.pi / 2, phi.dtype)


_kinc = jax.jit(integral(_first, _first_integrand))
_einc = jax.jit(
    integral(_second, _second_integrand, by_m=integral(_second_by_m, _second_by_m_integrand))
)
