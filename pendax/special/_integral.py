"""Integrals from 0 to φ, whose derivatives are known: the integrand, and more integrals."""

from collections.abc import Callable
from functools import cache, partial

import jax
import jax.numpy as jnp
from jax.custom_derivatives import SymbolicZero

from ._cpu import DOZENS, in_blocks
from ._duplication import finite


def integral(
    value: Callable, integrand: Callable | None = None, by_m: Callable | None = None
) -> Callable:
    """∫₀^φ integrand, a function of (φ, …, m, m1) of one dtype whose value is that of `value`;
    without an integrand of (…, m, m1).

    The derivative in φ is the integrand.  That in a parameter is the integral of the
    integrand's derivative, and again of this kind: its value is the derivative of `value`,
    or, in m, the function `by_m`.  So a derivative in φ never goes through the cosine of φ,
    whose square root is not smooth at quarter turns.  Where the value is infinite, there is
    none: NaN.  To derivatives m1 is 1 − m: the
    tangent of m counts, that of m1 does not.
    """
    fast = jax.jit(in_blocks(lambda *arguments: (value(*arguments),), DOZENS))

    @jax.custom_jvp
    def call(*arguments):
        return fast(*arguments)[0]

    @cache
    def slope(i, count):
        if integrand is None:
            return integral(_along(value, i))
        if i == 0:
            return integrand
        if i == count - 2 and by_m is not None:
            return by_m
        return integral(_along(value, i), _along(integrand, i))

    @partial(call.defjvp, symbolic_zeros=True)
    def _(primals, tangents):
        y = call(*primals)
        tangent = jnp.zeros_like(y)
        for i, x in enumerate(tangents[:-1]):
            if not isinstance(x, SymbolicZero):
                by = slope(i, len(primals))(*primals)
                tangent = tangent + (by if i == 0 and integrand else finite(by)) * x
        return y, tangent * jnp.where(jnp.isfinite(y), 1, jnp.nan)

    return call


def _along(function: Callable, i: int) -> Callable:
    """The derivative of function(φ, …, m, m1) in its i-th argument."""

    def derivative(*arguments):
        last = len(arguments) - 1
        tangents = [jnp.full_like(x, j == i) for j, x in enumerate(arguments)]
        if i == last - 1:
            tangents[last] = -tangents[i]
        moving = [i, last] if i == last - 1 else [i]

        def of(*moved):
            full = list(arguments)
            for j, x in zip(moving, moved, strict=True):
                full[j] = x
            return function(*full)

        return jax.jvp(of, [arguments[j] for j in moving], [tangents[j] for j in moving])[1]

    return derivative
