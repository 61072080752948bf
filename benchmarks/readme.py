"""The README's tables and the numbers in its sentences, out of the results files.

A block of the README begins with `<!-- TOPIC -->` and ends with `<!-- end TOPIC -->`; what is
between is written here and nowhere else.  All tables whole are in benchmarks/README.md.
"""

import re
from collections.abc import Callable, Iterable
from pathlib import Path

from . import report, results
from .results import Row, Tables, shown

README = Path(__file__).parent.parent / "README.md"


def renew() -> None:
    """Writes the blocks of all topics, and the report."""
    README.write_text(renewed(README.read_text(encoding="utf-8")), encoding="utf-8")
    report.write()


def renewed(text: str) -> str:
    """The README's text with its blocks written again."""

    def block(found: re.Match) -> str:
        name = found[1]
        if not (results.FOLDER / f"{name}.json").exists():
            return found[0]
        tables = results.read(name)["tables"]
        parts = [BLOCKS[name](tables), report.missed(tables)]
        text = "\n\n".join(filter(None, parts))
        return f"<!-- {name} -->\n{text}\n<!-- end {name} -->"

    return re.sub(r"<!-- (\w+) -->.*?<!-- end \1 -->", block, text, flags=re.DOTALL)


def accuracy(tables: Tables) -> str:
    """A line for each function: the worst of its regions."""
    rows = _table(tables, "errors")
    lines = []
    for function, here in _groups(rows, "function").items():
        both = [row for row in here if row["SciPy max"] is not None]
        lines.append({
            "function": function,
            "regions": len(here),
            "largest error": max(row["max"] for row in here),
            "mean": sum(row["mean"] for row in here) / len(here),
            "SciPy's, where it has one": max((row["SciPy max"] for row in both), default=None),
        })  # fmt: skip
    return results.markdown(lines)


def special(tables: Tables) -> str:
    title, rows = next(iter(tables.items()))
    works = _groups(rows, "work")
    few = [row for row in _table(tables, "ellipj by region") if row["region"] == "random"]
    lines = []
    for work, here in {"ellipj": works["ellipj"], "ellipj, 65,536 elements": few, **works}.items():
        mine, peers = _parted(here, "library")
        lines.append({
            "work": work,
            "pendax": "; ".join(_cell(row, "pendax", "ns", "eps") for row in mine),
            "others": "; ".join(_cell(row, "", "ns", "eps") for row in peers),
        })  # fmt: skip
    caption = f"{title}; time an element, largest error in eps of the scale:"
    parts = [caption, results.markdown(lines), _figure("special"), report.losses(tables)]
    return "\n\n".join(parts)


def free(tables: Tables) -> str:
    cost = {row["work"]: row["ns"] for row in _table(tables, "what the closed form costs")}
    fell = [row for row in _table(tables, "on the separatrix") if row["which way"]]
    longest = max(fell, key=lambda row: row["off by 0.1 rad at t"])
    return (
        f"{front('free', tables)}\n\n"
        f"In arrays of 2²⁰ a time costs {shown(cost['one pendulum, many times'])} ns, a pendulum "
        f"of its own {shown(cost['many pendulums, one time'])} ns, and with its gradient in ε, v0 "
        f"and θ0 {shown(cost['many pendulums, with the gradient in ε, v0, θ0'])} ns. On the "
        f"separatrix itself, v0 = 2√ε, the pendulum nears the top and stays; all {len(fell)} "
        f"solvers and settings fell off, the last of them, {longest['method']} at "
        f"{longest['setting']}, after {shown(longest['off by 0.1 rad at t'])} s (ε = 1 1/s²)."
    )


def damped(tables: Tables) -> str:
    bars = tables["bars"]
    random = next(row for row in bars if row["bar"].startswith("random scenes: largest"))
    slopes = next(row for row in bars if row["bar"].startswith("gradients"))
    scenes, sloped = _table(tables, "random scenes"), _table(tables, "their gradients")
    doubles = [row for row in scenes if row["dtype"] == "float64"]
    return (
        f"{front('damped', tables)}\n\n"
        f"Of {scenes[0]['scenes']} random scenes, at {len(doubles)} tolerances and one in "
        f"float32, none was off by more than {shown(random['measured'])} times tolerance × "
        f"(1 + max|y|) (1 + κ), and of {sloped[0]['scenes']} others no gradient by more than "
        f"{shown(slopes['measured'])} of its scale."
    )


