"""Command `planning`: landmarks and STL files of a hip as a joint."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import degrees
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Table

from ..core.kinds import Kind
from ..core.storage.atomic_files import check_parent_folder, write_text
from ..files.joint_toml import toml_of
from ..files.units import parse
from ..planning.implants import ImplantFit, Mesh, fit_head, fit_liner, read_stl
from ..planning.landmarks import Landmarks, read_landmarks
from ..planning.pelvis import CupOrientation, PelvicFrame, pelvic_frame
from ..planning.plan import CLEARANCE_REFUSAL, Plan, make_plan
from ..reports.terminal import console, print_columns, print_folded
from .json_answers import echo_json
from .options import AsJson, expand_groups
from .root import app, echo_path

_SPACES = ("ras", "lps")


@dataclass(frozen=True, kw_only=True)
class LandmarkOptions:
    """Options of landmark files and of the pelvis."""

    landmarks: Annotated[
        list[Path] | None, typer.Option(help="Landmark file of 3D Slicer (.mrk.json, .fcsv). Repeat for several.")
    ] = None
    rename: Annotated[
        list[str] | None,
        typer.Option(help="Point of a landmark: 'right_asis=F-1'. Repeat for several."),
    ] = None
    coordinates: Annotated[
        str | None, typer.Option(help="RAS or LPS, for landmark files that do not state their coordinate system.")
    ] = None
    side: Annotated[
        str | None, typer.Option(help="Side of the cup: right or left. Default: from names and position.")
    ] = None
    vertical: Annotated[
        str | None, typer.Option(help="Direction upwards 'x,y,z' in the scan: right, front, up. Default: not known.")
    ] = None
    pelvic_tilt: Annotated[
        str | None,
        typer.Option(help="Tilt of the pelvic plane in degrees, positive to the front. Not with --vertical."),
    ] = None

    def read(self) -> tuple[Landmarks | None, PelvicFrame | None]:
        """Read the landmarks and compute the pelvic frame; both are None without files."""
        if not self.landmarks:
            return None, None
        pairs = [text.partition("=") for text in self.rename or ()]
        landmarks = read_landmarks(
            *self.landmarks,
            coordinates=self.coordinates,
            rename={role.strip(): name.strip() for role, _, name in pairs},
        )
        tilt = None if self.pelvic_tilt is None else parse("pelvic_tilt", self.pelvic_tilt, Kind.ANGLE)
        vertical = self.vertical and [parse("vertical", part, Kind.NUMBER) for part in self.vertical.split(",")]
        return landmarks, pelvic_frame(landmarks, vertical=vertical, pelvic_tilt=tilt)


@dataclass(frozen=True, kw_only=True)
class ImplantOptions:
    """Options of the STL files."""

    liner: Annotated[Path | None, typer.Option(help="STL file of the liner.")] = None
    head: Annotated[Path | None, typer.Option(help="STL file of the head.")] = None
    stl_units: Annotated[str, typer.Option(help="Unit of the STL files: mm, cm, m, um or in.")] = "mm"
    placed: Annotated[
        str | None,
        typer.Option(
            help="RAS or LPS: the liner's file has coordinates of the scan. Default: as in the header of 3D Slicer."
        ),
    ] = None

    def read(self) -> tuple[ImplantFit | None, ImplantFit | None, str | None]:
        """Fit liner and head, and return them with the coordinates of the liner's file."""
        if self.placed is not None and self.placed.lower() not in _SPACES:
            raise ValueError(f"placed = {self.placed!r:.40} is not allowed: RAS or LPS")
        liner = None if self.liner is None else self._mesh(self.liner)
        head = None if self.head is None else fit_head(self._mesh(self.head))
        fit = None if liner is None else fit_liner(liner)
        return fit, head, self.placed or (liner and liner.space)

    def _mesh(self, path: Path) -> Mesh:
        """Read an STL file."""
        return read_stl(path, units=self.stl_units)


