"""What must not be in a compiled program.

XLA's text names the files that its operations come from: machinery that a scene has no use for,
diffrax's or the package's own, is found by them.
"""

import json
import subprocess
import sys
from collections.abc import Iterator

from .lean_hlo import Program
from .lean_programs import Question
from .results import Row

_EVENTS = ("_first_zero.py", "_switched.py", "_rest.py")
_DENSE = ("interpolation.py", "_solver/dopri8.py")
_FORBIDDEN = {
    "free": ("loops", "custom calls", "diffrax", "event machinery"),
    "first-order junction": ("loops", "custom calls", "diffrax", "event machinery"),
    "damped": ("custom calls", "diffrax", "event machinery", "the overdamped series"),
    "driven": ("custom calls", "diffrax", "event machinery", "the overdamped series"),
    "torque": ("custom calls", "diffrax", "event machinery", "the overdamped series"),
    "overdamped": ("custom calls", "diffrax", "event machinery"),
    "barely damped": ("custom calls", "diffrax", "event machinery", "the overdamped series"),
    "dry friction": ("custom calls", "diffrax", "the overdamped series"),
    "τ(t)": ("custom calls", "diffrax", "event machinery", "the overdamped series"),
    "τ(t) with kinks": ("custom calls", "event machinery", "the overdamped series"),
    "settle, damped": ("custom calls", "diffrax", "event machinery", "the overdamped series"),
    "settle, driven": ("custom calls", "diffrax", "event machinery", "the overdamped series"),
    "settle, dry": ("custom calls", "diffrax", "the overdamped series"),
    "settle, dry and damped": ("custom calls", "diffrax", "the overdamped series"),
}


def needless(question: Question, program: Program) -> Iterator[Row]:
    """What must not be there, and how often it is."""
    found = {
        "loops": len(program.trips),
        "custom calls": program.custom_calls,
        "diffrax": sum("/diffrax/" in x for x in program.sources),
        "event machinery": sum(x.endswith(_EVENTS) for x in program.sources),
        "the overdamped series": sum(x.endswith("_overdamped.py") for x in program.sources),
    }
    last = question.name == "final θ"
    for what in _FORBIDDEN[question.scene]:
        # At saved times diffrax has checks of its own, which call Python.
        where = " for a last state" if last and question.scene == "τ(t) with kinks" else ""
        yield {"scene": question.scene, "what": what + where, "count": found[what], "limit": 0}
    if (
        question.times is not None
        and question.many
        and not last
        and question.scene != "τ(t) with kinks"
    ):
        # The times as well, since a pendulum's own t0; diffrax has more copies of them.
        stored = program.carried(len(question.times) * question.lanes) - 1
        unasked = max(stored - (2 if question.name == "θ and v" else 1), 0)
        what = "trajectories stored beside those asked for"
        yield {"scene": question.scene, "what": what, "count": unasked, "limit": 0}
    if last:
        dense = sum(x.endswith(_DENSE) for x in program.sources)
        yield {"scene": question.scene, "what": "dense output", "count": dense, "limit": 0}
        # Stages of a step, terms of a series, a column for each direction; but no steps.
        columns = 1 + len(question.numbers) * question.gradient
        largest = program.largest / question.lanes / columns
        if question.lanes > 1:
            what = "largest array for a last state, numbers a pendulum and direction"
            yield {"scene": question.scene, "what": what, "count": largest, "limit": 32}


def gathered(rows: list[Row]) -> list[Row]:
    """The worst of the programs of a scene."""
    worst: dict = {}
    for row in rows:
        key = row["scene"], row["what"]
        if key not in worst or row["count"] > worst[key]["count"]:
            worst[key] = row
    return list(worst.values())


def imported() -> int:
    """Modules of diffrax after a run of each, in a process of its own."""
    script = """
import json, sys
import pendax
pendax.simulate(pendax.Pendulum(), 1.0, 1.3)
pendax.simulate(pendax.Pendulum(1.0, 0.1), 1.0, 1.3)
print(json.dumps(sum(name.split(".")[0] == "diffrax" for name in sys.modules)))
"""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)
