"""The command `ballsocket`: its one application, its exit statuses, and what happens to errors."""

from __future__ import annotations

import codecs
import sys
from io import TextIOWrapper
from typing import Annotated, Any

import typer

import ballsocket as bs

app = typer.Typer(
    name="ballsocket",
    help="Contact of a ball in a socket of nearly its own radius. Units are mm, N, MPa, degrees unless text says so.",
    no_args_is_help=False,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)

UsageError: Any = typer.BadParameter.__base__  # typer brings a click of its own, and does not export this
DONE, MISUSE, FAILURE = 0, 2, 3
_IN_ASCII = {"≤": "<=", "≥": ">=", "°": "o", "µ": "u", "ε": "e", "ν": "v", "²": "2", "ß": "ss"}


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"ballsocket {bs.__version__}")
        raise typer.Exit()


@app.callback(invoke_without_command=True)
def root(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", callback=_version, is_eager=True, help="Print it.")] = False,
) -> None:
    """Contact of a ball in a socket of nearly its own radius."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


def _degrade(error: UnicodeError) -> tuple[str, int]:
    """What stands for characters that the terminal's encoding lacks."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(_IN_ASCII.get(char, "?") for char in error.object[error.start : error.end]), error.end


def _write_in_any_encoding() -> None:
    codecs.register_error("degrade", _degrade)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="degrade")


def main() -> None:
    """The command `ballsocket`: one line on stderr for misuse, no tracebacks for what a user can mend."""
    _write_in_any_encoding()
    status = MISUSE
    try:
        sys.exit(app(standalone_mode=False) or DONE)
    except typer.Abort:
        sys.exit(130)
    except UsageError as error:
        message = error.format_message()
    except OSError as error:
        message = f"{error.filename or 'output'}: {error.strerror or error}"
    except ValueError as error:
        message = str(error)
    except ImportError as error:
        message = str(error)
    except RuntimeError as error:  # a process that was lost too often
        message, status = str(error), FAILURE
    except (ArithmeticError, MemoryError) as error:
        message, status = f"these numbers are too large or too small to calculate with ({error})", FAILURE
    print("ballsocket: " + " ".join(message.split()), file=sys.stderr)
    sys.exit(status)
