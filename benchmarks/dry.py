"""Dry friction against 30 digits, and beside SciPy's events and a smoothed sign."""

from functools import partial

import diffrax as dfx
import dry_references as references
import jax
import jax.numpy as jnp
import numpy as np

from pendax import Pendulum, settle, simulate

from . import cores, results
from .compared import Point, losses, spent
from .timing import Timing, side_by_side

NAMES = ("epsilon", "beta", "tau", "dry", "theta0", "v0")
SAVED = np.linspace(6.0, 60.0, 10)
WORK = "a swing of 45 turning points"
WHY = {}  # of losses, which there were none


def measure(seed: int, quick: bool) -> results.Tables:
    scenes, rounds = (3, 3) if quick else (40, 7)
    errors, swings = random_scenes(seed, scenes, quick)
    points = beside_peers(rounds, quick)
    return {
        f"{scenes} random scenes to t = 60, {swings} turning points at most": [
            {"what": what, "median": float(np.median(off)), "largest": float(max(off))}
            for what, off, _ in errors
        ],
        "a swing of 45 turning points: error of its last angle, rad": [
            {
                "method": point.method,
                "setting": point.setting,
                **spent(point.timing, "ms"),
                "error": point.error,
            }
            for point in points
        ],
        "losses": losses((point for point in points if "lane" not in point.setting), WHY),
        "bars": [results.bar(what, max(off), at_most=limit) for what, off, limit in errors],
    }


def draw(seed: int, count: int) -> np.ndarray:
    """Columns ε, β, τ, c, θ0, v0: swings, rotations, with and without damping."""
    rng = np.random.default_rng(seed)
    epsilon = np.exp(rng.uniform(-1, 2, count))
    columns = (
        epsilon,
        rng.choice([0.0, 1e-3, 0.05], count) * np.sqrt(epsilon),
        rng.uniform(-0.2, 0.2, count) * epsilon,
        np.exp(rng.uniform(-7, -2, count)) * epsilon,
        rng.uniform(-np.pi, np.pi, count),
        rng.normal(size=count) * np.sqrt(epsilon),
    )
    return np.stack(columns, 1)


def _theta(x, rtol=None):
    epsilon, beta, tau, dry, theta0, v0 = x
    return simulate(Pendulum(epsilon, beta, tau, dry), SAVED, v0, theta0, rtol=rtol).theta


def random_scenes(seed: int, count: int, quick: bool) -> tuple[list[tuple], int]:
    """(what, errors, bar) of all, and the most turning points of one."""
    rows = draw(seed, count)
    tolerances = (1e-9,) if quick else (1e-6, 1e-9, 1e-12)
    found = {r: np.asarray(jax.jit(jax.vmap(partial(_theta, rtol=r)))(rows)) for r in tolerances}
    if not quick:  # the derivatives take longest to compile
        slopes = np.asarray(jax.jit(jax.vmap(jax.jacrev(_theta)))(rows))
    epsilon, beta, tau, dry, theta0, v0 = rows.T
    ends = settle(Pendulum(epsilon, beta, tau, dry), v0, theta0, throw=False)
    truths = cores.each(_truth_of_start if quick else _truth, rows, worth=10)
    stops = (ends.running == 0) & np.isfinite(ends.time) & (ends.time < 300)
    resting = cores.each(_rest, np.c_[rows, ends.time][stops], worth=100)
    shares, wrong = {r: [] for r in found}, []
    for i, (true, exact, _) in enumerate(truths):
        kappa = np.abs(exact[:, -2:]).max()
        for r, share in shares.items():
            scale = r * (1 + np.abs(true).max()) * (1 + kappa)
            share.append(np.abs(found[r][i] - true).max() / scale)
        if not quick:
            wrong.append(np.abs(slopes[i] - exact).max() / (1 + np.abs(exact).max()))
    angles = np.asarray(ends.theta)[stops]
    off = [abs(a - b) for a, b in zip(angles, resting, strict=True) if b is not None]
    errors = [
        (f"θ at rtol {r:.0e}, in tolerance × (1 + max θ) (1 + κ)", share, 100)
        for r, share in shares.items()
    ]
    if not quick:
        errors.append(("gradients, of their size", wrong, 1e-7))
    errors.append(("angle at rest, rad", off or [np.nan], 1e-9))
    return errors, max(turns for _, _, turns in truths)


