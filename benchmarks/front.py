"""Error against run time of one problem, the diagram, and where pendax loses."""

import time
from collections.abc import Callable, Iterable

import jax
import numpy as np

from . import methods, results
from .methods import Method
from .problems import Problem
from .timing import Timing, side_by_side

EPS = 2.0**-52
ROUNDS = 3


def measure(problem: Problem, quick: bool) -> tuple[list[results.Row], list[results.Row]]:
    """Points, and those of peers that no point of ours is as good as in both."""
    if (true := problem.true()) is None:
        return [], []
    of = methods.of(problem, quick)
    return points(problem.name, of, problem.true, _floor(problem, true))


def points(problem: str, of: Iterable[Method], truth: Callable, floor: float, size=1.0):
    """The same for any methods, of errors over `size`."""
    known = {(m.name, m.setting): m for m in of}
    answers = {}

    def remembered(key):
        def call():
            answers[key] = known[key].call()
            return answers[key]

        return call

    often = {key: remembered(key) for key, method in known.items() if not method.slow}
    spent = side_by_side(often, ROUNDS)
    spent |= {key: _once(remembered(key)) for key in known if key not in often}
    rows, timings = [], []
    for key, method in known.items():
        true = truth(method.dtype)
        found = np.asarray(answers[key], float)[: len(true)]
        off = np.abs(found - true[: len(found)])
        each = Timing(tuple(s / method.lanes for s in spent[key].samples))
        rows.append({
            "problem": problem, "method": method.name, "setting": method.setting,
            "lanes": method.lanes, "µs": each.median * 1e6, "spread": _spread(method, each),
            "error": float(np.max(off / (size if np.ndim(size) == 0 else size[: len(found)]))),
        })  # fmt: skip
        timings.append(each)
    print(f"{problem}: {len(known)} settings", flush=True)
    return rows, losses(rows, timings, floor)


def _once(call) -> Timing:
    """Of what takes tens of seconds: no warming up, and the one run stands for all rounds."""
    start = time.perf_counter()
    jax.block_until_ready(call())
    return Timing((time.perf_counter() - start,) * ROUNDS)


def _spread(method, timing) -> float:
    return 0.5 if method.slow else timing.spread


def _floor(problem, true) -> float:
    """What the roundings of t and θ alone may do: nothing is told by errors below."""
    return 2 * EPS * float(np.max(np.abs(true)) + problem.t * np.max(np.abs(problem.v0)))


def losses(rows, timings: list[Timing], floor: float) -> list[results.Row]:
    """For each peer, where it is fastest in comparison at an error that no faster point of ours
    has; errors below `floor` are equal, and such as differ by a tenth.  A ratio below 1: pendax
    takes 1/ratio times as long."""
    mine = [i for i, row in enumerate(rows) if row["method"].startswith("pendax")]
    worst = {}
    for i, row in enumerate(rows):
        if i in mine or np.isnan(row["error"]):
            continue
        able = [j for j in mine if rows[j]["error"] <= max(1.1 * row["error"], floor)]
        if able:
            best = min(able, key=lambda j: timings[j].median)
            ratio = timings[i].over(timings[best])
            if ratio["ratio"] >= 1:
                continue
        else:
            best, ratio = None, {"ratio": 0.0, "from": None, "to": None}
        lost = {
            "problem": row["problem"], "peer": row["method"], "setting": row["setting"],
            "error": row["error"], "floor": floor, **ratio,
            "ours": "no setting as exact" if best is None else rows[best]["setting"],
        }  # fmt: skip
        known = worst.get(row["method"])
        if known is None or lost["ratio"] < known["ratio"]:
            worst[row["method"]] = lost
    return list(worst.values())


def explained(lost, why: dict[tuple[str, str], str]) -> list[results.Row]:
    """Losses with the reason, which is known by problem and the first word of the peer."""
    return [{**row, "why": why.get(_cause(row), "")} for row in lost]


def reasons(lost, why, quick: bool) -> list[results.Row]:
    if quick:  # with few settings of ours, others happen to be ahead
        return []
    count = sum(_cause(row) not in why for row in lost)
    return [results.bar("losses without a reason", count, at_most=0)]


def _cause(row) -> tuple[str, str]:
    return row["problem"], row["peer"].split(",")[0]


def summary(rows) -> list[results.Row]:
    """How many times as long the fastest of each peer takes as ours, at no larger an error."""
    lines = []
    for problem in dict.fromkeys(row["problem"] for row in rows):
        here = [row for row in rows if row["problem"] == problem]
        mine = [row for row in here if row["method"].startswith("pendax")]
        for name in dict.fromkeys(row["method"] for row in here):
            if name.startswith("pendax"):
                continue
            points = [row for row in here if row["method"] == name]
            best = min((r for r in points if r["error"] == r["error"]),
                       key=lambda r: r["error"], default=None)  # fmt: skip
            if best is None:
                continue
            able = [r["µs"] for r in mine if r["error"] <= best["error"]]
            lines.append({
                "problem": problem, "peer": name, "its least error": best["error"],
                "µs": best["µs"], "spread": best["spread"],
                "pendax there": min(able) if able else None,
            })  # fmt: skip
    return lines


def draw(
    rows, name: str, quick: bool, titles: dict[str, str], error="largest error of θ / rad"
) -> None:
    """results/NAME.png: a panel for each problem."""
    from pendax.plot import new_figure, style, work_precision

    if not rows:
        return
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    names = sorted({row["method"] for row in rows}, key=_family)  # alike in every panel
    columns = min(2, len(problems))
    lines = -(-len(problems) // columns)
    with style():
        figure = new_figure(6.2 * columns, 4.2 * lines + 0.9)
        panels = np.ravel(figure.subplots(lines, columns))
        for ax in panels[len(problems) :]:
            ax.set_axis_off()
        for ax, problem in zip(panels, problems, strict=False):
            points = {name: [] for name in names}
            for row in rows:
                if row["problem"] == problem and row["error"] == row["error"]:
                    points[row["method"]].append((row["error"] or EPS, row["µs"]))
            lines_of = {name: np.reshape(sorted(x), (-1, 2)).T for name, x in points.items()}
            work_precision(ax, lines_of, error=error,
                           time="run time of a lane / µs").get_legend().remove()  # fmt: skip
            ax.set_title(titles[problem])
        drawn = zip(*(ax.lines for ax in panels[: len(problems)]), strict=True)
        shown = [max(lines, key=lambda line: np.size(line.get_xdata())) for lines in drawn]
        figure.legend(shown, names, loc="outside lower center", ncols=3 * columns - 1, fontsize=9)
        folder = results.QUICK if quick else results.FOLDER
        folder.mkdir(parents=True, exist_ok=True)
        figure.savefig(folder / f"{name}.png")


def _family(name: str) -> tuple[bool, str]:
    """Ours first."""
    return not name.startswith("pendax"), name
