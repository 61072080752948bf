"""A measured I–V loop: its branches, and where it leaves zero voltage."""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ._turns import turning_points

TURN = 0.02  # of the range of currents, that a turning point stands out by
LEVEL = 0.05  # of the largest voltage, below which it is zero


def rising(current: np.ndarray) -> np.ndarray:
    """Whether it rises, at each value, from turning point to turning point; noise is none."""
    up = np.empty(current.size, bool)
    for first, last in pairwise(turning_points(current, TURN)):
        up[first : last + 1] = current[last] > current[first]
    return up


class Crossings(NamedTuple):
    """Currents, A, at which |V| comes to, or falls to, a share of its largest; or NaN.

    Midway between two measured ones; `gap` is the largest distance of such two, A, and `jump`
    |V| after the first points beyond the switching current, V.
    """

    switching: tuple[float, float]  # from zero voltage, for I > 0 and I < 0
    retrapping: tuple[float, float]
    gap: float
    jump: float


def crossings(
    current: np.ndarray, voltage: np.ndarray, rising: np.ndarray, level: float = LEVEL
) -> Crossings:
    """Where a measured loop leaves zero voltage and returns to it; A, V, and its direction.

    `level`: of the largest voltage, what is taken for zero.
    """
    threshold, gaps, jumps = level * np.max(np.abs(voltage)), [0.0], [0.0]

    def at(sign: int, outwards: bool) -> float:
        # Outwards is rising where the current is positive.
        branch = (rising == (outwards == (sign > 0))) & (sign * current > 0)
        size = sign * current[branch]
        order = np.argsort(size, kind="stable")
        above = sign * voltage[branch][order] > threshold
        if above.all() or not above.any():
            return math.nan
        # As many above it before as below it after: single values are noise.
        split = np.argmin(np.cumsum(np.where(above, 1, -1)))
        low, high = size[order][[split, min(split + 1, above.size - 1)]]
        gaps.append(float(high - low))
        if outwards:
            after = order[split + 1 : split + 4]
            jumps.append(float(np.median(sign * voltage[branch][after])) if after.size else 0.0)
        return sign * float(0.5 * (low + high))

    found = (at(1, True), at(-1, True)), (at(1, False), at(-1, False))
    return Crossings(*found, max(gaps), max(jumps))
