"""ε from the periods of swings of known amplitude."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, ArrayLike, Float

from .._arrays import common, require
from .._exact import period as exact_period
from .._pendulum import Pendulum
from .._results import Result, where
from ._cycles import Cycles
from ._fit import Fit
from ._judgement import goodness


def fit_frequency(
    amplitude: ArrayLike, period: ArrayLike, *, sigma: ArrayLike | None = None
) -> Fit[Pendulum]:
    """ε from cycles, through the exact T(θ_max) = T0 / AGM(1, cos(θ_max/2)).

    **Arguments:**

    - `amplitude`: θ_max of each cycle, rad, |θ_max| < π; its sign does not matter.
    - `period`: T of each cycle, s.
    - `sigma`: standard errors of the periods, s: the weights.  `None`: equal weights.

    One axis of at least two cycles.

    **Returns:** a [`Fit`][] whose `model` is `Pendulum(epsilon)`, ε = (2π/T0)²; T0 is
    the weighted least-squares value, in closed form because T is linear in it.  The
    standard error comes from the scatter of the residuals, so that only the ratios of
    `sigma` matter; `reduced_chi2` is with respect to them, and says whether the exact law holds
    within them.  `runs` is in the order of the amplitudes.

    **Raises:** `ValueError` for fewer than two cycles, |θ_max| ≥ π, a period or `sigma`
    that is not positive.
    """
    require("amplitude", amplitude, "below π in size", lambda x: abs(x) < jnp.pi)
    require("period", period, "positive", lambda x: x > 0)
    require("sigma", sigma, "positive", lambda x: x > 0)
    weighted = sigma is not None
    amplitude, period, sigma = common(
        amplitude=amplitude, period=period, sigma=sigma if weighted else 1.0
    )
    if amplitude.ndim != 1 or amplitude.size < 2:
        raise ValueError(
            "Argument `amplitude` must have one axis of two or more cycles, "
            f"but got shape {amplitude.shape}."
        )
    ratio = exact_period(Pendulum(), 0.0, amplitude) / (2 * jnp.pi)
    weight = 1 / sigma**2
    norm = jnp.sum(weight * ratio * ratio)
    small_angle = jnp.sum(weight * ratio * period) / norm
    residuals = period - small_angle * ratio
    loss = jnp.sum(weight * residuals * residuals)
    error = jnp.sqrt(loss / (amplitude.size - 1) / norm)

    epsilon = (2 * jnp.pi / small_angle) ** 2
    error_epsilon = 2 * epsilon * error / small_angle
    # In the order of the amplitudes: what the law lacks is a function of them.
    order = jnp.argsort(jnp.abs(amplitude))
    found = goodness(
        (residuals / sigma)[None, order], jnp.ones((1, residuals.size), bool), 1, weighted
    )
    return Fit(
        model=Pendulum(epsilon),
        v0=None,
        theta0=None,
        offset=None,
        errors={"epsilon": error_epsilon},
        covariance=error_epsilon[None, None] ** 2,
        residuals=residuals,
        history=loss[None],
        result=where(jnp.isfinite(epsilon), Result.successful, Result.not_a_number),
        reduced_chi2=found.reduced_chi2,
        runs=found.runs,
    )


def period_sigma(cycles: Cycles) -> Float[Array, " cycles"]:
    """Standard errors of the periods with those of the amplitudes carried over by dT/dθ_max.

    In angles of rad; the weights with which measured cycles go into [`fit_frequency`][].
    """
    amplitude, measured = jnp.asarray(cycles.amplitude), jnp.asarray(cycles.period)

    def ratio(amplitude):
        return exact_period(Pendulum(), 0.0, amplitude)

    slope = measured * jax.vmap(jax.grad(ratio))(amplitude) / ratio(amplitude)
    return jnp.hypot(jnp.asarray(cycles.period_error), slope * cycles.amplitude_error)
