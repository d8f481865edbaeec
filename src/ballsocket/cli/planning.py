"""Command `planning`: landmarks, meshes and worn bores of a hip."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from ..core.storage.atomic_files import check_parent_folder, write_text
from ..core.unit_systems import Units
from ..files.joint_file import Direction
from ..files.joint_toml import toml_of
from ..files.schema import Angle, FileTable, Force, Length, Text, Word, meaning
from ..files.tables import quantities_of
from ..planning.implants import fit_head, fit_liner
from ..planning.landmarks import read_landmarks
from ..planning.pelvis import pelvic_frame
from ..planning.plan import CLEARANCE_REFUSAL, HipPlan, describe_plan, make_plan
from ..planning.surfaces import read_mesh, read_points
from ..planning.worn_bores import measure_wear
from .elasticity_options import orientation_remark, orientation_summary
from .options import AsJson, UnitSystem, expand_groups, print_result
from .root import app, echo_path


class SpaceName(Word):
    """Coordinates of a scan."""

    choices = ("ras", "lps")


@dataclass(frozen=True, kw_only=True)
class PlanFiles:
    """Options of the files to read, and of the joint file to write."""

    landmarks: Annotated[
        list[Path] | None,
        typer.Option(help="Landmark file of 3D Slicer (.mrk.json, .fcsv). Repeat for several. Default: none."),
    ] = None
    rename: Annotated[
        list[str] | None,
        typer.Option(help="Point of a landmark: 'right_asis=F-1'. Repeat for several. Default: names as in the file."),
    ] = None
    liner: Annotated[Path | None, typer.Option(help="Mesh of the liner: STL, OBJ or PLY. Default: none.")] = None
    head: Annotated[Path | None, typer.Option(help="Mesh of the head: STL, OBJ or PLY. Default: none.")] = None
    worn: Annotated[
        Path | None,
        typer.Option(help="Points of a worn bore: .xyz, .csv, .txt, .asc, .pts, or a mesh of the bore. Default: none."),
    ] = None
    out: Annotated[Path | None, typer.Option(help="Write a joint file (.toml) for `ballsocket press`.")] = None

    def check(self, clearance: float | None) -> None:
        """Raise ValueError before any work without data, or if no joint file can be written."""
        if not (self.landmarks or self.liner or self.head or self.worn):
            raise ValueError("planning data are needed: --landmarks, --liner, --head or --worn")
        if self.out is None:
            return
        if clearance is None:
            both = self.head is not None and self.liner is not None
            raise ValueError(CLEARANCE_REFUSAL if both else "--out needs a clearance: state it with --clearance")
        if self.out.suffix.lower() != ".toml":
            raise ValueError(f"{self.out.name!r:.60} is not a name for a joint file: it ends with .toml")
        check_parent_folder(self.out)


class PlanInputs(FileTable, frozen=True, kw_only=True):
    """Pelvis, scans and joint of a plan."""

    coordinates: Annotated[
        Text | None, meaning("RAS or LPS, for landmark files that do not state their system", default="as in the file")
    ] = None
    side: Annotated[Text | None, meaning("side of the cup: right or left", default="from names and position")] = None
    vertical: Annotated[
        Direction | None, meaning("direction upwards 'x,y,z' in the scan: right, front, up", default="not known")
    ] = None
    pelvic_tilt: Annotated[
        Angle | None,
        meaning("tilt of the pelvic plane, positive to the front; not with --vertical", default="not known"),
    ] = None
    head_diameter: Annotated[
        Length | None, meaning("measured diameter of the head that wore the bore of --worn", default="not known")
    ] = None
    stl_units: Annotated[Text, meaning("unit of the meshes and points: mm, cm, m, um or in")] = Text("mm")
    placed: Annotated[
        SpaceName | None,
        meaning("coordinates of the scan that the liner's file has", default="as in the header of 3D Slicer"),
    ] = None
    clearance: Annotated[Length | None, meaning("radial clearance; needed for --out", default="none")] = None
    liner_thickness: Annotated[Length | None, meaning("thickness of the liner", default="the measured wall")] = None
    liner_material: Annotated[Text, meaning("name of the liner material, see `ballsocket presets`")] = Text("uhmwpe")
    head_material: Annotated[Text | None, meaning("name of the head material", default="a rigid head")] = None
    force: Annotated[Force | None, meaning("load of the joint file", default="none")] = None

    def plan(self, files: PlanFiles) -> HipPlan:
        """Read the files, and combine landmarks and implants."""
        landmarks, frame = None, None
        if files.landmarks:
            pairs = [text.partition("=") for text in files.rename or ()]
            landmarks = read_landmarks(
                *files.landmarks,
                coordinates=self.coordinates,
                rename={role.strip(): name.strip() for role, _, name in pairs},
            )
            frame = pelvic_frame(landmarks, vertical=self.vertical, **quantities_of(self, "pelvic_tilt"))
        liner = None if files.liner is None else read_mesh(files.liner, units=self.stl_units)
        head = None if files.head is None else fit_head(read_mesh(files.head, units=self.stl_units))
        worn, head_radius = None, None if self.head_diameter is None else float(self.head_diameter) / 2.0
        if files.worn is not None:
            worn = measure_wear(read_points(files.worn, units=self.stl_units), head_radius=head_radius)
        elif head_radius is not None:
            raise ValueError("--head-diameter is the head that wore a measured bore: it needs --worn")
        return make_plan(
            frame=frame,
            landmarks=landmarks,
            liner=None if liner is None else fit_liner(liner),
            head=head,
            side=self.side,
            space=self.placed or (None if liner is None else liner.space),
            worn=worn,
        )


@app.command()
@expand_groups
def planning(*, files: PlanFiles, inputs: PlanInputs, units: UnitSystem = Units.SI, as_json: AsJson = False) -> None:
    """Read landmarks, liner, head and worn bore of a hip.

    Landmarks give the pelvic frame, the side, and the radiographic angles of the cup from points on its rim. Meshes
    of liner and head give radius, arc of cover and wall thickness. A clearance is never derived from two files.
    Points of a worn bore give the worn volume and the deepest wear with their errors.

    Exit status: 0 success, 2 wrong input.
    """
    files.check(inputs.clearance)
    plan = inputs.plan(files)
    if files.out is not None:
        numbers = quantities_of(inputs, "clearance", "liner_thickness", "force")
        file = plan.joint_file(**numbers, liner=inputs.liner_material, ball=inputs.head_material, name=files.out.stem)
        write_text(files.out, toml_of(file))
    orientation = {} if plan.orientation is None else orientation_summary(plan.cup)
    path = None if files.out is None else str(files.out)
    remarks = [orientation_remark(plan.cup)] if orientation else []
    remarks += [note for note in plan.notes if inputs.clearance is None or note != CLEARANCE_REFUSAL]
    if inputs.clearance is not None:
        ball = inputs.head_material or "rigid"
        remarks.append(f"materials: liner {inputs.liner_material}, head {ball}")
    print_result(
        lambda: {**plan.summary(), "orientation": orientation or None, "file": path},
        lambda: describe_plan(plan, remarks),
        units,
        as_json,
    )
    if files.out is not None and not as_json:
        echo_path(files.out)
