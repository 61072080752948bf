"""sn of appendix B, and the figures of the Spanish source."""

import numpy as np
from matplotlib.figure import Figure

from .._energy import slack_angle, tension
from .._pendulum import Pendulum
from .._simulate import simulate
from .._small_angle import period_series
from ..plot import colour_of, new_figure, shades
from ..special import ellipj
from ._entry import Entry


def _sn(m: list[float], names: list[str], title: str) -> Figure:
    u = np.linspace(0, 15, 1501)
    figure = new_figure(7.2, 4.2)
    ax = figure.subplots()
    for value, name, shade in zip(m, names, shades(len(m)), strict=True):
        ax.plot(u, ellipj(u, value)[0], color=shade, label=name, lw=1.5)
    ax.set(xlabel="$u$", ylabel=r"$\mathrm{sn}(u\,|\,m)$", xlim=(0, 15))
    ax.legend(title=title, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _series() -> Figure:
    """Relative error of the partial sums of T/T0."""
    figure = new_figure(7.2, 4.4)
    ax = figure.subplots()
    degrees = [15, 45, 90, 120, 150, 170]
    sums = period_series(np.radians(degrees), 400)
    terms = np.arange(1, 401)
    for angle, error, shade in zip(degrees, np.abs(sums.error), shades(6), strict=True):
        ax.loglog(terms, np.maximum(error, 1e-17), color=shade, label=f"{angle}°")
    ax.set(xlabel="terms of the series", ylabel="relative error of $T$", ylim=(1e-16, 1))
    ax.legend(title=r"$\theta_{\max}$", loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _tension() -> Figure:
    """N/(mg) over one period from rest: below 0 a string would be slack."""
    figure = new_figure(7.2, 4.4)
    ax = figure.subplots()
    degrees = [30, 60, 90, 120, 150, 170]
    ts = np.linspace(0, 15, 1001)
    start = np.radians(degrees)
    run = simulate(Pendulum(), ts, np.zeros_like(start), start)
    # ε = g/l = 1 with g = l = 1: weights are m.
    pull = tension(Pendulum(), run.theta, run.v, 1.0, 1.0)
    for angle, row, shade in zip(degrees, np.asarray(pull), shades(6), strict=True):
        ax.plot(ts, row, color=shade, lw=1.5, label=f"{angle}°")
    ax.axhline(0, color=colour_of("separatrix"), lw=1)
    slack = float(np.degrees(slack_angle(Pendulum(), 0.0, np.radians(120))))
    ax.set_title(f"from 120°, a string would be slack above {slack:.1f}°", fontsize=11)
    ax.set(xlabel="time $t$ / s", ylabel="tension $N/(mg)$", xlim=(0, 15))
    ax.legend(title=r"$\theta_{\max}$", loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


_M = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
ELLIPTIC = (
    Entry("B", "the Jacobi elliptic function sn", lambda: _sn(_M, [f"{m:g}" for m in _M], "$m$")),
    Entry("es1.1", "tension of the rod, released from rest", _tension),
    Entry("es3.2.1", "sn, almost a sine at k = 0.05",
          lambda: _sn([0.05**2, 0.9**2], ["0.05", "0.9"], r"$k=\sqrt{m}$")),
    Entry("es4", "the series of the period", _series),
)  # fmt: skip
