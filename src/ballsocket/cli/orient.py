"""`orient`: how a cup may stand."""

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
from ..elasticity.off_axis.orientations import orient as stand
from ..io.joint_file import JointFile, read_aim
from ..io.units import as_given
from ..output.orientation_plot import orientation_figure
from ..output.orientation_terminal import print_orientations
from ..studies.expressions import parse_ends
from .elements import CupWords
from .groups import grouped
from .off_axis import AimWords
from .questions import FormWords
from .root import FAILURE, app, complain
from .words import JointWords, LoadWords, given


@dataclass(frozen=True, kw_only=True)
class StandWords:
    """Where the load points, and how the cup may stand."""

    direction: Annotated[
        str | None, typer.Option(help="Of the load, 'x,y,z': right, front, up of the body; upwards without it")
    ] = None
    inclination: Annotated[str, typer.Option(help="Radiographic, from and to, '30..60 deg'")] = "30..60 deg"
    anteversion: Annotated[str, typer.Option(help="Radiographic, from and to, '0..30 deg'")] = "0..30 deg"
    points: Annotated[int, typer.Option(min=1, max=91, help="Values of each angle")] = 13
    ring_width: Annotated[str | None, typer.Option(help="'2 deg', finer is slower and closer")] = None

    def angles(self) -> dict[str, Numbers]:
        """The values of both angles in rad."""
        return {name: self._angle(name) for name in ("inclination", "anteversion")}

    def _angle(self, name: str) -> Numbers:
        low, high = parse_ends(name, getattr(self, name), CUP[name].kind)
        with as_given({name: getattr(self, name)}):
            CUP[name].check(numpy.array([low, high]))
        return numpy.unique(numpy.linspace(min(low, high), max(low, high), self.points))

    def aim(self, file: JointFile) -> Mapping[str, Any]:
        """The direction in words, or that of the joint's file."""
        aim = read_aim(given({"direction": self.direction})) or file.aim
        if "tilt" in aim:
            raise ValueError("the load of the file is given by its tilt from the cup's axis; give it a --direction")
        return aim


@app.command()
@grouped
def orient(
    *,
    joint: Annotated[str | None, typer.Argument(help="A joint file (TOML), or the name of a preset.")] = None,
    words: JointWords,
    load: LoadWords,
    stands: StandWords,
    cup: CupWords,
    form: FormWords,
) -> None:
    """Map how a cup may stand: distance of the contact to the rim, and largest pressure, by its orientation.

    The load keeps its direction in the body while the cup is turned through inclinations and anteversions. Every
    orientation is pressed by full elasticity (sphere).

    Exit status: 0 done, 2 misuse, 3 no orientation has an answer.
    """
    form.check()
    angles: dict[str, Any] = stands.angles()
    file = words.or_named(joint)
    model = replace(AimWords(ring_width=stands.ring_width).model(), cup=cup.on(file.cup)).with_direction(
        **stands.aim(file)
    )
    status = Console(stderr=True).status("sphere")
    with status, progress_to(lambda text: status.update(f"sphere: {text}")):
        stood: Orientations = stand(file.joint, model=model, **angles, **load.or_of(file))
    form.print(stood.summary, lambda: print_orientations(stood))
    form.draw(lambda: orientation_figure(stood))
    if not stood.held.any():
        complain("no orientation has an answer (see the statuses)")
        raise typer.Exit(FAILURE)
