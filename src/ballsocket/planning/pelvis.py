"""Pelvic frame, pelvic tilt, and orientation of a cup in them."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, pi, radians, sin
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_vectors, shown
from ..core.kinds import MILLIMETRES
from ..core.unit_systems import Amount, Sentence
from ..problem.cup import Cup, Side
from .geometry import fit_plane
from .landmarks import ROLES, Landmarks, missing_landmarks, read_side

_ASIS_DISTANCES = (100.0, 400.0)
"""Allowed distance in mm of the two anterior superior iliac spines; adults have about 200 to 280."""

_HEIGHTS = (30.0, 250.0)  # allowed distance in mm of the pubis from the line through both spines
_MIN_SIDE_DISTANCE = 20.0  # distance in mm from the middle of the pelvis from which the side of a cup is clear
_MIN_RIM_POINTS = 3
_MIN_RIM_SPREAD = 0.15  # least width of the points of a rim over their length; below it they lie on a line
_ROUGH_RIM = 1.0  # root mean square distance in mm of rim points from their plane from which a note is given
_UNCERTAIN_AXIS = radians(2.0)
_MAX_TILT = radians(60.0)  # largest angle of the vertical from the pelvic plane


@dataclass(frozen=True, kw_only=True, eq=False)
class PelvicFrame:
    """Frame of the anterior pelvic plane: x to the right, y to the front, z upwards, origin between both spines.

    Attributes
    ----------
    origin : array (3,)
        Middle of both anterior superior iliac spines in mm, RAS.
    axes : array (3, 3)
        Unit vectors x, y, z as rows, in RAS.
    asis_distance, height : float
        Distance of the spines, and of the pubis from their line, in mm.
    tubercle_offset : float or None
        Distance in mm of the two pubic tubercles across the direction of the line of the spines, 0 if both lines are
        parallel; None without tubercles.
    vertical : array (3,) or None
        Direction upwards in the pelvic frame; None if it is not known.
    """

    origin: Numbers
    axes: Numbers
    asis_distance: float
    height: float
    tubercle_offset: float | None = None
    vertical: Numbers | None = None

    def convert(self, points: Numbers) -> Numbers:
        """Convert points (..., 3) in mm from RAS to the pelvic frame."""
        converted: Numbers = (points - self.origin) @ self.axes.T
        return converted

    @property
    def tilt(self) -> float | None:
        """Pelvic tilt in rad, positive if the top of the pelvis leans to the front; None without a vertical."""
        return None if self.vertical is None else atan2(-self.vertical[1], self.vertical[2])

    @property
    def obliquity(self) -> float | None:
        """Angle in rad of the line of both spines from the horizontal, positive if the right side is higher."""
        if self.vertical is None:
            return None
        return atan2(float(self.vertical[0]), hypot(float(self.vertical[1]), float(self.vertical[2])))

    @property
    def body_axes(self) -> Numbers:
        """Unit vectors x, y, z of the upright body as rows, in the pelvic frame.

        z is the vertical; x is the line of both spines, projected on the horizontal. Without a vertical, they are the
        axes of the pelvic frame.
        """
        if self.vertical is None:
            return numpy.eye(3)
        x = numpy.array([1.0, 0.0, 0.0]) - self.vertical[0] * self.vertical
        x /= numpy.linalg.norm(x)
        return numpy.array([x, numpy.cross(self.vertical, x), self.vertical])


def pelvic_frame(landmarks: Landmarks, *, vertical: Any = None, pelvic_tilt: float | None = None) -> PelvicFrame:
    """Compute the frame of the anterior pelvic plane.

    The plane passes through both anterior superior iliac spines and the middle of the pubic tubercles, or the pubic
    symphysis.

    Parameters
    ----------
    landmarks : Landmarks
        Points with names such as "right ASIS", "LASIS", "pubic symphysis", "right pubic tubercle".
    vertical : array (3,), optional
        Direction upwards in RAS: the standing patient's, opposite to gravity.
    pelvic_tilt : float, optional
        Angle in rad from the vertical to the pelvic plane in place of `vertical`; positive if the top leans to the
        front.

    Raises
    ------
    ValueError
        Missing landmarks, mirrored sides, points on a line, or distances that no pelvis has.
    """
    right_spine, left_spine, middle, offset = _landmarks_of_plane(landmarks)
    across = right_spine - left_spine
    distance = float(numpy.linalg.norm(across))
    _check_distance("the anterior superior iliac spines are {} apart", distance, _ASIS_DISTANCES)
    x, origin = across / distance, (right_spine + left_spine) / 2
    up = origin - middle
    up -= (up @ x) * x
    height = float(numpy.linalg.norm(up))
    _check_distance("the pubis is {} from the line through both spines", height, _HEIGHTS)
    z = up / height
    axes = numpy.array([x, numpy.cross(z, x), z])
    if axes[0, 0] < 0:
        raise ValueError(
            "the right ASIS lies to the left of the left one: the names of the sides are mirrored, or the file is in "
            "LPS coordinates where it states RAS"
        )
    if axes[2, 2] < 0:
        raise ValueError("the pubis lies above the spines: their names are exchanged, or the pelvis is upside down")
    frame = {"origin": origin, "axes": axes, "asis_distance": distance, "height": height, "tubercle_offset": offset}
    return PelvicFrame(**frame, vertical=_vertical(axes, vertical, pelvic_tilt))


def _landmarks_of_plane(landmarks: Landmarks) -> tuple[Numbers, Numbers, Numbers, float | None]:
    """Return both spines, the pubis, and the distance of the tubercles across the line of the spines."""
    points: dict[str, Any] = {role: landmarks.find(role) for role in ROLES}
    lacking = [f"the {side} ASIS" for side in ("right", "left") if points[f"{side}_asis"] is None]
    right_tubercle, left_tubercle = points["right_tubercle"], points["left_tubercle"]
    has_tubercles = right_tubercle is not None and left_tubercle is not None
    if points["symphysis"] is None and not has_tubercles:
        lacking.append("the pubic symphysis or both pubic tubercles")
    if lacking:
        raise missing_landmarks(landmarks, ", ".join(lacking))
    right_spine, left_spine = points["right_asis"], points["left_asis"]
    if not has_tubercles:
        return right_spine, left_spine, points["symphysis"], None
    x = (right_spine - left_spine) / max(float(numpy.linalg.norm(right_spine - left_spine)), 1e-9)
    across = right_tubercle - left_tubercle
    if across @ x < 0:
        raise ValueError("the right pubic tubercle lies to the left of the left one: the names are mirrored")
    offset = float(numpy.linalg.norm(across - (across @ x) * x))
    return right_spine, left_spine, (right_tubercle + left_tubercle) / 2, offset


def _check_distance(text: str, distance: float, allowed: tuple[float, float]) -> None:
    """Raise ValueError for a distance in mm that no pelvis has."""
    if not allowed[0] <= distance <= allowed[1]:
        stated = text.format(f"{distance:.3g} mm")
        raise ValueError(f"{stated}: {allowed[0]:g} to {allowed[1]:g} mm are allowed (points on a line, or not in mm?)")


def _vertical(axes: Numbers, vertical: Any, pelvic_tilt: float | None) -> Numbers | None:
    if vertical is not None and pelvic_tilt is not None:
        raise ValueError("either vertical or pelvic_tilt is needed, got both")
    if pelvic_tilt is not None:
        upwards = numpy.array([0.0, -sin(pelvic_tilt), cos(pelvic_tilt)])
    elif vertical is not None:
        direction = numpy.asarray(check_vectors("vertical", vertical, "right, front, up"), dtype=float)
        length = float(numpy.linalg.norm(direction))
        if direction.shape != (3,) or not 0 < length < numpy.inf:
            raise ValueError(f"vertical = {direction.tolist()!s:.60} is not allowed: a direction with a length")
        upwards = axes @ direction / length
    else:
        return None
    angle = float(numpy.arccos(numpy.clip(upwards[2], -1.0, 1.0)))
    if not angle <= _MAX_TILT:
        raise ValueError(
            f"the vertical is {degrees(angle):.0f}° from the pelvic plane's up: at most 60° are allowed; "
            "it points upwards, against gravity"
        )
    return upwards


@dataclass(frozen=True, kw_only=True, eq=False)
class CupOrientation:
    """Orientation of a cup in the pelvis.

    Attributes
    ----------
    axis : array (3,)
        Unit vector out of the opening, in the pelvic frame.
    centre : array (3,)
        Centre of the rim's points, or of the bore, in mm in the pelvic frame.
    side : Side
        Side of the body.
    frame : PelvicFrame
    points : int
        Number of points of the rim; 0 for the axis of a mesh.
    residual : float or None
        Root mean square distance in mm of the points from their plane; None without points.
    angle_error : float or None
        Standard error of the axis in rad; None if it is not known.
    largest_deviation : tuple of str and float, or None
        Name and distance in mm of the point farthest from the plane.
    """

    axis: Numbers
    centre: Numbers
    side: Side
    frame: PelvicFrame
    points: int = 0
    residual: float | None = None
    angle_error: float | None = None
    largest_deviation: tuple[str, float] | None = None

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the accuracy of the angles."""
        notes: list[str] = []
        if (self.residual or 0.0) > _ROUGH_RIM and self.largest_deviation is not None:
            name, distance = self.largest_deviation
            ends = (Amount(length, MILLIMETRES, decimals=1) for length in (self.residual or 0.0, distance))
            text = "the rim's points are {} from their plane (rms), {} {}: look at it"
            notes.append(Sentence(text, next(ends), shown(name), next(ends)))
        if self.points == 3:
            notes.append("three points on the rim leave no residual: more points show how exact the angles are")
        if (self.angle_error or 0.0) > _UNCERTAIN_AXIS:
            notes.append(f"the axis of the cup has a standard error of {degrees(self.angle_error or 0.0):.1f}°")
        if self.frame.vertical is None:
            notes.append("the angles are those in the anterior pelvic plane: the pelvic tilt is not known")
        return tuple(notes)

    def cup(self, upright: bool = True, **attributes: Any) -> Cup:
        """Create the cup with its radiographic angles in the upright body, or in the pelvic frame.

        Without a vertical, both are equal.

        Raises ValueError: a cup that opens upwards or to the middle of the body.
        """
        lateral, front, up = (self.frame.body_axes if upright else numpy.eye(3)) @ self.axis
        lateral = lateral if self.side is Side.RIGHT else -lateral
        inclination = atan2(lateral, -up)
        if not 0 <= inclination <= pi / 2:
            raise ValueError(
                f"the cup's radiographic inclination is {degrees(inclination):.1f}°: 0 to 90° are allowed, opening "
                f"downwards and to the {self.side.value}"
            )
        return Cup(inclination=inclination, anteversion=atan2(front, hypot(lateral, up)), side=self.side, **attributes)


