"""What several commands read and write: joints by file, preset or number, and JSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import typer

from ..checks import nearest
from ..io.joint_file import JointFile, joint_of, read_joint, read_load
from ..presets import joints


def echo_json(answer: dict[str, Any]) -> None:
    """Print one JSON object; a number that is missing is null."""
    typer.echo(json.dumps(answer, indent=2, allow_nan=False))


def given(words: dict[str, str | None]) -> dict[str, str]:
    """The words that were given."""
    return {name: word for name, word in words.items() if word is not None}


def load_of(words: dict[str, str | None], file: JointFile) -> dict[str, float]:
    """The load in words, or that of the joint's file."""
    load = read_load(given(words)) or file.load
    if not load:
        options = [f"--{name.replace('_', '-')}" for name in words]
        raise ValueError(f"a load is needed: {', '.join(options[:-1])} or {options[-1]}")
    return load


def joint_file(name: str | None, described: dict[str, dict[str, str]]) -> JointFile:
    """A joint by its file or preset, or by the tables of a joint file in words."""
    if name is not None and described:
        raise ValueError("give a joint file or the joint's numbers, not both")
    if name is None and not described:
        raise ValueError(
            "a joint is needed: a file, a preset's name, or --ball-radius --clearance --liner-thickness ..."
        )
    return joint_of(described) if name is None else named_joint(name)


def named_joint(name: str) -> JointFile:
    """A joint by its file or preset."""
    if not name:
        raise ValueError("the joint's name is empty")
    path = Path(name)
    if path.is_dir():
        raise ValueError(f"{name!r} is a folder; a joint file is needed")
    if path.exists():
        return read_joint(path)
    if name in joints:
        return JointFile(joints[name], {})
    raise ValueError(f"{name!r} is neither a file nor a preset{nearest(name, joints)}")
