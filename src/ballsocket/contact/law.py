"""Force and tangent stiffness of one joint as a function of the indentation, for time integration."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from .octave_curve import OctaveCurve, derivatives_at


class ForceLaw(Protocol):
    """Interface of the function `model.law(joint)`: force and stiffness from the indentation.

    Parameters
    ----------
    indentation : float
        Approach of the centres from first touch in mm; below 0 there is no contact.

    Returns
    -------
    float, float
        Axial load in N and tangent stiffness in N/mm; both NaN where the model has no result.
    """

    def __call__(self, indentation: float) -> tuple[float, float]: ...


@dataclass(frozen=True, kw_only=True, eq=False)
class CurveLaw:
    """Force law of one joint by the curve of its force over the indentation; the stiffness is the slope of the force.

    Attributes
    ----------
    curve : OctaveCurve
        Force in N over the indentation in mm.
    """

    curve: OctaveCurve

    def __call__(self, indentation: float) -> tuple[float, float]:
        return derivatives_at(indentation, *self.curve.plain_numbers)[:2]


def finite_or_nan(force: float, stiffness: float) -> tuple[float, float]:
    """Return force in N and stiffness in N/mm; NaN for both if one of them is not finite."""
    return (force, stiffness) if math.isfinite(force + stiffness) else (math.nan, math.nan)
