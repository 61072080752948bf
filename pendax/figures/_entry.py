"""A figure of a source: its number there, one line about it, and how it is drawn."""

from collections.abc import Callable
from typing import NamedTuple

from matplotlib.figure import Figure

_TYPESET = (
    ("θ_max", r"$\theta_{\max}$"),
    ("v0", "$v_0$"),
    ("β_c^(−1/2)", r"$\beta_c^{-1/2}$"),
)


class Entry(NamedTuple):
    """`name`: the source's number, or ours where it has none or has it twice."""

    name: str
    about: str
    draw: Callable[[], Figure]

    @property
    def heading(self) -> str:
        """Where it stands in its source."""
        name = self.name
        if name.startswith("es"):
            return f"Spanish source §{name[2:]}"
        if name.startswith("8.2.3"):
            return "§ 8.2.3"  # the source has two (e); v0 tells the panels apart
        if name.startswith("ch"):
            return f"Chapter {name[2:-1]}({name[-1]})"
        where = "Appendix" if name in "BDEGH" else "§" if "." in name else "Figure"
        number = name[:-1] if name[-1].islower() else name
        letter = f"({name[-1]})" if name[-1].islower() else ""
        return f"{where} {number}{letter}"

    def figure(self) -> Figure:
        """The figure, in the style in force, with its heading."""
        figure = self.draw()
        about = self.about
        for plain, set_ in _TYPESET:
            about = about.replace(plain, set_)
        figure.suptitle(f"{self.heading}: {about}", fontsize=12)
        return figure
