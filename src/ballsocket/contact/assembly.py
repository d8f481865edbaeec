"""Checked inputs of a press, and the contact assembled from the result of a solver."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import zip_longest
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy

from ..core import arrays
from ..core.arrays import Array, where
from ..core.checks import normalise_name, select_load, shown
from ..core.quantities import LOADS
from ..core.validity import Status, is_missing
from ..problem import Joint, make_unchecked
from ..problem.presets import joints
from .contact import Contact, Laws, PressModel


class SolverResult(NamedTuple):
    """Result of a solver, before the status of its points is determined."""

    laws: Laws  # formulas or solution of the other quantities
    # in N and mm; not finite where the load is not reached
    force: Array
    indentation: Array
    # mask of the points with each failure. A point that is not finite needs no mask.
    failures: Mapping[Status, Array] = MappingProxyType({})


def check_joint(joint: Any) -> None:
    """Raise TypeError unless `joint` is a Joint; the message suggests the preset with such a name."""
    if isinstance(joint, Joint):
        return
    is_preset = isinstance(joint, str) and normalise_name(joint) in joints
    hint = f"; use bs.joints[{normalise_name(joint)!r}]" if is_preset else ""
    raise TypeError(f"joint must be a Joint, got {shown(joint)}{hint}")


def select_and_check_load(**loads: Array | None) -> tuple[str, Array]:
    """Select the only load that is not None, check its values, and return its name and value."""
    kind, load = select_load(**loads)
    return kind, LOADS[kind].check(load)


def broadcast_load(load: Array, strengths: tuple[Array, ...]) -> Array:
    """Broadcast a load to the common shape with the strengths of the materials, for a comparison point by point."""
    if all(map(arrays.is_plain_number, strengths)):
        return load
    return arrays.broadcast(*arrays.to_common_arrays(load, *strengths))


def as_arrays(joint: Joint, load: Array, *parameters: Array) -> tuple[bool, Joint, Array]:
    """Convert the numbers of a joint and a load to arrays of one library and data type.

    The result is true if all numbers are plain, the joint, and the load. The `parameters` of a model count for the
    choice of the library; they are not returned.

    Raises ValueError: arrays whose shapes do not broadcast.
    """
    numbers = (*joint.numbers(), load)
    all_plain = all(arrays.is_plain_number(number) for number in (*numbers, *parameters))
    common = arrays.to_common_arrays(*numbers, *parameters)
    shapes = {tuple(getattr(number, "shape", ())) for number in common}
    if len(shapes) > 1:
        lengths = zip_longest(*(shape[::-1] for shape in shapes), fillvalue=1)
        if any(len({*axis} - {1}) > 1 for axis in lengths):
            listed = ", ".join(map(str, sorted(shapes - {()})))
            reason = "do not broadcast: an axis has one length in all, or 1"
            raise ValueError(f"the shapes {listed} of joint, load and direction {reason}")
    joint_numbers = common[: len(numbers)]
    return all_plain, joint.with_numbers(joint_numbers[:-1]), joint_numbers[-1]


_BY_SEVERITY = (
    Status.BEYOND_EQUATOR,
    Status.AT_RIM,
    Status.NOT_ROUND,
    Status.NOT_CONVERGED,
    Status.NOT_REACHED,
    Status.DISLOCATED,
    Status.OUTSIDE_DOMAIN,
)
"""Failures in ascending order of severity; a point with several failures gets the last of them."""


def make_contact(
    model: PressModel,
    contact_type: type[Contact],
    joint: Joint,
    kind: str,
    load: Array,
    points: Array,
    result: SolverResult,
    plain: bool,
) -> Contact:
    """Build a `Contact` of arrays from a solver's result: determine the status, and set failed points to NaN.

    `kind` is "force", "indentation" or "half_angle". The mask `points` is true inside the domain of the model. If
    `plain`, the contact consists of Python numbers.
    """
    xp = arrays.namespace(load)
    operands = (load, result.force, result.indentation, *joint.numbers())
    F = arrays.broadcast(load if kind == "force" else result.force, *operands)
    d = arrays.broadcast(load if kind == "indentation" else result.indentation, *operands)
    reachable = arrays.isfinite(result.force) & arrays.isfinite(result.indentation)
    failures = {**result.failures, Status.NOT_REACHED: ~reachable, Status.OUTSIDE_DOMAIN: ~points}
    status = xp.zeros_like(xp.astype(F > 0, xp.int8))
    for code in _BY_SEVERITY:
        if code in failures and not arrays.all_true(arrays.logical_not(failures[code])):
            status = where(failures[code], xp.asarray(int(code), dtype=xp.int8), status)
    solved = ~is_missing(status)
    if not (F.shape and arrays.all_true(solved)):
        F = F if kind == "force" else where(solved, F, xp.nan)
        d = d if kind == "indentation" else where(solved, d, xp.nan)
    if plain:
        F, d, status = float(F), float(d), Status(int(status))
    else:
        F, d, status = map(arrays.read_only, (F, d, status))
    return contact_type(model=model, laws=result.laws, joint=joint, force=F, indentation=d, status=status)


def make_scalar_contact(
    model: PressModel, contact_type: type[Contact], joint: Joint, kind: str, load: float, result: SolverResult
) -> Contact:
    """Build a `Contact` of Python numbers from a solver's result; set the numbers of a failed result to NaN.

    The joint is inside the domain of the model. See `make_contact`.
    """
    F, d = result.force, result.indentation
    failures = [code for code, is_failure in result.failures.items() if is_failure]
    if not (math.isfinite(F) and math.isfinite(d)):
        failures.append(Status.NOT_REACHED)
    status = max(failures, key=_BY_SEVERITY.index) if failures else Status.OK
    if status.failed:
        F, d = numpy.nan, numpy.nan
    F, d = load if kind == "force" else F, load if kind == "indentation" else d
    return make_unchecked(
        contact_type, model=model, laws=result.laws, joint=joint, force=F, indentation=d, status=status
    )
