"""sn, cn, dn and the amplitude, for every real parameter, from one ladder."""

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, ArrayLike, Float

from ._cpu import in_blocks, once
from ._either import with_parameter
from ._elementary import angle
from ._kinds import Scales, kind, scales
from ._slope import LARGEST, slopes
from ._steps import legs, other, parity, ratio, reduce, reduce_late

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
    either sign down to 1e-300 (float32: 1e4 quarter periods, 1e-36).  Derivatives in u,
    m and m1, in every mode, are regular at m = 0 and m = 1, and the first of them within
    50 eps of their own scale.  At |u| beyond 1/eps half periods no digit is left, and the
    result may be NaN.  Past half a period, second derivatives by m1 grow like
    m1^-2 and leave the range of the floats for |m1| below 1e-140; a Hessian in (u, m1)
    may then be NaN throughout, while derivatives in u alone stay right.

    DLMF 22.2; computed by 22.7 (Landen's transformations, both ways).
    """
    return with_parameter(jacobi, m, m1, u=u)


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
        values = jacobi(u, m, m1)
        return values, tuple(x * du for x in _by_u(m, *values))
    values = jacobi_and_slopes(u, m, m1)
    return values[:4], _along(_by_u(m, *values[:4]), du, _by_m(*values), dm)


@jax.custom_jvp
def jacobi_and_slopes(u: FloatArray, m: FloatArray, m1: FloatArray) -> tuple[FloatArray, ...]:
    """`jacobi` and the two `slopes`, d ph / d m and (d dn / d m) / sn."""
    return _values_and_slopes(u, m, m1)


@partial(jacobi_and_slopes.defjvp, symbolic_zeros=True)
def _jacobi_and_slopes_jvp(primals, tangents):
    u, m, m1 = primals
    du, dm, _ = tangents
    values = sn, cn, dn, ph, of_ph, of_dn = jacobi_and_slopes(u, m, m1)
    by_u = *_by_u(m, sn, cn, dn, ph), sn * of_dn, m * sn * of_ph - 0.5 * cn
    if isinstance(dm, SymbolicZero):
        return values, tuple(x * du for x in by_u)
    by_m = *_by_m(*values), *_curvatures(u, m, m1)
    return values, _along(by_u, du, by_m, dm)


def _curvatures(u, m, m1):
    """The derivatives of the `slopes` with respect to m, by JAX."""

    def slopes_of(m, m1):
        of_m = scales(m, m1)
        w, turns = reduce_late(u, of_m.factor, of_m.half_period)
        return slopes(u, w, turns, jacobi(u, m, m1)[:3], m, m1, of_m)

    tangents = jnp.ones_like(m), -jnp.ones_like(m)
    return tuple(_saturated(x) for x in jax.jvp(slopes_of, (m, m1), tangents)[1])


def _saturated(x):
    """inf times a tangent of 0 is not 0: where x overflows, about the largest float."""
    largest = LARGEST * jnp.finfo(x.dtype).max
    return jnp.where(jnp.isinf(x), jnp.copysign(largest, x), x)


def _by_u(m, sn, cn, dn, ph):
    del ph
    return cn * dn, -sn * dn, -m * sn * cn, dn


def _by_m(sn, cn, dn, ph, of_ph, of_dn):
    del dn, ph
    # At m = 1 cn leaves the range of the floats before its product with the slope does.
    beyond = jnp.abs(of_ph) >= 0.5 * LARGEST * jnp.finfo(sn.dtype).max
    dsn = jnp.where(beyond, -0.25 * sn, cn * of_ph)
    return dsn, -sn * of_ph, sn * of_dn, of_ph


def _along(by_u, du, by_m, dm):
    if isinstance(du, SymbolicZero):
        return tuple(y * dm for y in by_m)
    return tuple(x * du + y * dm for x, y in zip(by_u, by_m, strict=True))


@jax.jit
@in_blocks
def _values(u: FloatArray, m: FloatArray, m1: FloatArray) -> tuple[FloatArray, ...]:
    at = functions(u, m, m1)
    return *at.sn_cn_dn, _amplitude(at, m1)


@jax.jit
@in_blocks
def _values_and_slopes(u: FloatArray, m: FloatArray, m1: FloatArray) -> tuple[FloatArray, ...]:
    at = functions(u, m, m1)
    return *at.sn_cn_dn, _amplitude(at, m1), *slopes_at(at, u, m, m1)


class Functions(NamedTuple):
    sn_cn_dn: tuple[FloatArray, FloatArray, FloatArray]
    w: FloatArray  # the argument less its whole half periods, of the sign of the rest
    turns: FloatArray  # their number
    shared: Scales | None  # the `scales` of a parameter that many arguments share


def functions(u: FloatArray, m: FloatArray, m1: FloatArray) -> Functions:
    """Not to be differentiated, and best called inside `in_blocks`."""
    shared = once(scales, m, m1) if m.shape != jnp.broadcast_shapes(u.shape, m.shape) else None
    ends = once(lambda m, m1: scales(m, m1)[2:4], m, m1) if shared is None else shared[2:4]
    pair = once(lambda *x: lax.complex(*reduce(*x)), u, *ends)
    w, turns = pair.real, pair.imag

    def stage(w, m, m1):
        return ratio(w, kind(m, m1), scales(m, m1) if shared is None else shared)

    sn, partner = legs(once(stage, w, m, m1), w, turns, m, m1)
    swings, rest = m1 < 0, other(sn, partner, m1)
    cn_dn = jnp.where(swings, rest, partner), jnp.where(swings, partner, rest)
    return Functions((sn, *cn_dn), w, turns, shared)


def slopes_at(
    at: Functions, u: FloatArray, m: FloatArray, m1: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """`slopes` as a stage of their own; as `functions`."""

    def stage(u, w, turns, m, m1, *sn_cn_dn):
        of_m = scales(m, m1) if at.shared is None else at.shared
        return lax.complex(*slopes(u, w, turns, sn_cn_dn, m, m1, of_m))

    pair = once(stage, u, at.w, at.turns, m, m1, *at.sn_cn_dn)
    return pair.real, pair.imag


def _amplitude(at: Functions, m1: FloatArray) -> FloatArray:
    sn, cn, _ = at.sn_cn_dn
    ph = angle(sn, jnp.abs(cn))
    # A half period on, m <= 1 has turned over (sn, cn) and m > 1 swung back (sn, dn).
    return jnp.where(m1 < 0, ph, parity(at.turns) * ph + at.turns * jnp.pi)
