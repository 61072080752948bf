"""θ over time: exact solutions of Suzuki & Suzuki's chapters 2, 3 and 5."""

import numpy as np
from matplotlib.figure import Figure

from .._pendulum import Pendulum
from .._simulate import simulate
from ..plot import colour_of, new_figure, time_series
from ._data import swings
from ._entry import Entry

V0 = r"$v_0$ / rad s$^{-1}$"
_NEAR = [float(x) for x in np.round(1.99992 + np.arange(8) * 1e-5, 5)]
_OVER = [float(x) for x in np.round(2 + np.arange(1, 11) * 1e-5, 5)]

# Name, end in seconds, initial velocities of the source.
_FAMILIES: tuple[tuple[str, str, float, list[float]], ...] = (
    ("5a", "swinging", 30.0, [1.7, 1.75, 1.8, 1.85, 1.9, 1.95]),
    ("5b", "nearer to the separatrix", 40.0, [1.995, 1.996, 1.997, 1.998]),
    ("5c", "nearer still", 40.0, [1.999, 1.9992, 1.9994, 1.9996]),
    ("5d", "almost on it", 60.0, [1.99999, 1.999992, 1.999994, 1.999996, 1.999998]),
    ("10a", "turning over, θ = 2 am", 30.0, [2.3]),
    ("10b", "turning over, θ = 2 am", 30.0, [2.1]),
    ("10c", "turning over, θ = 2 am", 30.0, [2.01]),
    ("5.2a", "small swings", 25.0, [0.1, 0.2, 0.3, 0.4, 0.5]),
    ("5.2b", "large swings", 25.0, [1.4, 1.5, 1.6]),
    ("5.2c", "larger swings", 30.0, [1.91, 1.92, 1.93]),
    ("5.2d", "swings that linger", 30.0, [1.982, 1.984, 1.986, 1.988, 1.99]),
    ("5.2e", "almost square waves", 50.0, [1.9992, 1.9993, 1.9994, 1.9995, 1.9996, 1.9997]),
    ("5.2f", "almost square waves", 60.0, _NEAR),
    ("5.2h", "just over the top", 60.0, _OVER),
    ("5.2i", "turning over", 40.0, [2.02, 2.03, 2.04, 2.05, 2.07, 2.08]),
    ("5.2j", "turning over", 40.0, [2.1, 2.12, 2.14, 2.16, 2.18, 2.2]),
    ("E", "within 1e-5 of the separatrix", 100.0,
     [float(x) for x in np.round(1.999992 + np.arange(8) * 1e-6, 6)]),
    ("G", "the curve through the origin", 30.0, [2.1]),
)  # fmt: skip


def _family(end: float, v0: list[float], branches: bool, to_twenty_pi: bool = False) -> Figure:
    figure = new_figure(7.2, 4.2)
    ax = figure.subplots()
    ts, theta, _ = swings(v0, end)
    if branches:  # all of sin(θ/2) = sn(t/κ): what a contour plot of it shows
        faint = {"color": colour_of("separatrix"), "lw": 0.6, "alpha": 0.6}
        for n in range(-8, 12):
            label = "other branches" if n == -8 else None
            ax.plot(ts, theta[0] + 4 * np.pi * n, label=label, **faint)
            ax.plot(ts, 2 * np.pi * (2 * n + 1) - theta[0], **faint)
    time_series(ax, ts, theta, v0, name=V0)
    if branches:
        ax.set_ylim(-0.5, 20 * np.pi if to_twenty_pi else 1.2 * theta.max())
    return figure


def _on_the_separatrix() -> Figure:
    """The exact motion, which nears the top, and what a solver makes of it."""
    import diffrax
    import jax.numpy as jnp

    ts = np.linspace(0, 60, 1001)
    figure = new_figure(8.2, 4.2)
    ax = figure.subplots()
    few = np.linspace(0, 60, 121)  # a solver that has to hit more times is better than it need be
    for rtol, name in ((1e-4, "above"), (1e-8, "next"), (1e-12, "data")):
        run = simulate(Pendulum(), few, 2.0, solver=diffrax.Tsit5(), rtol=rtol, atol=rtol)
        ax.plot(few, run.theta, color=colour_of(name), lw=1.3, label=f"Tsit5, tolerance {rtol:.0e}")
    exact = simulate(Pendulum(), jnp.asarray(ts), 2.0).theta
    time_series(ax, ts, np.asarray(exact))
    ax.lines[-1].set(color=colour_of("law"), label="exact, 4 arctan $e^t$ − π", lw=2.2)
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _entry(name: str, about: str, end: float, v0: list[float]) -> Entry:
    branches = name in ("10a", "10b", "10c", "G")
    about = f"{about}, v0 = {span(v0)}"
    return Entry(name, about, lambda: _family(end, v0, branches, name == "G"))


def span(v0: list[float]) -> str:
    first, last = (f"{x:.10g}" for x in (v0[0], v0[-1]))
    return first if len(v0) == 1 else f"{first} … {last}"


MOTION = (
    *(_entry(*row) for row in _FAMILIES),
    Entry("5.2g", "v0 = 2 rad/s, on the separatrix: exact, and solved", _on_the_separatrix),
)
