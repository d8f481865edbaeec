"""Forward model of an identification: results for all data at many values of the unknowns at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
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


def split_joint_and_model_values(values: Mapping[str, Array]) -> tuple[dict[str, Array], dict[str, Array]]:
    """Split values by name into numbers of the joint and of the model; errors of a machine are in neither."""
    joint_values = {name: value for name, value in values.items() if name in JOINT_NUMBERS}
    return joint_values, {name: value for name, value in values.items() if name in MODEL_NUMBERS}


def insert_model_numbers(model: Model, values: Mapping[str, Array]) -> Model:
    """Return a copy of the contact model with new values of its parameters, by name."""
    for name, value in values.items():
        model = MODEL_NUMBERS[name].insert_into(model, value)
    return model


@dataclass(frozen=True, eq=False)
class ForwardModel:
    """Forward model of an identification: computes results for all data from values of the unknowns.

    The results are in the order of the data sets.
    """

    model: Model
    joint: Joint  # joint with the numbers that are not unknown
    data: tuple[Measured, ...]
    names: tuple[str, ...]  # names of the unknowns

    def results_at(self, values: Array, load_perturbation: float = 0.0) -> Array:
        """Compute the model results (points, data) for values of the unknowns (points, unknowns).

        A result is NaN where the model has none.

        Values may be of any array library. `load_perturbation` is a relative change of every load.
        """
        values_by_name = {name: values[:, index : index + 1] for index, name in enumerate(self.names)}
        joint_values, model_values = split_joint_and_model_values(values_by_name)
        joint, valid_geometry = vary_joint(self.joint, joint_values)
        errors = {name: size for measured in self.data for name, size in measured.machine.known_errors().items()}
        model = insert_model_numbers(self.model, model_values)
        joints_at_points, load_factor = _JointsAtPoints(model, joint, errors | values_by_name), 1 + load_perturbation
        results_by_index: dict[int, Array] = {}
        shared_by_load: dict[str, list[int]] = {}  # data sets with the same kind of load share one press
        for index, measured in enumerate(self.data):
            if not measured.load:
                results_by_index[index] = _read_joint_number(joints_at_points.joint, measured)
            elif measured.load == "indentation" and measured.machine.name:
                results_by_index[index] = joints_at_points.compute_at_read_indentation(measured, load_factor)
            else:
                shared_by_load.setdefault(measured.load, []).append(index)
        for kind, indices in shared_by_load.items():
            loads = load_factor * numpy.concatenate([self.data[index].loads for index in indices])
            contact, start = joints_at_points.press(kind, loads), 0
            for index in indices:
                value_range = slice(start, start + len(self.data[index]))
                start = value_range.stop
                results_by_index[index] = joints_at_points.compute_readings(
                    contact, len(loads), self.data[index], value_range
                )
        xp = arrays.namespace(values)
        rows = [results_by_index[index] for index in range(len(self.data))]
        rows = [xp.broadcast_to(xp.asarray(row), (len(values), row.shape[-1])) for row in rows]
        return arrays.where(valid_geometry, xp.concat(rows, axis=1), float("nan"))


@dataclass(frozen=True, eq=False)
class _JointsAtPoints:
    """Joints, contact model and other numbers at many values of the unknowns."""

    model: Model
    joint: Joint
    numbers: Columns

    def press(self, kind: str, load: Array) -> Contact | None:
        """Compute the contacts of all joints under loads of one kind; None if no point has a result."""
        load_by_kind = {kind: arrays.namespace(*self.joint.numbers()).asarray(load)}
        try:
            return self.model.press(self.joint, **load_by_kind)
        except OutsideDomainError:
            return None

    def compute_readings(
        self, contact: Contact | None, contact_count: int, measured: Measured, value_range: slice
    ) -> Array:
        """Compute the readings of one data set: model results, and of an indentation the machine errors."""
        if contact is None:
            return numpy.full((1, len(measured)), numpy.nan)
        if measured.observable is not None:
            numbers = {name: self.numbers[name] for name in measured.observable.numbers}
            values = measured.observable.read(contact, **numbers)
        elif measured.quantity == "pressure":
            angle = numpy.zeros(contact_count)
            angle[value_range] = measured.angle
            values = contact.pressure(arrays.namespace(contact.force).asarray(angle))
        else:
            values = getattr(contact, measured.quantity)
        values = _add_point_axis(values)[:, value_range]
        if measured.quantity == "indentation" and measured.machine.name:
            values = values + self._machine_error(measured, _add_point_axis(contact.force)[:, value_range])
        return values

    def compute_at_read_indentation(self, measured: Measured, load_factor: float) -> Array:
        """Compute the results at indentations that a machine with errors has read."""
        force: Array = measured.values if measured.quantity == "force" else 0.0 * measured.values
        contact: Contact | None = None
        for _ in range(_NEWTON_ITERATIONS if measured.machine.depends_on_force else 1):
            depth = load_factor * measured.loads - self._machine_error(measured, force)
            contact = self.press("indentation", arrays.clip(depth, 0.0, inf))
            if contact is not None:
                stiffness = arrays.where(arrays.isfinite(contact.stiffness), contact.stiffness, 0.0)
                compliance = sum(  # of the machine, in mm/N
                    self.numbers[measured.machine.key(name)] * error.slope(force, measured.order)
                    for name, error in MACHINE_ERRORS.items()
                    if error.slope is not None
                )
                force = force - (force - contact.force) / (1 + compliance * stiffness)
        return self.compute_readings(contact, len(measured), measured, slice(None))

    def _machine_error(self, measured: Measured, force: Array) -> Array:
        """Compute the error in mm that a machine adds to readings at a force in N."""
        return sum(
            self.numbers[measured.machine.key(name)] * error.effect(force, measured.order)
            for name, error in MACHINE_ERRORS.items()
        )


def _add_point_axis(values: Array) -> Array:
    """Add a leading axis of length 1 to values that are equal at all points."""
    return values[None, :] if len(values.shape) == 1 else values


def _read_joint_number(joint: Joint, measured: Measured) -> Array:
    """Return a measured number of the joint, repeated for each value of the data set."""
    if measured.quantity in PARTS:
        part_name, _, field_name = measured.quantity.partition("_")
        value = getattr(getattr(joint, part_name), field_name)
    else:
        value = getattr(joint, measured.quantity)
    if arrays.is_plain_number(value):
        return numpy.full((1, len(measured)), value)
    return value + numpy.zeros(len(measured))
