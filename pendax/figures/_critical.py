"""Figures 8, 9, 11, 12 and 13 of Suzuki & Suzuki: ω(v0) and its critical law.

Each takes the sweep and, where there is a measurement, its cycles and fit, and returns
a matplotlib `Figure`.
"""

from collections.abc import Callable
from functools import wraps

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from .._critical import Side
from .._pendulum import Pendulum
from .._sweep import Sweep
from ..fit import Cycles, Fit
from ..plot import (
    STYLE,
    critical_approach,
    frequency_curve,
    law_deviation,
    measured_cycles,
    new_figure,
)

Measured = tuple[Cycles, Fit[Pendulum]] | None


def _styled(draw: Callable[[Sweep, Measured], Figure]) -> Callable[[Sweep, Measured], Figure]:
    @wraps(draw)
    def styled(swept: Sweep, measured: Measured = None) -> Figure:
        with mpl.rc_context(STYLE):
            return draw(swept, measured)

    return styled


def _window(swept: Sweep, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """v0 and ω for low ≤ v0/√ε ≤ high."""
    x = swept.v0 / np.sqrt(swept.epsilon)
    inside = (x >= low) & (x <= high)
    return swept.v0[inside], swept.omega[inside]


@_styled
def figure_8(swept: Sweep, measured: Measured) -> Figure:
    """ω(v0) below the separatrix, (a) whole, (b) and (c) ever nearer to it."""
    figure = new_figure(12.0, 4.0)
    axes = figure.subplots(1, 3)
    for ax, letter, low in zip(axes, "abc", (0.0, 1.9, 1.999), strict=True):
        frequency_curve(ax, *_window(swept, low, 2.0), swept.epsilon)
        ax.set(
            title=f"Figure 8({letter}): below the separatrix",
            ylim=(0, None),
            xticks=np.linspace(low, 2.0, 3 if letter == "c" else 5),
        )
        ax.ticklabel_format(useOffset=False)
    if measured:
        _points(axes[0], measured)
    axes[0].legend(loc="lower left")
    return figure


@_styled
def figure_11(swept: Sweep, measured: Measured) -> Figure:
    """ω(v0) above the separatrix."""
    figure = new_figure(6.5, 4.5)
    ax = frequency_curve(figure.subplots(), *_window(swept, 2.0, 4.0), swept.epsilon)
    ax.set(ylim=(0, None), title="Figure 11: above the separatrix")
    ax.legend(loc="lower right")
    return figure


@_styled
def figure_13(swept: Sweep, measured: Measured) -> Figure:
    """ω(v0) on both sides, and the measured swing."""
    figure = new_figure(8.0, 5.0)
    ax = frequency_curve(figure.subplots(), swept.v0, swept.omega, swept.epsilon)
    if measured:
        _points(ax, measured)
    ax.set(xlim=(0, 4), ylim=(0, None), title="Figure 13: across the separatrix")
    ax.legend(loc="upper left")
    return figure


def _points(ax, measured: tuple[Cycles, Fit[Pendulum]]) -> None:
    found, fit = measured
    measured_cycles(
        ax,
        found.amplitude,
        found.period,
        float(fit.model.epsilon),
        found.amplitude_error,
        found.period_error,
    )


def _approach(number: int, side: Side) -> Callable[[Sweep, Measured], Figure]:
    @_styled
    def draw(swept: Sweep, measured: Measured) -> Figure:
        """ω over the distance from the separatrix, and how far the law is from it."""
        root = np.sqrt(swept.epsilon)
        mask = (swept.below == (side == "lower")) & (swept.t > 0) & (swept.t < root)
        points = swept.t[mask], swept.omega[mask]
        figure = new_figure(11.0, 4.5)
        left, right = figure.subplots(1, 2)
        critical_approach(left, *points, side, swept.epsilon).set_title(
            f"Figure {number}: ω → 0 at the separatrix"
        )
        law_deviation(right, *points, side, swept.epsilon).set_title("Where the law holds")
        right.legend(loc="upper left")
        return figure

    return draw


CRITICAL: dict[str, Callable[[Sweep, Measured], Figure]] = {
    "8": figure_8,
    "9": _approach(9, "lower"),
    "11": figure_11,
    "12": _approach(12, "upper"),
    "13": figure_13,
}
