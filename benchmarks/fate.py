"""Where motions end: maps of starts against 30 digits, what they take, and scripts beside them."""

from functools import partial

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

from . import cores, fate_scripts, results
from .compared import Point, losses, seconds, spent
from .timing import side_by_side

WHY = {}  # of losses, which there were none


def measure(seed: int, quick: bool) -> results.Tables:
    side, pixels, rounds = (64, 16, 3) if quick else (256, 200, 5)
    found, rows, bars, starts = {}, [], [], []
    for name, scene in axes(side).items():
        ends, timing, chosen, wrong = one_map(scene, seed, pixels, rounds)
        found[name] = ends
        starts.append(chosen)
        compared = {"compared": 2 * pixels, "wrong": wrong}
        rows.append({"starts": f"{side}² over {name}", **spent(timing, "s"), **compared})
        bars.append(results.bar(f"wrong fates, {name}", wrong, at_most=0))
        bars.append(results.bar(f"{side}² fates, {name}, s", seconds(timing), at_most=20))
    points = scripts(found, starts, rounds, quick)
    velocities, far = running(seed, pixels // 4, quick)
    bars.append(results.bar("mean velocity 1e-3 or more above τ_r, relative", far, at_most=1e-10))
    if not quick:
        _draw(found)
    count = len(starts[0][0])
    return {
        "maps, half of what is compared beside a boundary": rows,
        f"{count} of those starts of each map, time of one": [
            {
                "over": point.work,
                "method": point.method,
                "setting": point.setting,
                **spent(point.timing, "ms", count),
                f"wrong of {count}": point.error,
            }
            for point in points
        ],
        "mean velocity": velocities,
        "others": times(rounds, quick),
        "losses": losses(points, WHY),
        "bars": bars,
    }


def axes(side: int):
    """The scenes and starts of both maps, and their names."""
    v0 = np.linspace(-4, 4, side)
    tau = np.linspace(-1.1, 1.1, side)[:, None]
    beta = np.geomspace(0.02, 2, side)[:, None]
    return {"v0, τ at β = 0.16": (0.16, tau, v0), "v0, β at τ = 0.1": (beta, 0.1, v0)}


def _true(row):
    beta, tau, v0 = row
    kind, n = references.fate(beta, tau, 0.0, v0)
    return (0, n) if kind == "captured" else (n, 0)


def _fates(ends: Settled) -> np.ndarray:
    return np.stack([ends.running, ends.well], -1)


def one_map(scene, seed: int, pixels: int, rounds: int):
    """Its ends, its time, every second of the starts (β, τ, v0) that were compared with their true
    fates, for the scripts, and how many of all were wrong: random pixels, and those with another
    fate beside."""
    beta, tau, v0 = scene
    call = partial(settle, Pendulum(1.0, beta, tau), v0, throw=False)
    timing = side_by_side({"": call}, rounds)[""]
    ends = call()
    fate, rng = _fates(ends), np.random.default_rng(seed)
    edge = (fate[1:-1, 1:-1] != fate[2:, 1:-1]) | (fate[1:-1, 1:-1] != fate[1:-1, 2:])
    beside = np.argwhere(edge.any(-1)) + 1
    chosen = np.concatenate(
        [rng.integers(0, len(v0), (pixels, 2)), beside[rng.integers(0, len(beside), pixels)]]
    )
    every = np.stack(np.broadcast_arrays(beta, tau, v0), -1)[tuple(chosen.T)]
    true = np.array(cores.each(_true, every))
    wrong = int((fate[tuple(chosen.T)] != true).any(-1).sum())
    return ends, timing, (every[::2], true[::2]), wrong


def scripts(names, starts: list, rounds: int, quick: bool) -> list[Point]:
    """Of both maps' starts, wrong fates and run time of `settle` and of scripts."""
    points = []
    for name, (scenes, true) in zip(names, starts, strict=True):
        beta, tau, v0 = scenes.T
        ours = partial(settle, Pendulum(1.0, beta, tau), v0, throw=False)

        def note(method, timing, fate, setting="", name=name, true=true):
            wrong = int((fate != true).any(-1).sum())
            points.append(Point(name, method, timing, wrong, setting))

        note("pendax", side_by_side({"": ours}, rounds)[""], _fates(ours()))
        for run in fate_scripts.all_of(scenes, rounds, quick):
            note(*run)
    return points


def running(seed: int, count: int, quick: bool) -> tuple[list[results.Row], float]:
    """Mean velocities from 1e-6 above τ_r to 3 τ_r, against a turn in Arb; relative, and of
    |v̄| + |β ∂v̄/∂β| + |τ ∂v̄/∂τ|, as next to τ_r a rounding of τ counts."""
    rng = np.random.default_rng(seed)
    beta = 10 ** rng.uniform(-2.5, 0, count)
    tau = np.asarray(retrapping_torque(beta)) * (1 + 10 ** rng.uniform(-6, 0.5, count))
    true = np.array(cores.each(_velocity, np.stack([beta, tau], 1)))

    def one(beta, tau):
        return mean_velocity(Pendulum(1.0, beta, tau))

    error = np.abs(np.asarray(one(beta, tau)) - true)
    far = tau > 1.001 * np.asarray(retrapping_torque(beta))
    rows, columns = [], {"relative": error / true}
    if not quick:  # the derivatives take longest to compile
        slopes = jax.vmap(jax.grad(one, (0, 1)))(beta, tau)
        scale = true + np.abs(beta * slopes[0]) + np.abs(tau * slopes[1])
        columns["of its scale"] = error / scale
    for scenes, these in {"all": tau > 0, "1e-3 or more above τ_r": far}.items():
        worst = {name: float(max(x[these], default=np.nan)) for name, x in columns.items()}
        rows.append({"scenes": scenes, **worst})
    return rows, rows[1]["relative"]


def _velocity(row) -> float:
    return float(references.mean_velocity(*row))


def times(rounds: int, quick: bool) -> list[results.Row]:
    beta, tau = np.geomspace(1e-3, 2, 1000), np.linspace(1.01, 3, 200)
    calls = {
        "retrapping_torque, 1000 dampings": jax.jit(partial(retrapping_torque, beta)),
    }
    if not quick:  # they take longer to compile
        for damping in (0.3, 10.0):
            call = partial(mean_velocity, Pendulum(1.0, damping, tau))
            calls[f"mean_velocity, 200 torques at β = {damping:g}"] = call
        calls["well_boundaries, 13 torques"] = partial(
            well_boundaries, Pendulum(1.0, 0.16), 2.6, over="tau", count=13
        )
    taken = side_by_side(calls, rounds)
    return [{"work": name, **spent(timing, "ms")} for name, timing in taken.items()]


def _draw(found: dict[str, Settled]) -> None:
    from pendax.plot import fate_map, new_figure, style

    with style():
        figure = new_figure(11.0, 4.5)
        panels = zip(figure.subplots(1, 2), axes(256).items(), strict=True)
        for ax, (name, (beta, tau, v0)) in panels:
            over_beta = bool(np.ndim(beta))
            fate_map(ax, np.ravel(v0), np.ravel(beta if over_beta else tau), found[name])
            ax.set(xlabel="v0 / rad s⁻¹", ylabel="β / s⁻¹" if over_beta else "τ / s⁻²")
            ax.set_title(name + ", ε = 1 1/s²")
            if over_beta:
                ax.set_yscale("log")
        figure.savefig(results.folder() / "fate.png")
