"""Power over frequency, and the harmonics in it."""

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from ._style import colour_of


def spectrum(
    ax: Axes,
    omega: ArrayLike,
    power: ArrayLike,
    harmonics: tuple[ArrayLike, ArrayLike] | None = None,
    *,
    label: str | None = None,
    colour: str | None = None,
    fundamental: float | None = None,
) -> Axes:
    """Power, logarithmic, over ω, rad/s.

    **Arguments:** `omega` and `power` of a discrete transform, one axis each; `harmonics`, the
    frequencies and powers to be marked, the numbers nω/ω1 written beside those that stand 1e-9 of
    the highest or more; `fundamental`, ω1, by default the first of them.
    """
    ax.semilogy(omega, power, lw=0.9, color=colour, label=label)
    if harmonics is not None:
        at, height = (np.asarray(x, float) for x in harmonics)
        drawn = height > 0
        at, height = at[drawn], height[drawn]
        ax.plot(
            at, height, "o", ms=5, mfc="none", color=colour_of("above"), label="exact harmonics"
        )
        low, high = ax.get_xlim()
        for x, y in zip(at, height, strict=True):
            if low <= x <= high and y >= 1e-9 * height.max():
                ax.annotate(
                    f"{x / (fundamental or at[0]):.0f}", (x, y), xytext=(0, 5),
                    textcoords="offset points", ha="center", fontsize=8,
                )  # fmt: skip
    ax.set(xlabel=r"angular frequency $\omega$ / rad s$^{-1}$", ylabel="power / rad²")
    return ax
