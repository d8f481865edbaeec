"""Largest valid indentation of a model, for programs that cannot evaluate its validity."""

from __future__ import annotations

import numpy

from ..dynamics import ForceElement

_DEPTHS = 129
"""Number of indentations at which validity is evaluated."""


def valid_depth(element: ForceElement) -> float:
    """Find the largest indentation in mm at which the contact model is valid; 0 if no indentation is valid.

    Lower limits of the contact size are ignored: every contact passes through them at first touch.
    """
    depths = numpy.geomspace(1e-3 * element.wall, element.wall, _DEPTHS)
    valid = element.model.press(element.joint.with_floats(), indentation=depths).valid
    return float(max(depths[valid], default=0.0))
