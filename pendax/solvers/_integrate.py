"""The equation of motion through diffrax, saved exactly at the times that are asked for."""

from typing import Any

import diffrax as dfx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from .._pendulum import Pendulum
from .._results import Result

FloatArray = Float[Array, "..."]


def integrate(
    pendulum: Pendulum,
    ts: Float[Array, " times"],
    v0: Float[Array, ""],
    theta0: Float[Array, ""],
    t0: Float[Array, ""],
    *,
    solver: Any,
    stepsize_controller: Any,
    dt0: Float[Array, ""] | None,
    adjoint: Any,
    rtol: float | None,
    atol: float | None,
    max_steps: int,
) -> tuple[FloatArray, FloatArray, Result, dict[str, Array]]:
    """θ, v, how it ended, and the number of steps; one lane, `ts` monotone away from t0.

    An adaptive controller is clipped to the saved times: between steps diffrax's
    interpolants are less accurate than its steps (Dopri8's by a factor of 252).  Constant
    steps are shortened, all of those between two saved times alike, to end on them.
    """
    if not isinstance(solver, dfx.AbstractSolver):
        raise ValueError(
            f"Argument `solver` must be a solver of diffrax, such as Dopri8(), but got {solver!r}."
        )
    split = isinstance(solver.term_structure, tuple)
    if split and pendulum.beta is not None:
        raise ValueError(
            "Argument `solver` must take one term for a damped scene, such as "
            f"diffrax.Dopri8(), but got {solver}, which takes θ̇(v) and v̇(θ)."
        )
    terms = _split_terms(pendulum) if split else dfx.ODETerm(_field(pendulum))
    if stepsize_controller is None:
        stepsize_controller = _controller(solver, dt0, rtol, atol, v0.dtype)
    options = {
        "terms": terms,
        "solver": solver,
        "adjoint": dfx.RecursiveCheckpointAdjoint() if adjoint is None else adjoint,
        "max_steps": max_steps,
        "throw": False,
    }
    start = (theta0, v0)
    if isinstance(stepsize_controller, dfx.ConstantStepSize):
        return _constant(ts, t0, start, dt0, options)
    if isinstance(stepsize_controller, dfx.PIDController):
        stepsize_controller = dfx.ClipStepSizeController(stepsize_controller, step_ts=ts)
    # The first step is the controller's choice, unless the caller knows better.
    solution = dfx.diffeqsolve(
        t0=t0,
        t1=ts[-1],
        dt0=dt0,
        y0=start,
        saveat=dfx.SaveAt(ts=ts),
        stepsize_controller=stepsize_controller,
        **options,
    )
    assert solution.ys is not None
    theta, v = solution.ys
    return theta, v, _result(solution.result), _stats(solution.stats)


def _controller(solver, dt0, rtol, atol, dtype):
    """Adaptive steps where the solver estimates its error and the caller names no step."""
    adaptive = isinstance(solver, dfx.AbstractAdaptiveSolver)
    if not adaptive and dt0 is None:
        raise ValueError(f"Argument `dt0` must be given with {type(solver).__name__}.")
    if not adaptive or dt0 is not None:
        return dfx.ConstantStepSize()
    rtol = float(jnp.finfo(dtype).eps) ** 0.75 if rtol is None else rtol
    return dfx.PIDController(rtol=rtol, atol=rtol if atol is None else atol)


def _constant(ts, t0, start, dt0, options):
    if dt0 is None:
        raise ValueError("Argument `dt0` must be given with constant steps.")

    def between(carry, t):
        before, state, failed = carry
        steps = jnp.maximum(jnp.ceil(jnp.abs((t - before) / dt0) * (1 - 1e-6)), 1)
        solution = dfx.diffeqsolve(
            t0=before,
            t1=t,
            dt0=(t - before) / steps,
            y0=state,
            saveat=dfx.SaveAt(t1=True),
            stepsize_controller=dfx.ConstantStepSize(),
            **options,
        )
        state = jax.tree.map(lambda x: x[0], solution.ys)
        failed = failed | (solution.result != dfx.RESULTS.successful)
        return (t, state, failed), (state, _stats(solution.stats))

    empty = jnp.zeros((), bool)
    (_, _, failed), ((theta, v), stats) = lax.scan(between, (t0, start, empty), ts)
    result = Result.where(failed, Result.too_many_steps, Result.successful)
    return theta, v, result, jax.tree.map(jnp.sum, stats)


def _force(pendulum: Pendulum, t, theta):
    force = -pendulum.epsilon * jnp.sin(theta)
    if pendulum.tau is None:
        return force
    return force + (pendulum.tau(t) if callable(pendulum.tau) else pendulum.tau)


def _field(pendulum: Pendulum):
    def field(t, state, args):
        del args
        theta, v = state
        force = _force(pendulum, t, theta)
        return v, force if pendulum.beta is None else force - pendulum.beta * v

    return field


def _split_terms(pendulum: Pendulum):
    return (
        dfx.ODETerm(lambda t, v, args: v),
        dfx.ODETerm(lambda t, theta, args: _force(pendulum, t, theta)),
    )


def _result(result) -> Result:
    ok = result == dfx.RESULTS.successful
    many = result == dfx.RESULTS.max_steps_reached
    failed = Result.where(many, Result.too_many_steps, Result.solver_failed)
    return Result.where(ok, Result.successful, failed)


def _stats(stats: dict[str, Any]) -> dict[str, Array]:
    names = {
        "num_steps": "steps",
        "num_accepted_steps": "accepted",
        "num_rejected_steps": "rejected",
    }
    return {ours: jnp.asarray(stats[theirs]) for theirs, ours in names.items()}
