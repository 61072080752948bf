"""Results as JSON, with what they were measured on, and as tables."""

import json
import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

FOLDER = Path(__file__).parent / "results"
QUICK = FOLDER / "quick"  # not kept
_PACKAGES = ("pendax", "jax", "jaxlib", "diffrax", "equinox", "numpy", "scipy", "heyoka")
_TIMES = ("ns", "µs", "ms", "s")  # columns of medians; "spread" beside them is relative
_SPREADS = ("spread", "from", "to")
Row = dict[str, str | float | int | bool | None]
Tables = dict[str, list[Row]]


def bar(
    what: str,
    measured: float | Row,
    *,
    at_most: float | None = None,
    at_least: float | None = None,
) -> Row:
    """A row of the table "bars": what was aimed at, and whether it was met; NaN was skipped.

    `measured` is a number that comes out the same again, or a `Timing.over`.
    """
    if (at_most is None) == (at_least is None):
        raise ValueError(f"Either `at_most` or `at_least` of {what!r}.")
    spread = measured if isinstance(measured, dict) else {"from": None, "to": None}
    value = float(measured["ratio"] if isinstance(measured, dict) else measured)
    met = value <= at_most if at_most is not None else value >= at_least
    return {
        "bar": what,
        "measured": value,
        "from": spread["from"],
        "to": spread["to"],
        "limit": f"≤ {at_most:g}" if at_most is not None else f"≥ {at_least:g}",
        "verdict": "met" if met else "skipped" if value != value else "missed",
    }


def write(name: str, tables: Tables, *, seed: int, quick: bool) -> Path:
    """`tables` into results/NAME.json, beside the machine, the versions and the settings."""
    import jax

    folder = QUICK if quick else FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.json"
    content = {
        "machine": {
            "device": jax.devices()[0].device_kind,
            "processor": _processor(),
            "cores": os.cpu_count(),
            "python": platform.python_version(),
        },
        "versions": {package: _version(package) for package in _PACKAGES},
        "settings": {"seed": seed, "quick": quick},
        "tables": tables,
    }
    path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return path


def read(name: str, folder: Path = FOLDER) -> dict:
    """What `write` wrote."""
    return json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))


def differ(old: Tables, new: Tables) -> int:
    """Prints where two runs of one topic differ: in times and ratios by more than their spread,
    in anything else at all; the number of such rows."""
    count = 0
    for title in {*old, *new}:
        before, after = old.get(title, []), new.get(title, [])
        if len(before) != len(after):
            print(f"{title}: {len(before)} rows before, {len(after)} now")
            count += 1
        for was, now in zip(before, after, strict=False):
            off = [key for key in {*was, *now} if not _same(key, was, now)]
            if off:
                count += 1
                print(title, {key: (was.get(key), now.get(key)) for key in sorted(off)}, sep=": ")
    return count


def _same(key: str, was: Row, now: Row) -> bool:
    a, b = was.get(key), now.get(key)
    if key in _SPREADS or (a != a and b != b):
        return True
    if key in _TIMES:
        spread = 1 + max(was["spread"], now["spread"])
        return a == b or max(a / b, b / a) <= spread
    if was.get("from") is not None and key in ("ratio", "measured", "verdict"):
        overlap = now["from"] <= was["to"] and was["from"] <= now["to"]
        return key == "verdict" or overlap
    return a == b


def missed(tables: Tables) -> list[str]:
    return [str(row["bar"]) for row in tables.get("bars", []) if row["verdict"] == "missed"]


def markdown(rows: list[Row]) -> str:
    """A table, a column for every key of the first row; floats to two digits."""
    head = list(rows[0])
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(shown(row[name]) for name in head) + " |" for row in rows]
    return "\n".join(lines)


def shown(value) -> str:
    """A cell: floats to two digits, nothing for `None`."""
    if value is None:
        return ""
    if not isinstance(value, float) or value != value:
        return str(value)
    if 10 <= abs(value) < 10_000:
        return f"{float(f'{value:.2g}'):.0f}"
    return f"{value:.2g}"


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()
