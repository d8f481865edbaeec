"""Computation of a study in blocks of points."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from itertools import chain
from math import ceil, prod
from typing import Any

import numpy

from ..contact import Contact, Model
from ..contact.verdict import Verdict, error_bar
from ..core.arrays import Numbers
from ..core.quantities import BEARING, CONTACT, PLASTIC, YIELD_LIMITS, Quantity
from ..core.quantities import QUANTITIES as CONTACT_QUANTITIES
from ..core.storage.pieces import check_worker_code, fingerprint
from ..core.validity import OutsideDomainError, Status
from ..problem import Joint
from .design import Design
from .parameters import press_arguments

QUANTITIES = (*CONTACT, *BEARING)
"""Quantities that a study can have; `status` and `valid` are in every study."""

EDGE_DISTANCE = "edge_distance"
"""Further quantity of models for loads off the axis."""

FURTHER = (EDGE_DISTANCE, *PLASTIC, *YIELD_LIMITS)
"""Quantities that only some models have."""

DEFAULT_QUANTITIES = ("indentation", "half_angle", "max_pressure", "area")
"""Quantities of a study by default, with the force unless it is the load."""

OUTCOMES = ("status", "valid", "broken_limit")
"""Variables of every study beside its quantities."""

STRESSES = tuple(BEARING)
"""Quantities that are estimated by most models, so that a study has their bounds too."""

VERDICT = "verdict"
"""Variable with the verdict on the yield stress, in every study of the utilisation."""

NO_VERDICT = -1
"""Verdict of a point without a result."""

BOUNDS: dict[str, Quantity] = {
    f"{name}_{end}": replace(
        CONTACT_QUANTITIES[name],
        name=f"{name}_{end}",
        title=f"{word} bound of the {CONTACT_QUANTITIES[name].title}",
    )
    for name in (*QUANTITIES, *FURTHER)
    for end, word in (("low", "lower"), ("high", "upper"))
}
"""Ends of the error bars of quantities, which a study can have by these names."""

DTYPES: dict[str, Any] = {
    **dict.fromkeys((*QUANTITIES, *FURTHER, *BOUNDS), numpy.float64),
    "status": numpy.int8,
    "valid": numpy.bool_,
    "broken_limit": numpy.int8,
    VERDICT: numpy.int8,
}
"""Types of the arrays of a study."""

_POINTS_PER_PRESS = 1 << 14  # points of one press, whose intermediate arrays stay in the processor's cache
_BLOCK_SECONDS = 0.5  # intended computing time of a block in s
_MAX_BLOCK_POINTS = 1 << 20  # number of points above which a block is not enlarged
_MAX_BLOCKS = 10_000  # number of blocks above which the blocks of a study are enlarged


@dataclass(frozen=True)
class Blocks:
    """Division of a box of points into smaller boxes of equal size, except the last one along each dimension."""

    shape: tuple[int, ...]  # number of points along each dimension of the box
    size: tuple[int, ...]  # number of points along each dimension of a block

    @classmethod
    def divide(cls, shape: tuple[int, ...], max_points: int) -> Blocks:
        """Divide a box into blocks of at most `max_points` points, complete along the last dimensions.

        A block has at least one point.
        """
        sizes = []
        remaining = max(1, max_points)
        for length in reversed(shape):
            size = max(1, min(length, remaining))
            sizes.append(ceil(length / ceil(length / size)) if length else 1)
            remaining //= size
        return cls(shape, tuple(reversed(sizes)))

    @property
    def counts(self) -> tuple[int, ...]:
        """Number of blocks along each dimension."""
        return tuple(ceil(length / size) for length, size in zip(self.shape, self.size, strict=True))

    def __len__(self) -> int:
        return prod(self.counts)

    def __getitem__(self, number: int) -> tuple[slice, ...]:
        """Return the box of a block: the range of its points along each dimension."""
        if not 0 <= number < len(self):
            raise IndexError(number)
        position = numpy.unravel_index(number, self.counts)
        return tuple(
            slice(int(index) * size, min((int(index) + 1) * size, length))
            for index, size, length in zip(position, self.size, self.shape, strict=True)
        )

    def n_points(self, number: int) -> int:
        """Return the number of points of a block."""
        return prod(section.stop - section.start for section in self[number])


def divide_study(shape: tuple[int, ...], n_points: int) -> Blocks:
    """Divide a study into blocks of about `n_points` points; into larger ones if there are more than 10 000 blocks.

    Larger blocks have 2, 4, 8 ... times as many points, at most a million. The blocks do not depend on the workers, so
    that a study resumes on other workers.
    """
    blocks = Blocks.divide(shape, n_points)
    while len(blocks) > _MAX_BLOCKS and n_points < _MAX_BLOCK_POINTS:
        n_points *= 2
        blocks = Blocks.divide(shape, n_points)
    return blocks


@dataclass(frozen=True, eq=False)
class Task:
    """Model, joint and points of a study; a call with the number of a block computes this block."""

    model: Model
    joint: Joint
    design: Design
    quantities: tuple[str, ...]
    blocks: Blocks
    code: str = field(default_factory=fingerprint)

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the computed arrays: the quantities, the outcomes, and the verdict on the utilisation."""
        return (*self.quantities, *OUTCOMES, *([VERDICT] if "utilisation" in self.quantities else ()))

    def __call__(self, number: int) -> dict[str, Numbers]:
        """Compute the variables of one block, each of the block's shape.

        Raises ValueError: this process has another version of the package than the process that started the study.
        """
        check_worker_code(self.code)
        box = self.blocks[number]
        shape = tuple(section.stop - section.start for section in box)
        results = {name: numpy.empty(shape, dtype=DTYPES[name]) for name in self.variables}
        presses = Blocks.divide(shape, min(_POINTS_PER_PRESS, points_per_block(self.model)))
        values = self.design.values_in(box)
        for press_number in range(len(presses)):
            section = presses[press_number]
            parts = {}
            for name, value in values.items():  # they broadcast: dimensions of length one stay complete
                axes = zip(section, value.shape, strict=True)
                parts[name] = value[tuple(part if length > 1 else slice(None) for part, length in axes)]
            computed = self._press(parts)
            for name, result in computed.items():
                results[name][section] = result
        return results

    def _press(self, values: Mapping[str, Numbers]) -> Mapping[str, Any]:
        joint, load, is_joint = press_arguments(self.joint, values)
        possible = numpy.asarray(is_joint)
        absent: dict[str, Any] = dict.fromkeys(self.quantities, numpy.nan)
        absent |= {"status": int(Status.NO_JOINT), "valid": False, "broken_limit": 0, VERDICT: NO_VERDICT}
        try:
            contact = self.model.press(joint, **load)
        except OutsideDomainError:
            absent["status"] = numpy.where(possible, int(Status.OUTSIDE_DOMAIN), int(Status.NO_JOINT))
            return {name: absent[name] for name in self.variables}
        results = {name: _read_variable(contact, name) for name in self.variables}
        if possible.all():
            return results
        return {name: numpy.where(possible, result, absent[name]) for name, result in results.items()}


