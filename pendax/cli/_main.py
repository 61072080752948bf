"""`pendax`: one parser, one command a module."""

import argparse
import io
import os
import sys
from collections.abc import Sequence
from importlib.metadata import version
from typing import NoReturn

from . import _cache, _claims, _figures, _fit, _iv, _sweep
from ._error import UserError

_COMMANDS = {"sweep": _sweep, "figures": _figures, "report": _claims, "fit": _fit, "iv": _iv}


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; 0 if it worked, 2 with one line on stderr if the user erred."""
    argv = list(sys.argv[1:] if argv is None else argv)
    if not argv or (argv[0].startswith("-") and argv[0] not in ("-h", "--help", "--version")):
        argv.insert(0, "sweep")
    for stream in (sys.stdout, sys.stderr):  # a terminal without Greek gets question marks
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    parser = _parser()
    try:
        arguments = parser.parse_args(argv)
        if arguments.cache:
            _cache.keep_programs()
        arguments.run(arguments)
        sys.stdout.flush()
    except BrokenPipeError:  # the reader, `head` say, has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except UserError as error:
        print(f"pendax: error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("pendax: interrupted", file=sys.stderr)
        return 130
    return 0


class _Parser(argparse.ArgumentParser):
    """Errors in one line, without the usage before them."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"pendax: error: {message}\n")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="pendax",
        description="The pendulum beyond small angles, and the Josephson junction.",
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
        command.add_argument("--cache", action="store_true", help=_cache.HELP)
        command.set_defaults(run=module.run)
    return parser
