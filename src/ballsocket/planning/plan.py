"""Planned joint: cup orientation, liner and head of one patient, its description, and the joint file that follows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from math import acos, degrees, radians
from typing import Any

import numpy

from ..core.answers import Answer, Cell, Column, Row, Table
from ..core.arrays import Numbers
from ..core.checks import require
from ..core.display import counted
from ..core.kinds import CUBIC_MILLIMETRES, MICROMETRES, MILLIMETRES, PERCENT, Kind
from ..core.unit_systems import Amount, Sentence, with_error
from ..files.joint_file import JointFile, joint_of
from ..problem.cup import Cup, Side
from .geometry import angle_between
from .implants import ImplantFit
from .landmarks import Landmarks, read_side
from .pelvis import CupOrientation, PelvicFrame, cup_orientation, orientation_of_axis
from .worn_bores import WornBore

CLEARANCE_REFUSAL = Sentence(
    "no clearance is derived from two files, because their radii are nominal: public sets give {} and {}; state it "
    "with --clearance",
    Amount(-0.098, MILLIMETRES),
    Amount(0.002, MILLIMETRES),
)
"""Sentence on the difference of the radii of two files."""

_MAX_DIFFERENCE = 1.0  # largest difference in mm of the radii of bore and head; sizes of heads differ by 2 mm
_UNEVEN_TUBERCLES = 10.0  # mm
_LPS = numpy.diag([-1.0, -1.0, 1.0])


@dataclass(frozen=True, kw_only=True, eq=False)
class HipPlan:
    """Planning data of one hip: any of pelvic frame, orientation of the cup, liner and head.

    Attributes
    ----------
    frame : PelvicFrame or None
    orientation : CupOrientation or None
    liner, head : ImplantFit or None
    worn : WornBore or None

    Raises
    ------
    ValueError
        A head that does not belong to the bore.
    """

    frame: PelvicFrame | None = None
    orientation: CupOrientation | None = None
    liner: ImplantFit | None = None
    head: ImplantFit | None = None
    worn: WornBore | None = None

    def __post_init__(self) -> None:
        if self.orientation is not None:
            self.orientation.cup()  # refuses angles that no cup has
        if self.liner is None or self.head is None:
            return
        if abs(self.liner.radius - self.head.radius) > _MAX_DIFFERENCE:
            raise ValueError(
                f"the head of radius {self.head.radius:.3f} mm does not belong to the bore of radius "
                f"{self.liner.radius:.3f} mm: they differ by more than {_MAX_DIFFERENCE:g} mm"
            )

    @property
    def cup(self) -> Cup:
        """Cup with the measured arc of cover, orientation and side; defaults for the rest."""
        cup = Cup() if self.orientation is None else self.orientation.cup()
        return cup if self.liner is None else replace(cup, arc_of_cover=self.liner.arc_of_cover)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the accuracy and on what is not known."""
        notes = [note for fit in (self.liner, self.head) if fit is not None for note in fit.notes]
        if self.liner is not None and self.liner.wall_thickness is None:
            notes.append(f"{self.liner.name}: the outer surface is no sphere around the bore: no wall thickness")
        frame, orientation = self.frame, self.orientation
        if frame is not None and (frame.tubercle_offset or 0.0) > _UNEVEN_TUBERCLES:
            offset = Amount(frame.tubercle_offset or 0.0, MILLIMETRES, decimals=0)
            text = "the pubic tubercles are {} apart across the line of the spines: look at the landmarks"
            notes.append(Sentence(text, offset))
        if orientation is not None:
            notes += orientation.notes
        elif frame is not None:
            notes.append(
                "the orientation of the cup is not known: the landmarks have no points named rim, and no liner lies in "
                "the coordinates of the scan"
            )
        if self.worn is not None:
            notes += self.worn.notes
        if self.liner is not None and self.head is not None:
            notes.append(CLEARANCE_REFUSAL)
        return tuple(notes)

    def joint_file(
        self,
        clearance: float,
        *,
        liner: str = "uhmwpe",
        ball: str | None = None,
        liner_thickness: float | None = None,
        force: float | None = None,
        name: str = "",
    ) -> JointFile:
        """Create the joint with a stated clearance.

        The ball has the radius of the head; without a head, that of the bore less the clearance.

        Parameters
        ----------
        clearance : float
            Radial clearance in mm. It is never derived from two files, because their radii are nominal.
        liner, ball : str, optional
            Names of preset materials. Default: UHMWPE, and a rigid ball.
        liner_thickness : float, optional
            Thickness in mm in place of the measured wall.
        force : float, optional
            Load in N.
        name : str
            Name of the joint.

        Raises
        ------
        ValueError
            No radius or no thickness, or a number that is not allowed.
        """
        require("clearance", clearance, clearance < numpy.inf, "a radial clearance (mm) is finite")
        if self.head is not None:
            radius = self.head.radius
        elif self.liner is not None:
            radius = self.liner.radius - clearance
        else:
            raise ValueError("a joint needs a radius: read the mesh of a liner or a head")
        wall = None if self.liner is None else self.liner.wall_thickness
        thickness = wall if liner_thickness is None else liner_thickness
        if thickness is None:
            raise ValueError("a joint needs the liner's thickness: the files have none, state --liner-thickness")
        tables: dict[str, Any] = {
            "joint": {
                "ball_radius": round(radius, 4),
                "clearance": clearance,
                "liner_thickness": round(thickness, 4),
            },
            "liner": {"material": liner},
        }
        tables |= {"ball": {"material": ball}} if ball else {}
        tables |= {"load": {"force": force}} if force is not None else {}
        tables |= {"name": name} if name else {}
        names = ("arc_of_cover", "inclination", "anteversion") if self.cup.oriented else ("arc_of_cover",)
        angles: Any = {name: radians(round(degrees(getattr(self.cup, name)), 3)) for name in names}
        return replace(joint_of(tables), cup=replace(self.cup, **angles))

    def summary(self) -> dict[str, Any]:
        """Return all results for JSON, in mm and degrees; a missing number is None."""
        frame, worn = (
            "origin axes asis_distance height tilt_deg obliquity_deg",
            (
                "points volume volume_error depth depth_error radius radius_error noise form unworn cover ambiguous "
                "hidden_shift centre pole deepest reach_deg"
            ),
        )
        return {
            "side": None if self.orientation is None else self.orientation.side.value,
            "pelvis": None if self.frame is None else _attributes(self.frame, frame),
            "cup": None if self.orientation is None else _cup_summary(self.orientation),
            "liner": None if self.liner is None else _fit_summary(self.liner),
            "head": None if self.head is None else _fit_summary(self.head),
            "worn": None if self.worn is None else {"file": self.worn.name, **_attributes(self.worn, worn)},
            "notes": list(self.notes),
        }


