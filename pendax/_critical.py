"""ω(v0) at the separatrix: the logarithmic law, its corrections, and its fit.

With x = t/√ε, t = |v0 − 2√ε|, and L = ln(4/√x),

    π√ε/(2 ω) = A(x) L + B(x)    below,        π√ε/ω = A(−x) L + B(−x)    above,

A(x) = 1 + x/4 + …, B(x) = −x/8 − …, two power series with rational coefficients.  The
sources' law keeps A = 1, B = 0.
"""

from fractions import Fraction
from functools import lru_cache, partial
from typing import Literal

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from ._arrays import common, difference_of_products, require
from ._results import Result
from .special._agm import agm

FloatArray = Float[Array, "..."]
Side = Literal["lower", "upper"]


def critical_law(t: ArrayLike, side: Side, epsilon: ArrayLike = 1.0, order: int = 0) -> FloatArray:
    """ω a distance t from the separatrix, by the law of chosen order, rad/s.

    **Arguments:**

    - `t`: |v0 − 2√ε| ≥ 0, rad/s, any shape.
    - `side`: "lower" (librating, v0 < 2√ε) or "upper" (rotating).
    - `epsilon`: ε > 0, 1/s²; broadcasts with `t`.
    - `order`: the power of t/√ε up to which the series are kept.  0 is the leading
      law ω = A / ln(B/√t), A = π√ε/2 below and π√ε above, B = 4 ε^¼.

    **Returns:** ω; 0 at t = 0, NaN for t < 0, for t so large that the law has no positive
    value (16 √ε for the leading one) or, under a transformation, ε ≤ 0.  The
    relative error is of the order of (t/(4√ε))^(order + 1).

    **Raises:** `ValueError` for another `side`, a negative `order`, a visible ε ≤ 0.

    Suzuki & Suzuki §2.7, §3.3; the series from DLMF 19.12.1.
    """
    if side not in ("lower", "upper"):
        raise ValueError(f'Argument `side` must be "lower" or "upper", but got {side!r}.')
    require("epsilon", epsilon, "positive", lambda x: x > 0)
    t, epsilon = common(t=t, epsilon=epsilon)
    return _critical_law(t, epsilon, side, order)


class CriticalSide(eqx.Module):
    """ω = A / ln(B/√t) fitted on one side: `amplitude` A, rad/s; `scale` B, (rad/s)^½.

    `residual` is the root mean square of ω_law/ω − 1; `count` the points used.
    """

    amplitude: FloatArray
    scale: FloatArray
    residual: FloatArray
    count: Array


class CriticalLaw(eqx.Module):
    """Both sides of the separatrix; `ratio` = A_upper/A_lower, 2 in theory."""

    lower: CriticalSide
    upper: CriticalSide
    ratio: FloatArray
    result: Result


def fit_critical_law(
    v0: ArrayLike, omega: ArrayLike, epsilon: ArrayLike = 1.0, order: int = 0
) -> CriticalLaw:
    """A and B of the critical law, from frequencies on both sides of the separatrix.

    **Arguments:**

    - `v0`, `omega`: one axis of equal length; points on both sides, in any order, the
      window being what is passed.  Points at t = 0 carry no information and no weight.
    - `epsilon`: ε > 0 of all of them, a scalar.
    - `order`: as for [`critical_law`][]: 0 fits ω = A / ln(B/√t); higher orders fit the
      same A and B with the series' corrections held, for windows far from t = 0.

    **Returns:** a [`CriticalLaw`][], by Gauss–Newton on relative residuals.
    With fewer than two distances on a side, that side is NaN and `result` says so.

    t is recomputed from the rounded v0 as |v0² − 4ε| / (|v0| + 2√ε), v0² error-free.
    """
    require("epsilon", epsilon, "a positive scalar", lambda x: (x > 0) & (x.ndim == 0))
    v0, omega, epsilon = common(v0=v0, omega=omega, epsilon=epsilon)
    if v0.ndim != 1 or v0.size == 0:
        raise ValueError(f"Argument `v0` must have one axis of points, but got shape {v0.shape}.")
    # optimistix keeps some state in the default dtype: float32 data are fitted in it.
    wide = jnp.result_type(float)
    law = _fit(v0.astype(wide), omega.astype(wide), epsilon[0].astype(wide), order)
    return jax.tree.map(lambda x: x.astype(v0.dtype) if x.dtype == wide else x, law)


def distance(v0: FloatArray, epsilon: FloatArray) -> tuple[FloatArray, Array]:
    """(t, below): t = ||v0| − 2√ε| to the last digit, for the floats as given."""
    gap = difference_of_products(4 * epsilon, None, v0, v0)
    return jnp.abs(gap) / (jnp.abs(v0) + 2 * jnp.sqrt(epsilon)), gap > 0


@partial(jax.jit, static_argnums=(2, 3))
def _critical_law(t: FloatArray, epsilon: FloatArray, side: Side, order: int) -> FloatArray:
    root = jnp.sqrt(jnp.where(epsilon > 0, epsilon, jnp.nan))
    a, b = _series(t / root, 1 if side == "lower" else -1, order)
    prefactor = (0.5 if side == "lower" else 1) * jnp.pi * root
    return _law(t, prefactor, 4 * jnp.sqrt(root), a, b)


