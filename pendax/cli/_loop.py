"""A measured I–V loop from a CSV file, and its branches."""

import math
import re
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ._error import UserError
from ._quantity import AMPERE, VOLT, factor
from ._table import column, number, open_table

_CURRENT = re.compile(r"(i|curr|current)([^a-z].*)?$", re.IGNORECASE)
_VOLTAGE = re.compile(r"([uv]|volt|voltage)([^a-z].*)?$", re.IGNORECASE)
_TURN = 0.02  # of the range of currents, that a turning point stands out by


class Loop(NamedTuple):
    """Currents, A, voltages, V, in the order of the file; whether the current rises there."""

    current: np.ndarray
    voltage: np.ndarray
    rising: np.ndarray


def read_loop(
    path: Path,
    current: str | None = None,
    voltage: str | None = None,
    current_unit: str | None = None,
    voltage_unit: str | None = None,
) -> Loop:
    """Columns `current` and `voltage` of a CSV file with a header line.

    Columns not named are found by their names, I or current and V or voltage, with a unit
    after them, as I_amp, V (mV), U/V; a unit that is given counts.
    """
    header, rows = open_table(path)
    i = column(path, header, current, _CURRENT, "--current", "I_A")
    j = column(path, header, voltage, _VOLTAGE, "--voltage", "V_mV")
    amperes = _unit(path, header[i], current_unit, AMPERE, "--current-unit")
    volts = _unit(path, header[j], voltage_unit, VOLT, "--voltage-unit")
    found = [[number(path, line, header, row, k) for k in (i, j)] for line, row in rows]
    if len(found) < 3:
        raise UserError(f"{path}: expected three or more rows, but found {len(found)}")
    measured = np.array(found).T
    x, y = measured[0] * amperes, measured[1] * volts
    if not np.ptp(x) > 0:
        raise UserError(f"{path}: expected a current that is swept, but it is {x[0]:g} A always")
    return Loop(x, y, rising(x))


def _unit(path: Path, title: str, unit: str | None, names: tuple[str, ...], option: str) -> float:
    last = re.split(r"[_\s/(\[]+", title.strip(" )]"))[-1] if unit is None else unit
    scale = factor(last, names)
    if scale is None:
        raise UserError(
            f"{path}: expected column {title} to end in a unit such as _m{names[0]}, "
            f"or {option} m{names[0]}"
            if unit is None
            else f"{option}: expected a unit such as m{names[0]}, but got {unit!r}"
        )
    return scale


def rising(x: np.ndarray) -> np.ndarray:
    """Whether x rises, at each value, from turning point to turning point; noise is none."""
    least = _TURN * np.ptp(x)
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
    ends = [*turns, x.size - 1]
    up = np.empty(x.size, bool)
    for first, last in pairwise(ends):
        up[first : last + 1] = x[last] > x[first]
    return up


class Crossings(NamedTuple):
    """Currents, A, at which |V| comes to, or falls to, a twentieth of its largest; or NaN."""

    switching: tuple[float, float]  # from zero voltage, for I > 0 and I < 0
    retrapping: tuple[float, float]


def crossings(loop: Loop) -> Crossings:
    threshold = 0.05 * np.max(np.abs(loop.voltage))

    def at(sign: int, outwards: bool) -> float:
        # Outwards is rising where the current is positive.
        branch = (loop.rising == (outwards == (sign > 0))) & (sign * loop.current > 0)
        size, voltage = sign * loop.current[branch], sign * loop.voltage[branch]
        order = np.argsort(size, kind="stable")
        above = voltage[order] > threshold
        if above.all() or not above.any():
            return math.nan
        # As many above it before as below it after: single values are noise.
        split = np.argmin(np.cumsum(np.where(above, 1, -1)))
        return sign * float(size[order][min(split + 1, above.size - 1)])

    return Crossings(
        (at(1, True), at(-1, True)),
        (at(1, False), at(-1, False)),
    )
