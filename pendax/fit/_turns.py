"""Turning points that are more than noise."""

import numpy as np


def turning_points(x: np.ndarray, share: float) -> list[int]:
    """Where x turns, first and last index with them; noise stays below `share` of its range."""
    least = share * np.ptp(x)
    turns, low, high, way = [0], 0, 0, 0
    for k, value in enumerate(x):
        low = k if value < x[low] else low
        high = k if value > x[high] else high
        if way <= 0 and value - x[low] > least:
            turns += [low] if way else []
            way, high = 1, k
        elif way >= 0 and x[high] - value > least:
            turns += [high] if way else []
            way, low = -1, k
    return [*turns, x.size - 1]
