"""Retrapping: the torque whose saddles are joined by an orbit.

With x the angle beyond one saddle, θ̇ = 2 sin(x/2) z(x), and z is smooth from that saddle, x = 0,
to the next, x = 2π, the orbit leaving the one and arriving at the other:

    2 s z z' = τ s + c (κ − z²) − β z,    s = sin(x/2), c = cos(x/2), κ = √(1 − τ²),    ε = 1.

Both ends are regular for one τ only.  z = 1 + β ζ and τ = sin(β a) leave a problem that
has its digits at β = 0, where a = 4/π, and at τ = 1.  It is solved by collocation, once, at
the nodes of a polynomial in β² that is a(β) to all digits from 0 to β*.

Rejected: τ itself as the unknown, κ having no derivative at 1; the gap between the two
saddles' velocities halfway, a difference that is of order β; bisection by simulation.
"""

from functools import cache

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, ArrayLike, Float
from numpy.polynomial import chebyshev

from .._arrays import common, require, widened

FloatArray = Float[Array, "..."]

# β* of ε = 1, where τ_r reaches ε: a test finds it again from a(β).
LARGEST = 1.19304591882263494
_ORDER = 64  # of ζ in x; near β*, where it has most to describe, the last are 1e-13
_TERMS = 22  # of a in β²


def retrapping_torque(beta: ArrayLike, epsilon: ArrayLike = 1.0) -> FloatArray:
    """The torque τ_r below which a running pendulum is captured, whatever its velocity.

    From τ_r to ε both end states exist, at rest in a well and running for ever; τ_r is where an
    orbit leads from saddle to saddle.

    **Arguments:** the damping `beta` ≥ 0, 1/s, and `epsilon`, 1/s²; shapes broadcast.

    **Returns:** τ_r, 1/s²: (4/π) β √ε − 0.315139288 β³/√ε + … for small β, ε from
    β = 1.193045918822635 √ε on, where no hysteresis is left.  A junction of Stewart–McCumber
    parameter β_c = ε/β² = 1 has I_r/Ic = τ_r(1) = 0.964327124471, and hysteresis ends at
    β_c = 0.702563658.

    **Raises:** `ValueError` for β < 0 and ε ≤ 0; under a transformation such lanes are NaN.

    **Accuracy:** 4 eps relative, derivatives of every order by ordinary differentiation of
    a polynomial.  The first derivative is continuous at β*, both sides 0; the second is not.
    Suzuki & Suzuki §8.2, §8.3, where 4 I_c/(π √β_c) is the leading term.
    """
    require("beta", beta, "zero or positive", lambda x: (x >= 0) & np.isfinite(x))
    require("epsilon", epsilon, "positive", lambda x: (x > 0) & np.isfinite(x))
    return widened(_of_epsilon)(*common(beta=beta, epsilon=epsilon))


def _of_epsilon(beta: FloatArray, epsilon: FloatArray) -> FloatArray:
    # As factors, for the derivatives.
    fine = jnp.where((beta >= 0) & (epsilon > 0), jnp.ones_like(beta), jnp.nan)
    scaled = fine * beta / jnp.sqrt(jnp.where(epsilon > 0, epsilon, 1))
    return epsilon * retrapping(scaled)


def retrapping(beta: FloatArray) -> FloatArray:
    """τ_r for ε = 1."""
    inside = jnp.where(beta < LARGEST, beta, LARGEST)  # NaN stays outside, and is put back
    share = inside / LARGEST
    angle = inside * _clenshaw(2 * share * share - 1)
    return jnp.where(beta < LARGEST, jnp.sin(angle), jnp.where(beta >= LARGEST, 1, beta))


def _clenshaw(x: FloatArray) -> FloatArray:
    *rest, last = (float(c) for c in _coefficients()[::-1])
    b1, b2 = jnp.zeros_like(x), jnp.zeros_like(x)
    for c in rest:
        b1, b2 = c + 2 * x * b1 - b2, b1
    return last + x * b1 - b2


@cache
def _coefficients() -> np.ndarray:
    nodes = chebyshev.chebpts1(_TERMS)
    angles = [_angle(LARGEST * np.sqrt((x + 1) / 2)) for x in nodes]
    return chebyshev.chebfit(nodes, angles, _TERMS - 1)


def _angle(beta: float) -> float:
    """a(β): Newton's method for a and the Chebyshev coefficients of ζ."""
    s, c, values, slopes = _basis()
    a, zeta = 4 / np.pi, np.zeros(_ORDER + 1)
    for _ in range(9):
        z, dz = 1 + beta * (values @ zeta), slopes @ zeta
        bend = 2 * np.sin(beta * a / 2) ** 2 / beta
        # (κ − z²)/β
        miss = -bend - (values @ zeta) * (1 + z)
        residual = 2 * s * z * dz - np.sin(beta * a) / beta * s + z - c * miss
        of_zeta = (2 * s * z)[:, None] * slopes
        of_zeta += (2 * s * beta * dz + beta + 2 * c * z)[:, None] * values
        of_a = c * np.sin(beta * a) - s * np.cos(beta * a)
        change = np.linalg.solve(np.column_stack([of_a, of_zeta]), residual)
        a, zeta = a - change[0], zeta - change[1:]
    return a


@cache
def _basis() -> tuple[np.ndarray, ...]:
    """sin(x/2), cos(x/2), and Chebyshev polynomials with their slopes, one node more than ζ has."""
    u = np.linspace(-1, 1, _ORDER + 2)
    t = np.sin(np.pi * u / 2)  # x = π (1 + t)
    s, c = np.cos(np.pi * t / 2), -np.sin(np.pi * t / 2)
    s[[0, -1]] = 0
    slopes = chebyshev.chebval(t, chebyshev.chebder(np.eye(_ORDER + 1))).T
    return s, c, chebyshev.chebvander(t, _ORDER), slopes / np.pi
