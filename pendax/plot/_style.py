"""One look throughout, on white paper or on a dark screen."""

from contextlib import AbstractContextManager
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

Look = Literal["light", "dark"]

# Okabe and Ito's colours, told apart by every eye; on a dark ground the lighter of each kind.
COLOURS = {
    "below": "#0072B2",
    "above": "#D55E00",
    "law": "#000000",
    "next": "#009E73",
    "separatrix": "#777777",
    "data": "#CC79A7",
}
DARK_COLOURS = {
    "below": "#56B4E9",
    "above": "#F0853A",
    "law": "#F2F2F2",
    "next": "#2FC79A",
    "separatrix": "#9A9A9A",
    "data": "#E29BC3",
}

STYLE: dict[Any, Any] = {
    "figure.dpi": 150,
    "figure.constrained_layout.use": True,
    "font.size": 11,
    "axes.titlesize": 12,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#777777"]),
    "grid.alpha": 0.3,
    "legend.frameon": False,
    "lines.linewidth": 1.8,
    "image.cmap": "viridis",
    "svg.hashsalt": "pendax",
}
_GROUND, _INK = "#14171C", "#E6E6E6"
DARK_STYLE: dict[Any, Any] = STYLE | {
    "figure.facecolor": _GROUND,
    "axes.facecolor": _GROUND,
    "savefig.facecolor": _GROUND,
    "axes.prop_cycle": cycler(color=["#56B4E9", "#F0853A", "#2FC79A", "#E29BC3", "#9A9A9A"]),
    **dict.fromkeys(("text.color", "axes.edgecolor", "axes.labelcolor"), _INK),
    **dict.fromkeys(("xtick.color", "ytick.color"), _INK),
    "grid.color": "#6A6F78",
}


def style(look: Look = "light") -> AbstractContextManager[None]:
    """A `with` block in which matplotlib draws in the package's style, "light" or "dark"."""
    if look not in ("light", "dark"):
        raise ValueError(f"Argument `look` must be 'light' or 'dark', but got {look!r}.")
    return mpl.rc_context(DARK_STYLE if look == "dark" else STYLE)


def colour_of(name: str) -> str:
    """The colour of a thing ("below" or "above" the separatrix, "law", "next", "separatrix",
    "data"), to be seen on the axes' ground of the style in force."""
    if name not in COLOURS:
        raise ValueError(f"Argument `name` must be one of {', '.join(COLOURS)}, but got {name!r}.")
    dark = sum(to_rgb(mpl.rcParams["axes.facecolor"])) < 1.5
    return (DARK_COLOURS if dark else COLOURS)[name]


def shades(count: int) -> np.ndarray:
    """`count` colours in order, dark to light, every one to be seen on the ground in force."""
    dark = sum(to_rgb(mpl.rcParams["axes.facecolor"])) < 1.5
    low, high = (0.2, 0.97) if dark else (0.0, 0.88)
    return mpl.colormaps[mpl.rcParams["image.cmap"]](np.linspace(low, high, count))


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of the style in force, size in inches, outside pyplot's registry."""
    return Figure(figsize=(width, height), layout="constrained")
