"""What the joint's radii leave open: how far the socket reaches around the ball, and what holds its liner."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import inf, pi, radians

from .arrays import is_plain
from .checks import numeric, require

LEAST, MOST = radians(40.0), radians(340.0)


class Interface(Enum):
    """What the liner does on the layer behind it, or on the rigid socket: it is bonded, or slides without friction."""

    BONDED = "bonded"
    SLIDING = "sliding"


@dataclass(frozen=True, kw_only=True)
class Cup:
    """The socket seen from the side.

    Parameters
    ----------
    arc_of_cover : float
        From rim to rim in rad, 40° to 340°; π (default) is a hemisphere.
    chamfer : float
        Of the rim's inner edge in mm, at 45°: so much is taken away along the bore and into the depth. Default 0.
    interface : Interface
        Between liner and backing. A liner that slides stays in touch with it everywhere.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    TypeError
        An array, or an interface that is none.
    """

    arc_of_cover: float = pi
    chamfer: float = 0.0
    interface: Interface = Interface.BONDED

    def __post_init__(self) -> None:
        for name in ("arc_of_cover", "chamfer"):
            if not is_plain(numeric(name, getattr(self, name))):
                raise TypeError(f"{name} must be one number, got {getattr(self, name)!r}")
        arc, chamfer = self.arc_of_cover, self.chamfer
        require("arc_of_cover", arc, LEAST <= arc <= MOST, "an arc of cover is 40 to 340 degrees")
        require("chamfer", chamfer, 0 <= chamfer < inf, "a chamfer (mm) is 0 or more and finite")
        if not isinstance(self.interface, Interface):
            raise TypeError(f"interface must be Interface.BONDED or Interface.SLIDING, got {self.interface!r}")

    @property
    def rim(self) -> float:
        """The rim's polar angle in rad."""
        return self.arc_of_cover / 2