def gradients(tables: Tables) -> str:
    return front("gradients", tables, "over 1 + |gradient|")


def front(name: str, tables: Tables, unit: str = "in rad") -> str:
    """What each library reaches, at which run time, and how long we take to be as exact."""
    lines = []
    points = _groups(_table(tables, "error against run time"), "problem")
    for problem, here in _groups(tables["at each peer's least error"], "problem").items():
        mine, _ = _parted(points[problem], "method")
        mine = [row for row in mine if results.as_it_comes(row["method"])]
        ours = _fastest_of_exact(mine, "error")
        line: Row = {
            "problem": problem,
            "pendax": f"{ours['error']:.2g} in {shown(ours['µs'])} µs",
            **dict.fromkeys(("diffrax", "heyoka", "SciPy")),
        }
        for library, rows in _groups(here, "peer", _library).items():
            theirs = _fastest_of_exact(rows, "its least error")
            time = theirs["pendax, µs"]
            as_exact = "never" if time is None else f"in {shown(time)} µs"
            line[library] = (
                f"{theirs['peer'].removeprefix('SciPy ')}: {theirs['its least error']:.2g} "
                f"in {shown(theirs['µs'])} µs (pendax {as_exact})"
            )
        lines.append(line)
    return "\n\n".join([
        f"Of each library the fastest of its methods within twice its least error: that error, "
        f"{unit}, and its run time a lane; in brackets when pendax is as exact{_FLOOR[name]}. "
        f"Settings that are less exact are in the figure:",
        results.markdown(lines),
        _figure(name),
        report.losses(tables),
    ])  # fmt: skip


def _fastest_of_exact(rows: list[Row], error: str) -> Row:
    least = min(row[error] for row in rows)
    return min((row for row in rows if row[error] <= 2 * least), key=lambda row: row["µs"])


_ANGLES = " (below the roundings of θ and of t, 2 eps (|θ| + t |v|), all are as exact)"
_FLOOR = {"free": _ANGLES, "damped": _ANGLES, "gradients": " (below 1e-13 all are as exact)"}


def _library(peer: str) -> str:
    return peer.split(",")[0].split()[0] if peer.startswith(("SciPy", "heyoka")) else "diffrax"


def sweeps(tables: Tables) -> str:
    lines, rows = [], _table(tables, "sweeps")
    every = ("pendax", f"pendax, {results.WIDE}", "diffrax", "heyoka", "SciPy")
    names = [name for name in every if any(row["by"] == name for row in rows)]
    for (scene, lanes), here in _groups(rows, "scene", "lanes").items():
        line: Row = {"scene": scene, "lanes": lanes}
        by = {row["by"]: row for row in here}
        line |= {f"{name}, µs a lane": by[name]["µs"] if name in by else None
                 for name in names}  # fmt: skip
        line["compiling, s: pendax, diffrax"] = ", ".join(
            shown(by[name]["compiling, s"]) for name in ("pendax", "diffrax")
        )
        line["bytes a lane"] = ", ".join(
            shown(by[name]["bytes a lane"]) for name in ("pendax", "diffrax")
        )
        lines.append(line)
    return f"{results.markdown(lines)}\n\n{_figure('sweeps')}\n\n{report.losses(tables)}"


def dry(tables: Tables) -> str:
    return _points(tables, "a swing of", "ms", "rad")


def fate(tables: Tables) -> str:
    title = next(name for name in tables if "of those starts" in name)
    rows, count = tables[title], title.split()[0]
    columns = ("over", "method", "setting", "ms", f"wrong of {count}")
    maps = _table(tables, "maps")
    sentence = " and ".join(f"{row['starts']} in {shown(row['s'])} s" for row in maps)
    return f"Maps of {sentence}.\n\n{_columns(rows, columns)}\n\n{_figure('fate')}"


def junction(tables: Tables) -> str:
    curves = "; ".join(
        f"{row['currents']} currents, {row['junction']}: {shown(row['s'])} s"
        for row in _table(tables, "I–V curves")
    )
    largest = _columns(_table(tables, "voltages"), ("voltages", "scenes", "largest error"))
    branch = _columns(_table(tables, "falling"), ("method", "setting", "s", "error / Ic R"))
    title = next(name for name in tables if name.startswith("falling"))
    return f"{curves}.\n\n{largest}\n\n{title}:\n\n{branch}\n\n{_figure('junction')}"


