"""Carlson's duplication: the symmetric integrals of arguments that no longer differ much.

With lambda = sqrt(x y) + sqrt(x z) + sqrt(y z), all arguments may be replaced by
(x + lambda) / 4 without a change of RF(x, y, z)  (DLMF 19.26.18), and of RD and RJ but for
elementary terms (19.26.20 and 19.26.23).  Every sum is of positive terms, and it makes no
difference whether arguments are equal: there is nothing to cancel, in derivatives neither.
A step brings the arguments four times closer together in relation to their size; before,
while the two smaller ones are far from the third, it halves the exponent of their ratio.
Then Taylor's series about the mean (DLMF 19.36.1 and 19.36.2) is as exact as a float.
"""

from collections.abc import Callable
from functools import cache, partial

import jax
import jax.numpy as jnp
from jax import lax
from jax.custom_derivatives import SymbolicZero
from jaxtyping import Array, Float

from ._cpu import DOZENS, in_blocks
from ._elementary import rc_any, rc_middle, rc_near, reciprocal
from ._slope import LARGEST

FloatArray = Float[Array, "..."]


def _steps(dtype) -> tuple[int, int, float]:
    """Steps that are enough where the second largest of x, y, z is that share of the largest
    at least, and steps that are enough for all floats."""
    return (6, 13, 1e-5) if dtype == jnp.float64 else (4, 8, 1e-3)


@jax.custom_jvp
def root(x: FloatArray) -> FloatArray:
    """The square root, whose derivative at 0 is not inf, which times a tangent of 0 is no
    longer 0, but so large that it can't be taken for another."""
    return jnp.sqrt(x)


@root.defjvp
def _root_jvp(primals, tangents):
    r = root(*primals)
    endless = float(jnp.finfo(r.dtype).max) ** 0.25
    return r, tangents[0] * jnp.where(r > 0, 0.5 / jnp.where(r > 0, r, 1), endless)


def ordered(x: FloatArray, y: FloatArray, z: FloatArray, *others: tuple) -> list[tuple]:
    """(x, y, z) in ascending order, and `others` in the same order as they.

    By selection: `jnp.minimum` would average the derivatives of equal arguments."""
    rows = [(x, y, z), *others]

    def swapped(i, j):
        wrong = rows[0][i] > rows[0][j]
        for k, row in enumerate(rows):
            row = list(row)
            row[i], row[j] = jnp.where(wrong, row[j], row[i]), jnp.where(wrong, row[i], row[j])
            rows[k] = tuple(row)

    swapped(0, 1)
    swapped(1, 2)
    swapped(0, 1)
    return rows


def kernel(steps: Callable, long: Callable, three: Callable = lambda *x: x[:3]) -> Callable:
    """steps(count, *arguments), in blocks; where a block needs more than a few, long(…).

    `three` of the arguments are what the number of steps depends on."""

    def value(*arguments):
        few, all_, share = _steps(arguments[0].dtype)
        ((_, middle, highest),) = ordered(*three(*arguments))
        far = jnp.any(middle < share * highest)  # false for NaN
        branches = (lambda *x: (long(all_, *x),)), (lambda *x: (steps(few, *x),))
        return lax.cond(far, *branches, *arguments)

    fast = jax.jit(in_blocks(value, DOZENS))
    return lambda *arguments: fast(*jnp.broadcast_arrays(*arguments))[0]


def _differentiated(
    steps: Callable, loop: Callable, long: Callable, pole: Callable = lambda *x: False
) -> Callable:
    """The kernel of `steps`, inf where `pole`; its derivatives are kernels of theirs, and
    theirs are those of loop(count, *arguments), the same as `steps` but compiled faster."""

    def along(function, i, relative=False):
        """Its derivative in the i-th argument, or that times the argument, which does not
        leave the range of the floats on the way."""

        def slope(count, *arguments):
            arguments = jnp.broadcast_arrays(*arguments)
            by = arguments[i] if relative else jnp.ones_like(arguments[i])
            tangents = tuple(by if i == j else 0 * by for j in range(len(arguments)))
            return jax.jvp(partial(function, count), tuple(arguments), tangents)[1]

        return slope

    @cache
    def slope(i):
        relative = kernel(along(steps, i, True), along(loop, i, True))

        @jax.custom_jvp
        def call(*arguments):
            x = arguments[i]
            rest = relative(*arguments) * reciprocal(jnp.where(x == 0, 1, x))
            return finite(jnp.where(x == 0, -jnp.inf, rest))

        @call.defjvp
        def _(primals, tangents):
            again = partial(along(loop, i), _steps(primals[0].dtype)[1])
            return call(*primals), jax.jvp(jax.jit(again), primals, tangents)[1]

        return call

    def value(count, *arguments, steps=steps):
        return at_the_ends(steps(count, *arguments), pole(*arguments), *arguments)

    call = jax.custom_jvp(kernel(value, partial(value, steps=long)))

    @partial(call.defjvp, symbolic_zeros=True)
    def _(primals, tangents):
        moved = [i for i, x in enumerate(tangents) if not isinstance(x, SymbolicZero)]
        return call(*primals), sum(slope(i)(*primals) * tangents[i] for i in moved)

    return call


