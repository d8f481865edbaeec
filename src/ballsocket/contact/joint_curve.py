"""Curve of one joint: its contact quantities over a load, through some hundred presses.

It serves many loads on one joint, force laws and force elements.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

import numpy

from ..core.arrays import Numbers, is_plain_number
from ..core.lazy import cached_property
from ..core.validity import is_missing
from ..problem import Joint
from .assembly import SolverResult, as_arrays
from .coordinates import LIMIT
from .octave_curve import OctaveCurve, fit_octave_curve

MANY_LOADS = 200  # number of loads on one joint from which they are read from its curve
MAX_ERROR = 1e-9  # largest relative error of a quantity that is read from a curve
_END_TOLERANCE = 1e-6  # relative tolerance of the deepest indentation that has a load

QUANTITIES = {
    "force": ("indentation", "half_angle", "max_pressure", "stiffness"),
    "indentation": ("force", "half_angle", "max_pressure", "stiffness"),
}
"""Quantities of a curve by its load."""


class NoCurveError(TypeError):
    """A joint has no curve of its contacts over a load."""


@lru_cache(maxsize=256)
def joint_curve(model: Any, joint: Joint, kind: str) -> OctaveCurve:
    """Return the curve of a joint of floats over the indentation or the force, from a cache.

    It begins at an indentation of a millionth of the clearance, and ends where the loads end or at an indentation of
    one socket radius.

    Raises NoCurveError: no range of loads with a result.
    """
    low = 1e-6 * (joint.clearance or joint.socket_radius)
    ends = numpy.array([low, _deepest_indentation(model, joint, low)])
    if kind == "force":
        ends = _press(model, joint, "indentation", ends)[0]
    if not 0.0 < ends[0] < ends[1] < math.inf:
        raise NoCurveError(f"no curve: no load from an indentation of {low:.3g} mm on has a result")
    return fit_octave_curve(lambda loads: _press(model, joint, kind, loads), *ends.tolist())


def _press(model: Any, joint: Joint, kind: str, loads: Numbers) -> Numbers:
    """Solve the contacts of a joint: the quantities of its curve (quantities, n), NaN without a result."""
    _, array_joint, load = as_arrays(joint, loads)
    with numpy.errstate(all="ignore"):
        result = model._solve_curve_points(array_joint, kind, load)
        rows = [getattr(result, QUANTITIES[kind][0]), *(getattr(result.laws, name) for name in QUANTITIES[kind][1:])]
        values = numpy.stack([numpy.broadcast_to(row, load.shape) for row in rows])
        for status, mask in result.failures.items():
            values = numpy.where(mask & is_missing(status), numpy.nan, values)
    return values


def _deepest_indentation(model: Any, joint: Joint, low: float) -> float:
    """Find the indentation in mm up to which there are forces, less 1e-6 of it; at most the socket radius."""

    def is_solved(depths: Numbers) -> Numbers:
        return numpy.isfinite(_press(model, joint, "indentation", depths)[0])

    high = joint.socket_radius
    _, array_joint, widest = as_arrays(joint, numpy.array([LIMIT]))
    with numpy.errstate(all="ignore"):
        widest_indentation = float(model._solve_curve_points(array_joint, "half_angle", widest).indentation[0])
    below_end = (1 - _END_TOLERANCE) * widest_indentation
    at_end = is_solved(numpy.array([high, below_end, (1 + _END_TOLERANCE) * widest_indentation])).tolist()
    if at_end[0]:
        return high
    if at_end == [False, True, False]:
        return below_end
    while high / low > 1 + _END_TOLERANCE:
        depths = numpy.geomspace(low, high, 17)
        index = max(int(numpy.argmin(is_solved(depths))), 1)
        low, high = float(depths[index - 1]), float(depths[index])
    return low * (1 - _END_TOLERANCE)


@dataclass(frozen=True, kw_only=True, eq=False)
class CurveSolution:
    """Contacts that are read from the curve of their joint.

    Quantities that the curve lacks are solved when they are read.

    Attributes
    ----------
    solve : function
        Solver of the contacts.
    interpolation_error : float
        Largest relative error of the curve.
    """

    solve: Callable[[], SolverResult]
    interpolation_error: float

    @cached_property
    def solved(self) -> Any:
        """Solved contacts, with all quantities."""
        with numpy.errstate(all="ignore"):
            return self.solve().laws

    @property
    def error(self) -> dict[str, Numbers]:
        """Estimated relative errors of a model that estimates them, with that of the curve."""
        return {name: error + self.interpolation_error for name, error in self.solved.error.items()}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # a copy looks for its methods before it has attributes
            raise AttributeError(name)
        return getattr(self.solved, name)


def solve_by_curve(
    model: Any,
    joint: Joint,
    kind: str,
    load: Any,
    evaluate: Callable[[OctaveCurve, Numbers], Numbers] = OctaveCurve.__call__,
) -> SolverResult | None:
    """Read the contacts of many loads on one joint from its curve; None if they must be solved.

    They must be solved for few loads, for arrays of joints, for loads outside the curve, and if its error is too large.
    """
    is_suitable = (
        kind in QUANTITIES
        and type(load) is numpy.ndarray
        and load.dtype == numpy.float64
        and load.size >= MANY_LOADS
        and all(map(is_plain_number, (*joint.numbers(), *model.parameters)))
    )
    if not is_suitable:
        return None
    try:
        curve = joint_curve(model, joint.without_strengths().with_floats(), kind)
    except NoCurveError:
        return None
    accurate = numpy.flatnonzero(curve.error <= MAX_ERROR).tolist()
    loads = numpy.ascontiguousarray(load).reshape(-1)
    has_zeros = loads.min() == 0.0
    lowest = loads[loads > 0.0].min(initial=curve.high) if has_zeros else loads.min()
    if 0 not in accurate or lowest < curve.low or loads.max() > curve.high:
        return None
    curve = curve.select(accurate)
    values = evaluate(curve, numpy.maximum(loads, curve.low) if has_zeros else loads)
    if has_zeros:
        values[:, loads == 0.0] = 0.0
    names = [QUANTITIES[kind][index] for index in accurate]
    by_name = dict(zip(names, values.reshape(len(values), *load.shape), strict=True)) | {kind: load}
    solution = CurveSolution(
        solve=partial(model._solve, as_arrays(joint, load)[1], kind, load), interpolation_error=float(curve.error.max())
    )
    vars(solution).update(by_name)
    return SolverResult(laws=solution, force=by_name["force"], indentation=by_name["indentation"])
