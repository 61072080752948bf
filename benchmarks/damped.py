"""Damped and driven scenes against 30 digits, and beside diffrax's own solvers."""

import multiprocessing
from functools import partial
from pathlib import Path
from typing import NamedTuple

import damped_references as references
import diffrax as dfx
import jax
import jax.numpy as jnp
import numpy as np

from pendax import Pendulum, Result, condition, simulate

from .timing import side_by_side

FOLDER = Path(__file__).parent / "results"
SAVED = np.arange(1, 101) * 1.0  # of which every tenth is compared
NAMES = ("beta", "tau", "epsilon", "v0", "theta0")


def report(seed: int, scenes: int, rounds: int, check: bool) -> int:
    missed = random_scenes(seed, scenes)
    missed += gradients(seed, max(scenes // 20, 5))
    missed += stiff()
    missed += barely_damped()
    missed += against_solvers(rounds)
    return 1 if check and missed else 0


def draw(seed: int, count: int, dtype=np.float64) -> np.ndarray:
    """Columns β, τ, θ0, v0, as floats of the dtype."""
    rng = np.random.default_rng(seed)
    columns = (
        10 ** rng.uniform(-3, 1, count),
        rng.uniform(-2, 2, count),
        rng.uniform(-np.pi, np.pi, count),
        rng.uniform(-4, 4, count),
    )
    return np.stack(columns, 1).astype(dtype).astype(float)


def _true(slopes, row):
    beta, tau, theta0, v0 = row
    return references.trajectory(1.0, beta, tau, theta0, v0, SAVED[9::10], slopes)


def true_rows(rows: np.ndarray, slopes=()) -> np.ndarray:
    # Not forked: JAX has threads.
    with multiprocessing.get_context("spawn").Pool() as pool:
        return np.array(pool.map(partial(_true, slopes), [tuple(row) for row in rows], 8))


def random_scenes(seed: int, count: int) -> int:
    """Errors over tolerance × (1 + max|y|) × (1 + κ), of which 50 are allowed."""
    missed = 0
    print(f"\n{count} random scenes to t = 100 (seed {seed}): error over the scale, bar 50")
    print(
        f"{'':8} {'rtol':>7} {'median':>9} {'largest':>9} {'missed':>7} {'failed':>7} {'steps':>7}"
    )
    for dtype, exponents in ((np.float64, range(-4, -14, -1)), (np.float32, (-6,))):
        rows = draw(seed, count, dtype)
        true = true_rows(rows)
        beta, tau, theta0, v0 = (jnp.asarray(x, dtype) for x in rows.T)
        exact = (jnp.asarray(x) for x in rows.T)
        kappa = _kappa(*exact)[:, 9::10]
        for exponent in exponents:
            rtol = 10.0**exponent
            scene = Pendulum(jnp.ones_like(beta), beta, tau)
            ts = jnp.asarray(SAVED, dtype)
            run = simulate(scene, ts, v0, theta0, rtol=rtol, throw=False)
            states = np.stack([run.theta, run.v], -1).astype(float)
            largest = np.maximum.accumulate(np.abs(states).max(-1), 1)[:, 9::10]
            error = np.abs(states[:, 9::10] - true[..., :2]).max(-1)
            share = (error / (rtol * (1 + largest) * (1 + kappa))).max(1)
            failed = np.asarray(run.result != Result.successful)
            bad = int((share[~failed] > 50).sum())
            missed += bad + int(failed.sum())
            print(
                f"{np.dtype(dtype).name:8} {rtol:7.0e} {np.median(share):9.2g} {share.max():9.2g} "
                f"{bad:7} {failed.sum():7} {np.mean(run.stats['steps']):7.0f}"
            )
    return missed


def _kappa(beta, tau, theta0, v0):
    scene = Pendulum(jnp.ones_like(beta), beta, tau)
    return np.asarray(condition(scene, jnp.asarray(SAVED), v0, theta0))


def gradients(seed: int, count: int) -> int:
    """Of θ(100): |error| over |g| + Σ |y ∂g/∂y| + scale(θ) / max(|x|, 1)."""
    rows = draw(seed + 1, count)
    true = true_rows(rows, NAMES)[:, -1]
    x = jnp.asarray(np.stack([rows[:, 0], rows[:, 1], np.ones(count), rows[:, 3], rows[:, 2]], 1))

    def last(x):
        return simulate(Pendulum(x[2], x[0], x[1]), 100.0, x[3], x[4], throw=False).theta

    got = {"forward": jax.jacfwd(last), "reverse": jax.grad(last)}
    curvature = np.asarray(jax.jit(jax.vmap(jax.hessian(last)))(x))
    slopes = true[:, 2::2]
    size = np.abs(np.asarray(x))
    of_value = np.abs(true[:, :1]) + (np.abs(slopes) * size).sum(1, keepdims=True)
    scale = np.abs(slopes) + (np.abs(curvature) * size[:, None]).sum(2)
    scale = scale + of_value / np.maximum(size, 1)
    missed = 0
    print(f"\ngradients of θ(100) in β, τ, ε, v0, θ0, {count} scenes: bar 1e-8 × scale")
    for mode, gradient in got.items():
        error = np.abs(np.asarray(jax.jit(jax.vmap(gradient))(x)) - slopes) / scale
        missed += int((error > 1e-8).sum())
        print(f"{mode:8} largest {error.max():.1e}, median {np.median(error):.1e}")
    return missed


def stiff() -> int:
    """Steps and time while β grows; errors in tests/test_overdamped.py."""
    print("\noverdamped, ε = 1, t to 10 β, rtol = 1e-10 (float32: 1e-6)")
    for dtype, rtol in ((np.float64, 1e-10), (np.float32, 1e-6)):
        for beta in (1e3, 1e5, 1e8):
            for tau in (0.5, 1.5):
                ts = jnp.asarray(beta * np.array([0.01, 1, 10]), dtype)
                scene = Pendulum(*(jnp.asarray(x, dtype) for x in (1.0, beta, tau)))
                v0 = jnp.asarray(1.0, dtype)
                run = partial(simulate, scene, ts, v0, rtol=rtol)
                seconds = side_by_side({"": run}, 5)[""]
                print(
                    f"{np.dtype(dtype).name:8} β = {beta:.0e} τ = {tau}: "
                    f"{int(run().stats['steps'])} steps, {seconds * 1e3:.1f} ms"
                )
    return 0


def barely_damped() -> int:
    """Run time and the stated error; true errors in tests/test_averaged.py."""
    print("\nbarely damped, ε = 1, v0 = 2.3, t to 5/β")
    missed = 0
    for beta in (1e-4, 1e-5, 1e-6, 1e-7, 1e-8):
        run = partial(simulate, Pendulum(1.0, beta), 5 / beta, 2.3)
        seconds = side_by_side({"": run}, 5)[""]
        stated = float(run().stats["error"])
        missed += seconds > 1
        print(f"β = {beta:.0e}: {run().method}, {seconds:.3f} s, stated error {stated:.1e}")
    return missed


class Point(NamedTuple):
    method: str
    rtol: float
    seconds: float
    error: float


def against_solvers(rounds: int) -> int:
    """1,024 lanes to t = 100, β = 0.16, τ = 0.15: median error against time a lane."""
    count = 1024
    v0 = np.linspace(0.1, 4, count)
    rows = np.stack([np.full(count, 0.16), np.full(count, 0.15), np.zeros(count), v0], 1)
    few = slice(None, None, 8)
    true = true_rows(rows[few])[:, -1, :2]
    scene, v0 = Pendulum(1.0, 0.16, 0.15), jnp.asarray(v0)
    calls, settings = {}, {}
    for rtol in (1e-6, 1e-8, 1e-10, 1e-12):
        name = f"pendax {rtol:.0e}"
        settings[name] = ("pendax", rtol)
        calls[name] = jax.jit(partial(_ours, scene, rtol))
        for solver in (dfx.Dopri8(), dfx.Tsit5()):
            name = f"{type(solver).__name__} {rtol:.0e}"
            settings[name] = (type(solver).__name__, rtol)
            calls[name] = jax.jit(partial(_stock, solver, rtol))
    calls = {name: partial(call, v0) for name, call in calls.items()}
    seconds = side_by_side(calls, rounds)
    points = []
    for name, call in calls.items():
        error = np.abs(np.asarray(call())[few] - true).max(1)
        points.append(Point(*settings[name], seconds[name] / count, float(np.median(error))))
    print("\n1,024 lanes to t = 100: microseconds a lane, and median error")
    for point in points:
        print(
            f"{point.method:8} rtol {point.rtol:.0e} "
            f"{point.seconds * 1e6:8.1f} µs {point.error:.1e}"
        )
    _draw(points)
    at = {(p.method, p.rtol): p for p in points}
    stock = at["Dopri8", 1e-10]
    # Ours at no larger an error.
    ours = min(p.seconds for p in points if p.method == "pendax" and p.error <= stock.error)
    print(f"Dopri8 at error {stock.error:.1e} takes {stock.seconds / ours:.1f} times as long")
    return int(ours > stock.seconds)


def _ours(scene, rtol, v0):
    run = simulate(scene, 100.0, v0, rtol=rtol, throw=False)
    return jnp.stack([run.theta, run.v], -1)


def _stock(solver, rtol, v0):
    def field(t, y, args):
        theta, v = y
        return v, 0.15 - jnp.sin(theta) - 0.16 * v

    def one(v0):
        solution = dfx.diffeqsolve(
            dfx.ODETerm(field), solver, 0.0, 100.0, None, (jnp.zeros_like(v0), v0),
            stepsize_controller=dfx.PIDController(rtol=rtol, atol=rtol), max_steps=100_000,
        )  # fmt: skip
        return jnp.stack(solution.ys, -1)[0]

    return jax.vmap(one)(v0)


def _draw(points: list[Point]) -> None:
    from pendax.plot import new_figure, style, work_precision

    methods = {}
    for name in dict.fromkeys(p.method for p in points):
        mine = sorted((p.error, p.seconds * 1e6) for p in points if p.method == name)
        methods[name] = tuple(zip(*mine, strict=True))
    with style():
        figure = new_figure(7.0, 4.5)
        ax = work_precision(
            figure.subplots(), methods,
            error="median error of θ / rad and v / rad s⁻¹ at 100 s",
            time="run time of a lane / µs",
        )  # fmt: skip
        ax.set_title("1,024 damped, driven lanes (ε = 1, β = 0.16, τ = 0.15)")
        FOLDER.mkdir(exist_ok=True)
        figure.savefig(FOLDER / "damped.png")
