"""Command `orient`: contact of a cup in many orientations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy
import typer
from rich.console import Console

from ..core.arrays import Numbers
from ..core.quantities import CUP
from ..elasticity.finite_elements.progress import progress_to
from ..elasticity.off_axis.orientations import Orientations
from ..elasticity.off_axis.orientations import orient as press_orientations
from ..files.joint_file import JointFile, read_aim
from ..files.units import as_given
from ..reports.orientation_results import orientation_figure, print_orientations
from ..studies.expressions import parse_ends
from .elasticity_options import CupOptions, DirectionOptions
from .options import JointName, JointPartOptions, LoadOptions, OutputOptions, drop_missing, expand_groups
from .root import FAILURE, app, print_message


@dataclass(frozen=True, kw_only=True)
class OrientationOptions:
    """Options of the load's direction and of the orientations of the cup."""

    direction: Annotated[
        str | None,
        typer.Option(
            help="Direction of the load 'x,y,z' in the body: right, front, up. Default: as in the file, or up."
        ),
    ] = None
    inclination: Annotated[str, typer.Option(help="Range of the radiographic inclination in degrees.")] = "30..60 deg"
    anteversion: Annotated[str, typer.Option(help="Range of the radiographic anteversion in degrees.")] = "0..30 deg"
    points: Annotated[int, typer.Option(min=1, max=91, help="Number of values of each angle.")] = 13
    ring_width: Annotated[
        str | None,
        typer.Option(
            help="Width of the rings of the model in degrees. Default: 2 deg; finer is slower and more exact."
        ),
    ] = None

    def angles(self) -> dict[str, Numbers]:
        """Return the values of both angles in rad."""
        return {name: self._angle(name) for name in ("inclination", "anteversion")}

    def _angle(self, name: str) -> Numbers:
        """Return the values of one angle in rad."""
        low, high = parse_ends(name, getattr(self, name), CUP[name].kind)
        with as_given({name: getattr(self, name)}):
            CUP[name].check(numpy.array([low, high]))
        return numpy.unique(numpy.linspace(min(low, high), max(low, high), self.points))

    def read_direction(self, file: JointFile) -> Mapping[str, Any]:
        """Read the direction from the options or the joint file.

        Raises
        ------
        ValueError
            The file has a tilt from the cup's axis, which is not a direction in the body.
        """
        direction = read_aim(drop_missing({"direction": self.direction})) or file.aim
        if "tilt" in direction:
            raise ValueError("the load of the file has a tilt from the cup's axis; give its --direction in the body")
        return direction


@app.command()
@expand_groups
def orient(
    *,
    joint: JointName = None,
    joint_options: JointPartOptions,
    load: LoadOptions,
    orientation: OrientationOptions,
    cup: CupOptions,
    output: OutputOptions,
) -> None:
    """Map edge distance and peak pressure over cup orientations.

    The load has a fixed direction in the body while the cup rotates through inclinations and anteversions. The model
    sphere (linear elasticity) solves every orientation.

    Exit status: 0 success, 2 wrong input, 3 no orientation has a result.
    """
    output.check()
    angles: dict[str, Any] = orientation.angles()
    file = joint_options.read(joint)
    sphere = replace(DirectionOptions(ring_width=orientation.ring_width).model(), cup=cup.apply_to(file.cup))
    model = sphere.with_direction(**orientation.read_direction(file))
    status = Console(stderr=True).status("sphere")
    with status, progress_to(lambda text: status.update(f"sphere: {text}")):
        orientations: Orientations = press_orientations(file.joint, model=model, **angles, **load.read(file))
    output.print(orientations.summary, lambda: print_orientations(orientations))
    output.draw(lambda: orientation_figure(orientations))
    if not orientations.held.any():
        print_message("no orientation has an answer (see the statuses)")
        raise typer.Exit(FAILURE)
