"""Calls of tools: arguments checked and restricted to the folder of the server, and a process with limits.

The command of a call runs in a separate process, which is killed with its children at a time limit.
"""

from __future__ import annotations

import asyncio
import json
import math
import os
import signal
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

from typer.models import ArgumentInfo

from ..core.checks import check_names, known_name, needs, shown
from ..core.executors.processes import available_cores
from ..core.input_files import resolve_inside, resolve_path, restriction_variables
from ..core.storage.atomic_files import cache_folder, write_text
from ..files.toml import MAX_FILE_SIZE, read_toml
from .tools import TOOLS, Commands, Tool, option, parameters

_MAX_CHARACTERS = 300  # of a text
_MAX_VALUES = 50  # of a list
MAX_ANSWER = 2_000_000  # bytes


def command_line(name: str, arguments: Mapping[str, Any], folder: Path, commands: Commands) -> list[str]:
    """Return the command and its arguments for a call of a tool.

    Files outside the folder of the server are refused; the content of a file is written to it. Raises ValueError for
    an argument that is missing, unknown or not allowed, and OSError if the folder cannot be read or written.
    """
    tool = TOOLS[known_name("tool", name, TOOLS)]
    offered = parameters(tool, commands)
    check_names(arguments, (*offered, *(("file", "content") if tool.file else ())), f"in a call of {name}")
    for parameter in tool.required:
        if parameter not in arguments:
            raise ValueError(f"{parameter} is missing: {option(offered[parameter]).help}")
    operands, options = [], []
    for parameter in (parameter for parameter in offered if arguments.get(parameter) is not None):
        texts = _texts(parameter, arguments[parameter])
        if isinstance(option(offered[parameter]), ArgumentInfo):
            operands += [_checked_operand(text, folder) for text in texts]
        else:
            options += [f"--{parameter.replace('_', '-')}={text}" for text in texts]
    if tool.file:
        path = _file(tool, arguments, folder)
        operands.append(_checked_operand(path.relative_to(folder).as_posix(), folder))
        options += [f"{tool.writes}={path.stem}-pack"] if tool.writes else []
    return [tool.command, *operands, *tool.fixed, *options, "--json"]


def _texts(name: str, argument: Any) -> Iterator[str]:
    """Yield the values of an argument as text: each is text or a finite number."""
    values = argument if isinstance(argument, list) else [argument]
    if len(values) > _MAX_VALUES:
        raise ValueError(f"{name} has {len(values)} values: at most {_MAX_VALUES}")
    for value in values:
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise ValueError(f"{name} = {shown(value)} must be text with a unit, or a number in mm, N, MPa, degrees")
        if isinstance(value, float) and not math.isfinite(value):
            raise ValueError(f"{name} = {value} must be finite")
        text = f"{value:.0f}" if isinstance(value, float) and value.is_integer() else str(value)
        if len(text) > _MAX_CHARACTERS or not text.isprintable():
            raise ValueError(f"{name} = {shown(value)} must be one line of at most {_MAX_CHARACTERS} characters")
        yield text


def _checked_operand(name: str, folder: Path) -> str:
    """Check that a name stays inside the folder, and return it as an operand, which does not begin like an option."""
    if Path(name).is_absolute():
        raise ValueError(f"{shown(name)} lies outside the folder of this server: name a file in that folder")
    resolve_inside((resolve_path(folder),), folder / name, name)
    return f"./{name}" if name.startswith("-") else name


def _file(tool: Tool, arguments: Mapping[str, Any], folder: Path) -> Path:
    """Return the file of a call, by name or from its content. The called process checks further file names."""
    name, content = arguments.get("file"), arguments.get("content")
    if (name is None) == (content is None):
        raise ValueError(f"either a file is needed, or content: TOML about {tool.file}, or an object with its tables")
    if content is not None:
        path = _stored_content(_toml(content) if isinstance(content, Mapping) else content, folder)
    elif isinstance(name, str):
        path = folder / _checked_operand(next(_texts("file", name)), folder)
        if not path.is_file():
            raise ValueError(f"{shown(name)} does not exist in the folder of this server")
    else:
        raise ValueError(f"file = {shown(name)} must be text")
    for key in tool.forbidden:
        if key in read_toml(path, tool.command, dict):
            raise ValueError(f"{key} is not for this server: leave it out of the file")
    return path


