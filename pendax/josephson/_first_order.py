"""The first-order junction at a constant current, φ' = τ − sin φ: what is known in closed form."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

FloatArray = Float[Array, "..."]

_TERMS = 9  # of the series around the critical current


def mean_voltage(current: FloatArray, critical: FloatArray, resistance: FloatArray) -> FloatArray:
    """R √(I² − Ic²), of the sign of I; 0 below."""
    size = jnp.abs(current)
    running = size > critical
    # Its square root is not to see what is below, for the derivatives.
    x = jnp.where(running, size, 2 * critical)
    volts = resistance * jnp.sqrt((x - critical) * (x + critical))
    nothing = 0 * current * critical * resistance  # NaN stays
    return jnp.where(running, jnp.sign(current) * volts, nothing)


def phase_after(tau: FloatArray, s: FloatArray, phase0: FloatArray):
    """φ(s) from φ(0), and φ'.

    e^{iφ} obeys a Riccati equation, and φ is twice the argument of ξ = C + S (iτ + e^{−iφ0}) beyond
    φ0, with C = cosh λs, S = sinh(λs)/2λ, 4λ² = 1 − τ²; φ' = (τ − sin φ0)/|ξ|².  ξ turns about
    once in every 2π/√(τ² − 1): half turns are counted, and only what is left goes to arctan2.
    """
    square = (1 - tau) * (1 + tau)
    q = square * (0.5 * s) ** 2  # (λs)²
    small, relaxing = jnp.abs(q) < 0.1, q > 0
    near, above, below = small, ~small & ~relaxing, ~small & relaxing

    # Each with numbers of its own where it is not asked.
    x = jnp.where(near, q, 0)
    c_near, s_near = (0.5 * _series(x, first) for first in (0, 1))
    root = jnp.sqrt(jnp.where(near, 1, jnp.abs(square)))
    angle = jnp.where(above, 0.5 * root * s, 0)
    half_turns = jnp.round(angle / np.pi)
    angle = angle - half_turns * np.pi
    y = jnp.where(below, 0.5 * root * s, 0)
    # Both over cosh λs, as they grow like it.
    real = jnp.where(near, 2 * c_near, jnp.where(above, jnp.cos(angle), 1))
    slope = jnp.where(near, s_near * s, jnp.where(above, jnp.sin(angle), jnp.tanh(y)) / root)
    scale = 1 / jnp.cosh(jnp.clip(y, -350, 350))

    start = tau - jnp.sin(phase0)
    a, b = real + slope * jnp.cos(phase0), slope * start
    turned = jnp.arctan2(b, a) + jnp.sign(tau) * np.pi * half_turns
    return phase0 + 2 * turned, start * (scale / jnp.hypot(a, b)) ** 2


def _series(q: FloatArray, first: int) -> FloatArray:
    """cosh √q, or sinh √q/√q for `first` = 1."""
    total = jnp.ones_like(q)
    for k in range(2 * _TERMS + first, first, -2):
        total = 1 + q / ((k - 1) * k) * total
    return total
