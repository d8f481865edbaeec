"""Rooms of the package: its directories, and each module that stands directly in it."""

import ast
from functools import cache
from pathlib import Path

from .places import ROOT

PACKAGE = ROOT / "src" / "ballsocket"


def directories():
    """Return the names of all directories of the package that hold modules."""
    return sorted(path.name for path in PACKAGE.iterdir() if path.is_dir() and any(path.rglob("*.py")))


def rooms():
    """Return the names of all rooms: `hip`, or `cup.py`."""
    return [*directories(), *sorted(path.name for path in PACKAGE.glob("*.py"))]


def files_of(room):
    """Return the Python files of a room in the order of their paths."""
    path = PACKAGE / room
    return sorted(path.rglob("*.py")) if path.is_dir() else [path]


def shown(path):
    """Return a path relative to the repository, as editors and terminals link it."""
    path = Path(path).resolve()
    return path.relative_to(ROOT).as_posix() if path.is_relative_to(ROOT) else str(path)


@cache
def tree_of(path):
    """Parse a module once for all tests."""
    return ast.parse(path.read_bytes())
