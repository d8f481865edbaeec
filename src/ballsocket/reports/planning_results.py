"""Planning data of a hip as a table in a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import acos, degrees, floor, log10

from rich.table import Table

from ..planning.geometry import angle_between
from ..planning.implants import ImplantFit
from ..planning.pelvis import CupOrientation, PelvicFrame
from ..planning.plan import HipPlan
from ..planning.worn_bores import WornBore
from .terminal import Terminal, print_columns, print_folded

_Row = tuple[str, str, str]

_MESH_ERROR = 0.005  # smallest error of a radius in mm from a mesh


def print_plan(plan: HipPlan, remarks: Iterable[str]) -> None:
    """Print the table of a plan and remarks below it."""
    terminal, table = Terminal(), Table(box=None, pad_edge=False)
    for title in ("quantity", "value", "accuracy"):
        table.add_column(title, no_wrap=title == "value")
    for row in (
        *_pelvis_rows(plan.frame),
        *_cup_rows(plan.orientation),
        *_fit_rows("bore", plan.liner),
        *_fit_rows("head", plan.head),
        *_wear_rows(plan.worn),
    ):
        table.add_row(*row)
    print_columns(terminal, table)
    for remark in remarks:
        print_folded(terminal, remark, "dim")


def _rounded(value: float, error: float) -> str:
    """Return a number with the digits that its error leaves."""
    decimals = floor(0.5 - log10(error)) if error > 0 else 3
    return f"{round(value, decimals) + 0.0:.{max(decimals, 0)}f}"


def _pelvis_rows(frame: PelvicFrame | None) -> Iterator[_Row]:
    if frame is None:
        return
    yield "distance of the ASIS", f"{frame.asis_distance:.1f} mm", ""
    if frame.tilt is not None and frame.obliquity is not None:
        yield "pelvic tilt", f"{degrees(frame.tilt):.1f}°", f"obliquity {degrees(frame.obliquity):.1f}°"


def _cup_rows(orientation: CupOrientation | None) -> Iterator[_Row]:
    if orientation is None:
        return
    yield "side", orientation.side.value, ""
    error = "" if orientation.angle_error is None else f"±{degrees(orientation.angle_error):.1f}°, "
    plane = (
        "axis of the liner's file"
        if orientation.residual is None
        else (f"{error}{orientation.points} rim points, {orientation.residual:.2f} mm rms")
    )
    for upright, title in ((True, ""), (False, " to the pelvic plane")):
        if not upright and orientation.frame.vertical is None:
            return
        cup = orientation.cup(upright=upright)
        yield f"inclination{title}", f"{degrees(cup.inclination):.1f}°", plane
        yield f"anteversion{title}", f"{degrees(cup.anteversion):.1f}°", ""
        plane = ""


def _fit_rows(part: str, fit: ImplantFit | None) -> Iterator[_Row]:
    if fit is None:
        return
    yield f"{part} radius", f"{_rounded(fit.radius, max(fit.residual, _MESH_ERROR))} mm", f"{fit.residual:.3f} mm rms"
    rim = f"rim within {degrees(fit.rim_deviation):.1f}° of a plane" if fit.axis is not None else "complete"
    yield f"{part} arc of cover", f"{degrees(fit.arc_of_cover):.1f}°", rim
    if fit.axis is not None and fit.lip_angle is not None:
        for title, plane in zip(("main", "lip"), fit.rim, strict=True):
            extent = f"to the axis, {100 * plane.share:.0f} % of the rim, {plane.height:+.1f} mm from the centre"
            yield f"rim, {title} plane", f"{degrees(angle_between(plane.normal, fit.axis)):.1f}°", extent
        yield "rim, angle of the lip", f"{degrees(fit.lip_angle):.1f}°", "between both planes"
    if fit.wall_thickness is not None and fit.wall_range is not None and fit.wall_residual is not None:
        low, high = fit.wall_range
        yield (
            "wall thickness",
            f"{fit.wall_thickness:.2f} mm",
            f"{low:.2f} to {high:.2f} mm, {fit.wall_residual:.3f} mm rms",
        )


def _wear_rows(worn: WornBore | None) -> Iterator[_Row]:
    """Yield the rows of a worn bore; errors are two standard errors."""
    if worn is None:
        return
    error = worn.volume_error
    yield "worn volume", f"{_rounded(worn.volume, error)} mm³", f"±{error:.2g} mm³ (95 %), {worn.points} points"
    polar = degrees(acos(min(max(float(worn.deepest @ worn.pole), -1.0), 1.0)))
    error = 1000.0 * worn.depth_error
    place = f"±{error:.2g} µm (95 %), {polar:.0f}° from the middle of the points"
    yield "deepest wear", f"{_rounded(1000.0 * worn.depth, error)} µm", place
    radius = f"±{worn.radius_error:.2g} mm (95 %), noise {1000.0 * worn.noise:.2g} µm"
    yield "unworn radius", f"{_rounded(worn.radius, worn.radius_error)} mm", radius
    share = f"{100.0 * worn.cover:.0f} % within {degrees(worn.reach):.0f}° of their middle"
    yield "unworn part", f"{100.0 * worn.unworn:.0f} %", f"of the covered surface; points cover {share}"
