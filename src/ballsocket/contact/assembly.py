"""What comes into a press and what it hands back: loads checked, joints made arrays, failures made a status."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy

from ..core import arrays
from ..core.arrays import Array, where
from ..core.checks import normalise_name, select_load, shown
from ..core.quantities import LOADS
from ..core.validity import Status, is_missing
from ..problem import Joint
from ..problem.presets import joints
from .contact import Contact, Laws, Pressed


@dataclass(frozen=True, kw_only=True, eq=False)
class SolverResult:
    """What a solver hands back: force and indentation, where the further quantities come from, and what went wrong.

    `failures` are masks by the status that they mean; a point without force or indentation needs none.
    """

    laws: Laws
    force: Array
    indentation: Array
    failures: Mapping[Status, Array] = field(default_factory=dict)


class Asked(Pressed, Protocol):
    """What an answer needs to know of the model that was asked."""

    @property
    def contact_type(self) -> type[Contact]: ...


def check_joint(joint: Any) -> None:
    """Raise TypeError for what is no joint, the name of a preset among them."""
    if isinstance(joint, Joint):
        return
    preset = isinstance(joint, str) and normalise_name(joint) in joints
    hint = f"; bs.joints[{normalise_name(joint)!r}] is one" if preset else ""
    raise TypeError(f"joint must be a Joint, got {shown(joint)}{hint}")


def check_load(**loads: Array | None) -> tuple[str, Array]:
    """The one load that was given, checked, with its name."""
    kind, given = select_load(**loads)
    return kind, LOADS[kind].checked(given)


def broadcast_load(load: Array, strengths: tuple[Array, ...]) -> Array:
    """The load in the shape that it and the strengths broadcast to, so that contacts can be told how near they are."""
    if all(map(arrays.is_plain, strengths)):
        return load
    return arrays.broadcast(*arrays.to_common_arrays(load, *strengths))


def as_arrays(joint: Joint, load: Array, *parameters: Array) -> tuple[bool, Joint, Array]:
    """Whether only plain numbers came in, and joint and load as arrays of one library and dtype.

    A model's own `parameters` count for the library; they stay where they are.
    """
    numbers = (*joint.numbers(), load)
    plain = all(arrays.is_plain(number) for number in (*numbers, *parameters))
    joint_numbers = arrays.to_common_arrays(*numbers, *parameters)[: len(numbers)]
    return plain, joint.with_numbers(joint_numbers[:-1]), joint_numbers[-1]


_GRAVER = (
    Status.BEYOND_EQUATOR,
    Status.AT_RIM,
    Status.NOT_ROUND,
    Status.NOT_CONVERGED,
    Status.NOT_REACHED,
    Status.DISLOCATED,
    Status.OUTSIDE_DOMAIN,
)
"""Where a point has several failures it is told the last of these."""


def make_contact(
    model: Asked, joint: Joint, kind: str, load: Array, points: Array, answer: SolverResult, plain: bool
) -> Contact:
    """The contact with its status: NaN where there is no answer."""
    xp = arrays.namespace(load)
    shape = (load, answer.force, answer.indentation, *joint.numbers())
    F = arrays.broadcast(load if kind == "force" else answer.force, *shape)
    d = arrays.broadcast(load if kind == "indentation" else answer.indentation, *shape)
    found = arrays.isfinite(answer.force) & arrays.isfinite(answer.indentation)
    failures = {**answer.failures, Status.NOT_REACHED: ~found, Status.OUTSIDE_DOMAIN: ~points}
    status = xp.zeros_like(xp.astype(F > 0, xp.int8))
    for code in _GRAVER:
        if code in failures:
            status = where(failures[code], xp.asarray(int(code), dtype=xp.int8), status)
    answered = ~is_missing(status)
    F, d = where(answered | (kind == "force"), F, xp.nan), where(answered | (kind == "indentation"), d, xp.nan)
    if plain:
        F, d, status = float(F), float(d), Status(int(status))
    return model.contact_type(model=model, laws=answer.laws, joint=joint, force=F, indentation=d, status=status)


def make_scalar_contact(model: Asked, joint: Joint, kind: str, load: float, answer: SolverResult) -> Contact:
    """`finished` of Python numbers, inside the domain."""
    F, d, status = answer.force, answer.indentation, Status.OK
    failures = {**answer.failures, Status.NOT_REACHED: not (arrays.isfinite(F) and arrays.isfinite(d))}
    for code in _GRAVER:
        if failures.get(code):
            status = code
    if status.failed:
        F, d = numpy.nan, numpy.nan
    if kind != "half_angle":
        F, d = (load, d) if kind == "force" else (F, load)
    return model.contact_type(model=model, laws=answer.laws, joint=joint, force=F, indentation=d, status=status)