def at_the_ends(inside, pole, *arguments):
    """`inside`; inf at a `pole`, 0 where an argument is inf, NaN where one is negative."""
    least = highest = arguments[0]
    for x in arguments[1:]:
        least, highest = jnp.minimum(least, x), jnp.maximum(highest, x)
    value = jnp.where(jnp.isinf(highest), 0, inside)
    return jnp.where(least >= 0, jnp.where(pole, jnp.inf, value), jnp.nan)


def _means(x, y, z):
    """The roots, and the arguments a step on."""
    a, b, c = root(x), root(y), root(z)
    step = a * (b + c) + b * c
    return (a, b, c), step, tuple(0.25 * (t + step) for t in (x, y, z))


def rf_steps(count, x, y, z):
    for _ in range(count):
        x, y, z = _means(x, y, z)[2]
    return _rf_series(x, y, z)


def _rf_value(count, *arguments):
    ((_, middle, _),) = ordered(*arguments)
    return at_the_ends(rf_steps(count, *arguments), middle == 0, *arguments)


def _rf_series(x, y, z):
    r = 3 * reciprocal(x + y + z)
    x, y = 1 - x * r, 1 - y * r
    z = -(x + y)
    e2, e3 = x * y - z * z, x * y * z
    of_e2 = e2 * (-1 / 10 + e2 * (1 / 24 - 5 / 208 * e2 + e3 / 16))
    return root(r) * (1 + (of_e2 + e3 * (1 / 14 - 3 / 44 * e2 + 3 / 104 * e3)))


def _rd_step(at, _=None):
    x, y, z, total, quarter, lift = at
    (_, _, c), step, after = _means(x, y, z)
    term = quarter * reciprocal(c / lift * (z + step))
    return (*after, total + term, 0.25 * quarter, lift), None


def _rd_begun(x, y, z):
    (_, _, c), step, _ = _means(x, y, z)
    quarter = jnp.ones((), x.dtype)
    return x, y, z, jnp.zeros_like(x), quarter, _lift(1 / (c * (z + step)))


