"""Options of the models of linear elasticity: finite elements (`fem`) and loads off the cup's axis (`sphere`)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees, isfinite
from time import perf_counter
from typing import Annotated, Any

import typer
from rich.console import Console

from ..contact import Contact
from ..contact.describe import COLUMNS
from ..contact.per_joint import SolvedContact
from ..contact.verdict import Verdict, rim_verdict
from ..core.checks import known_name, require
from ..core.kinds import Kind
from ..core.quantities import CONTACT, LOADS
from ..elasticity.finite_elements.model import FiniteElement, MeshedContact
from ..elasticity.finite_elements.progress import progress_to
from ..elasticity.finite_elements.spacing import Adapted, Element, Spacing, Uniform
from ..elasticity.off_axis.contact import OffAxisContact
from ..elasticity.off_axis.directions import polar_angle
from ..elasticity.off_axis.model import Sphere
from ..files.joint_file import JointFile, read_aim, read_cup
from ..files.units import parse
from ..model_catalogue import judge, off_axis
from ..problem import Joint
from ..problem.cup import AngleDefinition, Cup
from ..reports.unit_systems import Units
from .options import ArcOfCover, drop_missing


@dataclass(frozen=True, kw_only=True)
class CupOptions:
    """Options of a cup; they replace single values of the cup in the joint file."""

    arc_of_cover: ArcOfCover = None
    chamfer: Annotated[
        str | None,
        typer.Option(help="Width of the chamfer on the rim's inner edge in mm. Default: as in the file, or 0."),
    ] = None
    interface: Annotated[
        str | None,
        typer.Option(help="Liner on its backing: 'bonded' or 'sliding'. Default: as in the file, or bonded."),
    ] = None

    def apply_to(self, cup: Cup) -> Cup:
        """Return a cup with the values that the options replace."""
        return read_cup(drop_missing(vars(self)), cup)


@dataclass(frozen=True, kw_only=True)
class MeshOptions:
    """Options of a finite-element mesh."""

    element_size: Annotated[
        str | None, typer.Option(help="Element size in the contact in mm: '0.05 mm'. Default: from the contact size.")
    ] = None
    element: Annotated[
        str | None, typer.Option(help="Element type: 'biquadratic' or 'bilinear'. Default: biquadratic.")
    ] = None

    def model(self, cup: Cup, meshes: int) -> FiniteElement:
        """Return the finite-element model of a cup, on one mesh or on two for error estimates."""
        known = {element.name.lower(): element for element in Element}
        element = Element.BIQUADRATIC if self.element is None else known[known_name("element", self.element, known)]
        spacing: Spacing = Adapted() if self.size is None else Uniform(size=self.size)
        return FiniteElement(cup=cup, spacing=spacing, element=element, meshes=meshes)

    @property
    def size(self) -> float | None:
        """Element size in mm; None if the option is not used."""
        if self.element_size is None:
            return None
        length = parse("element_size", self.element_size, Kind.LENGTH)
        require("element_size", length, length > 0, "an element's size (mm) is above 0")
        return length


def refuse_mesh_options(options: Mapping[str, Any]) -> None:
    """Raise ValueError for options of the finite elements that are used without this model."""
    for name, value in options.items():
        if value is not None:
            raise ValueError(f"--{name.replace('_', '-')} is for the finite elements: add --model {judge.name}")


def solve_mesh(model: FiniteElement, joint: Any, load: Mapping[str, float]) -> tuple[MeshedContact, float]:
    """Press a joint by finite elements with progress on stderr; return the contact and the time in s."""
    start = perf_counter()
    status = Console(stderr=True).status("finite elements")
    with status, progress_to(lambda text: status.update(f"finite elements: {text}")):
        contact: Any = model.press(joint, **load)
        _ = [column.values_of(contact) for column in COLUMNS]
    return contact, perf_counter() - start


def mesh_remark(contact: MeshedContact, seconds: float) -> str:
    """Return one line with the mesh, the time and the estimated errors of a contact."""
    if contact.status.failed or contact.indentation == 0:
        return f"fem: {seconds:.2f} s"
    size = contact.mesh
    mesh = f"fem: {size.elements} elements, {size.element_size:.3g} mm at the contact, {seconds:.2f} s"
    errors = _error_text(contact)
    return f"{mesh}; error of the mesh: {errors}" if errors else f"{mesh}; error of the mesh not estimated"


def _error_text(contact: SolvedContact) -> str:
    """Return the estimated relative errors of load, displacement, peak pressure and stiffness as text."""
    return ", ".join(
        f"{CONTACT[name].symbol} ±{100 * error:.1g} %"
        for name, error in contact.error.items()
        if name in (*LOADS, "max_pressure", "stiffness") and error > 1e-9
    )


@dataclass(frozen=True, kw_only=True)
class DirectionOptions:
    """Options of the load's direction, and of the rings of the model `sphere`."""

    tilt: Annotated[
        str | None,
        typer.Option(
            help="Angle between load and cup axis in degrees: '45 deg'. Solved by model sphere. "
            "Default: as in the file, or 0 deg."
        ),
    ] = None
    direction: Annotated[
        str | None,
        typer.Option(
            help="Direction of the load 'x,y,z' in the body: right, front, up. Solved by model sphere. "
            "Default: as in the file."
        ),
    ] = None
    ring_width: Annotated[
        str | None,
        typer.Option(help="sphere: width of its rings in degrees. Default: 2 deg; finer is slower and more exact."),
    ] = None

    def read(self, file: JointFile) -> dict[str, Any]:
        """Read the direction from the options or the joint file; empty if there is none."""
        return read_aim(drop_missing({"tilt": self.tilt, "direction": self.direction})) or file.aim

    def refuse(self) -> None:
        """Raise ValueError for options of `sphere` that are used without this model."""
        if self.ring_width is not None:
            raise ValueError(f"--ring-width is for contact on the sphere: add --model {off_axis.name}, or a --tilt")

    def model(self) -> Sphere:
        """Return the model `sphere` with the ring width of the options."""
        if self.ring_width is None:
            return Sphere()
        return Sphere(ring_width=parse("ring_width", self.ring_width, Kind.ANGLE))


