"""What runs on all cores: references, which take longest of all, and peers with threads; and how
wide a core's vectors are."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import cache
from multiprocessing import get_context
from pathlib import Path

import numpy as np

COUNT = os.cpu_count() or 1


def widest() -> dict[str, int]:
    """XLA's option for vectors of 512 bits: it keeps to 256 where there are 512 if it is not told
    to take these.  Empty without AVX-512."""
    info = Path("/proc/cpuinfo")
    has = info.exists() and "avx512f" in info.read_text(encoding="utf-8")
    return {"xla_cpu_prefer_vector_width": 512} if has else {}


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