def make_plan(
    *,
    frame: PelvicFrame | None = None,
    landmarks: Landmarks | None = None,
    liner: ImplantFit | None = None,
    head: ImplantFit | None = None,
    side: Side | str | None = None,
    space: str | None = None,
    worn: WornBore | None = None,
) -> HipPlan:
    """Combine landmarks and implants to a plan.

    The orientation is that of the rim's points. Without them, it is that of the liner if its file has the coordinates
    of the scan.

    Parameters
    ----------
    frame : PelvicFrame, optional
    landmarks : Landmarks, optional
        Points with those of the rim.
    liner, head : ImplantFit, optional
    side : Side or str, optional
        "right" or "left", if the landmarks do not determine it.
    space : str, optional
        "RAS" or "LPS": the liner's file has these coordinates of the scan.
    worn : WornBore, optional
        Wear of a measured bore.

    Raises
    ------
    ValueError
        A frame without any orientation, and the errors of `cup_orientation`.
    """
    orientation = None
    if frame is not None:
        if landmarks is not None and len(landmarks.rim(read_side(side))[1]):
            orientation = cup_orientation(landmarks, frame, side=side)
        elif liner is not None and liner.axis is not None and space is not None:
            to_ras: Numbers = {"RAS": numpy.eye(3), "LPS": _LPS}[space.upper()]
            axis, centre = frame.axes @ to_ras @ liner.axis, frame.convert(to_ras @ liner.centre)
            orientation = orientation_of_axis(axis, centre, frame, side=side, signed=True)
    return HipPlan(frame=frame, orientation=orientation, liner=liner, head=head, worn=worn)


def _cup_summary(orientation: CupOrientation) -> dict[str, Any]:
    in_pelvis, in_body = orientation.cup(upright=False), orientation.cup()
    return {
        "inclination_deg": degrees(in_body.inclination),
        "anteversion_deg": degrees(in_body.anteversion),
        "pelvic_inclination_deg": degrees(in_pelvis.inclination),
        "pelvic_anteversion_deg": degrees(in_pelvis.anteversion),
        **_attributes(orientation, "axis centre points residual angle_error_deg"),
    }


def _fit_summary(fit: ImplantFit) -> dict[str, Any]:
    return {
        "file": fit.name,
        **_attributes(fit, "radius residual facet_depth centre axis arc_of_cover_deg rim_deviation_deg"),
        "rim": [_attributes(plane, "normal height share") for plane in fit.rim],
        "lip_angle_deg": None if fit.lip_angle is None else degrees(fit.lip_angle),
        "axis_is_ambiguous": fit.ambiguous,
        **_attributes(fit, "wall_thickness wall_range wall_residual"),
    }


def _attributes(item: Any, names: str) -> dict[str, Any]:
    """Return attributes as data for JSON; a name that ends in _deg is an angle in degrees."""
    values: dict[str, Any] = {}
    for name in names.split():
        value = getattr(item, name.removesuffix("_deg"))
        if isinstance(value, numpy.ndarray | tuple):
            values[name] = numpy.asarray(value).tolist()
        else:
            values[name] = value if value is None or not name.endswith("_deg") else degrees(value)
    return values


