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
    """Times in the file's own unit, named `time_unit`, angles in rad, velocities in rad over it."""

    ts: np.ndarray
    theta: np.ndarray
    time_unit: str
    radians: float  # that the file's unit of angles has
    velocity: np.ndarray | None = None


def read_recording(
    path: Path,
    time: str | None = None,
    angle: str | None = None,
    unit: str | None = None,
    start: float = -math.inf,
    stop: float = math.inf,
    velocity: str | None = None,
) -> Recording:
    """Columns `time` and `angle` of a CSV file with a header line, from `start` to `stop`.

    Columns not named are found by their names: t or time, theta_deg or theta_rad and
    their like.  The unit of the angle is the ending of its name unless given, and that of a
    `velocity` column is that of the angle over that of the time.
    """
    header, rows = open_table(path)
    i = column(path, header, time, _TIME, "--time", "t_s")
    j = column(path, header, angle, _ANGLE, "--angle", "theta_deg or theta_rad")
    unit = unit or next((u for u in _UNITS if header[j].lower().endswith("_" + u)), None)
    if unit is None:
        raise UserError(
            f"{path}: expected column {header[j]} to end in _deg or _rad, or --unit deg or rad"
        )

    columns = [i, j]
    if velocity is not None:
        columns.append(column(path, header, velocity, _ANGLE, "--velocity", "omega"))

    found, last = [], -math.inf
    for line, row in rows:
        t, *values = (number(path, line, header, row, k) for k in columns)
        if t <= last:
            raise UserError(
                f"{path}, line {line}: expected {header[i]} to increase, but {row[i]} "
                f"follows {last:.12g}"
            )
        last = t
        if start <= t <= stop:
            found.append([t, *(x * _UNITS[unit] for x in values)])
    ts, theta, *speed = np.array(found).reshape(-1, len(columns)).T
    suffix = header[i].partition("_")[2]
    return Recording(ts, theta, suffix or "time units", _UNITS[unit], speed[0] if speed else None)


def write_cycles(cycles: Cycles, path: Path) -> None:
    """One row a cycle: times in the unit of the recording, angles in rad."""
    names = ("start", "amplitude_rad", "period", "amplitude_error_rad", "period_error")
    np.savetxt(path, np.column_stack(cycles), "%.17g", ",", header=",".join(names), comments="")
