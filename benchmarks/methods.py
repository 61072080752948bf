"""What solves an initial value problem here: pendax, diffrax, SciPy and heyoka.

Each yields the angle at the end, of the lanes it is asked for: pendax and diffrax all of them in
one compiled program, heyoka's batches as well, SciPy and heyoka's scalar integrator one after the
other.  heyoka runs a thread on every core, XLA as many as it likes, SciPy one.
"""

import copy
import math
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

import diffrax as dfx
import jax
import jax.numpy as jnp
import numpy as np

from pendax import simulate
from pendax.solvers import Symplectic

from . import cores, results
from .peers import library
from .problems import KNOWN, Problem

OURS = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14]  # each a program; stiff ones compile longest
FINEST = [2e-16]  # where errors of many steps add up
# Of implicit methods of order 5; the last only where there is something to gain.
IMPLICIT = (1e-4, 1e-6, 1e-8)


class Method(NamedTuple):
    name: str
    setting: str
    call: Callable  # of nothing, to the angles of the first `lanes` lanes
    lanes: int
    slow: bool = False  # run once
    dtype: type = np.float64


def of(problem: Problem, quick: bool) -> Iterator[Method]:
    yield from ours(problem, quick)
    yield from by_diffrax(problem, quick)
    yield from by_heyoka(problem, (1e-9,) if quick else (1e-6, 1e-9, 1e-12, 2e-16))
    yield from by_scipy(problem, {"DOP853": (1e-7,)} if quick and not problem.stiff else None)


def ours(problem: Problem, quick: bool) -> Iterator[Method]:
    lanes = len(problem.v0)
    exact = problem.beta is None and problem.tau is None
    several = OURS[1::2] if problem.stiff else OURS + FINEST * long(problem)
    rtols = [None] if exact else [1e-9] if quick else several
    v0 = jnp.asarray(problem.v0)
    for rtol in rtols:
        setting = "float64" if exact else f"rtol = {rtol:.0e}"
        yield Method("pendax", setting, partial(simulated(problem, rtol), v0), lanes)
        if (wide := cores.widest()) and not quick and rtol in (None, *OURS[1::2]):
            call = partial(simulated(problem, rtol, wide), v0)
            yield Method(f"pendax, {results.WIDE}", setting, call, lanes)
    with jax.enable_x64(False):
        narrow = jnp.asarray(problem.v0, jnp.float32)
        run = simulated(problem, None if exact else 1e-5)

        def in_float32():
            with jax.enable_x64(False):
                return run(narrow)

    if problem.wave is None:
        setting = "" if exact else "rtol = 1e-05"
        yield Method("pendax, float32", setting, in_float32, lanes, dtype=np.float32)


def simulated(problem, rtol, of_compiler=None):
    options = {"throw": False} if rtol is None else {"rtol": rtol, "throw": False}
    return jax.jit(
        lambda v0: simulate(problem.pendulum, problem.t, v0, problem.theta0, **options).theta,
        compiler_options=of_compiler,
    )


def by_diffrax(problem: Problem, quick: bool) -> Iterator[Method]:
    solvers = [(dfx.Kvaerno5(), IMPLICIT[: 3 if problem.stiff else 2])]
    if not problem.stiff:
        explicit = (dfx.Tsit5(), dfx.Dopri5(), dfx.Dopri8())
        rtols = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
        if long(problem):  # minutes, otherwise
            solvers = [(s, (1e-8,)) for s in explicit[:2]] + [(explicit[2], (1e-8, 1e-12))]
        else:
            solvers = [(s, rtols) for s in explicit] + (solvers if problem.turns < 50 else [])
    for solver, rtols in solvers[2:3] or solvers if quick else solvers:
        implicit = isinstance(solver, dfx.Kvaerno5)
        v0 = jnp.asarray(problem.v0[: 64 if implicit else None])
        # Compiled before, since what is slow is not warmed up.
        run = diffeqsolve(problem, solver).lower(jnp.asarray(1e-3), v0).compile()
        for rtol in rtols[1:2] if quick else rtols:
            call = partial(run, jnp.asarray(rtol), v0)
            yield Method(type(solver).__name__, _setting(rtol), call, len(v0), long(problem))
    if problem.by == "free":
        yield from symplectic(problem, quick)


def diffeqsolve(problem: Problem, solver) -> Callable:
    """As diffrax's manual has it; the tolerance is an argument, so one program does for all."""
    field = _field(problem, jnp.sin, jnp.cos)

    def one(rtol, v0):
        run = dfx.diffeqsolve(
            dfx.ODETerm(field), solver, 0.0, problem.t, None,
            (jnp.full_like(v0, problem.theta0), v0), throw=False, max_steps=2**24,
            stepsize_controller=dfx.PIDController(rtol=rtol, atol=rtol),
            adjoint=dfx.ForwardMode(),
        )  # fmt: skip
        return jnp.where(run.result == dfx.RESULTS.successful, run.ys[0][0], jnp.nan)

    return jax.jit(jax.vmap(one, (None, 0)))


