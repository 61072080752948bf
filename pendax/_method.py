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
from .taylor import (
    Scene,
    State,
    averaged,
    budget,
    is_overdamped,
    marched,
    with_derivatives,
)


class Method(eqx.Module):
    """(scene, times, v0, θ0, t0) of one lane -> θ, v, how it ended, and counts of steps."""

    name: eqx.AbstractVar[str]

    @abstractmethod
    def __call__(self, scene: Pendulum, times, v0, theta0, t0): ...


class TaylorSeries(Method):
    """For β and τ that don't depend on time."""

    rtol: float = eqx.field(static=True)
    atol: float = eqx.field(static=True)
    max_steps: Array | None
    stiff: bool = eqx.field(static=True)
    moving_times: bool = eqx.field(static=True)
    name: str = eqx.field(static=True, default="Taylor series")

    def __call__(self, scene, times, v0, theta0, t0):
        terms = Scene(scene.epsilon, scene.beta, scene.tau)
        start, since = State(theta0, v0), times - t0
        most = budget(terms, start, since)
        if self.max_steps is not None:
            most = self.max_steps
        states, end = marched(
            terms,
            start,
            since,
            most,
            rtol=self.rtol,
            atol=self.atol,
            stiff=self.stiff,
            moving_times=self.moving_times,
        )
        arrived = jnp.all(jnp.isfinite(states.theta) & jnp.isfinite(states.v))
        failed = Result.where(end.going, Result.too_many_steps, Result.solver_failed)
        result = Result.where(arrived, Result.successful, failed)
        none = jnp.zeros_like(end.steps)
        stats = {"steps": end.steps, "accepted": end.steps, "rejected": none}
        return states.theta, states.v, result, stats


class Averaged(Method):
    """For β far below √ε, without torque, over many turns."""

    moving_times: bool = eqx.field(static=True)
    name: str = eqx.field(static=True, default="averaging over turns")

    def __call__(self, scene, times, v0, theta0, t0):
        terms, start = Scene(scene.epsilon, scene.beta, None), State(theta0, v0)

        def solve(scene, start, ts, _):
            return averaged(scene, start, ts)

        states, error = with_derivatives(
            solve, terms, start, times - t0, None, self.moving_times
        )
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

    def __call__(self, scene, times, v0, theta0, t0):
        from .solvers import integrate

        return integrate(scene, times, v0, theta0, t0, solver=self.solver, **self.options)


def choose(
    pendulum: Pendulum, ts, t0, v0, solver: Any, options: dict[str, Any], moving_times: bool
) -> Method:
    """A named solver, or diffrax's options, are diffrax's; else the scene decides."""
    overdamped = _overdamped(pendulum)
    named = ("stepsize_controller", "dt0", "adjoint")
    if not callable(pendulum.tau) and solver is None and all(options[x] is None for x in named):
        if not moving_times and _barely_damped(pendulum, ts - t0):
            return Averaged(moving_times)
        most = options["max_steps"]
        return TaylorSeries(
            options["rtol"],
            options["atol"],
            None if most is None else jnp.asarray(min(most, 2**31 - 128), jnp.int32),
            stiff=overdamped is not False,
            moving_times=moving_times,
        )
    import diffrax as dfx

    if solver is None:
        solver = dfx.Kvaerno5() if overdamped else dfx.Dopri8()
    if options["max_steps"] is None:
        options = options | {"max_steps": _enough(pendulum, ts, t0, v0)}
    return Diffrax(solver, options, type(solver).__name__)


def _barely_damped(pendulum: Pendulum, since) -> bool:
    """Whether all lanes are, and a step at a time would take long."""
    terms = (pendulum.epsilon, pendulum.beta, since)
    if pendulum.tau is not None or pendulum.beta is None or since.dtype != jnp.float64:
        return False
    if any(isinstance(x, Tracer) for x in terms):
        return False
    root = np.sqrt(np.asarray(pendulum.epsilon))
    beta = np.asarray(pendulum.beta)
    weak = np.all((beta > 0) & (beta <= 3e-4 * root))
    return bool(weak and np.all(since >= 0) and np.max(since) * np.min(root) > 1e4)


def _overdamped(pendulum: Pendulum) -> bool | None:
    """Whether any lane is; None where that can't be seen yet."""
    if pendulum.beta is None:
        return False
    tau = None if callable(pendulum.tau) else pendulum.tau
    terms = Scene(pendulum.epsilon, pendulum.beta, tau)
    if any(isinstance(x, Tracer) for x in jax.tree.leaves(terms)):
        return None
    with jax.ensure_compile_time_eval():
        return bool(np.any(is_overdamped(terms)))


def _enough(pendulum: Pendulum, ts, t0, v0) -> int:
    """`budget` for what can be seen, a power of two: each new one is compiled."""
    tau = None if callable(pendulum.tau) else pendulum.tau
    terms = Scene(pendulum.epsilon, pendulum.beta, tau)
    if any(isinstance(x, Tracer) for x in jax.tree.leaves((terms, ts, t0, v0))):
        return 2**20
    with jax.ensure_compile_time_eval():
        steps = float(np.nan_to_num(jnp.max(budget(terms, State(v0, v0), ts - t0))))
    return 2 ** int(np.clip(np.ceil(np.log2(10 * steps)), 16, 30))
