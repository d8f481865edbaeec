"""From the arguments of a tool to the words of its command: checked, and inside the folder that was given."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from typer.models import ArgumentInfo

from ...core.checks import check_names, known_name, shown
from ...core.input_files import AllowedFolders, resolve_path
from ...core.storage.atomic_files import write_text
from ...files.toml import MOST, read_toml
from .schema import option, parameters
from .table import TOOLS, Tool

_LONGEST, _COUNT = 300, 50
"""Characters of a text, and texts of a list."""


def words_of(name: str, arguments: Mapping[str, Any], folder: Path) -> list[str]:
    """The words of a command.

    Parameters
    ----------
    name : str
        The tool's.
    arguments : mapping
    folder : Path
        Files are read and written there only; the content of one is put there.

    Raises
    ------
    ValueError
        One sentence: what is wrong, and what is right.
    OSError
        The folder cannot be read or written to.
    """
    tool = TOOLS[known_name("tool", name, TOOLS)]
    offered = parameters(tool)
    check_names(arguments, (*offered, *(("file", "content") if tool.file else ())), f"in a call of {name}")
    for each in tool.required:
        if each not in arguments:
            raise ValueError(f"{each} is missing: {option(offered[each]).help}")
    words, named = [], []
    for each in (each for each in offered if arguments.get(each) is not None):
        if isinstance(option(offered[each]), ArgumentInfo):
            named += [_inside(text, folder) for text in _texts(each, arguments[each])]
        else:
            words += [f"--{each.replace('_', '-')}={text}" for text in _texts(each, arguments[each])]
    if tool.file:
        path = _file(tool, arguments, folder)
        named.append(_operand(path.relative_to(folder).as_posix()))
        words += [f"{tool.writes}={path.stem}-pack"] if tool.writes else []
    return [tool.command, *named, *tool.fixed, *words, "--json"]


def _texts(name: str, value: Any) -> Iterator[str]:
    """The values of an option as text."""
    listed = value if isinstance(value, list) else [value]
    if len(listed) > _COUNT:
        raise ValueError(f"{name} has {len(listed)} values: at most {_COUNT}")
    for each in listed:
        if isinstance(each, bool) or not isinstance(each, str | int | float):
            raise ValueError(f"{name} = {shown(each)} must be text with a unit, or a number in mm, N, MPa, degrees")
        if isinstance(each, float) and not math.isfinite(each):
            raise ValueError(f"{name} = {each} must be finite")
        text = f"{each:.0f}" if isinstance(each, float) and each.is_integer() else str(each)
        if len(text) > _LONGEST or not text.isprintable():
            raise ValueError(f"{name} = {shown(each)} must be one line of at most {_LONGEST} characters")
        yield text


def _inside(name: str, folder: Path) -> str:
    """Check that a name stays inside the folder, and return it as an operand."""
    if Path(name).is_absolute():
        raise ValueError(f"{shown(name)} lies outside the folder of this server: name a file in that folder")
    AllowedFolders((resolve_path(folder),)).resolve(folder / name, name)
    return _operand(name)


def _operand(name: str) -> str:
    """Prefix a file name that begins like an option with the folder."""
    return f"./{name}" if name.startswith("-") else name


def _file(tool: Tool, arguments: Mapping[str, Any], folder: Path) -> Path:
    """Return the file of a call, by name or from its content. The called process checks further file names."""
    given = [arguments.get("file"), arguments.get("content")]
    if sum(each is not None for each in given) != 1:
        raise ValueError(f"either a file is needed, or content: TOML about {tool.file}")
    if not all(isinstance(each, str) for each in given if each is not None):
        raise ValueError("file and content must be text")
    path = _kept(arguments["content"], folder) if given[0] is None else _there(given[0], folder)
    for key in tool.forbidden:
        if key in read_toml(path, tool.file, dict):
            raise ValueError(f"{key} is not for this server: leave it out of the file")
    return path


def _there(name: Any, folder: Path) -> Path:
    """A file of the folder by its name."""
    path = folder / _inside(next(_texts("file", name)), folder)
    if not path.is_file():
        raise ValueError(f"{shown(name)} is no file in the folder of this server")
    return path


def _kept(content: str, folder: Path) -> Path:
    """Content as a file of the folder, named by what it holds."""
    raw = content.encode("utf-8", errors="replace")
    if len(raw) > MOST:
        raise ValueError(f"the content is larger than {MOST} bytes")
    path = folder / f"asked-{sha256(raw).hexdigest()[:12]}.toml"
    return path if path.is_file() else write_text(path, raw.decode("utf-8"))
