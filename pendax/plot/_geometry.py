"""The pendulum, its auxiliary circle, and the elliptic functions as lengths."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Arc, Circle

from .._geometry import geometry
from .._pendulum import Pendulum
from ._lines import legend_beside
from ._style import colour_of

_OFFSETS = {
    "A": (0, -13), "B": (12, 0), "B1": (-13, 0), "D": (-11, 4), "E": (-11, 6), "N": (-10, -4),
    "O": (-10, 0), "P": (11, -5), "Q": (3, -12),
}  # fmt: skip


def construction(ax: Axes, pendulum: Pendulum, theta: float, v: float) -> Axes:
    """Suzuki & Suzuki's chapter 4 for a pendulum at (θ, v), rad and rad/s, in units of the rod.

    The circle of the bob P about O with bottom A and top E; its turning points B and B′ where it
    swings; the circle over AD, up to where the energy would lift the bob, with Q at the height of
    P.  AP = 2k sn, EP = 2 dn, DQ = 2k² cn below the separatrix (k = sin θ_max/2); above it, with
    κ = 1/k, AP = 2 sn, EP = 2 cn, DN = 2 dn²/κ².
    """
    points = geometry(pendulum, theta, v)
    at = {name: np.asarray(getattr(points, name), float) for name in "ABDENPQ"}
    at |= {"B1": np.asarray(points.B1, float), "O": np.zeros(2)}
    swings = bool(np.isfinite(at["B"]).all())
    height = float(points.AD)
    if not swings or height > 2 - 1e-9:  # the turning points are none, or E
        del at["B"], at["B1"]
    thin = {"fill": False, "lw": 1.2, "zorder": 2}
    ax.add_patch(Circle((0, 0), 1, ec=colour_of("separatrix"), **thin))
    ax.add_patch(Circle((0, height / 2 - 1), height / 2, ec=colour_of("next"), **thin))
    faint = {"color": colour_of("separatrix"), "lw": 1.0, "ls": ":"}
    for ends in ("AE", "AD") + (("BB1", "EB", "AB") if "B" in at else ()):
        _segment(ax, at, ends, **faint)
    _segment(ax, at, "OP", color=colour_of("law"), lw=3.0)
    _segment(ax, at, "NP", color=colour_of("separatrix"), lw=1.2)
    swinging = (
        ("AP", "AP = 2k sn", "below"),
        ("EP", "EP = 2 dn", "data"),
        ("DQ", "DQ = 2k² cn", "next"),
        ("AQ", "AQ = 2k² sn", "above"),
    )
    rotating = (
        ("AP", "AP = 2 sn", "below"),
        ("EP", "EP = 2 cn", "data"),
        ("DN", "DN = 2 dn²/κ²", "next"),
    )
    for ends, label, colour in swinging if swings else rotating:
        # Dashed, so that they show where the two circles are one, at k = 1.
        dashes = "--" if "Q" in ends else "-"
        _segment(ax, at, ends, color=colour_of(colour), lw=2.2, ls=dashes, label=label, zorder=3)
    _angles(ax, at, theta)
    for name, xy in at.items():
        if name == "D" and abs(height - 2) < 1e-9:
            continue  # on E
        big = name == "P"
        ax.plot(
            *xy, "o", ms=11 if big else 3.5, color=colour_of("above" if big else "law"), zorder=4
        )
        ax.annotate(
            name.replace("1", "′"), tuple(xy), xytext=_OFFSETS[name], textcoords="offset points",
            ha="center", va="center", fontsize=10, zorder=5,
        )  # fmt: skip
    ax.set_aspect("equal")
    wide = max(1.2, 0.5 * height + 0.1)
    ax.set(xlim=(-wide, wide), ylim=(-1.2, max(1.2, height - 0.85)))
    ax.axis("off")
    legend_beside(ax)
    return ax


def _segment(ax: Axes, at: dict[str, np.ndarray], ends: str, **line) -> None:
    first, last = (ends[0], ends[1:])
    ax.plot(*np.stack([at[first], at[last]]).T, **line)


def _angles(ax: Axes, at: dict[str, np.ndarray], theta: float) -> None:
    """θ at the pivot, θ/2 at the top."""
    degrees = np.degrees(np.arctan2(np.sin(theta), np.cos(theta)))
    for centre, size, extent, text in (("O", 0.5, degrees, "θ"), ("E", 0.7, degrees / 2, "θ/2")):
        x, y = at[centre]
        low, high = sorted((-90.0, -90.0 + extent))
        ax.add_patch(Arc((x, y), size, size, theta1=low, theta2=high, color=colour_of("law"), lw=1))
        middle = np.radians(-90 + extent / 2)
        r = 0.5 * size + 0.09
        ax.annotate(text, (x + r * np.cos(middle), y + r * np.sin(middle)), ha="center",
                    va="center", fontsize=10)  # fmt: skip
