"""Which method follows a scene that has no closed form, and how it is called: one lane."""

from abc import abstractmethod
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax.core import Tracer
from jaxtyping import Array

from ._pendulum import Pendulum
from ._results import Result
from ._torque import SampledTorque
from .taylor import (
    Analytic,
    Scene,
    State,
    analytic,
    averaged,
    budget,
    is_overdamped,
    marched,
    since,
    with_derivatives,
)


class Method(eqx.Module):
    """(scene, times, v0, θ0, t0) of one lane -> θ, v, how it ended, and counts of steps."""

    name: eqx.AbstractVar[str]

    @abstractmethod
    def __call__(self, scene: Pendulum, times, v0, theta0, t0) -> Any: ...


class TaylorSeries(Method):
    """For terms that don't depend on time, or as samples do, or an entire function."""

    rtol: float = eqx.field(static=True)
    atol: float = eqx.field(static=True)
    max_steps: Array | None
    stiff: bool = eqx.field(static=True)
    moving_times: bool = eqx.field(static=True)
    moving_start: bool = eqx.field(static=True, default=False)
    name: str = eqx.field(static=True, default="Taylor series")

    def __call__(self, scene: Pendulum, times, v0, theta0, t0) -> Any:
        tau, clock = scene.tau, callable(scene.tau)
        if callable(tau) and not isinstance(tau, SampledTorque):
            tau = analytic(tau, times.dtype)
        terms = Scene(scene.epsilon, scene.beta, tau, scene.dry)
        start, elapsed = State(theta0, v0), times - t0
        most = budget(since(terms, t0), start, elapsed)
        if isinstance(tau, Analytic):
            most = jnp.minimum(most, 2**24)  # β may have been hidden, and be large
        if self.max_steps is not None:
            most = self.max_steps
        # Where there is no clock, time begins with the motion: differences keep their digits.
        states, end = marched(
            terms,
            start,
            times if clock else elapsed,
            most,
            t0=t0 if clock else None,
            rtol=self.rtol,
            atol=self.atol,
            stiff=self.stiff,
            moving_times=self.moving_times,
            moving_start=self.moving_start and clock,
        )
        arrived = jnp.all(jnp.isfinite(states.theta) & jnp.isfinite(states.v))
        failed = Result.where(end.going, Result.too_many_steps, Result.solver_failed)
        if isinstance(tau, Analytic) and scene.beta is not None:
            stiff = end.going & _hopeless(scene.beta, elapsed, most.astype(elapsed.dtype))
            failed = Result.where(stiff, Result.too_stiff, failed)
        result = Result.where(arrived, Result.successful, failed)
        none = jnp.zeros_like(end.steps)
        stats = {"steps": end.steps, "accepted": end.steps, "rejected": none}
        return states.theta, states.v, result, stats


class Averaged(Method):
    """For β far below √ε, without torque, over many turns."""

    name: str = eqx.field(static=True, default="averaging over turns")

    def __call__(self, scene: Pendulum, times, v0, theta0, t0) -> Any:
        terms, start = Scene(scene.epsilon, scene.beta, None), State(theta0, v0)

        def solve(_, scene, start, ts, __):
            return averaged(scene, start, ts)

        states, error = with_derivatives(solve, terms, start, times - t0, None, False)
        # Nothing is left to be averaged where it hangs at rest, or has not begun.
        still = (times == t0) | ((v0 == 0) & (theta0 == 0))
        theta = jnp.where(still, theta0, states.theta)
        v = jnp.where(still, v0, states.v)
        arrived = jnp.all(jnp.isfinite(theta) & jnp.isfinite(v))
        result = Result.where(arrived, Result.successful, Result.solver_failed)
        return theta, v, result, {"error": jnp.max(jnp.where(still, 0, error))}


class Diffrax(Method):
    """Whatever diffrax offers."""

    solver: Any
    options: dict[str, Any]
    name: str = eqx.field(static=True)

    def __call__(self, scene: Pendulum, times, v0, theta0, t0) -> Any:
        from diffrax import AbstractImplicitSolver

        from .solvers import integrate

        *motion, result, stats = integrate(
            scene, times, v0, theta0, t0, solver=self.solver, **self.options
        )
        if scene.beta is not None and not isinstance(self.solver, AbstractImplicitSolver):
            hopeless = _hopeless(scene.beta, times - t0, self.options["max_steps"])
            stiff = hopeless & (result == Result.too_many_steps)
            result = Result.where(stiff, Result.too_stiff, result)
        return *motion, result, stats


def _hopeless(beta, elapsed, max_steps) -> Any:
    """No explicit step is stable that is many times 1/β."""
    return beta * jnp.max(jnp.abs(elapsed)) > 4 * max_steps


