"""What every drawing of a joint in section keeps to: the radii that are drawn, and how wide the clearance is."""

from __future__ import annotations

from itertools import accumulate
from math import isinf

from ..problem import Joint

_MASSIVE = 0.8  # of the socket's radius is drawn of what has no end
_ROUND = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
_WIDEST_GAP = 0.09  # of the socket's radius, beside the ball


def radii_of(joint: Joint) -> list[float]:
    """Radii in mm of the bore, and from there outwards behind the liner and each layer."""
    bore = float(joint.socket_radius)
    thick = (float(each) for each in (joint.liner_thickness, *(layer.thickness for layer in joint.backing)))
    return list(accumulate((_MASSIVE * bore if isinf(each) else each for each in thick), initial=bore))


def gap_factor(joint: Joint) -> int:
    """How many times the gap between ball and socket is drawn: a round number, so that it can be seen."""
    gap = abs(float(joint.clearance))
    fitting = [times for times in _ROUND if times * gap <= _WIDEST_GAP * float(joint.socket_radius)]
    return fitting[-1] if fitting and gap > 0 else 1
