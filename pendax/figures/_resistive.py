"""Suzuki & Suzuki's chapter 7: the resistive pendulum."""

import numpy as np
from matplotlib.figure import Figure

from .._fixed_points import FixedPointKind, fixed_points
from .._pendulum import Pendulum
from .._simulate import simulate
from ..plot import colour_of, new_figure, phase_portrait, separatrix, time_series
from ._data import damped
from ._entry import Entry

_BETA = r"$\beta$ / s$^{-1}$"


def _angles() -> Figure:
    beta = [0.01, 0.012, 0.014, 0.016, 0.018, 0.02, 0.04, 0.08, 0.12, 0.16]
    figure = new_figure(7.2, 4.6)
    ts, theta, _ = damped(2.3, beta, 0.0, 150.0)
    time_series(figure.subplots(), ts, theta, beta, name=_BETA)
    return figure


def _velocities() -> Figure:
    beta = [0.04, 0.08, 0.12, 0.16]
    figure = new_figure(7.2, 4.6)
    ts, _, v = damped(2.3, beta, 0.0, 80.0)
    time_series(figure.subplots(), ts, v, beta, name=_BETA, quantity="v")
    return figure


def _orbits() -> Figure:
    beta = np.arange(0, 0.201, 0.02)
    figure = new_figure(8.4, 4.6)
    ax = figure.subplots()
    _, theta, v = damped(2.3, beta, 0.0, 150.0)
    theta, v = (np.where(theta < 8 * np.pi, x, np.nan) for x in (theta, v))
    phase_portrait(ax, theta, v, np.round(beta, 2), name=_BETA)
    separatrix(ax, Pendulum(), over=(-np.pi, 8 * np.pi))
    ax.legend(title=_BETA, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _fixed_points() -> Figure:
    """Arrows of the flow, spirals and saddles, and what runs into and out of a saddle."""
    pendulum = Pendulum(1.0, 0.2)
    figure = new_figure(8.4, 4.6)
    ax = figure.subplots()
    theta, v = np.meshgrid(np.linspace(-1.6 * np.pi, 3.6 * np.pi, 160), np.linspace(-2.8, 2.8, 80))
    force = -np.sin(theta) - 0.2 * v
    ax.streamplot(theta, v, v, force, color=colour_of("separatrix"), linewidth=0.6, density=1.6,
                  arrowsize=0.8)  # fmt: skip
    found = fixed_points(pendulum)
    saddles = np.asarray(found.kind == FixedPointKind.saddle)
    angles, eigenvalues = np.asarray(found.angle), np.asarray(found.eigenvalues)
    for angle, saddle, values in zip(angles, saddles, eigenvalues, strict=True):
        for turn in (-2 * np.pi, 0, 2 * np.pi, 4 * np.pi):
            at = angle + turn
            if not -1.6 * np.pi < at < 3.6 * np.pi:
                continue
            mark, name = ("X", "above") if saddle else ("o", "below")
            ax.plot(at, 0, mark, ms=9, color=colour_of(name), zorder=4)
            for root in values.real if saddle else ():
                _manifold(ax, pendulum, at, float(root))
    for name, mark, colour in (("spiral", "o", "below"), ("saddle", "X", "above")):
        ax.plot([], [], mark, ms=9, color=colour_of(colour), label=name)
    ax.plot([], [], color=colour_of("above"), label="out of a saddle")
    ax.plot([], [], color=colour_of("next"), label="into a saddle")
    phase_portrait(ax, np.array([np.nan]), np.array([np.nan]))
    ax.set(xlim=(-1.6 * np.pi, 3.6 * np.pi), ylim=(-2.8, 2.8))
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _manifold(ax, pendulum: Pendulum, saddle: float, root: float) -> None:
    """From beside the saddle along an eigenvector (1, λ), forwards or backwards in time."""
    ts = np.sign(root) * np.linspace(0, 14 if root > 0 else 11, 300)
    for side in (1e-3, -1e-3):
        run = simulate(pendulum, ts, side * root, saddle + side)
        name = "above" if root > 0 else "next"
        ax.plot(run.theta, run.v, color=colour_of(name), lw=1.4, zorder=3)


RESISTIVE = (
    Entry("7.1", "spirals and saddles, β = 0.2 1/s, ε = 1 1/s²", _fixed_points),
    Entry("7.2a", "θ(t), v0 = 2.3 rad/s, ε = 1 1/s²", _angles),
    Entry("7.2b", "v(t), v0 = 2.3 rad/s, ε = 1 1/s²", _velocities),
    Entry("7.2c", "orbits for 150 s, v0 = 2.3 rad/s, ε = 1 1/s²", _orbits),
)
