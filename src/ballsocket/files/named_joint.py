"""The joint of a file about more than a joint: described there, or by the name of a preset or of a joint file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..core.checks import check_text, nearest, normalise_name, shown
from ..core.input_files import resolve_input
from ..problem.presets import joints
from .joint_file import JointFile, joint_of, read_joint

PARTS = ("joint", "liner", "ball", "backing", "cup")
"""The tables that describe a joint."""


def joint_in(content: Mapping[str, Any], folder: Path) -> JointFile:
    """The joint of a file: from its tables, or by its name.

    Parameters
    ----------
    content : mapping
        `joint` is a table, or the name of a preset or of a joint file in the folder; then no other table describes it.
    folder : Path

    Raises
    ------
    ValueError
        One sentence: what is wrong, and the nearest thing that is right.
    OSError
        A joint file cannot be read.
    """
    given = content.get("joint")
    if isinstance(given, Mapping):
        return joint_of({name: content[name] for name in PARTS if name in content})
    others = [name for name in PARTS[1:] if name in content]
    if given is not None and others:
        raise ValueError(f"joint = {shown(given)} is a whole joint: [{others[0]}] belongs to a table [joint]")
    if given is None:
        raise ValueError("a joint is needed: a joint file, a preset's name, or a table [joint]")
    return _called(given, folder)


def _called(name: Any, folder: Path) -> JointFile:
    if not check_text("joint", name):
        raise ValueError("joint is empty")
    if normalise_name(name) in joints:
        return JointFile(joints[normalise_name(name)], {})
    if not resolve_input(folder / name).is_file():
        raise ValueError(f"joint {shown(name)} is neither a file nor a preset{nearest(name, joints)}")
    return read_joint(folder / name)
