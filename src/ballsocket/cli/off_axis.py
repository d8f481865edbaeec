"""The words of a load that does not go along the cup's axis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import Annotated, Any

import typer

from ..cup import Cup
from ..io.joint_file import JointFile, read_aim
from ..io.units import parse
from ..kinds import Kind
from ..sphere.model import Sphere
from .words import given


@dataclass(frozen=True, kw_only=True)
class AimWords:
    """Where the load points, and in how wide rings `sphere` is to answer."""

    tilt: Annotated[str | None, typer.Option(help="Angle between load and cup's axis, '45 deg'; asks sphere")] = None
    direction: Annotated[
        str | None, typer.Option(help="Of the load, 'x,y,z': right, front, up of the body; asks sphere")
    ] = None
    ring_width: Annotated[str | None, typer.Option(help="sphere: '2 deg', finer is slower and closer")] = None

    def or_of(self, file: JointFile) -> dict[str, Any]:
        """The direction in words, or that of the joint's file; empty where there is none."""
        return read_aim(given({"tilt": self.tilt, "direction": self.direction})) or file.aim

    def model(self) -> Sphere:
        """Contact on the sphere with such rings."""
        if self.ring_width is None:
            return Sphere()
        return Sphere(ring_width=parse("ring_width", self.ring_width, Kind.ANGLE))


def aimed(cup: Cup, aim: Mapping[str, Any]) -> Cup:
    """The cup as a vertical load finds it that comes from where the load of the aim does.

    A direction of the body's leaves the cup where it is; models that take every load as the cup's own axis judge the
    rim by the tilt.
    """
    return cup.tilted(min(aim["tilt"], pi / 2)) if "tilt" in aim else cup


def along(sphere: Sphere, cup: Cup, aim: Mapping[str, Any]) -> Sphere:
    """The model in that cup, under a load of that aim."""
    return replace(sphere, cup=cup).along(**aim)
