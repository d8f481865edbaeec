"""The program `ballsocket`: its application, commands imported on demand, exit statuses and error messages."""

from __future__ import annotations

import codecs
import os
import re
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from io import BufferedWriter, FileIO, TextIOWrapper
from pathlib import Path
from typing import Annotated, Any, ClassVar, NoReturn, TextIO

import typer
from typer.core import TyperCommand, TyperGroup

from ..core.threads import THREAD_VARIABLES
from ..version import __version__

UsageError: Any = typer.BadParameter.__base__  # typer contains a copy of click and does not export this class
PROGRAM = "ballsocket"
SUCCESS, MISUSE, FAILURE = 0, 2, 3
INTERRUPTED, BROKEN_PIPE = 130, 141  # 128 + number of the signal, like in a shell
_MAX_MESSAGE_LENGTH = 600  # characters
_MAX_HELP_WIDTH = 120  # columns; a narrower terminal has its own width
_ASCII_REPLACEMENTS = {"≤": "<=", "≥": ">=", "±": "+-", "ß": "ss"} | dict(zip("°µενφΔ²", "ouevfD2", strict=True))


@dataclass(frozen=True)
class CommandEntry:
    """A command before it is imported: its module and its line in the list of commands."""

    module: str
    summary: str
    hidden: bool = False


ENTRIES: dict[str, CommandEntry] = {}
"""Commands of the program by name, in the order of the help; they are imported when they are called."""


class PlainCommand(TyperCommand):
    """A command that takes texts and defaults as they are."""

    def get_params(self, ctx: Any) -> list[Any]:
        """Return the parameters and the option for help."""
        return [_pass_plain_values(parameter) for parameter in super().get_params(ctx)]


def _pass_plain_values(parameter: Any) -> Any:
    """Let a parameter pass texts and defaults unchecked: pydantic, which checks them, takes 0.2 s to import."""
    annotation = getattr(getattr(parameter, "type_descriptor", None), "annotation", None)
    if annotation is None or parameter.required or "process_value" in vars(parameter):
        return parameter
    process_value = parameter.process_value

    def process(ctx: Any, value: Any) -> Any:
        """Pass a value of the annotated type, and process another value as typer does."""
        if annotation == list[str] and all(isinstance(text, str) for text in value or ()):
            value = list(value or ())
        elif not isinstance(annotation, type) or not (value is None or isinstance(value, annotation)):
            return process_value(ctx, value)
        return value if parameter.callback is None else parameter.callback(ctx, parameter, value)

    parameter.process_value = process
    return parameter


class Program(typer.Typer):
    """Application whose commands are of the class `PlainCommand`."""

    def command(self, *names: Any, **options: Any) -> Any:
        """Return the decorator that makes a command of a function."""
        return super().command(*names, cls=PlainCommand, **options)


class Placeholder(TyperCommand):
    """A command that is listed but not imported yet."""


class CommandGroup(TyperGroup):
    """Commands of the program; each one is imported when it is called."""

    program: ClassVar[typer.Typer]

    def __init__(self, **attributes: Any) -> None:
        super().__init__(**attributes)
        imported = dict(self.commands)
        self.commands = {
            name: imported.get(name) or Placeholder(name=name, help=entry.summary, hidden=entry.hidden)
            for name, entry in ENTRIES.items()
        }

    def get_params(self, ctx: Any) -> list[Any]:
        """Return the parameters of the program and the option for help."""
        return [_pass_plain_values(parameter) for parameter in super().get_params(ctx)]

    def invoke(self, ctx: Any) -> Any:
        """Call a command without floating-point warnings."""
        with _without_warnings():
            return super().invoke(ctx)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return a command by its name, imported if necessary, with the arguments that follow it."""
        name = args[0]
        if isinstance(self.commands.get(name), Placeholder):
            import_module(ENTRIES[name].module)
            imported: Any = typer.main.get_command(self.program)
            self.commands[name] = imported.commands[name]
        return super().resolve_command(ctx, args)


app = Program(
    name=PROGRAM,
    cls=CommandGroup,
    help="Contact of a ball in a socket of nearly its own radius. A number without a unit is in mm, N, MPa or degrees.",
    no_args_is_help=False,
    add_completion=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": _MAX_HELP_WIDTH},
)
CommandGroup.program = app


def load_commands() -> dict[str, Callable[..., None]]:
    """Import all commands, and return their functions by name in the order of the help."""
    for entry in ENTRIES.values():
        import_module(entry.module)
    functions: dict[str, Any] = {}
    for command in CommandGroup.program.registered_commands:
        assert command.callback is not None
        functions[command.name or command.callback.__name__.replace("_", "-")] = command.callback
    return {name: functions[name] for name in ENTRIES}


def _print_version(requested: bool) -> None:
    if requested:
        typer.echo(f"ballsocket {__version__}")
        raise typer.Exit()


@app.callback(invoke_without_command=True)
def root(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Print the list of commands if none is called."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())


def _replace_by_ascii(error: UnicodeError) -> tuple[str, int]:
    """Return ASCII text for characters that cannot be encoded, and the position after them."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(_ASCII_REPLACEMENTS.get(char, "?") for char in error.object[error.start : error.end]), error.end


class _Output(FileIO):
    """Output whose reader may leave, as `head` does: the command continues and writes its files."""

    has_reader = True

    def write(self, data: Any) -> int:
        """Write bytes, or discard them if nobody reads them any more."""
        try:
            return super().write(data)
        except BrokenPipeError:
            self.has_reader = False
            _discard_output(self)
            return len(data)


