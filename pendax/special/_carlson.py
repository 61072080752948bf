"""Carlson's symmetric integrals of the first and second kind."""

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, ArrayLike, Float

from .._arrays import common, widened
from ._domain import fenced
from ._duplication import finite, ordered, rd, rf, root
from ._elementary import reciprocal

FloatArray = Float[Array, "..."]


def elliprf(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> FloatArray:
    """Carlson's RF(x, y, z) = ½ ∫₀^∞ dt / √((t + x)(t + y)(t + z)).

    **Arguments:** `x`, `y`, `z` ≥ 0, one of them 0 at most.  Shapes broadcast.

    **Returns:** RF: inf where two are 0; 0 where one is inf; NaN (value and gradient) where
    one is negative.  The derivative in an argument that is 0 is −inf; as about the largest
    number of the floats it leaves those in the others as they are.

    Within 3 eps for arguments from 1e-300 to 1e300 (float32: 1e±36), derivatives 10.
    DLMF 19.16.1; by Carlson's duplication (19.36.1).
    """
    return widened(_rf)(*common(x=x, y=y, z=z))


def elliprc(x: ArrayLike, y: ArrayLike) -> FloatArray:
    """Carlson's degenerate RC(x, y) = RF(x, y, y) = ½ ∫₀^∞ dt / (√(t + x) (t + y)).

    **Arguments:** `x` ≥ 0, `y` ≠ 0.  Shapes broadcast.

    **Returns:** RC, the Cauchy principal value where y < 0; 0 where one is inf; NaN (value
    and gradient) for x < 0 and y = 0.

    Within 6 eps of |RC| + |x ∂RC/∂x| + |y ∂RC/∂y|, domain as [`elliprf`][].  DLMF 19.2.17,
    19.2.20; an arctangent for x < y, else a logarithm.
    """
    return widened(_rc)(*common(x=x, y=y))


def elliprd(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> FloatArray:
    """Carlson's RD(x, y, z) = RJ(x, y, z, z) = 3/2 ∫₀^∞ dt / (√((t + x)(t + y)) (t + z)^{3/2}).

    **Arguments:** `x`, `y` ≥ 0, one of them 0 at most, `z` > 0.  Shapes broadcast.

    **Returns:** RD: inf for z = 0 and for x = y = 0; 0 where one is inf; NaN (value and
    gradient) where one is negative.

    Within 4 eps, domain and derivatives in an argument that is 0 as [`elliprf`][], where the
    result is a float.  DLMF 19.16.5; by Carlson's duplication (19.36.2).
    """
    return widened(_rd)(*common(x=x, y=y, z=z))


def elliprg(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> FloatArray:
    """Carlson's RG(x, y, z), the mean of √(x s₁² + y s₂² + z s₃²) over the unit sphere.

    **Arguments:** `x`, `y`, `z` ≥ 0.  Shapes broadcast.

    **Returns:** RG: √z / 2 where the others are 0; inf where one is inf; NaN (value and
    gradient) where one is negative.

    Within 4 eps, domain and derivatives in an argument that is 0 as [`elliprf`][].
    DLMF 19.16.3, 19.23.6; by 19.21.10 with the middle argument last, a sum of positive terms.
    """
    return widened(_rg)(*common(x=x, y=y, z=z))


def _replaced(valid, *arguments):
    return [jnp.where(valid, x, 1) for x in arguments]


def _sorted_out(*arguments):
    """No argument below 0, and no inf among them."""
    none_below, none_endless = True, True
    for x in arguments:
        none_below = none_below & (x >= 0)
        none_endless = none_endless & ~jnp.isinf(x)
    return none_below, none_endless


@jax.jit
def _rf(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    none_below, none_endless = _sorted_out(x, y, z)
    ((_, middle, _),) = ordered(x, y, z)
    valid = none_below & none_endless & (middle > 0)
    outside = jnp.where(none_endless, jnp.inf, jnp.where(middle > 0, 0, jnp.nan))
    outside = jnp.where(none_below, outside, jnp.nan)
    return fenced(rf(*_replaced(valid, x, y, z)), valid, outside, x, y, z)


@jax.jit
def _rc(x: FloatArray, y: FloatArray) -> FloatArray:
    valid = (x >= 0) & (y != 0) & ~jnp.isinf(x) & ~jnp.isinf(y)
    outside = jnp.where((x >= 0) & (jnp.isinf(x) | jnp.isinf(y)), 0, jnp.nan)
    return fenced(rc(*_replaced(valid, x, y)), valid, outside, x, y)


def rc(x: FloatArray, y: FloatArray) -> FloatArray:
    """RC inside its domain; for y < 0 by DLMF 19.2.20."""
    below = y < 0
    size = jnp.where(below, -y, y)
    apart = jnp.where(below, x + size, 1)
    value = rf(jnp.where(below, apart, x), size, size)
    return jnp.where(below, root(jnp.where(below, x, 1)) * root(reciprocal(apart)), 1) * value


@jax.jit
def _rd(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    none_below, none_endless = _sorted_out(x, y, z)
    finite_value = (z > 0) & ((x > 0) | (y > 0))
    valid = none_below & none_endless & finite_value
    outside = jnp.where(none_endless, jnp.inf, jnp.where(finite_value, 0, jnp.nan))
    outside = jnp.where(none_below, outside, jnp.nan)
    return fenced(rd(*_replaced(valid, x, y, z)), valid, outside, x, y, z)


@jax.jit
def _rg(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    none_below, none_endless = _sorted_out(x, y, z)
    valid = none_below & none_endless
    outside = jnp.where(none_below, jnp.inf, jnp.nan)
    safe = _replaced(valid, x, y, z)
    # RG is of degree 1/2.  The two larger are brought to sizes whose product is 1, so that
    # nothing leaves the range of the floats on the way.
    ((_, middle, highest),) = ordered(*map(lax.stop_gradient, safe))
    middle = jnp.where(middle > 0, middle, jnp.where(highest > 0, highest, 1))
    size = jnp.sqrt(middle) * jnp.sqrt(jnp.maximum(highest, middle))
    value = jnp.sqrt(size) * rg(*(t * (1 / size) for t in safe))
    return fenced(value, valid, outside, x, y, z)


@jax.custom_jvp
def rg(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    """RG inside its domain."""
    ((x, y, z),) = ordered(x, y, z)
    flat = y == 0
    y = jnp.where(flat, 1, y)
    rest = (1 / 3 * (y - x) * rd(x, z, y)) * (z - y) + root(x) * (root(z) / root(y))
    return 0.5 * jnp.where(flat, root(z), y * rf(x, y, z) + rest)


@rg.defjvp
def _rg_jvp(primals, tangents):
    # ∂RG/∂x = RF/4 − x RD(y, z, x)/12 (DLMF 19.18.1 and 19.21.10), in which there is little to
    # cancel but for the largest argument.  Its own is from the sum of x ∂RG/∂x, RG/2.
    (x, y, z), (dx, dy, dz) = ordered(*primals, tangents)
    value = rg(*primals)
    flat = y == 0
    middle = jnp.where(flat, 1, y)
    first = jnp.where(flat, jnp.inf, rf(x, middle, z))
    of_x = finite(0.25 * first) - x / 12 * finite(rd(middle, z, x))
    of_y = finite(0.25 * first) - y / 12 * rd(x, z, middle)
    of_z = (0.5 * value - x * of_x - y * of_y) / z
    return value, of_x * dx + of_y * dy + of_z * dz
