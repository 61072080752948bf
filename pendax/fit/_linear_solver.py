"""Thin least squares as a solver of lineax."""

from typing import Any

import jax
import jax.numpy as jnp
import lineax as lx
from jax.flatten_util import ravel_pytree

from ._thin_qr import reduced, substituted


class ThinQR(lx.AbstractLinearSolver):
    """min ‖A x − b‖ for a handful of unknowns, of independent columns."""

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
