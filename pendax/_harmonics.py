"""The exact Fourier series of the undamped, untorqued motion."""

from functools import partial

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from ._arrays import common, whole, widened
from ._exact import angular_frequency
from ._gap import gap_of, half_angle, hypotenuse
from ._pendulum import Pendulum, require_free
from .special._landen import ladder, log_nome, nome16, nome16_over_p

FloatArray = Float[Array, "..."]


class Harmonics(eqx.Module):
    """θ(t) = Σ amplitude[…, n−1] sin(n ω t), t from a passage of the bottom upwards; in
    rotation θ(t) = ± (ω t + the same).  `frequency` is ω, rad/s; `amplitude` in rad."""

    frequency: Float[Array, "*lanes"]
    amplitude: Float[Array, "*lanes count"]


def harmonics(
    pendulum: Pendulum, v0: ArrayLike, theta0: ArrayLike = 0.0, *, count: int
) -> Harmonics:
    """Frequency and amplitudes of the first `count` harmonics of the motion through (θ0, v0).

    **Arguments:** the undamped, untorqued `pendulum`; `v0`, rad/s, and `theta0`, rad, whose
    shapes broadcast with the scene's; `count` ≥ 1.

    **Returns:** [`Harmonics`][].  In libration a_n = 4 / (n cosh(n π K'/2K)) for odd n, of
    K(m) and K' = K(1 − m), and 0 for even n; on the separatrix, the square wave's 4/n.  In
    rotation 2 / (n cosh(n π K'/K)) for every n, of K(1/m), so that a_1 drops from 4 to below
    2 where v0 passes 2√ε: the series changes there, not the motion.  On the separatrix the
    derivatives are infinite, and come out as NaN.

    **Raises:** `ValueError` for a scene with damping or torque, or a count below 1.

    Through the nome q: 8 q^(n/2) / (n (1 + q^n)) and 4 q^n / (n (1 + q^2n)), √q as k times a
    power series in m, so that amplitudes keep their digits at any swing.
    Within 8 eps of |a| + Σ |x ∂a/∂x|.  Suzuki & Suzuki §2.4; DLMF 22.11.
    """
    require_free(pendulum, "its harmonics")
    count = whole("count", count, 1)
    arrays = common(epsilon=pendulum.epsilon, v0=v0, theta0=theta0)
    return Harmonics(*widened(partial(_harmonics, count))(*arrays))


@partial(jax.jit, static_argnums=0)
def _harmonics(count: int, epsilon: FloatArray, v0: FloatArray, theta0: FloatArray):
    omega = angular_frequency(epsilon, v0, theta0)
    (base, decay, small), rotates = _base(jnp.where(epsilon > 0, epsilon, jnp.nan), v0, theta0)
    n = jnp.arange(1, count + 1, dtype=base.dtype).reshape((1,) * base.ndim + (count,))
    # Near the separatrix a base that is rounded and raised to the n would lose n roundings.
    raised = jnp.where(small, base, 0.5)[..., None] ** n
    power = jnp.where(small[..., None], raised, jnp.exp(-n * decay[..., None]))
    amplitude = jnp.where(rotates, 4, 8)[..., None] * power / (n * (1 + power * power))
    even = (n % 2 == 0) & ~rotates[..., None]
    return omega, jnp.where(even, 0, amplitude)


def _base(epsilon: FloatArray, v0: FloatArray, theta0: FloatArray):
    """√q(m) in libration and q(1/m) in rotation; and which of the two.

    The first as a number where m1 ≥ ½ (or what stands for it in rotation), as the negative
    of its logarithm elsewhere.
    """
    root = jnp.sqrt(epsilon)
    sin, cos, _ = half_angle(theta0)
    m1 = gap_of(4 * epsilon, v0, sin, cos) / (4 * epsilon)
    rotates = m1 < 0
    # 1/k in rotation, and its complement.
    k = hypotenuse(v0 / (2 * root), sin)
    k = jnp.where(rotates, 1 / jnp.where(rotates, k, 1), k)
    m1 = jnp.where(rotates, -m1 * k * k, m1)
    small = m1 >= 0.5
    over_p = nome16_over_p(ladder(jnp.where(small, k * k, 0.25)))
    near_bottom = k * jnp.sqrt(over_p / 16)
    endless = m1 == 0
    length = log_nome(nome16(ladder(jnp.where(small | endless, 0.25, m1))))
    decay = 0.5 * jnp.pi**2 / length
    # At the separatrix 0, and no derivative, rather than 0 for an infinite one.
    decay = jnp.where(endless, jnp.sqrt(m1), decay)
    base = jnp.where(rotates, near_bottom * near_bottom, near_bottom)
    return (base, jnp.where(rotates, 2 * decay, decay), small), rotates
