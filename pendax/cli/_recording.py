"""A recorded swing from a CSV file, and its cycles into one."""

import math
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..fit import Cycles
from ._error import UserError
from ._table import column, number, open_table

_TIME = re.compile(r"(t|time)(_.*)?$", re.IGNORECASE)
_ANGLE = re.compile(r"(theta|angle).*", re.IGNORECASE)
_UNITS = {"rad": 1.0, "deg": math.pi / 180}


class Recording(NamedTuple):
    """Times in the file's own unit, named `time_unit`, and angles in rad."""

    ts: np.ndarray
    theta: np.ndarray
    time_unit: str


def read_recording(
    path: Path,
    time: str | None = None,
    angle: str | None = None,
    unit: str | None = None,
    start: float = -math.inf,
) -> Recording:
    """Columns `time` and `angle` of a CSV file with a header line, from `start` on.

    Columns not named are found by their names: t or time, theta_deg or theta_rad and
    their like.  The unit of the angle is the ending of its name unless given.
    """
    header, rows = open_table(path)
    i = column(path, header, time, _TIME, "--time", "t_s")
    j = column(path, header, angle, _ANGLE, "--angle", "theta_deg or theta_rad")
    unit = unit or next((u for u in _UNITS if header[j].lower().endswith("_" + u)), None)
    if unit is None:
        raise UserError(
            f"{path}: expected column {header[j]} to end in _deg or _rad, or --unit deg or rad"
        )

    ts, theta, last = [], [], -math.inf
    for line, row in rows:
        t, x = (number(path, line, header, row, k) for k in (i, j))
        if t <= last:
            raise UserError(
                f"{path}, line {line}: expected {header[i]} to increase, but {row[i]} "
                f"follows {last:.12g}"
            )
        last = t
        if t >= start:
            ts.append(t)
            theta.append(x * _UNITS[unit])
    suffix = header[i].partition("_")[2]
    return Recording(np.array(ts), np.array(theta), suffix or "time units")


def write_cycles(cycles: Cycles, path: Path) -> None:
    """One row a cycle: times in the unit of the recording, angles in rad."""
    names = ("start", "amplitude_rad", "period", "amplitude_error_rad", "period_error")
    np.savetxt(path, np.column_stack(cycles), "%.17g", ",", header=",".join(names), comments="")
