"""Suzuki & Suzuki's §8.2 and appendix H: damping and a constant torque, β = 0.16."""

import jax.numpy as jnp
import numpy as np
from matplotlib.figure import Figure

from .._pendulum import Pendulum
from ..fate import settle
from ..plot import colour_of, fate_map, new_figure, phase_portrait, time_series
from ._data import damped
from ._entry import Entry

_BETA = 0.16
_TAU = r"$\tau$ / s$^{-2}$"
_STARTS = (2.01, 2.05, 2.10, 2.14, 2.27, 2.40, 2.60, 2.80, 2.95, 3.15)


def _orbits(v0: float, tau: np.ndarray, end: float, turns: tuple[float, float]) -> Figure:
    """Orbits, and where those that are captured come to rest, θ = 2πn + arcsin τ."""
    figure = new_figure(8.6, 4.4)
    ax = figure.subplots()
    _, theta, v = damped(v0, _BETA, tau, end)
    ends = settle(Pendulum(1.0, _BETA, jnp.asarray(tau)), v0)
    captured = np.asarray(ends.running) == 0
    high = turns[1] * np.pi
    theta, v = (np.where(theta <= high, x, np.nan) for x in (theta, v))
    phase_portrait(ax, theta, v, np.round(tau, 4), name=_TAU)
    rest = np.asarray(ends.theta)[captured]
    ax.plot(rest, np.zeros_like(rest), "o", ms=4, mfc="none", color=colour_of("above"), zorder=4)
    wells = ", ".join(str(n) for n in np.unique(np.asarray(ends.well)[captured]))
    ax.set_title(f"captured in n = {wells}" if captured.any() else "none captured",
                 fontsize=11)  # fmt: skip
    ax.set_xlim(turns[0] * np.pi, high)
    return figure


def _near_the_change() -> Figure:
    tau = [0.19, 0.2, 0.21, 0.22, 0.23, 0.24]
    figure = new_figure(7.2, 4.6)
    ts, _, v = damped(1.98, _BETA, tau, 80.0)
    time_series(figure.subplots(), ts, v, tau, name=_TAU, quantity="v")
    return figure


def _map() -> Figure:
    tau, v0 = np.linspace(-0.05, 0.45, 301), np.linspace(1.4, 3.5, 211)
    pendulum = Pendulum(1.0, _BETA, jnp.asarray(tau))
    ends = settle(pendulum, jnp.asarray(v0)[:, None])
    figure = new_figure(7.6, 4.8)
    ax = fate_map(figure.subplots(), tau, v0, ends)
    for letter, start in zip("abcdefghij", _STARTS, strict=True):
        ax.plot([0.01, 0.4], [start, start], color=colour_of("above"), lw=0.6)
        near = letter in "bd"  # two columns: the first four are close
        ax.annotate(f"({letter})", (0.4, start), xytext=(14 if near else 2, 0), fontsize=7,
                    textcoords="offset points", va="center", color=colour_of("above"))  # fmt: skip
    ax.set(xlabel=r"torque $\tau$ / s$^{-2}$", ylabel=r"$v_0$ / rad s$^{-1}$")
    return figure


def _family(letter: str, v0: float) -> Entry:
    tau = np.arange(1, 41) * 0.01
    return Entry(
        f"8.2.3{letter}",
        f"v0 = {v0:.2f} rad/s, τ = 0.01 … 0.40, β = {_BETA} 1/s",
        lambda: _orbits(v0, tau, 100.0, (-1.0, 14.0)),
    )


DRIVEN = (
    Entry("8.2.1", f"v0 = 0.2 rad/s, β = {_BETA} 1/s",
          lambda: _orbits(0.2, np.arange(0, 0.81, 0.2), 60.0, (-0.5, 6.0))),
    Entry("8.2.2a", f"v0 = 1.98 rad/s, β = {_BETA} 1/s",
          lambda: _orbits(1.98, np.arange(0.19, 0.251, 0.01), 80.0, (-1.0, 14.0))),
    Entry("8.2.2b", f"v0 = 1.98 rad/s, β = {_BETA} 1/s", _near_the_change),
    *(_family(*row) for row in zip("abcdefghij", _STARTS, strict=True)),
    Entry("8.2.3", f"wells over v0 and τ, β = {_BETA} 1/s; lines: panels (a) to (j)", _map),
    Entry("H", f"v0 = 2.1 rad/s, τ = 0.01 … 0.35, β = {_BETA} 1/s",
          lambda: _orbits(2.1, np.arange(1, 36) * 0.01, 100.0, (-1.0, 14.0))),
)  # fmt: skip
