"""Linear least squares with few unknowns, in plain JAX.

The rejected form is `jnp.linalg.qr`: LAPACK's batched calls inside a loop can lock up the threads
of XLA's CPU backend, and plain arithmetic batches well.
"""

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

Matrix = Float[Array, "rows columns"]
Square = Float[Array, "columns columns"]
Vector = Float[Array, " columns"]


class Reduced(NamedTuple):
    """A = Q R and b = Q y + what is left, with orthonormal Q."""

    r: Square
    y: Vector


def reduced(matrix: Matrix, b: Float[Array, " rows"]) -> Reduced:
    """Modified Gram–Schmidt of the columns with b behind them: as stable for x and R as
    Householder's form (Björck, BIT 7 (1967) 1)."""
    n = matrix.shape[1]
    both = jnp.concatenate([matrix, b[:, None]], 1)

    def step(k, at):
        both, r = at
        column = lax.dynamic_index_in_dim(both, k, 1, keepdims=False)
        norm = jnp.sqrt(jnp.sum(column * column))
        q = column / norm
        row = jnp.where(jnp.arange(n + 1) > k, q @ both, 0)
        both = both - q[:, None] * row[None, :]
        return both, r.at[k].set(row.at[k].set(norm))

    _, r = lax.fori_loop(0, n, step, (both, jnp.zeros((n, n + 1), matrix.dtype)))
    return Reduced(r[:, :n], r[:, n])


def substituted(r: Square, y: Float[Array, "columns ..."]) -> Float[Array, "columns ..."]:
    """x of R x = y, R upper triangular."""
    n = r.shape[0]

    def step(i, x):
        k = n - 1 - i
        return x.at[k].set((y[k] - jnp.tensordot(r[k], x, 1)) / r[k, k])

    return lax.fori_loop(0, n, step, jnp.zeros_like(y))
