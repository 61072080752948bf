"""Fits of random scenes, and their run time.

The scenes are those of `tests/fit_scenes.py`, where their distribution is written down.
"""

import fit_scenes
import jax
import jax.numpy as jnp
import numpy as np

from pendax import Pendulum, Result, fit_trajectory, simulate

from . import results
from .compared import once, seconds, spent
from .timing import Timing, side_by_side


def measure(seed: int, quick: bool) -> results.Tables:
    kinds = ("libration",) if quick else fit_scenes.KINDS
    each = 10 if quick else 200
    rows, right, inside = random_scenes(seed, kinds, each)
    bars = [results.bar("share back to 1e-8", right, at_least=0.99)]
    title = f"{each} scenes a kind, {fit_scenes.SAMPLES} samples, started 30 % off"
    if quick:  # too few scenes for shares, and what follows takes longest to compile
        return {title: rows, "bars": bars}
    bars.append(results.bar("share of 95 % intervals that hold", inside, at_least=0.93))
    bars.append(results.bar("the same", inside, at_most=0.97))
    cold, warm = long_recording()
    bars.append(results.bar("5,000 samples, 5 parameters, s", seconds(warm), at_most=2))
    bars.append(results.bar("the same, first call, s", seconds(cold), at_most=15))
    times = [{"call": "first", **spent(cold, "s")}, {"call": "next", **spent(warm, "s")}]
    return {title: rows, "5,000 samples, 5 parameters": times, "bars": bars}


def fitted(kind, row, start, noise):
    ts, theta = fit_scenes.recorded(kind, row)
    measured = theta + noise * fit_scenes.noise_of(theta)
    guess = fit_scenes.pendulum_of(kind, start)
    fit = fit_trajectory(ts, measured, guess, v0=start[3], theta0=start[4])
    found = {name: getattr(fit.model, name) for name in ("epsilon", "beta", "tau")}
    found |= {"v0": fit.v0, "theta0": fit.theta0}
    names = list(fit.errors)
    true = row[jnp.asarray([fit_scenes.COLUMNS.index(name) for name in names])]
    values = jnp.stack([found[name] for name in names])
    return values / true - 1, (values - true) / jnp.stack(list(fit.errors.values())), fit.result


def random_scenes(seed: int, kinds, each: int):
    """Rows by kind; the share without noise right to 1e-8; with 1 % of noise, the share of 95 %
    intervals that hold the truth."""
    rows, right, inside = [], [], []
    for kind in kinds:
        drawn = fit_scenes.scenes(kind, each, seed)
        noise = np.random.default_rng([seed, 7]).normal(size=(each, fit_scenes.SAMPLES))
        program = jax.jit(jax.vmap(lambda *x, kind=kind: fitted(kind, *x)))
        given = [jnp.asarray(x) for x in (drawn, fit_scenes.beside(drawn, seed))]
        off, _, result = program(*given, jnp.zeros_like(noise))
        good = np.abs(np.asarray(off)).max(1) < 1e-8
        said = np.asarray(result == Result.successful)
        noisy = [*given, jnp.asarray(noise)]
        runs = [once(lambda f=program, x=noisy: f(*x)) for _ in range(3)]
        timing = Timing(tuple(run.median for run, _ in runs))
        _, pulls, result = runs[0][1]
        held, well = np.abs(pulls) < 1.96, np.asarray(result == Result.successful)
        rows.append(
            {
                "kind": kind,
                "to 1e-8": int(good.sum()),
                "converged elsewhere": int((~good & said).sum()),
                "1 % noise: in 95 %": float(held.mean()),
                "of converged": float(held[well].mean()),
                "converged": float(well.mean()),
                **spent(timing, "ms", each),
            }
        )
        right.append(good)
        inside.append(held.ravel())
    return rows, float(np.concatenate(right).mean()), float(np.concatenate(inside).mean())


def long_recording() -> tuple[Timing, Timing]:
    """First and next times of a fit of five parameters: 5,000 samples in 30 s of a damped swing,
    with noise and an offset."""
    ts = np.linspace(0.0, 30.0, 5000)
    theta = simulate(Pendulum(6.0, 0.1), ts, 0.0, 2.0).theta
    noisy = np.asarray(theta) + 0.1 + 0.01 * np.random.default_rng(3).normal(size=ts.size)

    def fit():
        return fit_trajectory(ts, noisy, Pendulum(8.0, 0.15), offset=0.0)

    cold, _ = once(fit)
    return cold, side_by_side({"": fit}, 5)[""]
