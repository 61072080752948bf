"""Operations counted on paper, from the formulas, of one element: a time, or a pendulum.

Additions, multiplications, divisions, roots, powers, sines, exponentials, roundings, absolute
values, minima and maxima.  Comparisons, selections and the bits of a sign are left out, and so is
what does not change: with the time where one pendulum is asked for at many, and from step to
step.  A program has no branch, so both feet of the ladder are in it.  Nothing is counted twice.

The closed form

    u = √ε (t − t0), w = factor u                                                     3
    turns = round(w / P), w − turns P                                                 4
    sin, cos of w: two polynomials of 8 terms in w²                                  37
    sinh, cosh of w: a polynomial of 6 terms in w², e^|w|, e^-|w|                    22
    four rungs, (1 + l) s h, g d, l s · s, h², h² ∓ l s²; the first from h = d = 1   34
    the smaller leg over the larger, |s| size and the clipped partner, a sign         8
    parity 6, 1 + q² 2, sn 4 and its partner 3 over their roots, signs 3             18
    dn from cn and sn: a root of two scaled squares                                   9
    D = c² + s² C0², 1/D                                                              5
    S, C                                                                             12
    θ/2 = 2 arctan (smaller / (1 + larger)): a polynomial of 11 terms                33
    whole turns, and θ of them                                                       14
    W, v = 2√ε W                                                                      7

Its derivatives in ε, v0 and θ0, of a sum over times: the slopes of the integral of sd², and the
columns ∂θ/∂v0, ∂θ/∂θ0, ∂v/∂v0, ∂v/∂θ0 by S, C, W

    up the ladder: z 4; a pole, n, z at three rungs 6 + 11 + 11; the last one 14;
        the half periods 1; dn N 6, cn N 5, their poles 5                            63
    ∂ph/∂m, (∂dn/∂m)/sn: negative 8, reciprocal 3, signs 6, a series 12, one from
        the other and back 11                                                        40
    those of θ: by m of s, c, d 4, S 7, C 7, θ 3; by W0 5; by θ0 11; together 7      44
    those of v beyond: by m 15, by θ0 6, together 7; alone, 4 more for s, c, d    28, 32
    held finite: 2 for each column                                                    4
    ∂θ/∂ε = (t v − v0 ∂θ/∂v0)/2ε; ∂v/∂ε has the force, a sine of θ: 5 and 59       4, 64

A time to a pendulum, what else depends on it: sin, cos of θ0/2 with quarter turns taken off 59;
√ε, m and the like 6; the gap to the separatrix, of both signs, in error-free products 104; the
ladder 40, its nome 17, a logarithm 28, scales 4; the angle of the start 32, |m1| 1: 291.  With
derivatives 83 more: weights of rungs 20, integrals of turns 20, powers of m 24, factors 19.

The period: numbers scaled 6, θ0/2 57, rise 5, gap 101, AGM: two roots, 12 steps of 4 but for the
last root 46, the rest 9.  Its derivatives: twice the steps' tangents, 7 a step, the first of
them known, 137; from T back to ε, v0, θ0 42.

The first-order junction: s 2, (λs)² and its size 4; angle, half turns 5; two series of 9 terms 52;
cos, sin over the root, slopes 5; ξ 3, its argument and turns 3, φ 2.  Below Ic e^-λs 5, its two
terms 2, real and imaginary part 6, argument 2, turned by φ0 7, turns and φ 7.  V instead: |ξ|²
and a quotient 4 and 5, R Ic 1.  Its derivatives, by JAX from these, are not counted.

One step of Taylor's method of order N: 2 N (N − 1) − 1 for the series of sin θ and cos θ, each
term m products, m − 1 sums and a division; N products by ε, N − 1 divisions; ε and v in the rate's
unit, the rate, 8 in all; sine and cosine of any angle 52: which quarter 2, the angle from it in
three parts 6, within bounds 1, two polynomials 37, the quarter of its turn 4, signs 2.  Its size:
of four terms of θ and v the larger against its scale, its logarithm, roughly, over n, the largest
of them 35; the scales 7, an exponential, roughly, 7, the longest 4.  θ and v by Horner 5 N.
Time 6.  β adds two operations to each term, and 3; a torque 4.
A torque a cos t: sine and cosine 52, the first power and the square of the unit 2; a term from the
one before the last 2, a, its unit and the sum 3, 5 N − 4 in all; its size now, its type 5.
With tangents the size needs four terms of sin θ as well, one of them not needed by v: 2 N + 8.
A tangent, of p: one sum of m + 1 products for each sine,
none of cosines; 5 for each term of the force, with β 9, with τ 3 in all; Horner 4 N; 6 beside.
"""

