"""What a model says of everything that was measured, at many numbers of the joint at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from typing import Any

import numpy

from ..contact import Contact, Model
from ..core import arrays
from ..core.arrays import Array
from ..core.quantities import PARTS
from ..core.validity import OutsideDomainError
from ..problem import Joint
from ..studies.parameters import varied
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

    def at(self, values: Array, louder: float = 0.0) -> Array:
        """The answers (points, data) at numbers (points, unknowns) of any array library; NaN where there is none.

        `louder` moves every load by that share of itself.
        """
        columns = {name: values[:, place : place + 1] for place, name in enumerate(self.names)}
        own = {name: column for name, column in columns.items() if "." not in name}
        joint, possible = varied(self.joint, own)
        machines = self._known | columns
        parts = self._pressed(joint, machines, 1 + louder)
        xp = arrays.namespace(values)
        rows = [xp.broadcast_to(xp.asarray(part), (len(values), part.shape[-1])) for part in parts]
        return arrays.where(possible, xp.concat(rows, axis=1), float("nan"))

    def _pressed(self, joint: Joint, machines: Columns, factor: float) -> list[Array]:
        """A part for each set; sets whose loads are of one kind, and the same for all points, are pressed at once."""
        parts: dict[int, Array] = {}
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
    ) -> dict[int, Array]:
        loads = factor * numpy.concatenate([self.data[place].loads for place in places])
        contact, found, start = self._press(joint, kind, loads), {}, 0
        for place in places:
            each, where = self.data[place], slice(start, start + len(self.data[place]))
            start += len(each)
            found[place] = self._of_set(contact, len(loads), each, where, machines)
        return found

    def _of_set(self, contact: Contact | None, count: int, each: Measured, where: slice, machines: Columns) -> Array:
        if contact is None:
            return numpy.full((1, len(each)), numpy.nan)
        return _read(contact, count, each, where) + _added(each, machines, contact, where)

    def _by_depth(self, joint: Joint, machines: Columns, each: Measured, factor: float) -> Array:
        """Compute results at measured indentations, corrected for compliance and zero of the machine."""
        compliance, zero = _of_machine(each, machines)
        force: Array = each.values if each.quantity == "force" else 0.0 * each.values
        contact = self._press(joint, "indentation", _depth(factor * each.loads - zero))
        for _ in range(_ROUNDS if each.machine.compliance else 0):
            depth = _depth(factor * each.loads - zero - compliance * force)
            contact = self._press(joint, "indentation", depth)
            if contact is not None:
                stiffness = arrays.where(arrays.isfinite(contact.stiffness), contact.stiffness, 0.0)
                force = force - (force - contact.force) / (1 + compliance * stiffness)
        return self._of_set(contact, len(each), each, slice(None), machines)

    def _press(self, joint: Joint, kind: str, load: Array) -> Contact | None:
        """None where the model has no answer for any of the points."""
        load_by_kind: dict[str, Any] = {kind: arrays.namespace(*joint.numbers()).asarray(load)}
        try:
            return self.model.press(joint, **load_by_kind)
        except OutsideDomainError:
            return None


def _read_by_machine(each: Measured) -> bool:
    return each.load == "indentation" and bool(each.machine.name)


def _depth(read: Array) -> Array:
    return arrays.clip(read, 0.0, inf)


def _read(contact: Contact, count: int, each: Measured, where: slice) -> Array:
    """What a set asks of its contacts, which are some of `count`."""
    if each.own is not None:
        return _rows(each.own.read(contact))[:, where]
    if each.quantity != "pressure":
        return _rows(getattr(contact, each.quantity))[:, where]
    angle = numpy.zeros(count)
    angle[where] = each.angle
    return _rows(contact.pressure(arrays.namespace(contact.force).asarray(angle)))[:, where]


def _rows(found: Array) -> Array:
    return found[None, :] if len(found.shape) == 1 else found


def _added(each: Measured, machines: Columns, contact: Contact, where: slice) -> Array:
    """Compute the addition of the machine to an indentation."""
    if each.quantity != "indentation" or not each.machine.name:
        return 0.0
    compliance, zero = _of_machine(each, machines)
    return compliance * _rows(contact.force)[:, where] + zero


def _of_machine(each: Measured, machines: Columns) -> tuple[Array, Array]:
    """Return the compliance of the machine, and its zero at each reading."""
    compliance, offset, drift = (machines[each.machine.key(part)] for part in ("compliance", "offset", "drift"))
    return compliance, offset + drift * each.order


def _of_joint(joint: Joint, each: Measured) -> Array:
    if each.quantity in PARTS:
        part, _, number = each.quantity.partition("_")
        value = getattr(getattr(joint, part), number)
    else:
        value = getattr(joint, each.quantity)
    if arrays.is_plain(value):
        return numpy.full((1, len(each)), value)
    return value + numpy.zeros(len(each))
