"""The power series of K and E in m, and how far off they are after each term."""

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float

from .._arrays import common, whole, widened
from ._complete import ellipe, ellipk

FloatArray = Float[Array, "..."]

_MORE = 64  # terms that are summed beyond those asked for, for the error's own digits


class Approximation(NamedTuple):
    """An approximate `value`, and its relative `error`, value/exact − 1."""

    value: FloatArray
    error: FloatArray


def ellipk_series(m: ArrayLike, terms: int) -> Approximation:
    """Partial sums of K(m) = π/2 Σ ((2n − 1)!!/(2n)!!)² mⁿ.

    **Arguments:** `m`, the parameter k², 0 <= m <= 1, any shape; `terms` ≥ 1.

    **Returns:** [`Approximation`][] whose last axis has the sums of 1 … `terms` terms;
    NaN outside the domain; error −1 at m = 1.

    **Raises:** `ValueError` for terms below 1.  The sums to a few eps; the errors, which
    are summed and not subtracted, to 1e-6 of themselves or some eps of K.
    The Spanish source's §5.2.2; DLMF 19.5.1.
    """
    return _sums(m, terms, ellipk, lambda n: np.ones_like(n))


def ellipe_series(m: ArrayLike, terms: int) -> Approximation:
    """Partial sums of E(m) = π/2 (1 − Σ_{n>0} ((2n − 1)!!/(2n)!!)² mⁿ/(2n − 1)).

    As [`ellipk_series`][].  The Spanish source's §5.2.2, one of whose five forms sums from
    n = 0 and is π/2 too large; DLMF 19.5.2.
    """
    return _sums(m, terms, ellipe, lambda n: -1 / (2 * n - 1))


def _sums(m: ArrayLike, terms: int, exact, weight) -> Approximation:
    terms = whole("terms", terms, 1)
    (m,) = common(m=m)
    n = np.arange(terms + _MORE, dtype=float)
    weights = weight(n)
    ratios = ((2 * n[:-1] + 1) / (2 * n[:-1] + 2)) ** 2
    # Between neighbouring terms, weights included; the next one's for what is left over.
    ratios = ratios * weights[1:] / weights[:-1]
    total = widened(partial(_partial, terms, tuple(ratios.tolist())))
    return Approximation(*total(jnp.where((m >= 0) & (m <= 1), m, jnp.nan), exact(m)))


@partial(jax.jit, static_argnums=(0, 1))
def _partial(terms: int, ratios: tuple[float, ...], m: FloatArray, exact: FloatArray):
    factors = jnp.asarray(ratios, m.dtype).reshape((1,) * m.ndim + (-1,)) * m[..., None]
    first = 0.5 * jnp.pi + 0 * m[..., None]
    each = jnp.concatenate([first, first * jnp.cumprod(factors, -1)], -1)
    # What is left after the last: a geometric series where it is small, else a difference.
    last, ratio = each[..., -1], jnp.abs(factors[..., -1])
    small = jnp.abs(last) < 1e-9 * (1 - ratio) * jnp.abs(first[..., 0])
    left = jnp.where(small, last * ratio / jnp.where(small, 1 - ratio, 1), 0)
    left = jnp.where(small, left, exact - jnp.sum(each, -1))
    tails = jnp.cumsum(jnp.concatenate([each[..., 1:], left[..., None]], -1)[..., ::-1], -1)
    error = -tails[..., ::-1][..., :terms] / exact[..., None]
    endless = jnp.isinf(exact)[..., None]
    return jnp.cumsum(each, -1)[..., :terms], jnp.where(endless, -1, error)
