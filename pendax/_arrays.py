"""From whatever the caller passes to arrays of one shape and dtype, and exact products."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.core import Tracer
from jaxtyping import Array, Float

# What JAX takes for an array (its `ArrayLike`, which has no isinstance for tracers).
NUMBERS = (jax.Array, np.ndarray, np.generic, bool, int, float, complex)


def common(**arguments: Any) -> list[Float[Array, "..."]]:
    """The arguments as real floating arrays of one shape and dtype: `aligned`, broadcast."""
    arrays = aligned(**arguments)
    shape = jnp.broadcast_shapes(*(x.shape for x in arrays))
    return [jnp.broadcast_to(x, shape) for x in arrays]


def aligned(**arguments: Any) -> list[Float[Array, "..."]]:
    """The arguments as real floating arrays of one rank and dtype that broadcast together.

    The dtype is `jnp.result_type` of them all, Python scalars and integers weak;
    float16 and bfloat16 stay what they are (see `widened`).
    """
    for name, x in arguments.items():
        if not isinstance(x, NUMBERS):
            raise ValueError(
                f"Argument `{name}` must be a number or an array, but got {type(x).__name__}."
            )
        kind = jnp.result_type(x)
        if not (jnp.issubdtype(kind, jnp.floating) or jnp.issubdtype(kind, jnp.integer)):
            raise ValueError(f"Argument `{name}` must be real numbers, but got {kind}.")
    dtype = floating(*arguments.values())
    arrays = [jnp.asarray(x, dtype) for x in arguments.values()]
    try:
        shape = jnp.broadcast_shapes(*(x.shape for x in arrays))
    except ValueError:
        shapes = ", ".join(f"`{name}` {jnp.shape(x)}" for name, x in arguments.items())
        raise ValueError(f"Arguments must broadcast together, but got shapes {shapes}.") from None
    return [x.reshape((1,) * (len(shape) - x.ndim) + x.shape) for x in arrays]


def widened(function: Callable) -> Callable:
    """`function` of arrays of one dtype, with float16 and bfloat16 carried in float32,
    and its results rounded."""

    def call(*arrays):
        dtype = arrays[0].dtype
        if dtype in (jnp.float16, jnp.bfloat16):
            outputs = function(*(x.astype(jnp.float32) for x in arrays))
            return jax.tree.map(lambda x: x.astype(dtype), outputs)
        return function(*arrays)

    return call


def floating(*arguments: Any) -> np.dtype:
    """`jnp.result_type` of the arguments, a floating type in any case."""
    dtype = jnp.result_type(*arguments)
    return dtype if jnp.issubdtype(dtype, jnp.floating) else jnp.result_type(float)


def inexact(x: Any) -> Any:
    """Numbers as floating arrays, Python's own weakly typed; all else as it is."""
    if not isinstance(x, NUMBERS):
        return x
    if isinstance(x, int | float):
        # Under jit as well a number, for what is chosen by its value.
        with jax.ensure_compile_time_eval():
            return jnp.asarray(float(x))
    return jnp.asarray(x, floating(x))


def concrete(x: object) -> np.ndarray | None:
    """The values of `x` where Python can see them (no tracer, a number), else None."""
    if isinstance(x, Tracer) or not isinstance(x, NUMBERS):
        return None
    return np.asarray(x)


def require(name: str, x: object, holds: str, test) -> None:
    """ValueError "Argument `name` must be `holds`, but got …" unless test(x) throughout.

    NaN passes: it stays in its own lane.  Tracers and non-numbers pass unseen.
    """
    values = concrete(x)
    if values is None or not np.issubdtype(values.dtype, np.number):
        return
    wrong = ~(test(values) | np.isnan(values))
    if wrong.any():
        raise ValueError(f"Argument `{name}` must be {holds}, but got {values[wrong].flat[0]}.")


def whole(name: str, x: object, least: int) -> int:
    """`x` as an integer from `least` on, else ValueError."""
    if not isinstance(x, int | np.integer) or x < least:
        raise ValueError(f"Argument `{name}` must be {least} or more, a whole number, but got {x}.")
    return int(x)


def tolerance(name: str, x: object) -> float | None:
    """`x` as a positive Python number, or None, else ValueError."""
    if x is None:
        return None
    values = concrete(x)
    if values is None or values.ndim or not (0 < values < np.inf):
        raise ValueError(f"Argument `{name}` must be one positive number, but got {x}.")
    return float(values)


def difference_of_products(
    a: Float[Array, "..."],
    b: Float[Array, "..."] | None,
    c: Float[Array, "..."],
    d: Float[Array, "..."],
) -> Float[Array, "..."]:
    """a b − c d to 2 eps of itself plus 4 eps² of a b, where nothing over- or underflows.

    `b` may be `None` for 1.

    Every factor is cut into two halves by `lax.reduce_precision`, and every product of
    halves is exact: it makes no difference which of them the compiler fuses into
    multiply-adds.  The rejected form, Veltkamp and Dekker's rounded product with its
    error, subtracts the error twice where a compiler contracts the subtraction of the
    product.  Not to be differentiated.
    """
    digits = jnp.finfo(a.dtype).nmant // 2 - (a.dtype == jnp.float64)

    def halves(x):
        high = lax.reduce_precision(x, jnp.finfo(x.dtype).nexp, digits)
        return high, x - high

    (a1, a2), (c1, c2), (d1, d2) = map(halves, (a, c, d))
    if b is None:
        total, terms = a1, (-c1 * d1, -c1 * d2, a2, -c2 * d1, -c2 * d2)
    else:
        b1, b2 = halves(b)
        total = a1 * b1
        terms = (-c1 * d1, a1 * b2, -c1 * d2, a2 * b1, -c2 * d1, a2 * b2, -c2 * d2)
    rest = jnp.zeros_like(a)
    for term in terms:
        total, error = _two_sum(total, term)
        rest = rest + error
    return total + rest


def _two_sum(
    a: Float[Array, "..."], b: Float[Array, "..."]
) -> tuple[Float[Array, "..."], Float[Array, "..."]]:
    """a + b as rounded sum and exact error (Knuth); additions alone, so safe from fusing."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)
