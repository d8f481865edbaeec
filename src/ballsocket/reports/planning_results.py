"""Planning data of a hip as a table in a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import degrees

from rich.table import Table

from ..planning.geometry import angle_between
from ..planning.implants import ImplantFit
from ..planning.pelvis import CupOrientation, PelvicFrame
from ..planning.plan import HipPlan
from .terminal import console, print_columns, print_folded

_Row = tuple[str, str, str]


def print_plan(plan: HipPlan, remarks: Iterable[str]) -> None:
    """Print the table of a plan and remarks below it."""
    terminal, table = console(), Table(box=None, pad_edge=False)
    for title in ("quantity", "value", "accuracy"):
        table.add_column(title, no_wrap=title == "value")
    for row in (
        *_pelvis_rows(plan.frame),
        *_cup_rows(plan.orientation),
        *_fit_rows("bore", plan.liner),
        *_fit_rows("head", plan.head),
    ):
        table.add_row(*row)
    print_columns(terminal, table)
    for remark in remarks:
        print_folded(terminal, remark, "dim")


def _pelvis_rows(frame: PelvicFrame | None) -> Iterator[_Row]:
    """Yield the rows of the pelvis."""
    if frame is None:
        return
    yield "distance of the ASIS", f"{frame.asis_distance:.1f} mm", ""
    if frame.tilt is not None and frame.obliquity is not None:
        yield "pelvic tilt", f"{degrees(frame.tilt):.1f}°", f"obliquity {degrees(frame.obliquity):.1f}°"


def _cup_rows(orientation: CupOrientation | None) -> Iterator[_Row]:
    """Yield the rows of the orientation of the cup."""
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
    """Yield the rows of a liner or head."""
    if fit is None:
        return
    yield f"{part} radius", f"{fit.radius:.3f} mm", f"{fit.residual:.3f} mm rms"
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
