"""Angles or velocities over time, and over one another."""

from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._energy import velocity
from .._pendulum import Pendulum
from ._angle import angle_axis
from ._lines import family
from ._style import colour_of

_NAMES = {"theta": r"angle $\theta$ / rad", "v": r"angular velocity $v$ / rad s$^{-1}$"}


def time_series(
    ax: Axes,
    ts: ArrayLike,
    y: ArrayLike,
    values: ArrayLike | None = None,
    *,
    name: str = "",
    quantity: Literal["theta", "v"] = "theta",
) -> Axes:
    """Angles (`quantity` "theta", rad) or velocities ("v", rad/s) over time, s.

    **Arguments:** `ts`, one axis; `y`, one curve of as many points or rows of them; `values` of
    the parameter that tells the rows apart, and its `name`: a legend, or a colour bar where they
    are more than a dozen.  A legend stands beside the axes in a figure of constrained layout
    ([`style`][], [`new_figure`][]), inside them elsewhere.

    **Raises:** `ValueError` where shapes or numbers do not match.
    """
    if quantity not in _NAMES:
        raise ValueError(f"Argument `quantity` must be 'theta' or 'v', but got {quantity!r}.")
    family(ax, ts, y, values, name)
    ax.set(xlabel="time $t$ / s", ylabel=_NAMES[quantity], xlim=(np.min(ts), np.max(ts)))
    if quantity == "theta":
        angle_axis(ax.yaxis)
    return ax


def phase_portrait(
    ax: Axes,
    theta: ArrayLike,
    v: ArrayLike,
    values: ArrayLike | None = None,
    *,
    name: str = "",
) -> Axes:
    """Velocity over angle, rad/s and rad; arguments as for [`time_series`][]."""
    family(ax, theta, v, values, name)
    return _phase_axes(ax)


def energy_levels(
    ax: Axes,
    pendulum: Pendulum,
    energies: ArrayLike,
    *,
    over: tuple[float, float] = (-np.pi, np.pi),
) -> Axes:
    """Phase curves v(θ; E), both signs, of the energies E, 1/s², over the angles `over`, rad, of
    the scene without its damping and torque."""
    theta, rows = np.linspace(*over, 2001), []
    energies = np.atleast_1d(np.asarray(energies, float))
    if not energies.size or not (energies >= 0).all():
        raise ValueError(f"Argument `energies` must be some numbers ≥ 0, but got {energies}.")
    for energy in energies:
        v = np.array(velocity(pendulum, theta, float(energy)), float)
        # The grid passes the turning points; close the curve there.
        beyond = np.isnan(v)
        v[beyond & ~(np.roll(beyond, 1) & np.roll(beyond, -1))] = 0.0
        # Both branches in one line, a gap between them: a curve has one entry in the legend.
        rows.append(np.concatenate([v, [np.nan], -v[::-1]]))
    x = np.concatenate([theta, [np.nan], theta[::-1]])
    family(ax, x, np.stack(rows), energies, r"$E$ / s$^{-2}$")
    return _phase_axes(ax)


def separatrix(ax: Axes, pendulum: Pendulum, *, over: tuple[float, float] | None = None) -> Axes:
    """The separatrix v = ± 2√ε cos(θ/2) of the undamped pendulum, dashed, over the angles shown
    (or `over`, rad; −π to π where nothing is shown yet)."""
    shown = ax.get_xlim() if ax.has_data() else (-np.pi, np.pi)
    theta = np.linspace(*(over or shown), 2001)
    v = 2 * float(np.sqrt(pendulum.epsilon)) * np.abs(np.cos(0.5 * theta))
    line = {"color": colour_of("separatrix"), "ls": "--", "lw": 1.0, "zorder": 1.5}
    ax.plot(theta, v, label="separatrix", **line)
    ax.plot(theta, -v, **line)
    ax.set_xlim(theta[0], theta[-1])
    return _phase_axes(ax)


def _phase_axes(ax: Axes) -> Axes:
    ax.set(xlabel=_NAMES["theta"], ylabel=_NAMES["v"])
    angle_axis(ax.xaxis)
    return ax
