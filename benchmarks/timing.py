"""Run times that can be compared: warmed up, blocked, interleaved."""

import time
from collections.abc import Callable
from typing import NamedTuple

import jax
import numpy as np


class Row(NamedTuple):
    work: str
    library: str
    seconds: float  # an element
    error: float | None  # largest, in eps × scale


def side_by_side(calls: dict[str, Callable], rounds: int) -> dict[str, float]:
    """Median seconds of each call, one of each in turn, after one to warm up."""
    spent: dict[str, list[float]] = {name: [] for name in calls}
    for call in calls.values():
        jax.block_until_ready(call())
    for _ in range(rounds):
        for name, call in calls.items():
            start = time.perf_counter()
            jax.block_until_ready(call())
            spent[name].append(time.perf_counter() - start)
    return {name: float(np.median(times)) for name, times in spent.items()}


def compile_time(function: Callable, *arguments) -> float:
    """Seconds to trace and compile, no cache."""
    jax.clear_caches()
    start = time.perf_counter()
    jax.jit(function).lower(*arguments).compile()
    return time.perf_counter() - start
