"""TOML at the door: every file that a user hands in is read here, bounded, and refused in one sentence."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Mapping
from math import isinf
from pathlib import Path
from typing import Any, TypeVar

from ..core.checks import shown
from ..core.input_files import open_input

Made = TypeVar("Made")

MOST = 100_000
"""Bytes that a file may have."""

_PART = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.){0,80}+"|'[^'\n]{0,80}+')[ \t]*+"""
_LONG_KEY = re.compile(rf"(?<![\w-])(?:{_PART}\.[ \t]*+){{16}}")
"""A key of so many parts, `a.b.c...`, is in no file; the parser would take seconds over one of some thousand."""


def read_toml(path: Path, kind: str, make: Callable[[Mapping[str, Any]], Made]) -> Made:
    """What is made of a file; see `parse_toml`.

    Raises
    ------
    ValueError
        One sentence: what is wrong.
    OSError
        The file cannot be read.
    """
    with open_input(path) as stream:
        raw = stream.read(MOST + 1)
    return parse_toml(raw, path.name, kind, make)


def parse_toml(raw: bytes, title: str, kind: str, make: Callable[[Mapping[str, Any]], Made]) -> Made:
    """What is made of a file's content.

    Parameters
    ----------
    raw : bytes
        TOML in UTF-8, at most `MOST` bytes.
    title : str
        The file's name, with which every refusal begins.
    kind : str
        What sort of file is expected, in a word: "joint", "study".
    make : callable
        From its tables to what they stand for.

    Raises
    ------
    ValueError
        One sentence: what is wrong.
    """
    content = _content(raw, title, kind)
    try:
        return make(content)
    except ValueError as error:
        raise ValueError(f"{title}: {error}") from error


def table_of(content: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """The table of that name, empty where there is none; ValueError where it is something else."""
    part = content.get(name, {})
    if not isinstance(part, Mapping):
        raise ValueError(f"{name} = {shown(part)} must be a table: [{name}]")
    return part


def _content(raw: bytes, title: str, kind: str) -> Mapping[str, Any]:
    if len(raw) > MOST:
        raise ValueError(f"{title} is larger than {MOST} bytes; a {kind} file is a few lines")
    try:
        text = raw.decode("utf-8-sig")  # as editors on Windows write it
        if _LONG_KEY.search(text):
            raise ValueError("a name of more than 16 parts with dots between them")
        found = tomllib.loads(text, parse_float=_number)
    except UnicodeDecodeError as error:
        raise ValueError(f"{title} is not text in UTF-8: {error.reason} at byte {error.start}") from error
    except RecursionError as error:
        raise ValueError(f"{title} is no {kind} file: its brackets are nested too deeply") from error
    except ValueError as error:  # TOMLDecodeError, or a number of thousands of digits
        raise ValueError(f"{title} is not TOML: {error}") from error
    if not found:
        raise ValueError(f"{title} is empty: a {kind} file has tables, such as [joint]")
    return found


def _number(text: str) -> float:
    """Infinite only where that is what is written."""
    number = float(text)
    if isinf(number) and "inf" not in text:
        raise ValueError(f"{shown(text)} is too large a number")
    return number