def _toml(content: Mapping[str, Any]) -> str:
    needs("mcp", "tomli_w")
    import tomli_w

    try:
        return tomli_w.dumps(content)
    except (TypeError, AttributeError) as error:
        raise ValueError("content has null or a key that is not text: leave out keys without a value") from error
    except RecursionError as error:
        raise ValueError("content is nested too deeply: a file has tables of keys") from error


def _stored_content(content: Any, folder: Path) -> Path:
    """Write content to a file of the folder that is named by its hash, and return the path."""
    if not isinstance(content, str):
        raise ValueError(f"content = {shown(content)} must be text in TOML, or an object")
    raw = content.encode("utf-8", errors="replace")
    if len(raw) > MAX_FILE_SIZE:
        raise ValueError(f"the content is larger than {MAX_FILE_SIZE} bytes")
    path = folder / f"asked-{sha256(raw).hexdigest()[:12]}.toml"
    return path if path.is_file() else write_text(path, raw.decode("utf-8"))


@dataclass(frozen=True)
class CallResult:
    """Result of a call: an answer, a refusal, or both if the answer is incomplete."""

    answer: dict[str, Any] | None
    refusal: str = ""


async def run(arguments: Sequence[str], folder: Path, longest: float) -> CallResult:
    """Run a command in a separate Python process that works in a folder for at most `longest` s; return its result.

    `arguments` are those of Python: of the program, the name of the command and its arguments.
    """
    with _lifeline() as stdin:
        process = await asyncio.create_subprocess_exec(
            sys.executable,
            *arguments,
            cwd=folder,
            env={**os.environ, **restriction_variables((folder, cache_folder()))},
            stdin=stdin,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            start_new_session=True,
        )
        try:
            out, err = await asyncio.wait_for(process.communicate(), longest)
        except TimeoutError:
            return CallResult(None, f"stopped after {longest:g} s, the time limit of a call here{_RESUME}")
        finally:
            with suppress(OSError):
                if hasattr(os, "killpg"):
                    os.killpg(process.pid, signal.SIGKILL)
                elif process.returncode is None:
                    process.kill()
            await process.wait()
    lines = err.decode("utf-8", errors="replace").splitlines()
    messages = [line.removeprefix("ballsocket: ") for line in lines if line.startswith("ballsocket: ")]
    refusal = "; ".join(messages) or "its process died; it may have had too little memory"
    if len(out) > MAX_ANSWER:
        return CallResult(None, f"the answer has {len(out)} bytes; allowed are {MAX_ANSWER}: request fewer points")
    return CallResult(json.loads(out) if out.strip() else None, "" if process.returncode == 0 else refusal)


_RESUME = "; the finished parts of an evidence pack are stored: call the tool again to resume"


@contextmanager
def _lifeline() -> Iterator[int]:
    """Open a pipe whose reading end is for a child, and whose writing end closes when this process ends."""
    reading, writing = os.pipe()
    try:
        yield reading
    finally:
        os.close(writing)
        os.close(reading)


@dataclass(frozen=True)
class ToolCalls:
    """Calls of tools; at most one runs per core."""

    folder: Path  # of the files to read and write
    longest: float  # s, time limit of a call without its time in the queue
    commands: Commands
    program: Sequence[str]  # arguments of Python that run a command, before its name
    _slots: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(available_cores()))

    async def call(self, name: str, arguments: Mapping[str, Any]) -> CallResult:
        """Call a tool, and return its answer or the reason of a refusal."""
        try:
            command = command_line(name, arguments, self.folder, self.commands)
        except (ValueError, OSError) as error:
            return CallResult(None, " ".join(str(error).split()))
        async with self._slots:
            return await run([*self.program, *command], self.folder, self.longest)
