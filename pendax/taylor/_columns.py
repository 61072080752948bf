"""Derivatives in every mode and order of what JAX can only differentiate forwards.

A loop of unknown length has no reverse mode.  Here the tangent of f(p) is J dp, with J from
forward mode: a product with numbers, and so linear and transposable; and J is itself such
an f, so that its tangent is had in the same way.  Memory does not grow with the length of
the loop.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float, Shaped

Parameters = list[Shaped[Array, "..."]]  # whole numbers never move


def by_columns(
    f: Callable[[Parameters], tuple[Any, Any]], p: Parameters, careful: Callable | None = None
) -> tuple[Any, Any]:
    """`f(p)`, a pytree of arrays and whatever else `f` says; `p` must hold all that is traced.

    `careful` is the same function, to be differentiated in place of `f`.
    """
    exact = f if careful is None else careful

    @jax.custom_jvp
    def value(p):
        return f(p)

    @partial(value.defjvp, symbolic_zeros=True)
    def _(primals, tangents):
        (p,), (dp,) = primals, tangents
        moving = moving_among(p, dp)
        if not moving:
            y, said = by_columns(f, p, careful)
            return (y, said), jax.tree.map(no_tangent, (y, said))
        (y, columns), said = by_columns(partial(_with_columns, exact, moving), p)
        direction = direction_of(moving, p, dp)
        dy = jax.tree.map(lambda column: column @ direction, columns)
        return (y, said), (dy, jax.tree.map(no_tangent, said))

    return value(p)


def _with_columns(f, moving: list[int], p: Parameters):
    """`f(p)` and ∂f/∂p_k, on a last axis, p_k the elements of the `moving` arrays.

    The others have no tangents: zeros would be carried through every step, as numbers.
    """

    def of_moving(moved):
        return f(replaced(p, moving, moved))

    def along(dp):
        y, dy, said = jax.jvp(of_moving, ([p[i] for i in moving],), (dp,), has_aux=True)
        return (y, dy), said

    return jax.vmap(along, out_axes=((None, -1), None))(unit_tangents(moving, p))


def moving_among(p: Parameters, dp: list[Any]) -> list[int]:
    """Which of them have tangents."""
    return [
        i
        for i, (x, dx) in enumerate(zip(p, dp, strict=True))
        if not isinstance(dx, SymbolicZero) and jnp.issubdtype(x.dtype, jnp.inexact)
    ]


def replaced(p: Parameters, moving: list[int], moved: Parameters) -> Parameters:
    """`p` with others in the place of the `moving` arrays."""
    at = dict(zip(moving, moved, strict=True))
    return [at.get(i, x) for i, x in enumerate(p)]


def unit_tangents(moving: list[int], p: Parameters) -> Parameters:
    """Tangents of the `moving` arrays in each direction of their elements, stacked.

    What a torque holds may be of another precision.
    """
    sizes = [p[i].size for i in moving]
    ends = [sum(sizes[: k + 1]) for k in range(len(sizes) - 1)]
    units = jnp.split(jnp.eye(sum(sizes), dtype=p[0].dtype), ends, axis=1)
    return [
        unit.reshape(-1, *p[i].shape).astype(p[i].dtype)
        for i, unit in zip(moving, units, strict=True)
    ]


def direction_of(moving: list[int], p: Parameters, dp: list[Any]) -> Float[Array, " directions"]:
    """`dp` in terms of the unit tangents."""
    return jnp.concatenate([jnp.ravel(dp[i]).astype(p[0].dtype) for i in moving])


def no_tangent(x):
    """That of counts and flags, and of numbers that nothing moves."""
    dtype = x.dtype if jnp.issubdtype(x.dtype, jnp.inexact) else jax.dtypes.float0
    return jnp.zeros(jnp.shape(x), dtype)
