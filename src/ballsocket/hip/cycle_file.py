"""A cycle of one's own, from tables: of text, of OpenSim, or as OrthoLoad has them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path

import numpy

from ..core.arrays import Numbers
from ..core.checks import known_name, require
from ..core.deprecation import renamed_arguments
from ..problem.cup import Side
from .cycle import DEFAULT_STEPS, Course, Cycle, Frame
from .measured import ANGLES, FORCES, Measured, measured, together
from .resampled import CLOSED, check_closed, clock_of, course, cut, phases_of
from .sliding import rotation_matrices
from .tables import read_table

FRAMES = ("body", "femur", "cup")
BODIES = ("socket", "ball")


@dataclass(frozen=True, kw_only=True, eq=False)
class Reading:
    """How a table is to be read, beyond what its columns say.

    Parameters
    ----------
    side : Side
        Of the hip in the table: on the left, `force_x` to the right is to the middle. Default RIGHT.
    frame : str, optional
        "body", "femur" (it turns with the ball) or "cup": whose directions the force has, where columns do not say it.
    force_on : str, optional
        "socket" or "ball", where columns do not say it.
    begin, end : float, optional
        Times in s, or phases from 0 to 1, of the one cycle that is cut out.
    closing : float
        Of its span: so much a column may end elsewhere than it begins, which is spread over the cycle. Default 0.01.
    motion : Cycle, optional
        Whose angles are taken where a table has none.

    Raises
    ------
    ValueError
        A word or a number that is not allowed.
    """

    side: Side = Side.RIGHT
    frame: str | None = None
    force_on: str | None = None
    begin: float | None = None
    end: float | None = None
    closing: float = CLOSED
    motion: Cycle | None = None

    def __post_init__(self) -> None:
        for name, known in (("frame", FRAMES), ("force_on", BODIES)):
            if (given := getattr(self, name)) is not None:
                known_name(name, given, known)
        require("closing", self.closing, 0 <= self.closing <= 0.5, "it is 0 to 0.5 of what a column spans")


@renamed_arguments(instants="n_steps")
def read_cycle(
    path: str | Path | Sequence[str | Path],
    n_steps: int = DEFAULT_STEPS,
    order: str = "xyz",
    body_weight: float | None = None,
    reading: Reading = Reading(),
) -> Cycle:
    """Read a cycle from a table, or from several of one walk.

    In a table of text a line names the columns with their units: `time [s]` or `phase [%]`; `force [N]` along z, or
    `force_x [N]`, `force_y [N]`, `force_z [N]`; `flexion [deg]`, `adduction [deg]`, `rotation [deg]`, of which those
    that are missing are zero. Forces may be in kN, or in %BW, which needs the body's weight. Columns are parted by
    commas, semicolons, tabs or blanks; lines that begin with # are passed over. As OrthoLoad has it, `Fx`, `Fy`, `Fz`
    are forces on the ball in the femur's frame. Of OpenSim's storages (.mot, .sto) are read the coordinates
    `hip_flexion_r`, `hip_adduction_r`, `hip_rotation_r` and the joint's reaction, as
    `hip_r_on_femur_r_in_pelvis_fx`, or those of the left hip. The last line is the first again, one cycle later.
    Between the lines the course is monotone and smooth.

    Parameters
    ----------
    path : str or Path, or several
    n_steps, order
        As of `Cycle`.
    body_weight : float, optional
        In N.
    reading : Reading
        Side, frame, what is cut out, and the like.

    Raises
    ------
    ValueError
        One sentence: a column without its unit, a gap, what is no number, a cycle that does not close.
    OSError
        A file cannot be read.
    """
    paths = [Path(path)] if isinstance(path, str | Path) else [Path(each) for each in path]
    if not paths:
        raise ValueError("no table is named")
    try:
        parts = [measured(read_table(each), body_weight, reading.side) for each in paths]
        found = together([replace(part, columns=cut(part.columns, reading.begin, reading.end)) for part in parts])
        return replace(_cycle(found, order, reading), name=paths[0].stem, n_steps=n_steps)
    except ValueError as error:
        raise ValueError(f"{', '.join(each.name for each in paths)}: {error}") from error


def _cycle(found: Measured, order: str, reading: Reading) -> Cycle:
    columns, motion = found.columns, reading.motion
    phase, duration = phases_of(columns)
    for title, values in columns.items():
        if title.startswith("force"):
            _check_size(title, values)
        if title != clock_of(columns):
            check_closed(title, values, reading.closing, *(("°", 180 / pi) if title in ANGLES else (" N", 1.0)))
        if title in ANGLES:
            _check_turn(title, values)
    angles = _angles(phase, columns, motion)
    frame = known_name("frame", reading.frame or found.frame or FRAMES[0], FRAMES)
    on = known_name("force_on", reading.force_on or found.force_on or BODIES[0], BODIES)
    force = course(phase, _force(columns, reading.side, on))
    return Cycle(
        name="",
        force=_turning(force, angles, order) if frame == "femur" and "force" not in columns else force,
        angles=angles,
        order=order,
        duration=duration,
        frame=Frame.CUP if frame == "cup" else Frame.BODY,
        notes=() if motion is None else (f"the motion is that of {motion.name}",),
    )


def _check_size(title: str, values: Numbers) -> None:
    """Raise ValueError for a force (N) beyond any hip joint, as from a wrong unit or a damaged table."""
    largest = float(abs(values).max())
    if largest > _LARGEST_FORCE:
        raise ValueError(f"{title} goes to {largest:.4g} N; allowed are forces up to {_LARGEST_FORCE:g} N")


_LARGEST_FORCE = 1e9
"""Largest allowed force in N, beyond any hip and any test machine."""


def _check_turn(title: str, values: Numbers) -> None:
    """Raise ValueError where an angle (rad) is one to which no hip turns, as of degrees under a head in rad."""
    furthest = float(values[abs(values).argmax()])
    if abs(furthest) > pi:
        raise ValueError(
            f"{title} goes to {180 / pi * furthest:.4g}°, and no hip turns further than 180°: is its unit right?"
        )


def _angles(phase: Numbers, columns: dict[str, Numbers], motion: Cycle | None) -> Course:
    given = any(name in columns for name in ANGLES)
    if motion is None:
        return course(phase, numpy.stack([columns.get(name, 0.0 * phase) for name in ANGLES]))
    if given:
        raise ValueError(f"angles are there, and the motion of {motion.name} is one too many")
    return motion.angles


def _force(columns: dict[str, Numbers], side: Side, on: str) -> Numbers:
    """The force on the socket, to the side, to the front and upwards, or its size alone."""
    whole = all(name in columns for name in FORCES)
    if ("force" in columns) == whole or (not whole and any(name in columns for name in FORCES)):
        raise ValueError("a column force [N], or force_x, force_y and force_z, is needed")
    if "force" in columns:
        return columns["force"]
    force = numpy.stack([columns[name] for name in FORCES])
    force[0] *= 1.0 if side is Side.RIGHT else -1.0
    return force if on == "socket" else -force


def _turning(force: Course, angles: Course, order: str) -> Course:
    """A force that is told in directions that turn with the ball."""
    return lambda phases: numpy.einsum("nij,jn->in", rotation_matrices(angles(phases).T, order), force(phases))
