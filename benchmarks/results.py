"""Results as JSON, with what they were measured on, and as tables."""

import json
import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

FOLDER = Path(__file__).parent / "results"
SEED = 1  # of what is kept
_PACKAGES = ("pendax", "jax", "jaxlib", "diffrax", "equinox", "numpy", "scipy", "heyoka")
_TIMES = ("ns", "µs", "ms", "s")  # columns of medians; "spread" beside them is relative
WIDE = "512 bits"  # vectors that XLA is told to use: `cores.widest`
# "at" so many settings a peer is faster, and how much of a lead remains beside wide vectors.
_SPREADS = ("spread", "from", "to", "at", WIDE)
_GENERATION = {"family": "cpu family", "model": "model"}  # as /proc/cpuinfo has them on x86
_ASSUMED = 0.5  # spread of a time that has none beside it
Row = dict[str, str | float | int | bool | None]
Tables = dict[str, list[Row]]


def as_it_comes(method: str) -> bool:
    """Whether it is pendax, in float64, with no options for XLA: what peers are compared with."""
    return method.startswith("pendax") and "float32" not in method and WIDE not in method


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


_elsewhere: list[Path] = []


def elsewhere(path: Path) -> None:
    """From now on results and figures go there."""
    _elsewhere.append(path)


def folder(quick: bool = False) -> Path:
    """Where results and figures go: those of quick runs and of other seeds are not kept in git."""
    return _elsewhere[-1] if _elsewhere else FOLDER / "quick" if quick else FOLDER


def write(name: str, tables: Tables, *, seed: int, quick: bool) -> Path:
    """`tables` into NAME.json, beside the machine, the versions and the settings."""
    from .peers import ABSENT

    folder(quick).mkdir(parents=True, exist_ok=True)
    path = folder(quick) / f"{name}.json"
    content = {
        **here(),
        "settings": {"seed": seed, "quick": quick},
        "absent": sorted(ABSENT),
        "tables": tables,
    }
    path.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return path


def here() -> dict[str, dict]:
    """This machine, and the versions of what is measured on it."""
    import jax

    return {
        "machine": {
            "device": jax.devices()[0].device_kind,
            "processor": _processor(),
            "cores": os.cpu_count(),
            "python": platform.python_version(),
        },
        "versions": {package: _version(package) for package in _PACKAGES},
    }


def moved(old: dict) -> list[str]:
    """In what this machine and its versions are others than those of `old`, a line each."""
    return [
        f"{key}: {was} → {now}"
        for part, values in here().items()
        for key, now in values.items()
        if now != (was := old.get(part, {}).get(key))
    ]


def read(name: str, folder: Path = FOLDER) -> dict:
    """What `write` wrote."""
    return json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))


def kept(name: str, settings: dict) -> dict | None:
    """What there is to compare with; where there is nothing of these settings, prints why."""
    path = folder(settings["quick"]) / f"{name}.json"
    try:
        known = read(name, path.parent)
        of, _ = known["settings"], known["tables"]
    except FileNotFoundError:
        print(f"{name}: nothing to compare with, there is no {path}")
    except (ValueError, LookupError, TypeError) as error:
        print(f"{name}: nothing to compare with, {path} is damaged ({error!r})")
    else:
        if of == settings:
            return known
        print(f"{name}: {path} is of {of}, not {settings}: measure that first")
    return None


def differ(old: Tables, new: Tables) -> tuple[int, int, int]:
    """Prints where two runs of one topic differ, and counts them: rows whose errors, or anything
    else that comes out the same again, do; rows of which only ratios leave the range that was
    stated; and those of which times alone, in seconds, leave theirs."""
    wrong = ratios = slow = 0
    for title in [*old, *(title for title in new if title not in old)]:
        before, after = old.get(title, []), new.get(title, [])
        if title == "losses":  # which there are is a matter of times
            names = [[_name(x) for x in rows] for rows in (before, after)]
            slow += names[0] != names[1]
            before = [x for x in before if _name(x) in names[1]]
            after = [x for x in after if _name(x) in names[0]]
        if len(before) != len(after):
            print(f"{title}: {len(before)} rows before, {len(after)} now")
            wrong += 1
        for was, now in zip(before, after, strict=False):
            off = [key for key in {**was, **now} if not _same(key, was, now)]
            if off:
                timed = all(_timed(key, was) for key in off)
                of_range = timed and not {"ratio", "measured"}.isdisjoint(off)
                of_range = of_range and not _in_seconds(was)
                wrong, ratios = wrong + (not timed), ratios + of_range
                slow += timed and not of_range
                changes = (f"{key} {_change(was.get(key), now.get(key))}" for key in off)
                word = "ratio" if of_range else "time" if timed else "DIFFERS"
                range_ = f" (from {was['from']:.3g} to {was['to']:.3g})" if of_range else ""
                print(f"{word}: {title}: {_name(was)}: {', '.join(changes)}{range_}")
    return wrong, ratios, slow


def _name(row: Row) -> str:
    return ", ".join(str(x) for x in row.values() if isinstance(x, str) and x)


def _in_seconds(row: Row) -> bool:
    """Whether it is a bar on a time."""
    return str(row.get("bar", "")).endswith((", s", ": s", "µs more"))


def _change(was, now) -> str:
    """To as many digits as tell the two apart."""
    short = [f"{x:.6g}" if isinstance(x, float) else str(x) for x in (was, now)]
    return " → ".join(short if short[0] != short[1] else (str(was), str(now)))


def _timed(key: str, row: Row) -> bool:
    """Whether it is a time or a ratio of times."""
    of_ratio = row.get("from") is not None and key in ("ratio", "measured", "verdict")
    return of_ratio or key in (*_TIMES, *_SPREADS) or key.endswith(tuple(f", {x}" for x in _TIMES))


def _same(key: str, was: Row, now: Row) -> bool:
    a, b = was.get(key), now.get(key)
    if key in _SPREADS or a == b or (a != a and b != b):
        return True
    if a is None or b is None or not _timed(key, was):
        return False
    if was.get("from") is not None and key in ("ratio", "measured", "verdict"):
        return key == "verdict" or was["from"] <= b <= was["to"]
    spread = was.get("spread", _ASSUMED) if key in _TIMES else _ASSUMED
    return max(a / b, b / a) <= 1 + spread


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
    """With family and model: the name alone may be that of several generations."""
    info = Path("/proc/cpuinfo")
    if not info.exists():
        return platform.processor() or platform.machine()
    first = info.read_text(encoding="utf-8").split("\n\n")[0]
    says = {k.strip(): v.strip() for k, _, v in (x.partition(":") for x in first.splitlines())}
    name = says.get("model name") or platform.machine()
    exact = [f"{key} {says[of]}" for key, of in _GENERATION.items() if of in says]
    return f"{name} ({', '.join(exact)})" if exact else name
