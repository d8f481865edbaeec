"""Joints of files of other kinds: described there, or named as a preset or a joint file."""

from __future__ import annotations

from pathlib import Path

from ..core.checks import check_text, nearest, normalise_name, shown
from ..core.input_files import resolve_input
from ..problem.presets import joints
from .joint_file import JointFile, JointTables, describe_joint, read_joint

_PARTS = ("liner", "ball", "backing", "cup")
"""Tables that describe a joint together with [joint]."""


def joint_in(tables: JointTables, folder: Path) -> JointFile:
    """Create the joint of a file from its tables, or read it by its name.

    Parameters
    ----------
    tables : JointTables
        `joint` is a table, or the name of a preset or of a joint file in the folder; then no other table describes it.
    folder : Path

    Raises
    ------
    ValueError
        One sentence: the error, and the nearest allowed name.
    OSError
        A joint file cannot be read.
    """
    if tables.joint is None:
        raise ValueError("a joint is needed: a joint file, a preset's name, or a table [joint]")
    if not isinstance(tables.joint, str):
        return describe_joint(tables)
    described = [part for part in _PARTS if getattr(tables, part) is not None]
    if described:
        name = shown(tables.joint)
        raise ValueError(f"joint = {name} is a whole joint: [{described[0]}] belongs to a table [joint]")
    return _named(tables.joint, folder)


def _named(name: str, folder: Path) -> JointFile:
    """Return a preset, or read a joint file of the folder."""
    if not check_text("joint", name):
        raise ValueError("joint is empty")
    if normalise_name(name) in joints:
        return JointFile(joints[normalise_name(name)], {})
    if not resolve_input(folder / name).is_file():
        raise ValueError(f"joint {shown(name)} is neither a file nor a preset{nearest(name, joints)}")
    return read_joint(folder / name)
