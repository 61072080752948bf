"""Where starts end, as a map."""

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from numpy.typing import ArrayLike

from ..fate import Settled


def fate_map(ax: Axes, x: ArrayLike, y: ArrayLike, ends: Settled, *, most: int = 6) -> Axes:
    """The well in which each start ends, over two parameters; grey where it runs for ever.

    **Arguments:** `x` and `y`, one axis each; `ends`, of shape (y, x), as
    [`settle`][pendax.settle] gives it; wells beyond ± `most` have the last colour.

    **Raises:** `ValueError` where `ends` is of another shape.
    """
    well, running = np.asarray(ends.well), np.asarray(ends.running)
    if well.shape != (np.size(y), np.size(x)):
        raise ValueError(
            f"Argument `ends` must be of shape {(np.size(y), np.size(x))}, one end for each y and "
            f"x, but got {well.shape}."
        )
    captured = running == 0
    low = int(max(well[captured].min(initial=0), -most))
    high = int(min(well[captured].max(initial=0), most))
    wells = np.arange(low, high + 1)
    colours = mpl.colormaps["RdBu_r" if low < 0 else "viridis"].resampled(len(wells))
    shown = np.ma.masked_array(np.clip(well, low, high), ~captured)
    ax.set_facecolor("0.35")
    ax.grid(False)
    edges = BoundaryNorm(np.arange(low, high + 2) - 0.5, len(wells))
    grid = np.asarray(x), np.asarray(y)
    image = ax.pcolormesh(*grid, shown, cmap=colours, norm=edges, rasterized=True)
    beyond = (bool((well[captured] < low).any()), bool((well[captured] > high).any()))
    arrows = ("neither", "max", "min", "both")[2 * beyond[0] + beyond[1]]
    label = "well $n$" + ("" if captured.all() else "; grey: runs for ever")
    bar = ax.figure.colorbar(image, ax=ax, label=label, extend=arrows)
    bar.set_ticks(wells.tolist(), labels=[str(n).replace("-", "−") for n in wells])
    return ax