def _lift(first):
    """A power of 2 that keeps what follows a small first term among the normal numbers."""
    exponent = jnp.finfo(first.dtype).maxexp
    small = lax.stop_gradient(first) < 2.0 ** -(0.6 * exponent)
    return jnp.where(small, jnp.ones_like(first) * 2.0 ** (exponent // 4), 1)


def _rd_ended(x, y, z, total, quarter, lift):
    return (3 * total + _rj_series(x, y, z, z, quarter * lift)) / lift


def _rd_steps(count, *arguments):
    at = _rd_begun(*arguments)
    for _ in range(count):
        at, _ = _rd_step(at)
    return _rd_ended(*at)


def _rd_loop(count, *arguments):
    at = _rd_begun(*jnp.broadcast_arrays(*arguments))
    return _rd_ended(*lax.scan(_rd_step, at, length=count)[0])


def _rj_series(x, y, z, p, weight):
    r = 5 * reciprocal(x + y + z + 2 * p)
    x, y, z = 1 - x * r, 1 - y * r, 1 - z * r
    p = -0.5 * (x + y + z)
    xyz, pp = x * y * z, p * p
    e2 = x * (y + z) + y * z - 3 * pp
    e3 = xyz + 2 * p * (e2 + 2 * pp)
    e4 = (2 * xyz + p * (e2 + 3 * pp)) * p
    e5 = xyz * pp
    of_e2 = e2 * (-3 / 14 + e2 * (9 / 88 - e2 / 16) + 45 / 272 * e2 * e3)
    of_e3 = e3 * (1 / 6 - 9 / 52 * e2 + 3 / 40 * e3)
    of_e4 = e4 * (-3 / 22 + 3 / 20 * e2 - 9 / 68 * e3)
    of_e5 = e5 * (3 / 26 - 9 / 68 * e2)
    return (weight * r) * root(r) * (1 + (of_e2 + of_e3 + of_e4 + of_e5))


def _rj_step(at, _=None, rc=rc_any):
    x, y, z, p, total, quarter, lift, apart = at
    (a, b, c), step, after = _means(x, y, z)
    d = root(p)
    ra, rb, rg = (reciprocal(d + t) for t in (a, b, c))
    # e = (p - x)(p - y)(p - z) / ((d + a)(d + b)(d + c))^2, the differences those of the
    # start, and 1 + e without a cancellation where p is small.
    of_x, of_y, of_z = (quarter * far * r * r for far, r in zip(apart, (ra, rb, rg), strict=True))
    e, one = of_x * of_y * of_z, 2 * (d * ra) * ((p + step) * (rb * rg))
    term = quarter * (lift * ra * rb * rg) * (rc(e) if rc is rc_near else rc(e, one))
    return (*after, 0.25 * (p + step), total + term, 0.25 * quarter, lift, apart), None


def _rj_begun(x, y, z, p):
    a, b, c, d = root(x), root(y), root(z), root(p)
    lift = _lift(1 / (d + a) / (d + b) / (d + c))
    quarter = jnp.ones((), x.dtype)
    return x, y, z, p, jnp.zeros_like(x), quarter, lift, (p - x, p - y, p - z)


def _rj_ended(x, y, z, p, total, quarter, lift, _):
    return (6 * total + _rj_series(x, y, z, p, quarter * lift)) / lift


def _rj_steps(count, *arguments):
    at = _rj_begun(*arguments)
    # Where few steps are enough, e is from -0.26 to 0.44 after the first of them, and less
    # than 0.1 after three.
    soon = count == _steps(arguments[0].dtype)[0]
    for i in range(count):
        at, _ = _rj_step(at, rc=(rc_any, rc_middle, rc_middle, rc_near)[min(i, 3) * soon])
    return _rj_ended(*at)


def _rj_loop(count, *arguments):
    at = _rj_begun(*jnp.broadcast_arrays(*arguments))
    return _rj_ended(*lax.scan(_rj_step, at, length=count)[0])


# RF, RD and RJ of floats ≥ 0; p > 0 up to some times the largest of the others.
rd = _differentiated(
    _rd_steps, _rd_loop, _rd_steps, lambda x, y, z: (z == 0) | ((x == 0) & (y == 0))
)

rj = _differentiated(_rj_steps, _rj_loop, _rj_loop)


def sum_of_steps(count, x, y, z, of_rf, of_rd):
    at = _rd_begun(x, y, z)
    for _ in range(count):
        at, _ = _rd_step(at)
    return of_rf * _rf_series(*at[:3]) + of_rd * _rd_ended(*at)


# a RF(x, y, z) + b RD(x, y, z) of (x, y, z, a, b), not to be differentiated.
rf_and_rd = kernel(sum_of_steps, sum_of_steps)


def _rd_of(which: int) -> Callable:
    """RD of x, y and z, whose last argument is the smallest of them (0) or the middle (1)."""

    def of(function):
        def call(count, *arguments):
            ((lowest, middle, highest),) = ordered(*arguments)
            pair = (middle, lowest) if which == 0 else (lowest, middle)
            return function(count, highest, *pair)

        return call

    return _differentiated(*map(of, (_rd_steps, _rd_loop, _rd_steps)))


_rd_of_lowest, _rd_of_middle = map(_rd_of, (0, 1))

rf = jax.custom_jvp(kernel(_rf_value, _rf_value))


@partial(rf.defjvp, symbolic_zeros=True)
def _rf_jvp(primals, tangents):
    value = rf(*primals)
    moved = [i for i in range(3) if not isinstance(tangents[i], SymbolicZero)]
    if len(moved) < 3:
        others = {0: (1, 2), 1: (0, 2), 2: (0, 1)}
        slopes = (-1 / 6 * rd(*(primals[j] for j in others[i]), primals[i]) for i in moved)
        return value, sum(finite(s) * tangents[i] for s, i in zip(slopes, moved, strict=True))
    # Euler's x RD(y, z, x) + y RD(x, z, y) + z RD(x, y, z) = 3 RF saves the third: the
    # largest has a third of the sum or more.
    of_x, of_y = finite(_rd_of_lowest(*primals)), finite(_rd_of_middle(*primals))
    (x, y, z), (dx, dy, dz) = ordered(*primals, tangents)
    of_z = (3 * value - x * of_x - y * of_y) / z
    return value, -1 / 6 * (of_x * dx + of_y * dy + of_z * dz)


def finite(slope: FloatArray) -> FloatArray:
    """inf times a tangent of 0 is not 0: where a slope overflows, about the largest float."""
    largest = LARGEST * float(jnp.finfo(slope.dtype).max)
    return jnp.where(jnp.isinf(slope), jnp.copysign(largest, slope), slope)