def choose(pendulum: Pendulum, ts, t0, v0, dtype, solver: Any, options: dict[str, Any]) -> Method:
    """A named solver, or diffrax's options, are diffrax's; else the scene decides.

    By what can be seen of it: under a transformation programs are general.
    """
    span = None if _hidden(ts, t0) else _span(ts, t0)
    named = ("stepsize_controller", "dt0", "adjoint")
    plain = solver is None and all(options[x] is None for x in named)
    _require_switching(pendulum, plain, span)
    backwards = span is not None and bool(np.any(span < 0))
    sampled = isinstance(pendulum.tau, SampledTorque) and not backwards
    if plain and (not callable(pendulum.tau) or sampled or _is_entire(pendulum, dtype, span)):
        # Who speaks of steps wants them.
        free = all(options[x] is None for x in ("rtol", "atol", "max_steps"))
        if free and span is not None and _barely_damped(pendulum, span, dtype):
            return Averaged()
        most = options["max_steps"]
        # A step more or less to the last digit: tolerances cost little here.
        rtol = options["rtol"] or float(jnp.finfo(dtype).eps) ** 0.9
        return TaylorSeries(
            rtol=rtol,
            atol=options["atol"] or rtol,
            max_steps=None if most is None else jnp.asarray(min(most, 2**31 - 128), jnp.int32),
            # A line's end would start another relaxation.
            stiff=not callable(pendulum.tau) and _overdamped(pendulum) is not False,
            moving_times=span is None,
            moving_start=_hidden(t0),
        )
    import diffrax as dfx

    if solver is None:
        solver = dfx.Kvaerno5() if _overdamped(pendulum) else dfx.Dopri8()
    rtol = options["rtol"] or float(jnp.finfo(dtype).eps) ** 0.75
    options = options | {"rtol": rtol, "atol": options["atol"] or rtol}
    if options["max_steps"] is None:
        options = options | {"max_steps": _enough(pendulum, span, v0)}
    return Diffrax(solver=solver, options=options, name=type(solver).__name__)


def _require_switching(pendulum: Pendulum, plain: bool, span) -> None:
    """ValueError for dry friction where no method here knows when it changes its sign."""
    if pendulum.dry is None:
        return
    if not plain:
        raise ValueError(
            "Argument `pendulum` must be without dry friction for diffrax's solvers and options: "
            "their steps would go over the turning points."
        )
    if callable(pendulum.tau) and not isinstance(pendulum.tau, SampledTorque):
        raise ValueError(
            "Argument `pendulum` must have, with dry friction, a torque that is a number or "
            "sampled, but got a function of time. Sample it: tau=pendax.SampledTorque(ts, tau(ts))."
        )
    if span is not None and np.any(span < 0):
        raise ValueError(
            "Argument `ts` must be `t0` or later with dry friction: what has come to rest does not "
            "know its past."
        )


def _hidden(*terms) -> bool:
    return any(isinstance(x, Tracer) for x in terms)


def _together(*terms):
    return np.broadcast_arrays(*(np.asarray(x, float) for x in terms))


def _span(ts, t0):
    """From each t0 to the time that is farthest away; of none at all, 0."""
    ts, t0 = np.atleast_1d(np.asarray(ts, float)), np.asarray(t0, float)
    if ts.size == 0:
        return np.zeros_like(t0)
    low, high = ts.min() - t0, ts.max() - t0
    return np.where(np.abs(low) > np.abs(high), low, high)


def _barely_damped(pendulum: Pendulum, span, dtype) -> bool:
    """Whether all lanes are, and a step at a time would take long."""
    epsilon, beta = pendulum.epsilon, pendulum.beta
    if (
        pendulum.tau is not None
        or pendulum.dry is not None
        or beta is None
        or dtype != jnp.float64
        or _hidden(epsilon, beta)
    ):
        return False
    root, beta = _together(np.sqrt(np.asarray(epsilon)), beta)
    weak = np.all((beta > 0) & (beta <= 3e-4 * root) | np.isnan(beta))
    return bool(weak and np.all(span > 0) and np.max(span) * np.min(root) > 1e4)


# An exponent's change over the span: what decays by more is soon over, and steps stay as short.
_LASTING = 300


def _is_entire(pendulum: Pendulum, dtype, span) -> bool:
    """Whether τ is a function that shows what it is, no lane needs an implicit step, and it goes on
    as it began."""
    if not callable(pendulum.tau) or isinstance(pendulum.tau, SampledTorque):
        return False
    if _overdamped(pendulum):
        return False
    growth = eqx.filter_eval_shape(_growth, pendulum.tau, dtype)
    if growth is None or isinstance(growth, float):
        return growth is not None
    if span is None or _hidden(*jax.tree.leaves(pendulum.tau)):
        return True
    growth = _growth(pendulum.tau, dtype)
    if _hidden(growth):
        with jax.ensure_compile_time_eval():  # inside of `jit`; of many small programs
            growth = _growth(pendulum.tau, dtype)
    return bool(float(growth) * np.max(np.abs(span)) <= _LASTING)


@eqx.filter_jit
def _growth(tau, dtype) -> Any:
    """Of an entire function of time, else `None`; as it is read where it is followed."""
    found = analytic(tau, dtype)
    return None if found is None else found.growth()


def _overdamped(pendulum: Pendulum) -> bool | None:
    """Whether any lane is; None where that can't be seen."""
    if pendulum.beta is None:
        return False
    tau = 0.0 if pendulum.tau is None or callable(pendulum.tau) else pendulum.tau
    dry = 0.0 if pendulum.dry is None else pendulum.dry
    terms = pendulum.epsilon, pendulum.beta, tau, dry
    if _hidden(*terms):
        return None
    with np.errstate(over="ignore"):
        return bool(np.any(is_overdamped(Scene(*_together(*terms)))))


def _enough(pendulum: Pendulum, span, v0) -> int:
    """Ten times Taylor's `budget` for what can be seen, a power of two: each is compiled."""
    tau = 0.0 if pendulum.tau is None or callable(pendulum.tau) else pendulum.tau
    beta = 0.0 if pendulum.beta is None else pendulum.beta
    terms = pendulum.epsilon, beta, tau, v0
    if span is None or _hidden(*terms):
        return 2**20
    epsilon, beta, tau, v0, span = _together(*terms, span)
    with jax.ensure_compile_time_eval():
        # A single program: its operations one by one would be ten to compile.
        steps = jax.jit(budget)(Scene(epsilon, beta, tau), State(v0, v0), span)
        return 2 ** int(np.clip(np.ceil(np.log2(10 * float(np.max(np.asarray(steps))))), 16, 24))