def with_bounds(names: Iterable[str]) -> tuple[str, ...]:
    """Return names of quantities, each followed by the names of its bounds."""
    return tuple(chain.from_iterable((name, f"{name}_low", f"{name}_high") for name in names))


def quantity_of_bound(name: str) -> str:
    """Return the name of the quantity of a bound; another name is returned as it is."""
    return name.rpartition("_")[0] if name in BOUNDS else name


def _read_variable(contact: Contact, name: str) -> Any:
    """Read a variable of a study from a contact: a quantity, an end of its error bar, or the verdict on yielding."""
    if name == VERDICT:
        bar, limit = error_bar(contact, "utilisation"), contact.joint.liner.yield_stress
        verdict = bar.decide(high=1.0)
        is_checked = numpy.asarray(contact.valid) & (limit is not None and limit == limit)
        verdict = numpy.where(is_checked, verdict, numpy.maximum(verdict, int(Verdict.UNDECIDED)))
        return numpy.where(numpy.isnan(bar.value), NO_VERDICT, verdict)
    if name in BOUNDS:
        return getattr(error_bar(contact, quantity_of_bound(name)), name.rpartition("_")[2])
    return getattr(contact, name)


def points_per_block(model: Model) -> int:
    """Return the number of points of a block that takes about half a second."""
    return int(min(_MAX_BLOCK_POINTS, max(1.0, _BLOCK_SECONDS / model.seconds_a_press)))
