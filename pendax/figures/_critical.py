"""Figures 8 to 13 of Suzuki & Suzuki: ω(v0), θ_max(v0) and the critical law.

Those of ω take a sweep and, where there is a measurement, its cycles and fit.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from .._critical import Side
from .._exact import amplitude
from .._pendulum import Pendulum
from .._sweep import Sweep, sweep, velocities
from ..fit import Cycles, Fit
from ..plot import (
    colour_of,
    critical_approach,
    frequency_curve,
    law_deviation,
    measured_cycles,
    new_figure,
)
from ..plot._angle import angle_axis
from ._entry import Entry

Measured = tuple[Cycles, Fit[Pendulum]] | None


def _window(swept: Sweep, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """v0 and ω for low ≤ v0/√ε ≤ high."""
    x = swept.v0 / np.sqrt(swept.epsilon)
    inside = (x >= low) & (x <= high)
    return swept.v0[inside], swept.omega[inside]


def figure_8(swept: Sweep, measured: Measured = None) -> Figure:
    """ω(v0) below the separatrix, (a) whole, (b) and (c) ever nearer to it."""
    figure = new_figure(12.0, 4.0)
    axes = figure.subplots(1, 3)
    for ax, letter, low in zip(axes, "abc", (0.0, 1.9, 1.999), strict=True):
        frequency_curve(ax, *_window(swept, low, 2.0), swept.epsilon)
        ax.set(
            title=f"({letter})",
            ylim=(0, None),
            xticks=np.linspace(low, 2.0, 3 if letter == "c" else 5),
        )
        ax.ticklabel_format(useOffset=False)
    if measured:
        _points(axes[0], measured)
    axes[0].legend(loc="lower left")
    return figure


def figure_11(swept: Sweep, measured: Measured = None) -> Figure:
    """ω(v0) above the separatrix."""
    figure = new_figure(6.5, 4.5)
    ax = frequency_curve(figure.subplots(), *_window(swept, 2.0, 4.0), swept.epsilon)
    ax.set(ylim=(0, None))
    ax.legend(loc="lower right")
    return figure


def figure_13(swept: Sweep, measured: Measured = None) -> Figure:
    """ω(v0) on both sides, and the measured swing."""
    figure = new_figure(8.0, 5.0)
    ax = frequency_curve(figure.subplots(), swept.v0, swept.omega, swept.epsilon)
    if measured:
        _points(ax, measured)
    ax.set(xlim=(0, 4), ylim=(0, None))
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


def _approach(side: Side) -> Callable[[Sweep, Measured], Figure]:
    def draw(swept: Sweep, measured: Measured = None) -> Figure:
        """ω over the distance from the separatrix, and how far the law is from it."""
        root = np.sqrt(swept.epsilon)
        mask = (swept.below == (side == "lower")) & (swept.t > 0) & (swept.t < root)
        points = swept.t[mask], swept.omega[mask]
        figure = new_figure(11.0, 4.5)
        left, right = figure.subplots(1, 2)
        critical_approach(left, *points, side, swept.epsilon)
        law_deviation(right, *points, side, swept.epsilon).set_title("Where the law holds")
        right.legend(loc="upper left")
        return figure

    return draw


_ABOUT: dict[str, tuple[str, Callable[[Sweep, Measured], Figure]]] = {
    "8": ("ω(v0) below the separatrix, ever nearer to it", figure_8),
    "9": ("ω → 0 below the separatrix, and where the law holds", _approach("lower")),
    "11": ("ω(v0) above the separatrix", figure_11),
    "12": ("ω → 0 above the separatrix, and where the law holds", _approach("upper")),
    "13": ("ω(v0) across the separatrix", figure_13),
}


def critical_entries(swept: Callable[[], Sweep], measured: Measured = None) -> tuple[Entry, ...]:
    """The figures of ω(v0), of the sweep that `swept` gives."""

    def entry(name: str) -> Entry:
        about, draw = _ABOUT[name]
        return Entry(name, about, lambda: draw(swept(), measured))

    return tuple(entry(name) for name in _ABOUT)


def _amplitude() -> Figure:
    """θ_max(v0), the line of small angles, and the one that the source prints."""
    v0 = np.linspace(0, 2, 1001)
    figure = new_figure(6.8, 4.6)
    ax = figure.subplots()
    ax.plot(v0, amplitude(Pendulum(), v0), color=colour_of("above"),
            label=r"$2\,\arcsin(v_0/2\sqrt{\varepsilon})$")  # fmt: skip
    ax.plot(v0, v0, color=colour_of("below"), label=r"small angles, $v_0/\sqrt{\varepsilon}$")
    ax.plot(v0, 2 * v0, color=colour_of("separatrix"), ls=":",
            label=r"as printed, $2v_0/\sqrt{\varepsilon}$")  # fmt: skip
    ax.axvline(0.8, color=colour_of("separatrix"), lw=0.8)
    off = 100 * (1 - 0.8 / float(amplitude(Pendulum(), 0.8)))
    ax.annotate(f"{off:.1f} % apart at 0.8", (0.8, 0.3), xytext=(6, 0), textcoords="offset points")
    ax.set(xlabel=r"initial velocity $v_0$ / rad s$^{-1}$", ylabel=r"$\theta_{\max}$ / rad")
    ax.set(xlim=(0, 2), ylim=(0, 1.05 * np.pi))
    angle_axis(ax.yaxis)
    ax.legend(loc="upper left")
    return figure


@cache
def _unit_sweep() -> Sweep:
    return sweep(1.0, velocities(1.0, 20_000))


CRITICAL = (
    *critical_entries(_unit_sweep),
    Entry("10", "θ_max(v0) and the small-angle line, ε = 1 1/s²", _amplitude),
)
