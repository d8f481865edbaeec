"""Commands `export`, `fmu` and `deck`: a joint as a force element or as finite elements for other programs."""

from __future__ import annotations

import keyword
import re
import sys
from collections.abc import Mapping
from dataclasses import replace
from math import radians
from pathlib import Path
from typing import Annotated, Any, ClassVar

import typer

from ..core.checks import check_text, known_name, shown
from ..core.kinds import Kind
from ..core.storage.atomic_files import check_ending
from ..dynamics import Bristles, Damping, ForceElement, Friction, PreloadedElement, Prony, Restitution
from ..elasticity.off_axis.model import Sphere
from ..export import TARGETS, ExportJob
from ..files.joint_file import JointFile
from ..files.joint_options import JOINT, PARTS
from ..files.schema import FileTable, Length, Parsed, PlainNumber, Speed, Viscosity, meaning
from ..files.tables import written_in
from ..files.units import as_given, parse
from ..lubrication import Lubricant
from ..model_catalogue import OFF_AXIS, reference, with_gap
from ..problem.cup import AXIAL_TILT, Cup
from ..question import complete
from ..reports.accuracy_results import describe_rival, describe_tilted_rival
from ..reports.terminal import print_answer
from ..studies.run import default_model
from .elasticity_options import MeshTable, Yielding, solver_progress
from .options import GapName, JointName, JointOptions, ModelName, expand_groups, needed_load, requested_model
from .root import app, echo_path, print_message

_RING_WIDTH = radians(3.0)  # width of the rings that tabulate a preloaded joint, in rad
_NOTED_ERROR = 0.02  # relative error of the force of a preloaded element above which a message states it


