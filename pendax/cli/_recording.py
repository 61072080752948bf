"""A recorded swing from a CSV file, and its cycles into one."""

import csv
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..fit import Cycles
from ._error import UserError

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
    rows = _rows(path)
    try:
        _, header = next(rows)
    except StopIteration:
        raise UserError(
            f"{path}: expected a header line and rows of numbers, but it is empty"
        ) from None
    i = _column(path, header, time, _TIME, "--time", "t_s")
    j = _column(path, header, angle, _ANGLE, "--angle", "theta_deg or theta_rad")
    unit = unit or next((u for u in _UNITS if header[j].lower().endswith("_" + u)), None)
    if unit is None:
        raise UserError(
            f"{path}: expected column {header[j]} to end in _deg or _rad, or --unit deg or rad"
        )

    ts, theta, last = [], [], -math.inf
    for line, row in rows:
        t, x = (_number(path, line, header, row, column) for column in (i, j))
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


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """(line number, stripped fields) of the lines that are not blank."""
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.reader(file)
            for row in reader:
                fields = [field.strip() for field in row]
                if any(fields):
                    yield reader.line_num, fields
    except OSError as error:
        raise UserError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise UserError(f"{path}: expected comma-separated text, but {error}") from None


def _column(
    path: Path, header: list[str], name: str | None, pattern: re.Pattern, option: str, like: str
) -> int:
    if name is not None:
        if name in header:
            return header.index(name)
        raise UserError(
            f"{path}: expected a column {name}, but the columns are {', '.join(header)}"
        )
    for i, column in enumerate(header):
        if pattern.match(column):
            return i
    raise UserError(
        f"{path}: expected a column like {like} (or {option} NAME), "
        f"but the columns are {', '.join(header)}"
    )


def _number(path: Path, line: int, header: list[str], row: list[str], column: int) -> float:
    text = row[column] if column < len(row) else ""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise UserError(
            f"{path}, line {line}: expected a number in column {header[column]}, but got {text!r}"
        )
    return value


def write_cycles(cycles: Cycles, path: Path) -> None:
    """One row a cycle: times in the unit of the recording, angles in rad."""
    names = ("start", "amplitude_rad", "period", "amplitude_error_rad", "period_error")
    np.savetxt(path, np.column_stack(cycles), "%.17g", ",", header=",".join(names), comments="")
