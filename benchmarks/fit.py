"""Fits of 1,000 random scenes, and their run time.

The scenes are those of `tests/fit_scenes.py`, where their distribution is written down.
"""

import time

import fit_scenes
import jax
import jax.numpy as jnp
import numpy as np

from pendax import Pendulum, Result, fit_trajectory, simulate

from .timing import side_by_side


def report(seed: int, scenes: int, rounds: int, check: bool) -> int:
    missed = random_scenes(seed, scenes)
    missed += long_recording(rounds)
    return 1 if check and missed else 0


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


def random_scenes(seed: int, scenes: int) -> int:
    """Without noise to 1e-8; with 1 % of noise, how many 95 % intervals hold the truth."""
    each = scenes // len(fit_scenes.KINDS)
    print(f"{each} scenes of each kind, seed {seed}, {fit_scenes.SAMPLES} samples, 30 % off")
    print(f"{'':12}{'to 1e-8':>9}{'not, unsaid':>13}{'s':>6}", end="")
    print(f"{'1 % noise: in 95 %':>21}{'of converged':>14}{'converged':>11}{'s':>6}")
    right, inside, parameters = 0, 0.0, 0
    for kind in fit_scenes.KINDS:
        rows = fit_scenes.scenes(kind, each, seed)
        noise = np.random.default_rng([seed, 7]).normal(size=(each, fit_scenes.SAMPLES))
        program = jax.jit(jax.vmap(lambda *x, kind=kind: fitted(kind, *x)))
        given = [jnp.asarray(x) for x in (rows, fit_scenes.beside(rows, seed))]
        results = []
        for share in (0.0, 1.0):
            started = time.perf_counter()
            off, pulls, result = jax.block_until_ready(program(*given, jnp.asarray(share * noise)))
            seconds = time.perf_counter() - started
            well = np.asarray(result == Result.successful)
            results.append((np.abs(np.asarray(off)).max(1), np.abs(pulls), well, seconds))
        (off, _, said, cold), (_, pulls, well, warm) = results
        good, held = off < 1e-8, pulls < 1.96
        print(f"{kind:12}{good.sum():9d}{(~good & said).sum():13d}{cold:6.0f}", end="")
        print(f"{held.mean():21.3f}{held[well].mean():14.3f}{well.mean():11.3f}{warm:6.1f}")
        right, inside = right + good.sum(), inside + held.sum()
        parameters += held.size
    total = each * len(fit_scenes.KINDS)
    print(f"all: {right / total:.1%} to 1e-8 (bar 99 %), {inside / parameters:.3f} (0.93 … 0.97)")
    return int(right < 0.99 * total) + int(not 0.93 < inside / parameters < 0.97)


def long_recording(rounds: int) -> int:
    """5,000 samples, five parameters: 30 s of a damped swing with noise and an offset."""
    ts = np.linspace(0.0, 30.0, 5000)
    theta = simulate(Pendulum(6.0, 0.1), ts, 0.0, 2.0).theta
    noisy = np.asarray(theta) + 0.1 + 0.01 * np.random.default_rng(3).normal(size=ts.size)

    def fit():
        return fit_trajectory(ts, noisy, Pendulum(8.0, 0.15), offset=0.0)

    started = time.perf_counter()
    jax.block_until_ready(fit())
    cold = time.perf_counter() - started
    warm = side_by_side({"": fit}, rounds)[""]
    print(f"5,000 samples, 5 parameters: {warm:.2f} s warm (bar 2 s), {cold:.1f} s cold (bar 15 s)")
    return int(warm > 2) + int(cold > 15)