def orientation_summary(cup: Cup) -> dict[str, dict[str, float]]:
    """Return the angles of a cup in the body in every definition, for JSON; empty without an orientation."""
    names = ("inclination_deg", "anteversion_deg")
    angles = {definition.value: map(degrees, cup.angles(definition)) for definition in AngleDefinition}
    return {name: dict(zip(names, pair, strict=True)) for name, pair in angles.items()} if cup.oriented else {}


def orientation_remark(cup: Cup) -> str:
    """Return one line with the angles of a cup in the body in every definition."""
    angles = orientation_summary(cup)
    texts = (f"{name} {pair['inclination_deg']:.4g}°/{pair['anteversion_deg']:.4g}°" for name, pair in angles.items())
    return f"cup: inclination/anteversion {', '.join(texts)}, {cup.side.value} side"


@dataclass
class TimedModel:
    """A model that measures the time of its last press in s."""

    model: Any
    seconds: float = 0.0

    def in_cup(self, cup: Cup) -> TimedModel:
        """Set the cup of the model, and return this object."""
        self.model = self.model.in_cup(cup)
        return self

    def press(self, joint: Joint, **load: Any) -> Contact:
        """Press a joint, and measure the time."""
        start = perf_counter()
        contact: Contact = self.model.press(joint, **load)
        self.seconds = perf_counter() - start
        return contact


def sphere_remark(contact: Any, seconds: float, units: Units = Units.SI) -> str:
    """Return one line with the place of the contact in its cup, the rings, the time and the estimated errors."""
    cost = f"rings of {degrees(contact.model.ring_width):.3g}°, {seconds:.2f} s"
    if contact.status.failed or contact.indentation == 0:
        return f"{off_axis.name}: {cost}"
    peak = "pressure unbounded there"
    if isfinite(contact.max_pressure):
        peak = f"largest pressure {degrees(polar_angle(contact.max_pressure_at)):.3g}° from the axis"
    position = f"load {degrees(contact.tilt):.3g}° from the cup's axis, {_rim_text(contact, units)}, {peak}"
    return f"{off_axis.name}: {position}; {cost}; error of the rings: {_error_text(contact)}"


def _rim_text(contact: OffAxisContact, units: Units = Units.SI) -> str:
    distance = contact.edge_distance
    if contact.edge_loaded and contact.joint.clearance < 0:
        return "contact up to the rim"
    verdict = rim_verdict(contact)
    if verdict is Verdict.EXCEEDED:
        return f"contact cut off by {units.short_length(max(-distance, 0.0))} at the rim"
    near = ", less than its error bar: edge loading is undecided" if verdict is Verdict.UNDECIDED else ""
    return f"contact {units.short_length(abs(distance))} from the rim{near}"
