"""How far a model trusts itself, for programs that cannot ask it."""

from __future__ import annotations

import numpy

from ..dynamics import ForceElement

_LOOKED = 129


def trusted_depth(element: ForceElement) -> float:
    """The deepest indentation in mm at which the model trusts itself; 0 where it never does.

    Small contacts, which every touch-down passes through, do not matter.
    """
    depths = numpy.geomspace(1e-3 * element.wall, element.wall, _LOOKED)
    valid = element.model.press(element.joint.with_floats(), indentation=depths).valid
    return float(max(depths[valid], default=0.0))
