"""Maps of fates as scripts draw them: solve to a fixed time, round the last angle to a well."""

from collections.abc import Iterator

import diffrax as dfx
import jax
import jax.numpy as jnp
import numpy as np
from scipy.integrate import solve_ivp

from .compared import once
from .timing import Timing, side_by_side

FAST = 0.5  # of √ε: who moves faster at the end is said to run
SCIPY = [("RK45", 1e-3, 100), ("RK45", 1e-6, 100), ("DOP853", 1e-9, 300)]
DIFFRAX = [(dfx.Tsit5(), 1e-6, 100), (dfx.Dopri8(), 1e-9, 300)]


def all_of(
    scenes: np.ndarray, rounds: int, quick: bool
) -> Iterator[tuple[str, Timing, np.ndarray, str]]:
    """(method, time, rows (running, well), setting) of every script for rows (β, τ, v0)."""
    for method, rtol, span in SCIPY[: 2 if quick else None]:
        timing, last = once(lambda m=method, r=rtol, s=span: by_scipy(scenes, m, r, s))
        yield "SciPy", timing, rounded(scenes, last), setting(method, rtol, span)
    for solver, rtol, span in DIFFRAX[: 1 if quick else None]:
        program = by_diffrax(solver, rtol, span)
        timing = side_by_side({"": lambda f=program: f(scenes)}, rounds)[""]
        last = np.asarray(program(scenes))
        yield "diffrax", timing, rounded(scenes, last), setting(type(solver).__name__, rtol, span)


def setting(method: str, rtol: float, span: float) -> str:
    return f"{method}, rtol {rtol:.0e}, to t = {span}"


def by_scipy(scenes: np.ndarray, method: str, rtol: float, span: float) -> np.ndarray:
    def force(_, y, beta, tau):
        return y[1], tau - beta * y[1] - np.sin(y[0])

    return np.array(
        [
            solve_ivp(
                force, (0, span), (0.0, v0), method, rtol=rtol, atol=rtol, args=(beta, tau)
            ).y[:, -1]
            for beta, tau, v0 in scenes
        ]
    )


def by_diffrax(solver, rtol: float, span: float):
    def field(t, y, scene):
        beta, tau = scene
        return y[1], tau - beta * y[1] - jnp.sin(y[0])

    def one(row):
        beta, tau, v0 = row
        run = dfx.diffeqsolve(
            dfx.ODETerm(field), solver, 0.0, span, None, (0.0 * v0, v0), (beta, tau),
            stepsize_controller=dfx.PIDController(rtol=rtol, atol=rtol), max_steps=100_000,
        )  # fmt: skip
        return jnp.stack(run.ys)[:, 0]

    return jax.jit(jax.vmap(one))


def rounded(scenes: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Rows (running, well) from the last θ and v."""
    theta, v = last.T
    runs = np.abs(v) > FAST
    well = np.round((theta - np.arcsin(np.clip(scenes[:, 1], -1, 1))) / (2 * np.pi))
    return np.stack([np.where(runs, np.sign(v), 0), np.where(runs, 0, well)], -1).astype(int)
