"""How a computation ended, lane by lane."""

import equinox as eqx
import jax
from jaxtyping import Array, Bool

from ._arrays import concrete


class Result(eqx.Enumeration):
    """`==` compares lane by lane; printing one shows its message."""

    successful = "Successful."
    not_a_number = "An argument is NaN or infinite, or a parameter is outside its domain."
    too_few_points = "A fit needs two or more points on each side."
    not_converged = "The iteration did not converge."
    too_many_steps = "The solver took `max_steps` steps and was not at the last time yet."
    too_stiff = "The solver took `max_steps` steps, held small by the damping alone."
    unsettled = "The motion did not come to an end: no damping, a start on a saddle, `max_steps`."
    misfit = "It converged where the model does not describe the data: another start might."
    solver_failed = "The solver gave up: its step became too small, or a number infinite."


def where(condition: Bool[Array, "*lanes"], then: Result, otherwise: Result) -> Result:
    """`Result.where` for a condition of any shape."""
    select = Result.where
    for _ in range(condition.ndim):
        select = jax.vmap(select, in_axes=(0, None, None))
    return select(condition, then, otherwise)


def raise_if(x: Array, failed: Bool[Array, "..."], message: str) -> Array:
    """`eqx.error_if`: a program of its own, which no cache keeps, unless all is seen to be well."""
    seen = concrete(failed)
    return x if seen is not None and not seen.any() else eqx.error_if(x, failed, message)