def fit(tables: Tables) -> str:
    calls = {row["call"]: shown(row["s"]) for row in _table(tables, "5,000")}
    title, rows = next(iter(tables.items()))
    columns = ("kind", "to 1e-8", "converged elsewhere", "1 % noise: in 95 %", "of converged",
               "converged", "ms")  # fmt: skip
    sentence = f"{calls['next']} s, the first time {calls['first']} s"
    return (
        f"{title}:\n\n{_columns(rows, columns)}\n\n5,000 samples with five parameters: {sentence}."
    )


def stability(tables: Tables) -> str:
    title = next(iter(tables))
    rows = [row for row in tables[title] if row["dtype"] == "float64"]
    columns = ("scene", "by", "error", "of derivatives", "steps", "verdict",
               "SciPy, ellipj", "SciPy, solver", "diffrax")  # fmt: skip
    limits = title.partition("; ")[2]
    lines = _columns(rows, columns)
    return f"{lines}\n\nThese are in float64; {limits}.\n\n{report.losses(tables)}"


def lean(tables: Tables) -> str:
    """Those that were counted on paper; the others have no such row."""
    rows = [row for row in _table(tables, "operations") if row["on paper"] is not None]
    columns = ("scene", "asked", "gradient", "part", "on paper", "distinct", "computed",
               "transcendental", "roots")  # fmt: skip
    return _columns(rows, columns)


def start(tables: Tables) -> str:
    ratios = {row["what"]: f"{row['ratio']:.2g}" for row in _table(tables, "imports")}
    bars = {row["bar"]: row for row in tables["bars"]}
    ellipk = bars["ellipk over equinox"]["measured"]
    lines = []
    for sweep, here in _groups(_table(tables, "cold start"), "sweep").items():
        by = {row["cache"]: row["s"] for row in here}
        if here[0]["by"] is not None:
            lines.append({"sweep": sweep, "by": here[0]["by"], "s": by["no"],
                          "with a warm cache, s": by["yes"]})  # fmt: skip
    return (
        f"`import pendax` loads nothing and takes {ratios['import pendax']} times as long as "
        f"`import jax`; with `pendax.Pendulum` {ratios['pendax.Pendulum']}, with "
        f"`pendax.simulate` {ratios['pendax.simulate']}, `ellipk` {shown(ellipk)} times as long "
        f"as `import equinox`. From the shell to the first number of 1,000 lanes:\n\n"
        f"{results.markdown(lines)}"
    )


def _points(tables: Tables, title: str, time: str, unit: str) -> str:
    rows = [{**row, f"error, {unit}": row["error"]} for row in _table(tables, title)]
    return _columns(rows, ("method", "setting", time, f"error, {unit}"))


def _table(tables: Tables, title: str) -> list[Row]:
    return next(rows for name, rows in tables.items() if name.startswith(title))


def _columns(rows: Iterable[Row], names: tuple[str, ...]) -> str:
    return results.markdown([{name: row[name] for name in names} for row in rows])


def _groups(rows: Iterable[Row], *keys) -> dict:
    """Rows by what they have under the keys; a function among the keys is applied to it."""
    *names, change = keys if callable(keys[-1]) else (*keys, lambda x: x)
    groups: dict = {}
    for row in rows:
        group = tuple(row[name] for name in names)
        groups.setdefault(change(group[0] if len(group) == 1 else group), []).append(row)
    return groups


def _parted(rows: Iterable[Row], key: str) -> tuple[list[Row], list[Row]]:
    rows = list(rows)
    ours = [row for row in rows if str(row[key]).startswith("pendax")]
    return ours, [row for row in rows if row not in ours]


def _cell(row: Row, ours: str, time: str, unit: str) -> str:
    name = str(row["library"]).removeprefix(ours).strip()
    error = "" if row["error"] is None else f", {shown(row['error'])} {unit}"
    return f"{name} {shown(row[time])} {time}{error}".strip(", ")


def _figure(name: str) -> str:
    return f"![{name}](benchmarks/results/{name}.png)"


BLOCKS: dict[str, Callable[[Tables], str]] = {
    function.__name__: function
    for function in (accuracy, special, free, damped, gradients, sweeps, dry, fate, junction, fit,
                     stability, lean, start)
}  # fmt: skip