def cup_orientation(landmarks: Landmarks, frame: PelvicFrame, *, side: Side | str | None = None) -> CupOrientation:
    """Compute the orientation of a cup from three or more points on its rim.

    Parameters
    ----------
    landmarks : Landmarks
        Points with names that begin with "rim"; see `Landmarks.rim`.
    frame : PelvicFrame
    side : Side or str, optional
        "right" or "left", where both hips have points.

    Raises
    ------
    ValueError
        Fewer than three points, points on a line, or a side that contradicts their names.
    """
    stated = read_side(side)
    names, points, named = landmarks.rim(stated)
    if len(points) < _MIN_RIM_POINTS:
        raise missing_landmarks(landmarks, f"the cup's rim: {len(points)} of at least 3 points with names like rim-1")
    plane = fit_plane(frame.convert(points))
    if plane.spread[1] < _MIN_RIM_SPREAD * plane.spread[0]:
        raise ValueError(
            f"the {len(points)} points of the rim lie on a line: {', '.join(names[:5])}; spread them around the rim"
        )
    worst = int(abs(plane.distances).argmax())
    return orientation_of_axis(
        plane.normal,
        plane.centre,
        frame,
        side=stated or named,
        points=len(points),
        residual=plane.residual,
        angle_error=plane.angle_error,
        largest_deviation=(names[worst], float(abs(plane.distances[worst]))),
    )


