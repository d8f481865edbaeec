"""Description of the planning data of a hip: a row for each measured number, with its accuracy."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import acos, degrees

from ..core.answers import Answer, Cell, Column, Row, Table
from ..core.display import counted
from ..core.kinds import CUBIC_MILLIMETRES, MICROMETRES, MILLIMETRES, PERCENT, Kind
from ..core.unit_systems import Amount, Sentence, with_error
from .geometry import angle_between
from .implants import ImplantFit
from .pelvis import CupOrientation, PelvicFrame
from .plan import HipPlan
from .worn_bores import WornBore

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
