"""Taylor's method: how long a step of the series may be, and where in it a motion turns.

The last terms say how far the series may be trusted, before the step is taken: no step is
rejected.  Steps are held fixed when a step is differentiated: its derivatives are then Taylor's
method for the variational equations, whose series converge where this one does.

Two terms, as is the custom, are too few: of a release from rest at 90° v has the powers 1, 5, 9, …
of t alone.

Jorba & Zou, Exp. Math. 14 (2005) 99.
"""

import math
from collections.abc import Callable
from functools import partial, reduce
from typing import Any, NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from ..special._cpu import stage
from ._analytic import Analytic
from ._first_zero import first_zero
from ._series import Ramp, Scene, State, scaled_series

Scalar = Float[Array, ""]

# Steps of this length leave what decays small.
STABLE = 2.0


class Method(NamedTuple):
    """A step of size h and, from (θ, v), the size that keeps it within the tolerances.

    `series(scene, state)`: what both need, to be handed to them, and `None` where each computes
    it; `turn(scene, state, way, most)`: the size of one on which v keeps the sign `way`, `most` at
    most, and negative where v comes to nothing at its end; `landed(scene, state)`: from a state
    where v is nothing but for rounding and derivatives, to where it is nothing, and the time.
    """

    series: Callable[[Scene, State], Any]
    size: Callable[..., Scalar]  # scene, state, series
    step: Callable[..., State]  # scene, state, h, series
    turn: Callable[[Scene, State, Scalar, Scalar], Scalar]
    landed: Callable[[Scene, State], tuple[State, Scalar]]


def order_for(rtol: float, atol: float, most: int = 20) -> int:
    """The order of least work: −½ ln(tolerance), and more for what a step costs at any order.

    It is flat from there on; `most` where programs are long or roundings show.
    """
    return max(10, min(most, round(4 - 0.5 * math.log(min(rtol, atol)))))


def taylor(
    order: int, rtol: float, atol: float, longest: float = STABLE, forced: float | None = None
) -> Method:
    """Steps of given `order`, errors within atol + rtol |y| in θ and in v each.

    At rest the motion's own series says nothing, and perturbations still move like e^(λt) with
    |λ| ≤ √ε or β: no step is longer than `longest` over the larger of these.  What moves them
    with ε is sin θ, of which a fast rotation tells nothing: its series is within `forced`.
    """

    def quickest(scene):
        rate = jnp.sqrt(scene.epsilon)
        return rate if scene.beta is None else jnp.maximum(rate, scene.beta)

    return method(scaled_series, order, rtol, atol, quickest, longest, forced=forced)


def for_tangents(order: int, rtol: float, atol: float) -> float:
    """The longest step after which a perturbation's own series is within the tolerance."""
    return min(STABLE, (math.factorial(order) * min(rtol, atol)) ** (1 / order))


_BRIEF = 4  # terms of θ around a turning point: derivatives are right up to the third


