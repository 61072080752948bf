"""benchmarks/README.md: every table of the results files, and in words where a peer is ahead."""

from pathlib import Path

from . import TOPICS, results
from .results import Row, Tables

REPORT = Path(__file__).parent / "README.md"
_POINTS = 100  # rows: the points of a diagram, which shows them


def write() -> None:
    REPORT.write_text(text(), encoding="utf-8")


def text() -> str:
    """All topics that have results."""
    parts = [
        "# Error against run time, stability, and what a scene costs",
        "Written by `python -m benchmarks` out of benchmarks/results; `python -m benchmarks "
        "--verify` measures again and compares. Times are medians of rounds in turn, each "
        "method warmed up, in each turn where it takes below 50 ms, and blocked. Another run's "
        "median is expected in 99 of 100 to be off by no more than *spread*, relative (by "
        "Student's t of the rounds, and 15 % that two whole runs differed by; 0.5 is assumed "
        "of what was timed once), and another run's ratio to lie between *from* and *to*. A "
        "*lane* is one of the pendulums that are followed side by side, a *bar* what was aimed "
        "at. heyoka runs a thread on each core, XLA (pendax, diffrax, jaxellip, "
        "elliptic-functions) as many as it likes, SciPy, GSL, Boost, mpmath and pyjjasim one. "
        "Errors of functions are in eps of the scale, of angles in rad, of gradients over 1 + "
        "|gradient|, of energies relative. On the same machine and versions errors come out "
        "the same. On another, what roundings decide may not: the mean velocities of fate by "
        "parts in 1e10, for a reason not yet traced, and what SciPy's and diffrax's solvers "
        "give: the linear algebra in them (OpenBLAS) rounds as the processor's kernels do, and "
        "the environment variable OPENBLAS_CORETYPE chooses these.",
    ]
    for name, about in TOPICS.items():
        if not (results.FOLDER / f"{name}.json").exists():
            continue
        content = results.read(name)
        on, versions = content["machine"], content["versions"]
        parts.append(f"## {name}: {about}")
        parts.append(
            f"{on['cores']} cores of {on['processor']}, Python {on['python']}, "
            + ", ".join(f"{package} {v}" for package, v in versions.items() if v)
            + f"; seed {content['settings']['seed']}."
            + "".join(
                f" Without {peer}, which was not there." for peer in content.get("absent", [])
            )
        )
        if (results.FOLDER / f"{name}.png").exists():
            parts.append(f"![{name}](results/{name}.png)")
        for title, rows in content["tables"].items():
            if title == "losses":
                parts.append(losses(content["tables"]))
            elif title == "bars":
                parts.append(bars(rows))
            elif rows and len(rows) < _POINTS:
                parts.append(f"### {title}\n\n{results.markdown(rows)}")
            elif rows:
                parts.append(f"### {title}\n\n{len(rows)} points: results/{name}.json.")
    return "\n\n".join(parts) + "\n"


def bars(rows: list[Row]) -> str:
    """Those that are missed before the others, of which no more is shown than fits."""
    missed = [row for row in rows if row["verdict"] == "missed"]
    others = [row for row in rows if row not in missed]
    heading = f"### bars: {len(missed)} missed, {len(others)} others"
    shown = missed + others[: max(0, _POINTS - len(missed))]
    return f"{heading}\n\n{results.markdown(shown)}" if rows else "### bars: none"


def missed(tables: Tables) -> str:
    """In words, and nothing where all are met."""
    rows = [row for row in tables["bars"] if row["verdict"] == "missed"]
    count = sum(row["verdict"] != "skipped" for row in tables["bars"])
    each = (f"{row['bar']} {row['measured']:.3g} ({row['limit']})" for row in rows)
    return f"Missed, {len(rows)} of {count} aims: {'; '.join(each)}." if rows else ""


def losses(tables: Tables) -> str:
    """Where a peer is ahead, in words, what has one reason together."""
    rows = tables.get("losses", [])
    if not rows:
        return "No peer was ahead in these."
    reasons: dict = {}
    for row in rows:
        reasons.setdefault(row["why"], []).append(_loss(row))
    lines = [f"- {'; '.join(where)}. {why[:1].upper()}{why[1:]}." for why, where in reasons.items()]
    return "\n".join(["Where a peer is ahead:", "", *lines])


def _loss(row: Row) -> str:
    where, peer = row.get("problem") or row.get("where"), row["peer"]
    if row.get("of") == "error":
        exact = row["ratio"] == float("inf")
        return f"{where}: {peer} is " + ("exact" if exact else f"{row['ratio']:.3g} times nearer")
    if row.get("of") == "run time":  # ours over theirs
        return f"{where}: {peer} is faster by a factor of {_range(row)}"
    settings = f"at {row['at']} of {row['settings']} settings"
    if row["ratio"] is None:
        return f"{where}: {peer} reaches errors that we do not, {row['error']:.1g} ({settings})"
    return (
        f"{where}: {peer} is faster {settings}, with {_range(row)} of our time{_wide(row)} at "
        f"an error of {row['error']:.1g}"
    )


def _wide(row: Row) -> str:
    left = row.get(results.WIDE)
    return "" if left is None else f", {left:.2g} where XLA uses vectors of {results.WIDE},"


def _range(row: Row) -> str:
    low, high = row.get("from"), row.get("to")
    spread = "" if low is None else f" ({low:.2g} to {high:.2g})"
    return f"{row['ratio']:.2g}{spread}"