def orientation_of_axis(
    axis: Numbers,
    centre: Numbers,
    frame: PelvicFrame,
    *,
    side: Side | str | None = None,
    signed: bool = False,
    **attributes: Any,
) -> CupOrientation:
    """Return the orientation of a cup from its axis and centre in the pelvic frame.

    Without `signed`, the axis has either sign: a cup opens downwards and to the side. The side follows from the centre.

    Raises ValueError: a centre in the middle of the pelvis, or on the other side than stated.
    """
    lies = Side.RIGHT if centre[0] > 0 else Side.LEFT
    clear = abs(centre[0]) >= _MIN_SIDE_DISTANCE
    stated = read_side(side)
    if stated is None and not clear:
        raise ValueError(f"the cup is {abs(centre[0]):.0f} mm from the middle of the pelvis: state its side")
    if stated is not None and clear and stated is not lies:
        raise ValueError(
            f"the cup is {abs(centre[0]):.0f} mm to the {lies.value} of the middle, but its side is stated as "
            f"{stated.value}: the sides are mirrored"
        )
    chosen = stated or lies
    outwards = numpy.array([1.0 if chosen is Side.RIGHT else -1.0, 0.0, -1.0])
    opening = axis if signed or axis @ outwards >= 0 else -axis
    return CupOrientation(axis=opening, centre=centre, side=chosen, frame=frame, **attributes)