def _truth(row, names=NAMES):
    """θ at the times, its derivatives by the names, and how many turning points there were."""
    scene = dict(zip(NAMES, row, strict=True))
    states, turned, _ = references.trajectory(**scene, ts=SAVED)
    slopes = np.moveaxis(references.slopes(names, scene, SAVED), 0, -1)[:, 0]
    return np.array([float(theta) for theta, _ in states]), slopes, len(turned)


_truth_of_start = partial(_truth, names=NAMES[4:])


def _rest(row) -> float | None:
    """The angle a second after the last number of the row, if it rests there."""
    states, _, held = references.trajectory(
        **dict(zip(NAMES, row[:-1], strict=True)), ts=[row[-1] + 1]
    )
    return float(states[0][0]) if held else None


SCENE = (4.0, 0.0, 0.0, 0.012, 2.5, 0.0)


def beside_peers(rounds: int, quick: bool) -> list[Point]:
    """One swing of 45 turning points, its last angle; and 1,024 of them side by side."""
    true = float(references.trajectory(**dict(zip(NAMES, SCENE, strict=True)), ts=[100.0])[0][0][0])
    epsilon, _, _, dry, theta0, _ = SCENE

    def ours(c, rtol=None):
        return simulate(Pendulum(epsilon, dry=c), jnp.array([100.0]), 0.0, theta0, rtol=rtol).theta

    def smoothed(width):
        def field(t, y, c):
            return jnp.stack([y[1], -epsilon * jnp.sin(y[0]) - c * jnp.tanh(y[1] / width)])

        def run(c):
            return dfx.diffeqsolve(
                dfx.ODETerm(field), dfx.Dopri8(), 0.0, 100.0, None, jnp.array([theta0, 0.0]), c,
                stepsize_controller=dfx.PIDController(rtol=1e-10, atol=1e-10), max_steps=2**20,
            ).ys[:, 0]  # fmt: skip

        return jax.jit(run)

    works = {("pendax", "default"): jax.jit(ours)}
    if not quick:
        for r in (1e-6, 1e-9, 1e-12):
            works["pendax", f"rtol {r:.0e}"] = jax.jit(partial(ours, rtol=r))
    for w in (1e-2, 1e-4)[: 1 if quick else 2]:
        works["diffrax", f"Dopri8, tanh(v/{w:g})"] = smoothed(w)
    for r in (1e-8, 1e-12)[: 1 if quick else 2]:
        works["SciPy", f"DOP853, events, rtol {r:.0e}"] = partial(_scipy, r)
    calls = {name: (lambda f=f: f(jnp.asarray(dry))) for name, f in works.items()}
    timings = side_by_side(calls, rounds)
    angles = {name: call()[0] for name, call in calls.items()}
    if not quick:
        lanes, many = jax.jit(jax.vmap(ours)), jnp.full(1024, dry)
        together = "pendax", "a lane of 1,024"
        of_all = side_by_side({"": lambda: lanes(many)}, 3)[""]
        timings[together] = Timing(tuple(x / many.size for x in of_all.samples))
        angles[together] = lanes(many)[0, 0]
    return [
        Point(WORK, method, timing, abs(float(angles[method, setting]) - true), setting)
        for (method, setting), timing in timings.items()
    ]


def _scipy(rtol, c):
    """A script such as people write: a terminal event at every turning point."""
    from scipy.integrate import solve_ivp

    epsilon, _, _, _, theta, v = SCENE
    t, c = 0.0, float(c)
    while t < 100.0:
        way = np.sign(v) if v else -np.sign(np.sin(theta))
        if v == 0 and epsilon * abs(np.sin(theta)) <= c:
            break

        def field(t, y, way=way):
            return [y[1], -epsilon * np.sin(y[0]) - c * way]

        def turned(t, y):
            return y[1]

        turned.terminal, turned.direction = True, -way
        run = solve_ivp(
            field, (t, 100.0), (theta, v), "DOP853", rtol=rtol, atol=rtol, events=turned
        )
        t, theta = run.t[-1], run.y[0, -1]
        v = 0.0 if run.status == 1 else run.y[1, -1]
    return [theta]
