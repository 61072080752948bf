"""The first-order junction at a constant current, φ' = τ − sin φ: what is known in closed form."""

import jax.numpy as jnp
import numpy as np
from jax import lax
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
    φ0, with C = cosh λs, S = sinh(λs)/2λ, 4λ² = 1 − τ²; φ' = (τ − sin φ0)/|ξ|².  With a voltage
    ξ turns about once in every 2π/√(τ² − 1): half turns are counted, and only what is left goes to
    arctan2.
    """
    square = (1 - tau) * (1 + tau)
    q = square * (0.5 * s) ** 2  # (λs)²
    near, relaxing = jnp.abs(q) < 0.1, q > 0
    above, below = ~near & ~relaxing, ~near & relaxing

    # Each with numbers of its own where it is not asked.
    x = jnp.where(near, q, 0)
    root = jnp.sqrt(jnp.where(square < 0, -square, 1))  # of the junction alone, not of the time
    angle = jnp.where(above, 0.5 * root * s, 0)
    half_turns = jnp.round(angle / np.pi)
    angle = angle - half_turns * np.pi
    real = jnp.where(near, _series(x, 0), jnp.cos(angle))
    slope = jnp.where(near, 0.5 * _series(x, 1) * s, jnp.sin(angle) / root)
    start = tau - jnp.sin(phase0)
    a, b = real + slope * jnp.cos(phase0), slope * start
    turned = jnp.arctan2(b, a) + jnp.sign(tau) * np.pi * half_turns
    phase, rate = phase0 + 2 * turned, start / (a * a + b * b)

    settling = _settling(jnp.where(square > 0, tau, 0), jnp.where(below, s, 1), phase0)
    return tuple(jnp.where(below, x, y) for x, y in zip(settling, (phase, rate), strict=True))


def _settling(tau: FloatArray, s: FloatArray, phase0: FloatArray):
    """The same without a voltage, for all times: φ leaves π − α, and comes to α = arcsin τ.

    With p, q = (φ0 ± α)/2 and e = exp(−√(1 − τ²) |s|), e^{iφ/2} is along

        cos p e^{iα/2} + e i sin q e^{−iα/2},

    or, for s < 0, with e at the other term: no difference of what is nearly alike.
    """
    alpha, root = jnp.arcsin(tau), jnp.sqrt((1 - tau) * (1 + tau))
    p, q = 0.5 * (phase0 + alpha), 0.5 * (phase0 - alpha)
    # Smaller ones make no difference, and their squares would not be numbers.
    longest = -0.4 * float(np.log(jnp.finfo(s.dtype).tiny))
    e = jnp.exp(-jnp.minimum(root * jnp.abs(s), longest))
    stable = jnp.cos(p) * jnp.where(s > 0, 1, e)
    unstable = jnp.sin(q) * jnp.where(s > 0, e, 1)
    c, d = jnp.cos(0.5 * alpha), jnp.sin(0.5 * alpha)
    real, imaginary = stable * c + unstable * d, stable * d + unstable * c
    phase = 2 * jnp.arctan2(imaginary, real)
    # Up to whole turns of e^{iφ/2}, of which φ0 says how many.
    turned = jnp.arctan2(
        imaginary * jnp.cos(0.5 * phase0) - real * jnp.sin(0.5 * phase0),
        real * jnp.cos(0.5 * phase0) + imaginary * jnp.sin(0.5 * phase0),
    )
    turns = jnp.round((phase0 + 2 * turned - phase) / (4 * np.pi))
    rate = -2 * jnp.cos(p) * jnp.sin(q) * root * root * (e / (real * real + imaginary * imaginary))
    return phase + 4 * np.pi * lax.stop_gradient(turns), rate


def _series(q: FloatArray, first: int) -> FloatArray:
    """cosh √q, or sinh √q/√q for `first` = 1."""
    total = jnp.ones_like(q)
    for k in range(2 * _TERMS + first, first, -2):
        total = 1 + q / ((k - 1) * k) * total
    return total
