"""The words of a load that does not go along the cup's axis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import degrees, isfinite, pi
from time import perf_counter
from typing import Annotated, Any

import typer

from ..catalogue import off_axis
from ..contact import Contact
from ..core.kinds import Kind
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.directions import polar_angle
from ..elasticity.off_axis.model import Sphere
from ..files.joint_file import JointFile, read_aim
from ..files.units import parse
from ..problem import Joint
from ..problem.cup import Cup
from .elements import error_bars
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

    def refuse(self) -> None:
        """Raise ValueError for words that only `sphere` understands, where it is not asked."""
        if self.ring_width is not None:
            raise ValueError(f"--ring-width is for contact on the sphere: add --model {off_axis.name}, or a --tilt")

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


@dataclass
class Watched:
    """A model, with the seconds that its last press took."""

    model: Any
    seconds: float = 0.0

    def in_cup(self, cup: Cup) -> Watched:
        """Itself, in that cup."""
        self.model = self.model.in_cup(cup)
        return self

    def press(self, joint: Joint, **load: Any) -> Contact:
        """What the model answers."""
        start = perf_counter()
        contact: Contact = self.model.press(joint, **load)
        self.seconds = perf_counter() - start
        return contact


def along(sphere: Sphere, cup: Cup, aim: Mapping[str, Any]) -> Sphere:
    """The model in that cup, under a load of that aim."""
    return replace(sphere, cup=cup).with_direction(**aim)


def remark(contact: Any, seconds: float) -> str:
    """Where the contact lies in its cup, rings, time and error bars in a line."""
    took = f"rings of {degrees(contact.model.ring_width):.3g}°, {seconds:.2f} s"
    if contact.status.failed or contact.indentation == 0:
        return f"{off_axis.name}: {took}"
    where = f"load {degrees(contact.tilt):.3g}° from the cup's axis, {_rim(contact)}, {_largest(contact)}"
    return f"{off_axis.name}: {where}; {took}; error of the rings: {error_bars(contact)}"


def _rim(contact: OffAxisContact) -> str:
    distance = contact.edge_distance
    return (
        f"contact cut off by {max(-distance, 0.0):.1f} mm at the rim"
        if contact.edge_loaded
        else f"contact {distance:.1f} mm from the rim"
    )


def _largest(contact: OffAxisContact) -> str:
    if not isfinite(contact.max_pressure):
        return "pressure unbounded there"
    return f"largest pressure {degrees(polar_angle(contact.max_pressure_at)):.3g}° from the axis"
