"""Voltage over current, both branches."""

import numpy as np
from matplotlib.axes import Axes

from ..josephson import IVCurve
from ._style import colour_of

_PREFIXES = (("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9), ("p", 1e-12))


def iv_curve(ax: Axes, curve: IVCurve, *, label: str = "", errors: bool = True) -> Axes:
    """A junction's I–V curve, rising and falling current in two colours, with arrows.

    **Arguments:** a `curve` of one junction over one axis of currents, as [`pendax.iv_curve`][]
    gives it; `label`: its name in the legend; `errors`: whether the uncertainty of averages is
    drawn as a band.
    """
    current = np.asarray(curve.current)
    up, down = np.asarray(curve.voltage_up), np.asarray(curve.voltage_down)
    if current.ndim != 1 or up.shape != current.shape:
        raise ValueError(
            "Argument `curve` must be of one junction over one axis of currents, but got voltages "
            f"of shape {up.shape}."
        )
    amperes, volts = _units(ax, current, up)
    order = np.argsort(current, kind="stable")
    current, up, down = current[order] / amperes, up[order] / volts, down[order] / volts
    named = f"{label}, " if label else ""
    branches = [
        ("above", named + "current rising", up, 1),
        ("below", named + "current falling", down, -1),
    ]
    if np.allclose(up, down, rtol=0, atol=1e-6 * np.nanmax(np.abs(up), initial=0), equal_nan=True):
        branches = [("above", label or "both branches", up, 0)]
    for colour, name, voltage, way in branches:
        ax.plot(current, voltage, color=colour_of(colour), lw=1.4, label=name, zorder=3)
        if way:
            _arrow(ax, current, voltage, way, colour_of(colour))
    if errors:
        for voltage, error in ((up, curve.error_up), (down, curve.error_down)):
            if error is not None:
                off = np.asarray(error)[order] / volts
                band = voltage - off, voltage + off
                ax.fill_between(current, *band, color=colour_of("separatrix"), alpha=0.4, lw=0)
    return ax


def measured_loop(ax: Axes, current: np.ndarray, voltage: np.ndarray, rising: np.ndarray) -> Axes:
    """Measured points, A and V, those of a rising current larger and paler than the others."""
    amperes, volts = _units(ax, np.asarray(current), np.asarray(voltage))
    x, y, rising = np.asarray(current) / amperes, np.asarray(voltage) / volts, np.asarray(rising)
    for mask, name, colour, size, alpha in (
        (rising, "measured, current rising", "data", 7, 0.35),
        (~rising, "measured, current falling", "next", 3.5, 1.0),
    ):
        style = {"ms": size, "mew": 0, "color": colour_of(colour), "alpha": alpha}
        ax.plot(x[mask], y[mask], "o", label=name, zorder=2, **style)
    return ax


def _units(ax: Axes, current: np.ndarray, voltage: np.ndarray) -> tuple[float, float]:
    """What an axis counts in, A and V: as its label has it, or as fits best."""
    found = []
    both = (ax.xaxis, "current $I$", "A", current), (ax.yaxis, "voltage $V$", "V", voltage)
    for axis, what, unit, x in both:
        labels = {f"{what} / {p}{unit}": size for p, size in _PREFIXES}
        if axis.get_label_text() not in labels:
            largest = np.nanmax(np.abs(x), initial=0)
            fits = [k for k, size in labels.items() if largest >= size]
            axis.set_label_text(fits[0] if fits else f"{what} / {unit}")
        found.append(labels[axis.get_label_text()])
    return found[0], found[1]


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
