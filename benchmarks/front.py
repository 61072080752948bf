"""Error against run time of one problem, the diagram, and where pendax loses."""

import time
from collections.abc import Callable, Iterable

import jax
import numpy as np

from pendax import simulate

from . import methods, results
from .methods import Method
from .problems import Problem
from .timing import Timing, side_by_side

EPS = 2.0**-52
# Why heyoka may be faster.
MACHINE_CODE = (
    "machine code made for this equation, several lanes at a time where there are enough, with "
    "every coefficient computed once; XLA computes the series thrice, for the size of the step, "
    "for θ and for v"
)
ROUNDS, OF_CHEAP = 3, 9


def measure(problem: Problem, quick: bool) -> tuple[list[results.Row], ...]:
    """Points, the best of each peer, and those that no point of ours is as good as in both."""
    if (true := problem.true()) is None:
        return [], [], []
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
    spent = side_by_side(often, ROUNDS, OF_CHEAP)
    spent |= {key: _once(remembered(key)) for key in known if key not in often}
    rows, timings = [], []
    for key, method in known.items():
        true = truth(method.dtype)
        found = np.asarray(answers[key], float)[: len(true)]
        off = np.abs(found - true[: len(found)])
        each = Timing(tuple(s / method.lanes for s in spent[key].samples))
        rows.append({
            "problem": problem, "method": method.name, "setting": method.setting,
            "lanes": method.lanes, "µs": each.median * 1e6, "spread": each.spread,
            "error": float(np.max(off / (size if np.ndim(size) == 0 else size[: len(found)]))),
        })  # fmt: skip
        timings.append(each)
    print(f"{problem}: {len(known)} settings", flush=True)
    return rows, best(rows, floor), losses(rows, timings, floor)


def _once(call) -> Timing:
    """Of what takes tens of seconds: one run, and no warming up."""
    start = time.perf_counter()
    jax.block_until_ready(call())
    return Timing((time.perf_counter() - start,))


def _floor(problem, true) -> float:
    """What the roundings of t and θ alone may do: nothing is told by errors below."""
    v0 = problem.v0[: len(true)]
    last = simulate(problem.pendulum, problem.t, v0, problem.theta0, throw=False).v
    return 2 * EPS * float(np.max(np.abs(true) + problem.t * np.abs(last)))


def _ours(rows, floor: float, error: float, wide=False) -> list[int]:
    """Our points that are as exact, errors below `floor` being equal, and such as differ by a
    tenth; or those with wide vectors.  float32's are of other scenes, whose numbers are rounded."""
    most = max(1.1 * error, floor)
    names = (row["method"] for row in rows)
    mine = (results.WIDE in name if wide else results.as_it_comes(name) for name in names)
    return [i for i, is_ours in enumerate(mine) if is_ours and rows[i]["error"] <= most]


def losses(rows, timings: list[Timing], floor: float) -> list[results.Row]:
    """For each peer, its smallest error that we do not reach, and where it is fastest in
    comparison: at best it takes that share of our time at no larger an error."""
    lost = []
    for name in dict.fromkeys(row["method"] for row in rows):
        points = [i for i, row in enumerate(rows) if row["method"] == name]
        points = [i for i in points if rows[i]["error"] == rows[i]["error"]]
        if name.startswith("pendax"):
            continue
        alone, faster = [], []
        for i in points:
            able = _ours(rows, floor, rows[i]["error"])
            if not able:
                alone.append(i)
                continue
            ours = min(able, key=lambda j: timings[j].median)
            if (ratio := timings[i].over(timings[ours]))["ratio"] < 1:
                faster.append((ratio["ratio"], i, ours, ratio))
        common = {"problem": rows[0]["problem"], "peer": name}
        if alone:
            i = min(alone, key=lambda i: rows[i]["error"])
            lost.append({**common, "setting": rows[i]["setting"], "error": rows[i]["error"],
                         "ratio": None, "from": None, "to": None, results.WIDE: None,
                         "at": len(alone), "settings": len(points),
                         "ours": "no setting as exact"})  # fmt: skip
        if faster:
            _, i, ours, ratio = min(faster)
            wide = _ours(rows, floor, rows[i]["error"], wide=True)
            of_wide = min(wide, key=lambda j: timings[j].median, default=None)
            left = None if of_wide is None else timings[i].over(timings[of_wide])["ratio"]
            lost.append({**common, "setting": rows[i]["setting"], "error": rows[i]["error"],
                         **ratio, results.WIDE: left, "at": len(faster), "settings": len(points),
                         "ours": rows[ours]["setting"]})  # fmt: skip
    return lost


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


def best(rows, floor: float) -> list[results.Row]:
    """How long we take to be as exact as each peer where it is most exact."""
    lines = []
    for name in dict.fromkeys(row["method"] for row in rows):
        points = [row for row in rows if row["method"] == name and row["error"] == row["error"]]
        if name.startswith("pendax") or not points:
            continue
        row = min(points, key=lambda row: row["error"])
        able = [rows[i]["µs"] for i in _ours(rows, floor, row["error"])]
        lines.append({
            "problem": row["problem"], "peer": name, "its least error": row["error"],
            "µs": row["µs"], "spread": row["spread"], "pendax, µs": min(able) if able else None,
        })  # fmt: skip
    return lines


# A colour for each library, a mark for each of its methods, alike in all figures.
COLOURS = {"pendax": "C0", "heyoka": "C1", "SciPy": "C2", "diffrax": "C3", "Symplectic": "C4"}
_MARKS = "os^vDP*X"


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
            for line, look in zip(ax.lines, _looks(names), strict=True):
                line.set(**look)
            ax.set_title(titles[problem])
        drawn = zip(*(ax.lines for ax in panels[: len(problems)]), strict=True)
        shown = [max(lines, key=lambda line: np.size(line.get_xdata())) for lines in drawn]
        figure.legend(shown, names, loc="outside lower center", ncols=3 * columns - 1, fontsize=9)
        folder = results.folder(quick)
        folder.mkdir(parents=True, exist_ok=True)
        figure.savefig(folder / f"{name}.png")


def _looks(names: list[str]) -> list[dict]:
    looks, count = [], {}
    for name in names:
        colours = (colour for word, colour in COLOURS.items() if name.startswith(word))
        colour = next(colours, COLOURS["diffrax"])
        count[colour] = count.get(colour, -1) + 1
        looks.append({"color": colour, "marker": _MARKS[count[colour]]})
    return looks


def _family(name: str) -> tuple[int, str]:
    """Ours first, then library by library."""
    words = ["pendax", "Symplectic", "heyoka", "SciPy"]
    return next((i for i, word in enumerate(words) if name.startswith(word)), len(words)), name