@dataclass(frozen=True, kw_only=True)
class PlannedJointOptions:
    """Options of the joint file."""

    clearance: Annotated[str | None, typer.Option(help="Radial clearance in mm: '0.15 mm'. Needed for --out.")] = None
    liner_thickness: Annotated[
        str | None, typer.Option(help="Thickness of the liner in mm. Default: the measured wall.")
    ] = None
    liner_material: Annotated[str, typer.Option(help="Name of a material, see `ballsocket presets`.")] = "uhmwpe"
    head_material: Annotated[str | None, typer.Option(help="Name of a material. Default: a rigid head.")] = None
    force: Annotated[str | None, typer.Option(help="Load of the joint file in N, or with a unit: '3 kN'.")] = None
    out: Annotated[Path | None, typer.Option(help="Write a joint file (.toml) for `ballsocket press`.")] = None

    def check(self, has_head: bool, has_liner: bool) -> None:
        """Raise ValueError before any work if no joint file can be written."""
        if self.out is None:
            return
        if self.clearance is None:
            raise ValueError(
                CLEARANCE_REFUSAL if has_head and has_liner else "--out needs a clearance: state it with --clearance"
            )
        if self.out.suffix.lower() != ".toml":
            raise ValueError(f"{self.out.name!r:.60} is not a name for a joint file: it ends with .toml")
        check_parent_folder(self.out)

    def write(self, plan: Plan) -> None:
        """Write the joint file, if it has a path."""
        if self.out is None:
            return
        lengths: dict[str, float] = {
            name: parse(name, text, Kind.LENGTH)
            for name, text in (("clearance", self.clearance), ("liner_thickness", self.liner_thickness))
            if text is not None
        }
        force = None if self.force is None else parse("force", self.force, Kind.FORCE)
        file = plan.joint_file(
            **lengths, liner=self.liner_material, ball=self.head_material, force=force, name=self.out.stem
        )
        write_text(self.out, toml_of(file))


@app.command()
@expand_groups
def planning(
    *,
    landmark_options: LandmarkOptions,
    implant_options: ImplantOptions,
    joint_options: PlannedJointOptions,
    as_json: AsJson = False,
) -> None:
    """Read landmarks and STL files of a hip as a joint.

    Landmarks give the pelvic frame, the side, and the radiographic angles of the cup from points on its rim. STL files
    give radius, arc of cover and wall thickness. A clearance is never derived from two files.

    Exit status: 0 success, 2 wrong input.
    """
    if not (landmark_options.landmarks or implant_options.liner or implant_options.head):
        raise ValueError("planning data are needed: --landmarks, --liner or --head")
    joint_options.check(implant_options.head is not None, implant_options.liner is not None)
    landmarks, frame = landmark_options.read()
    liner, head, space = implant_options.read()
    plan = make_plan(frame=frame, landmarks=landmarks, liner=liner, head=head, side=landmark_options.side, space=space)
    joint_options.write(plan)
    if as_json:
        echo_json({**plan.summary(), "file": joint_options.out and str(joint_options.out)})
        return
    _print_plan(plan, joint_options)
    if joint_options.out is not None:
        echo_path(joint_options.out)


def _print_plan(plan: Plan, options: PlannedJointOptions) -> None:
    """Print the table of a plan and its notes."""
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
    for note in plan.notes:
        if note != CLEARANCE_REFUSAL or options.clearance is None:
            print_folded(terminal, note, "dim")
    if options.out is not None:
        head = options.head_material or "rigid"
        print_folded(terminal, f"materials: liner {options.liner_material}, head {head}", "dim")


Row = tuple[str, str, str]


def _pelvis_rows(frame: PelvicFrame | None) -> Iterator[Row]:
    """Yield the rows of the pelvis."""
    if frame is None:
        return
    yield "distance of the ASIS", f"{frame.asis_distance:.1f} mm", ""
    if frame.tilt is not None and frame.obliquity is not None:
        yield "pelvic tilt", f"{degrees(frame.tilt):.1f}°", f"obliquity {degrees(frame.obliquity):.1f}°"


def _cup_rows(orientation: CupOrientation | None) -> Iterator[Row]:
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
        cup: Any = orientation.cup(upright=upright)
        yield f"inclination{title}", f"{degrees(cup.inclination):.1f}°", plane
        yield f"anteversion{title}", f"{degrees(cup.anteversion):.1f}°", ""
        plane = ""


def _fit_rows(part: str, fit: ImplantFit | None) -> Iterator[Row]:
    """Yield the rows of a liner or head."""
    if fit is None:
        return
    yield f"{part} radius", f"{fit.radius:.3f} mm", f"{fit.residual:.3f} mm rms"
    rim = f"rim within {degrees(fit.rim_deviation):.1f}° of a plane" if fit.axis is not None else "complete"
    yield f"{part} arc of cover", f"{degrees(fit.arc_of_cover):.1f}°", rim
    if fit.wall_thickness is not None and fit.wall_range is not None and fit.wall_residual is not None:
        low, high = fit.wall_range
        yield (
            "wall thickness",
            f"{fit.wall_thickness:.2f} mm",
            f"{low:.2f} to {high:.2f} mm, {fit.wall_residual:.3f} mm rms",
        )
