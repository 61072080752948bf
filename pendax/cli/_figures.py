"""`pendax figures`: every figure of the sources, and two films."""

import argparse
import difflib
from pathlib import Path
from typing import TYPE_CHECKING

from ._error import UserError
from ._output import output_folder

if TYPE_CHECKING:
    from ..plot import Look

SUMMARY = "every figure of the sources, and two films"
DESCRIPTION = """\
Draw the figures of the two sources with their parameters, each by its number there, as PNG and
SVG, and two animations as GIF.  --list names them; --only 5a 13 draws those; 5, no figure by
itself, draws all its panels.  Figures of unnumbered parts are named after their section (5.2a,
8.2.3j), chapter (ch6a) or appendix (B, D, E, G, H), those of the Spanish source es…"""

_FORMATS = ("png", "svg")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--only", nargs="+", metavar="NAME", help="figures or films to draw (default: all)")
    add("--list", action="store_true", help="name them all, one line each, and draw nothing")
    add("--look", choices=("light", "dark"), default="light", help="(default light)")
    add("--format", nargs="+", choices=_FORMATS, default=list(_FORMATS),
        help="of the figures (default: both)")  # fmt: skip
    add("--out", type=Path, default=Path("pendax-out"), metavar="FOLDER",
        help="where the files go (default pendax-out)")  # fmt: skip
    add("--quiet", action="store_true", help="print nothing but errors")


def run(arguments: argparse.Namespace) -> None:
    from ..figures import ANIMATIONS, FIGURES

    if arguments.list:
        for thing in (*FIGURES.values(), *ANIMATIONS.values()):
            print(f"{thing.name:14}{thing.about}")
        return
    names = _chosen(arguments.only, [*FIGURES, *ANIMATIONS])
    with output_folder(arguments.out) as folder:
        files = draw(names, folder, arguments.look, arguments.format, arguments.quiet)
    if not arguments.quiet:
        print(f"drew {', '.join(names)}: {len(files)} files in {arguments.out}")


def draw(
    names: list[str], folder: Path, look: "Look", formats: list[str], quiet: bool
) -> list[str]:
    """Files written into the folder, in the order of the names."""
    import jax
    from tqdm import tqdm

    jax.config.update("jax_enable_x64", True)
    from ..figures import ANIMATIONS, FIGURES
    from ..plot import style

    files = []
    hidden = True if quiet else None  # None: hidden unless on a terminal
    with style(look), tqdm(names, desc="figures", unit="", delay=1, disable=hidden) as bar:
        for name in bar:
            bar.set_postfix_str(name)
            if name in ANIMATIONS:
                files.append(f"film-{name}.gif")
                ANIMATIONS[name].save(folder / files[-1])
                continue
            figure = FIGURES[name].figure()
            for form in formats:
                files.append(f"figure-{name}.{form}")
                # No date in the file: the same figure is the same bytes.
                dateless = {"Date": None} if form == "svg" else None
                figure.savefig(folder / files[-1], metadata=dateless)
    return files


def _chosen(only: list[str] | None, names: list[str]) -> list[str]:
    """The names asked for, in the catalogue's order."""
    if only is None:
        return names
    found, unknown = set(), []
    by_small = {name.lower(): name for name in names}
    for asked in only:
        small = asked.lower()
        panels = [n for n in names if n[:-1] == asked and n[-1].islower()]
        # A panel of a figure that is drawn whole, 8a, is found in the whole.
        whole = by_small.get(small) or (small[-1:] in "abc" and by_small.get(small[:-1]))
        if whole:
            found.add(whole)
        elif panels:
            found.update(panels)
        else:
            near = difflib.get_close_matches(asked, names, 3, 0.4)
            unknown.append(repr(asked) + (f" ({' or '.join(near)}?)" if near else ""))
    if unknown:
        raise UserError(f"--only: no figure {', '.join(unknown)}; --list names them all")
    return [name for name in names if name in found]
