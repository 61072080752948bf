"""ω over v0."""

import numpy as np
from matplotlib.axes import Axes

from ._style import colour_of

V0_LABEL = r"initial velocity $v_0/\sqrt{\varepsilon}$"
OMEGA_LABEL = r"angular frequency $\omega/\sqrt{\varepsilon}$"


def frequency_curve(
    ax: Axes, v0: np.ndarray, omega: np.ndarray, epsilon: float = 1.0, most: int = 4000
) -> Axes:
    """ω(v0) in units of √ε, swinging and turning over in two colours.

    **Arguments:** `v0`, ascending, and `omega`, rad/s, one axis each; `epsilon`, 1/s²;
    `most`, how many points are drawn of either side, those at which the curve has moved
    on: the last representable distances from the separatrix are among them.
    """
    root = np.sqrt(epsilon)
    x, y = np.asarray(v0) / root, np.asarray(omega) / root
    sides = (("below", "swings", x <= 2), ("above", "turns over", x >= 2))
    for side, label, mask in sides:
        if mask.sum() > 1:
            drawn = _thinned(x[mask], y[mask], most)
            ax.plot(x[mask][drawn], y[mask][drawn], color=colour_of(side), label=label)
    if x.min() <= 2 <= x.max():
        ax.axvline(
            2,
            color=colour_of("separatrix"),
            ls="--",
            lw=1,
            label=r"separatrix $v_0=2\sqrt{\varepsilon}$",
        )
    ax.set(xlabel=V0_LABEL, ylabel=OMEGA_LABEL)
    return ax


def measured_cycles(
    ax: Axes,
    amplitude: np.ndarray,
    period: np.ndarray,
    epsilon: float,
    amplitude_error: np.ndarray | float = 0.0,
    period_error: np.ndarray | float = 0.0,
) -> Axes:
    """Cycles of a measured swing as (v0, ω) in units of √ε: v0 = 2√ε sin(θ_max/2).

    **Arguments:** `amplitude`, rad, and `period`, s, of each cycle with their standard
    errors; `epsilon`, 1/s², as fitted to them.
    """
    root = np.sqrt(epsilon)
    omega = 2 * np.pi / np.asarray(period) / root
    ax.errorbar(
        2 * np.sin(np.asarray(amplitude) / 2),
        omega,
        xerr=np.abs(np.cos(np.asarray(amplitude) / 2) * amplitude_error),
        yerr=omega * period_error / np.asarray(period),
        fmt="o",
        ms=5,
        color=colour_of("data"),
        ecolor=colour_of("data"),
        markeredgecolor="black",
        markeredgewidth=0.6,
        elinewidth=1,
        zorder=5,
        label="measured cycles",
    )
    ax.set(xlabel=V0_LABEL, ylabel=OMEGA_LABEL)
    return ax


def _thinned(x: np.ndarray, y: np.ndarray, most: int) -> np.ndarray:
    """Indices of about `most` points evenly spaced along the curve."""
    if x.size <= most:
        return np.arange(x.size)
    length = np.abs(np.diff(x)) / np.ptp(x) + np.abs(np.diff(y)) / max(np.ptp(y), 1e-300)
    along = np.r_[0, np.cumsum(length)]
    picked = np.searchsorted(along, np.linspace(0, along[-1], most))
    return np.unique(np.clip(picked, 0, x.size - 1))
