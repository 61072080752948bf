"""Linear least squares with few unknowns, in plain JAX."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import lineax as lx
from jax import lax
from jax.flatten_util import ravel_pytree
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


class ThinQR(lx.AbstractLinearSolver):
    """min ‖A x − b‖ for a handful of unknowns, of independent columns.

    The rejected form is lineax's `QR`: LAPACK's batched calls inside a loop can lock up the
    threads of XLA's CPU backend, and plain arithmetic batches well.
    """

    def init(self, operator: lx.AbstractLinearOperator, options: dict[str, Any]):
        del options
        unknowns = jax.tree.map(lambda x: jnp.zeros(x.shape, x.dtype), operator.in_structure())
        return operator.as_matrix(), unknowns

    def compute(self, state, vector, options: dict[str, Any]):
        del options
        matrix, unknowns = state
        found = reduced(matrix, ravel_pytree(vector)[0])
        _, unravel = ravel_pytree(unknowns)
        return unravel(substituted(*found)), lx.RESULTS.successful, {}

    def transpose(self, state, options: dict[str, Any]):
        raise NotImplementedError

    def conj(self, state, options: dict[str, Any]):
        return state, options

    def assume_full_rank(self) -> bool:
        return True
