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
        "--verify` measures again and compares. Times are medians of rounds in turn, each method "
        "warmed up and blocked; *spread* is how far a round lay from the median, relative, and 0.5 "
        "where there was one round; *from* and *to* are the least and largest ratio of a round.",
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
        )
        if (results.FOLDER / f"{name}.png").exists():
            parts.append(f"![{name}](results/{name}.png)")
        for title, rows in content["tables"].items():
            if title == "losses":
                parts.append(losses(content["tables"]))
            elif rows and len(rows) < _POINTS:
                parts.append(f"### {title}\n\n{results.markdown(rows)}")
            elif rows:
                parts.append(f"### {title}\n\n{len(rows)} points: results/{name}.json.")
    return "\n\n".join(parts) + "\n"


def losses(tables: Tables) -> str:
    """Where a peer is ahead, in words, what has one reason together."""
    rows = tables.get("losses", [])
    if not rows:
        return "No peer was ahead anywhere."
    reasons: dict = {}
    for row in rows:
        reasons.setdefault(row["why"], []).append(_loss(row))
    lines = [f"- {'; '.join(where)}. {why[:1].upper()}{why[1:]}." for why, where in reasons.items()]
    return "\n".join(["Where a peer is ahead:", "", *lines])


def _loss(row: Row) -> str:
    where, peer = row.get("problem") or row.get("where"), row["peer"]
    if row.get("of") == "error":
        return f"{where}: {peer} is nearer by a factor of {row['ratio']:.2g}"
    if row.get("of") == "run time":  # ours over theirs
        return f"{where}: {peer} is faster by a factor of {_range(row)}"
    if not row["ratio"]:
        return f"{where}: {peer} reaches {row['error']:.1g}, which we do not"
    return f"{where}, error {row['error']:.1g}: {peer} takes {_range(row)} of our time"


def _range(row: Row) -> str:
    low, high = row.get("from"), row.get("to")
    spread = "" if low is None else f" ({low:.2g} to {high:.2g})"
    return f"{row['ratio']:.2g}{spread}"
