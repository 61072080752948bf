"""The equation of motion through diffrax, saved exactly at the times that are asked for."""

from dataclasses import replace
from typing import Any

import diffrax as dfx
import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from .._pendulum import Pendulum
from .._results import Result
from ._differentiable import differentiable

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
    if stepsize_controller is None:
        stepsize_controller = _controller(solver, dt0, rtol, atol, v0.dtype)
    constant = isinstance(stepsize_controller, dfx.ConstantStepSize)
    if constant and dt0 is None:
        raise ValueError("Argument `dt0` must be given with constant steps.")
    options = {"solver": solver, "max_steps": max_steps, "throw": False}
    options["adjoint"] = dfx.RecursiveCheckpointAdjoint() if adjoint is None else adjoint

    def solve(terms, start, ts, dt0):
        if constant:
            return _constant(terms, start, ts, dt0, options)
        return _adaptive(terms, start, ts, stepsize_controller, dt0, options)

    if split:
        (theta, v), said = solve(_split_terms(pendulum, t0), (theta0, v0), ts - t0, dt0)
    else:
        leaves, rest = eqx.partition(pendulum, eqx.is_array)
        leaves, treedef = jax.tree.flatten(leaves)

        def field(t, y, p):
            scene = eqx.combine(jax.tree.unflatten(treedef, p[3 : 3 + len(leaves)]), rest)
            theta, v = y
            force = _force(scene, p[2] + t, theta)
            return jnp.stack([v, force if scene.beta is None else force - scene.beta * v])

        def start(p):
            return jnp.stack(p[:2])

        def solve_vector(field, start, p, ts):
            y0, step = start(p), None if dt0 is None else lax.stop_gradient(p[-1])
            if y0.size > 2:  # with its derivatives
                return solve(dfx.ODETerm(lambda t, y, args: field(t, y, p)), y0, ts, step)
            # θ and v apart: over many lanes that is twice as fast as arrays of two.
            terms = dfx.ODETerm(lambda t, y, args: tuple(field(t, jnp.stack(y), p)))
            ys, said = solve(terms, tuple(y0), ts, step)
            return jnp.stack(ys).T, said

        # A step that is traced has to go through the same door as all else that is.
        p = [theta0, v0, t0, *leaves, *([] if dt0 is None else [dt0])]
        wrap = differentiable if adjoint is None else _as_it_is
        ys, said = wrap(solve_vector, field, start, p, ts - t0)
        theta, v = ys[:, 0], ys[:, 1]
    return theta, v, _result(said.pop("result")), said


def _as_it_is(solve, field, start, p, ts):
    return solve(field, start, p, ts)


def _adaptive(terms, start, ts, controller, dt0, options):
    if isinstance(controller, dfx.PIDController):
        times = lax.stop_gradient(ts)
        if controller.dtmin is None:
            # Without a smallest step NaN would be retried until `max_steps`.
            smallest = jnp.finfo(ts.dtype).eps ** 1.5 * jnp.max(jnp.abs(times))
            controller = replace(controller, dtmin=smallest, force_dtmin=False)
        if len(ts) > 1:
            controller = dfx.ClipStepSizeController(controller, step_ts=times)
    # Of a single time there is no order to check, which takes a callback to Python, and programs
    # with callbacks are in no persistent cache.
    saveat = dfx.SaveAt(t1=True) if len(ts) == 1 else dfx.SaveAt(ts=ts)
    solution = dfx.diffeqsolve(
        terms,
        t0=jnp.zeros_like(ts[0]),
        t1=ts[-1],
        dt0=dt0,  # None: the controller's choice
        y0=start,
        saveat=saveat,
        stepsize_controller=controller,
        **options,
    )
    # A last state that is not the one at t1 stands there as well.
    arrived = (len(ts) > 1) | (solution.result == dfx.RESULTS.successful)
    return jax.tree.map(lambda y: jnp.where(arrived, y, jnp.inf), solution.ys), _said(solution)


def _constant(terms, start, ts, dt0, options):
    """From one saved time to the next."""

    def between(carry, t):
        before, state = carry
        steps = jnp.maximum(jnp.ceil(jnp.abs((t - before) / dt0) * (1 - 1e-6)), 1)
        solution = dfx.diffeqsolve(
            terms,
            t0=before,
            t1=t,
            dt0=(t - before) / steps,
            y0=state,
            saveat=dfx.SaveAt(t1=True),
            stepsize_controller=dfx.ConstantStepSize(),
            **options,
        )
        state = jax.tree.map(lambda x: x[0], solution.ys)
        return (t, state), (state, _said(solution))

    _, (ys, said) = lax.scan(between, (jnp.zeros_like(ts[0]), start), ts)
    result = jnp.max(said.pop("result"))
    return ys, {"result": result} | jax.tree.map(jnp.sum, said)


def _controller(solver, dt0, rtol, atol, dtype):
    """Adaptive steps where the solver estimates its error and the caller names no step."""
    adaptive = isinstance(solver, dfx.AbstractAdaptiveSolver)
    if not adaptive and dt0 is None:
        raise ValueError(f"Argument `dt0` must be given with {type(solver).__name__}.")
    if not adaptive or dt0 is not None:
        return dfx.ConstantStepSize()
    rtol = float(jnp.finfo(dtype).eps) ** 0.75 if rtol is None else rtol
    return dfx.PIDController(rtol=rtol, atol=rtol if atol is None else atol)


def _force(pendulum: Pendulum, t, theta):
    force = -pendulum.epsilon * jnp.sin(theta)
    if pendulum.tau is None:
        return force
    return force + (pendulum.tau(t) if callable(pendulum.tau) else pendulum.tau)


def _split_terms(pendulum: Pendulum, t0):
    return (
        dfx.ODETerm(lambda t, v, args: v),
        dfx.ODETerm(lambda t, theta, args: _force(pendulum, t0 + t, theta)),
    )


_SUCCESS, _TOO_MANY, _FAILED = 0, 1, 2


def _said(solution) -> dict[str, Array]:
    """How it ended, as a number, and the counts of steps."""
    many = solution.result == dfx.RESULTS.max_steps_reached
    how = jnp.where(many, _TOO_MANY, _FAILED)
    how = jnp.where(solution.result == dfx.RESULTS.successful, _SUCCESS, how)
    names = {
        "num_steps": "steps",
        "num_accepted_steps": "accepted",
        "num_rejected_steps": "rejected",
    }
    counts = {ours: jnp.asarray(solution.stats[theirs]) for theirs, ours in names.items()}
    return {"result": how} | counts


def _result(how: Array) -> Result:
    failed = Result.where(how == _TOO_MANY, Result.too_many_steps, Result.solver_failed)
    return Result.where(how == _SUCCESS, Result.successful, failed)
