"""From u to the reduced argument w, and from w up the ladder to sn, cn, dn."""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from ._elementary import sin_cos, sinh_cosh
from ._kinds import Kind, Scales
from ._landen import climb

FloatArray = Float[Array, "..."]


def reduce(
    u: FloatArray, factor: FloatArray, half_period: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """(w, turns): w = factor u less its whole half periods, and their number."""
    # No sign is taken off w and put on again: XLA may compute w once with and once
    # without a fused multiply-add, and beside a whole half period the two signs differ.
    w = u * factor
    turns = jnp.round(w / half_period)
    return _taken_off(w, turns, half_period), turns


def reduce_late(
    u: FloatArray, factor: FloatArray, half_period: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """`reduce` for a long half period in w from -8 to all but 8 of it, and so for -u.

    The derivative of a half period with respect to m1 is about 1 / m1, and what two of
    them add to a second derivative cancels until the function is no longer small.
    """
    w = u * factor
    early = jnp.minimum(0.5, 8 / half_period)
    turns = jnp.sign(w) * jnp.floor(jnp.abs(w) / half_period + early)
    return _taken_off(w, turns, half_period), turns


def _taken_off(w, turns, half_period):
    none = turns == 0  # half_period may be inf, and -0 - 0 is not -0
    return jnp.where(none, w, w - turns * jnp.where(none, 1, half_period))


def parity(turns: FloatArray) -> FloatArray:
    """1 for an even and -1 for an odd number of half periods."""
    return 1 - 2 * (turns - 2 * jnp.floor(0.5 * turns))


class Step(NamedTuple):
    """Homogeneous coordinates at one rung.

    Descending, sn : cn : dn : 1 = s : c g : d : h with c the cosine at the foot;
    ascending, sn : cn : dn : 1 = s : h : d : c g with c the hyperbolic cosine.
    """

    s: FloatArray
    g: FloatArray
    d: FloatArray
    h: FloatArray


class Foot(NamedTuple):
    s: FloatArray
    c: FloatArray


def foot(w: FloatArray, is_: Kind) -> Foot:
    """Sine and cosine, or the hyperbolic ones, at the foot of the ladder."""
    limit = _limit(w)
    sin, cos = sin_cos(jnp.where(is_.ascends, 0, w))
    sinh, cosh = sinh_cosh(jnp.where(is_.ascends, jnp.clip(w, -limit, limit), 0))
    return Foot(jnp.where(is_.ascends, sinh, sin), jnp.where(is_.ascends, cosh, cos))


def _limit(w: FloatArray) -> float:
    """Beyond it 1 / cosh w is no normal number."""
    return float(np.log(np.finfo(w.dtype).max)) - 2


def endless(w: FloatArray, is_: Kind) -> Array:
    """Where cosh w is out of range; only at m1 = 0 is there no half period before."""
    return is_.ascends & (jnp.abs(w) > _limit(w))


def steps(at: Foot, is_: Kind, scales: Scales) -> list[Step]:
    """Every rung from the foot to the top, for w from half a half period below zero to
    one above.

    Gauss's transformation (DLMF 22.7) in homogeneous coordinates is a few products a
    step and no division:

        s, g, d, h  <-  (1 + l) s h, g d, h^2 - l s^2, h^2 + l s^2

    from (sin, 1, 1, 1).  Jacobi's imaginary transformation turns the same step, with -l
    for l, into the one that ascends from (sinh, 1, 1, 1).  sinh^2 is never formed alone:
    l sinh^2 is at most 4 where sinh^2 may overflow.
    """
    rungs, _ = climb(scales.p, scales.square)
    sign = jnp.where(is_.ascends, -1, 1)
    one = jnp.ones_like(at.s)
    climbed = [Step(at.s, one, one, one)]
    for n, rung in reversed(list(enumerate(rungs))):
        s, g, d, h = climbed[-1]
        # The smallest normal p times (1 + root)^-2 would underflow.
        shift = (rung * s if n else scales.p * s * scales.square) * (sign * s)
        climbed.append(Step((1 + rung) * s * h, g * d, h * h - shift, h * h + shift))
    return climbed


def ratio(w: FloatArray, is_: Kind, scales: Scales) -> FloatArray:
    """Of the legs of the right angle, sn^2 + cn^2 = 1 or m sn^2 + dn^2 = 1 where m > 1: the
    smaller over the larger, with a minus sign where the sine is the larger.

    One number from which both follow to the last digit: XLA's CPU backend would compute
    all of this twice for two.
    """
    at = foot(w, is_)
    s, g, d, h = steps(at, is_, scales)[-1]
    side = jnp.abs(s) * jnp.where(is_.reciprocal, 1, scales.size)
    partner = jnp.where(is_.ascends, jnp.where(is_.swings, d, h), at.c * g)
    partner = jnp.maximum(partner, 0)  # below it only by the rounding of w, at its end
    q = jnp.minimum(side, partner) / jnp.maximum(side, partner)
    q = jnp.where(endless(w, is_), 0, q)
    return jnp.where(side > partner, -q, q)


def legs(
    q: FloatArray, w: FloatArray, turns: FloatArray, m: FloatArray, m1: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """sn, and of cn and dn the one that passes through zero: cn for m <= 1, dn above."""
    sine_is_larger = jnp.signbit(q)  # and not q < 0: q may be -0
    square = 1 + q * q
    sine = jnp.copysign(jnp.where(sine_is_larger, 1, q), w)
    cosine = jnp.where(sine_is_larger, jnp.abs(q), 1)
    sn = parity(turns) * sine / jnp.sqrt(square * jnp.where(m1 < 0, m, 1))
    partner = parity(turns) * cosine / jnp.sqrt(square)
    return sn, partner


def other(sn: FloatArray, partner: FloatArray, m1: FloatArray) -> FloatArray:
    """What `legs` leaves out: the root of a sum of two squares,
    dn^2 = cn^2 + m1 sn^2 or cn^2 = dn^2 - m1 sn^2."""
    # For a small m1 the squares of two small numbers would underflow.
    many = 2.0 ** (jnp.finfo(m1.dtype).maxexp // 2 - 2)
    near = jnp.abs(m1) < 1 / many
    up, down = jnp.where(near, many, 1), jnp.where(near, 1 / many, 1)
    side, other = up * partner, up * sn
    root = jnp.sqrt(side * side + jnp.abs(m1) * other * other) * down
    return jnp.where(m1 < 0, jnp.minimum(root, 1), root)
