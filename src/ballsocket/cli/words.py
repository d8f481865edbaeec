"""What several commands read and write: joints by file, preset or number, loads, and JSON."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from ..core.checks import nearest, normalise_name
from ..core.input_files import resolve_input
from ..files.joint_file import JointFile, joint_of, read_joint, read_load, varied
from ..problem.dimensions import LENGTHS
from ..problem.presets import joints
from .answers import whole

AsJson = Annotated[bool, typer.Option("--json", help="One JSON object instead of the table.")]


@dataclass(frozen=True, kw_only=True)
class JointWords:
    """A joint in words, or what they change in that of a file or preset."""

    ball_radius: Annotated[str | None, typer.Option(help="R1, '16 mm'")] = None
    head_diameter: Annotated[str | None, typer.Option(help="2 R1, '32 mm', in place of --ball-radius")] = None
    clearance: Annotated[str | None, typer.Option(help="Radial clearance, '0.1 mm'")] = None
    diametral_clearance: Annotated[str | None, typer.Option(help="Twice that, in place of --clearance")] = None
    interference: Annotated[str | None, typer.Option(help="Of a preloaded joint, R1 - R2; asks sphere")] = None
    liner_thickness: Annotated[str | None, typer.Option(help="L, '6 mm'; inf is a massive socket")] = None
    outer_radius: Annotated[
        str | None, typer.Option(help="Of the liner, or its shell, in place of --liner-thickness")
    ] = None
    outer_diameter: Annotated[str | None, typer.Option(help="Twice that, '48 mm'")] = None
    young: Annotated[str | None, typer.Option(help="Young's modulus of the liner, '1 GPa'")] = None
    poisson: Annotated[str | None, typer.Option(help="Poisson's ratio of the liner")] = None
    liner: Annotated[
        str | None, typer.Option(help="Liner material by name; --young and --poisson win over its own")
    ] = None
    ball_young: Annotated[str | None, typer.Option(help="Young's modulus of the ball; none is a rigid ball")] = None
    ball_poisson: Annotated[str | None, typer.Option(help="Poisson's ratio of the ball")] = None
    ball: Annotated[
        str | None, typer.Option(help="Ball material by name; --ball-young and --ball-poisson win over its own")
    ] = None

    def tables(self) -> dict[str, dict[str, str]]:
        """The tables of a joint file that the words make up."""
        lengths = {name: getattr(self, name) for name in LENGTHS if hasattr(self, name)}
        liner = {"material": self.liner, "young": self.young, "poisson": self.poisson}
        ball = {"material": self.ball, "young": self.ball_young, "poisson": self.ball_poisson}
        tables = {"joint": given(lengths), "liner": given(liner), "ball": given(ball)}
        return {name: table for name, table in tables.items() if table}

    def or_named(self, name: str | None) -> JointFile:
        """The joint in words, or that of a file or preset with what the words change."""
        tables = self.tables()
        if name is None and not tables:
            raise ValueError(
                "a joint is needed: a file, a preset's name, or --ball-radius --clearance --liner-thickness ..."
            )
        if name is None:
            return joint_of(tables)
        return varied(named_joint(name), tables) if tables else named_joint(name)


@dataclass(frozen=True, kw_only=True)
class LoadWords:
    """A load, in place of that of the joint's file."""

    force: Annotated[str | None, typer.Option(help="Axial load, '3 kN'")] = None
    indentation: Annotated[str | None, typer.Option(help="Approach from first touch, '40 um'")] = None
    half_angle: Annotated[str | None, typer.Option(help="Contact half-angle, '40 deg'")] = None

    def or_of(self, file: JointFile) -> dict[str, float]:
        """The load in words, or that of the joint's file."""
        return load_of(vars(self), file)


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


def named_joint(name: str) -> JointFile:
    """A joint by its file or preset."""
    if not name:
        raise ValueError("the joint's name is empty")
    path = resolve_input(Path(name))
    if path.is_dir():
        raise ValueError(f"{name!r} is a folder; a joint file is needed")
    if path.exists():
        return read_joint(path)
    if normalise_name(name) in joints:
        return JointFile(joints[normalise_name(name)], {})
    if not path.parent.is_dir():
        raise ValueError(f"{name!r} is no file: there is no folder {str(path.parent)!r}")
    raise ValueError(f"{name!r} is neither a file nor a preset{nearest(name, joints)}")


def echo_json(answer: dict[str, Any]) -> None:
    """Print one JSON object, with what every answer says; a number that is missing is null."""
    try:
        text = json.dumps(whole(answer, sys.argv[1:]), indent=2, allow_nan=False)
    except ValueError as error:
        raise ArithmeticError("a result is infinite") from error
    typer.echo(text)
