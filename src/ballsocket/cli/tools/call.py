"""From the arguments of a tool to the words of its command: checked, and inside the folder that was given."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from typer.models import ArgumentInfo

from ...core.checks import check_names, known_name, needs, shown
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
    name, content = arguments.get("file"), arguments.get("content")
    if (name is None) == (content is None):
        raise ValueError(f"either a file is needed, or content: TOML about {tool.file}, or an object with its tables")
    if content is None:
        path = _named_file(name, folder)
    else:
        path = _write_content(_toml(content) if isinstance(content, Mapping) else content, folder)
    for key in tool.forbidden:
        if key in read_toml(path, tool.file, dict):
            raise ValueError(f"{key} is not for this server: leave it out of the file")
    return path


def _named_file(name: Any, folder: Path) -> Path:
    """Return a file of the folder by its name."""
    if not isinstance(name, str):
        raise ValueError(f"file = {shown(name)} must be text")
    path = folder / _inside(next(_texts("file", name)), folder)
    if not path.is_file():
        raise ValueError(f"{shown(name)} is no file in the folder of this server")
    return path


def _toml(content: Mapping[str, Any]) -> str:
    """Write an object as TOML.

    Raises
    ------
    ValueError
        A value that TOML does not have.
    ImportError
        The writer of TOML is not installed.
    """
    needs("mcp", "tomli_w")
    import tomli_w

    try:
        return tomli_w.dumps(content)
    except (TypeError, AttributeError) as error:
        raise ValueError("content has null or a key that is no text: leave out keys without a value") from error
    except RecursionError as error:
        raise ValueError("content is nested too deeply: a file has tables of keys") from error


def _write_content(content: Any, folder: Path) -> Path:
    """Write content to a file of the folder, named by its fingerprint."""
    if not isinstance(content, str):
        raise ValueError(f"content = {shown(content)} must be text in TOML, or an object")
    raw = content.encode("utf-8", errors="replace")
    if len(raw) > MOST:
        raise ValueError(f"the content is larger than {MOST} bytes")
    path = folder / f"asked-{sha256(raw).hexdigest()[:12]}.toml"
    return path if path.is_file() else write_text(path, raw.decode("utf-8"))
