"""Run times that can be compared: warmed up, blocked, interleaved."""

import math
import time
from collections.abc import Callable
from typing import NamedTuple

import jax
import numpy as np

_ONCE = 0.5  # spread that is assumed of what was timed once
_OF_100 = 99  # medians of other runs that a stated spread should hold
# From run to run ratios of two times move as well: where programs come to lie in memory, what else
# the machine does.  The standard deviation of their logarithms, of 43 ratios in two whole runs on
# two shared cores, beyond what rounds tell.
_FROM_RUN_TO_RUN = 0.15


class Timing(NamedTuple):
    """Seconds of one call, in the order of the rounds.

    A spread says where the median of another run is to be expected.
    """

    samples: tuple[float, ...]

    @property
    def median(self) -> float:
        return float(np.median(self.samples))

    @property
    def spread(self) -> float:
        """How far from the median it may lie, relative."""
        low, high = expected(self.samples)
        return max(high / self.median, self.median / low) - 1

    def over(self, other: "Timing") -> dict[str, float]:
        """The ratio of two, and from where to where that of another run is to be expected.

        It is that of the rounds where both were timed in turn.
        """
        if (both := min(len(self.samples), len(other.samples))) > 1:
            ratios = np.divide(self.samples[:both], other.samples[:both])
            low, high = expected(ratios)
            return {"ratio": float(np.median(ratios)), "from": low, "to": high}
        off = (1 + self.spread) * (1 + other.spread)
        middle = self.median / other.median
        return {"ratio": middle, "from": middle / off, "to": middle * off}

    def in_every_round(self, other: "Timing") -> bool:
        """Whether it was faster in each: else they tie."""
        if (both := min(len(self.samples), len(other.samples))) > 1:
            return bool(np.all(np.less(self.samples[:both], other.samples[:both])))
        return self.over(other)["to"] < 1


def expected(values) -> tuple[float, float]:
    """Between which the median of as many other values is to be expected in 99 of 100 runs.

    By Student's t of the logarithms, whose median has the variance π σ²/(2 n), and what runs
    differ by; at least from the smallest to the largest of these.
    """
    from scipy.stats import norm, t

    count, median, tail = len(values), float(np.median(values)), 0.5 + _OF_100 / 200
    off = 1 + _ONCE
    if count > 1:
        of_rounds = t.ppf(tail, count - 1) * np.std(np.log(values), ddof=1) * np.sqrt(np.pi / count)
        off = np.exp(np.hypot(of_rounds, norm.ppf(tail) * _FROM_RUN_TO_RUN))
    return float(min(median / off, *values)), float(max(median * off, *values))


_SHORT = 2e-3  # s: what takes less is called again and again, as a loop would, for its mean
_CHEAP = 50e-3  # s: what takes less may have more rounds, and is warmed up in each


def side_by_side(calls: dict[str, Callable], rounds: int, of_cheap: int = 0) -> dict[str, Timing]:
    """Timings of each call, one of each in turn, after one to warm up.

    So many rounds, or `of_cheap` where a call is short and those are more.  Short ones are called
    once more in each turn, untimed: else they pay for what the one before them left, as memory that
    it gave back to the system, up to four times their own time in arrays of a million.
    """
    spent: dict[str, list[float]] = {name: [] for name in calls}
    times, most, warm = {}, {}, {}
    for name, call in calls.items():
        _seconds(call, 1)
        once = _seconds(call, 1)
        times[name] = min(200, max(1, math.ceil(_SHORT / once)))
        spent[name] += [once] * (times[name] == 1)
        warm[name] = once < _CHEAP
        most[name] = max(rounds, of_cheap) if warm[name] else rounds
    while any(len(samples) < most[name] for name, samples in spent.items()):
        for name, call in calls.items():
            if len(spent[name]) < most[name]:
                if warm[name]:
                    _seconds(call, 1)
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
