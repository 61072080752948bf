"""Error against run time."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

Values = float | Sequence[float] | ArrayLike

_MARKS = "osDv^<>Ph*d"  # as many as have no factor in common with the colours


def work_precision(
    ax: Axes,
    methods: Mapping[str, tuple[Values, Values]],
    *,
    error: str = "largest error",
    time: str = "run time / s",
) -> Axes:
    """Errors over run times, both logarithmic, one line a method.

    **Arguments:** `methods`: name → (errors, run times) of its settings, one axis each, from
    coarse to fine; a method with one setting is a point.  `error` and `time` name the axes.
    Errors of 0 are drawn at 1e-17.
    """
    for (name, (errors, times)), mark in zip(methods.items(), _MARKS * 3, strict=False):
        errors = np.maximum(np.atleast_1d(np.asarray(errors, float)), 1e-17)
        single = errors.size == 1
        ax.loglog(np.atleast_1d(np.asarray(times, float)), errors, mark + ("" if single else "-"),
                  ms=10 if single else 5, lw=1.3, label=name)  # fmt: skip
    ax.set(xlabel=time, ylabel=error)
    ax.legend(fontsize=9)
    return ax
