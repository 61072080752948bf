"""Carlson's symmetric integrals of the first and second kind."""

from functools import partial, reduce

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, ArrayLike, Float

from .._arrays import common, widened
from ._duplication import finite, kernel, ordered, rd, rf, rf_steps, root, sum_of_steps
from ._elementary import power_of_two, reciprocal

FloatArray = Float[Array, "..."]


def elliprf(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> FloatArray:
    """Carlson's RF(x, y, z) = ½ ∫₀^∞ dt / √((t + x)(t + y)(t + z)).

    **Arguments:** `x`, `y`, `z` ≥ 0, one of them 0 at most.  Shapes broadcast.

    **Returns:** RF: inf where two are 0; 0 where one is inf; NaN (value and gradient) where
    one is negative.  In an argument that is 0 the derivative is infinite.  What is given
    instead is a very large number (1e76 or more in size, of its sign), because inf times 0
    would spoil the derivatives in the other arguments; those are right.

    Within 3.5 eps for arguments from 1e-300 to 1e300 (float32: 1e±36), derivatives 10.
    DLMF 19.16.1; by Carlson's duplication (19.36.1).
    """
    return widened(_rf)(*common(x=x, y=y, z=z))


def elliprc(x: ArrayLike, y: ArrayLike) -> FloatArray:
    """Carlson's degenerate RC(x, y) = RF(x, y, y) = ½ ∫₀^∞ dt / (√(t + x) (t + y)).

    **Arguments:** `x` ≥ 0, `y` ≠ 0.  Shapes broadcast.

    **Returns:** RC, the Cauchy principal value where y < 0; 0 where one is inf; NaN (value
    and gradient) for x < 0 or y = 0.

    Within 6 eps of |RC| + |x ∂RC/∂x| + |y ∂RC/∂y|, domain and derivative at x = 0 as
    [`elliprf`][].  DLMF 19.2.17,
    19.2.20; an arctangent for x < y, else a logarithm.
    """
    return widened(_rc)(*common(x=x, y=y))


def elliprd(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> FloatArray:
    """Carlson's RD(x, y, z) = RJ(x, y, z, z) = 3/2 ∫₀^∞ dt / (√((t + x)(t + y)) (t + z)^{3/2}).

    **Arguments:** `x`, `y` ≥ 0, one of them 0 at most, `z` > 0.  Shapes broadcast.

    **Returns:** RD: inf for z = 0 and for x = y = 0; 0 where one is inf; NaN (value and
    gradient) where one is negative.

    Within 4.5 eps, domain and derivatives in an argument that is 0 as [`elliprf`][], where the
    result is a float.  DLMF 19.16.5; by Carlson's duplication (19.36.2).
    """
    return widened(_rd)(*common(x=x, y=y, z=z))


def elliprg(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> FloatArray:
    """Carlson's RG(x, y, z), the mean of √(x s₁² + y s₂² + z s₃²) over the unit sphere.

    **Arguments:** `x`, `y`, `z` ≥ 0.  Shapes broadcast.

    **Returns:** RG: √z / 2 where the others are 0; inf where one is inf; NaN (value and
    gradient) where one is negative.

    Within 5.5 eps, domain as [`elliprf`][].  The derivative in one argument that is 0 is
    RF / 4; where two are 0, theirs are infinite, given as very large numbers.
    DLMF 19.16.3, 19.23.6; by 19.21.10 with the middle argument last, a sum of positive terms.
    """
    return widened(_rg)(*common(x=x, y=y, z=z))


_rf, _rd = jax.jit(rf), jax.jit(rd)


@jax.custom_jvp
def rc(x: FloatArray, y: FloatArray) -> FloatArray:
    return _rc_kernel(x, y)


@rc.defjvp
def _rc_jvp(primals, tangents):
    return rc(*primals), jax.jvp(partial(_rc_by, rf), primals, tangents)[1]


def _rc_by(rf, x, y):
    """For y < 0 by DLMF 19.2.20."""
    below = y < 0
    value, apart = rf(*_three(x, y)), jnp.where(below, x - y, 1)
    return jnp.where(below, root(jnp.where(below, x, 1)) * root(reciprocal(apart)), 1) * value


def _three(x, y):
    """The arguments of RF."""
    size = jnp.where(y < 0, -y, y)
    return jnp.where(y < 0, x - y, x), size, size


def _rc_value(count, x, y):
    value = _rc_by(partial(rf_steps, count), x, y)
    value = jnp.where(jnp.isinf(x) | jnp.isinf(y), 0, value)
    return jnp.where((x >= 0) & (y != 0) & ~jnp.isnan(y), value, jnp.nan)


_rc_kernel = kernel(_rc_value, _rc_value, _three)
_rc = jax.jit(rc)


@jax.custom_jvp
def rg(x: FloatArray, y: FloatArray, z: FloatArray) -> FloatArray:
    return _rg_kernel(x, y, z)


@rg.defjvp
def _rg_jvp(primals, tangents):
    # ∂RG/∂x = RF/4 − x RD(y, z, x)/12 (DLMF 19.18.1 and 19.21.10), in which there is little to
    # cancel but for the largest argument.  Its own is from the sum of x ∂RG/∂x, RG/2.
    (x, y, z), (dx, dy, dz) = ordered(*primals, tangents)
    value, (unit, root_of_unit) = rg(*primals), _unit(x, y, z)
    x, y, z = x * unit, y * unit, z * unit
    first = finite(0.25 * rf(x, y, z))
    of_x = first - x / 12 * finite(rd(y, z, x))
    of_y = first - y / 12 * finite(rd(x, z, y))
    of_z = (0.5 * value * root_of_unit - x * of_x - y * of_y) / z
    of_x, of_y, of_z = (finite(root_of_unit * slope) for slope in (of_x, of_y, of_z))
    return value, of_x * dx + of_y * dy + of_z * dz


def _unit(x, y, z):
    """A power of four u, and √u: what RG, of degree 1/2, may be scaled by without a rounding.

    The two larger get sizes whose product is about 1, so that nothing leaves the range of the
    floats on the way."""
    ((_, y, z),) = ordered(*map(lax.stop_gradient, (x, y, z)))
    y = jnp.where(y > 0, y, jnp.where(z > 0, z, 1))
    _, exponent = jnp.frexp(jnp.sqrt(y) * jnp.sqrt(jnp.maximum(y, z)))
    most = jnp.finfo(y.dtype).maxexp // 2 - 2
    half = jnp.clip(-(exponent // 2), -most, most)
    return power_of_two(2 * half, y.dtype), power_of_two(half, y.dtype)


def _rg_value(count, x, y, z):
    arguments, (unit, root_of_unit) = (x, y, z), _unit(x, y, z)
    ((x, y, z),) = ordered(x * unit, y * unit, z * unit)
    flat = y == 0
    y = jnp.where(flat, 1, y)
    rest = jnp.sqrt(x) * (jnp.sqrt(z) / jnp.sqrt(y))
    value = rest + sum_of_steps(count, x, z, y, y, 1 / 3 * (y - x) * (z - y))
    value = jnp.where(flat, jnp.sqrt(z), value) * (0.5 / root_of_unit)
    least, largest = (reduce(pick, arguments) for pick in (jnp.minimum, jnp.maximum))
    value = jnp.where(jnp.isinf(largest), jnp.inf, value)  # their sum may be without any being so
    none_below = least >= 0
    return jnp.where(none_below, value, jnp.nan)


_rg_kernel = kernel(_rg_value, _rg_value)
_rg = jax.jit(rg)
