"""Angles on an axis, in multiples of π."""

from fractions import Fraction

import numpy as np
from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, Locator

_STEPS = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0, 20.0, 50.0, 100.0)


class _Multiples(Locator):
    """Ticks at multiples of the finest of `_STEPS` turns that gives no more than `most`."""

    def __init__(self, most: int = 8):
        self.most = most

    def __call__(self):
        assert self.axis is not None
        return self.tick_values(*self.axis.get_view_interval())

    def tick_values(self, vmin, vmax):
        low, high = sorted((vmin / np.pi, vmax / np.pi))
        step = next((s for s in _STEPS if (high - low) / s <= self.most), (high - low) / self.most)
        return (
            np.pi * step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1)
        )


def _named(angle: float, position: int | None = None) -> str:
    turns = Fraction(angle / np.pi).limit_denominator(8)
    if turns == 0:
        return "0"
    sign, n, over = "−" if turns < 0 else "", abs(turns.numerator), turns.denominator
    return f"{sign}{n if n > 1 else ''}π" + (f"/{over}" if over > 1 else "")


def angle_axis(axis: Axis) -> None:
    """Ticks of an angle, rad, at multiples of π where the axis spans half a turn or more."""
    low, high = axis.get_view_interval()
    if abs(high - low) >= np.pi:
        axis.set_major_locator(_Multiples())
        axis.set_major_formatter(FuncFormatter(_named))
