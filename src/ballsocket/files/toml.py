"""TOML files of users: bounded in size and depth, and refused in one sentence."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from math import isinf
from pathlib import Path
from typing import Any, TypeVar

from ..core.checks import shown
from ..core.input_files import open_input

Result = TypeVar("Result")

MAX_FILE_SIZE = 100_000  # largest size of a file in bytes

_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.){0,80}+"|'[^'\n]{0,80}+')[ \t]*+"""
_LONG_KEY = re.compile(rf"(?<![\w-])(?:{_PART}\.[ \t]*+){{16}}")
"""Keys of 16 parts, `a.b.c...`, which no file needs; the parser takes seconds for one of some thousand parts."""


def read_toml(path: Path, kind: str, make: Callable[[Mapping[str, Any]], Result]) -> Result:
    """Read a file and convert its content; see `parse_toml`.

    Raises ValueError: one sentence: the error.
    Raises OSError: the file cannot be read.
    """
    with open_input(path) as stream:
        raw = stream.read(MAX_FILE_SIZE + 1)
    return parse_toml(raw, path.name, kind, make)


def parse_toml(raw: bytes, title: str, kind: str, make: Callable[[Mapping[str, Any]], Result]) -> Result:
    """Convert the content of a file, TOML in UTF-8 of at most `MAX_FILE_SIZE` bytes, with the function `make`.

    Every message begins with `title`, the name of the file. `kind` is the expected kind in a word: "joint", "study".

    Raises ValueError: one sentence: the error.
    """
    content = _content(raw, title, kind)
    try:
        return make(content)
    except ValueError as error:
        raise ValueError(f"{title}: {error}{_other_kind(content, kind, title)}") from error


_KINDS = (
    (("axes", "samples", "table"), "study", "study"),
    (("question", "context_of_use"), "question", "evidence"),
    (("free", "machine"), "measurement", "identify"),
    (("cycle", "activity"), "hip", "hip"),
)
"""Tables by which a file is known, its kind, and the command that reads it."""

_TABLE_ENDINGS = (".csv", ".tsv", ".xlsx")
_TABLE_KEYS = {
    "study": "[table] path",
    "hip": "[cycle] file",
    **dict.fromkeys(("measurement", "wear test"), "[[data]] file"),
}
"""Table and key that name a table of numbers, by the kind of the file."""


def _other_kind(content: Mapping[str, Any], kind: str, title: str) -> str:
    """Name the command for a file of another kind; empty if it looks like the expected kind."""
    designs = content.get("design")
    if isinstance(designs, list) and "session" not in kind:
        return (
            f"; this is a session file with {len(designs)} of the explorer's designs: start `ballsocket app`, open the "
            "file on its page, and save one design as TOML"
        )
    for tables, found, command in _KINDS:
        if any(table in content for table in tables):
            if found == "hip" and "data" in content:
                found, command = "wear test", "identify"
            related = {kind, found} == {"hip", "wear test"} and "data" not in content
            return "" if found == kind or related else f"; this is a {found} file: ballsocket {command} {title}"
    is_joint = kind != "joint" and isinstance(content.get("joint"), Mapping) and "data" not in content
    return f"; this is a joint file: ballsocket press {title}" if is_joint else ""


def _content(raw: bytes, title: str, kind: str) -> Mapping[str, Any]:
    """Parse TOML; ValueError if it is too large, not TOML, or empty."""
    if len(raw) > MAX_FILE_SIZE:
        raise ValueError(f"{title} is larger than {MAX_FILE_SIZE} bytes; a {kind} file is a few lines")
    if title.lower().endswith(_TABLE_ENDINGS):
        hint = f": name the table in it, {_TABLE_KEYS[kind]} = {title!r}" if kind in _TABLE_KEYS else ""
        raise ValueError(f"{title} is a table of numbers, and a {kind} file is TOML{hint}")
    try:
        text = raw.decode("utf-8-sig")  # as editors on Windows write it
        if _LONG_KEY.search(text):
            raise ValueError("a name of more than 16 parts with dots between them")
        content = tomllib.loads(text, parse_float=_number)
    except UnicodeDecodeError as error:
        raise ValueError(f"{title} is not text in UTF-8: {error.reason} at byte {error.start}") from error
    except RecursionError as error:
        raise ValueError(f"{title} is no {kind} file: its brackets are nested too deeply") from error
    except ValueError as error:  # TOMLDecodeError, or a number of thousands of digits
        raise ValueError(f"{title} is not TOML: {error}") from error
    if not content:
        raise ValueError(f"{title} is empty: a {kind} file has tables, such as [joint]")
    return content


def toml_text(content: Mapping[str, Any]) -> str:
    """Write tables as the text of a TOML file: keys first, then tables, then lists of tables.

    Values are texts, numbers, truth values, lists of them, tables, and lists of tables.

    Examples
    --------
    >>> print(toml_text({"name": "cup", "joint": {"clearance": "0.1 mm"}}), end="")
    name = "cup"
    <BLANKLINE>
    [joint]
    clearance = "0.1 mm"
    """
    return "\n".join([*_table_lines(content, ()), ""]).lstrip("\n")


def _table_lines(content: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    tables = {key: value for key, value in content.items() if isinstance(value, Mapping)}
    lists = {
        key: value
        for key, value in content.items()
        if isinstance(value, list | tuple) and value and isinstance(value[0], Mapping)
    }
    for key, value in content.items():
        if key not in tables and key not in lists:
            yield f"{_key(key)} = {_value(value)}"
    for key, table in tables.items():
        yield from ("", f"[{'.'.join(map(_key, (*path, key)))}]")
        yield from _table_lines(table, (*path, key))
    for key, rows in lists.items():
        for row in rows:
            yield from ("", f"[[{'.'.join(map(_key, (*path, key)))}]]")
            yield from _table_lines(row, (*path, key))


def _key(name: str) -> str:
    """Write a key; in quotes if it has other characters than letters, digits, hyphens and underscores."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _value(name)


def _value(value: Any) -> str:
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    return repr(float(value)) if isinstance(value, float) else str(value)


def _number(text: str) -> float:
    """Convert a number; ValueError for one that is too large, unless the text is infinity."""
    number = float(text)
    if isinf(number) and "inf" not in text:
        raise ValueError(f"{shown(text)} is too large a number")
    return number
