"""`pendax`: one parser, one command a module."""

import argparse
import sys
from collections.abc import Sequence
from importlib.metadata import version

from . import _sweep
from ._error import UserError

_COMMANDS = {"sweep": _sweep}


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; 0 if it worked, 2 with one line on stderr if the user erred."""
    argv = list(sys.argv[1:] if argv is None else argv)
    if not argv or (argv[0].startswith("-") and argv[0] not in ("-h", "--help", "--version")):
        argv.insert(0, "sweep")
    parser = _parser()
    arguments = parser.parse_args(argv)
    try:
        arguments.run(arguments)
    except UserError as error:
        print(f"pendax: error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("pendax: interrupted", file=sys.stderr)
        return 130
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="pendax",
        description="The pendulum beyond small angles, θ̈ + ε sin θ = 0.",
        epilog="`pendax` alone is `pendax sweep`; `pendax COMMAND --help` explains a command.",
    )
    parser.add_argument("--version", action="version", version=f"pendax {version('pendax')}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    for name, module in _COMMANDS.items():
        command = commands.add_parser(
            name,
            help=module.SUMMARY,
            description=module.DESCRIPTION,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        module.add_arguments(command)
        command.set_defaults(run=module.run)
    return parser
