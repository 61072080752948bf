"""How well fitted parameters are known, and how well the model describes the data."""

from collections.abc import Callable
from typing import NamedTuple

import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from .._results import Result, where
from ._thin_qr import reduced, substituted

LEFT = 1e-3  # of a standard error, that a converged fit may be off (Bates & Watts 1981)
AT_ZERO = 1e-2  # of its standard error, that a positive parameter is nothing
KEPT = -4.0  # standard deviations of the run test: not by chance
GROSS = 0.1  # of the data's own spread


class Judgement(NamedTuple):
    errors: Float[Array, " parameters"]
    covariance: Float[Array, "parameters parameters"]
    converged: Bool[Array, ""]


def judged(
    residuals: Float[Array, " samples"],
    jacobian: Float[Array, "samples parameters"],
    count: Float[Array, ""],
    values: Float[Array, " parameters"],
    positive: Bool[Array, " parameters"],
    loss: Callable | None,
    variances: Float[Array, " samples"] | None = None,
) -> Judgement:
    """Of weighted residuals, 0 where there is no sample, and their slopes in the parameters.

    The covariance is s² (JᵀJ)⁻¹, of a loss ρ other than r²/2 with s² = ⟨ρ'²⟩/⟨ρ''⟩² (Huber 1973).
    What is left to go is the Gauss–Newton step: a small part of the standard errors, or of the
    values themselves where there is no noise.  What is nothing and has to be `positive` can't go
    below: the others have to be where they belong without it.

    `variances`: of residuals that don't all scatter alike.
    """
    size = jacobian.shape[1]
    freedom = count - size
    pull, stiffness, bent = residuals, jnp.ones_like(count), jnp.zeros_like(count)
    if loss is not None:
        there = jnp.any(jacobian != 0, axis=1)
        pull = jax.vmap(jax.grad(loss))(residuals)
        curvature = jax.vmap(jax.grad(jax.grad(loss)))(residuals)
        stiffness = jnp.sum(jnp.where(there, curvature, 0)) / count
        bent = jnp.sum(there & (curvature < 0)).astype(count.dtype) / count
    # Units apart, that R be as well conditioned as it can.
    norms = jnp.sqrt(jnp.sum(jacobian**2, axis=0))
    found = reduced(jacobian / norms[None, :], pull)
    inverse = substituted(found.r, jnp.eye(size, dtype=norms.dtype)) / norms[:, None]
    scatter = jnp.sum(pull**2) / freedom / stiffness**2
    covariance = scatter * (inverse @ inverse.T)
    if variances is not None:
        moves = inverse @ (inverse.T @ jacobian.T)
        covariance = (moves * variances[None, :]) @ moves.T
    errors = jnp.sqrt(jnp.diagonal(covariance))
    left = inverse @ found.y
    ends = positive & (values < AT_ZERO * errors) & (left > 0)
    free = jnp.where(ends[None, :], 0, jacobian / norms[None, :])
    rows = jnp.concatenate([free, jnp.diag(ends.astype(free.dtype))])
    left = substituted(*reduced(rows, jnp.pad(pull, (0, size)))) / norms
    digits = float(jnp.finfo(values.dtype).eps) ** 0.6
    near = jnp.abs(left) <= stiffness * (LEFT * errors + digits * jnp.abs(values))
    # Of a loss that is bent downwards at most samples nothing is known.
    firm = (stiffness > 0) & (bent <= 0.5)
    known = jnp.where(firm, 1, jnp.nan)
    return Judgement(errors * known, covariance * known, jnp.all(near | ends) & firm)


class Goodness(NamedTuple):
    reduced_chi2: Float[Array, ""]
    runs: Float[Array, ""]


def goodness(
    residuals: Float[Array, "series samples"],
    there: Bool[Array, "series samples"],
    parameters: int,
    weighted: bool,
) -> Goodness:
    """Reduced χ² and run test of weighted residuals, each series in the order of its times.

    Unless `weighted` by standard errors, χ² is that relative to successive differences
    (von Neumann 1941).
    """
    # Samples that are there, one after the other.
    order = jnp.argsort(~there, axis=1, stable=True)
    r, there = (jnp.take_along_axis(x, order, 1) for x in (residuals, there))
    pairs = there[:, 1:] & there[:, :-1]

    positive = jnp.sum(there & (r > 0), 1).astype(r.dtype)
    n = jnp.sum(there, 1).astype(r.dtype)
    product = 2 * positive * (n - positive)
    expected = product / n + 1
    variance = product * (product - n) / (n * n * jnp.maximum(n - 1, 1))
    changes = jnp.sum(pairs & ((r[:, 1:] > 0) != (r[:, :-1] > 0)), 1) + 1
    runs = jnp.sum(changes.astype(r.dtype) - expected) / jnp.sqrt(jnp.sum(variance))
    runs = jnp.where(jnp.sum(variance) > 0, runs, -jnp.sqrt(jnp.sum(n)))  # of one sign

    mean_square = jnp.sum(jnp.where(there, r * r, 0)) / (jnp.sum(n) - parameters)
    if weighted:
        return Goodness(mean_square, runs)
    steps = jnp.sum(jnp.where(pairs, (r[:, 1:] - r[:, :-1]) ** 2, 0))
    noise = steps / 2 / jnp.sum(pairs).astype(r.dtype)
    return Goodness(jnp.where(noise > 0, mean_square / noise, 1), runs)


def ended(
    judgement: Judgement,
    loss: Float[Array, ""],
    runs: Float[Array, ""],
    unexplained: Float[Array, ""],
) -> Result:
    """`unexplained`: the residuals' rms over the data's own spread."""
    result = where(judgement.converged, Result.successful, Result.not_converged)
    gross = judgement.converged & (unexplained > GROSS) & (runs < KEPT)
    result = Result.where(gross, Result.misfit, result)
    return Result.where(jnp.isfinite(loss), result, Result.not_a_number)
