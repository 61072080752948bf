"""Expansions for small angles, each with its error against the exact value."""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import ArrayLike

from ._arrays import common
from ._exact import amplitude, frequency
from ._harmonics import harmonics
from ._pendulum import Pendulum, require_free
from .special._series import Approximation, ellipk_series


def period_series(amplitude: ArrayLike, terms: int) -> Approximation:
    """Partial sums of T/T0 = Σ ((2n)!/(2²ⁿ n!²))² sin²ⁿ(θ_max/2), T0 = 2π/√ε.

    **Arguments:** `amplitude` θ_max, rad, any shape, |θ_max| ≤ π; `terms` ≥ 1.

    **Returns:** an [`Approximation`][pendax.special.Approximation]: `value` and relative
    `error` of the sums of 1 … `terms` terms on the last axis.  NaN beyond π.

    **Raises:** `ValueError` for terms below 1.

    The Spanish source's §4; right for any amplitude, but slow: for 1e-6 it takes 3 terms at
    15°, 16 at 90°, 1,239 at 170°, where [`period`][pendax.period] takes four AGM steps.
    """
    (amplitude,) = common(amplitude=amplitude)
    sin = jnp.sin(0.5 * jnp.where(jnp.abs(amplitude) <= jnp.pi, amplitude, jnp.nan))
    sums, error = ellipk_series(sin * sin, terms)
    return Approximation(sums * (2 / jnp.pi), error)


class SmallAngle(NamedTuple):
    """Expansions for small swings, each a `value` with its `error`, value/exact − 1.

    With α1, α3, rad, the amplitudes of the first and third harmonics (those of
    [`harmonics`][pendax.harmonics]) and θ_max that of the whole swing:

    - `isochronous`: T ≈ T0 = 2π/√ε, s, the period of all small swings;
    - `period`: T ≈ T0 (1 + θ_max²/16), s;
    - `frequency`: ω ≈ √ε √(1 − α1²/8), rad/s;
    - `amplitude`: θ_max ≈ v0/√ε, rad;
    - `third`: α3 ≈ α1³/192, rad.
    """

    isochronous: Approximation
    period: Approximation
    frequency: Approximation
    amplitude: Approximation
    third: Approximation


def small_angle(pendulum: Pendulum, v0: ArrayLike, theta0: ArrayLike = 0.0) -> SmallAngle:
    """The expansion of a small swing through (θ0, v0) to its first non-linear terms.

    **Arguments:** as for [`frequency`][pendax.frequency].

    **Returns:** a [`SmallAngle`][].  α1 and θ_max are taken as they are; v0 in the
    amplitude's is the speed at the bottom.  NaN where the pendulum does not swing, and for
    ω beyond α1 = √8, where its square is negative.

    **Raises:** `ValueError` for a scene with damping or torque.

    Suzuki & Suzuki §1.1, (5) and (6), and §2.8 (whose line is v0/√ε, not 2 v0/√ε).  α3 is
    positive in the sine series of a start from the bottom, negative in the source's cosines.
    """
    require_free(pendulum, "its expansion for small angles")
    top, omega = amplitude(pendulum, v0, theta0), frequency(pendulum, v0, theta0)
    top, omega, epsilon = common(top=top, omega=omega, epsilon=pendulum.epsilon)
    swings = jnp.isfinite(top)
    first, _, third = jnp.moveaxis(harmonics(pendulum, v0, theta0, count=3).amplitude, -1, 0)
    root = jnp.sqrt(epsilon)

    def beside(value, exact):
        error = value / jnp.where(exact == 0, 1, exact) - 1
        return Approximation(
            jnp.where(swings, value, jnp.nan),
            jnp.where(swings, jnp.where(exact == 0, 0 * value, error), jnp.nan),
        )

    period0, period = 2 * jnp.pi / root, 2 * jnp.pi / omega
    return SmallAngle(
        isochronous=beside(period0, period),
        period=beside(period0 * (1 + top * top / 16), period),
        frequency=beside(root * jnp.sqrt(1 - first * first / 8), omega),
        amplitude=beside(2 * jnp.sin(0.5 * jnp.where(swings, top, 0)), top),
        third=beside(first * first * first / 192, third),
    )
