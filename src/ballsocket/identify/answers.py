"""What a model says of everything that was measured, at many numbers of the joint at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy

from ..arrays import Array, Numbers
from ..contact import Contact
from ..joint import Joint
from ..model import Model
from ..quantities import PARTS
from ..studies.parameters import varied
from ..validity import OutsideDomainError
from .measured import Measured

Columns = Mapping[str, Array]
"""Numbers by their names, each (points, 1)."""

_ROUNDS = 3  # of Newton's method for the force of a machine that gives way: its compliance is small


@dataclass(frozen=True, eq=False)
class Answers:
    """A model's answers in the order of the data, one set behind the other.

    Attributes
    ----------
    model, joint
        What is pressed; numbers that are not sought stay.
    data : tuple of Measured
    names : tuple of str
        Of the numbers that are sought.
    """

    model: Model
    joint: Joint
    data: tuple[Measured, ...]
    names: tuple[str, ...]
    _known: dict[str, float] = field(init=False)

    def __post_init__(self) -> None:
        known: dict[str, float] = {}
        for each in self.data:
            known |= each.machine.known()
        object.__setattr__(self, "_known", known)

    def at(self, values: Numbers, louder: float = 0.0) -> Numbers:
        """The answers (points, data) at numbers (points, unknowns); NaN where there is none.

        `louder` moves every load by that share of itself.
        """
        columns = {name: values[:, place : place + 1] for place, name in enumerate(self.names)}
        own = {name: column for name, column in columns.items() if "." not in name}
        joint, possible = varied(self.joint, own)
        machines = self._known | columns
        parts = self._pressed(joint, machines, 1 + louder)
        shape = (len(values), -1)
        rows = [numpy.broadcast_to(part, (len(values), part.shape[-1])).reshape(shape) for part in parts]
        return numpy.where(possible, numpy.concatenate(rows, axis=1), numpy.nan)

    def _pressed(self, joint: Joint, machines: Columns, factor: float) -> list[Numbers]:
        """A part for each set; sets whose loads are of one kind, and the same for all points, are pressed at once."""
        parts: dict[int, Numbers] = {}
        for kind in dict.fromkeys(each.load for each in self.data):
            sets = [place for place, each in enumerate(self.data) if each.load == kind]
            together = [place for place in sets if not _read_by_machine(self.data[place])]
            if not kind:
                parts |= {place: _of_joint(joint, self.data[place]) for place in sets}
                continue
            if together:
                parts |= self._together(joint, machines, kind, together, factor)
            for place in set(sets) - set(together):
                parts[place] = self._by_depth(joint, machines, self.data[place], factor)
        return [parts[place] for place in range(len(self.data))]

    def _together(
        self, joint: Joint, machines: Columns, kind: str, places: list[int], factor: float
    ) -> dict[int, Numbers]:
        loads = factor * numpy.concatenate([self.data[place].loads for place in places])
        contact, found, start = self._press(joint, kind, loads), {}, 0
        for place in places:
            each, where = self.data[place], slice(start, start + len(self.data[place]))
            start += len(each)
            found[place] = self._of_set(contact, len(loads), each, where, machines)
        return found

    def _of_set(self, contact: Contact | None, count: int, each: Measured, where: slice, machines: Columns) -> Numbers:
        if contact is None:
            return numpy.full((1, len(each)), numpy.nan)
        return _read(contact, count, each, where) + _added(each, machines, contact, where)

    def _by_depth(self, joint: Joint, machines: Columns, each: Measured, factor: float) -> Numbers:
        """Answers at indentations that a machine reads: its own share, and its zero, are taken off first."""
        compliance, offset = (machines[each.machine.key(part)] for part in ("compliance", "offset"))
        force: Array = each.values if each.quantity == "force" else 0.0 * each.values
        contact = self._press(joint, "indentation", numpy.maximum(factor * each.loads - offset, 0.0))
        for _ in range(_ROUNDS if numpy.any(compliance) else 0):
            depth = numpy.maximum(factor * each.loads - offset - compliance * force, 0.0)
            contact = self._press(joint, "indentation", depth)
            if contact is not None:
                stiffness = numpy.nan_to_num(contact.stiffness, posinf=0.0)
                force = force - (force - contact.force) / (1 + compliance * stiffness)
        return self._of_set(contact, len(each), each, slice(None), machines)

    def _press(self, joint: Joint, kind: str, load: Array) -> Contact | None:
        """None where the model has no answer for any of the points."""
        load_by_kind: dict[str, Any] = {kind: load}
        try:
            return self.model.press(joint, **load_by_kind)
        except OutsideDomainError:
            return None


def _read_by_machine(each: Measured) -> bool:
    return each.load == "indentation" and bool(each.machine.name)


def _read(contact: Contact, count: int, each: Measured, where: slice) -> Numbers:
    """What a set asks of its contacts, which are some of `count`."""
    if each.quantity != "pressure":
        return _rows(getattr(contact, each.quantity))[:, where]
    angle = numpy.zeros(count)
    angle[where] = each.angle
    return _rows(contact.pressure(angle))[:, where]


def _rows(found: Array) -> Numbers:
    return numpy.atleast_2d(numpy.asarray(found, dtype=float))


def _added(each: Measured, machines: Columns, contact: Contact, where: slice) -> Array:
    """What the machine adds to an indentation."""
    if each.quantity != "indentation" or not each.machine.name:
        return 0.0
    compliance, offset = (machines[each.machine.key(part)] for part in ("compliance", "offset"))
    return compliance * _rows(contact.force)[:, where] + offset


def _of_joint(joint: Joint, each: Measured) -> Numbers:
    if each.quantity in PARTS:
        part, _, number = each.quantity.partition("_")
        value = getattr(getattr(joint, part), number)
    else:
        value = getattr(joint, each.quantity)
    return numpy.broadcast_to(numpy.reshape(value, (-1, 1)), (numpy.size(value), len(each)))
