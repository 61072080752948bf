"""What a scene's compiled program does: operations against a count on paper, loops, memory.

Operations are those of one time or one pendulum, in one step where there are steps; "distinct"
counts each once, "computed" as often as XLA's CPU backend does it, which computes again what
several results share rather than keep it.  On paper: `lean_paper`; nothing stands there for
what diffrax does in a step, for `settle` with dry friction, and for derivatives of the slow
overdamped motion, the dry one and the junction.  Trips of a loop are known to XLA, or a matter
of data.
"""

from collections.abc import Iterator

import jax.numpy as jnp

from . import lean_paper as paper
from .lean_absent import gathered, imported, needless
from .lean_hlo import ROOTS, TRANSCENDENTAL, Loop, Program
from .lean_programs import Question, compiled, free, junction, motions, seconds, settled
from .results import Row, Tables, bar

_MOST = 1.05  # times what is on paper
Read = list[tuple[Question, Program]]


def measure(seed: int, quick: bool) -> Tables:
    del seed  # nothing is drawn
    read: Read = []
    programs = []
    for question in _questions(quick):
        program, memory = compiled(question)
        read.append((question, program))
        programs.append(_row(question, program, memory))
    operations = [row for pair in read for row in _operations(*pair)]
    absent = [] if quick else _absent(read)
    unwanted = gathered([row for pair in read for row in needless(*pair)])
    bars = [
        bar(f"{_title(row)}: operations over paper", row["over paper"], at_most=_MOST)
        for row in operations
        if row["over paper"] is not None
    ]
    bars += [bar(f"{row['of']}, over paper", row["over paper"], at_least=0.95) for row in absent]
    bars += [
        bar(f"{_title(row)}: {row['what']}", row["count"], at_most=row["limit"]) for row in unwanted
    ]
    bars.append(bar("diffrax imported, by a free and a damped scene", imported(), at_most=0))
    tables = {"operations": operations, "programs": programs, "terms, where they are": absent}
    return tables | {"compile time": [_timed(x) for x in _timed_ones(quick)], "bars": bars}


def _questions(quick: bool) -> Iterator[Question]:
    if quick:
        yield from (x for x in free()[:8:2])
        yield motions("damped", 10.0, beta=0.1)[3]
        return
    yield from free()
    yield from junction()
    yield from motions("damped", 10.0, beta=0.1)
    yield from motions("driven", 10.0, beta=0.1, tau=0.5)[2:]
    yield from motions("torque", 10.0, tau=0.5)[2:]
    yield from motions("overdamped", 10.0, beta=1e3)[2:]
    yield from motions("dry friction", 10.0, dry=0.05)[2:]
    yield from motions("τ(t)", 10.0, _wave, beta=0.1)[2:]
    yield from motions("τ(t) with kinks", 10.0, lambda t: abs(_wave(t)), beta=0.1)[2:]
    # Averaging takes longest to compile, its derivatives minutes: those are left out.
    yield motions("barely damped", 1e6, lanes=1, beta=1e-6)[3]
    yield settled("settle, damped", beta=0.1)
    yield settled("settle, driven", beta=0.1, tau=0.05)
    yield settled("settle, dry", dry=0.05)
    yield settled("settle, dry and damped", beta=0.1, dry=0.05)


def _wave(t):
    return 0.5 * jnp.cos(t)


def _timed_ones(quick: bool) -> list[Question]:
    closed, damped = free(), motions("damped", 10.0, beta=0.1)
    if quick:
        return [closed[0]]
    others = [
        motions("overdamped", 10.0, beta=1e3),
        motions("dry friction", 10.0, dry=0.05),
        motions("τ(t)", 10.0, _wave, beta=0.1),
        motions("τ(t) with kinks", 10.0, lambda t: abs(_wave(t)), beta=0.1),
    ]
    final = [x for asked in (damped, *others) for x in asked[3:]]
    last = settled("settle, damped", beta=0.1)
    return [*closed[4:6], *closed[8:], *junction()[4:], *final, last]


