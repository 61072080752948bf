"""The Landen ladder: one sequence that serves both ends of the parameter range.

For p in [-1, 1/2], the AGM of 1 and sqrt(1 - p) has the ratios

    l_1 = (1 - sqrt(1 - p)) / (1 + sqrt(1 - p)),   l_{n+1} = the same of l_n^2,

and AGM(1, sqrt(1 - p)) = 1 / prod(1 + l_n)  (DLMF 19.8.5, 19.8.12).  With p = m
the ladder descends to the circular functions, with p = 1 - m = m1 (the same
sequence, DLMF 22.7) it ascends to the hyperbolic ones.  p may be of either sign
and may be 0: every l_n is an analytic function of p there, which is why nothing
in this package has a kink at m = 0 or at m = 1.

The rejected form, (1 - a) / (1 + a), loses all digits of l_1 as p -> 0;
p / (1 + a)^2 is the same number without the subtraction.
"""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from ._elementary import half_root, log


class Ladder(NamedTuple):
    """The rungs and what is built from them."""

    p: Float[Array, "..."]
    root: Float[Array, "..."]  # sqrt(1 - p), the complementary modulus
    square: Float[Array, "..."]  # (1 + root)^-2, l_1 = p * square
    rungs: tuple[Float[Array, "..."], ...]  # l_1, l_2, ... until l_n < eps
    product: Float[Array, "..."]  # prod(1 + l_n) = 1 / AGM(1, sqrt(1 - p))


def ladder(p: Float[Array, "..."]) -> Ladder:
    """The ladder of `p`, -1 <= p <= 1/2, to the last digit of its dtype.

    |l_1| <= 0.172, l_2 <= 0.0075, l_3 <= 1.4e-5, l_4 <= 5e-11, l_5 <= 6e-22.
    """
    root = jnp.sqrt(1 - p)
    square = 1 / ((1 + root) * (1 + root))
    rungs, product = climb(p, square)
    return Ladder(p, root, square, rungs, product)


def climb(
    p: Float[Array, "..."], square: Float[Array, "..."]
) -> tuple[tuple[Float[Array, "..."], ...], Float[Array, "..."]]:
    """The rungs from the first, l_1 = p square, and prod(1 + l_n)."""
    l1 = p * square
    r2 = 0.5 * l1 * half_root(l1 * l1)
    l2 = r2 * r2
    # sqrt(1 - x) to O(x^3), x = l2^2 <= 5.6e-5: the first omitted term is
    # 4e-14 of l3, which is 5e-19 of 1.
    x = l2 * l2
    l3 = 0.25 * x * (1 + x * (0.5 + 0.3125 * x))
    rungs = (l1, l2, l3)
    if p.dtype == jnp.float64:
        rungs += (0.25 * l3 * l3,)
    # Less 1, at most 0.18: its roundings count that much less than those of the product.
    excess = rungs[-1]
    for rung in rungs[-2::-1]:
        excess = rung + (excess + excess * rung)
    return rungs, 1 + excess


def nome16(rungs: Ladder) -> Float[Array, "..."]:
    """16 q(p), of the sign of p; q = exp(-pi K(1 - p) / K(p)) in size.  16 q instead of q
    keeps p down to the smallest normal number from underflowing."""
    return rungs.p * nome16_over_p(rungs)


def nome16_over_p(rungs: Ladder) -> Float[Array, "..."]:
    """q = e + 2 e^5 + 15 e^9 + 150 e^13, e = (1 - b) / (2 (1 + b)), b = (1 - p)^(1/4)
    (DLMF 19.5.7), e = p / (2 (1 + b^2) (1 + b)^2) without its subtraction;
    |e| <= 0.0432, and the first omitted term, 1707 e^16, is 3e-19.
    """
    b = jnp.sqrt(rungs.root)
    slope = 8 / ((1 + rungs.root) * ((1 + b) * (1 + b)))
    e = rungs.p * slope / 16
    e4 = (e * e) * (e * e)
    return slope * (1 + e4 * (2 + e4 * (15 + 150 * e4)))


def log_nome(q16: Float[Array, "..."]) -> Float[Array, "..."]:
    """-ln|q| = pi K(1 - p) / K(p)."""
    return 4 * LN2 - log(jnp.where(q16 < 0, -q16, q16))


LN2 = 0.6931471805599453
