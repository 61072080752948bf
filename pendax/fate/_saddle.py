"""The upper equilibria, which part the wells, and the motion that ends on one."""

import math
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

Scalar = Float[Array, ""]

_TERMS = 14  # of W; what is left out is below 1e-13 where it is used


class Saddle(NamedTuple):
    """The upper equilibria of one torque: π − α + 2πn ends well n."""

    alpha: Scalar
    kappa: Scalar
    tau: Scalar


def saddle(tau: Scalar) -> Saddle:
    kappa = jnp.sqrt(jnp.maximum((1 - tau) * (1 + tau), 0))
    return Saddle(jnp.arctan2(tau, kappa), kappa, tau)


def well_of(at: Saddle, theta: Scalar) -> Scalar:
    """Which well an angle is in, a whole number."""
    near = jnp.floor((theta + (jnp.pi + at.alpha)) / (2 * jnp.pi))
    # Beside a saddle by what `before` says, which has more digits.
    low = jnp.where(before(at, theta, near - 1) > 0, near - 1, near)
    return jnp.where(before(at, theta, near) <= 0, near + 1, low)


def before(at: Saddle, theta: Scalar, well: Scalar) -> Scalar:
    """How far before the end of that well; exact beside the top where α = 0 and n = 0 or −1."""
    odd = 2 * well + 1
    high = np.asarray(np.pi, theta.dtype)
    low = (np.pi - float(high)) + 1.2246467991473532e-16
    return ((odd * high - theta) - at.alpha) + odd * low


def stable(at: Saddle, beta: Scalar) -> list[Scalar]:
    """W/y, W W' = β W + κ sin y − τ (1 − cos y), in powers of y."""
    steepest = 0.5 * (beta + jnp.sqrt(beta * beta + 4 * at.kappa))
    w = [steepest]
    for k in range(2, _TERMS + 1):
        force = (at.tau if k % 2 == 0 else at.kappa) * ((-1) ** (k // 2) / math.factorial(k))
        known = sum((w[i - 1] * w[k - i] for i in range(2, k)), jnp.zeros_like(beta))
        w.append((force - 0.5 * (k + 1) * known) / ((k + 1) * steepest - beta))
    return w
