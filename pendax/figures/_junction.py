"""Suzuki & Suzuki's §8.3: the pendulum as a Josephson junction."""

import numpy as np
from matplotlib.figure import Figure

from ..fate import retrapping_torque
from ..josephson import FLUX_QUANTUM, JosephsonJunction
from ..josephson import iv_curve as curve_of
from ..plot import colour_of, iv_curve, new_figure
from ._entry import Entry

_IC, _R = 100e-6, 10.0
_BETA = 0.16


def _iv() -> Figure:
    """The junction of β = 0.16: hysteresis, where the source has one critical current."""
    # β = β_c^(−1/2) and β_c = 2π Ic R² C/Φ0.
    capacitance = FLUX_QUANTUM / (2 * np.pi * _IC * _R**2 * _BETA**2)
    junction = JosephsonJunction(_IC, _R, capacitance)
    current = np.linspace(-1.5, 1.5, 601) * _IC
    figure = new_figure(7.2, 4.8)
    ax = iv_curve(figure.subplots(), curve_of(junction, current))
    retrapping = 1e6 * _IC * float(retrapping_torque(_BETA))
    line = {"color": colour_of("separatrix"), "lw": 1, "ls": ":"}
    for at, name in ((1e6 * _IC, "$I_c$"), (retrapping, "$I_r$")):
        ax.axvline(at, **line)
        ax.annotate(name, (at, 1.0), xytext=(4, -10), xycoords=("data", "axes fraction"),
                    textcoords="offset points")  # fmt: skip
    overdamped = curve_of(JosephsonJunction(_IC, _R), current)
    iv_curve(ax, overdamped, label="no capacitance")
    ax.lines[-1].set(color=colour_of("next"), lw=1.0)
    ax.legend(loc="lower right")
    return figure


JUNCTION = (Entry("8.3", "a junction of β = β_c^(−1/2) = 0.16", _iv),)
