"""Voltage over current, both branches."""

import numpy as np
from matplotlib.axes import Axes

from ..josephson import IVCurve
from ._style import COLOURS

_AMPERES, _VOLTS = 1e6, 1e3  # µA and mV


def iv_curve(ax: Axes, curve: IVCurve, *, errors: bool = True) -> Axes:
    """A junction's I–V curve, rising and falling current in two colours, with arrows.

    **Arguments:** a `curve` of one junction, as [`pendax.iv_curve`][] gives it; `errors`: whether
    the uncertainty of averages is drawn as a band.  In µA and mV.
    """
    current = _AMPERES * np.asarray(curve.current)
    up, down = (_VOLTS * np.asarray(x) for x in (curve.voltage_up, curve.voltage_down))
    if current.ndim != 1 or up.shape != current.shape:
        raise ValueError(f"Argument `curve` must be of one junction, but got shape {up.shape}.")
    order = np.argsort(current, kind="stable")
    current, up, down = current[order], up[order], down[order]
    branches = [("above", "model, current rising", up, 1)]
    if np.array_equal(up, down, equal_nan=True):
        branches = [("above", "model", up, 0)]
    else:
        branches.append(("below", "model, current falling", down, -1))
    for colour, label, voltage, way in branches:
        ax.plot(current, voltage, color=COLOURS[colour], label=label, zorder=3)
        if way:
            _arrow(ax, current, voltage, way, COLOURS[colour])
    if errors:
        for voltage, error in ((up, curve.error_up), (down, curve.error_down)):
            if error is not None:
                off = _VOLTS * np.asarray(error)[order]
                band = voltage - off, voltage + off
                ax.fill_between(current, *band, color=COLOURS["separatrix"], alpha=0.4, lw=0)
    return _labelled(ax)


def measured_loop(ax: Axes, current: np.ndarray, voltage: np.ndarray, rising: np.ndarray) -> Axes:
    """Measured points, A and V, those of a rising current full and the others open."""
    x, y = _AMPERES * np.asarray(current), _VOLTS * np.asarray(voltage)
    for mask, label, marker in (
        (rising, "measured, current rising", "o"),
        (~np.asarray(rising), "measured, current falling", "x"),
    ):
        ax.plot(
            x[mask],
            y[mask],
            marker,
            ms=3,
            mew=0.6,
            color=COLOURS["data" if marker == "o" else "next"],
            alpha=0.5,
            label=label,
            zorder=2,
        )
    return _labelled(ax)


def _arrow(ax: Axes, current: np.ndarray, voltage: np.ndarray, way: int, colour: str) -> None:
    """Along the largest jump, in the direction of the sweep."""
    if current.size < 2:
        return
    k = int(np.nanargmax(np.abs(np.diff(voltage))))
    ends = (current[k], voltage[k]), (current[k + 1], voltage[k + 1])
    first, last = ends if way > 0 else ends[::-1]
    tail, head = (
        tuple(a + share * (b - a) for a, b in zip(first, last, strict=True))
        for share in (0.45, 0.6)
    )
    style = {"arrowstyle": "-|>", "color": colour, "lw": 1.8, "mutation_scale": 16}
    ax.annotate("", xy=head, xytext=tail, arrowprops=style, zorder=4)


def _labelled(ax: Axes) -> Axes:
    ax.set(xlabel="current $I$ / µA", ylabel="voltage $V$ / mV")
    return ax
