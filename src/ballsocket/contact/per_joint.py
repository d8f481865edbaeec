"""Models that solve one joint at a time: split arrays of joints and loads, and combine the solutions."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf, nan, prod
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..core.lazy import cached_property
from ..problem import Joint
from .contact import Contact
from .model import Model

QUANTITIES = (
    "force",
    "indentation",
    "half_angle",
    "max_pressure",
    "pole_pressure",
    "stiffness",
    "energy",
    "pressure_integral",
)
"""Quantities of a solved state that have an error estimate, one number per contact."""


@dataclass(frozen=True, kw_only=True, eq=False)
class JointContacts:
    """Solved contacts of one joint under several loads."""

    load: numpy.ndarray  # load of each contact
    touching: numpy.ndarray  # mask of the loads whose contact is solved; the others are zero
    state: Any  # solution of the touching contacts: `QUANTITIES`, `max_pressure_angle` and `pressure(angle)`
    reached: numpy.ndarray  # mask of the touching contacts that have a solution
    error: dict[str, numpy.ndarray]  # relative error of each quantity of the touching contacts

    def expand_to_all_loads(self, values: numpy.ndarray) -> numpy.ndarray:
        """Expand values (..., touching) to all loads (..., loads): 0 at loads of 0, NaN without a solution."""
        expanded = numpy.zeros((*values.shape[:-1], len(self.load)))
        expanded[..., self.touching] = numpy.where(self.reached, values, numpy.nan)
        return expanded


Solve = Callable[..., JointContacts]
"""Solver of one joint of plain numbers: takes the joint, its loads and other arrays of the same length."""


def solve_per_joint(model: Model, joint: Joint, load: Array, solve: Solve, *parameters: Array) -> CombinedSolution:
    """Solve the contacts of arrays of joints and loads: one solution for each distinct joint, with all its loads.

    `solve` solves one joint. It gets the loads, then the parameters, arrays that broadcast against joint and load.

    Raises TypeError: traced numbers without a value (inside `jax.jit`, `jax.grad`).
    """
    joint = joint.without_strengths()
    numbers = [_to_concrete_array(model, number) for number in joint.numbers()]
    load_arrays = [_to_concrete_array(model, value) for value in (load, *parameters)]
    common_shape = numpy.broadcast_shapes(*(numpy.shape(number) for number in (*numbers, *load_arrays)))
    loads = [numpy.broadcast_to(value, common_shape).ravel().astype(float) for value in load_arrays]
    joint_contacts = []
    for joint_numbers, indices in _distinct_joints(numbers, common_shape):
        single_joint = joint.with_numbers(joint_numbers)
        if indices.size and all(limit.strictly_holds(SimpleNamespace(joint=single_joint)) for limit in model.domain):
            joint_contacts.append((indices, solve(single_joint, *(values[indices] for values in loads))))
    return CombinedSolution(like=load, shape=common_shape, pieces=tuple(joint_contacts))


def _distinct_joints(
    numbers: list[numpy.ndarray], shape: tuple[int, ...]
) -> Iterator[tuple[list[float], numpy.ndarray]]:
    """Yield each distinct joint of broadcast arrays: its numbers and the flat indices of its points."""
    if all(number.size == 1 for number in numbers):
        yield [float(number.item()) for number in numbers], numpy.arange(prod(shape))
        return
    table = numpy.stack([numpy.broadcast_to(number, shape).ravel() for number in numbers]).astype(float)
    joints, inverse = numpy.unique(table, axis=1, return_inverse=True)
    order = numpy.argsort(inverse.ravel(), kind="stable")
    ends = numpy.cumsum(numpy.bincount(inverse.ravel(), minlength=joints.shape[1]))
    for joint_numbers, indices in zip(joints.T, numpy.split(order, ends[:-1]), strict=False):
        yield joint_numbers.tolist(), indices


def joint_at(joint: Joint, shape: tuple[int, ...], index: int) -> Joint:
    """Return the joint of plain numbers at one flat index of a joint whose numbers are arrays."""
    broadcast = (numpy.broadcast_to(arrays.to_numpy(number), shape) for number in joint.numbers())
    return joint.with_numbers([float(number.flat[index]) for number in broadcast])


def _to_concrete_array(model: Model, number: Array) -> numpy.ndarray:
    """Convert a number or array to NumPy; raise TypeError if JAX traces it."""
    values = arrays.concrete_values(number)
    if values is None:
        raise TypeError(f"model {model.name} cannot be traced by JAX: use tabulated or refined")
    return values


def _quantity_of_all_joints(quantity_name: str) -> Any:
    """Make a cached property: the values of one quantity in all joints, as one array."""

    def combine_quantity(self: CombinedSolution) -> Array:
        return self.combine(lambda contacts: getattr(contacts.state, quantity_name))

    combine_quantity.__name__ = quantity_name
    return cached_property(combine_quantity)


@dataclass(frozen=True, kw_only=True, eq=False)
class CombinedSolution:
    """Solutions of all joints, combined to arrays of the load's library: the `Laws` of their contact."""

    like: Array  # load, whose library, dtype and device the quantities have
    shape: tuple[int, ...]  # common shape of joint and load
    # (array, JointContacts), indices in the flattened shape and contacts of each joint
    pieces: tuple[tuple[numpy.ndarray, JointContacts], ...]

    def combine(self, quantity: Callable[[JointContacts], numpy.ndarray], rows: tuple[int, ...] = ()) -> Array:
        """Combine a quantity of all joints to one array (*rows, *shape); NaN at points without a solution."""
        return self.combine_by_index(lambda indices, contacts: quantity(contacts), rows)

    def combine_by_index(
        self, quantity: Callable[[numpy.ndarray, JointContacts], numpy.ndarray], rows: tuple[int, ...] = ()
    ) -> Array:
        """Combine a quantity that is a function of the flat indices of the points; see `combine`."""
        combined = numpy.full((prod(rows), prod(self.shape)), numpy.nan)
        for indices, contacts in self.pieces:
            combined[:, indices] = contacts.expand_to_all_loads(quantity(indices, contacts))
        return arrays.convert_like(combined.reshape((*rows, *self.shape)), self.like)

    def _relative_error(self, name: str) -> Array:
        return self.combine(lambda contacts: contacts.error[name])

    @property
    def max_error(self) -> Array:
        """Largest estimated relative error of all quantities at each point."""
        return self.combine(lambda contacts: numpy.max(list(contacts.error.values()), axis=0))

    @property
    def error(self) -> dict[str, Array]:
        """Estimated relative errors, one array for each quantity name."""
        return {name: self._relative_error(name) for name in QUANTITIES}

    force = _quantity_of_all_joints("force")
    indentation = _quantity_of_all_joints("indentation")
    half_angle = _quantity_of_all_joints("half_angle")
    max_pressure = _quantity_of_all_joints("max_pressure")
    max_pressure_angle = _quantity_of_all_joints("max_pressure_angle")
    pole_pressure = _quantity_of_all_joints("pole_pressure")
    stiffness = _quantity_of_all_joints("stiffness")
    energy = _quantity_of_all_joints("energy")
    pressure_integral = _quantity_of_all_joints("pressure_integral")

    @property
    def foundation_modulus(self) -> Array:
        """Foundation modulus K = p0/d in MPa/mm (pole pressure p0, indentation d); infinite for d = 0."""
        d = self.indentation
        return arrays.where(d == 0, inf, self.pole_pressure / arrays.safe_divisor(d))

    def pressure(self, angle: Array) -> Array:
        """Compute the contact pressure in MPa at polar angles in rad.

        The angles broadcast with the shape of the contact.
        """
        angles = arrays.to_numpy(angle)
        shape = numpy.broadcast_shapes(angles.shape, self.shape)
        angle_shape = shape[: len(shape) - len(self.shape)]
        rows = numpy.broadcast_to(angles, (*angle_shape, *self.shape)).reshape(prod(angle_shape), prod(self.shape))

        def joint_pressure(indices: numpy.ndarray, contacts: JointContacts) -> numpy.ndarray:
            pressures: numpy.ndarray = contacts.state.pressure(rows[:, indices[contacts.touching]])
            return pressures

        return self.combine_by_index(joint_pressure, angle_shape)


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class SolvedContact(Contact):
    """Contact of a numerical model that solves joint by joint, with error estimates."""

    laws: CombinedSolution

    _inside: ClassVar[str] = "displacements and stresses"

    @cached_property
    def error(self) -> dict[str, Array]:
        """Estimated relative errors, one array for each quantity name; that of a solved stress is measured.

        A point without an answer has NaN.
        """
        failed, errors = self._failed, self.laws.error
        errors = {name: self._match_load(arrays.where(failed, nan, error)) for name, error in errors.items()}
        if self.stress_error is not None:
            errors["von_mises"] = (1 + self.stress_error) * (1 + errors["max_pressure"]) - 1
        return errors

    @property
    def stated_error(self) -> dict[str, Array]:
        """Relative errors of the solver, the same at points that are not valid."""
        return self.error

    def _compute_von_mises(self) -> Array:
        """Compute the largest von Mises stress in the liner in MPa by solving for the stresses."""
        return self.laws.combine_by_index(self._joint_von_mises)

    def utilisation_at(self, mask: Array) -> Array:
        """Compute the ratio of von Mises to yield stress at the points of a mask; NaN at the other points."""
        flat_mask = numpy.broadcast_to(arrays.to_numpy(mask), self.laws.shape).ravel()

        def masked_von_mises(indices: numpy.ndarray, contacts: JointContacts) -> numpy.ndarray:
            masked_contacts = replace(contacts, reached=contacts.reached & flat_mask[indices][contacts.touching])
            return self._joint_von_mises(indices, masked_contacts)

        return self._compute_utilisation(self._match_load(self.laws.combine_by_index(masked_von_mises)))

    @abstractmethod
    def _joint_von_mises(self, indices: numpy.ndarray, contacts: JointContacts) -> numpy.ndarray:
        """Compute the largest von Mises stress in MPa in the liner of one joint, for its touching contacts."""

    @property
    def single_state(self) -> Any:
        """Solved state of a single contact; the ball must touch the socket.

        Raises ValueError: more than one contact; a contact that does not touch or has no result.
        """
        if prod(self.laws.shape) != 1:
            raise ValueError(f"{self._inside} are for one contact, got the shape {self.laws.shape}: press one load")
        joint_contacts = self.laws.pieces
        if self._all_points_failed or not joint_contacts or not joint_contacts[0][1].touching.all():
            raise ValueError(f"{self._inside} need a contact under load, or preloaded")
        return joint_contacts[0][1].state

    @property
    def _all_points_failed(self) -> bool:
        return bool(arrays.to_numpy(self._failed).all())

    def summary(self) -> dict[str, Any]:
        """Return a dictionary of the contact for JSON, with error estimates."""
        error = {name: arrays.to_list(value) for name, value in self.error.items()}
        return {**super().summary(), "error": error}
