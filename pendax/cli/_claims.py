"""`pendax report`: every claim of the sources, and the verdict on it."""

import argparse
from pathlib import Path

from ._error import UserError
from ._figures import draw
from ._output import output_folder

SUMMARY = "every claim of the sources beside what is found"
DESCRIPTION = """\
Check every claim of the two sources and every misprint known of them, and write report.md: what
the source says, what is found, to how many digits, and the verdict.  --figures draws the
figures that it links to as well; without it, it links to those already in the folder."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--figures", action="store_true", help="draw the figures too, as PNG")
    add("--out", type=Path, default=Path("pendax-out"), metavar="FOLDER",
        help="where the files go (default pendax-out)")  # fmt: skip
    add("--quiet", action="store_true", help="print nothing but errors")


def run(arguments: argparse.Namespace) -> None:
    import jax
    from tqdm import tqdm

    jax.config.update("jax_enable_x64", True)
    from ..figures import FIGURES
    from ..report import CLAIMS, ERRATA, SECTIONS, report

    if (arguments.out / "report.md").is_dir():
        raise UserError(f"{arguments.out / 'report.md'}: expected no folder in place of a file")
    with output_folder(arguments.out) as folder:
        if arguments.figures:
            draw(list(FIGURES), folder, "light", ["png"], arguments.quiet)

        def link(name: str) -> str | None:
            for form in ("png", "svg"):
                file = f"figure-{name}.{form}"
                if any((place / file).exists() for place in (folder, arguments.out)):
                    return file
            return None

        hidden = True if arguments.quiet else None  # None: hidden unless on a terminal
        total = len(CLAIMS) + len(ERRATA)
        with tqdm(total=total, desc="claims", unit="", delay=1, disable=hidden) as bar:

            def tell(name: str) -> None:
                bar.set_postfix_str(name, refresh=False)
                bar.update()

            text = report(SECTIONS, ERRATA, link, tell)
        (folder / "report.md").write_text(text, encoding="utf-8")
    if not arguments.quiet:
        print(text.split("\n")[2])
        print(f"wrote {arguments.out / 'report.md'}")
