"""Sweeps of v0: time a lane, compile time and memory, for one lane to tens of thousands.

θ(t) of a free pendulum, of a damped and driven one, and under a periodic torque; beside diffrax's
Dopri8 under `vmap`, heyoka and a loop around SciPy, all at the tolerance 1e-8.  Memory is what the
compiled program asks for: its arguments, its result, and what it needs on the way.
"""

from collections.abc import Callable
from functools import partial

import diffrax as dfx
import jax
import jax.numpy as jnp
import numpy as np

from . import cores, front, methods, results
from .problems import Problem
from .timing import Timing, side_by_side

RTOL = 1e-8
WIDE = f"pendax, {results.WIDE}"
ROUNDS = 5
BY = ("pendax", WIDE, "diffrax", "heyoka", "SciPy")
FREE, DRIVEN, WAVED = "free, t = 10", "damped and driven, t = 40", "periodic torque, t = 40"
_CALL = "a call of a compiled program costs some microseconds, whatever it computes"


def measure(seed: int, quick: bool) -> results.Tables:
    rng = np.random.default_rng(seed)
    lanes = (1024,) if quick else (1, 32, 1024, 32_768)
    v0 = rng.uniform(0.1, 4.0, max(lanes))
    rows, bars, lost = [], [], []
    for problem in scenes(v0)[: 2 if quick else 3]:
        per_lane = {}
        for count in lanes:
            given = jnp.asarray(v0[:count])
            programs = {"pendax": ours(problem), "diffrax": dopri8(problem)}
            built = {name: _compiled(run, given) for name, run in programs.items()}
            if wide := cores.widest():
                built[WIDE] = _compiled(programs["pendax"], given, wide)
            calls = {name: partial(one[0], given) for name, one in built.items()}
            calls |= peers(problem, v0[:count])
            spent = side_by_side(calls, ROUNDS)
            for name, timing in spent.items():
                each = Timing(tuple(s / count for s in timing.samples))
                per_lane[name, count] = timing
                seconds, memory = built[name][1:] if name in built else (None, None)
                rows.append({
                    "scene": problem.name, "by": name, "lanes": count, "µs": each.median * 1e6,
                    "spread": each.spread, "compiling, s": seconds, "bytes a lane": memory,
                })  # fmt: skip
        print(f"{problem.name}: {len(lanes)} sizes", flush=True)
        most = max(lanes)
        ratio = per_lane["pendax", most].over(per_lane["diffrax", most])
        bars.append(results.bar(f"{problem.name}, {most} lanes: over diffrax", ratio, at_most=1))
        lost += losses(problem.name, per_lane)
    draw(rows, quick)
    return {"sweeps": rows, "losses": lost, "bars": bars}


WHY = {
    (FREE, "heyoka"): _CALL,
    (DRIVEN, "heyoka"): front.MACHINE_CODE,
    (WAVED, "heyoka"): front.MACHINE_CODE,
}


def losses(scene: str, spent: dict[tuple[str, int], Timing]) -> list[results.Row]:
    """Where a peer was faster, in the median of the rounds."""
    rows = []
    for (name, count), timing in spent.items():
        ours = spent["pendax", count]
        if not name.startswith("pendax") and (ratio := ours.over(timing))["ratio"] > 1:
            rows.append({
                "where": f"{scene}, {count} lanes", "peer": name, "of": "run time",
                **ratio, "why": WHY.get((scene, name), ""),
            })  # fmt: skip
    return rows


def scenes(v0) -> list[Problem]:
    return [
        Problem(FREE, v0, 10.0),
        Problem(DRIVEN, v0, 40.0, beta=0.16, tau=0.15),
        Problem(WAVED, v0, 40.0, beta=0.5, tau=0.9, wave=(0.4, 0.6)),
    ]


def ours(problem: Problem) -> Callable:
    free = problem.beta is None
    return methods.simulated(problem, None if free else RTOL)


def dopri8(problem: Problem) -> Callable:
    return partial(methods.diffeqsolve(problem, dfx.Dopri8()), RTOL)


def _compiled(run: Callable, v0, options=None) -> tuple[Callable, float, float]:
    """The program, seconds to compile it without a cache, and its bytes a lane."""
    import time

    jax.clear_caches()
    start = time.perf_counter()
    program = jax.jit(run).lower(v0).compile(options)
    seconds = time.perf_counter() - start
    memory = program.memory_analysis()
    size = memory.argument_size_in_bytes + memory.output_size_in_bytes
    return program, seconds, (size + memory.temp_size_in_bytes) / len(v0)


def peers(problem: Problem, v0) -> dict[str, Callable]:
    few = Problem(problem.name, v0, problem.t, beta=problem.beta, tau=problem.tau,
                  wave=problem.wave)  # fmt: skip
    calls = {}
    for method in methods.by_heyoka(few, (RTOL,)):
        if method.lanes == len(v0):
            calls[method.name.split(",")[0]] = method.call  # batches, where they fill up
    if len(v0) <= 32:
        calls["SciPy"] = next(m.call for m in methods.by_scipy(few, {"DOP853": (RTOL,)}, len(v0)))
    return calls


def draw(rows, quick: bool) -> None:
    from pendax.plot import new_figure, style

    names = list(dict.fromkeys(row["scene"] for row in rows))
    with style():
        figure = new_figure(4.8 * len(names), 4.2)
        for ax, scene in zip(figure.subplots(1, len(names)), names, strict=True):
            for by, mark in zip(BY, "ovs^D", strict=True):
                mine = [row for row in rows if row["scene"] == scene and row["by"] == by]
                if mine:
                    ax.loglog([r["lanes"] for r in mine], [r["µs"] for r in mine], mark + "-",
                              label=by, color=front.COLOURS[by.split(",")[0]])  # fmt: skip
            ax.set(title=scene, xlabel="lanes", ylabel="run time of a lane / µs")
            ax.legend()
        folder = results.folder(quick)
        folder.mkdir(parents=True, exist_ok=True)
        figure.savefig(folder / "sweeps.png")
