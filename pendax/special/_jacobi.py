"""sn, cn, dn and the amplitude, for every real parameter, from one ladder."""

from functools import partial

import jax
import jax.numpy as jnp
from jax import lax
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, ArrayLike, Float

from .._arrays import aligned, widened
from ._cpu import in_blocks, once
from ._elementary import angle
from ._kinds import kind, scales
from ._slope import by_amplitude, slope
from ._steps import other, reduce, sine_and_partner

FloatArray = Float[Array, "..."]


def ellipj(
    u: ArrayLike, m: ArrayLike | None = None, *, m1: ArrayLike | None = None
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Jacobi elliptic functions sn(u | m), cn(u | m), dn(u | m) and the amplitude.

    **Arguments:**

    - `u`: the argument, any real numbers.
    - `m`: the parameter k^2 (not the modulus k), any real numbers: m < 0 and m > 1 too.
    - `m1`: the complement 1 - m, instead of `m`, for m so near to 1 that 1 - m has lost
      its digits.

    Shapes broadcast.

    **Returns:** `(sn, cn, dn, ph)`, sn = sin ph and cn = cos ph.  `ph` is continuous in
    u and never folded: it grows without bound for m < 1 and swings between
    -arcsin(1/sqrt(m)) and its opposite for m > 1.

    **Raises:** `ValueError` unless exactly one of `m` and `m1` is given.

    NaN in an element gives NaN in that element alone.  Within 8 eps of
    |f| + |u df/du| for |u| up to 1e6 quarter periods, m from -1e10 to 1e10, m1 of
    either sign down to 1e-300.  Derivatives of every order in u, m and m1 come from
    JAX and are regular at m = 0 and m = 1.

    DLMF 22.2; computed by 22.7 (Landen's transformations, both ways).
    """
    if (m is None) == (m1 is None):
        raise ValueError(
            "Arguments `m` and `m1` must be given one without the other, but got "
            + ("neither." if m is None else "both.")
        )
    given = {"u": u, "m": m} if m1 is None else {"u": u, "m1": m1}
    u, parameter = aligned(**given)

    def functions(u, parameter):
        pair = (parameter, 1 - parameter) if m1 is None else (1 - parameter, parameter)
        return jacobi(u, *pair)

    return widened(functions)(u, parameter)


@jax.custom_jvp
def jacobi(u: FloatArray, m: FloatArray, m1: FloatArray) -> tuple[FloatArray, ...]:
    """(sn, cn, dn, ph) for arguments of one dtype and rank; m + m1 = 1, each as exact as
    known.  To derivatives m1 is 1 - m: the tangent of m counts, that of m1 does not."""
    return _values(u, m, m1)


@partial(jacobi.defjvp, symbolic_zeros=True)
def _jacobi_jvp(primals, tangents):
    u, m, m1 = primals
    du, dm, _ = tangents
    if isinstance(dm, SymbolicZero):
        functions = jacobi(u, m, m1)
        return functions, tuple(x * du for x in _by_u(m, *functions))
    *functions, slope_ = jacobi_and_slope(u, m, m1)
    return tuple(functions), _tangents(u, m, m1, (*functions, slope_), du, dm)


@jax.custom_jvp
def jacobi_and_slope(u: FloatArray, m: FloatArray, m1: FloatArray) -> tuple[FloatArray, ...]:
    """`jacobi` and the `slope`."""
    return _values_and_slope(u, m, m1)


@partial(jacobi_and_slope.defjvp, symbolic_zeros=True)
def _jacobi_and_slope_jvp(primals, tangents):
    u, m, m1 = primals
    du, dm, _ = tangents
    values = jacobi_and_slope(u, m, m1)
    sn, cn, dn, _, slope_ = values
    # The slope by u: d dn / dm, or what follows from (d dn / dm) / sn.
    by_m = _by_m(u, m, m1, values)
    by_u = jnp.where(by_amplitude(u, m, m1), by_m[2], -0.5 * cn - m * by_m[1])
    if isinstance(dm, SymbolicZero):
        tangents = (*(x * du for x in _by_u(m, *values[:4])), by_u * du)
    else:
        by_m = curvature(u, m, m1)
        tangents = (*_tangents(u, m, m1, values, du, dm), _along(by_u, du, by_m, dm))
    return values, tangents


def curvature(u: FloatArray, m: FloatArray, m1: FloatArray) -> FloatArray:
    """The derivative of the `slope` with respect to m, by JAX."""

    def slope_of(m, m1):
        of_m = scales(m, m1)
        w, turns = reduce(u, of_m.factor, of_m.half_period)
        return slope(u, w, turns, jacobi(u, m, m1)[:3], m, m1, of_m)

    return jax.jvp(slope_of, (m, m1), (jnp.ones_like(m), -jnp.ones_like(m)))[1]


def _by_u(m, sn, cn, dn, ph):
    del ph
    return cn * dn, -sn * dn, -m * sn * cn, dn


def _by_m(u, m, m1, values):
    sn, cn, dn, _, slope_ = values
    swinging = ~by_amplitude(u, m, m1)
    # By the slope of ph.
    dsn = cn * slope_
    # At m = 1 exactly cn leaves the range of the floats, and sn -> -sgn(u) / 4.
    dsn = jnp.where(jnp.isinf(slope_), -0.25 * sn, dsn)
    ddn = -sn * (0.5 * sn + m * dsn) / jnp.where(swinging, 1, dn)
    # By that of dn.
    other_dsn = -(0.5 * sn + dn * slope_) / jnp.where(swinging, m, 1)
    dph = other_dsn / jnp.where(swinging, cn, 1)
    return (
        jnp.where(swinging, other_dsn, dsn),
        -sn * jnp.where(swinging, dph, slope_),
        jnp.where(swinging, sn * slope_, ddn),
        jnp.where(swinging, dph, slope_),
    )


def _tangents(u, m, m1, values, du, dm):
    by_u, by_m = _by_u(m, *values[:4]), _by_m(u, m, m1, values)
    return tuple(_along(x, du, y, dm) for x, y in zip(by_u, by_m, strict=True))


def _along(by_u, du, by_m, dm):
    if isinstance(du, SymbolicZero):
        return by_m * dm
    return by_u * du + by_m * dm


@jax.jit
@in_blocks
def _values(u: FloatArray, m: FloatArray, m1: FloatArray) -> tuple[FloatArray, ...]:
    w, turns, scaled = _reduced(u, m, m1)
    sn, cn, dn = _functions(w, turns, m, m1, scaled)
    return sn, cn, dn, _amplitude(sn, cn, turns, m1)


@jax.jit
@in_blocks
def _values_and_slope(u: FloatArray, m: FloatArray, m1: FloatArray) -> tuple[FloatArray, ...]:
    w, turns, scaled = _reduced(u, m, m1)
    functions = _functions(w, turns, m, m1, scaled)

    def stage(u, w, turns, m, m1, *functions):
        of_m = scales(m, m1) if scaled is None else scaled
        return slope(u, w, turns, functions, m, m1, of_m)

    sn, cn, dn = functions
    return sn, cn, dn, _amplitude(sn, cn, turns, m1), once(stage, u, w, turns, m, m1, *functions)


def _reduced(u, m, m1):
    """w and turns, and the `scales` of a parameter that many arguments share."""
    shared = m.shape != jnp.broadcast_shapes(u.shape, m.shape)
    scaled = once(scales, m, m1) if shared else None
    ends = scaled[2:4] if shared else once(lambda m, m1: scales(m, m1)[2:4], m, m1)
    pair = once(lambda *x: lax.complex(*reduce(*x)), u, *ends)
    return pair.real, pair.imag, scaled


def _functions(w, turns, m, m1, scaled):
    def stage(w, turns, m, m1):
        of_m = scales(m, m1) if scaled is None else scaled
        return lax.complex(*sine_and_partner(w, turns, kind(m, m1), of_m))

    pair = once(stage, w, turns, m, m1)
    sn, partner = pair.real, pair.imag
    swings, rest = m1 < 0, other(sn, partner, m1)
    return sn, jnp.where(swings, rest, partner), jnp.where(swings, partner, rest)


def _amplitude(sn, cn, turns, m1):
    ph = angle(sn, jnp.abs(cn))
    # A half period on, m <= 1 has turned over (sn, cn) and m > 1 swung back (sn, dn).
    parity = 1 - 2 * (turns - 2 * jnp.floor(0.5 * turns))
    return jnp.where(m1 < 0, ph, parity * ph + turns * jnp.pi)
