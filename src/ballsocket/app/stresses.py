"""Von Mises stresses in the liner, as pieces of the drawing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import isinf

import numpy

from ..contact import Contact
from ..files.joint_file import JointFile
from . import svg
from .drawing import DrawingFrame, heat

_ACROSS, _DEEP = 40, 10
_DEEPEST = 1.5  # contact radii that are drawn of what has no end
_BEYOND = 1.25  # half angles to each side


@dataclass(frozen=True, eq=False)
class Stresses:
    """Stresses in MPa at angles (rad, from the load's axis) and depths (mm): a row a depth."""

    angles: numpy.ndarray
    depths: numpy.ndarray
    values: numpy.ndarray

    @property
    def largest(self) -> float:
        """In MPa."""
        return float(self.values.max())


@lru_cache(maxsize=32)
def stresses(contact: Contact) -> Stresses | None:
    """The stresses of a contact; None where its model knows none inside the liner."""
    if not hasattr(contact, "stress") or not float(contact.half_angle) > 0:
        return None
    half, joint = float(contact.half_angle), contact.joint
    deep = float(joint.liner_thickness)
    if isinf(deep):
        deep = _DEEPEST * half * float(joint.socket_radius)
    angles = _BEYOND * half * (numpy.arange(_ACROSS) + 0.5) / _ACROSS
    depths = deep * (numpy.arange(_DEEP) + 0.5) / _DEEP
    values = numpy.asarray(contact.stress(angles[None, :], depths[:, None]).von_mises)
    return Stresses(angles, depths, values)


def painted_stresses(file: JointFile, found: Stresses, frame: DrawingFrame, tilt: float) -> str:
    """Each piece of the liner in the colour of its stress, inside the cup's arc."""
    wide, deep = found.angles[1] - found.angles[0], found.depths[1] - found.depths[0]
    bore, rim, top = float(file.joint.socket_radius), file.cup.rim, found.largest
    pieces = []
    for row, depth in enumerate(found.depths):
        near, far = bore + depth - 0.52 * deep, bore + depth + 0.52 * deep
        for side in (1, -1):
            for place, angle in enumerate(found.angles):
                ends = [side * (angle - 0.52 * wide) - tilt, side * (angle + 0.52 * wide) - tilt]
                low, high = max(min(ends), -rim), min(max(ends), rim)
                if low < high:
                    corners = [frame.at(r, a) for r, a in ((near, low), (near, high), (far, high), (far, low))]
                    x, y = map(numpy.array, zip(*corners, strict=True))
                    pieces.append(f'<path fill="{heat(found.values[row, place] / top)}" d="{svg.closed(x, y)}"/>')
    return "".join(pieces)
