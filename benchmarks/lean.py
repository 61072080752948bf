"""Operations of the compiled scene against a count on paper.

The undamped, untorqued scene, one pendulum at many times, as `simulate` compiles it: what
one time costs, in additions, multiplications, divisions, roots, exponentials, roundings,
absolute values, minima and maxima.  Comparisons, selections and the bits of a sign are
left out, and so is all that depends on the pendulum alone.  The program has no branch, so
both feet of the ladder are in it.

                                                                             operations
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
    ------------------------------------------------------------------------------------
    θ alone                                                                         199
    W, v = 2√ε W                                                                      7
    θ and v                                                                         206
    v alone: 206 less S, C, the angle and the turns                                 147

Counted in XLA's optimised program with its fusion switched off: fusion computes again,
in each result, what two results share, since that is cheaper than to keep it; what it
adds is listed beside.
"""

import re
from collections.abc import Callable

import jax
import jax.numpy as jnp

from pendax import Pendulum, simulate

PAPER = {"θ": 199, "v": 147, "θ and v": 206}
ARITHMETIC = {
    "abs", "add", "divide", "exponential", "floor", "maximum", "minimum", "multiply",
    "negate", "round-nearest-even", "rsqrt", "sqrt", "subtract",
}  # fmt: skip
SIZE = 1024  # times: one block


def report(check: bool) -> int:
    missed = 0
    print("| asked for | on paper | counted | ratio | with fusion | loops | bar 1.05 |")
    print("|---|---|---|---|---|---|---|")
    for name, function in questions().items():
        counted = operations(program(function, SIZE, "fusion"))
        text = program(function, SIZE)
        ratio = counted / PAPER[name]
        loops = text.count(" while(")
        met = abs(ratio - 1) <= 0.05 and loops == 0
        missed += not met
        print(
            f"| {name} | {PAPER[name]} | {counted} | {ratio:.3f} | {operations(text)} "
            f"| {loops} | {'met' if met else 'missed'} |"
        )
    loops = program(questions()["θ and v"], 2**20).count(" while(")
    missed += loops > 1
    print(f"\nloops over blocks at 2²⁰ times: {loops}, at most 1 meant")
    return 1 if check and missed else 0


def questions() -> dict[str, Callable]:
    def run(ts, epsilon, v0, theta0):
        return simulate(Pendulum(epsilon), ts, v0, theta0)

    return {
        "θ": lambda *x: run(*x).theta,
        "v": lambda *x: run(*x).v,
        "θ and v": lambda *x: (lambda it: (it.theta, it.v))(run(*x)),
    }


def program(function: Callable, size: int, without: str | None = None) -> str:
    options = {"xla_disable_hlo_passes": without} if without else None
    lowered = jax.jit(function).lower(jnp.linspace(0.0, 10.0, size), 1.0, 1.3, 0.2)
    return lowered.compile(compiler_options=options).as_text()


def operations(text: str) -> int:
    """Arithmetic on arrays of SIZE elements."""
    found = re.findall(rf"= f(?:64|32)\[(?:1,)*{SIZE}\]\S* ([\w-]+)\(", text)
    return sum(name in ARITHMETIC for name in found)
