"""A CSV file with a header line, row by row; what is wrong with it, by line."""

import csv
import math
import re
from collections.abc import Iterator
from pathlib import Path

from ._error import UserError

Rows = Iterator[tuple[int, list[str]]]


def open_table(path: Path) -> tuple[list[str], Rows]:
    """The header, and (line number, fields) of the lines after it that are not blank."""
    rows = _rows(path)
    try:
        _, header = next(rows)
    except StopIteration:
        raise UserError(
            f"{path}: expected a header line and rows of numbers, but it is empty"
        ) from None
    return header, rows


def _rows(path: Path) -> Rows:
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


def column(
    path: Path, header: list[str], name: str | None, pattern: re.Pattern, option: str, like: str
) -> int:
    if name is not None:
        if name in header:
            return header.index(name)
        raise UserError(
            f"{path}: expected a column {name}, but the columns are {', '.join(header)}"
        )
    for i, title in enumerate(header):
        if pattern.match(title):
            return i
    raise UserError(
        f"{path}: expected a column like {like} (or {option} NAME), "
        f"but the columns are {', '.join(header)}"
    )


def number(path: Path, line: int, header: list[str], row: list[str], column: int) -> float:
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