FREE = {"θ": 199, "v": 147, "θ and v": 206, "final θ": 199 + 291}
FREE["period"] = 6 + 57 + 5 + 101 + 46 + 9
_BOTH = FREE["θ and v"] + 63 + 40  # its derivatives need θ, v and the slopes in any case
FREE_GRADIENT = {
    "θ": _BOTH + 44 + 4 + 4,
    "v": _BOTH + 32 + 4 + 64,
    "θ and v": _BOTH + 44 + 28 + 8 + 4 + 64,
    "final θ": _BOTH + 44 + 4 + 4 + 291 + 83,
    "period": FREE["period"] + 137 + 42,
}
_RUNNING, _RESTING = 2 + 4 + 5 + 52 + 5 + 3, 5 + 2 + 6
JUNCTION = {
    "θ": _RUNNING + 3 + 2 + _RESTING + 2 + 7 + 7,
    "v": _RUNNING + 4 + _RESTING + 5 + 1,
    "θ and v": _RUNNING + 3 + 2 + 4 + _RESTING + 2 + 7 + 7 + 5 + 1,
}

# Of the tolerance 8e-15, and of 1e-12.
ORDER, WITH_TANGENTS, RUBBING = 20, 14, 16
SETTLING, RUBBING_TO_REST = 18, 12
_CIRCLE = 2 + 6 + 1 + 37 + 4 + 2  # sine and cosine of any angle
_SIZE, _TIME = 35 + 7 + 7 + 4, 6


def series(order: int, *, beta: bool = False, tau: bool = False, wave: bool = False) -> int:
    """v to the power `order` of time, from θ and v."""
    sines = 2 * order * (order - 1) - 1
    force = order + order - 1
    once = 8 + _CIRCLE + wave * (_CIRCLE + 3)
    return sines + force + once + beta * (2 * order + 2) + tau * 4 + wave * 5 * order


def tangent(order: int, *, beta: bool = False, tau: bool = False) -> int:
    """Of a series, of θ and v by Horner's rule, in one direction."""
    sines = order * order - 1
    force = 5 * order - 2 + beta * (4 * order + 1) + tau * 3
    return sines + force + 4 * order + 6


def step(
    order: int | None = None,
    *,
    beta: bool = False,
    tau: bool = False,
    wave: bool = False,
    directions: int = 0,
) -> int:
    order = order or (WITH_TANGENTS if directions else ORDER)
    terms = {"beta": beta, "tau": tau}
    value = series(order, **terms, wave=wave) + _SIZE + beta + 5 * order + _TIME
    forced = 2 * order + 8 if directions else 0
    return value + forced + directions * tangent(order, **terms)


def slow_step(order: int = 8, sweeps: int = 5) -> int:
    """Overdamped: sweeps of a series with v̇ from the one before, each term with 3 more."""
    sweep = 2 * order * (order + 1) - 1 + 3 * (order + 1)
    once = 14 + _CIRCLE  # rate, δ and its multiples
    return sweeps * sweep + once + _SIZE + 5 * order + 1 + _TIME


def settling_step(*, beta: bool = False, tau: bool = False) -> int:
    """And whether it is caught: wells before and after 19 each, the distance to the saddle 7,
    the energies 11 and a sine and cosine, the creeping 1; its time is a sum."""
    return step(SETTLING, beta=beta, tau=tau) - _TIME + 1 + 2 * 19 + 7 + 11 + _CIRCLE + 1


def rubbing_step(order: int = RUBBING) -> int:
    """Dry friction alone, a torque that has a sign: up to a turning point, or over it.

    Each term of a polynomial with its slope takes 4.  Where v first comes to nothing: at the end
    of the step, 6 Newton steps to a dip, 8 to a zero.  There four terms more to land on it, and
    whether friction holds the pendulum, by a sine.
    """
    slope, bend = 4 * order - 2, 4 * (order - 1) - 2
    zero = (order - 1) + slope + 1 + 6 * (bend + 4) + 2 * order + 4 + 8 * (slope + 4) + 3
    turn = order + 1 + zero + 6  # v in the direction of motion
    landed = series(4, tau=True) + 2 + 33
    return step(order, tau=True) - _TIME + 4 + turn + landed + 2 + 14 + _CIRCLE - 1
