"""The running state's mean velocity where collocation has nothing left to find, ε = 1."""

import jax.numpy as jnp
from jaxtyping import Array, Float

Scalar = Float[Array, ""]


def far_above(beta: Scalar, tau: Scalar) -> Scalar:
    """V = τ/β and its ripple, w = V + a cos(θ + …) with the mean V and a² = 1/(V² + β²)."""
    return tau / beta * (1 - 0.5 * ripple(beta, tau))


def ripple(beta: Scalar, tau: Scalar) -> Scalar:
    """a²/V², whose square is what `far_above` leaves out."""
    # Nothing is left of it long before its squares would overflow.
    v, beta = jnp.clip(tau / beta, 1e-8, 1e8), jnp.clip(beta, 1e-8, 1e8)
    return (1 / (v * jnp.hypot(v, beta))) ** 2


def overdamped(beta: Scalar, tau: Scalar) -> Scalar:
    """For β⁴ ≫ ε²: θ̇ = (τ − sin θ)/β and corrections, whose order 1/β² adds up to nothing."""
    root = jnp.sqrt((tau - 1) * (tau + 1))
    return root / beta * (1 + root / (tau + root) / beta / beta / beta / beta)
