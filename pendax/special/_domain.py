"""What a function gives outside its domain, for value and gradient."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

FloatArray = Float[Array, "..."]


@jax.custom_jvp
def fenced(
    inside: FloatArray, valid: Bool[Array, "..."], outside: FloatArray, *arguments: FloatArray
) -> FloatArray:
    """`inside` where `valid`; elsewhere `outside`, whose derivatives in the `arguments` are NaN.

    `inside` is to be computed from arguments that are replaced where they are not valid."""
    return jnp.where(valid, inside, outside)


@fenced.defjvp
def _fenced_jvp(primals, tangents):
    inside, valid, outside, *arguments = primals
    moved = sum(tangents[3:], jnp.zeros_like(inside)) * jnp.where(valid, 0, jnp.nan)
    return fenced(inside, valid, outside, *arguments), moved + tangents[0] * jnp.where(valid, 1, 0)
