"""The potential, and the energies in it."""

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from .._energy import potential
from .._pendulum import Pendulum
from ._angle import angle_axis
from ._style import colour_of, shades


def potential_energy(
    ax: Axes,
    pendulum: Pendulum,
    energies: ArrayLike = (),
    *,
    over: tuple[float, float] = (-2 * np.pi, 2 * np.pi),
) -> Axes:
    """U(θ)/ε = 1 − cos θ over the angles `over`, rad, and levels of the energies E/ε where
    E ≥ U; the torque, which does work on its way, is not in U."""
    epsilon = float(pendulum.epsilon)
    theta = np.linspace(*over, 4001)
    u = np.asarray(potential(pendulum, theta), float) / epsilon
    ax.plot(theta, u, color=colour_of("law"), label=r"$U/\varepsilon=1-\cos\theta$")
    energies = np.asarray(energies, float)
    for energy, colour in zip(energies, shades(energies.size), strict=True):
        level = np.where(u <= energy, energy, np.nan)
        at_top = np.isclose(energy, 2)
        ax.plot(theta, level, color=colour, lw=2.4 if at_top else 1.4, ls="--" if at_top else "-")
        ax.annotate(
            f"{energy:g}" + (" (separatrix)" if at_top else ""), (over[1], energy),
            xytext=(4, 0), textcoords="offset points", va="center", fontsize=9,
        )  # fmt: skip
    ax.set(xlabel=r"angle $\theta$ / rad", ylabel=r"energy $E/\varepsilon$", xlim=over)
    angle_axis(ax.xaxis)
    return ax
