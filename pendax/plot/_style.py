"""One look throughout."""

from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

# Okabe and Ito's colours, told apart by every eye.
COLOURS = {
    "below": "#0072B2",
    "above": "#D55E00",
    "law": "#000000",
    "next": "#009E73",
    "separatrix": "#777777",
    "data": "#CC79A7",
}

STYLE: dict[Any, Any] = {
    "figure.dpi": 150,
    "figure.constrained_layout.use": True,
    "font.size": 11,
    "axes.titlesize": 12,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.alpha": 0.3,
    "legend.frameon": False,
    "lines.linewidth": 1.8,
}


def new_figure(width: float, height: float) -> Figure:
    """An empty figure in the package's style, size in inches, outside pyplot's registry."""
    with mpl.rc_context(STYLE):
        return Figure(figsize=(width, height))
