"""Run times that can be compared: warmed up, blocked, interleaved."""

import math
import time
from collections.abc import Callable
from typing import NamedTuple

import jax
import numpy as np


class Timing(NamedTuple):
    """Seconds of one call, in the order of the rounds."""

    samples: tuple[float, ...]

    @property
    def median(self) -> float:
        return float(np.median(self.samples))

    @property
    def spread(self) -> float:
        """How far a run may lie from the median: the farthest did, relative."""
        low, high = min(self.samples), max(self.samples)
        return max(high / self.median, self.median / low) - 1

    def over(self, other: "Timing") -> dict[str, float]:
        """The ratio of two that were timed in turn, and the least and largest of the rounds'."""
        ratios = np.divide(self.samples, other.samples)
        return {
            "ratio": float(np.median(ratios)),
            "from": float(ratios.min()),
            "to": float(ratios.max()),
        }


_SHORT = 2e-3  # s: what takes less is called again and again, as a loop would, for its mean


def side_by_side(calls: dict[str, Callable], rounds: int) -> dict[str, Timing]:
    """Timings of each call, one of each in turn, after one to warm up."""
    spent: dict[str, list[float]] = {name: [] for name in calls}
    times = {}
    for name, call in calls.items():
        _seconds(call, 1)
        once = _seconds(call, 1)
        times[name] = min(200, max(1, math.ceil(_SHORT / once)))
        spent[name] += [once] * (times[name] == 1)
    while any(len(samples) < rounds for samples in spent.values()):
        for name, call in calls.items():
            if len(spent[name]) < rounds:
                spent[name].append(_seconds(call, times[name]))
    return {name: Timing(tuple(samples)) for name, samples in spent.items()}


def _seconds(call: Callable, times: int) -> float:
    """Of one of so many calls."""
    start = time.perf_counter()
    for _ in range(times):
        jax.block_until_ready(call())
    return (time.perf_counter() - start) / times


def compile_time(function: Callable, *arguments) -> float:
    """Seconds to trace and compile, no cache."""
    jax.clear_caches()
    start = time.perf_counter()
    jax.jit(function).lower(*arguments).compile()
    return time.perf_counter() - start
