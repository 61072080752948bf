"""A measured I–V loop from a CSV file, and its branches."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..fit import rising
from ._error import UserError
from ._quantity import AMPERE, VOLT, factor
from ._table import column, number, open_table

_CURRENT = re.compile(r"(i|curr|current)([^a-z].*)?$", re.IGNORECASE)
_VOLTAGE = re.compile(r"([uv]|volt|voltage)([^a-z].*)?$", re.IGNORECASE)


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
