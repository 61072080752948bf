"""Orbits in the phase plane, Suzuki & Suzuki's §2.5 and §5.3."""

import numpy as np
from matplotlib.figure import Figure

from .._pendulum import Pendulum
from ..plot import new_figure, phase_portrait, separatrix
from ._data import swings
from ._entry import Entry
from ._motion import V0, span

_FAMILIES: tuple[tuple[str, str, float, list[float]], ...] = (
    ("7a", "closed orbits", 12.0, [1.8, 1.85, 1.9, 1.95]),
    ("7b", "closed orbits near the separatrix", 15.0, [1.96, 1.97, 1.98, 1.99]),
    ("5.3a", "closed orbits", 9.0, [1.0, 1.1, 1.2, 1.3, 1.4, 1.5]),
    ("5.3b", "closed orbits", 11.0, [1.6, 1.7, 1.8, 1.9]),
    ("5.3c", "closed orbits", 13.0, [1.91, 1.92, 1.93, 1.94, 1.95, 1.96, 1.97]),
    ("5.3d", "closed orbits near the separatrix", 15.0,
     [float(x) for x in np.round(np.arange(1.98, 1.9905, 1e-3), 3)]),
    ("5.3e", "the separatrix itself", 40.0, [2.0]),
    ("5.3f", "an open orbit", 30.0, [2.01]),
)  # fmt: skip


def _orbits(end: float, v0: list[float]) -> Figure:
    figure = new_figure(7.2, 4.4)
    ax = figure.subplots()
    _, theta, v = swings(v0, end)
    phase_portrait(ax, theta, v, v0, name=V0)
    high = max(theta.max() + 0.3, np.pi) if max(v0) > 2 else np.pi
    separatrix(ax, Pendulum(), over=(-np.pi, float(high)))
    ax.legend(title=V0, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _entry(name: str, about: str, end: float, v0: list[float]) -> Entry:
    return Entry(name, f"{about}, v0 = {span(v0)}", lambda: _orbits(end, v0))


PHASE = tuple(_entry(*row) for row in _FAMILIES)
