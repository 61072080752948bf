"""A solved equation with derivatives in every mode and order.

diffrax differentiates its own steps: reverse mode by default, forward mode with another
adjoint, neither of them twice.  Here the tangent is J(t) dp, with J = ∂y/∂p from the
variational equation J' = F_y J + F_p, solved beside y' = F(t, y; p) by the same solver: a
product with numbers, and so linear and transposable; and J is itself the solution of
such an equation, so that its tangent is had in the same way.  Memory does not grow with the
number of steps.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float

from ..taylor._columns import (
    Parameters,
    direction_of,
    moving_among,
    no_tangent,
    replaced,
    unit_tangents,
)

FloatArray = Float[Array, "..."]
# y' = field(t, y, p) from y(0) = start(p); y a vector, p a list of arrays.
Field = Callable[[FloatArray, FloatArray, Parameters], FloatArray]
Start = Callable[[Parameters], FloatArray]
# (field, start, p, ts) -> y at ts, and whatever else a solver says.
Solve = Callable[[Field, Start, Parameters, FloatArray], tuple[FloatArray, Any]]


def differentiable(
    solve: Solve, field: Field, start: Start, p: Parameters, ts: Float[Array, " times"]
) -> tuple[FloatArray, Any]:
    """`solve(field, start, p, ts)`, to be differentiated in `p` and `ts`."""

    @jax.custom_jvp
    def solution(p, ts):
        return solve(field, start, p, ts)

    @partial(solution.defjvp, symbolic_zeros=True)
    def _(primals, tangents):
        p, ts = primals
        dp, dts = tangents
        moving = moving_among(p, dp)
        size = jax.eval_shape(start, p).size
        both, said = differentiable(solve, *_with_slopes(field, start, moving, size), p, ts)
        y, slopes = both[:, :size], both[:, size:].reshape(len(ts), -1, size)
        dy = jnp.zeros_like(y)
        if moving:
            dy = dy + jnp.einsum("tks,k->ts", slopes, direction_of(moving, p, dp))
        if not isinstance(dts, SymbolicZero):
            along = jax.vmap(lambda t, y: field(t, y, p))(ts, y)
            dy = dy + along * dts[:, None]
        return (y, said), (dy, jax.tree.map(no_tangent, said))

    return solution(p, ts)


def _with_slopes(field: Field, start: Start, moving: list[int], size: int) -> tuple[Field, Start]:
    """The equation of (y, ∂y/∂p_1, ∂y/∂p_2, …), p_k the elements of the `moving` arrays."""

    def wider_field(t, wide, p):
        y, slopes = wide[:size], wide[size:].reshape(-1, size)
        if not moving:
            return field(t, y, p)

        def of_moving(y, moved):
            return field(t, y, replaced(p, moving, moved))

        def along(dy, dp):
            return jax.jvp(of_moving, (y, [p[i] for i in moving]), (dy, dp))

        values, changes = jax.vmap(along, out_axes=(None, 0))(slopes, unit_tangents(moving, p))
        return jnp.concatenate([values, changes.ravel()])

    def wider_start(p):
        if not moving:
            return start(p)

        def along(dp):
            at = [p[i] for i in moving]
            return jax.jvp(lambda moved: start(replaced(p, moving, moved)), (at,), (dp,))

        values, changes = jax.vmap(along, out_axes=(None, 0))(unit_tangents(moving, p))
        return jnp.concatenate([values, changes.ravel()])

    return wider_field, wider_start