def method(
    series_of: Callable,
    order: int,
    rtol: float,
    atol: float,
    quickest: Callable,
    longest: float,
    cut: Callable = stage,
    forced: float | None = None,
) -> Method:
    """Of `series_of(order, scene, state)`: a rate, the coefficients in rate · t of v / rate and,
    where `forced` is an error allowed for them, of sin θ."""
    series = partial(series_of, order)

    def shared(scene, state):
        return series(scene, state) if cut is plain else None

    def theta_after(scene, state, h, known=None):
        rate, v, _ = known or series(scene, state)
        return state.theta + h * rate * polynomial(integrated(v[:-1]), h * rate)

    def v_after(scene, state, h, known=None):
        # On a slow manifold the series starts from a v of its own.
        rate, v, _ = known or series(scene, state)
        return rate * (v[0] + h * rate * polynomial(v[1:], h * rate))

    def step(scene, state, h, known=None):
        given = (scene, state, h) if known is None else (scene, state, h, known)
        return State(cut(theta_after, *given), cut(v_after, *given))

    def size_of(scene, state, known=None):
        rate, v, sines = known or series(scene, state)
        theta = integrated(v)
        tolerance = max(rtol, atol)
        scales = [atol / tolerance + rtol / tolerance * jnp.abs(x) for x in state]
        scales[1] = scales[1] / rate

        def relative(n):
            # θ's list starts at n = 1.
            sizes = [jnp.abs(theta[n - 1]) / scales[0], jnp.abs(v[n]) / scales[1]]
            if forced is not None:
                sizes.append(tolerance / forced * jnp.abs(sines[n]))
            return reduce(jnp.maximum, sizes)

        last, most = LAST, longest / quickest(scene)
        if isinstance(scene.tau, Ramp):
            last = 6
        if isinstance(scene.tau, Analytic):
            last = LAST if scene.tau.power() == 0 else scene.tau.power() + 5
            # Of an entire function the type says what the last terms may not.
            quickness = jnp.maximum(scene.tau.quickness(), jnp.finfo(most.dtype).tiny)
            most = jnp.minimum(most, for_tangents(order, rtol, atol) / quickness)
        sizes = [relative(n) for n in range(order - last + 1, order + 1)]
        return jnp.minimum(reach(sizes, order, tolerance) / rate, most)

    def size(scene, state, known=None):
        given = (scene, state) if known is None else (scene, state, known)
        return cut(size_of, *lax.stop_gradient(given))

    def turn_of(scene, state, way, most):
        h = jnp.minimum(size_of(scene, state), most)
        rate, v, _ = series(scene, state)
        v = [way * x for x in v]
        # From rest v is t times what has no zero at the start; there it can't go the other way.
        rest = v[0] == 0
        started = [jnp.maximum(v[1], 0), *v[2:], jnp.zeros_like(h)]
        v = [jnp.where(rest, x, y) for x, y in zip(started, v, strict=True)]
        x, found = first_zero(v, h * rate)
        h = jnp.minimum(x / rate, h)
        return jnp.where(found, -h, h)

    def turn(scene, state, way, most):
        return cut(turn_of, *lax.stop_gradient((scene, state, way, most)))

    def landed(scene, state):
        rate, v, _ = series_of(_BRIEF, scene, state)
        slopes = [n * x for n, x in enumerate(v)][1:]
        x = -v[0] / v[1]
        x = x - polynomial(v, x) / polynomial(slopes, x)
        theta = state.theta + x * polynomial(integrated(v[:-1]), x)
        return State(theta, jnp.zeros_like(x)), x / rate

    return Method(shared, size, step, turn, landed)


# A release from rest leaves out three powers, or, by a force that grows with time, five.
LAST = 4


def reach(sizes: list[Scalar], order: int, tolerance: float) -> Scalar:
    """How far a series of `order` N is to be trusted, in its unit of time.

    As far as its n-th term, whose relative `sizes` are of the last ones, is tolerance^(n/N): by
    the root test, as if the terms were those of a geometric series.
    """
    roots = [_log2(x) / n for n, x in enumerate(sizes, order - len(sizes) + 1)]
    power = math.log2(tolerance) / order - reduce(jnp.maximum, roots)
    return jnp.where(jnp.isfinite(power), _exp2(power), jnp.where(power > 0, jnp.inf, 0))


# What a step's size needs of them.  To all digits they were slower than the rest of it: XLA's CPU
# backend calls a library, number by number.


def _log2(x: Scalar) -> Scalar:
    """Within 0.044, of which an n-th root is left: the bits of a float, read as an integer.

    ∞ of what is not a number, too.
    """
    info = jnp.finfo(x.dtype)
    bits = lax.bitcast_convert_type(x, jnp.int32 if info.bits == 32 else jnp.int64)
    bits = (bits >> (info.bits - 32)).astype(jnp.int32)  # whose conversions are vectorised
    one = 2.0 ** (info.nmant - (info.bits - 32))
    log = bits.astype(x.dtype) * (1 / one) + (info.minexp - 1 + 0.043)
    return jnp.where(x == 0, -jnp.inf, jnp.where(x < jnp.inf, log, jnp.inf))


def _exp2(x: Scalar) -> Scalar:
    """Within 0.3 %: parabolas between powers of two, which have to be in range."""
    info = jnp.finfo(x.dtype)
    whole = jnp.floor(x)
    part = x - whole
    biased = (whole.astype(jnp.int32) + (1 - info.minexp)).astype(f"int{info.bits}")
    power = lax.bitcast_convert_type(biased << info.nmant, x.dtype)
    return power * (1 + part * (0.66 + 0.34 * part))


def plain(function: Callable, *arguments):
    """No cut: for steps that are few."""
    return function(*arguments)


def integrated(v):
    return [x / (n + 1) for n, x in enumerate(v)]


def polynomial(coefficients, h):
    total = coefficients[-1]
    for x in coefficients[-2::-1]:
        total = total * h + x
    return total
