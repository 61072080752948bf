"""A recorded swing cut into cycles."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from jaxtyping import ArrayLike
from numpy.polynomial import Polynomial

# Fractions of the swing's amplitude, measured on encoder and video recordings:
NEAR_LEVEL = 0.4  # around a passage, where a cubic gives its time to 3e-6 of the period
NEAR_PEAK = 0.92  # around a turning point, where an even polynomial is good to 1e-5 of θ_max
SMALLEST = 0.02  # of the largest swing: a swing below it is rest
ENOUGH = 5  # samples for a fit; on coarse recordings the neighbourhood grows to hold them


class Cycles(NamedTuple):
    """One row a cycle, from one passage through the level of rest to the next but one.

    `start` and `period` have the unit of the times, `amplitude` that of the angles; it
    is half the distance of the two turning points within the cycle, whatever the
    offset of the angle.  `amplitude_error` has in it that a damped swing has no single
    amplitude: the half-step from one turning point to the next over √12.
    """

    start: np.ndarray
    amplitude: np.ndarray
    period: np.ndarray
    amplitude_error: np.ndarray
    period_error: np.ndarray


class _Estimate(NamedTuple):
    value: float
    error: float
    slope: float = 0.0


def cycles(ts: ArrayLike, theta: ArrayLike) -> Cycles:
    """A recording of a librating pendulum cut into cycles that do not overlap.

    **Arguments:** `ts`, times in increasing order, and `theta`, angles in any unit, one
    axis each.  Gaps are allowed: a passage through rest that falls into one is not
    used.  Eager only, the number of cycles depends on the data.

    **Returns:** [`Cycles`][], empty if the recording holds none.  Passages are located
    by a least-squares cubic through the samples within 0.4 of the amplitude, turning
    points by a polynomial of degree 4 to 8 through those above 0.92 of it; the errors
    are those of these fits.

    **Raises:** `ValueError` for times that do not increase, for values that are not
    finite, or for shapes other than one axis of equal length.
    """
    ts, theta = _checked(ts, theta)
    if ts.size < 4 or np.ptp(theta) == 0:
        return Cycles(*np.empty((5, 0)))
    swings, level = _swings(theta)
    step = np.median(np.diff(ts))
    crossings = [_crossing(ts, theta - level, a, b, step) for a, b in pairwise(swings)]
    peaks = [_peak(ts, theta - level, swing) for swing in swings]

    rows, i = [], 0
    while i + 2 < len(crossings):
        first, last = crossings[i], crossings[i + 2]
        one, two = peaks[i + 1], peaks[i + 2]
        if first is None or last is None:
            i += 1
            continue
        spread = abs(abs(one.value) - abs(two.value)) / np.sqrt(12)
        rows.append(
            (
                first.value,
                0.5 * abs(one.value - two.value),
                last.value - first.value,
                np.sqrt(0.25 * (one.error**2 + two.error**2) + spread**2),
                np.hypot(first.error, last.error),
            )
        )
        i += 2
    return Cycles(*np.array(rows).reshape(-1, 5).T)


def _checked(ts: ArrayLike, theta: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    ts, theta = np.asarray(ts, float), np.asarray(theta, float)
    if ts.ndim != 1 or ts.shape != theta.shape:
        raise ValueError(
            "Arguments `ts` and `theta` must have one axis of equal length, "
            f"but got shapes {ts.shape} and {theta.shape}."
        )
    for name, x in (("ts", ts), ("theta", theta)):
        if not np.isfinite(x).all():
            raise ValueError(f"Argument `{name}` must be finite, but got {x[~np.isfinite(x)][0]}.")
    back = np.flatnonzero(np.diff(ts) <= 0)
    if back.size:
        i = back[0]
        raise ValueError(f"Argument `ts` must increase, but got {ts[i + 1]} after {ts[i]}.")
    return ts, theta


def _swings(theta: np.ndarray) -> tuple[list[slice], float]:
    """Runs of samples clearly on one side of the level of rest, and that level.

    The level is the median of the turning points' weighted midpoints (a + 2 b + c) / 4,
    in which a constant loss per swing and a constant factor cancel to first order.
    """
    level = 0.5 * (theta.max() + theta.min())
    swings: list[slice] = []
    for _ in range(3):
        swings = _runs(theta - level)
        turns = np.array([_turning(theta - level, s) for s in swings]) + level
        if turns.size < 3:
            break
        level = float(np.median(0.25 * (turns[:-2] + 2 * turns[1:-1] + turns[2:])))
    return swings, level


def _runs(y: np.ndarray) -> list[slice]:
    """Samples beyond the threshold, cut where the sign changes."""
    noise = np.median(np.abs(np.diff(y, 3))) / (0.6745 * np.sqrt(20))
    threshold = max(SMALLEST * np.abs(y).max(), 4 * noise)
    far = np.flatnonzero(np.abs(y) > threshold)
    cuts = np.flatnonzero(np.diff(np.sign(y[far])) != 0)
    starts, stops = np.r_[far[:1], far[cuts + 1]], np.r_[far[cuts], far[-1:]]
    return [slice(int(a), int(b) + 1) for a, b in zip(starts, stops, strict=True)]


def _turning(y: np.ndarray, swing: slice) -> float:
    part = y[swing]
    return float(part[np.argmax(np.abs(part))])


def _crossing(
    ts: np.ndarray, y: np.ndarray, before: slice, after: slice, step: float
) -> _Estimate | None:
    """The time of the passage between two swings: the root of θ as a cubic in t."""
    reach = NEAR_LEVEL * min(abs(_turning(y, before)), abs(_turning(y, after)))
    first, last = before.stop - 1, after.start
    while first > before.start and (abs(y[first - 1]) < reach or last - first < ENOUGH - 1):
        first -= 1
    while last < after.stop - 1 and (abs(y[last + 1]) < reach or last - first < ENOUGH):
        last += 1
    near = slice(first, last + 1)
    if np.diff(ts[near]).max() > 2.5 * step:
        return None
    t, x = ts[near], y[near]
    roots = Polynomial.fit(t, x, _degree(x.size, 3)).roots()
    real = roots[np.isreal(roots)].real
    i = before.stop - 1 - near.start  # the passage lies between samples i and j
    j = after.start - near.start
    inside = real[(real >= t[i]) & (real <= t[j])]
    if inside.size != 1:
        return None
    there = _polynomial(t, x, 3, float(inside[0]))
    return _Estimate(float(inside[0]), abs(there.error / there.slope))


def _peak(ts: np.ndarray, y: np.ndarray, swing: slice) -> _Estimate:
    """The turning point of a swing: the extremum of θ as a polynomial in t."""
    t, part = ts[swing], y[swing]
    highest = int(np.argmax(np.abs(part)))
    near = np.abs(part) > NEAR_PEAK * abs(part[highest])
    near[max(highest - ENOUGH // 2, 0) : highest + ENOUGH // 2 + 1] = True
    t, x, here = t[near], part[near], t[highest]
    if x.size < 3:
        return _Estimate(float(part[highest]), float(abs(part[highest])))
    # Near π the top is as flat as a cosh: more samples carry a higher degree.
    most = 4 if x.size < 20 else 6 if x.size < 40 else 8
    roots = Polynomial.fit(t, x, _degree(x.size, most)).deriv().roots()
    real = roots[np.isreal(roots)].real
    inside = real[(real >= t[0]) & (real <= t[-1])]
    top = inside[np.argmin(np.abs(inside - here))] if inside.size else here
    return _polynomial(t, x, most, float(top))


def _degree(samples: int, most: int) -> int:
    """One sample to spare for the scatter."""
    return min(most, samples - 2)


def _polynomial(x: np.ndarray, y: np.ndarray, most: int, at: float) -> _Estimate:
    """Least-squares polynomial of y(x) read at a point, with its standard error and slope."""
    degree = _degree(x.size, most)
    span = max(float(np.ptp(x)), np.finfo(float).tiny)
    basis = np.vander((x - at) / span, degree + 1, increasing=True)
    mean = y.mean()
    solution, _, rank, _ = np.linalg.lstsq(basis, y - mean, rcond=None)
    scatter = basis @ solution - (y - mean)
    variance = scatter @ scatter / max(x.size - rank, 1)
    covariance = np.linalg.pinv(basis.T @ basis)
    error = float(np.sqrt(variance * covariance[0, 0]))
    return _Estimate(float(mean + solution[0]), error, float(solution[1] / span))
