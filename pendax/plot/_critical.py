"""ω over the distance t from the separatrix."""

import numpy as np
from matplotlib.axes import Axes

from .._critical import Side, critical_law
from ._style import colour_of

_NAMES: dict[Side, tuple[str, str, str]] = {
    "lower": ("below", r"t=2\sqrt{\varepsilon}-v_0", r"\frac{\pi}{2}"),
    "upper": ("above", r"t=v_0-2\sqrt{\varepsilon}", r"\pi"),
}


def critical_approach(
    ax: Axes, t: np.ndarray, omega: np.ndarray, side: Side, epsilon: float = 1.0
) -> Axes:
    """Exact ω(t) on a logarithmic t with the leading law and its next order.

    **Arguments:** `t` > 0 and `omega`, rad/s, one axis each, of one `side` ("lower" or
    "upper"); `epsilon`, 1/s².  Drawn in units of √ε.
    """
    colour, distance, prefactor = _NAMES[side]
    x, y, root = _sorted(t, omega, epsilon)
    law = (
        rf"$\omega/\sqrt{{\varepsilon}}={prefactor}\,/\,\ln(4\,(t/\sqrt{{\varepsilon}})^{{-1/2}})$"
    )
    ax.plot(x, y, color=colour_of(colour), lw=4, alpha=0.5, label="exact")
    for order, style, label in ((0, "--", law), (1, ":", "with the next order in t")):
        approximate = np.asarray(critical_law(x * root, side, epsilon, order)) / root
        ax.plot(x, approximate, style, color=colour_of("next" if order else "law"), label=label)
    ax.set_xscale("log")
    ax.set_ylim(0, 1.05 * y.max())
    ax.set(xlabel=rf"${distance}$, in $\sqrt{{\varepsilon}}$")
    ax.set(ylabel=r"$\omega/\sqrt{\varepsilon}$")
    ax.legend(loc="upper left")
    return ax


def law_deviation(
    ax: Axes, t: np.ndarray, omega: np.ndarray, side: Side, epsilon: float = 1.0
) -> Axes:
    """|law/exact − 1| of the leading law and its next order, both axes logarithmic.

    Arguments as for [`critical_approach`][].  A line ends where the deviation sinks
    into the rounding errors, below 4 eps of the dtype.
    """
    _, distance, _ = _NAMES[side]
    x, y, root = _sorted(t, omega, epsilon)
    for order, style in ((0, "--"), (1, ":")):
        off = np.asarray(critical_law(x * root, side, epsilon, order)) / root / y - 1
        visible = np.abs(off) >= 4 * np.finfo(y.dtype).eps
        label = "next order" if order else "leading law"
        ax.plot(
            x[visible],
            np.abs(off[visible]),
            style,
            label=label,
            color=colour_of("next" if order else "law"),
        )
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set(xlabel=rf"${distance}$, in $\sqrt{{\varepsilon}}$", ylabel="|law / exact − 1|")
    return ax


def _sorted(t, omega, epsilon, most: int = 2000):
    """t/√ε ascending and ω/√ε, `most` points at most; √ε."""
    root = float(np.sqrt(epsilon))
    order = np.argsort(t)
    order = order[:: max(order.size // most, 1)]
    return np.asarray(t)[order] / root, np.asarray(omega)[order] / root, root
