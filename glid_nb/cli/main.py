"""The parser of all commands, and the handling of errors."""

import argparse
import io
import sys
import warnings
from collections.abc import Sequence
from typing import Any, NoReturn

import glid_nb
from glid_nb.cli import (
    animate,
    audit,
    demo,
    doctor,
    grade,
    lab,
    page,
    render,
    samples,
    solve,
    trace,
)
from glid_nb.cli.output import BAD_INPUT, one_line, tell_error

COMMANDS = (demo, trace, solve, render, animate, page, audit, samples, lab, grade, doctor)


class OneLineParser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        self.exit(2, f"glid-nb: error: {message} (see {self.prog} --help)\n")


def _tell(message: Warning | str, *_: Any) -> None:
    print(f"glid-nb: warning: {' '.join(str(message).split())}", file=sys.stderr)


def build_parser() -> argparse.ArgumentParser:
    what = "Locally injective image deformation: from a picture to a map proved never to fold."
    parser = OneLineParser(prog="glid-nb", description=what)
    parser.add_argument("--version", action="version", version=f"glid-nb {glid_nb.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for module in COMMANDS:
        summary = (module.__doc__ or "").splitlines()[0]
        command = commands.add_parser(
            module.__name__.rpartition(".")[2],
            help=summary[0].lower() + summary[1:].rstrip("."),
            description=module.__doc__,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        module.add_arguments(command)
        debug = "show the traceback when the input is refused"
        command.add_argument("--debug", action="store_true", help=debug)
        command.set_defaults(run=module.run)
    return parser


def _escape_what_cannot_be_printed() -> None:
    """Print characters that the console lacks as escapes, such as \\u03c3, without an error."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command. The exit code is 0, 1 for bad input, 2 for wrong usage, 3 for an audited
    warp that is not proved, 130 after Ctrl-C.

    ``arguments`` are the words after ``glid-nb``, by default those of the process.
    """
    if arguments is None:
        _escape_what_cannot_be_printed()
    chosen = build_parser().parse_args(arguments)
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _tell
            code = chosen.run(chosen)
    except KeyboardInterrupt:
        print("glid-nb: interrupted", file=sys.stderr)
        return 130
    except BAD_INPUT as error:
        if chosen.debug:
            raise
        tell_error(one_line(error))
        return 1
    return code or 0
