"""Fourier spectra of θ(t): Suzuki & Suzuki's figure 6, chapter 6 and appendix D."""

import jax.numpy as jnp
import numpy as np
from matplotlib.figure import Figure

from .._exact import frequency
from .._harmonics import harmonics
from .._pendulum import Pendulum
from .._simulate import simulate
from .._spectrum import power_spectrum
from ..plot import colour_of, new_figure, spectrum
from ._entry import Entry

# Appendix D: 32,768 samples in 1,600 s.
_SAMPLES, _END, _HIGHEST = 32768, 1600.0, 5.0
_COUNT = 61

_PANELS = (
    *(("6" + x, v0) for x, v0 in zip("abcde", (0.2, 1.6, 1.92, 1.98, 1.998), strict=True)),
    *(
        ("ch6" + x, v0)
        for x, v0 in zip(
            "abcdefghij",
            (0.5, 1.6, 1.9, 1.981, 1.9962, 1.9991, 1.999995, 1.9999985, 1.9999999, 2.001),
            strict=True,
        )
    ),
    ("D", 1.92),
)


def _spectrum(v0: float) -> Figure:
    """As the source transforms it, and through a window, under which the lines stand clear."""
    ts = jnp.arange(_SAMPLES) * (_END / _SAMPLES)
    theta = simulate(Pendulum(), ts, v0).theta
    figure = new_figure(7.2, 4.4)
    ax = figure.subplots()
    rotates = v0 > 2
    # A rotation is a ramp with a ripple: undetrended, as in the source, the ramp hides all lines.
    ramp = {"detrend": frequency(Pendulum(), v0)} if rotates else {}
    omega, power = power_spectrum(ts, theta)
    shown = np.asarray(omega) <= _HIGHEST
    faint = colour_of("separatrix")
    name = (
        "no window, ramp included (the source's way)" if rotates else "no window (the source's way)"
    )
    spectrum(ax, omega[shown], power[shown], label=name, colour=faint)
    ax.set_xlim(0, _HIGHEST)
    _, clean = power_spectrum(ts, theta, window="blackman-harris", **ramp)
    exact = harmonics(Pendulum(), v0, count=_COUNT)
    at = np.arange(1, _COUNT + 1) * float(exact.frequency)
    height = _SAMPLES * np.asarray(exact.amplitude) ** 2 / 4
    inside = at <= _HIGHEST
    spectrum(
        ax, omega[shown], clean[shown], (at[inside], height[inside]),
        label="Blackman–Harris window" + (", ramp taken off" if rotates else ""),
        colour=colour_of("below"), fundamental=float(exact.frequency),
    )  # fmt: skip
    top = max(float(jnp.max(power[shown])), height.max())
    ax.set_ylim(1e-13 * height.max(), 8 * top)
    ax.legend(loc="upper right", fontsize=9)
    return figure


def _entry(name: str, v0: float) -> Entry:
    kind = "ripple of the rotation" if v0 > 2 else "odd harmonics"
    return Entry(name, f"spectrum at v0 = {v0:.10g} rad/s, {kind}", lambda: _spectrum(v0))


SPECTRA = tuple(_entry(*panel) for panel in _PANELS)
