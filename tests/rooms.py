"""Rooms of the package: its directories, and each module directly in it."""

import ast
from functools import cache
from pathlib import Path

from .places import ROOT

PACKAGE = ROOT / "src" / "ballsocket"


COLLECTIONS = ("elasticity",)
"""Directories whose own directories are rooms: `elasticity/exact`."""


def room_of(path, package=PACKAGE):
    """Return the name of the room that a file of the package is in: `hip`, `elasticity/exact` or `cup.py`."""
    parts = path.relative_to(package).parts
    return "/".join(parts[:2]) if parts[0] in COLLECTIONS and len(parts) > 2 else parts[0]


def rooms():
    """Return the names of all rooms, directories first."""
    names = {room_of(path) for path in PACKAGE.rglob("*.py")}
    return sorted(names, key=lambda name: (name.endswith(".py"), name))


def files_of(room):
    """Return the Python files of a room in the order of their paths."""
    path = PACKAGE / room
    return sorted(file for file in path.rglob("*.py") if room_of(file) == room) if path.is_dir() else [path]


def shown(path):
    """Return a path relative to the repository, as editors and terminals link it."""
    path = Path(path).resolve()
    return path.relative_to(ROOT).as_posix() if path.is_relative_to(ROOT) else str(path)


@cache
def tree_of(path):
    """Parse a module once for all tests."""
    return ast.parse(path.read_bytes())
