"""What commands say of a force element: the law behind it, and what it loses."""

from __future__ import annotations

import keyword
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ..core.storage.atomic_files import check_parent_folder
from ..dynamics import Damping, ForceElement, Friction, Restitution
from ..io.joint_file import JointFile
from ..problem.cup import Cup
from ..studies.default_model import default_model
from ..studies.file import named_model


@dataclass(frozen=True, kw_only=True)
class ElementWords:
    """A force element in words, besides its joint."""

    model: Annotated[
        str | None, typer.Option(help="A model's name: tabulated (default), exact (where tables know no joint), ...")
    ] = None
    hysteresis: Annotated[float | None, typer.Option(help="Damping over force and speed, s/mm; none without it")] = None
    restitution: Annotated[float | None, typer.Option(help="In its place, with --impact-speed: 0 to 1")] = None
    impact_speed: Annotated[float | None, typer.Option(help="At which the restitution was seen, mm/s")] = None
    friction: Annotated[float | None, typer.Option(help="Coefficient of friction; none without it")] = None

    def element(self, file: JointFile) -> ForceElement:
        """The element of a joint file; in a cup that is not just a hemisphere it has a rim.

        Raises
        ------
        ValueError
            A model that has no law, and numbers that are not allowed.
        """
        model = default_model(file.joint, {}) if self.model is None else named_model(self.model)
        friction = None if self.friction is None else Friction(coefficient=self.friction)
        cup = None if file.cup == Cup() else file.cup
        try:
            return ForceElement(model, file.joint, damping=self._damping(), friction=friction, cup=cup)
        except TypeError as error:  # there is no law
            raise ValueError(str(error)) from error

    def _damping(self) -> Damping | None:
        seen = (self.restitution, self.impact_speed)
        if seen == (None, None):
            return None if self.hysteresis is None else Damping(hysteresis=self.hysteresis)
        if self.hysteresis is not None:
            raise ValueError("a hysteresis and a restitution are given; one is needed")
        if None in seen:
            raise ValueError("a restitution and the speed of its impact belong together: --restitution --impact-speed")
        return Restitution(restitution=self.restitution, impact_speed=self.impact_speed)


def checked_out(out: Path, ending: str) -> Path:
    """A file that can be written, with the right ending.

    Raises
    ------
    ValueError
        Another ending, or a folder that is not there.
    """
    if out.suffix.lower() != ending:
        raise ValueError(f"out {str(out)!r} must end in {ending}")
    check_parent_folder(out)
    return out


def identifier(path: Path) -> str:
    """A file's name as programs take it: letters, digits and _, and no word that C, Python or Modelica have."""
    name = re.sub(r"[^A-Za-z0-9_]", "_", path.stem)[:40]
    return name if name[:1].isalpha() and name not in _TAKEN else f"joint_{name}"[:40]


_MODELICA = "algorithm block connect constant discrete each encapsulated end equation external function initial inner"
_MORE = "input loop model Modelica outer output package parameter partial record redeclare then type when within"
_PROGRAMS = "exudyn mujoco numpy opensim pydrake assert errno float limits stdio stdlib string"
_TAKEN = {*keyword.kwlist, *sys.stdlib_module_names, *f"{_MODELICA} {_MORE} {_PROGRAMS}".split()}