def symplectic(problem: Problem, quick: bool) -> Iterator[Method]:
    v0 = jnp.asarray(problem.v0)
    given = {2: (0.1, 0.01), 6: (0.2, 0.05, 0.0125)}
    for degree in (6,) if quick else given:
        for step in given[degree][:1] if quick or long(problem) else given[degree]:

            def run(v0, degree=degree, step=step):
                options = {"solver": Symplectic(degree), "dt0": step, "max_steps": 2**24}
                return simulate(
                    problem.pendulum, problem.t, v0, problem.theta0, throw=False, **options
                ).theta

            call = partial(jax.jit(run).lower(v0).compile(), v0)
            yield Method(f"Symplectic({degree})", f"dt = {step}", call, len(v0), long(problem))


def by_scipy(problem: Problem, tolerances: dict | None = None, lanes=KNOWN) -> Iterator[Method]:
    """One lane after the other, by the methods and tolerances given, or those it has time for."""
    from scipy.integrate import solve_ivp

    field = _field(problem, math.sin, math.cos)
    slow = problem.turns > 50
    if tolerances is None:
        tolerances = {"DOP853": (1e-4, 1e-7, 1e-10, 1e-13), "LSODA": (1e-4, 1e-7, 1e-10, 1e-12)}
        tolerances["Radau"] = IMPLICIT[: 3 if problem.stiff else 2]
        if problem.stiff:
            del tolerances["DOP853"]
        if slow:
            tolerances, lanes = {"DOP853": (1e-7, 1e-13), "LSODA": (1e-10,)}, 1
        if long(problem):
            tolerances = {"DOP853": (1e-10,)}
    for name, rtols in tolerances.items():
        for rtol in rtols:

            def call(name=name, rtol=rtol):
                found = []
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")  # of tolerances below its least
                    for v0 in problem.v0[:lanes]:
                        run = solve_ivp(field, (0, problem.t), (problem.theta0, v0), name,
                                        rtol=rtol, atol=rtol, args=(None,))  # fmt: skip
                        found.append(run.y[0, -1] if run.success else math.nan)
                return np.array(found)

            yield Method(f"SciPy {name}", _setting(rtol), call, lanes, slow)


def by_heyoka(problem: Problem, tolerances=(1e-6, 1e-9, 1e-12, 2e-16)) -> Iterator[Method]:
    if problem.stiff or (heyoka := library("heyoka")) is None:
        return  # an explicit method takes a step for every 1/β
    theta, v = heyoka.make_vars("theta", "v")
    field = _field(problem, heyoka.sin, heyoka.cos)
    system = list(zip((theta, v), field(heyoka.time, (theta, v), None), strict=True))
    width = heyoka.recommended_simd_size()
    count = min(len(problem.v0), 64)
    for tol in tolerances:
        scalar = heyoka.taylor_adaptive(system, [0.0, 0.0], tol=tol)
        scalars = [copy.deepcopy(scalar) for _ in range(cores.COUNT)]
        given = problem.v0[:count, None]
        call = partial(_threaded, problem, scalars, given)
        yield Method("heyoka", f"tol = {tol:.0e}", call, count)
        if (rows := len(problem.v0) // width) >= cores.COUNT:
            batch = heyoka.taylor_adaptive_batch(system, np.zeros((2, width)), tol=tol)
            batches = [copy.deepcopy(batch) for _ in range(cores.COUNT)]
            given = problem.v0[: rows * width].reshape(rows, width)
            call = partial(_threaded, problem, batches, given)
            yield Method(f"heyoka, batches of {width}", f"tol = {tol:.0e}", call, rows * width)


def _threaded(problem, integrators, rows) -> np.ndarray:
    """Each integrator takes its share of the rows of v0."""

    def work(integrator, mine):
        found = []
        for v0 in mine:
            if v0.size > 1:
                integrator.set_time(0.0)
            else:
                integrator.time = 0.0
            integrator.state[0] = problem.theta0
            integrator.state[1] = v0 if v0.size > 1 else v0[0]
            integrator.propagate_until(problem.t)
            found.append(np.array(integrator.state[0]))
        return found

    return np.ravel(cores.shared(work, integrators, rows))


def long(problem: Problem) -> bool:
    return problem.turns > 500


def _field(problem, sin, cos):
    """Only the terms that the scene has."""
    beta, tau, wave = problem.beta, problem.tau, problem.wave

    def field(t, y, args):
        theta, v = y
        force = -sin(theta)
        if beta is not None:
            force = force - beta * v
        if tau is not None:
            force = force + tau
        if wave is not None:
            force = force + wave[0] * cos(wave[1] * t)
        return v, force

    return field


def _setting(rtol) -> str:
    return f"rtol = atol = {rtol:.0e}"