_Cells = tuple[str, Cell, str]

_MESH_ERROR = 0.005  # smallest error of a radius in mm from a mesh


def describe_plan(plan: HipPlan, remarks: Iterable[str] = ()) -> Answer:
    """Describe the results of a plan, with remarks in place of its notes."""
    columns = [Column.of_words("quantity"), Column.of_number("value"), Column.of_words("accuracy")]
    cells = (
        *_pelvis_cells(plan.frame),
        *_cup_cells(plan.orientation),
        *_fit_cells("bore", plan.liner),
        *_fit_cells("head", plan.head),
        *_wear_cells(plan.worn),
    )
    table = Table("plan", "Planning data", columns, list(map(Row, cells)))
    return Answer(title="planning data of a hip", tables=[table], notes=list(remarks))


def _angle(angle: float) -> Amount:
    return Amount(angle, Kind.ANGLE.written, decimals=1)


def _pelvis_cells(frame: PelvicFrame | None) -> Iterator[_Cells]:
    if frame is None:
        return
    yield "distance of the ASIS", Amount(frame.asis_distance, MILLIMETRES, decimals=1), ""
    if frame.tilt is not None and frame.obliquity is not None:
        yield "pelvic tilt", _angle(frame.tilt), f"obliquity {degrees(frame.obliquity):.1f}°"


def _cup_cells(orientation: CupOrientation | None) -> Iterator[_Cells]:
    if orientation is None:
        return
    yield "side", orientation.side.value, ""
    plane = "axis of the liner's file"
    if orientation.residual is not None:
        error = "" if orientation.angle_error is None else f"±{degrees(orientation.angle_error):.1f}°, "
        residual = Amount(orientation.residual, MILLIMETRES, decimals=2)
        plane = Sentence(f"{error}{counted(orientation.points, 'rim point')}, {{}} rms", residual)
    for upright, title in ((True, ""), (False, " to the pelvic plane")):
        if not upright and orientation.frame.vertical is None:
            return
        cup = orientation.cup(upright=upright)
        yield f"inclination{title}", _angle(cup.inclination), plane
        yield f"anteversion{title}", _angle(cup.anteversion), ""
        plane = ""


def _fit_cells(part: str, fit: ImplantFit | None) -> Iterator[_Cells]:
    if fit is None:
        return
    residual = Amount(fit.residual, MILLIMETRES, decimals=3)
    radius, _ = with_error(fit.radius, max(fit.residual, _MESH_ERROR), MILLIMETRES, digits=1)
    yield f"{part} radius", radius, Sentence("{} rms", residual)
    rim = f"rim within {degrees(fit.rim_deviation):.1f}° of a plane" if fit.axis is not None else "complete"
    yield f"{part} arc of cover", _angle(fit.arc_of_cover), rim
    if fit.axis is not None and fit.lip_angle is not None:
        for title, plane in zip(("main", "lip"), fit.rim, strict=True):
            height = Amount(plane.height, MILLIMETRES, decimals=1)
            extent = Sentence(f"to the axis, {100 * plane.share:.0f} % of the rim, {{}} from the centre", height)
            yield f"rim, {title} plane", _angle(angle_between(plane.normal, fit.axis)), extent
        yield "rim, angle of the lip", _angle(fit.lip_angle), "between both planes"
    if fit.wall_thickness is not None and fit.wall_range is not None and fit.wall_residual is not None:
        low, high = (Amount(end, MILLIMETRES, decimals=2) for end in fit.wall_range)
        residual = Amount(fit.wall_residual, MILLIMETRES, decimals=3)
        thickness = Amount(fit.wall_thickness, MILLIMETRES, decimals=2)
        yield "wall thickness", thickness, Sentence("{} to {}, {} rms", low, high, residual)


def _wear_cells(worn: WornBore | None) -> Iterator[_Cells]:
    """Yield the rows of a worn bore; errors are two standard errors."""
    if worn is None:
        return
    volume, error = with_error(worn.volume, worn.volume_error, CUBIC_MILLIMETRES)
    yield "worn volume", volume, Sentence(f"±{{}} (95 %), {counted(worn.points, 'point')}", error)
    polar = degrees(acos(min(max(float(worn.deepest @ worn.pole), -1.0), 1.0)))
    depth, error = with_error(worn.depth, worn.depth_error, MICROMETRES)
    place = Sentence(f"±{{}} (95 %), {polar:.0f}° from the middle of the points", error)
    yield "deepest wear", depth, place
    radius, error = with_error(worn.radius, worn.radius_error, MILLIMETRES)
    yield "unworn radius", radius, Sentence("±{} (95 %), noise {}", error, Amount(worn.noise, MICROMETRES, 2))
    share = f"{100.0 * worn.cover:.0f} % within {degrees(worn.reach):.0f}° of their middle"
    unworn = Amount(worn.unworn, PERCENT, decimals=0)
    yield "unworn part", unworn, f"of the covered surface; points cover {share}"
