"""The first-order junction under an alternating current: its turns per period, exactly.

    φ' = i0 + i1 sin Ωs − sin φ

A Riccati equation for e^{iφ}: a period maps it by (a z + b)/(b* z + a*), |a|² − |b|² = 1, and

    2 a' = i (i0 + i1 sin Ωs) a + b*,    2 b*' = a − i (i0 + i1 sin Ωs) b*

is linear.  What has turned after very many periods is in that one map: |Re a| > 1, two fixed
points, the junction is locked, and turns a whole number of times; |Re a| ≤ 1, by arccos(Re a)/π
beyond one.  Which number, the argument of a says, followed along the period.

Rejected: averages over many periods, whose error goes like 1/number, or like the square root of
the distance to a step.

Buchstaber, Karpov & Tertychnyi, Theor. Math. Phys. 162 (2010) 211.
"""

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from ..taylor import by_columns

Scalar = Float[Array, ""]
Components = Float[Array, "4"]  # real and imaginary parts of a and b*

_ORDER = 16  # of the series of a step, and
_STRIDE = 0.7  # how far it goes, in units of 1/rate: 0.7^17/17! is below all roundings
MOST_STEPS = 2_000_000


def rotation_number(i0: Scalar, i1: Scalar, omega: Scalar) -> tuple[Scalar, Scalar]:
    """Mean turns of φ in a period 2π/Ω, and how far rounding may have moved them.

    NaN where a period would take more than `MOST_STEPS` steps.
    """
    (real, log_size), (argument, steps) = by_columns(_period, [i0, i1, omega])
    fine = steps <= MOST_STEPS
    # A size that overflows belongs to a junction that is locked.
    size = jnp.exp(jnp.minimum(log_size, 200 if real.dtype == jnp.float64 else 60))
    half_trace = real * size
    locked = ~(jnp.abs(half_trace) < 1)
    inside = jnp.where(locked, 0, half_trace)
    sine = jnp.sqrt((1 - inside) * (1 + inside))
    # Between 0 and π, and on the side of the real axis where a is.
    angle = jnp.where(jnp.sin(argument) < 0, -1, 1) * jnp.arctan2(sine, inside)
    turns = jnp.round((argument - lax.stop_gradient(angle)) / (2 * np.pi))
    rho = jnp.where(locked, jnp.round(argument / np.pi) + 0.0, 2 * turns + angle / np.pi)
    eps = jnp.finfo(real.dtype).eps
    off = 16 * eps * size * jnp.sqrt(steps)
    at_edge = jnp.sqrt(2 * off)
    beside = jnp.where(jnp.abs(half_trace) - 1 > off, 0, at_edge)
    near = jnp.where(locked, beside, jnp.minimum(off / jnp.maximum(sine, off), at_edge)) / np.pi
    error = lax.stop_gradient(near + 4 * eps * jnp.abs(rho))
    return jnp.where(fine, rho, jnp.nan), jnp.where(fine, error, jnp.nan)


def _period(p: list[Scalar]) -> tuple[tuple[Scalar, Scalar], tuple[Scalar, Scalar]]:
    """a after a period: Re(a)/|a| and ln |a|; its argument, continued from 0, and the steps."""
    i0, i1, omega = p
    # The solution's rate, and the current's.
    rate = 0.5 * (jnp.abs(i0) + jnp.abs(i1) + 1) + omega
    wanted = jnp.ceil(lax.stop_gradient(2 * np.pi / omega * rate / _STRIDE))
    # NaN as well takes none.
    steps = jnp.where(wanted <= MOST_STEPS, wanted, jnp.inf)
    going = jnp.where(steps < jnp.inf, steps, 0)

    def step(at):
        k, (a0, a1, *b), argument, log_size = at
        c0, c1, *b = _step(i0, i1, omega, k, steps, jnp.stack([a0, a1, *b]))
        size = jnp.hypot(c0, c1)
        after = jnp.stack([c0, c1, *b]) / size
        turned = jnp.arctan2(a0 * c1 - a1 * c0, a0 * c0 + a1 * c1)
        return k + 1, after, argument + lax.stop_gradient(turned), log_size + jnp.log(size)

    zero = jnp.zeros_like(i0)
    start = (zero, jnp.stack([jnp.ones_like(i0), zero, zero, zero]), zero, zero)
    _, y, argument, log_size = lax.while_loop(lambda at: at[0] < going, step, start)
    return (y[0], log_size), lax.stop_gradient((argument, steps))


def _step(i0, i1, omega, k, steps, y: Components) -> Components:
    """After the k-th of `steps` steps, by its Taylor series."""
    n = np.arange(_ORDER)
    clock = 2 * np.pi / steps  # Ω h
    h = clock / omega
    # The series of the current, with the powers of h in it.
    growth = jnp.cumprod(jnp.append(jnp.ones_like(clock), clock / n[1:].astype(clock.dtype)))
    waves = jnp.sin(clock * k + (np.pi / 2 * (n % 4)).astype(clock.dtype))
    current = (i1 * growth * waves).at[0].add(i0)

    def term(series, n):
        y, before = series  # the last term, and all, the last first
        a0, a1, b0, b1 = current @ before
        turned = jnp.stack([-a1, a0, b1, -b0])
        y = 0.5 * h / n * (turned + jnp.roll(y, 2))
        return (y, jnp.concatenate([y[None], before[:-1]])), y

    before = jnp.zeros((_ORDER, 4), y.dtype).at[0].set(y)
    numbers = jnp.arange(1, _ORDER + 1, dtype=clock.dtype)
    return y + jnp.sum(lax.scan(term, (y, before), numbers)[1], 0)
