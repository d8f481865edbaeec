"""Forward model of an identification: results for all data at many values of the unknowns at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf

import numpy

from ..contact import Contact, Model
from ..core import arrays
from ..core.arrays import Array
from ..core.quantities import PARTS
from ..core.validity import OutsideDomainError
from ..problem import Joint
from ..studies.parameters import vary_joint
from .measured import Measured
from .registry import JOINT_NUMBERS, MACHINE_ERRORS, MODEL_NUMBERS

Columns = Mapping[str, Array]
"""Numbers by name, each of shape (points, 1)."""

_NEWTON_ITERATIONS = 3  # for the force of a compliant machine; its compliance is small


def split_numbers(values: Mapping[str, Array]) -> tuple[dict[str, Array], dict[str, Array]]:
    """Split values of unknowns into those of the joint and those of the model, by name.

    Errors of a machine are in neither.
    """
    joint = {name: value for name, value in values.items() if name in JOINT_NUMBERS}
    return joint, {name: value for name, value in values.items() if name in MODEL_NUMBERS}


def insert_numbers(model: Model, values: Mapping[str, Array]) -> Model:
    """Return a copy of the model with new values of its numbers, by name."""
    for name, value in values.items():
        model = MODEL_NUMBERS[name].insert_into(model, value)
    return model


@dataclass(frozen=True, eq=False)
class ForwardModel:
    """Forward model of an identification: results for all data from values of the unknowns.

    The results are in the order of the data sets.

    Attributes
    ----------
    model : Model
    joint : Joint
        Joint with the numbers that are not unknown.
    data : tuple of Measured
    names : tuple of str
        Names of the unknowns.
    """

    model: Model
    joint: Joint
    data: tuple[Measured, ...]
    names: tuple[str, ...]
    _known_errors: dict[str, float] = field(init=False)

    def __post_init__(self) -> None:
        known: dict[str, float] = {}
        for measured in self.data:
            known |= measured.machine.known_errors()
        object.__setattr__(self, "_known_errors", known)

    def results_at(self, values: Array, load_perturbation: float = 0.0) -> Array:
        """Compute the model results (points, data) from values of the unknowns (points, unknowns).

        A result is NaN where the model has none.

        Values may be of any array library. `load_perturbation` is a relative change of every load.
        """
        columns = {name: values[:, index : index + 1] for index, name in enumerate(self.names)}
        of_joint, of_model = split_numbers(columns)
        joint, possible = vary_joint(self.joint, of_joint)
        pressed = _PressedPoints(insert_numbers(self.model, of_model), joint, self._known_errors | columns)
        rows = self._compute_rows(pressed, 1 + load_perturbation)
        xp = arrays.namespace(values)
        rows = [xp.broadcast_to(xp.asarray(row), (len(values), row.shape[-1])) for row in rows]
        return arrays.where(possible, xp.concat(rows, axis=1), float("nan"))

    def _compute_rows(self, pressed: _PressedPoints, factor: float) -> list[Array]:
        """Compute the results of each data set.

        Data sets with the same kind of load share one press.
        """
        rows: dict[int, Array] = {}
        for kind in dict.fromkeys(measured.load for measured in self.data):
            indices = [index for index, measured in enumerate(self.data) if measured.load == kind]
            shared = [index for index in indices if not _is_load_read_by_machine(self.data[index])]
            if not kind:
                rows |= {index: _read_joint_number(pressed.joint, self.data[index]) for index in indices}
                continue
            if shared:
                rows |= self._compute_rows_of_one_press(pressed, kind, shared, factor)
            for index in set(indices) - set(shared):
                rows[index] = pressed.compute_at_read_indentation(self.data[index], factor)
        return [rows[index] for index in range(len(self.data))]

    def _compute_rows_of_one_press(
        self, pressed: _PressedPoints, kind: str, indices: list[int], factor: float
    ) -> dict[int, Array]:
        """Compute the results of data sets with the same kind of load by one press."""
        loads = factor * numpy.concatenate([self.data[index].loads for index in indices])
        contact, rows, start = pressed.press(kind, loads), {}, 0
        for index in indices:
            measured = self.data[index]
            span = slice(start, start + len(measured))
            start += len(measured)
            rows[index] = pressed.compute_readings(contact, len(loads), measured, span)
        return rows


@dataclass(frozen=True, eq=False)
class _PressedPoints:
    """Joints, model, errors of machines and numbers of observables at many values of the unknowns."""

    model: Model
    joint: Joint
    numbers: Columns

    def press(self, kind: str, load: Array) -> Contact | None:
        """Compute the contacts under one kind of load; None if no point has a result."""
        load_by_kind = {kind: arrays.namespace(*self.joint.numbers()).asarray(load)}
        try:
            return self.model.press(self.joint, **load_by_kind)
        except OutsideDomainError:
            return None

    def compute_readings(self, contact: Contact | None, count: int, measured: Measured, span: slice) -> Array:
        """Compute the readings of one data set: its slice of `count` contacts plus machine errors."""
        if contact is None:
            return numpy.full((1, len(measured)), numpy.nan)
        return self._read_quantity(contact, count, measured, span) + self._added_error(measured, contact, span)

    def compute_at_read_indentation(self, measured: Measured, factor: float) -> Array:
        """Compute the results at measured indentations, corrected for machine errors."""
        zero = self._sum_errors(measured, 0.0, depends_on_force=False)
        force: Array = measured.values if measured.quantity == "force" else 0.0 * measured.values
        contact = self.press("indentation", _clip_negative(factor * measured.loads - zero))
        for _ in range(_NEWTON_ITERATIONS if measured.machine.depends_on_force else 0):
            error = self._sum_errors(measured, force, depends_on_force=True)
            contact = self.press("indentation", _clip_negative(factor * measured.loads - zero - error))
            if contact is not None:
                stiffness = arrays.where(arrays.isfinite(contact.stiffness), contact.stiffness, 0.0)
                force = force - (force - contact.force) / (1 + self._sum_error_slopes(measured, force) * stiffness)
        return self.compute_readings(contact, len(measured), measured, slice(None))

    def _read_quantity(self, contact: Contact, count: int, measured: Measured, span: slice) -> Array:
        """Read the measured quantity of a data set from its slice of `count` contacts."""
        if measured.observable is not None:
            numbers = {name: self.numbers[name] for name in measured.observable.numbers}
            return _add_point_axis(measured.observable.read(contact, **numbers))[:, span]
        if measured.quantity != "pressure":
            return _add_point_axis(getattr(contact, measured.quantity))[:, span]
        angle = numpy.zeros(count)
        angle[span] = measured.angle
        return _add_point_axis(contact.pressure(arrays.namespace(contact.force).asarray(angle)))[:, span]

    def _added_error(self, measured: Measured, contact: Contact, span: slice) -> Array:
        """Compute the machine error in mm that adds to the indentations of a data set; 0 for other quantities."""
        if measured.quantity != "indentation" or not measured.machine.name:
            return 0.0
        force = _add_point_axis(contact.force)[:, span]
        return self._sum_errors(measured, force, depends_on_force=True) + self._sum_errors(
            measured, 0.0, depends_on_force=False
        )

    def _sum_errors(self, measured: Measured, force: Array, *, depends_on_force: bool) -> Array:
        """Sum the machine errors in mm that depend on the force, or those that do not."""
        return sum(
            self.numbers[measured.machine.key(name)] * error.effect(force, measured.order)
            for name, error in MACHINE_ERRORS.items()
            if (error.slope is not None) == depends_on_force
        )

    def _sum_error_slopes(self, measured: Measured, force: Array) -> Array:
        """Sum the derivatives of the machine errors with respect to the force, in mm/N."""
        return sum(
            self.numbers[measured.machine.key(name)] * error.slope(force, measured.order)
            for name, error in MACHINE_ERRORS.items()
            if error.slope is not None
        )


def _is_load_read_by_machine(measured: Measured) -> bool:
    """Check if the loads of a data set are indentations read by a machine with errors."""
    return measured.load == "indentation" and bool(measured.machine.name)


def _clip_negative(indentation: Array) -> Array:
    """Replace negative indentations by 0."""
    return arrays.clip(indentation, 0.0, inf)


def _add_point_axis(values: Array) -> Array:
    """Add a leading axis of points to values that are equal for all points."""
    return values[None, :] if len(values.shape) == 1 else values


def _read_joint_number(joint: Joint, measured: Measured) -> Array:
    """Read a measured number of the joint, repeated for each value of the data set."""
    if measured.quantity in PARTS:
        part, _, number = measured.quantity.partition("_")
        value = getattr(getattr(joint, part), number)
    else:
        value = getattr(joint, measured.quantity)
    if arrays.is_plain_number(value):
        return numpy.full((1, len(measured)), value)
    return value + numpy.zeros(len(measured))