def _tolerant(stream: Any) -> Any:
    """Return a stream to the same file for which every character can be encoded, and whose reader may leave."""
    if not isinstance(stream, TextIOWrapper):
        return stream
    raw = getattr(stream.buffer, "raw", stream.buffer)  # without a buffer if Python is unbuffered
    if type(raw) is FileIO:
        buffer = BufferedWriter(_Output(raw.fileno(), "w", closefd=False))
        stream = TextIOWrapper(buffer, stream.encoding, line_buffering=stream.line_buffering)
    stream.reconfigure(errors="degrade")
    return stream


def main() -> None:
    """Run the program; print errors that the user can correct as one line on stderr."""
    codecs.register_error("degrade", _replace_by_ascii)
    sys.stdout, sys.stderr = _tolerant(sys.stdout), _tolerant(sys.stderr)
    if os.environ.get("COLUMNS", "").strip() == "0":  # width 0 means an unknown width
        del os.environ["COLUMNS"]
    for name in THREAD_VARIABLES:  # NumPy is not imported yet; threads cost more time than they save
        os.environ.setdefault(name, "1")
    with _exit_on_sigterm():
        sys.exit(_run())


@contextmanager
def _without_warnings() -> Iterator[None]:
    """Suppress floating-point warnings; results carry a status and notes."""
    import numpy

    with numpy.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        yield


def _run() -> int:
    """Run the command of the command line, and return the exit status."""
    status = MISUSE
    try:
        result = app(prog_name=PROGRAM, standalone_mode=False) or SUCCESS
        for stream in filter(None, (sys.stdout, sys.stderr)):
            stream.flush()  # now, so that an error in writing is still reported
        output = getattr(getattr(sys.stdout, "buffer", None), "raw", None)
        return int(result) or (SUCCESS if getattr(output, "has_reader", True) else BROKEN_PIPE)
    except typer.Abort:
        return INTERRUPTED
    except UsageError as error:
        message = _usage_message(error)
    except OSError as error:
        if error.filename is None:
            _discard_output()  # the remaining output would fail again when Python exits
        message = f"{error.filename or 'output'}: {error.strerror or error}"
    except ValueError as error:
        message = str(error).replace("\\\\", "\\")  # quoted paths of Windows
    except ImportError as error:
        message = str(error)
    except RuntimeError as error:  # a worker process died several times
        message, status = str(error), FAILURE
    except (ArithmeticError, MemoryError) as error:
        message, status = f"the numbers are too large or too small to compute with ({error})", FAILURE
    print_message(message)
    return status


def _usage_message(error: Any) -> str:
    """Return the message of a wrong command line; for an unknown option with no similar one, add where to look."""
    checks: list[Any] = getattr(error.__cause__ or error.__context__, "errors", list)()  # of typer's check of a type
    if checks:
        from ..core.checks import shown  # NumPy, which it imports, is not needed for --help

        return f"{error.param.opts[0]} must be {_allowed_text(checks[0])}, got {shown(checks[0]['input'])}"
    message: str = error.format_message()
    example = re.search(r"'([^']+)'", getattr(getattr(error, "param", None), "help", None) or "")
    if message.startswith("Missing"):
        name = error.param.opts[0]
        if name.startswith("-") and example:
            return f"{name} is missing: {name} '{example[1]}', for example"
        return f"{name} is missing: {error.param.help}"
    if not hasattr(error, "option_name") or error.ctx is None or set(error.possibilities or ()) - {"--help"}:
        return message
    return f"No such option: {error.option_name}; {error.ctx.command_path} -h lists them"


def _allowed_text(check: Mapping[str, Any]) -> str:
    """Describe the values that a failed check of typer allows."""
    kind, limits = check["type"], check.get("ctx", {})
    bounds = {"ge": "at least", "gt": "above", "le": "at most", "lt": "below"}
    for name, text in bounds.items():
        if name in limits:
            return f"{text} {limits[name]}"
    kinds = {"int": "a whole number", "float": "a number", "bool": "true or false"}
    own_text: str = check["msg"].removeprefix("Value error, ").removeprefix("Input should be ").rstrip(".")
    if " is not one of " in own_text:
        own_text = f"one of {own_text.partition(' is not one of ')[2]}"
    return kinds.get(kind.partition("_")[0], own_text)


def print_message(message: str) -> None:
    """Print a message as one line of limited length on stderr if stderr can be written to."""
    text = " ".join(message.split())
    if len(text) > _MAX_MESSAGE_LENGTH:
        text = f"{text[: _MAX_MESSAGE_LENGTH // 2]} ... {text[-_MAX_MESSAGE_LENGTH // 4 :]}"
    try:
        print(f"ballsocket: {_escape(text)}", file=sys.stderr, flush=True)
    except OSError:
        _discard_output(sys.stderr)


def fail(message: str) -> NoReturn:
    """Print one line on stderr, and exit with the status of a failed computation."""
    print_message(message)
    raise typer.Exit(FAILURE)


def _escape(text: str) -> str:
    return "".join(char if char.isprintable() else ascii(char)[1:-1] for char in text)


def echo_path(path: str | Path, more: str = "") -> None:
    """Print the path or address of a written file or folder, with escapes for characters that are not printable."""
    from ..core.storage.atomic_files import address_of

    typer.echo(_escape(f"{address_of(path) or path}{more}"))


def _discard_output(stream: TextIO | FileIO | None = None) -> None:
    """Redirect a stream to the null device, so that buffered output causes no error when Python exits."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), (stream or sys.stdout).fileno())


@contextmanager
def _exit_on_sigterm() -> Iterator[None]:
    """Exit through Python on SIGTERM, so that temporary folders are removed."""

    def exit_with_status(number: int, frame: Any) -> None:
        sys.exit(128 + number)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, exit_with_status)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
