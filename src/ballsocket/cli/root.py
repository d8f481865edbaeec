"""The command `ballsocket`: its one application, its exit statuses, and what happens to errors."""

from __future__ import annotations

import codecs
import os
import signal
import sys
import threading
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from io import TextIOWrapper
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, TextIO

import numpy
import typer
from typer.models import CommandInfo

import ballsocket as bs

_MODULES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        **{name: (name,) for name in ("press", "curve", "orient")},
        "questions": ("map", "optimise", "sensitivity"),
        **{name: (name,) for name in ("study", "hip")},
        "lists": ("models", "presets", "cite"),
        "identify": ("identify",),
        "fit": ("calibrate", "build-tables"),
        **{name: (name,) for name in ("evidence", "deck", "fmu", "export", "schema", "app")},
        "serve_mcp": ("serve-mcp",),
        "reproduce": ("reproduce",),
    }
)
"""Modules of this package with their commands, in the order of `--help`."""


class _Commands(typer.Typer):
    """Application that imports the modules of its commands on first use."""

    _needed: tuple[str, ...] = tuple(_MODULES)

    def need(self, word: str) -> None:
        """Import the module of one command only; all modules for any other word."""
        modules = tuple(module for module, commands in _MODULES.items() if word in commands)
        self._needed = modules or tuple(_MODULES)

    @property
    def registered_commands(self) -> list[CommandInfo]:
        """Commands of the needed modules."""
        needed, self._needed = self._needed, ()
        for module in needed:
            import_module(f"ballsocket.cli.{module}")
        return self._commands

    @registered_commands.setter
    def registered_commands(self, commands: list[CommandInfo]) -> None:
        self._commands = commands


app = _Commands(
    name="ballsocket",
    help="Contact of a ball in a socket of nearly its own radius. Units are mm, N, MPa, degrees unless text says so.",
    no_args_is_help=False,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

UsageError: Any = typer.BadParameter.__base__  # typer brings a click of its own, and does not export this
DONE, MISUSE, FAILURE = 0, 2, 3
STOPPED, NOBODY_READS = 130, 141  # as a shell says it of the signals
_LONGEST = 600  # characters of a message
_IN_ASCII = {
    "≤": "<=",
    "≥": ">=",
    "±": "+-",
    "°": "o",
    "µ": "u",
    "ε": "e",
    "ν": "v",
    "φ": "f",
    "Δ": "D",
    "²": "2",
    "ß": "ss",
}


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
    if os.environ.get("COLUMNS", "").strip() == "0":  # width 0 means an unknown width
        del os.environ["COLUMNS"]
    with _cleaning_up_when_ended(), _without_warnings():
        sys.exit(_status())


@contextmanager
def _without_warnings() -> Iterator[None]:
    """Suppress floating-point warnings; results carry a status and notes."""
    with numpy.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        yield


def _status() -> int:
    """Do what is asked; the exit status."""
    status = MISUSE
    try:
        app.need(sys.argv[1] if len(sys.argv) > 1 else "")
        done = app(standalone_mode=False) or DONE
        _flush()
        return int(done)
    except SystemExit as ended:
        if isinstance(ended.__context__, BrokenPipeError):  # rich ends at once, as if it were an error
            return NOBODY_READS
        raise
    except BrokenPipeError:
        _write_no_more()
        return NOBODY_READS
    except typer.Abort:
        return STOPPED
    except UsageError as error:
        message = _said(error)
    except OSError as error:
        if error.filename is None:
            _write_no_more()  # what is still to be written would fail again at the very end
        message = f"{error.filename or 'output'}: {error.strerror or error}"
    except ValueError as error:
        message = str(error)
    except ImportError as error:
        message = str(error)
    except RuntimeError as error:  # a process that was lost too often
        message, status = str(error), FAILURE
    except (ArithmeticError, MemoryError) as error:
        message, status = f"these numbers are too large or too small to calculate with ({error})", FAILURE
    complain(message)
    return status


def _said(error: Any) -> str:
    """What is wrong with a command line; where an option is not known, and none is like it, who lists them."""
    message: str = error.format_message()
    if not hasattr(error, "option_name") or error.ctx is None or set(error.possibilities or ()) - {"--help"}:
        return message
    return f"No such option: {error.option_name}; ballsocket {error.ctx.info_name} -h lists them"


def complain(message: str) -> None:
    """Print one line on stderr, if anything can be written there."""
    try:
        print(f"ballsocket: {_one_line(message)}", file=sys.stderr, flush=True)
    except OSError:
        _write_no_more(sys.stderr)


def _one_line(message: str) -> str:
    """A text as any terminal can show it, whatever the names in it are, and how long."""
    text = " ".join(message.split())
    if len(text) > _LONGEST:
        text = f"{text[: _LONGEST // 2]} ... {text[-_LONGEST // 4 :]}"
    return _printable(text)


def _printable(text: str) -> str:
    return "".join(char if char.isprintable() else ascii(char)[1:-1] for char in text)


def echo_path(path: Path, more: str = "") -> None:
    """Tell where something was written, as any terminal can show it."""
    typer.echo(_printable(f"{path}{more}"))


def _flush() -> None:
    """What is still to be written is written while there is somebody to hear that it cannot be."""
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()


def _write_no_more(stream: TextIO | None = None) -> None:
    """Nobody reads what is written: not even at the end of the process is there anything to flush."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), (stream or sys.stdout).fileno())


@contextmanager
def _cleaning_up_when_ended() -> Iterator[None]:
    """A process that is asked to end leaves no half-written folders behind."""

    def end(number: int, frame: Any) -> None:
        sys.exit(128 + number)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
