"""Gradients of the last angle, error against run time.

∂θ(t)/∂(β, τ, v0) of damped, driven lanes: pendax's forward and reverse mode, diffrax's adjoints
and its forward mode, heyoka's variational equations, central differences around SciPy.
"""

import copy
import math
from collections.abc import Iterator
from functools import partial

import damped_references as references
import diffrax as dfx
import jax
import jax.numpy as jnp
import numpy as np

from pendax import Pendulum, simulate

from . import cores, front, results
from .methods import OURS, Method
from .peers import library

T, BETA, TAU = 40.0, 0.16, 0.15
KNOWN = 4
NAMES = ("beta", "tau", "v0")
PROBLEM = "gradient"
WHY = {
    (PROBLEM, "heyoka"): "machine code made for these equations, several lanes at a time, with "
    "every coefficient computed once; XLA computes the series again for the size of the step and "
    "for each of its results"
}


def _true(row) -> np.ndarray:
    return references.trajectory(1.0, BETA, TAU, 0.0, *row, [T], NAMES)[0][2::2]


def measure(seed: int, quick: bool) -> results.Tables:
    v0 = np.random.default_rng(seed).uniform(0.1, 4.0, 32 if quick else 256)
    true = np.array(cores.each(_true, v0[:KNOWN, None], worth=1))
    size = 1 + np.abs(true)
    rows, best, lost = front.points(PROBLEM, methods(v0, quick), lambda dtype: true, 1e-13, size)
    titles = {PROBLEM: f"∂θ({T:g})/∂(β, τ, v0), β = {BETA}, τ = {TAU} ({len(v0)} lanes)"}
    front.draw(rows, "gradients", quick, titles, error="largest error / (1 + |gradient|)")
    return {
        "error against run time": rows,
        "at each peer's least error": best,
        "losses": front.explained(lost, WHY),
        "bars": front.reasons(lost, WHY, quick),
    }


def methods(v0: np.ndarray, quick: bool) -> Iterator[Method]:
    lanes = jnp.asarray(v0)
    rtols = (1e-8,) if quick else (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
    modes = {"reverse": jax.grad} if quick else {"forward": jax.jacfwd, "reverse": jax.grad}
    for name, mode in modes.items():
        for rtol in rtols if quick else OURS:
            run = jax.jit(jax.vmap(_gradient(mode, partial(_ours, rtol))))
            yield Method(f"pendax, {name}", f"rtol = {rtol:.0e}", partial(run, lanes), len(v0))
    if (wide := cores.widest()) and not quick:
        for rtol in OURS[1::2]:
            run = jax.jit(
                jax.vmap(_gradient(jax.grad, partial(_ours, rtol))), compiler_options=wide
            )
            name = f"pendax, reverse, {results.WIDE}"
            yield Method(name, f"rtol = {rtol:.0e}", partial(run, lanes), len(v0))
    adjoints = {
        "checkpoints": (jax.grad, dfx.RecursiveCheckpointAdjoint()),
        "backsolve": (jax.grad, dfx.BacksolveAdjoint()),
        "forward mode": (jax.jacfwd, dfx.ForwardMode()),
    }
    for name, (mode, adjoint) in list(adjoints.items())[: 1 if quick else 3]:

        def gradient(rtol, v0, mode=mode, adjoint=adjoint):
            return _gradient(mode, partial(_diffrax, adjoint, rtol))(v0)

        run = jax.jit(jax.vmap(gradient, (None, 0)))
        for rtol in rtols:
            call = partial(run, rtol, lanes)
            yield Method(f"Dopri8, {name}", f"rtol = atol = {rtol:.0e}", call, len(v0))
    yield from by_heyoka(v0, quick)
    yield from by_differences(v0, quick)


def _gradient(mode, angle):
    def gradient(v0):
        return mode(angle)(jnp.stack([jnp.full_like(v0, BETA), jnp.full_like(v0, TAU), v0]))

    return gradient


def _ours(rtol, x):
    return simulate(Pendulum(1.0, x[0], x[1]), T, x[2], rtol=rtol, throw=False).theta


def _diffrax(adjoint, rtol, x):
    def field(t, y, x):
        theta, v = y
        return v, x[1] - jnp.sin(theta) - x[0] * v

    return dfx.diffeqsolve(
        dfx.ODETerm(field), dfx.Dopri8(), 0.0, T, None, (jnp.zeros_like(x[2]), x[2]), x,
        stepsize_controller=dfx.PIDController(rtol=rtol, atol=rtol), adjoint=adjoint,
        throw=False, max_steps=4096,
    ).ys[0][0]  # fmt: skip


def by_heyoka(v0: np.ndarray, quick: bool) -> Iterator[Method]:
    if (heyoka := library("heyoka")) is None:
        return
    theta, v = heyoka.make_vars("theta", "v")
    beta, tau = heyoka.par[0], heyoka.par[1]
    system = [(theta, v), (v, tau - beta * v - heyoka.sin(theta))]
    varied = heyoka.var_ode_sys(system, [beta, tau, v], order=1)
    width = heyoka.recommended_simd_size()
    pars = np.repeat([[BETA], [TAU]], width, 1)
    for tol in (1e-9,) if quick else (1e-6, 1e-9, 1e-12, 2e-16):
        run = heyoka.taylor_adaptive_batch(varied, np.zeros((2, width)), tol=tol, pars=pars)
        start, runs = np.array(run.state), [copy.deepcopy(run) for _ in range(cores.COUNT)]

        def work(run, rows, start=start):
            found = []
            for x in rows:
                run.set_time(0.0)
                run.state[:] = start
                run.state[1] = x
                run.propagate_until(T)
                found.append(np.array(run.state[2:5]).T)  # θ by β, τ and v0
            return found

        def call(runs=runs, work=work):
            return np.concatenate(cores.shared(work, runs, v0.reshape(-1, width)))

        yield Method("heyoka, variational equations", f"tol = {tol:.0e}", call, len(v0))


def by_differences(v0: np.ndarray, quick: bool) -> Iterator[Method]:
    """Two runs an argument, steps of the tolerance's cube root."""
    from scipy.integrate import solve_ivp

    def angle(rtol, beta, tau, v0):
        def field(t, y):
            return y[1], tau - beta * y[1] - math.sin(y[0])

        return solve_ivp(field, (0, T), (0.0, v0), "DOP853", rtol=rtol, atol=rtol).y[0, -1]

    for rtol in (1e-9,) if quick else (1e-6, 1e-9, 1e-12):
        h = rtol ** (1 / 3)

        def call(rtol=rtol, h=h):
            found = []
            for x in v0[:KNOWN]:
                at = np.array([BETA, TAU, x])
                ends = [
                    (angle(rtol, *(at + h * e)) - angle(rtol, *(at - h * e))) / (2 * h)
                    for e in np.eye(3)
                ]
                found.append(ends)
            return np.array(found)

        yield Method("SciPy, differences", f"rtol = atol = {rtol:.0e}", call, KNOWN)
