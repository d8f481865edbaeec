"""Cup: rim, interface of the liner, and orientation of the socket in the body.

Directions are those of the patient's body: x to the right, y to the front, z upwards.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan2, degrees, hypot, pi, radians
from typing import Any, Self

from ..core import arrays
from ..core.arrays import Array, cos, is_plain_number, sin
from ..core.checks import check_numeric, require, shown
from ..core.kinds import Choice
from ..core.quantities import CUP

Direction = tuple[float, float, float]

UP: Direction = (0.0, 0.0, 1.0)
"""Direction of a vertical load of the ball on a cup."""


AXIAL_TILT = 1e-9
"""Angle in rad between a load and the axis of a cup up to which the load counts as axial."""


class Interface(Choice):
    """Interface between the liner and its backing: bonded, or sliding without friction."""

    BONDED = "bonded"
    SLIDING = "sliding"


class Side(Choice):
    """Side of the body, right or left, on which the cup lies.

    On the left, x points to the middle of the body.
    """

    RIGHT = "right"
    LEFT = "left"


class AngleDefinition(Choice):
    """Definition of the inclination and anteversion of a cup (Murray 1993).

    RADIOGRAPHIC: inclination between the axes of body and cup in the frontal view; anteversion between the cup's axis
    and the frontal plane. OPERATIVE: inclination between the cup's axis and the sagittal plane; anteversion between
    the axes of body and cup in the sagittal view. ANATOMICAL: inclination between the axes of body and cup;
    anteversion between the transverse axis and the cup's axis in the view from above.
    """

    RADIOGRAPHIC = "radiographic"
    OPERATIVE = "operative"
    ANATOMICAL = "anatomical"


def _opening_of(inclination: Array, anteversion: Array, definition: AngleDefinition) -> tuple[Array, Array, Array]:
    """Return the axis of a cup out of its opening: lateral, to the front, downwards."""
    if definition is AngleDefinition.OPERATIVE:
        across = cos(inclination)
        return sin(inclination), across * sin(anteversion), across * cos(anteversion)
    if definition is AngleDefinition.ANATOMICAL:
        level = sin(inclination)
        return level * cos(anteversion), level * sin(anteversion), cos(inclination)
    frontal = cos(anteversion)
    return sin(inclination) * frontal, sin(anteversion), cos(inclination) * frontal


def _angles_of(opening: Direction, definition: AngleDefinition) -> tuple[float, float]:
    """Return the inclination and anteversion in rad of an axis: lateral, to the front, downwards."""
    lateral, front, down = opening
    if definition is AngleDefinition.OPERATIVE:
        return atan2(lateral, hypot(front, down)), atan2(front, down)
    if definition is AngleDefinition.ANATOMICAL:
        return atan2(hypot(lateral, front), down), atan2(front, lateral)
    return atan2(lateral, down), atan2(front, hypot(lateral, down))


def cup_axes(inclination: Array, anteversion: Array, side: Side) -> tuple[Any, Any, Any]:
    """Compute the unit vectors x, y, z of a cup's frame in the body frame, each a tuple of three components.

    The angles in rad are numbers or arrays of any library.
    """
    lateral, front, down = _opening_of(inclination, anteversion, AngleDefinition.RADIOGRAPHIC)
    sign = 1.0 if side is Side.RIGHT else -1.0
    level = cos(inclination)
    x, z = (sign * level, 0.0 * level, sin(inclination)), (-sign * lateral, -front, down)
    y = (z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0])
    return x, y, z


class UnsetAngle(float):
    """Default angle in rad of a cup, which nobody set.

    The standard of a load cycle may replace an orientation, and a preloaded joint the arc of cover.
    """


_UNSET_ANGLE, _UNSET_ARC = UnsetAngle(0.0), UnsetAngle(pi)

HOLDING_ARC = radians(240.0)
"""Assumed arc of cover in rad of a socket that holds a preloaded ball."""


@dataclass(frozen=True, kw_only=True)
class Cup:
    """Geometry and orientation of a cup: rim, interface of its liner, and angles in the body.

    `Cup()` is a hemisphere that opens downwards. A vertical load acts along its axis, as every axisymmetric model
    assumes. Inclination and anteversion are radiographic: the anteversion is the angle between the cup's axis and the
    frontal plane, the inclination the angle between the axes of body and cup in the frontal view.

    Parameters
    ----------
    arc_of_cover : float
        Angle from rim to rim in rad, 40° to 340°; π (default) is a hemisphere. The face of the rim is a cone towards
        the centre of the bore for any arc: a corner of 90°, where the pressure is finite. Other corners of a flat face
        are not modelled; above 90° the pressure is unbounded in linear elasticity.
    chamfer : float
        Width of the 45° chamfer of the rim's inner edge in mm, along the bore and in depth. Default 0.
    interface : Interface
        Interface between liner and backing. A sliding liner stays in contact with the backing everywhere.
    inclination : float
        Radiographic inclination in rad, 0 (default) to π/2: opening to the side.
    anteversion : float
        Radiographic anteversion in rad, -π/2 to π/2: opening to the front. Default 0. A hip simulation takes the
        tilt of its cycle's standard only if neither angle is set; an explicit 0 counts as set.
    side : Side
        Side of the body, RIGHT (default) or LEFT.

    Raises
    ------
    ValueError
        A number that is not allowed; the message has its value.
    TypeError
        An array; an interface or a side of another type.

    References
    ----------
    Murray 1993, The definition and measurement of acetabular orientation, J. Bone Joint Surg. Br. 75-B, 228-232, doi
    10.1302/0301-620X.75B2.8444942.

    Examples
    --------
    >>> from math import degrees, radians
    >>> cup = Cup(inclination=radians(45.0), anteversion=radians(15.0))
    >>> round(degrees(cup.tilt(UP)), 1)
    46.9
    """

    arc_of_cover: float = _UNSET_ARC
    chamfer: float = 0.0
    interface: Interface = Interface.BONDED
    inclination: float = _UNSET_ANGLE
    anteversion: float = _UNSET_ANGLE
    side: Side = Side.RIGHT

    def __post_init__(self) -> None:
        for name, quantity in CUP.items():
            if not is_plain_number(quantity.check(getattr(self, name))):
                raise TypeError(f"{name} must be one number, got {shown(getattr(self, name))}")
        for name, kind in (("interface", Interface), ("side", Side)):
            if not isinstance(getattr(self, name), kind):
                choices = " or ".join(map(str, kind))
                raise TypeError(f"{name} must be {choices}, got {shown(getattr(self, name))}")

    @classmethod
    def from_angles(
        cls,
        inclination: float,
        anteversion: float,
        *,
        definition: AngleDefinition | str = AngleDefinition.RADIOGRAPHIC,
        pelvic_tilt: float = 0.0,
        **attributes: Any,
    ) -> Self:
        """Create a cup with its radiographic angles in the body from angles of any definition, in a tilted pelvis.

        Parameters
        ----------
        inclination, anteversion : float
            Angles in rad relative to the pelvis; the ranges are those of the radiographic ones.
        definition : AngleDefinition or str
            "radiographic" (default), "operative" or "anatomical".
        pelvic_tilt : float
            Rotation of the pelvis in the body about the transverse axis in rad, -π/2 to π/2, positive if its top moves
            to the front. It reduces the operative anteversion by its own size.
        **attributes
            Further attributes of the cup.

        Raises
        ------
        ValueError
            An angle that is not allowed, or a cup that opens upwards.

        Examples
        --------
        >>> from math import degrees, radians
        >>> cup = Cup.from_angles(radians(43.0795), radians(20.7536), definition="operative")
        >>> round(degrees(cup.inclination), 3), round(degrees(cup.anteversion), 3)
        (45.0, 15.0)
        """
        chosen = _definition(definition)
        if not -pi / 2 <= pelvic_tilt <= pi / 2:
            raise ValueError(
                f"pelvic_tilt = {pelvic_tilt:g} is not allowed: a pelvic tilt (rad) is between -pi/2 and pi/2"
            )
        for name, angle in (("inclination", inclination), ("anteversion", anteversion)):
            CUP[name].check(angle)
        if chosen is AngleDefinition.RADIOGRAPHIC and pelvic_tilt == 0:
            return cls(inclination=inclination, anteversion=anteversion, **attributes)
        lateral, front, down = _opening_of(inclination, anteversion, chosen)
        forward, level = sin(pelvic_tilt), cos(pelvic_tilt)
        opening = (lateral, front * level - down * forward, down * level + front * forward)
        angles = _angles_of(opening, AngleDefinition.RADIOGRAPHIC)
        if angles[0] > pi / 2 + 1e-12:
            raise ValueError(
                f"the cup would open upwards: with a pelvic tilt of {degrees(pelvic_tilt):g}° its radiographic "
                f"inclination is {degrees(angles[0]):.4g}°; allowed are 0 to 90°"
            )
        return cls(inclination=min(angles[0], pi / 2), anteversion=angles[1], **attributes)

    def angles(self, definition: AngleDefinition | str = AngleDefinition.RADIOGRAPHIC) -> tuple[float, float]:
        """Return inclination and anteversion in rad in a definition: "radiographic", "operative" or "anatomical".

        Examples
        --------
        >>> from math import degrees, radians
        >>> cup = Cup(inclination=radians(45.0), anteversion=radians(15.0))
        >>> [round(degrees(angle), 4) for angle in cup.angles("operative")]
        [43.0795, 20.7536]
        >>> [round(degrees(angle), 4) for angle in cup.angles("anatomical")]
        [46.9205, 20.7536]
        """
        chosen = _definition(definition)
        if chosen is AngleDefinition.RADIOGRAPHIC:
            return float(self.inclination), float(self.anteversion)
        return _angles_of(self._axis, chosen)

    def __str__(self) -> str:
        angles = ("arc_of_cover", "inclination", "anteversion")
        texts = [f"{CUP[name].title} {degrees(getattr(self, name)):.4g}°" for name in angles]
        chamfer = [f"chamfer {self.chamfer:g} mm"] if self.chamfer else []
        return ", ".join([*texts, *chamfer, f"{self.interface.value} liner", f"{self.side.value} side"])

    @property
    def rim(self) -> float:
        """Polar angle of the rim in rad, half of the arc of cover."""
        return self.arc_of_cover / 2

    def around_ball(self, clearance: Array) -> Cup:
        """Return the cup with an arc of cover of 240° if none was set and the clearance (mm) is negative.

        A preloaded ball is held by a socket that reaches beyond its equator alone.
        """
        return self if self.has_stated_arc or float(clearance) >= 0 else replace(self, arc_of_cover=HOLDING_ARC)

    @property
    def has_stated_arc(self) -> bool:
        """True if the arc of cover was set, even to 180°."""
        return not isinstance(self.arc_of_cover, UnsetAngle)

    @property
    def oriented(self) -> bool:
        """True if inclination or anteversion was set, even to 0."""
        return not (isinstance(self.inclination, UnsetAngle) and isinstance(self.anteversion, UnsetAngle))

    @property
    def _axis(self) -> Direction:
        """Unit vector out of the opening: lateral, to the front, downwards."""
        return _opening_of(float(self.inclination), float(self.anteversion), AngleDefinition.RADIOGRAPHIC)

    @property
    def opening(self) -> Direction:
        """Unit vector along the axis of the cup, out of its opening, in the body frame."""
        lateral, front, down = self._axis
        return (lateral if self.side is Side.RIGHT else -lateral), front, -down

    @property
    def dome(self) -> Direction:
        """Unit vector along the axis of the cup, towards the pole of its bore, in the body frame."""
        x, y, z = self.opening
        return -x, -y, -z

    @property
    def frame(self) -> tuple[Direction, Direction, Direction]:
        """Unit vectors x, y, z of the cup frame, in the body frame.

        x points up in the plane of the rim, z to the dome. In an inclined cup, a vertical load lies between x and z.
        """
        return cup_axes(float(self.inclination), float(self.anteversion), self.side)

    def tilted(self, angle: float) -> Cup:
        """Return a copy of the cup, tilted by an angle in rad between its axis and a vertical load.

        The angle is at most π/2.
        """
        return replace(self, inclination=angle, anteversion=0.0)

    def under_load(self, tilt: float) -> tuple[Cup, Direction]:
        """Return an upright copy of the cup, and the direction of a load at an angle in rad from its axis, up to π."""
        return self.tilted(0.0), (sin(tilt), 0.0, cos(tilt))

    def load_tilt(self, *, tilt: float | None = None, direction: Array = UP) -> float:
        """Return the angle in rad between a load and the axis of the cup, from a tilt or a direction in the body."""
        return float(self.tilt(direction)) if tilt is None else float(tilt)

    def tilt(self, direction: Array) -> Array:
        """Compute the angle γ in rad between directions (..., 3) and the axis of the cup, from 0 (to the dome) to π.

        A direction, for example of the force on the cup, has any length.

        Raises ValueError: not three components, or a direction without a length.
        """
        vector = check_numeric("direction", direction)
        if tuple(getattr(vector, "shape", ()))[-1:] != (3,):
            raise ValueError(f"a direction has three components, x, y and z, got {direction!r:.60}")
        (x, y, z), (a, b, c) = (vector[..., axis] for axis in range(3)), self.dome
        along = a * x + b * y + c * z
        across = arrays.sqrt((b * z - c * y) ** 2 + (c * x - a * z) ** 2 + (a * y - b * x) ** 2)
        length = arrays.sqrt(along**2 + across**2)
        require("the length of direction", length, length > 0, "a direction points somewhere")
        angle = arrays.atan2(across, along)
        return float(angle) if is_plain_number(angle) else angle

    def edge_distance(self, radius: Array, half_angle: Array, direction: Array = UP) -> Array:
        """Compute the arc length in mm from the edge of a contact to the rim.

        It is the shortest arc, and negative where the rim cuts the contact: the contact-patch-to-rim distance
        R (β/2 - γ - ε). With ε = 0 it is the distance of the contact's centre.

        The radius R in mm is that of the sphere of the arc, for example of the socket; ε is the half angle of the
        contact in rad. Directions (..., 3) of the force on the cup have any length, and point upwards by default.
        """
        return (self.rim - self.tilt(direction) - half_angle) * radius


DEFAULT_CUP = Cup()
"""Hemisphere that opens downwards."""


def _definition(value: AngleDefinition | str) -> AngleDefinition:
    try:
        return AngleDefinition(value)
    except ValueError as error:
        words = ", ".join(choice.value for choice in AngleDefinition)
        raise ValueError(f"definition = {shown(value)} is not allowed: {words}") from error
