"""Command `planning`: landmarks, meshes and worn bores of a hip."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ..core.kinds import Kind
from ..core.storage.atomic_files import check_parent_folder, write_text
from ..files.joint_toml import toml_of
from ..files.units import parse
from ..planning.clouds import read_points
from ..planning.implants import ImplantFit, fit_head, fit_liner
from ..planning.landmarks import Landmarks, read_landmarks
from ..planning.meshes import read_mesh
from ..planning.pelvis import PelvicFrame, pelvic_frame
from ..planning.plan import CLEARANCE_REFUSAL, HipPlan, make_plan
from ..planning.worn_bores import WornBore, measure_wear
from ..reports.planning_results import print_plan
from .elasticity_options import orientation_remark, orientation_summary
from .json_answers import echo_json
from .options import AsJson, expand_groups
from .root import app, echo_path

_SPACES = ("ras", "lps")


@dataclass(frozen=True, kw_only=True)
class LandmarkOptions:
    """Options of landmark files and of the pelvis."""

    landmarks: Annotated[
        list[Path] | None,
        typer.Option(help="Landmark file of 3D Slicer (.mrk.json, .fcsv). Repeat for several. Default: none."),
    ] = None
    rename: Annotated[
        list[str] | None,
        typer.Option(help="Point of a landmark: 'right_asis=F-1'. Repeat for several. Default: names as in the file."),
    ] = None
    coordinates: Annotated[
        str | None,
        typer.Option(help="RAS or LPS, for landmark files that do not state their system. Default: as in the file."),
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
    """Options of the meshes."""

    liner: Annotated[Path | None, typer.Option(help="Mesh of the liner: STL, OBJ or PLY. Default: none.")] = None
    head: Annotated[Path | None, typer.Option(help="Mesh of the head: STL, OBJ or PLY. Default: none.")] = None
    worn: Annotated[
        Path | None,
        typer.Option(help="Points of a worn bore: .xyz, .csv, .txt, .asc, .pts, or a mesh of the bore. Default: none."),
    ] = None
    head_diameter: Annotated[
        str | None,
        typer.Option(help="Measured diameter in mm of the head that wore the bore of --worn. Default: not known."),
    ] = None
    stl_units: Annotated[str, typer.Option(help="Unit of the meshes and points: mm, cm, m, um or in.")] = "mm"
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
        liner = None if self.liner is None else read_mesh(self.liner, units=self.stl_units)
        head = None if self.head is None else fit_head(read_mesh(self.head, units=self.stl_units))
        fit = None if liner is None else fit_liner(liner)
        return fit, head, self.placed or (None if liner is None else liner.space)

    def read_wear(self) -> WornBore | None:
        """Measure the wear of the points, if there are any."""
        if self.worn is None:
            if self.head_diameter is not None:
                raise ValueError("--head-diameter is the head that wore a measured bore: it needs --worn")
            return None
        diameter = None if self.head_diameter is None else parse("head_diameter", self.head_diameter, Kind.LENGTH)
        head_radius = None if diameter is None else diameter / 2.0
        return measure_wear(read_points(self.worn, units=self.stl_units), head_radius=head_radius)


@dataclass(frozen=True, kw_only=True)
class PlannedJointOptions:
    """Options of the joint file."""

    clearance: Annotated[
        str | None, typer.Option(help="Radial clearance in mm: '0.15 mm'. Needed for --out. Default: none.")
    ] = None
    liner_thickness: Annotated[
        str | None, typer.Option(help="Thickness of the liner in mm. Default: the measured wall.")
    ] = None
    liner_material: Annotated[str, typer.Option(help="Name of the liner material, see `ballsocket presets`.")] = (
        "uhmwpe"
    )
    head_material: Annotated[str | None, typer.Option(help="Name of the head material. Default: a rigid head.")] = None
    force: Annotated[
        str | None, typer.Option(help="Load of the joint file in N, or with a unit: '3 kN'. Default: none.")
    ] = None
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

    def write(self, plan: HipPlan) -> None:
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
    """Read landmarks, liner, head and worn bore of a hip.

    Landmarks give the pelvic frame, the side, and the radiographic angles of the cup from points on its rim. Meshes
    of liner and head give radius, arc of cover and wall thickness. A clearance is never derived from two files.
    Points of a worn bore give the worn volume and the deepest wear with their errors.

    Exit status: 0 success, 2 wrong input.
    """
    if not (landmark_options.landmarks or implant_options.liner or implant_options.head or implant_options.worn):
        raise ValueError("planning data are needed: --landmarks, --liner, --head or --worn")
    joint_options.check(implant_options.head is not None, implant_options.liner is not None)
    landmarks, frame = landmark_options.read()
    liner, head, space = implant_options.read()
    plan = make_plan(
        frame=frame,
        landmarks=landmarks,
        liner=liner,
        head=head,
        side=landmark_options.side,
        space=space,
        worn=implant_options.read_wear(),
    )
    joint_options.write(plan)
    if as_json:
        orientation = {} if plan.orientation is None else orientation_summary(plan.cup)
        file = None if joint_options.out is None else str(joint_options.out)
        echo_json({**plan.summary(), "orientation": orientation or None, "file": file})
        return
    remarks = [] if plan.orientation is None else [orientation_remark(plan.cup)]
    remarks += [note for note in plan.notes if joint_options.clearance is None or note != CLEARANCE_REFUSAL]
    if joint_options.clearance is not None:
        ball = joint_options.head_material or "rigid"
        remarks.append(f"materials: liner {joint_options.liner_material}, head {ball}")
    print_plan(plan, remarks)
    if joint_options.out is not None:
        echo_path(joint_options.out)
