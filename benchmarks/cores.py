"""What runs on all cores: references, which take longest of all, and peers with threads."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import cache
from multiprocessing import get_context

import numpy as np

COUNT = os.cpu_count() or 1


def each(function: Callable, rows: Iterable[Iterable[float]], *, worth: int = 40) -> list:
    """`function` of every row of floats; below `worth` rows here, as handing over takes longer."""
    rows = [tuple(map(float, row)) for row in rows]
    if len(rows) < worth:
        return list(map(function, rows))
    return list(_processes().map(function, rows, chunksize=max(1, len(rows) // 50)))


def shared(work: Callable, workers: list, rows: np.ndarray) -> list:
    """What `work(worker, its rows)` found, of all workers, each in a thread; a single row here,
    as handing it over takes longer."""
    if len(rows) == 1:
        return work(workers[0], rows)
    shares = np.array_split(rows, len(workers))
    return [x for found in _threads().map(work, workers, shares) for x in found]


@cache
def _threads() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(COUNT)


@cache
def _processes() -> ProcessPoolExecutor:
    # Not forked: JAX has threads.  Kept: they take seconds to begin.
    return ProcessPoolExecutor(COUNT, get_context("spawn"))
