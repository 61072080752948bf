"""Errors and run times of methods at the same work, and where another one is ahead of pendax."""

import time
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import jax

from . import results
from .timing import Timing, expected

_UNITS = {"ns": 1e9, "µs": 1e6, "ms": 1e3, "s": 1.0}


class Point(NamedTuple):
    work: str
    method: str
    timing: Timing
    error: float | None  # None: it is not compared
    setting: str = ""

    @property
    def ours(self) -> bool:
        return self.method.startswith("pendax")


def once(call: Callable) -> tuple[Timing, Any]:
    """Of what is too slow to be repeated: the time of its first call, and what it gave."""
    start = time.perf_counter()
    value = jax.block_until_ready(call())
    return Timing((time.perf_counter() - start,)), value


def an_element(timing: Timing, elements: int) -> Timing:
    return Timing(tuple(x / elements for x in timing.samples))


def spent(timing: Timing, unit: str, elements: float = 1) -> results.Row:
    """The columns of a run time, of one of so many elements."""
    return {unit: timing.median / elements * _UNITS[unit], "spread": timing.spread}


def seconds(timing: Timing) -> results.Row:
    """For a bar on a run time: as `Timing.over`, over one second."""
    low, high = expected(timing.samples)
    return {"ratio": timing.median, "from": low, "to": high}


def losses(points: Iterable[Point], why: dict[str, str]) -> list[results.Row]:
    """Where a peer takes less time for no larger an error, or as little for a smaller one, and no
    setting of ours is ahead of it in turn.  `why` by the work, or by "work, peer"."""
    rows = []
    # float32's errors are of another eps.
    points = [x for x in points if x.error is not None and "float32" not in x.method]
    for peer in points:
        rivals = [x for x in points if results.as_it_comes(x.method) and x.work == peer.work]
        if peer.ours or any(_ahead(x, peer) for x in rivals):
            continue
        for ours in rivals:
            if _ahead(peer, ours):
                reason = why.get(f"{peer.work}, {peer.method}", why.get(peer.work, "unexplained"))
                rows.append(
                    {
                        "where": ", ".join(filter(None, (ours.work, ours.setting))),
                        "peer": ", ".join(filter(None, (peer.method, peer.setting))),
                        "of": "run time",
                        **ours.timing.over(peer.timing),
                        "why": reason,
                    }
                )
    return rows


def error_loss(where: str, peer: str, ours: float, theirs: float, why: str) -> results.Row:
    """A row beside those of `losses`, of errors alone."""
    return {
        "where": where,
        "peer": peer,
        "of": "error",
        "ratio": ours / theirs if theirs else float("inf"),
        "from": None,
        "to": None,
        "why": why,
    }


def _ahead(a: Point, b: Point) -> bool:
    if a.error == b.error:
        return a.timing.in_every_round(b.timing)
    return a.error < b.error and b.timing.over(a.timing)["ratio"] > 1
