"""Elliptic integrals in Arb, with all first and second derivatives; nothing here is pendax's."""

from collections.abc import Callable
from typing import NamedTuple

import flint
import numpy as np
from flint import acb, arb

STEP = 80  # differences take a step of 2^-80 of an argument


class Truth(NamedTuple):
    value: arb
    slopes: list[arb]
    curvatures: list[list[arb]]

    def scale(self, at: list[arb]) -> arb:
        """|f| + Σ |x ∂f/∂x|."""
        return abs(self.value) + sum(abs(x * g) for x, g in zip(at, self.slopes, strict=True))

    def scale_of_slope(self, at: list[arb], i: int) -> arb:
        """|g| + Σ |y ∂g/∂y| + scale(f) / max(|x|, 1), g = ∂f/∂x the i-th derivative."""
        over = sum(abs(x * h) for x, h in zip(at, self.curvatures[i], strict=True))
        size = abs(at[i])
        return abs(self.slopes[i]) + over + self.scale(at) / (size if size > 1 else 1)


def truth(function: Callable, at: list[float], bits: int, order: int = 2) -> Truth:
    """`function` of balls at floats, by central differences good to 2^-160 of themselves; one
    of an argument that is 0 has a step of 2^-80.  Of `order` 1 there are no curvatures."""
    count = len(at)
    with flint.ctx.workprec(bits):
        x = [arb(float(t)) for t in at]
        h = [(abs(t) if t != 0 else 1) * arb(2) ** -STEP for t in x]

        def moved(*by):
            y = list(x)
            for i, sign in by:
                y[i] = y[i] + sign * h[i]
            return function(*y)

        value = function(*x)
        up, down = ([moved((i, sign)) for i in range(count)] for sign in (1, -1))
        slopes = [(up[i] - down[i]) / (2 * h[i]) for i in range(count)]
        if order == 1:
            return Truth(value, slopes, [])
        curvatures = [[arb(0)] * count for _ in range(count)]
        for i in range(count):
            curvatures[i][i] = (up[i] + down[i] - 2 * value) / h[i] ** 2
            for j in range(i):
                signs = ((1, 1), (1, -1), (-1, 1), (-1, -1))
                total = sum(a * b * moved((i, a), (j, b)) for a, b in signs)
                curvatures[i][j] = curvatures[j][i] = total / (4 * h[i] * h[j])
        return Truth(value, slopes, curvatures)


def error(got, true: arb, scale: arb, dtype=np.float64) -> float:
    """|got − true| in eps of the dtype × scale."""
    with flint.ctx.workprec(3000):
        if scale == 0:
            return 0.0 if float(got) == 0 and true == 0 else float("inf")
        return float(abs(arb(float(got)) - true) / scale) / float(np.finfo(dtype).eps)


def carlson(name: str) -> Callable:
    """ "rf", "rc", "rd", "rg" or "rj" of balls, principal values for a last argument < 0."""

    def call(*x):
        return getattr(acb, f"elliptic_{name}")(*map(acb, x)).real

    return call


def legendre(name: str, parameter: str) -> Callable:
    """ "f", "e" (of φ and m or m1), "pi" (n, φ, m or m1), "pi_complete" (n, m or m1)."""

    def call(*arguments):
        *before, given = arguments
        m = given if parameter == "m" else 1 - given
        if name == "f":
            return acb.elliptic_f(acb(before[0]), acb(m)).real
        if name == "e":
            return acb.elliptic_e_inc(acb(before[0]), acb(m)).real
        if name == "pi":
            return acb.elliptic_pi_inc(acb(before[0]), acb(before[1]), acb(m)).real
        return acb.elliptic_pi(acb(before[0]), acb(m)).real

    return call
