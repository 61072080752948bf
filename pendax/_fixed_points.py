"""Where the pendulum can rest, and whether it would stay."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Complex, Float

from ._arrays import common
from ._pendulum import Pendulum

FloatArray = Float[Array, "..."]


class FixedPointKind(eqx.Enumeration):
    """What a small push does to a pendulum at rest; `==` compares lane by lane."""

    spiral = "Spiral: motions die out, turning around it."
    node = "Node: motions die out without turning (β ≥ 2 √(ε cos θ))."
    centre = "Centre: motions go round it for ever (no damping)."
    saddle = "Saddle: one direction leads in, one out."
    saddle_node = "Saddle and node in one: |τ| = ε."
    none = "There is none: |τ| > ε, or a parameter is outside its domain."


class FixedPoints(eqx.Module):
    """The two of each turn: `[…, 0]` the lower, `[…, 1]` the upper equilibrium.

    `angle`, rad, where ε sin θ = τ; others are whole turns away.  `eigenvalues[…, i, :]`,
    1/s, of the motion linearised there.
    """

    angle: Float[Array, "*lanes 2"]
    kind: FixedPointKind
    eigenvalues: Complex[Array, "*lanes 2 2"]


def fixed_points(pendulum: Pendulum) -> FixedPoints:
    """The equilibria of a pendulum under a constant torque, their kinds and eigenvalues.

    **Arguments:** `pendulum`, its leaves of shapes that broadcast; τ no function of time.

    **Returns:** [`FixedPoints`][]: θ = arcsin(τ/ε) and π − arcsin(τ/ε), with the roots of
    λ² + βλ ± κ = 0, κ = √(ε² − τ²) = ε cos θ.  NaN and kind *none* for |τ| > ε; at |τ| = ε
    the two are one, and derivatives are infinite.

    **Raises:** `ValueError` for a torque that is a function of time, and for dry friction.

    The small root is κ over the large one: −β/2 + √(β²/4 − κ) has no digits in strong
    damping.  Suzuki & Suzuki §7.1.
    """
    if pendulum.dry is not None:
        raise ValueError(
            "Argument `pendulum` must be without dry friction, which lets it rest anywhere with "
            "|ε sin θ − τ| ≤ c; where a motion comes to rest is `settle`."
        )
    if callable(pendulum.tau):
        raise ValueError("Argument `pendulum` must have a constant torque, but got a function.")
    beta = 0.0 if pendulum.beta is None else pendulum.beta
    tau = 0.0 if pendulum.tau is None else pendulum.tau
    return _fixed_points(*common(epsilon=pendulum.epsilon, beta=beta, tau=tau))


@jax.jit
def _fixed_points(epsilon: FloatArray, beta: FloatArray, tau: FloatArray) -> FixedPoints:
    there = (jnp.abs(tau) <= epsilon) & (epsilon > 0) & (beta >= 0)
    inside = jnp.where(there, 1, jnp.nan)  # as a factor, for the derivatives
    kappa = _root(inside * (epsilon - tau)) * _root(inside * (epsilon + tau))
    lower = jnp.arctan2(tau, kappa)
    angle = jnp.stack([lower, jnp.pi - lower], -1)

    half = 0.5 * beta
    disc = half * half - kappa
    turning = _root(jnp.maximum(-disc, 0))
    far = -(half + _root(jnp.maximum(disc, 0)))
    near = kappa / jnp.where(far == 0, -1, far)
    turns = disc < 0
    pair = (
        jax.lax.complex(jnp.where(turns, -half, far), turning),
        jax.lax.complex(jnp.where(turns, -half, near), -turning),
    )
    away = -(half + _root(half * half + kappa))
    out = -kappa / jnp.where(away == 0, -1, away)
    zero = jnp.zeros_like(half)
    saddle = jax.lax.complex(away, zero), jax.lax.complex(out, zero)
    eigenvalues = jnp.stack([jnp.stack(pair, -1), jnp.stack(saddle, -1)], -2)

    kind = _kind
    for _ in range(half.ndim + 1):
        kind = jax.vmap(kind)
    upper = jnp.stack([jnp.zeros_like(there), jnp.ones_like(there)], -1)
    conditions = jnp.broadcast_arrays(
        upper, *(x[..., None] for x in (there, kappa == 0, turns, beta == 0))
    )
    return FixedPoints(angle, kind(*conditions), eigenvalues)


def _kind(upper, there, merged, turns, undamped):
    either = FixedPointKind.where
    around = either(undamped, FixedPointKind.centre, FixedPointKind.spiral)
    lower = either(turns, around, FixedPointKind.node)
    kind = either(upper, FixedPointKind.saddle, lower)
    kind = either(merged, FixedPointKind.saddle_node, kind)
    return either(there, kind, FixedPointKind.none)


def _root(x: FloatArray) -> FloatArray:
    """√x, of derivative 0 at 0."""
    return jnp.where(x == 0, 0, jnp.sqrt(jnp.where(x == 0, 1, x)))
