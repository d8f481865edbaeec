"""Models that are solved joint by joint: arrays of joints and loads are taken apart, and the answers put together."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, prod
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy

from ..core import arrays
from ..core.arrays import Array
from ..problem import Joint
from . import strength
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
"""What a state knows, one number a contact, and how well; besides, where the largest pressure is."""


@dataclass(frozen=True, kw_only=True, eq=False)
class JointContacts:
    """Contacts of one joint.

    `state` has those that are `touching` (a mask of the loads): `QUANTITIES`, `max_pressure_angle` and
    `pressure(angle)` of them. `reached` marks the ones that have an answer, and `error` is the relative error of each
    quantity.
    """

    load: numpy.ndarray
    touching: numpy.ndarray
    state: Any
    reached: numpy.ndarray
    error: dict[str, numpy.ndarray]

    def spread(self, values: numpy.ndarray) -> numpy.ndarray:
        """Values of the touching contacts in the order of the loads: 0 without a load, NaN where none was reached."""
        whole = numpy.zeros((*values.shape[:-1], len(self.load)))
        whole[..., self.touching] = numpy.where(self.reached, values, numpy.nan)
        return whole


Solve = Callable[..., JointContacts]
"""From a joint of plain numbers and its loads, and what else varies from load to load, to their contacts."""


def solve_per_joint(model: Model, joint: Joint, load: Array, solve: Solve, *others: Array) -> CombinedSolution:
    """The contacts of all joints that lie in the model's domain; every one is solved with all of its loads at once.

    `others` are arrays that broadcast against joint and load, handed to `solve` after the loads.

    Raises
    ------
    TypeError
        Numbers that are not known yet (inside `jax.jit`, `jax.grad`).
    """
    joint = joint.without_strengths()
    numbers = [_values(model, number) for number in joint.numbers()]
    varying = [_values(model, each) for each in (load, *others)]
    shape = numpy.broadcast_shapes(*(numpy.shape(number) for number in (*numbers, *varying)))
    loads = [numpy.broadcast_to(each, shape).ravel().astype(float) for each in varying]
    pieces = []
    for column, place in _columns(numbers, shape):
        one = joint.with_numbers(column)
        if place.size and all(limit.strictly_holds(SimpleNamespace(joint=one)) for limit in model.domain):
            pieces.append((place, solve(one, *(each[place] for each in loads))))
    return CombinedSolution(like=load, shape=shape, pieces=tuple(pieces))


def _columns(numbers: list[numpy.ndarray], shape: tuple[int, ...]) -> Iterator[tuple[list[float], numpy.ndarray]]:
    """Each joint's numbers, with the places in the flat shape where it stands."""
    if all(number.size == 1 for number in numbers):
        yield [float(number.item()) for number in numbers], numpy.arange(prod(shape))
        return
    table = numpy.stack([numpy.broadcast_to(number, shape).ravel() for number in numbers]).astype(float)
    joints, which = numpy.unique(table, axis=1, return_inverse=True)
    order = numpy.argsort(which.ravel(), kind="stable")
    ends = numpy.cumsum(numpy.bincount(which.ravel(), minlength=joints.shape[1]))
    for column, place in zip(joints.T, numpy.split(order, ends[:-1]), strict=False):
        yield column.tolist(), place


def joint_at(joint: Joint, shape: tuple[int, ...], place: int) -> Joint:
    """The joint of plain numbers at a place of the flat shape."""
    wide = (numpy.broadcast_to(arrays.to_numpy(number), shape) for number in joint.numbers())
    return joint.with_numbers([float(number.flat[place]) for number in wide])


def _values(model: Model, number: Array) -> numpy.ndarray:
    values = arrays.concrete_values(number)
    if values is None:
        raise TypeError(f"{model.name} cannot be traced by JAX: tabulated and refined can")
    return values


def _of_state(name: str) -> Any:
    """A quantity of all states, put together when it is first asked for."""

    def quantity(self: CombinedSolution) -> Array:
        return self.spread(lambda piece: getattr(piece.state, name))

    quantity.__name__ = name
    return cached_property(quantity)


