"""A recorded motion, the model fitted to it, and what is left."""

import numpy as np
from matplotlib.axes import Axes

from ._style import colour_of

GAP = 2.5  # median steps


def recorded_motion(
    ax: Axes, ts: np.ndarray, theta: np.ndarray, model: np.ndarray, *, unit: str = "s"
) -> Axes:
    """Measured angles, rad, as points and the model's as a line, in degrees over time.

    **Arguments:** `ts`, in `unit`, `theta` and `model`, one axis each, in the order of time.  The
    line ends at gaps in the recording.
    """
    _points(ax, ts, np.degrees(theta), "measured")
    x, y = np.asarray(ts), np.degrees(model)
    gaps = np.flatnonzero(np.diff(x) > GAP * np.median(np.diff(x))) + 1
    x, y = (np.insert(np.asarray(z, float), gaps, np.nan) for z in (x, y))
    ax.plot(x, y, color=colour_of("law"), lw=1.1, label="model", zorder=3)
    ax.set(xlabel=f"time $t$ / {unit}", ylabel=r"angle $\theta$ / °")
    return ax


def residuals(
    ax: Axes, ts: np.ndarray, left: np.ndarray, *, unit: str = "s", quantity: str = "θ / °"
) -> Axes:
    """Measured less modelled over time, in the unit named in `quantity`."""
    _points(ax, ts, np.asarray(left), "measured − model")
    ax.axhline(0, color=colour_of("separatrix"), lw=1, zorder=1)
    ax.set(xlabel=f"time $t$ / {unit}", ylabel=f"measured − model, {quantity}")
    return ax


def _points(ax: Axes, x: np.ndarray, y: np.ndarray, label: str) -> None:
    size = 1.6 if np.size(x) > 1000 else 3.5
    ax.plot(x, y, "o", ms=size, mew=0, color=colour_of("data"), label=label, zorder=2)
