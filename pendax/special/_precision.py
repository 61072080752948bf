"""Half precision computes in float32 and rounds."""

from collections.abc import Callable

import jax
import jax.numpy as jnp


def widened(function: Callable) -> Callable:
    """`function` of arrays of one dtype, with float16 and bfloat16 carried in float32."""

    def call(*arrays):
        dtype = arrays[0].dtype
        if dtype in (jnp.float16, jnp.bfloat16):
            outputs = function(*(x.astype(jnp.float32) for x in arrays))
            return jax.tree.map(lambda x: x.astype(dtype), outputs)
        return function(*arrays)

    return call
