"""References on all cores: those of one point after the other take longest of all."""

import multiprocessing
from collections.abc import Callable, Iterable


def each(function: Callable, rows: Iterable[Iterable[float]], *, worth: int = 40) -> list:
    """`function` of every row of floats; below `worth` rows here, as new processes take longer."""
    rows = [tuple(map(float, row)) for row in rows]
    if len(rows) < worth:
        return list(map(function, rows))
    with multiprocessing.get_context("spawn").Pool() as pool:
        return pool.map(function, rows, chunksize=max(1, len(rows) // 50))
