"""What the joint's radii leave open: how far the socket reaches around the ball, what holds its liner, where it faces.

Directions are those of the patient's body: x to the right, y to the front, z upwards.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum
from math import cos, pi, sin

from ..core import arrays
from ..core.arrays import Array, is_plain
from ..core.checks import check_numeric, require, shown
from ..core.quantities import CUP

Direction = tuple[float, float, float]

UP: Direction = (0.0, 0.0, 1.0)
"""The direction of a vertical load on a cup: the ball presses it upwards."""


class Interface(Enum):
    """What the liner does on the layer behind it, or on the rigid socket: it is bonded, or slides without friction."""

    BONDED = "bonded"
    SLIDING = "sliding"


class Side(Enum):
    """The side of the body that a cup belongs to: on the left, x points to the middle."""

    RIGHT = "right"
    LEFT = "left"


class UnsetAngle(float):
    """Default angle of a cup without an orientation: 0, which the standard of a cycle may replace."""


_NOT_GIVEN = UnsetAngle(0.0)

_CHOICES = {"interface": Interface, "side": Side}


@dataclass(frozen=True, kw_only=True)
class Cup:
    """The socket seen from the side, and where it faces in the body.

    `Cup()` is a hemisphere that opens straight down: a vertical load presses it along its own axis, which is what every
    axisymmetric model takes for granted. Inclination and anteversion are the radiographic ones: the anteversion lies
    between the cup's axis and the frontal plane, the inclination between the body's axis and the cup's, seen from the
    front.

    Parameters
    ----------
    arc_of_cover : float
        From rim to rim in rad, 40° to 340°; π (default) is a hemisphere. The face of the rim is a cone towards the
        centre of the bore, whatever the arc: a corner of 90°, where the pressure stays finite. The sharper or blunter
        corner of a flat face is not modelled; one above 90° has an unbounded pressure in linear elasticity.
    chamfer : float
        Of the rim's inner edge in mm, at 45°: so much is taken away along the bore and into the depth. Default 0.
    interface : Interface
        Between liner and backing. A liner that slides stays in touch with it everywhere.
    inclination : float
        Radiographic inclination in rad, 0 (default) to π/2: how far the cup opens to the side.
    anteversion : float
        Radiographic anteversion in rad, -π/2 to π/2: opening to the front. Default 0. A hip in use takes the
        tilt of its cycle's standard only where neither angle is set; an explicit 0 counts as set.
    side : Side
        Of the body, RIGHT (default) or LEFT.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    TypeError
        An array, or an interface or a side that is none.

    References
    ----------
    The angles are those of Murray (1993), doi 10.1302/0301-620X.75B2.8444942.

    Examples
    --------
    >>> from math import degrees, radians
    >>> cup = Cup(inclination=radians(45.0), anteversion=radians(15.0))
    >>> round(degrees(cup.tilt(UP)), 1)
    46.9
    """

    arc_of_cover: float = pi
    chamfer: float = 0.0
    interface: Interface = Interface.BONDED
    inclination: float = _NOT_GIVEN
    anteversion: float = _NOT_GIVEN
    side: Side = Side.RIGHT

    def __post_init__(self) -> None:
        for name, quantity in CUP.items():
            if not is_plain(quantity.checked(getattr(self, name))):
                raise TypeError(f"{name} must be one number, got {shown(getattr(self, name))}")
        for name, kind in _CHOICES.items():
            if not isinstance(getattr(self, name), kind):
                known = " or ".join(map(str, kind))
                raise TypeError(f"{name} must be {known}, got {shown(getattr(self, name))}")

    @property
    def rim(self) -> float:
        """The rim's polar angle in rad."""
        return self.arc_of_cover / 2

    @property
    def oriented(self) -> bool:
        """True where an inclination or an anteversion was set, 0 included."""
        return not (isinstance(self.inclination, UnsetAngle) and isinstance(self.anteversion, UnsetAngle))

    @property
    def opening(self) -> Direction:
        """The unit vector along the cup's axis, out of its opening."""
        # (sin RI cos RA, sin RA, -cos RI cos RA), x being lateral
        lateral = sin(self.inclination) * cos(self.anteversion)
        down = cos(self.inclination) * cos(self.anteversion)
        return (lateral if self.side is Side.RIGHT else -lateral), sin(self.anteversion), -down

    @property
    def dome(self) -> Direction:
        """The unit vector along the cup's axis, to the pole of its bore."""
        x, y, z = self.opening
        return -x, -y, -z

    @property
    def frame(self) -> tuple[Direction, Direction, Direction]:
        """Unit vectors of the cup's own frame in the body's: x upwards along the rim's plane, y across, z to the dome.

        Turned so that an inclined cup feels a vertical load between x and z: it is tilted towards x.
        """
        level = cos(self.inclination)
        x, z = (level if self.side is Side.RIGHT else -level, 0.0, sin(self.inclination)), self.dome
        y = (z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0])
        return x, y, z

    def tilted(self, angle: float) -> Cup:
        """This cup turned so that a vertical load comes at this angle (rad, at most π/2) from its axis."""
        return replace(self, inclination=angle, anteversion=0.0)

    def tilt(self, direction: Array) -> Array:
        """The angle γ in rad between a direction and the dome's axis.

        Parameters
        ----------
        direction : array, (..., 3)
            Of the force on the cup, say; its length does not matter.

        Returns
        -------
        float or array
            From 0 (the load presses along the cup's own axis) to π.

        Raises
        ------
        ValueError
            Not three components, or a direction without a length.
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
        return float(angle) if is_plain(angle) else angle

    def edge_distance(self, radius: Array, half_angle: Array, direction: Array = UP) -> Array:
        """The arc in mm from the edge of a contact to the rim where that is nearest; below 0 the contact is cut off.

        R (β/2 - γ - ε), the contact-patch-to-rim distance; with ε = 0 it is that of the contact's centre.

        Parameters
        ----------
        radius : float or array
            Of the sphere that the arc lies on in mm: the socket's, say.
        half_angle : float or array
            ε of the contact in rad.
        direction : array, (..., 3)
            Of the force on the cup, upwards by default; of any length.
        """
        return (self.rim - self.tilt(direction) - half_angle) * radius
