"""What XLA's CPU backend needs to be fast; on other backends these are plain calls."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jax import lax

_SMALL = 64  # elements; below, a stage of its own costs more than it saves
# Elements of a block.  Temporary arrays of larger ones leave the cache, and the system hands out
# memory for them anew in each call; smaller ones leave cores without work.
_FEW, DOZENS = 262144, 65536  # for functions with so many temporary arrays


def once(function: Callable, *arguments: Any) -> Any:
    """`function(*arguments)`, elementwise, as a stage whose results are computed once.

    XLA's CPU backend fuses elementwise work into every array that it leads to, and so
    computes what four outputs share four times; `optimization_barrier` does not stop
    it, the branch of a conditional does.  The predicate is a constant that XLA can't
    see through and `vmap` does not map.  A branch that returns several arrays computes
    what they share several times again: best is one real number from which all follow;
    one array of complex numbers is shared, but not vectorised.
    """
    results = jax.eval_shape(function, *arguments)
    if max(x.size for x in jax.tree.leaves(results)) < _SMALL:
        return function(*arguments)
    return stage(function, *arguments)


def stage(function: Callable, *arguments: Any) -> Any:
    """[`once`][] whatever the size, for what `vmap` will make large."""
    function = jax.jit(function)  # traced, differentiated and mapped once for all platforms

    def never(*arguments):
        results = jax.eval_shape(function, *arguments)
        return jax.tree.map(lambda x: jnp.zeros(x.shape, x.dtype), results)

    def cut(*arguments):
        false = lax.optimization_barrier(jnp.zeros((), bool))
        return lax.cond(false, never, function, *arguments)

    return lax.platform_dependent(*arguments, cpu=cut, default=function)


def where_needed(needed: Any, function: Callable, *arguments: Any) -> Any:
    """`function(*arguments)`, one array, if any of it is needed, else zeros; for what is
    within [`in_blocks`][], where no mapped predicate makes both branches run."""

    def zeros(*arguments):
        result = jax.eval_shape(function, *arguments)
        return jnp.zeros(result.shape, result.dtype)

    return lax.cond(jnp.any(needed), function, zeros, *arguments)


def in_blocks(function: Callable, most: int = _FEW) -> Callable:
    """`function`, elementwise from arrays of one rank to a tuple of arrays; from twice `most`
    elements on in blocks of so many.

    Whole arrays would pass through main memory some thirty times.
    Not to be differentiated; a mapped axis becomes one more axis of the arrays.
    """

    @jax.custom_batching.custom_vmap
    def call(*arrays):
        return lax.platform_dependent(*arrays, cpu=blocks, default=function)

    @call.def_vmap
    def _(_, mapped, *arrays):
        arrays = [x if is_mapped else x[None] for x, is_mapped in zip(arrays, mapped, strict=True)]
        results = call(*arrays)
        return results, jax.tree.map(lambda _: True, results)

    def blocks(*arrays):
        shape = jnp.broadcast_shapes(*(x.shape for x in arrays))
        results = jax.eval_shape(function, *arrays)
        size = results[0].size
        if size < 2 * most or any(x.shape != shape and x.size != 1 for x in arrays):
            return function(*arrays)
        flat = [x.reshape(-1) for x in arrays]

        def block(i, totals):
            start = jnp.minimum(i * most, size - most)  # the last two may overlap
            parts = [x if x.size == 1 else lax.dynamic_slice_in_dim(x, start, most) for x in flat]
            return tuple(
                lax.dynamic_update_slice_in_dim(total, part, start, 0)
                for total, part in zip(totals, function(*parts), strict=True)
            )

        totals = tuple(jnp.empty(size, x.dtype) for x in results)
        totals = lax.fori_loop(0, -(-size // most), block, totals)
        return tuple(x.reshape(shape) for x in totals)

    return call