@dataclass(frozen=True, kw_only=True, eq=False)
class CombinedSolution:
    """The contacts of all joints, as the `Laws` of the contact they belong to, in the caller's array library."""

    like: Array
    shape: tuple[int, ...]
    pieces: tuple[tuple[numpy.ndarray, JointContacts], ...]

    def spread(self, quantity: Callable[[JointContacts], numpy.ndarray], rows: tuple[int, ...] = ()) -> Array:
        """A quantity of every piece at its place, of the shape (*rows, *shape); NaN where there is none."""
        return self._own(self._flat(lambda place, piece: quantity(piece), prod(rows)), rows)

    def located(self, quantity: Callable[[numpy.ndarray, JointContacts], numpy.ndarray]) -> Array:
        """Values of a quantity that depends on the places of the piece's contacts too."""
        return self._own(self._flat(quantity))

    def _flat(self, quantity: Callable[[numpy.ndarray, JointContacts], numpy.ndarray], rows: int = 1) -> numpy.ndarray:
        whole = numpy.full((rows, prod(self.shape)), numpy.nan)
        for place, piece in self.pieces:
            whole[:, place] = piece.spread(quantity(place, piece))
        return whole

    def _own(self, whole: numpy.ndarray, shape: tuple[int, ...] = ()) -> Array:
        """NumPy values in the shape, library, dtype and device of the load."""
        values = whole.reshape((*shape, *self.shape))
        xp = arrays.namespace(self.like)
        return xp.asarray(values, dtype=self.like.dtype, device=arrays.device(self.like))

    def _error(self, name: str) -> Array:
        return self.spread(lambda piece: piece.error[name])

    @property
    def worst(self) -> Array:
        """The largest of the estimated errors, point by point."""
        return self.spread(lambda piece: numpy.max(list(piece.error.values()), axis=0))

    @property
    def error(self) -> dict[str, Array]:
        """Estimated relative error of each quantity."""
        return {name: self._error(name) for name in QUANTITIES}

    force = _of_state("force")
    indentation = _of_state("indentation")
    half_angle = _of_state("half_angle")
    max_pressure = _of_state("max_pressure")
    max_pressure_angle = _of_state("max_pressure_angle")
    pole_pressure = _of_state("pole_pressure")
    stiffness = _of_state("stiffness")
    energy = _of_state("energy")
    pressure_integral = _of_state("pressure_integral")

    @property
    def foundation_modulus(self) -> Array:
        d = self.indentation
        return arrays.where(d == 0, inf, self.pole_pressure / arrays.safe_divisor(d))

    def pressure(self, angle: Array) -> Array:
        """p(φ) at angles that broadcast against the contact's shape."""
        given = arrays.to_numpy(angle)
        shape = numpy.broadcast_shapes(given.shape, self.shape)
        front = shape[: len(shape) - len(self.shape)]
        rows = numpy.broadcast_to(given, (*front, *self.shape)).reshape(prod(front), prod(self.shape))
        return self._own(
            self._flat(lambda place, piece: piece.state.pressure(rows[:, place[piece.touching]]), rows=len(rows)), front
        )


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class SolvedContact(Contact):
    """A `Contact` whose model solved it joint by joint, and estimated how well."""

    laws: CombinedSolution

    _inside: ClassVar[str] = "displacements and stresses"

    @cached_property
    def error(self) -> dict[str, Array]:
        """Estimated relative error of each quantity, by name, from the solution itself."""
        return {name: self._match_load(error) for name, error in self.laws.error.items()}

    @property
    def von_mises_bounds(self) -> tuple[Array, Array]:
        """What `von_mises` lies between, as far as that is known at once: about what other models say of it."""
        least, most = strength.von_mises_bounds(self, super()._compute_von_mises())
        return self._match_load(least), self._match_load(most)

    def _compute_von_mises(self) -> Array:
        return self.laws.located(self._joint_von_mises)

    def utilisation_at(self, asked: Array) -> Array:
        wanted = numpy.broadcast_to(arrays.to_numpy(asked), self.laws.shape).ravel()

        def there(place: numpy.ndarray, piece: JointContacts) -> numpy.ndarray:
            some = replace(piece, reached=piece.reached & wanted[place][piece.touching])
            return self._joint_von_mises(place, some)

        return self._compute_utilisation(self._match_load(self.laws.located(there)))

    @abstractmethod
    def _joint_von_mises(self, place: numpy.ndarray, piece: JointContacts) -> numpy.ndarray:
        """Largest von Mises stress in the liner of the touching contacts of one joint, which lie at these places."""

    @property
    def single_state(self) -> Any:
        """The solver's own answer, of one contact that touches, with a load or preloaded.

        Raises
        ------
        ValueError
            More than one contact, or one that does not touch or has no answer.
        """
        if prod(self.laws.shape) != 1:
            raise ValueError(f"{self._inside} are for one contact, not {self.laws.shape}: press it alone")
        pieces = self.laws.pieces
        if self._failed_everywhere or not pieces or not pieces[0][1].touching.all():
            raise ValueError(f"{self._inside} need a contact under load, or preloaded")
        return pieces[0][1].state

    @property
    def _failed_everywhere(self) -> bool:
        return bool(arrays.to_numpy(self._failed).all())

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON, with the error estimates."""
        error = {name: arrays.to_list(value) for name, value in self.error.items()}
        return {**super().summary(), "error": error}
