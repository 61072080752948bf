"""Two short films: the construction of chapter 4, and a junction's escape and retrapping."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from .._exact import period
from .._geometry import geometry
from .._pendulum import Pendulum
from .._simulate import simulate
from ..fate import retrapping_torque
from ..plot import colour_of, construction, new_figure
from ..special import ellipj

_RATE = 20  # frames a second
Scene = tuple[Figure, Callable[[int], object], int]


class Animation(NamedTuple):
    """`make` gives the figure, what draws frame n, and the number of frames."""

    name: str
    about: str
    make: Callable[[], Scene]

    def save(self, path: Path) -> None:
        """As a GIF, by Pillow, in the style in force."""
        figure, draw, count = self.make()
        figure.set_dpi(80)
        canvas = FigureCanvasAgg(figure)
        frames = []
        for n in range(count):
            draw(n)
            canvas.draw()
            figure.set_layout_engine("none")  # one layout for all frames
            frame = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
            frames.append(frame.quantize(64))
        frames[0].save(
            path, save_all=True, append_images=frames[1:], duration=1000 // _RATE, loop=0
        )


def _construction() -> Scene:
    """One period of a swing up to 150°: the bob, Q on the auxiliary circle, and sn, cn, dn."""
    modulus = float(np.sin(np.radians(75)))
    v0, count = 2 * modulus, 60
    whole = float(period(Pendulum(), v0))
    ts = np.linspace(0, whole, count, endpoint=False)
    run = simulate(Pendulum(), ts, v0)
    theta, v = np.asarray(run.theta), np.asarray(run.v)
    curve = np.linspace(0, whole, 400)
    figure = new_figure(9.0, 4.4)
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.1))
    names = (("sn", "below"), ("cn", "next"), ("dn", "data"))
    values = np.stack(ellipj(curve, modulus**2)[:3])
    for (name, colour), row in zip(names, values, strict=True):
        right.plot(curve, row, color=colour_of(colour), label=name)
    dots = [right.plot([], [], "o", color=colour_of(colour), ms=7)[0] for _, colour in names]
    right.set(xlabel=r"$u=\sqrt{\varepsilon}\,t$", xlim=(0, whole), ylim=(-1.1, 1.1))
    right.legend(loc="lower left")
    figure.suptitle("Figure 16, moving: sn, cn and dn as lengths")
    lengths = geometry(Pendulum(), theta, v)
    # Of lengths, which have no sign: AP = 2k sn, ND = 2k² cn², EP = 2 dn.
    sn = np.sign(theta) * np.asarray(lengths.AP) / (2 * modulus)
    cn = np.sign(v) * np.sqrt(np.asarray(lengths.ND) / 2) / modulus
    dn = np.asarray(lengths.EP) / 2

    def draw(n: int) -> None:
        left.clear()
        construction(left, Pendulum(), float(theta[n]), float(v[n]))
        left.get_legend().remove()
        for dot, y in zip(dots, (sn[n], cn[n], dn[n]), strict=True):
            dot.set_data([ts[n]], [y])

    return figure, draw, count


def _retrapping() -> Scene:
    """A torque that rises past the critical one and falls again: escape at τ = ε, retrapping far
    below it."""
    beta, rise, end, count = 0.4, 25.0, 75.0, 150

    def torque(t):
        return jnp.where(t < rise, 1.15 * t / rise, 1.15 * (end - t) / (end - rise))

    ts = np.linspace(0, end, 2201)
    run = simulate(Pendulum(1.0, beta, torque), jnp.asarray(ts), 0.0)
    theta, v, tau = (np.asarray(x) for x in (run.theta, run.v, torque(jnp.asarray(ts))))
    figure = new_figure(8.0, 3.8)
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.5))
    left.set(xlim=(-1.25, 1.25), ylim=(-1.25, 1.25))
    left.set_aspect("equal")
    left.axis("off")
    left.plot(0, 0, "o", color=colour_of("separatrix"), ms=7)
    (rod,) = left.plot([], [], "-", color=colour_of("law"), lw=3)
    (bob,) = left.plot([], [], "o", color=colour_of("above"), ms=16)
    (trace,) = right.plot([], [], color=colour_of("below"), lw=1.0)
    (now,) = right.plot([], [], "o", color=colour_of("above"), ms=7)
    retrapping = float(retrapping_torque(beta))
    for at, name in ((1.0, r"$\tau_c=\varepsilon$"), (retrapping, r"$\tau_r$")):
        right.axvline(at, color=colour_of("separatrix"), ls=":", lw=1)
        right.annotate(name, (at, 1.0), xytext=(4, -10), xycoords=("data", "axes fraction"),
                       textcoords="offset points")  # fmt: skip
    right.set(xlabel=r"torque $\tau$ / s$^{-2}$", ylabel=r"angular velocity $v$ / rad s$^{-1}$")
    right.set(xlim=(0, 1.2), ylim=(1.1 * v.min() - 0.1, 1.25 * v.max()))
    figure.suptitle(
        rf"$\tau$ up to 1.15 s$^{{-2}}$ in {rise:g} s and back in {end - rise:g} s, "
        rf"$\beta={beta}$ s$^{{-1}}$, $\varepsilon=1$ s$^{{-2}}$",
        fontsize=11,
    )
    frames = np.linspace(0, ts.size - 1, count).astype(int)

    def draw(n: int) -> None:
        i = frames[n]
        x, y = np.sin(theta[i]), -np.cos(theta[i])
        rod.set_data([0, x], [0, y])
        bob.set_data([x], [y])
        trace.set_data(tau[: i + 1], v[: i + 1])
        now.set_data([tau[i]], [v[i]])

    return figure, draw, count


ANIMATIONS: dict[str, Animation] = {
    film.name: film
    for film in (
        Animation("construction", "sn, cn and dn as lengths on a swing, moving", _construction),
        Animation("retrapping", "a driven pendulum escapes and is retrapped", _retrapping),
    )
}
