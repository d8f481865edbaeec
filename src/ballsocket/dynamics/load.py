"""What a force element answers: force and moment on both bodies, the energy, and how they change."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, wraps
from math import degrees
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy

from ..core import arrays
from ..core.arrays import Array, to_list
from . import reaction as formulas
from .matrices import damping_matrix, matrix, vector
from .reaction import Elastic, Place, Three
from .touch import ROOM, Touch, status_of, told

if TYPE_CHECKING:
    from .element import ForceElement


def _quiet(formula: Callable[[Load], Any]) -> Callable[[Load], Any]:
    """A formula without NumPy's warnings: a state without an answer has a status."""

    @wraps(formula)
    def answer(load: Load) -> Any:
        if type(load.force) is tuple:
            return formula(load)
        with numpy.errstate(all="ignore"):
            return formula(load)

    return answer


class Load(NamedTuple):
    """The load of a force element at a state: a number, a triple of numbers, or arrays as the state was given.

    Attributes
    ----------
    force : (3,)
        On the ball, in N, at its centre.
    moment : (3,)
        On the ball about its centre, in N mm.
    energy : float or array
        Stored in the contact, in N mm.
    deflection_rate : (4,)
        Of bristles, in mm/s.
    rubbed : float or array
        What bristles lose, in N mm/s.
    """

    force: Any
    moment: Any
    energy: Array
    element: ForceElement
    place: Place
    contact: Elastic
    position: Three
    velocity: Three
    spin: Three
    deflection_rate: Any = (0.0, 0.0, 0.0, 0.0)
    rubbed: Array = 0.0

    @property
    def socket_force(self) -> Any:
        """On the socket, in N."""
        return self._packed(*(-part for part in self._parts(self.force)))

    @property
    @_quiet
    def socket_moment(self) -> Any:
        """On the socket about its own centre, in N mm: less the moment on the ball, less r x F."""
        (fx, fy, fz), (mx, my, mz) = self._parts(self.force), self._parts(self.moment)
        x, y, z = self.position
        return self._packed(-mx - y * fz + z * fy, -my - z * fx + x * fz, -mz - x * fy + y * fx)

    @property
    def indentation(self) -> Array:
        """d in mm; below 0 it is the way to the touch-down."""
        return self.place.distance - (self.element.constants.clearance + self.element.stretch)

    @property
    def attached(self) -> Array:
        """Whether the ball touches, which one that sticks is asked with next."""
        return self.place.indentation > 0.0

    @property
    @_quiet
    def half_angle(self) -> Array:
        """ε of the contact in rad, 0 where nothing touches."""
        return self.element.half_angle(self.indentation)

    @property
    @_quiet
    def max_pressure(self) -> Array:
        """In MPa, of the elastic contact away from a rim."""
        return self.element.max_pressure(self.indentation)

    @property
    def tangent(self) -> Any:
        """∂²U/∂r² in N/mm, (3, 3) and symmetric: less the slope of the elastic force."""
        if type(self.force) is tuple:
            return self._rows
        with numpy.errstate(all="ignore"):
            return matrix(self._rows)

    @property
    def _rows(self) -> Any:
        xx, yy, zz, xy, yz, zx = formulas.tangent(self.place, self.contact, self.element.constants)
        return (xx, xy, zx), (xy, yy, yz), (zx, yz, zz)

    @property
    def damping_matrix(self) -> Any:
        """Less the slope of (force, moment) over (velocity, spin) at this normal force, (6, 6) and symmetric."""
        with numpy.errstate(all="ignore"):
            return damping_matrix(self.place, self.contact, self.velocity, self.spin, self.element.constants)

    @property
    @_quiet
    def dissipation(self) -> Array:
        """What is lost in N mm/s: never below 0."""
        state = self.place, self.contact, self.velocity, self.spin
        return formulas.dissipation(*state, self.element.constants) + self.rubbed

    @property
    @_quiet
    def status(self) -> Touch | Array:
        """A `Touch`, or an array of its codes."""
        return status_of(self.place, self.contact, self._known, self.element.constants)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON in N, mm, N mm, MPa and degrees; a missing number is None."""
        status = self.status
        names = ("force", "moment", "socket_force", "socket_moment", "energy", "dissipation", "indentation")
        return {
            "status": status.name.lower() if isinstance(status, Touch) else to_list(status),
            **{name: _listed(getattr(self, name)) for name in names},
            "half_angle_deg": _listed(self.half_angle * degrees(1.0)),
            "max_pressure": _listed(self.max_pressure),
            "notes": list(self.notes),
        }

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be said of the state: failures with where they are; empty where all is well."""
        return told(self)

    @property
    def _known(self) -> Array:
        rates = self.deflection_rate
        bent = rates if type(rates) is tuple else (rates[..., axis] for axis in range(4))
        state = *self.position, *self.velocity, *self.spin, *bent
        return arrays.isfinite(ROOM * sum((part * part for part in state), 0.0))

    @property
    def _packed(self) -> Any:
        return partial(vector, type(self.force))

    @staticmethod
    def _parts(packed: Any) -> Three:
        x, y, z = packed if type(packed) is tuple else (packed[..., axis] for axis in range(3))
        return x, y, z


def _listed(value: Any) -> Any:
    return [to_list(part) for part in value] if type(value) is tuple else to_list(value)