class PronyTerms(Parsed):
    """Prony series of a relaxing liner: pairs of share and time, such as "0.3: 0.1 s, 0.2: 10 s"."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "string", "maxLength": 1000}

    @classmethod
    def parse(cls, name: str, value: Any) -> Prony:
        pairs = [term.split(":") for term in check_text(name, value).split(",")]
        if any(len(pair) != 2 for pair in pairs):
            raise ValueError(
                f"{name} must be pairs of share and time, such as '0.3: 0.1 s, 0.2: 10 s', got {shown(value)}"
            )
        return Prony(
            terms=tuple((parse(name, share, Kind.NUMBER), parse(name, time, Kind.DURATION)) for share, time in pairs)
        )


class ForceElementInputs(FileTable, frozen=True, kw_only=True):
    """Inputs of a force element, in addition to its joint and model."""

    hysteresis: Annotated[
        PlainNumber | None,
        meaning("damping factor in s/mm: damping force / (contact force * speed)", default="no damping"),
    ] = None
    restitution: Annotated[
        PlainNumber | None,
        meaning("coefficient of restitution, 0 to 1, with --impact-speed, not with --hysteresis", default="none"),
    ] = None
    impact_speed: Annotated[
        Speed | None,
        meaning(
            "impact speed at which the restitution was measured", example="0.1 m/s", default="none, with --hysteresis"
        ),
    ] = None
    friction: Annotated[PlainNumber | None, meaning("coefficient of friction", default="no friction")] = None
    bristle_stiffness: Annotated[
        PlainNumber | None, meaning("stiffness of bristles in 1/mm, for --friction with a state", default="no bristles")
    ] = None
    relaxation: Annotated[
        PronyTerms | None,
        meaning(
            "shares of the liner's modulus that relax, with their times; its modulus is then the instantaneous one",
            example="0.3: 0.1 s, 0.2: 10 s",
            default="an elastic liner",
        ),
    ] = None
    viscosity: Annotated[
        Viscosity | None, meaning("viscosity of a lubricant", example="2.5 mPa s", default="a dry socket")
    ] = None
    roughness: Annotated[
        Length | None, meaning("combined roughness, the least film of --viscosity", default="0.001 mm")
    ] = None
    smoothing: Annotated[
        Length | None,
        meaning(
            "indentation on both sides of first touch over which the law is rounded off, for optimal control",
            example="5 um",
            default="0 mm",
        ),
    ] = None

    def element(self, file: JointFile, name: str | None, gap: str | None) -> ForceElement | PreloadedElement:
        """Return the force element of a joint file; it has a rim unless the cup is a plain dry hemisphere.

        A joint with an interference has a tabulated element of the model sphere.

        Raises ValueError: the model has no force law, or a value is not allowed.
        """
        friction: Friction | Bristles | None = None
        if self.friction is None and self.bristle_stiffness is not None:
            raise ValueError("--bristle-stiffness is that of friction: add --friction")
        if self.friction is not None:
            friction = Friction(coefficient=float(self.friction))
        if self.friction is not None and self.bristle_stiffness is not None:
            friction = Bristles(coefficient=float(self.friction), stiffness=float(self.bristle_stiffness))
        if file.joint.clearance < 0:
            return self._preloaded_element(file, name, friction)
        default = default_model(file.joint, {}) if gap is None else reference
        model = with_gap(default if name is None else requested_model(name), gap)
        lubricant = self._lubricant()
        cup = None if file.cup == Cup() and lubricant is None else file.cup
        damping = self._damping()
        try:
            smoothing = float(self.smoothing or 0.0)
            relaxation = None if self.relaxation is None else self.relaxation.value
            return ForceElement(model, file.joint, damping, friction, cup, smoothing, lubricant, relaxation=relaxation)
        except TypeError as error:  # the model has no force law
            raise ValueError(str(error)) from error

    def _preloaded_element(
        self, file: JointFile, name: str | None, friction: Friction | Bristles | None
    ) -> PreloadedElement:
        """Return the force element of a joint with an interference; print the assumed arc of cover."""
        if name not in (None, OFF_AXIS):
            raise ValueError(f"the model {name} does not solve a preloaded joint: use {OFF_AXIS}")
        if isinstance(friction, Bristles):
            raise ValueError("a preloaded joint has no bristles: omit --bristle-stiffness")
        if self.relaxation is not None:
            raise ValueError("the liner of a preloaded joint does not relax: omit --relaxation")
        if self.viscosity is not None:
            raise ValueError("a preloaded joint has no clearance for the film of a lubricant: omit --viscosity")
        if self.smoothing is not None:
            raise ValueError("a preloaded joint has no first touch: omit --smoothing")
        assumed, sentences = complete(file)
        if "arc_of_cover" in sentences:
            print_message(sentences["arc_of_cover"])
        element = PreloadedElement(
            Sphere(cup=assumed.cup, ring_width=_RING_WIDTH), file.joint, damping=self._damping(), friction=friction
        )
        error = element.table.error
        if error > _NOTED_ERROR:
            print_message(f"the tabulated forces differ from the solver's by up to about {100 * error:.2g} %")
        return element

    def _lubricant(self) -> Lubricant | None:
        if self.viscosity is None:
            if self.roughness is not None:
                raise ValueError("--roughness is that of a film: add --viscosity")
            return None
        roughness = {} if self.roughness is None else {"ball_roughness": 0.0, "cup_roughness": float(self.roughness)}
        with as_given(written_in(self)):
            return Lubricant(viscosity=float(self.viscosity), **roughness)

    def _damping(self) -> Damping | None:
        if self.restitution is None and self.impact_speed is None:
            return None if self.hysteresis is None else Damping(hysteresis=float(self.hysteresis))
        if self.hysteresis is not None:
            raise ValueError("a hysteresis and a restitution are given; one is needed")
        if self.restitution is None or self.impact_speed is None:
            raise ValueError("a restitution and the speed of its impact belong together: --restitution --impact-speed")
        with as_given(written_in(self)):
            return Restitution(restitution=float(self.restitution), impact_speed=float(self.impact_speed))


Beyond = Annotated[
    str,
    typer.Option(
        help="Beyond the range of the law: extend (the force goes on with its last stiffness) or stop (no force)."
    ),
]
Mass = Annotated[float, typer.Option(help="Mass of the ball in kg, for the advice on time steps.")]

_LOAD = ("load.force", "load.indentation", "load.tilt")
"""Keys of the load up to which a law is exported."""

_FILE_ENDINGS = {".c", ".csv", ".fmu", ".h", ".inp", ".mo", ".osim", ".py", ".txt", ".xml"}
"""Endings of files: a path with one of them is a file, and any other a folder."""


@app.command()
@expand_groups
def export(
    *,
    target: Annotated[str, typer.Argument(help=f"Program: {', '.join(TARGETS)}.")],
    joint: JointName = None,
    joint_options: Annotated[JointOptions, (*JOINT, "cup.arc_of_cover", *_LOAD)],
    model: ModelName = None,
    gap: GapName = None,
    inputs: ForceElementInputs,
    out: Annotated[
        Path,
        typer.Option(
            help="Output folder, also the name of the files, or one of the files, such as joint.c; created if missing."
        ),
    ],
    beyond: Beyond = "extend",
    mass: Mass = 1.0,
) -> None:
    """Write a joint as a force element for another program."""
    from ..export.law_fit import fit_depth

    chosen = TARGETS[known_name("target", target, TARGETS)]
    folder = out.parent if out.suffix.lower() in _FILE_ENDINGS else out
    existing = next(path for path in (folder, *folder.parents, Path()) if path.exists())
    if not existing.is_dir():
        raise ValueError(f"{str(existing)!r} is a file; a folder is needed")
    file = joint_options.read(joint)
    chosen.check(file.joint)
    element = inputs.element(file, model, gap)
    depth = fit_depth(element, file.load)
    job = ExportJob(element=element, name=identifier(out), depth=depth, beyond=beyond, mass=mass, tilt=file.tilt)
    if folder != out and out.name not in (names := tuple(chosen.texts(job))):
        raise ValueError(f"out {str(out)!r}: {target} writes {', '.join(names)}; give one of them, or a folder")
    paths, notes = chosen.write(job, folder)
    echo_path(folder, f": {', '.join(path.relative_to(folder).as_posix() for path in paths)}")
    typer.echo(job.time_steps)
    if notes:
        print_message(notes)


@app.command()
@expand_groups
def fmu(
    *,
    joint: JointName = None,
    joint_options: Annotated[JointOptions, (*JOINT, "cup.arc_of_cover")],
    model: ModelName = None,
    gap: GapName = None,
    inputs: ForceElementInputs,
    out: Annotated[Path, typer.Option(help="File to write (.fmu); files of the FMI cross-check are put beside it.")],
    fmi: Annotated[int, typer.Option(help="Version of the FMI standard: 2 or 3.")] = 3,
    beyond: Beyond = "extend",
    mass: Mass = 1.0,
    ball_mass: Annotated[
        float | None, typer.Option(help="Mass in kg of a ball inside that the unit moves. Default: no ball.")
    ] = None,
) -> None:
    """Write a joint as a functional mock-up unit (FMI).

    The unit contains the C sources, and a binary for this machine if there is a compiler.
    """
    from ..export.fmu import Fmu, write_cross_check

    check_ending("out", out, ".fmu")
    element = inputs.element(joint_options.read(joint), model, gap)
    unit = Fmu(element=element, name=identifier(out), version=fmi, beyond=beyond, mass=mass, ball_mass=ball_mass)
    written = unit.write(out)
    start = ""
    if isinstance(unit.element, PreloadedElement):
        position = ", ".join(f"{1e-3 * component:.4g}" for component in unit.element.rest_position)
        start = f": starts at rest, with force 0 at position ({position}) m"
    echo_path(written.path, start)
    for extra_path in write_cross_check(unit.element, out, ball_mass):
        echo_path(extra_path)
    typer.echo(unit.time_steps)
    if written.missing:
        print_message(written.missing)


def identifier(path: Path) -> str:
    """Return the name of a file as an identifier: letters, digits and _, and no keyword of C, Python or Modelica."""
    name = re.sub(r"[^A-Za-z0-9_]", "_", path.stem)[:40]
    return name if name[:1].isalpha() and name not in _RESERVED else f"joint_{name}"[:40]


_OTHER_KEYWORDS = """
algorithm block connect constant discrete each encapsulated end equation external function initial inner input loop
model Modelica outer output package parameter partial record redeclare then type when within
exudyn mujoco numpy opensim pydrake assert errno float limits stdio stdlib string"""
_RESERVED = {*keyword.kwlist, *sys.stdlib_module_names, *_OTHER_KEYWORDS.split()}

_TILTED_ELEMENT_ANGLE = 6.0  # degrees of the bore per element, by default


@app.command()
@expand_groups
def deck(
    *,
    joint: JointName = None,
    joint_options: Annotated[JointOptions, (*PARTS, "cup", "load")],
    out: Annotated[Path, typer.Option(help="Output folder, or the deck itself (.inp); created if it does not exist.")],
    steps: Annotated[
        int, typer.Option(min=1, max=1000, help="Number of equal indentation steps up to that of the load.")
    ] = 8,
    scale: Annotated[
        float,
        typer.Option(
            help="Factor on clearance and indentation; small: contact on the undeformed shape, 1: on the deformed."
        ),
    ] = 1e-3,
    mesh: MeshTable,
    plastic: Yielding = False,
    run: Annotated[bool, typer.Option("--run", help="Run CalculiX (ccx), and compare its results with ours.")] = False,
) -> None:
    """Write a finite-element input file for CalculiX or Abaqus.

    The folder also gets the results to expect. A tilted load makes a three-dimensional model.
    """
    if out.suffix.lower() in _FILE_ENDINGS:
        check_ending("out", out, ".inp")
    file = joint_options.read(joint)
    if file.joint.clearance < 0:
        raise ValueError(
            f"a deck needs a clearance of 0 or more, got interference = {file.joint.interference:g} mm: press solves a "
            "preloaded joint (model sphere), and export table has its forces"
        )
    load = needed_load(file)
    if file.tilt > AXIAL_TILT:
        if plastic:
            raise ValueError("--plastic is for loads along the axis of the cup, and this one is tilted")
        _write_tilted(file, load, file.tilt, out, mesh, run)
        return
    with solver_progress("finite elements"):
        contact: Any = replace(mesh.model(meshes=1, plastic=plastic), cup=file.cup).press(file.joint, **load)
    if contact.status.failed:
        raise ValueError("; ".join(contact.notes))
    from ..elasticity.finite_elements.calculix import run as run_ccx
    from ..elasticity.finite_elements.deck import deck_of

    made = deck_of(contact, steps=steps, scale=scale)
    echo_path(made.write(out), f": {made.element_count} elements, {steps} steps")
    if run:
        print_answer(describe_rival(made.expected, run_ccx(out)))


def _write_tilted(file: JointFile, load: dict[str, float], tilt: float, out: Path, mesh: MeshTable, run: bool) -> None:
    """Write the input file of a ball that is displaced at a tilt in rad."""
    from ..elasticity.off_axis.deck import TiltedDeck
    from ..elasticity.off_axis.deck import run as run_ccx

    if "indentation" not in load:
        raise ValueError("a tilted deck displaces the ball: give an indentation")
    size = float(mesh.element_size or 0) or radians(_TILTED_ELEMENT_ANGLE) * float(file.joint.socket_radius)
    made = TiltedDeck(
        joint=replace(file.joint, ball=None),
        cup=file.cup,
        indentation=load["indentation"],
        tilt=tilt,
        element_size=size / float(file.joint.socket_radius),
    )
    echo_path(made.write(out), f": {made.ball.last_number} nodes, rigid ball")
    if run:
        print_answer(describe_tilted_rival(made.expected["force_vector"], run_ccx(out)["force_vector"]))