@partial(jax.jit, static_argnums=2)
def frequency_at(t: FloatArray, epsilon: FloatArray, side: Side) -> FloatArray:
    """The exact ω a distance t > 0 from the separatrix, where v0 itself may be no float."""
    separatrix = 2 * jnp.sqrt(epsilon)
    if side == "lower":
        return 0.5 * agm(separatrix, jnp.sqrt(t * (2 * separatrix - t)))
    return agm(separatrix + t, jnp.sqrt(t * (2 * separatrix + t)))


@eqx.filter_jit
def _fit(v0: FloatArray, omega: FloatArray, epsilon: FloatArray, order: int) -> CriticalLaw:
    t, below = distance(v0, epsilon)

    def one(below, sign):
        used = below & (t > 0)
        a, b = _series(t / jnp.sqrt(epsilon), sign, order)
        return _fit_side(jnp.where(used, t, 1), jnp.where(used, omega, 1), a, b, used)

    (lower, ok_lower), (upper, ok_upper) = one(below, 1), one(~below, -1)
    result = Result.where(ok_lower & ok_upper, Result.successful, Result.not_converged)
    few = jnp.minimum(lower.count, upper.count) < 2
    result = Result.where(few, Result.too_few_points, result)
    return CriticalLaw(lower, upper, upper.amplitude / lower.amplitude, result)


def _fit_side(t, omega, a, b, used) -> tuple[CriticalSide, Array]:
    import optimistix as optx

    # In the unknowns 1/A and (ln B + mean)/A the law's 1/ω is linear, so the iteration
    # lands in one step.  In ln A and ln B it creeps; Levenberg-Marquardt, at the bottom,
    # may reject every further step and never call itself converged.
    count = jnp.sum(used)
    points = count.astype(t.dtype)
    log = -0.5 * jnp.log(t)
    mean = jnp.sum(jnp.where(used, log, 0)) / points

    def residuals(unknowns, _):
        inverse, shifted = unknowns
        law = a * (shifted + inverse * (log - mean)) + b * inverse
        return jnp.where(used, omega * law - 1, 0)

    eps = float(jnp.finfo(t.dtype).eps)
    solver = optx.GaussNewton(rtol=eps**0.75, atol=eps**0.75)
    start = jnp.zeros(2, t.dtype)
    solution = optx.least_squares(residuals, solver, start, max_steps=64, throw=False)
    inverse, shifted = solution.value
    ok = (solution.result == optx.RESULTS.successful) & (count > 1) & (inverse > 0)
    amplitude = jnp.where(ok, 1 / inverse, jnp.nan)
    scale = jnp.exp(shifted * amplitude - mean)
    law = _law(t, amplitude, scale, a, b)
    rms = jnp.sqrt(jnp.sum(jnp.where(used, (law / omega - 1) ** 2, 0)) / points)
    return CriticalSide(amplitude, scale, rms, count), ok


def _law(t, amplitude, scale, a, b):
    """A / (a ln(B/√t) + b); NaN for t < 0 and where the logarithm is spent."""
    at_zero = t == 0
    log = jnp.log(scale) - 0.5 * jnp.log(jnp.where(at_zero, 1, t))
    inverse = a * log + b
    beyond = ~(inverse > 0)  # t ≥ 16 √ε or so: no law there
    law = jnp.where(beyond, jnp.nan, amplitude / jnp.where(beyond, 1, inverse))
    return jnp.where(at_zero, 0, law)


def _series(x: FloatArray, sign: int, order: int) -> tuple[FloatArray, FloatArray]:
    """A(±x) and B(±x), to the power `order`, by Horner's rule."""

    def polynomial(series):
        total = jnp.zeros_like(x)
        for n in range(order, -1, -1):
            total = total * x + float(series[n]) * sign**n
        return total

    a, b = coefficients(order)
    return polynomial(a), polynomial(b)


@lru_cache
def coefficients(order: int) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...]]:
    """The coefficients of A(x) and B(x), exact, powers 0 … order.

    K = Σ a_n m1^n (ln(4/√m1) − r_n) with a_n = ((1/2)_n/n!)², r_{n+1} = r_n +
    1/((2n+1)(n+1)) (DLMF 19.12.1), at m1 = x − x²/4 = 1 − (1 − x/2)².
    """
    if order < 0:
        raise ValueError(f"Argument `order` must be zero or positive, but got {order}.")
    size = order + 1

    def times(p, q):
        return [sum(p[i] * q[n - i] for i in range(n + 1)) for n in range(size)]

    def padded(*low):
        return [Fraction(c) for c in low[:size]] + [Fraction(0)] * (size - len(low))

    m1, power = padded(0, 1, Fraction(-1, 4)), padded(1)
    weight, r = Fraction(1), Fraction(0)
    a, b = padded(), padded()
    for n in range(size):
        a = [x + weight * y for x, y in zip(a, power, strict=True)]
        b = [x - weight * r * y for x, y in zip(b, power, strict=True)]
        power = times(power, m1)
        weight *= Fraction(2 * n + 1, 2 * n + 2) ** 2
        r += Fraction(1, (2 * n + 1) * (n + 1))
    # ln(4/√m1) = L − ½ ln(1 − x/4) = L + Σ (x/4)^n / (2n)
    log = [Fraction(0)] + [Fraction(1, 2 * n * 4**n) for n in range(1, size)]
    b = [x + y for x, y in zip(b, times(log, a), strict=True)]
    return tuple(a), tuple(b)
