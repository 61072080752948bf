"""sn, cn, dn and the amplitude, for every real parameter, from one ladder."""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, ArrayLike, Bool, Float

from .._arrays import common, widened
from ._elementary import angle, sin_cos, sinh_cosh
from ._landen import Ladder, ladder, log_nome, nome16

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
    if m1 is None:
        u, m = common(u=u, m=m)
        return widened(lambda u, m: _jacobi(u, m, 1 - m))(u, m)
    u, m1 = common(u=u, m1=m1)
    return widened(lambda u, m1: _jacobi(u, 1 - m1, m1))(u, m1)


class _Parameter(NamedTuple):
    """m sorted into one of four classes, each with a p in [-1, 1/2].

    class         m            p                  functions of scale * u at p
    circular      -1 … 1/2     m                  sn, cn, dn
    hyperbolic    1/2 … 2      m1, either sign    sn, cn, dn
    reciprocal    above 2      1/m                sn / scale, dn, cn    (DLMF 22.17)
    negative      below -1     1/m1               sd / scale, cd, nd

    circular and reciprocal descend to sin and cos, hyperbolic and negative ascend
    to tanh and sech.
    """

    circular: Bool[Array, "..."]
    reciprocal: Bool[Array, "..."]
    negative: Bool[Array, "..."]
    ascends: Bool[Array, "..."]
    p: FloatArray
    scale: FloatArray


def _classify(m: FloatArray, m1: FloatArray) -> _Parameter:
    reciprocal = m > 2
    negative = ~(m >= -1)  # NaN goes this way too, and stays NaN
    circular = (m <= 0.5) & ~negative
    hyperbolic = (m > 0.5) & ~reciprocal
    divisor = jnp.where(reciprocal, m, jnp.where(negative, m1, 1))
    p = jnp.where(circular, m, jnp.where(hyperbolic, m1, 1 / divisor))
    ascends = hyperbolic | negative
    return _Parameter(circular, reciprocal, negative, ascends, p, jnp.sqrt(divisor))


@jax.jit
def _jacobi(u: FloatArray, m: FloatArray, m1: FloatArray) -> tuple[FloatArray, ...]:
    """(sn, cn, dn, ph) for arguments of one dtype; m + m1 = 1, each as exact as known.

    Every operation is an analytic function of u, m and m1 within its class, and the
    classes agree where they meet, so derivatives of any order come from
    differentiating the program; there is no 0/0 at m = 0, at m = 1 or at u = 0.
    """
    parameter = _classify(m, m1)
    rungs = ladder(parameter.p)

    # No sign is taken off w and put on again: XLA may compute w once with and once
    # without a fused multiply-add, and beside a whole half period the two signs differ.
    w = u * (parameter.scale / rungs.product)
    w, turns = _reduce(w, nome16(rungs), parameter.ascends)
    sn, cn, dn = _around_zero(w, parameter, rungs)
    ph = angle(sn, cn)

    # A half period on, m <= 1 has turned over (sn, cn) and m > 1 swung back (sn, dn).
    swings = m1 < 0
    parity = 1 - 2 * (turns - 2 * jnp.floor(0.5 * turns))
    return (
        parity * sn,
        jnp.where(swings, cn, parity * cn),
        jnp.where(swings, parity * dn, dn),
        jnp.where(swings, parity * ph, ph + turns * jnp.pi),
    )


@jax.custom_jvp
def _reduce(
    w: FloatArray, q16: FloatArray, ascends: Bool[Array, "..."]
) -> tuple[FloatArray, FloatArray]:
    """w less its whole half periods, and their number.

    The half period of w is pi on the circular side and -ln|q(p)| on the hyperbolic
    one, which is infinite at p = 0.
    """
    endless = ascends & (q16 == 0)
    half_period = jnp.where(ascends, log_nome(jnp.where(endless, 1, q16)), jnp.pi)
    turns = jnp.where(endless, 0, jnp.round(w / half_period))
    return w - turns * half_period, turns


@_reduce.defjvp
def _reduce_jvp(primals, tangents):
    # Where no half period is taken off, ln|q| is not differentiated: 0 * inf.
    _, q16, ascends = primals
    reduced, turns = _reduce(*primals)
    moves = ascends & (turns != 0)
    slope = jnp.where(moves, turns, 0) / jnp.where(moves, q16, 1)
    return (reduced, turns), (tangents[0] + slope * tangents[1], jnp.zeros_like(turns))


def _around_zero(
    w: FloatArray, parameter: _Parameter, rungs: Ladder
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """sn, cn, dn for w from one quarter period below zero to one above.

    Gauss's transformation (DLMF 22.7) in homogeneous coordinates, sn : cn : dn : 1
    = s : c : d : h, is a few products a step and no division:

        s, c, d, h  <-  (1 + l) s h, c d, h^2 - l s^2, h^2 + l s^2

    from (sin, cos, 1, 1).  Jacobi's imaginary transformation turns the same step,
    with -l for l, into the one that ascends from (sinh, cosh, 1, 1), where the
    homogeneous coordinates are those of sc, nc, dc.  There s and c are kept divided
    by y = e^|w|, so that no step over- or underflows, for m1 of any size; y is a
    common factor, a constant as far as derivatives go.
    """
    ascends = parameter.ascends
    sin, cos = sin_cos(jnp.where(ascends, 0, w))
    sinh, cosh, e = sinh_cosh(jnp.where(ascends, w, 0))
    s, c = jnp.where(ascends, sinh, sin), jnp.where(ascends, cosh, cos)
    y = 1 / jnp.maximum(e, jnp.finfo(w.dtype).tiny)
    signed_y = jnp.where(ascends, -y, 1)

    d = h = jnp.ones_like(w)
    for rung in rungs.rungs[:0:-1]:
        shift = rung * signed_y * y * (s * s)
        s, c, d, h = (1 + rung) * s * h, c * d, h * h - shift, h * h + shift
    # The last step takes y out of d and h again.  Its l y is p y / (1 + root)^2: the
    # smallest normal p and the largest y multiply before anything is divided by 4.
    rung = rungs.rungs[0]
    shift = signed_y * parameter.p * rungs.square * (s * s)
    square = e * (h * h)
    s, c, d, h = (1 + rung) * s * h, c * d, square - shift, square + shift

    circular, reciprocal, negative = parameter.circular, parameter.reciprocal, parameter.negative
    # Three quotients, not products with one reciprocal: XLA computes what leads to a
    # quotient once for all who use it, but what leads to a product once for each.
    unit = jnp.where(circular | reciprocal, h, jnp.where(negative, d, c))
    sn = s / (unit * parameter.scale)
    cn = jnp.where(circular, c, jnp.where(reciprocal, d, h)) / unit
    dn = jnp.where(reciprocal | negative, c, d) / unit
    # sn^2 + cn^2 = 1 but for the rounding of the steps: taken back, and not differentiated.
    onto = lax.stop_gradient(1.5 - 0.5 * (sn * sn + cn * cn))
    return _at_most_one(sn * onto), _at_most_one(cn * onto), dn


def _at_most_one(x: FloatArray) -> FloatArray:
    """x rounded back to [-1, 1]; its derivatives stay those of x."""
    return x - lax.stop_gradient(x - jnp.clip(x, -1, 1))
