"""Sums of squares and other losses brought to a minimum, with the loss after every step."""

from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

Vector = Float[Array, " parameters"]


class Minimum(NamedTuple):
    """Where it ended, and the loss after each step, the last one repeated."""

    x: Vector
    history: Float[Array, " steps"]


def least_squares(residuals: Callable[[Vector], Array], x: Vector, steps: int) -> Minimum:
    """Half the sum of squares by optimistix's Levenberg–Marquardt, `steps` at most.

    It is driven step by step, for the history, and because by itself it ends on accepted steps
    only: at the rounding of the loss none is accepted any more, and what it proposes shrinks to
    nothing.
    """
    import optimistix as optx

    from ._thin_qr import ThinQR

    # Half as many digits again as the loss can show.
    small = float(jnp.finfo(x.dtype).eps) ** 0.75
    solver = optx.LevenbergMarquardt(rtol=small, atol=small, linear_solver=ThinQR())

    def function(x, _):
        return residuals(x), None

    rest = None, {}, frozenset()  # arguments, options and tags: there are none
    arguments, options, tags = rest
    shape = jax.eval_shape(residuals, x)
    state = solver.init(function, x, arguments, options, shape, None, tags)
    moving, fixed = eqx.partition(state, eqx.is_array)

    def unfinished(at):
        _, _, _, count, done = at
        return ~done & (count < steps)

    def step(at):
        x, moving, history, count, _ = at
        state = eqx.combine(fixed, moving)
        proposed = state.y_eval
        x, state, _ = solver.step(function, x, arguments, options, state, tags)
        done, _ = solver.terminate(function, x, arguments, options, state, tags)
        rejected = state.num_steps_since_acceptance > 0
        nowhere = jnp.all(jnp.abs(proposed - x) <= small * (1 + jnp.abs(x)))
        loss = 0.5 * jnp.sum(state.f_info.residual**2)
        history = jnp.where(jnp.arange(steps) < count, history, loss)
        return x, eqx.filter(state, eqx.is_array), history, count + 1, done | (rejected & nowhere)

    start = jnp.zeros(steps, x.dtype), jnp.zeros((), jnp.int32), jnp.zeros((), bool)
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
        change, state = optimiser.update(
            slope, state, x, value=value, grad=slope, value_fn=loss
        )
        return (optax.apply_updates(x, change), state), value

    (x, _), history = lax.scan(step, (x, optimiser.init(x)), length=steps)
    return Minimum(x, history)
