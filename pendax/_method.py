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
from .taylor import Scene, State, budget, is_overdamped, marched


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
