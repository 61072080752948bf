"""A family of curves, told apart by a parameter."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.layout_engine import ConstrainedLayoutEngine
from numpy.typing import ArrayLike

from ._style import shades

_MOST = 12  # entries of a legend; beyond, a colour bar


def family(
    ax: Axes,
    x: ArrayLike,
    y: ArrayLike,
    values: ArrayLike | None,
    name: str,
) -> None:
    """Rows of `y` over those of `x` (or over `x`), dark to light in the order given."""
    count = None if values is None else np.shape(values)
    values = None if values is None else np.asarray(values, float)
    y, x = np.atleast_2d(np.asarray(y)), np.asarray(x)
    if x.size == 0 or x.shape not in (y.shape[-1:], y.shape):
        raise ValueError(
            "Curves must have as many points as there are abscissae, one or more, but got shapes "
            f"{x.shape} and {y.shape}."
        )
    x = np.broadcast_to(x, y.shape)
    if y.ndim != 2 or (count is not None and count != y.shape[:1]):
        raise ValueError(
            f"Curves must be one, or rows with one of the `values` each, but got curves of shape "
            f"{y.shape} with values of shape {count}."
        )
    colours = shades(len(y)) if len(y) > 1 else [None]
    many = len(y) > _MOST
    for i, colour in enumerate(colours):
        label = None if many or values is None else f"{values[i]:.10g}"
        ax.plot(x[i], y[i], color=colour, label=label, lw=0.9 if many else 1.5)
    if values is None:
        return
    if many:
        span = Normalize(float(np.min(values)), float(np.max(values)))
        mappable = ScalarMappable(span, ListedColormap(shades(256)))
        ax.figure.colorbar(mappable, ax=ax, label=name)
    else:
        legend_beside(ax, name)


def legend_beside(ax: Axes, title: str | None = None) -> None:
    """To the right of the axes where the figure's layout makes room for it, else inside."""
    figure = ax.get_figure(root=True)
    engine = figure.get_layout_engine() if figure else None
    if isinstance(engine, ConstrainedLayoutEngine):
        ax.legend(title=title, loc="center left", bbox_to_anchor=(1.0, 0.5))
    else:
        ax.legend(title=title, loc="best")
