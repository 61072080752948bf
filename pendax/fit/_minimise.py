"""Sums of squares and other losses brought to a minimum, with the loss after every step."""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float, Int

Vector = Float[Array, " parameters"]

ENOUGH = 1e-10  # of the loss, that a step may promise at most where it is over: 1e-4 of an error


class Minimum(NamedTuple):
    """Where it ended, and the loss after each step, the last one repeated."""

    x: Vector
    history: Float[Array, " steps"]


def least_squares(
    residuals: Callable[[Vector], Array], x: Vector, steps: int, most: Int[Array, ""]
) -> Minimum:
    """Half the sum of squares by optimistix's Levenberg–Marquardt, `most` of `steps` at most.

    It is driven step by step, for the history, and for its end.  By itself it ends on accepted
    steps that are nothing, where there is noise many steps after they have stopped to matter,
    and at the rounding of the loss never: none is accepted there any more.
    """
    import optimistix as optx

    from ._linear_solver import ThinQR

    # Half as many digits again as the loss can show.
    small = float(jnp.finfo(x.dtype).eps) ** 0.75
    solver = optx.LevenbergMarquardt(rtol=small, atol=small, linear_solver=ThinQR())
    # Of noisy data no step fulfils its prediction to the default's 99 %: the damping would stay.
    solver = eqx.tree_at(lambda s: s.search, solver, optx.ClassicalTrustRegion(high_cutoff=0.5))

    def function(x, _):
        return residuals(x), None

    rest = None, {}, frozenset()  # arguments, options and tags: there are none
    arguments, options, tags = rest
    shape = jax.eval_shape(residuals, x)
    state = solver.init(function, x, arguments, options, shape, None, tags)
    moving, fixed = eqx.partition(state, eqx.is_array)

    def unfinished(at):
        _, _, _, count, done = at
        return ~done & (count < most)

    def step(at):
        x, moving, history, count, _ = at
        state = eqx.combine(fixed, moving)
        tried = state.y_eval
        x, state, _ = solver.step(function, x, arguments, options, state, tags)
        done, _ = solver.terminate(function, x, arguments, options, state, tags)
        rejected = state.num_steps_since_acceptance > 0
        nowhere = rejected & jnp.all(jnp.abs(tried - x) <= small * (1 + jnp.abs(x)))
        here = state.f_info.residual
        there = here + state.f_info.jac.mv(state.y_eval - x)
        loss, promised = 0.5 * jnp.sum(here**2), 0.5 * jnp.sum(there**2)
        history = jnp.where(jnp.arange(steps, dtype=count.dtype) < count, history, loss)
        done = done | nowhere | (loss - promised < ENOUGH * loss)
        return x, eqx.filter(state, eqx.is_array), history, count + 1, done

    start = jnp.zeros(steps, x.dtype), jnp.zeros_like(most), jnp.zeros((), bool)
    x, _, history, _, _ = lax.while_loop(unfinished, step, (x, moving, *start))
    return Minimum(x, history)


def by_optimiser(
    loss: Callable[[Vector], Float[Array, ""]], x: Vector, optimiser: Any, steps: int
) -> Minimum:
    """`steps` of any of optax's optimisers."""
    import optax

    optimiser = optax.with_extra_args_support(optimiser)

    def step(at, _):
        x, state = at
        value, slope = jax.value_and_grad(loss)(x)
        # Not all of optax's mind their dtypes.
        with jax.numpy_dtype_promotion("standard"), jax.numpy_rank_promotion("allow"):
            change, state = optimiser.update(
                slope, state, x, value=value, grad=slope, value_fn=loss
            )
        return (x + change, state), value

    (x, _), history = lax.scan(step, (x, optimiser.init(x)), length=steps)
    return Minimum(x, history)
