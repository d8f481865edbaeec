"""Command `orient`: contact of a cup in many orientations."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import degrees
from typing import Annotated, Any

import numpy
import typer

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.kinds import Kind
from ..core.quantities import CUP
from ..elasticity.off_axis.model import Sphere
from ..elasticity.off_axis.orientations import Orientations
from ..elasticity.off_axis.orientations import orient as press_orientations
from ..files.joint_options import LOAD, PARTS, RIM
from ..files.units import as_given, parse
from ..model_catalogue import with_gap
from ..reports.orientation_plots import orientation_figure
from ..studies.expressions import parse_ends, parse_limit
from ..studies.limits import Limit
from ..studies.orientation_answer import LIMITED_FIELDS, describe_orientations, limits_summary
from .elasticity_options import RingTable, solver_progress
from .options import (
    GapName,
    JointName,
    JointOptions,
    OutputOptions,
    expand_groups,
    needed_load,
)
from .root import app, fail


@dataclass(frozen=True, kw_only=True)
class OrientationOptions:
    """Options of the load's direction and of the orientations of the cup."""

    inclination: Annotated[
        str, typer.Option(help="Radiographic inclinations in degrees: a range '30..60 deg', or one angle '45 deg'.")
    ] = "30..60 deg"
    anteversion: Annotated[
        str, typer.Option(help="Radiographic anteversions in degrees: a range '0..30 deg', or one angle '20 deg'.")
    ] = "0..30 deg"
    step: Annotated[
        str | None,
        typer.Option(
            help="Step of both angles in degrees: '5 deg' for its multiples and both ends. Default: at most 13 values."
        ),
    ] = None
    points: Annotated[
        int | None, typer.Option(min=1, max=91, help="Number of equally spaced values of each angle. Not with --step.")
    ] = None
    gap: GapName = None
    limit: Annotated[
        list[str] | None,
        typer.Option(
            help="Limit of edge_distance, max_pressure or half_angle: 'edge_distance>=1 mm'. Repeat for several. "
            "Default: no limit."
        ),
    ] = None

    def angles(self) -> dict[str, Numbers]:
        """Return the values of both angles in rad."""
        return {name: self._angle(name) for name in ("inclination", "anteversion")}

    def _angle(self, name: str) -> Numbers:
        text = getattr(self, name)
        ends = parse_ends(name, text, Kind.ANGLE) if ".." in text else (parse(name, text, Kind.ANGLE),) * 2
        with as_given({name: text}):
            for end in ends:
                CUP[name].check(end)
        low, high = sorted(ends)
        if self.points == 1 and low != high:
            raise ValueError(f"--points 1 is not possible for the range {text}: give at least 2, or one angle")
        if self.points is None:
            return numpy.radians(_even_degrees(round(degrees(low), 9), round(degrees(high), 9), self.step))
        if self.step is not None:
            raise ValueError("--step and --points are one too many: either fixes the other")
        return numpy.unique(numpy.linspace(low, high, self.points))

    def read_limits(self) -> list[Limit]:
        """Read the limits.

        Raises ValueError: a limit of a quantity that orientations do not have.
        """
        limits = [parse_limit(text) for text in self.limit or ()]
        for limit in limits:
            if limit.name not in LIMITED_FIELDS:
                raise ValueError(f"--limit of {limit.name} is not possible here; possible: {', '.join(LIMITED_FIELDS)}")
        return limits


_ROUND_STEPS = (0.5, 1.0, 2.0, 2.5, 5.0, 10.0, 15.0)  # steps in degrees that are used without a request

_USUAL_VALUES, _MAX_VALUES = 13, 91
"""Largest number of values of an angle, without a requested step and with one."""


def _even_degrees(low: float, high: float, step: str | None) -> Numbers:
    """Return the ends of a range in degrees and the multiples of a step between them.

    Raises ValueError: a step that is not above 0, or more than 91 values.
    """
    if step is None:
        chosen = next(size for size in _ROUND_STEPS if (high - low) / size <= _USUAL_VALUES - 1)
    else:
        chosen = degrees(parse("step", step, Kind.ANGLE))
        require("step", chosen, chosen > 0, "a step (degrees) is above 0")
    if (high - low) / chosen > _MAX_VALUES - 1:
        raise ValueError(f"step = {chosen:g} degrees makes more than {_MAX_VALUES} values of an angle")
    multiples = chosen * numpy.arange(numpy.ceil(low / chosen), numpy.floor(high / chosen) + 1)
    return numpy.unique(numpy.round([low, *multiples, high], 9))


@app.command()
@expand_groups
def orient(
    *,
    joint: JointName = None,
    joint_options: Annotated[JointOptions, (*PARTS, *LOAD, "load.direction", "cup.side", *RIM)],
    orientation: OrientationOptions,
    rings: Annotated[RingTable, "sphere"],
    output: OutputOptions,
) -> None:
    """Map edge distance and peak pressure over cup orientations.

    The load has a fixed direction in the body while the cup rotates through inclinations and anteversions. The model
    sphere (linear elasticity) solves every orientation. --limit finds the orientations within limits.

    Exit status: 0 success, 2 wrong input, 3 no orientation has a result.
    """
    output.check()
    limits = orientation.read_limits()
    angles: dict[str, Any] = orientation.angles()
    if output.figure is not None and all(len(values) == 1 for values in angles.values()):
        raise ValueError("--figure needs a range of an angle, such as --inclination 30..60; got one orientation")
    file = joint_options.read(joint)
    if "tilt" in file.aim:
        raise ValueError("the load of the file has a tilt from the cup's axis; give its --direction in the body")
    model = replace(with_gap(rings.model() or Sphere(), orientation.gap), cup=file.cup).with_direction(**file.aim)
    with solver_progress("sphere"):
        orientations: Orientations = press_orientations(file.joint, model=model, **angles, **needed_load(file))
    output.print(
        lambda: {**orientations.summary(), **limits_summary(orientations, limits)},
        lambda: describe_orientations(orientations, limits),
    )
    output.draw(lambda: orientation_figure(orientations, output.units, limits))
    if not orientations.held.any():
        fail("no orientation has an answer (see the statuses)")