def _names(question: Question) -> Row:
    return {
        "scene": question.scene,
        "asked": question.name,
        "gradient": "yes" if question.gradient else "",
    }


def _title(row: Row) -> str:
    parts = (row["scene"], row.get("asked"), row.get("part"), row.get("gradient") and "gradient")
    return ", ".join(str(x) for x in parts if x)


def _timed(question: Question) -> Row:
    timing = seconds(question)
    return _names(question) | {"s": timing.median, "spread": timing.spread}


def _row(question: Question, program: Program, memory) -> Row:
    """The whole program; bytes of all its times or pendulums."""
    trips = ", ".join("data" if n is None else str(n) for n in program.trips)
    return _names(question) | {
        "elements": question.lanes,
        "loops": len(program.trips),
        "trips": trips,
        "bytes in": memory.argument_size_in_bytes,
        "out": memory.output_size_in_bytes,
        "between": memory.temp_size_in_bytes,
    }


def _operations(question: Question, program: Program) -> Iterator[Row]:
    """A row for a program without steps, else for each kind of step; none for averaging, whose
    loops are those of tables."""
    if question.scene == "barely damped":
        return
    steps = [x for x in program.loops if x.total("computed")]
    if not steps:
        yield _counted(question, "", program.outside, _on_paper(question, 0))
    for i, loop in enumerate(steps):
        part = f"loop {i + 1}" if len(steps) > 1 else "step"
        yield _counted(question, part, loop, _on_paper(question, i))


def _counted(question: Question, part: str, loop: Loop, expected: int | None) -> Row:
    distinct = loop.total()
    return _names(question) | {
        "part": part,
        "on paper": expected,
        "distinct": distinct,
        "over paper": None if expected is None else distinct / expected,
        "computed": loop.total("computed"),
        "transcendental": loop.total("distinct", TRANSCENDENTAL),
        "roots": loop.total("distinct", ROOTS),
    }


def _on_paper(question: Question, part: int) -> int | None:
    directions = len(question.numbers) if question.gradient else 0
    terms = {"beta": "beta" in question.numbers, "tau": "tau" in question.numbers}
    match question.scene:
        case "free":
            return (paper.FREE_GRADIENT if question.gradient else paper.FREE)[question.name]
        case "first-order junction":
            return None if question.gradient else paper.JUNCTION[question.name]
        case "damped" | "driven" | "torque":
            return paper.step(**terms, directions=directions)
        case "τ(t)":
            return paper.step(**terms, wave=True, directions=directions)
        case "overdamped" if part == 0:  # until v has relaxed
            return paper.step(beta=True, directions=directions)
        case "overdamped":
            return None if question.gradient else paper.slow_step()
        case "dry friction":
            return None if question.gradient else paper.rubbing_step()
        case "settle, damped" | "settle, driven":
            return paper.settling_step(**terms)
    return None


def _absent(read: Read) -> list[Row]:
    """What a term adds to a step: as much as on paper, unless it is there without being asked."""

    def step(scene: str) -> int:
        found = (p for q, p in read if q.scene == scene and q.name in ("final θ", "well"))
        return next(found).loops[-1].total()

    beta, tau = {"beta": True}, {"tau": True}
    settling, order = paper.settling_step(), paper.RUBBING_TO_REST
    pairs = [
        ("β in a step", "driven", "torque", paper.step(**beta) - paper.step()),
        ("τ in a step", "driven", "damped", paper.step(**tau) - paper.step()),
        (
            "τ in `settle`",
            "settle, driven",
            "settle, damped",
            paper.settling_step(**tau) - settling,
        ),
        (
            "β in `settle`, dry friction",
            "settle, dry and damped",
            "settle, dry",
            paper.step(order, **beta) - paper.step(order),
        ),
    ]
    return [
        {
            "of": of,
            "with it": step(present),
            "without": step(absent),
            "on paper": expected,
            "over paper": (step(present) - step(absent)) / expected,
        }
        for of, present, absent, expected in pairs
    ]
