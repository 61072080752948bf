"""Dry friction against 30 digits, and beside SciPy's events and a smoothed sign."""

from functools import partial

import diffrax as dfx
import dry_references as references
import jax
import jax.numpy as jnp
import numpy as np

from pendax import Pendulum, settle, simulate

from .timing import side_by_side

NAMES = ("epsilon", "beta", "tau", "dry", "theta0", "v0")
SAVED = np.linspace(6.0, 60.0, 10)


def report(seed: int, scenes: int, rounds: int, check: bool) -> int:
    missed = random_scenes(seed, scenes)
    beside_peers(rounds)
    return 1 if check and missed else 0


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


def random_scenes(seed: int, count: int) -> int:
    """θ over tolerance × (1 + max|θ|) × (1 + κ), bar 100; gradients over their size, bar 1e-7;
    the angle at rest, bar 1e-9."""
    rows = draw(seed, count)
    motions = {r: jax.jit(jax.vmap(partial(_theta, rtol=r))) for r in (1e-6, 1e-9, 1e-12)}
    found = {r: np.asarray(f(rows)) for r, f in motions.items()}
    slopes = np.asarray(jax.jit(jax.vmap(jax.jacrev(_theta)))(rows))
    epsilon, beta, tau, dry, theta0, v0 = rows.T
    ends = settle(Pendulum(epsilon, beta, tau, dry), v0, theta0, throw=False)
    shares, wrong, stops, turns = {r: [] for r in found}, [], [], []
    for i, row in enumerate(rows):
        scene = dict(zip(NAMES, row.tolist(), strict=True))
        states, turned, _ = references.trajectory(**scene, ts=SAVED)
        true = np.array([float(theta) for theta, _ in states])
        exact = np.moveaxis(references.slopes(NAMES, scene, SAVED), 0, -1)[:, 0]
        kappa = np.abs(exact[:, 4:]).max()
        turns.append(len(turned))
        for r, share in shares.items():
            scale = r * (1 + np.abs(true).max()) * (1 + kappa)
            share.append(np.abs(found[r][i] - true).max() / scale)
        wrong.append(np.abs(slopes[i] - exact).max() / (1 + np.abs(exact).max()))
        if ends.running[i] == 0 and np.isfinite(ends.time[i]) and ends.time[i] < 300:
            last, _, held = references.trajectory(**scene, ts=[float(ends.time[i]) + 1])
            if held:
                stops.append(abs(float(ends.theta[i]) - float(last[0][0])))
    print(f"\n{count} random scenes to t = 60 (seed {seed}), {max(turns)} turning points at most")
    for r, share in shares.items():
        print(
            f"θ at rtol {r:.0e}: {np.median(share):.2g} median, {max(share):.2g} largest, bar 100"
        )
    print(f"gradients: {np.median(wrong):.1e} median, {max(wrong):.1e} largest, bar 1e-07")
    print(f"{len(stops)} stops: {max(stops):.1e} rad largest, bar 1e-09")
    return sum(max(x) > 100 for x in shares.values()) + (max(wrong) > 1e-7) + (max(stops) > 1e-9)


SCENE = (4.0, 0.0, 0.0, 0.012, 2.5, 0.0)


def beside_peers(rounds: int) -> None:
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

    works = {f"pendax, rtol {r:.0e}": jax.jit(partial(ours, rtol=r)) for r in (1e-6, 1e-9, 1e-12)}
    works["pendax"] = jax.jit(ours)
    works |= {f"tanh(v/{w:g}), Dopri8": smoothed(w) for w in (1e-2, 1e-4)}
    works |= {f"SciPy DOP853, events, {r:.0e}": partial(_scipy, r) for r in (1e-8, 1e-12)}
    lanes = jax.jit(jax.vmap(ours))
    many = jnp.full(1024, dry)
    times = side_by_side(
        {name: (lambda f=f: f(jnp.asarray(dry))) for name, f in works.items()}
        | {"pendax, 1,024 lanes": lambda: lanes(many)},
        rounds,
    )
    print("\none swing through 45 turning points: error of the last angle, run time")
    for name, f in works.items():
        error = abs(float(f(jnp.asarray(dry))[0]) - true)
        print(f"{name:28} {error:8.1e}  {times[name] * 1e3:9.3f} ms")
    print(f"{'a lane of 1,024':28} {'':8}  {times['pendax, 1,024 lanes'] / 1.024:9.4f} ms")


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
