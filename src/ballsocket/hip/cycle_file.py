"""Cycles in files: measured tables, and the tables [cycle] and [[activity]] of a hip file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_names, known_name, refusals_of, require, shown
from ..core.display import plain_number
from ..files.columns import ALL_COLUMNS, HeadChoice
from ..problem.cup import Side
from .cycle import DEFAULT_STEPS, Cycle, Frame
from .cycle_registry import CYCLES, named_cycle
from .cycle_tables import (
    ANGLES,
    DEFAULT_CLOSURE,
    FORCES,
    HipColumns,
    check_closed,
    combine_columns,
    monotone_periodic,
    opensim_columns,
    phases_and_duration,
    read_table,
    select_time_range,
    text_columns,
    time_column,
)
from .in_vivo_cycles import check_body_weight
from .kinematics import rotation_matrices
from .mix import Activity, Mix
from .schema import CycleKeys, CycleTables, FrameName, LoadedPart

_FRAMES, _BODIES = FrameName.choices, LoadedPart.choices
_MAX_FORCE = 1e9  # largest allowed force in N, beyond any hip and any test machine


@dataclass(frozen=True, kw_only=True, eq=False)
class TableOptions:
    """Options for reading a table of a cycle.

    Parameters
    ----------
    side : Side
        Side of the hip in the table. On the left, `force_x` to the right points to the middle. Default RIGHT.
    frame : str, optional
        Frame of the force, if the columns do not state it: "body", "femur" (rotates with the ball) or "cup".
    force_on : str, optional
        Body that the force acts on, if the columns do not state it: "socket" or "ball".
    begin, end : float, optional
        Times in s, or phases from 0 to 1, between which one cycle is cut out.
    closing : float
        Allowed difference between the ends of a column as a share of its range, distributed over the cycle.
        Default 0.01.
    motion : Cycle, optional
        Cycle whose angles are used if the table has none.
    heads : HeadChoice
        Columns of the file that get another name, or that are not used.

    Raises
    ------
    ValueError
        A word or a number is not allowed.
    """

    side: Side = Side.RIGHT
    frame: str | None = None
    force_on: str | None = None
    begin: float | None = None
    end: float | None = None
    closing: float = DEFAULT_CLOSURE
    motion: Cycle | None = None
    heads: HeadChoice = ALL_COLUMNS

    def __post_init__(self) -> None:
        for name, choices in (("frame", _FRAMES), ("force_on", _BODIES)):
            if (value := getattr(self, name)) is not None:
                known_name(name, value, choices)
        require("closing", self.closing, 0 <= self.closing <= 0.5, "0 to 0.5 of the range of a column")


def read_cycle(
    path: str | Path | Sequence[str | Path],
    n_steps: int = DEFAULT_STEPS,
    order: str = "xyz",
    body_weight: float | None = None,
    options: TableOptions = TableOptions(),
) -> Cycle:
    """Read a cycle from one table, or from several tables of the same cycle.

    In a text table one line names the columns with their units: `time [s]` or `phase [%]`; `force [N]` along z, or
    `force_x [N]`, `force_y [N]`, `force_z [N]`; `flexion [deg]`, `adduction [deg]`, `rotation [deg]`. Missing angles
    are zero, which a note states. Forces may be in kN, or in %BW, which needs the body weight. Columns are separated by
    commas, semicolons, tabs or blanks; lines that begin with # are ignored. Columns `Fx`, `Fy`, `Fz`, as OrthoLoad
    names them, are forces on the ball in the femur's frame. OpenSim files (.mot, .sto) have the coordinates
    `hip_flexion_r`, `hip_adduction_r`, `hip_rotation_r` and the joint reaction, such as
    `hip_r_on_femur_r_in_pelvis_fx`, or those of the left hip. The last line must repeat the first, one cycle later.
    Between the lines, values are interpolated smoothly and monotonically.

    Parameters
    ----------
    path : str or Path, or several
    n_steps, order
        As in `Cycle`.
    body_weight : float, optional
        Body weight in N.
    options : TableOptions
        Side, frame and the part of the table that is used.

    Raises
    ------
    ValueError
        A column has no unit, a time step is a gap, a cell is not a number, or the cycle does not close.
    OSError
        A file cannot be read.
    """
    paths = [Path(path)] if isinstance(path, str | Path) else [Path(name) for name in path]
    if not paths:
        raise ValueError("no table is named")
    tables = [read_table(file, options.heads) for file in paths]
    with refusals_of(", ".join(file.name for file in paths)):
        hips = [
            opensim_columns(table, options.side) if table.is_opensim else text_columns(table, body_weight)
            for table in tables
        ]
        parts = [replace(hip, columns=select_time_range(hip.columns, options.begin, options.end)) for hip in hips]
        remark = "; ".join(table.remark() for table in tables if table.remark())
        cycle = _table_cycle(combine_columns(parts), order, options)
        return replace(cycle, name=paths[0].stem, n_steps=n_steps, remark=remark)


def _table_cycle(table: HipColumns, order: str, options: TableOptions) -> Cycle:
    """Create a cycle without a name from columns in s, N and rad."""
    columns, motion = table.columns, options.motion
    phase, duration = phases_and_duration(columns)
    for title, values in columns.items():
        _check_size(title, values)
        if title != time_column(columns):
            check_closed(title, values, options.closing, *(("°", 180 / pi) if title in ANGLES else (" N", 1.0)))
    if motion is None:
        angles = monotone_periodic(phase, numpy.stack([columns.get(name, 0.0 * phase) for name in ANGLES]))
    elif any(name in columns for name in ANGLES):
        raise ValueError(f"the table has angles, so the motion of {motion.name} cannot be used: remove one of them")
    else:
        angles = motion.angles
    frame = known_name("frame", options.frame or table.frame or _FRAMES[0], _FRAMES)
    loaded_body = known_name("force_on", options.force_on or table.force_on or _BODIES[0], _BODIES)
    force = monotone_periodic(phase, _socket_force(columns, options.side, loaded_body))

    def force_of_femur(phases: Numbers) -> Numbers:
        """Convert the force in the femur's frame, which rotates with the ball, to the body's frame."""
        return numpy.einsum("nij,jn->in", rotation_matrices(angles(phases).T, order), force(phases))

    return Cycle(
        name="",
        force=force_of_femur if frame == "femur" and "force" not in columns else force,
        angles=angles,
        order=order,
        duration=duration,
        frame=Frame.CUP if frame == "cup" else Frame.BODY,
        notes=(
            *(_missing_angle_notes(columns) if motion is None else (f"the motion is that of {motion.name}",)),
            *_assumed_frame_notes(table, options, loaded_body, frame),
        ),
    )


def _assumed_frame_notes(table: HipColumns, options: TableOptions, loaded_body: str, frame: str) -> tuple[str, ...]:
    """Return a note on the loaded body and the frame of the force, as far as the user does not state them."""
    assumed = {"force_on": f"acts on the {loaded_body}", "frame": f"is in the frame of the {frame}"}
    unstated = [text for name, text in assumed.items() if getattr(options, name) is None]
    if "force_z" not in table.columns or not unstated or (table.frame is not None and not table.orthoload):
        return ()
    reason = "by its heads, those of OrthoLoad" if table.orthoload else "by default"
    return (f"the force {' and '.join(unstated)} {reason}; force_on and frame in [cycle] state it",)


def _missing_angle_notes(columns: Mapping[str, Numbers]) -> tuple[str, ...]:
    """Return a note on the rotations without a column, which are zero."""
    missing = [name for name in ANGLES if name not in columns]
    if not missing:
        return ()
    meaning = (
        "the ball does not rotate: no sliding and no wear"
        if len(missing) == len(ANGLES)
        else "cross-shear and crossing angle mean nothing, nor does wear by a law with cross-shear"
    )
    return (f"the motion has no columns of {', '.join(missing)}: they are assumed to be 0, so that {meaning}",)


def _check_size(title: str, values: Numbers) -> None:
    """Raise ValueError for forces (N) above those of any hip and for angles (rad) beyond 180°: a wrong unit."""
    largest = float(values[abs(values).argmax()])
    if title.startswith("force") and abs(largest) > _MAX_FORCE:
        allowed = f"allowed are forces up to {plain_number(_MAX_FORCE)} N"
        raise ValueError(f"{title} goes to {plain_number(abs(largest))} N; {allowed}")
    if title in ANGLES and abs(largest) > pi:
        raise ValueError(f"{title} goes to {180 / pi * largest:.4g}°; allowed are angles up to 180°: check its unit")


def _socket_force(columns: dict[str, Numbers], side: Side, loaded_body: str) -> Numbers:
    """Return the force of the ball on the socket in N: (3, rows), or its upward magnitude alone: (rows,)."""
    complete = all(name in columns for name in FORCES)
    if ("force" in columns) == complete or (not complete and any(name in columns for name in FORCES)):
        raise ValueError("the table needs either a column force [N], or force_x, force_y and force_z")
    if "force" in columns:
        return columns["force"]
    force = numpy.stack([columns[name] for name in FORCES])
    force[0] *= 1.0 if side is Side.RIGHT else -1.0
    return force if loaded_body == "socket" else -force


_COMMON_KEYS = ("instants", "rotation_order", "times_body_weight")
_TABLE_KEYS = ("side", "frame", "force_on", "from", "to", "closing", "motion", "columns", "skip")


def cycle_of(tables: CycleTables, folder: Path) -> Cycle | Mix:
    """Create the cycle of a hip file from its [cycle], or the mix of its [[activity]] tables."""
    weight = None if tables.body_weight is None else check_body_weight(float(tables.body_weight))
    if tables.activity is None:
        return _create_cycle(tables.cycle or CycleKeys(), folder, weight, "[cycle]")
    if tables.cycle is not None:
        raise ValueError("the file has both [cycle] and [[activity]]: remove one of them")
    activities = []
    for table in tables.activity:
        if (table.per_year is None) == (table.share is None):
            raise ValueError("an [[activity]] needs either per_year (cycles a year) or share (of cycles_per_year)")
        cycle = _create_cycle(table, folder, weight, "[[activity]]")
        if table.per_year is not None:
            per_year = float(table.per_year)
        elif tables.cycles_per_year is None or table.share is None:
            raise ValueError("share needs cycles_per_year at the top of the file")
        else:
            per_year = float(tables.cycles_per_year) * float(table.share)
        activities.append(Activity(cycle=cycle, per_year=per_year))
    return Mix(activities=tuple(activities))


def _create_cycle(table: CycleKeys, folder: Path, weight: float | None, where: str) -> Cycle:
    """Create the cycle of one table, by name or from a file, scaled to a multiple of body weight if stated."""
    if (table.name is None) == (table.file is None):
        raise ValueError(f"{where} needs either a name or a file; names: {', '.join(CYCLES)}")
    weight = weight if table.body_weight is None else check_body_weight(float(table.body_weight))
    order = "xyz" if table.rotation_order is None else str(table.rotation_order.value)
    keys = [key for key in table.stated() if key not in ("per_year", "share")]
    if table.name is not None:
        definition = CYCLES[table.name]
        weight_key = ("body_weight",) if definition.per_body_weight or table.times_body_weight is not None else ()
        allowed = ("name", *_COMMON_KEYS, *weight_key, *(parameter.key for parameter in definition.parameters))
        check_names(keys, allowed, f"with the name {definition.name!r} in {where}")
        values = {parameter.argument: table.parameter(parameter.key) for parameter in definition.parameters}
        stated = {argument: value for argument, value in values.items() if value is not None}
        body_weight = weight if definition.per_body_weight else None
        cycle = named_cycle(definition.name, int(table.instants), order, body_weight, **stated)
    else:
        check_names(keys, ("file", "body_weight", *_COMMON_KEYS, *_TABLE_KEYS), f"with a file in {where}")
        if not table.file or not all(table.file):
            raise ValueError(f"file = {shown(list(table.file or ()))} names no table")
        motion = None
        if table.motion is not None:
            body_weight = (weight or 1.0) if CYCLES[table.motion].per_body_weight else None
            motion = named_cycle(table.motion, DEFAULT_STEPS, order, body_weight)
        options = TableOptions(
            side=Side.RIGHT if table.side is None else Side(table.side),
            frame=table.frame,
            force_on=table.force_on,
            begin=table.begin,
            end=table.end,
            closing=DEFAULT_CLOSURE if table.closing is None else table.closing,
            motion=motion,
            heads=table.choice(),
        )
        cycle = read_cycle([folder / name for name in table.file], int(table.instants), order, weight, options)
    if table.times_body_weight is None:
        return cycle
    if weight is None:
        raise ValueError("times_body_weight needs a body_weight")
    times = float(table.times_body_weight)
    require("times_body_weight", times, 0 < times <= 100, "a load is above 0 and at most 100 times the body weight")
    return cycle.scaled(times * weight / cycle.largest_force)
