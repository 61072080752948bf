"""Suzuki & Suzuki's chapter 4: the elliptic functions as lengths."""

import numpy as np
from matplotlib.figure import Figure

from .._energy import energy, velocity
from .._pendulum import Pendulum
from ..plot import construction, new_figure
from ._entry import Entry


def _construct(top: float | None, degrees: float, kappa: float = 1.0) -> Figure:
    """The pendulum at the angle `degrees` that swings up to `top` degrees, or turns over."""
    pendulum, theta = Pendulum(), np.radians(degrees)
    height = 2 / kappa**2 if top is None else float(energy(pendulum, np.radians(top), 0.0))
    v = float(velocity(pendulum, theta, height))
    figure = new_figure(6.6 if height <= 2 else 7.4, 4.8)
    construction(figure.subplots(), pendulum, float(theta), v)
    return figure


GEOMETRY = (
    Entry("15", "θ_max = 120°, θ = 70°", lambda: _construct(120.0, 70.0)),
    Entry("16", "θ_max = 150°, θ = 70°", lambda: _construct(150.0, 70.0)),
    Entry("17", "θ_max = 180°, θ = 50°, the critical state", lambda: _construct(180.0, 50.0)),
    Entry("18", "turning over, κ = 0.90, θ = 70°", lambda: _construct(None, 70.0, 0.9)),
)
