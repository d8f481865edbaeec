"""TOML at the door: every file that a user hands in is read here, bounded, and refused in one sentence."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

Made = TypeVar("Made")

MOST = 100_000
"""Bytes that a file may have."""


def read_toml(path: Path, kind: str, make: Callable[[Mapping[str, Any]], Made]) -> Made:
    """What is made of a file; see `parse_toml`.

    Raises
    ------
    ValueError
        One sentence: what is wrong.
    OSError
        The file cannot be read.
    """
    with path.open("rb") as stream:
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


def _content(raw: bytes, title: str, kind: str) -> Mapping[str, Any]:
    if len(raw) > MOST:
        raise ValueError(f"{title} is larger than {MOST} bytes; a {kind} file is a few lines")
    try:
        return tomllib.loads(raw.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise ValueError(f"{title} is not text in UTF-8: {error.reason} at byte {error.start}") from error
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{title} is not TOML: {error}") from error
    except RecursionError as error:
        raise ValueError(f"{title} is no {kind} file: its brackets are nested too deeply") from error
