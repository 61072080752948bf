"""Suzuki & Suzuki's chapter 1: the pendulum, its potential, its phase plane."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc

from .._pendulum import Pendulum
from ..plot import (
    colour_of,
    energy_levels,
    new_figure,
    phase_portrait,
    potential_energy,
    separatrix,
)
from ._entry import Entry

_ANGLE = np.radians(40)


def _sketch(torque: bool) -> Figure:
    figure = new_figure(4.6, 4.6)
    ax = figure.subplots()
    bob = np.array([np.sin(_ANGLE), -np.cos(_ANGLE)])
    ax.plot([-0.5, 0.5], [0, 0], color=colour_of("separatrix"), lw=5, solid_capstyle="butt")
    ax.plot([0, 0], [0, -1.15], color=colour_of("separatrix"), lw=1, ls=":")
    ax.plot(*np.stack([[0, 0], bob]).T, color=colour_of("law"), lw=2.5)
    ax.plot(*bob, "o", ms=20, color=colour_of("above"), zorder=3)
    degrees = np.degrees(_ANGLE)
    ax.add_patch(Arc((0, 0), 0.6, 0.6, theta1=-90, theta2=-90 + degrees, color=colour_of("law")))
    ax.annotate("θ", (0.13, -0.42), fontsize=13)
    ax.annotate("l", tuple(0.3 * bob + [0.05, 0.03]), fontsize=13)
    tangent = -np.array([np.cos(_ANGLE), np.sin(_ANGLE)])
    _force(ax, bob, bob - np.array([0, 0.45]), "mg", (8, 0), "below")
    _force(ax, bob, bob + 0.45 * np.sin(_ANGLE) * tangent, "mg sin θ", (-4, -16), "next")
    if torque:
        bow = {"arrowstyle": "-|>", "lw": 2.0, "color": colour_of("data"), "mutation_scale": 16}
        bow["connectionstyle"] = "arc3,rad=0.6"
        ax.annotate("", (0.3, -0.06), (-0.3, -0.06), arrowprops=bow)
        ax.annotate("torque T", (-0.42, -0.32), ha="center", color=colour_of("data"), fontsize=11)
        ax.annotate("drag η dθ/dt, against the motion", (0.05, -1.28), ha="center", fontsize=10)
    else:
        _force(ax, bob, bob - 0.5 * bob, "tension", (8, 8), "data")
    ax.set(xlim=(-0.75, 1.05), ylim=(-1.4, 0.12))
    ax.set_aspect("equal")
    ax.axis("off")
    return figure


def _force(ax: Axes, start, end, name: str, offset: tuple[int, int], colour: str) -> None:
    arrow = {"arrowstyle": "-|>", "lw": 2.2, "color": colour_of(colour), "mutation_scale": 16}
    ax.annotate("", tuple(end), tuple(start), arrowprops=arrow, zorder=4)
    ax.annotate(
        name, tuple(end), xytext=offset, textcoords="offset points", color=colour_of(colour),
        fontsize=11, ha="left" if offset[0] > 0 else "right",
    )  # fmt: skip


def _potential() -> Figure:
    figure = new_figure(7.5, 4.5)
    ax = potential_energy(figure.subplots(), Pendulum(), np.arange(0.5, 3.01, 0.5))
    ax.legend(loc="lower center")
    ax.set_ylim(-0.45, 3.2)
    return figure


def _separatrices() -> Figure:
    epsilon = np.array([0.25, 0.5, 1.0, 1.5, 2.0])
    theta = np.linspace(-np.pi, np.pi, 801)
    v = 2 * np.sqrt(epsilon)[:, None] * np.cos(theta / 2)
    around = np.concatenate([theta, theta[::-1]])
    figure = new_figure(6.8, 4.6)
    both = np.concatenate([v, -v[:, ::-1]], -1)
    phase_portrait(figure.subplots(), around, both, epsilon, name=r"$\varepsilon$ / s$^{-2}$")
    return figure


def _levels() -> Figure:
    figure = new_figure(7.5, 4.6)
    ax = figure.subplots()
    over = (-2 * np.pi, 2 * np.pi)
    energy_levels(ax, Pendulum(), np.arange(0.5, 3.51, 0.5), over=over)
    separatrix(ax, Pendulum(), over=over)
    ax.legend(title=r"$E$ / s$^{-2}$", loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


FORMULATION = (
    Entry("1", "a simple pendulum", lambda: _sketch(False)),
    Entry("2", "potential and energies E/ε", _potential),
    Entry("3", "the separatrix E = 2ε for several ε", _separatrices),
    Entry("4", "phase plane at ε = 1 1/s²", _levels),
    Entry("8.1", "a pendulum with an applied torque", lambda: _sketch(True)),
)
