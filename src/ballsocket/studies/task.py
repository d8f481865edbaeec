"""One block of a study: from its place among the axes to arrays of answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy

from ..contact import Model
from ..contact.describe import COLUMNS
from ..core.arrays import Numbers
from ..core.quantities import BEARING
from ..core.storage.fingerprint import check_worker_code, fingerprint
from ..core.validity import OutsideDomainError, Status
from ..problem import Joint
from .blocks import Blocks
from .design import Design
from .parameters import pressable

QUANTITIES = (*(column.attribute for column in COLUMNS), *BEARING)
"""What a study can answer; `status` and `valid` come with every study."""

EDGE_DISTANCE = "edge_distance"
"""What a study can answer besides, of a model that presses off the axis."""

USUAL = ("indentation", "half_angle", "max_pressure", "area")
"""What it answers unless told otherwise, with the force where that is not given."""

DTYPES: dict[str, Any] = {
    **dict.fromkeys((*QUANTITIES, EDGE_DISTANCE), numpy.float64),
    "status": numpy.int8,
    "valid": numpy.bool_,
}

_CACHED = 1 << 14  # points: a block's intermediate numbers stay in the processor's cache
_SECONDS, _MOST = 0.5, 1 << 20
"""A block takes about so long, and has at most so many points."""


@dataclass(frozen=True, eq=False)
class Task:
    """A model, a joint and the points at which it is pressed; called with a block's number it computes the block.

    `variables` are the quantities with `status` and `valid`.
    """

    model: Model
    joint: Joint
    design: Design
    quantities: tuple[str, ...]
    blocks: Blocks
    code: str = field(default_factory=fingerprint)

    @property
    def variables(self) -> tuple[str, ...]:
        return (*self.quantities, "status", "valid")

    def __call__(self, number: int) -> dict[str, Numbers]:
        """The variables of one block, each of the block's shape.

        Raises
        ------
        ValueError
            Another version of this package than that which asks.
        """
        check_worker_code(self.code)
        place = self.blocks[number]
        shape = tuple(part.stop - part.start for part in place)
        whole = {name: numpy.empty(shape, dtype=DTYPES[name]) for name in self.variables}
        inner = Blocks.of(shape, _CACHED)
        values = self.design.part(place)
        for each in range(len(inner)):
            here = inner[each]
            answers = self._answers({name: _at(value, here) for name, value in values.items()})
            for name, answer in answers.items():
                whole[name][here] = answer
        return whole

    def _answers(self, values: Mapping[str, Numbers]) -> Mapping[str, Any]:
        joint, load, made = pressable(self.joint, values)
        possible = numpy.asarray(made)
        try:
            contact = self.model.press(joint, **load)
        except OutsideDomainError:
            status = numpy.where(possible, int(Status.OUTSIDE_DOMAIN), int(Status.NO_JOINT))
            return {**dict.fromkeys(self.quantities, numpy.nan), "status": status, "valid": False}
        answers = {name: getattr(contact, name) for name in self.variables}
        if possible.all():
            return answers
        for name in self.quantities:
            answers[name] = numpy.where(possible, answers[name], numpy.nan)
        answers["status"] = numpy.where(possible, answers["status"], int(Status.NO_JOINT))
        answers["valid"] = answers["valid"] & possible
        return answers


def _at(value: Numbers, place: tuple[slice, ...]) -> Numbers:
    """Part of an array that broadcasts: whole along dimensions of one."""
    return value[tuple(part if length > 1 else slice(None) for part, length in zip(place, value.shape, strict=True))]


def points_a_block(model: Model) -> int:
    """So many that a block takes about half a second."""
    return int(min(_MOST, max(1.0, _SECONDS / model.seconds_a_press)))
