"""Named designs: session files with the recipe of each, and names of files after a design."""

from __future__ import annotations

import json
import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any
from urllib.parse import parse_qsl

from ...core.checks import check_names, shown
from ...files.joint_file import NO_DETAILS, JointFileTable, joint_of
from ...files.joint_toml import written_tables
from ...files.toml import MAX_FILE_SIZE, parse_toml, toml_text
from .screen import START, Screen, flat, link_of, read_link, read_query, with_load

MAX_DESIGNS = 50  # largest number of designs in a browser and in a session file
_DESIGN, _PAGE = "design", "page"
_JOINT_KEYS = (*JointFileTable.__struct_fields__, "preset")
_NOT_SAVED = (*_JOINT_KEYS, "theme")
_STEM_LENGTH = 60
_DEVICES = re.compile(r"(con|prn|aux|nul|(com|lpt)\d)(\..*)?", re.IGNORECASE)  # names that Windows refuses


def file_stem(name: str) -> str:
    """Return the name of a file after a design, without characters that a file system refuses.

    Examples
    --------
    >>> file_stem("hip 36: a/b"), file_stem("..."), file_stem("CON")
    ('hip-36-a-b', 'ballsocket', 'design-CON')
    """
    stem = re.sub(r"[^\w.]+", "-", unicodedata.normalize("NFKC", name))[:_STEM_LENGTH].strip("-._")
    return f"design-{stem}" if _DEVICES.fullmatch(stem) else stem or "ballsocket"


def session_text(links: Sequence[str]) -> str:
    """Return the text of a session file of the designs with these links.

    Raises ValueError for a link that cannot be read, too many designs, or a file that would be too long to read.
    """
    check_count(len(links))
    text = toml_text({_DESIGN: [_table_of(read_query(link)) for link in links]})
    if len(text.encode()) > MAX_FILE_SIZE:
        raise ValueError(f"the session file would be larger than {MAX_FILE_SIZE} bytes: delete some designs first")
    return text


def check_count(count: int) -> None:
    """Raise ValueError for no design, or more designs than a browser keeps."""
    if not 0 < count <= MAX_DESIGNS:
        raise ValueError(f"a session has 1 to {MAX_DESIGNS} designs, got {count}")


def _table_of(screen: Screen) -> dict[str, Any]:
    """Return the table of a design: its joint file, and the settings of its page."""
    page: dict[str, Any] = {}
    for name, value in parse_qsl(link_of(screen), keep_blank_values=True):
        *path, key = name.split(".")
        if name.split(".")[0] in _NOT_SAVED:
            continue
        table = page
        for part in path:
            table = table.setdefault(part, {})
        table[key] = [*table.get(key, ()), value] if key == "limit" else value
    return {**written_tables(screen.file), **({_PAGE: page} if page else {})}


def read_upload(text: str, screen: Screen) -> list[Screen]:
    """Read a joint file, or a session file in TOML or JSON, as one screen for each design.

    Settings and load of `screen` hold for a joint file, which states none. Heads of reports are left out: the path of
    a logo would be one of the server. Raises ValueError with the design, the key, the value and what is allowed.
    """
    if len(text.encode()) > MAX_FILE_SIZE:
        raise ValueError(f"the file is larger than {MAX_FILE_SIZE} bytes; a design is a few lines")
    if not text.lstrip("\ufeff \t\r\n").startswith("{"):
        return parse_toml(text.encode(), "the file", "joint or session", lambda content: _screens(content, screen))
    try:
        content = json.loads(text.lstrip("\ufeff"))
    except (ValueError, RecursionError) as error:
        raise ValueError(f"the file is not JSON: {error}") from error
    try:
        return _screens(content, screen)
    except ValueError as error:
        raise ValueError(f"the file: {error}") from error


def _screens(content: Mapping[str, Any], screen: Screen) -> list[Screen]:
    if _DESIGN not in content:
        return [_with_joint(screen, content, screen.file.load)]
    check_names(content, (_DESIGN,), "in a session file")
    designs = content[_DESIGN]
    if not isinstance(designs, list) or not all(isinstance(design, dict) for design in designs):
        raise ValueError(f"{_DESIGN} = {shown(designs)} must be tables [[{_DESIGN}]]")
    check_count(len(designs))
    return [_design(number, table) for number, table in enumerate(designs, start=1)]


def _design(number: int, table: Mapping[str, Any]) -> Screen:
    try:
        page = table.get(_PAGE, {})
        if not isinstance(page, dict):
            raise ValueError(f"{_PAGE} = {shown(page)} must be a table")
        if set(page) & set(_NOT_SAVED):
            raise ValueError(f"{shown(next(iter(set(page) & set(_NOT_SAVED))))} in [{_PAGE}] belongs to the design")
        pairs: dict[str, list[str]] = {}
        for name, value in flat(page):
            pairs.setdefault(name, []).append(value)
        joint = {key: value for key, value in table.items() if key != _PAGE}
        return _with_joint(read_link(pairs), joint, START.file.load)
    except ValueError as error:
        name = table.get("name", "")
        sentence = str(error).replace("in the link", f"in [{_PAGE}]")
        raise ValueError(f"design {number}{f' ({shown(name)})' if name else ''}: {sentence}") from error


def _with_joint(screen: Screen, tables: Mapping[str, Any], load: dict[str, float]) -> Screen:
    """Return a screen with the joint of the tables of a joint file, under this load if they state none."""
    return replace(screen, file=replace(with_load(joint_of(tables), load), report=NO_DETAILS))
