"""The parameter m sorted into four classes, and all that depends on m alone."""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from ._landen import ladder, log_nome, nome16

FloatArray = Float[Array, "..."]
BoolArray = Bool[Array, "..."]


class Kind(NamedTuple):
    """m in one of four classes, each with a p in [-1, 1/2] that its ladder is built on.

    class         m            p                  functions of scale * u at p
    circular      -1 … 1/2     m                  sn, cn, dn
    hyperbolic    1/2 … 2      m1, either sign    sn, cn, dn
    reciprocal    above 2      1/m                sn / scale, dn, cn    (DLMF 22.17)
    negative      below -1     1/m1               sd / scale, cd, nd

    circular and reciprocal descend to sin and cos, hyperbolic and negative ascend
    to tanh and sech.  For m > 1 the amplitude swings: dn changes sign and cn does not.
    """

    circular: BoolArray
    hyperbolic: BoolArray
    reciprocal: BoolArray
    negative: BoolArray
    swings: BoolArray

    @property
    def ascends(self) -> BoolArray:
        return self.hyperbolic | self.negative


def kind(m: FloatArray, m1: FloatArray) -> Kind:
    """m + m1 = 1, each as exact as known.  Comparisons: cheaper to repeat than to keep."""
    reciprocal = m > 2
    negative = ~(m >= -1)  # NaN goes this way too, and stays NaN
    circular = (m <= 0.5) & ~negative
    hyperbolic = (m > 0.5) & ~reciprocal
    return Kind(circular, hyperbolic, reciprocal, negative, m1 < 0)


class Scales(NamedTuple):
    """What the classes' ladders need, one number each for an m."""

    p: FloatArray
    square: FloatArray  # (1 + root)^-2, root = sqrt(1 - p)
    factor: FloatArray  # w = factor * u, the argument at the base of the ladder
    half_period: FloatArray  # of w; inf at p = 0 where it ascends
    size: FloatArray  # 1 / scale; sqrt(m) where hyperbolic functions swing; else 1


def scales(m: FloatArray, m1: FloatArray) -> Scales:
    """m + m1 = 1, each as exact as known."""
    is_ = kind(m, m1)
    divisor = jnp.where(is_.reciprocal, m, jnp.where(is_.negative, m1, 1))
    p = jnp.where(is_.circular, m, jnp.where(is_.hyperbolic, m1, 1 / divisor))
    rungs = ladder(p)
    q16 = nome16(rungs)
    endless = p == 0
    length = log_nome(jnp.where(endless, 1, q16)) + jnp.where(endless, jnp.inf, 0)
    scale = jnp.sqrt(divisor)
    return Scales(
        p,
        rungs.square,
        scale / rungs.product,
        jnp.where(is_.ascends, length, jnp.pi),
        jnp.where(is_.swings & is_.hyperbolic, rungs.root, 1 / scale),
    )
