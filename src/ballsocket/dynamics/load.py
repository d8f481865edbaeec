"""Load of a force element at a state: force and moment on both bodies, energy, derivatives, and the contact state."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from functools import partial, wraps
from math import degrees
from typing import Any, NamedTuple, Protocol

import numpy

from ..core import arrays
from ..core.arrays import Array, Numbers, sqrt, to_list, where
from ..core.checks import shown
from . import reaction as formulas
from .bristles import Bristles, Four, bent
from .matrices import damping_matrix, matrix, vector
from .reaction import Constants, Elastic, Place, Three, pressed, sliding


class Touch(IntEnum):
    """What a force element finds at a state. Arrays hold its codes."""

    FREE = 0
    CONTACT = 1
    AT_RIM = 2
    OVER_RIM = 3
    THROUGH_WALL = 4
    NO_NUMBER = 5

    @property
    def sentence(self) -> str:
        return _SENTENCES[self]

    @property
    def failed(self) -> bool:
        """Whether there is no answer: the step that led here is to be taken again, shorter."""
        return self >= Touch.THROUGH_WALL


_SENTENCES = {
    Touch.FREE: "nothing touches",
    Touch.CONTACT: "the ball touches the socket",
    Touch.AT_RIM: "the contact reaches the rim, which carries a part of it",
    Touch.OVER_RIM: "the ball has left the cup over its rim, and nothing carries it",
    Touch.THROUGH_WALL: "the ball is deeper than the wall, or the model, goes: a shorter step is needed",
    Touch.NO_NUMBER: "the state is no finite number, or too large a one",
}


ROOM = 1e8
"""Numbers of a state are too large if this times the sum of their squares is none."""


class LoadedElement(Protocol):
    """Force element as its loads use it."""

    @property
    def constants(self) -> Constants: ...
    @property
    def stretch(self) -> float: ...
    @property
    def wall(self) -> float: ...
    def half_angle(self, indentation: Array) -> Array: ...
    def max_pressure(self, indentation: Array) -> Array: ...


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
    element: LoadedElement
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


def status_of(place: Place, contact: Elastic, known: Array, given: Constants) -> Touch | Array:
    """A `Touch`, or an array of its codes."""
    d, s = place.indentation, contact.covered
    none = 0.0 * where(known, d, 0.0)
    touching = d > -given.smoothing
    code = where(touching, none + 1.0, none)
    code = where(touching & (s < 1.0), none + float(Touch.AT_RIM), code)
    code = where(
        (d > given.wall) | (touching & (contact.normal != contact.normal)), none + float(Touch.THROUGH_WALL), code
    )
    code = where(touching & (s <= -1.0), none + float(Touch.OVER_RIM), code)
    code = where(known, code, none + float(Touch.NO_NUMBER))
    if type(code) is float:
        return Touch(int(code))
    xp = arrays.namespace(code)
    return xp.astype(code, xp.int8)


def told(load: Load) -> tuple[str, ...]:
    """A sentence for each kind of state that is to be told, with the first of its states."""
    codes = numpy.atleast_1d(arrays.to_numpy(load.status)).ravel()
    return tuple(_told(load, codes, touch) for touch in list(Touch)[2:] if (codes == touch).any())


def _told(load: Load, codes: Numbers, touch: Touch) -> str:
    numbers = numpy.flatnonzero(codes == touch)
    x, y, z, d = (_at(part, codes, numbers[0]) for part in (*load.position, load.indentation))
    many = "" if codes.size == 1 else f"{len(numbers)} of {codes.size}: "
    state = f"r = ({x:.6g}, {y:.6g}, {z:.6g}) mm, d = {d:.6g} mm"
    return f"{many}{touch.sentence}; {state}, and there is an answer up to {load.element.wall:.6g} mm"


def _at(part: Array, codes: Numbers, number: int) -> float:
    return float(numpy.broadcast_to(arrays.to_numpy(part), codes.shape).ravel()[number])


def brushed(load: Load, bristles: Bristles, deflection: Any) -> Load:
    """A load without friction, and what the bristles add to it."""
    place, given = load.place, load.element.constants
    speed = sum(rate * way for rate, way in zip(load.velocity, place[1:4], strict=True))
    slip = sliding(place, pressed(load.contact, speed, given), load.velocity, load.spin, given)
    force, rate, lost = bent(place, slip, _four(load, deflection), bristles)
    N, R1, n = slip.normal, given.ball_radius, place[1:4]
    rubbing = [-N * part for part in force[:3]]
    drill = -N * sqrt(slip.lever_squared) * force[3]
    turned = _cross(n, rubbing)
    kind = type(load.force)
    return load._replace(
        force=vector(kind, *(a + b for a, b in zip(_components(load.force), rubbing, strict=True))),
        moment=vector(kind, *(R1 * a + drill * way for a, way in zip(turned, n, strict=True))),
        deflection_rate=vector(kind, *rate),
        rubbed=N * lost,
    )


def _four(load: Load, deflection: Any) -> Four:
    if type(load.force) is not tuple and type(deflection) in (tuple, list):
        deflection = numpy.asarray(deflection, dtype=float)
        deflection = arrays.namespace(load.force).asarray(deflection, dtype=load.force.dtype)
    parts = tuple(deflection) if type(deflection) in (tuple, list) else tuple(deflection[..., i] for i in range(4))
    if len(parts) != 4:
        raise ValueError(f"bristles have four deflections, x, y, z and about the load, got {shown(deflection)}")
    a, b, c, d = (part + 0.0 for part in parts)
    return a, b, c, d


def _components(packed: Any) -> Any:
    return packed if type(packed) is tuple else [packed[..., axis] for axis in range(3)]


def _cross(a: Any, b: Any) -> Any:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
