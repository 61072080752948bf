"""Numbers with units: `112.5uA`, `8 ohm`, `0.4pF`, and the units of a file's columns."""

import argparse
import math
import re
from collections.abc import Callable

PREFIXES = {"": 1.0, "p": 1e-12, "n": 1e-9, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "m": 1e-3,
            "k": 1e3, "M": 1e6, "G": 1e9, "f": 1e-15}  # fmt: skip

# What a unit may be called.
AMPERE = ("A", "amp", "ampere", "amperes")
VOLT = ("V", "volt", "volts")
OHM = ("ohm", "Ohm", "Ω", "ohms")
FARAD = ("F", "farad", "farads")

_NUMBER = re.compile(r"([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(\S*)$")


def factor(unit: str, names: tuple[str, ...]) -> float | None:
    """What a `unit` such as mV is worth in that of `names`, or None."""
    for name in names:
        if unit.endswith(name) and unit[: -len(name)] in PREFIXES:
            return PREFIXES[unit[: -len(name)]]
    return None


def positive(names: tuple[str, ...]) -> Callable[[str], float]:
    """For argparse: a positive number of that unit, or with its own."""

    def parse(text: str) -> float:
        found = _NUMBER.match(text.strip())
        digits, unit = found.groups() if found else ("nan", "")
        scale = factor(unit or names[0], names)
        try:
            value = math.nan if scale is None else scale * float(digits)
        except ValueError:
            value = math.nan
        if not 0 < value < math.inf:
            raise argparse.ArgumentTypeError(
                f"expected a positive number in {names[0]}, or with a unit as 2.5m{names[0]}, "
                f"but got {text!r}"
            )
        return value

    return parse
