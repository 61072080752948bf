"""Where motions end: maps of starts against 30 digits, and what they take."""

import multiprocessing
from functools import partial
from pathlib import Path

import fate_references as references
import jax
import numpy as np

from pendax import (
    Pendulum,
    Settled,
    mean_velocity,
    retrapping_torque,
    settle,
    well_boundaries,
)

from .timing import side_by_side

FOLDER = Path(__file__).parent / "results"
SIDE = 256


def report(seed: int, pixels: int, rounds: int, check: bool) -> int:
    missed = maps(seed, pixels, rounds)
    missed += running(seed, pixels // 4)
    missed += times(rounds)
    return 1 if check and missed else 0


def axes():
    """The scenes and starts of both maps, and their names."""
    v0 = np.linspace(-4, 4, SIDE)
    tau = np.linspace(-1.1, 1.1, SIDE)[:, None]
    beta = np.geomspace(0.02, 2, SIDE)[:, None]
    return {"v0, τ at β = 0.16": (0.16, tau, v0), "v0, β at τ = 0.1": (beta, 0.1, v0)}


def _true(row):
    beta, tau, v0 = row
    kind, n = references.fate(beta, tau, 0.0, v0)
    return (0, n) if kind == "captured" else (n, 0)


def maps(seed: int, pixels: int, rounds: int) -> int:
    """Fates of random pixels, and of those that have another fate beside them."""
    rng = np.random.default_rng(seed)
    missed, found = 0, {}
    for name, (beta, tau, v0) in axes().items():
        call = partial(settle, Pendulum(1.0, beta, tau), v0, throw=False)
        seconds = side_by_side({"": call}, rounds)[""]
        ends = call()
        fate = np.stack([ends.running, ends.well], -1)
        found[name] = ends
        edge = (fate[1:-1, 1:-1] != fate[2:, 1:-1]) | (fate[1:-1, 1:-1] != fate[1:-1, 2:])
        beside = np.argwhere(edge.any(-1)) + 1
        chosen = np.concatenate(
            [rng.integers(0, SIDE, (pixels, 2)), beside[rng.integers(0, len(beside), pixels)]]
        )
        every = np.stack(np.broadcast_arrays(beta, tau, v0), -1)[tuple(chosen.T)]
        with multiprocessing.get_context("spawn").Pool() as pool:
            true = np.array(pool.map(_true, [tuple(row) for row in every], 8))
        wrong = int((fate[tuple(chosen.T)] != true).any(-1).sum())
        missed += wrong + (seconds > 20)
        print(
            f"{SIDE}² starts over {name}: {seconds:.1f} s (bar 20); wrong fates {wrong} of "
            f"{len(chosen)}, half of them beside a boundary (seed {seed})"
        )
    _draw(found)
    return missed


def running(seed: int, count: int) -> int:
    """Mean velocities from 1e-6 above τ_r to 3 τ_r, against a turn in Arb."""
    rng = np.random.default_rng(seed)
    beta = 10 ** rng.uniform(-2.5, 0, count)
    tau = np.asarray(retrapping_torque(beta)) * (1 + 10 ** rng.uniform(-6, 0.5, count))
    true = np.array([float(references.mean_velocity(*row)) for row in zip(beta, tau, strict=True)])

    def one(beta, tau):
        return mean_velocity(Pendulum(1.0, beta, tau))

    slopes = jax.vmap(jax.grad(one, (0, 1)))(beta, tau)
    error = np.abs(np.asarray(one(beta, tau)) - true)
    scale = true + np.abs(beta * slopes[0]) + np.abs(tau * slopes[1])
    print(
        f"mean velocity, {count} scenes: largest error {np.max(error / true):.1e} relative, "
        f"{np.max(error / scale):.1e} of its scale"
    )
    far = tau > 1.001 * np.asarray(retrapping_torque(beta))
    print(
        f"  of those 1e-3 or more above τ_r: {np.max((error / true)[far]):.1e} relative (bar 1e-10)"
    )
    return int((error / true)[far].max() > 1e-10)


def times(rounds: int) -> int:
    beta, tau = np.geomspace(1e-3, 2, 1000), np.linspace(1.01, 3, 200)
    calls = {
        "retrapping_torque, 1000 dampings": jax.jit(partial(retrapping_torque, beta)),
        "mean_velocity, 200 torques at β = 0.3": partial(mean_velocity, Pendulum(1.0, 0.3, tau)),
        "mean_velocity, 200 torques at β = 10": partial(mean_velocity, Pendulum(1.0, 10.0, tau)),
        "well_boundaries, 13 torques": partial(
            well_boundaries, Pendulum(1.0, 0.16), 2.6, over="tau", count=13
        ),
    }
    for name, seconds in side_by_side(calls, rounds).items():
        print(f"{name}: {seconds * 1e3:.2f} ms")
    return 0


def _draw(found: dict[str, Settled]) -> None:
    from pendax.plot import fate_map, new_figure, style

    with style():
        figure = new_figure(11.0, 4.5)
        panels = zip(figure.subplots(1, 2), axes().items(), strict=True)
        for ax, (name, (beta, tau, v0)) in panels:
            over_beta = bool(np.ndim(beta))
            fate_map(ax, np.ravel(v0), np.ravel(beta if over_beta else tau), found[name])
            ax.set(xlabel="v0 / rad s⁻¹", ylabel="β / s⁻¹" if over_beta else "τ / s⁻²")
            ax.set_title(name + ", ε = 1 1/s²")
            if over_beta:
                ax.set_yscale("log")
        FOLDER.mkdir(exist_ok=True)
        figure.savefig(FOLDER / "fate.png")
