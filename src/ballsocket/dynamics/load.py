"""Load of a force element at a state: force and moment on both bodies, energy, derivatives, contact state."""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from functools import wraps
from math import degrees
from typing import Any, NamedTuple, Protocol

import numpy

from ..core import arrays
from ..core.arrays import Array, sqrt, to_list, where
from ..core.checks import shown
from . import reaction as formulas
from .ball_centre import BallCentre, Constants, Vector
from .bristles import DEFLECTIONS, Bristles, bristle_forces
from .film import film_thickness, squeeze_pressure
from .matrices import damping_matrix, join_matrix, join_vector
from .reaction import Elastic, normal_force, sliding_state


class ContactState(IntEnum):
    """State of the contact of a force element, as an integer code in arrays."""

    FREE = 0
    CONTACT = 1
    AT_RIM = 2
    OVER_RIM = 3
    THROUGH_WALL = 4
    NO_NUMBER = 5

    @property
    def sentence(self) -> str:
        """Description of the contact state in words, such as "no contact"."""
        return _SENTENCES[self]

    @property
    def failed(self) -> bool:
        """True for a state without a valid load; repeat the last time step with a smaller size."""
        return self >= ContactState.THROUGH_WALL


_SENTENCES = {
    ContactState.FREE: "no contact",
    ContactState.CONTACT: "contact",
    ContactState.AT_RIM: "the contact reaches the rim of the cup",
    ContactState.OVER_RIM: "the ball has left the cup over its rim, without contact",
    ContactState.THROUGH_WALL: "the indentation exceeds the wall thickness or the range of the model; reduce the step",
    ContactState.NO_NUMBER: "the state is not finite, or too large",
}


_OVERFLOW_GUARD = 1e8  # factor whose product with the sum of squares of a state must not overflow


class LoadedElement(Protocol):
    """Interface of a force element that its loads depend on."""

    @property
    def constants(self) -> Constants: ...
    @property
    def stretch(self) -> float: ...
    @property
    def wall(self) -> float: ...
    def relaxation_loss(self, load: Load) -> Array: ...
    def half_angle(self, indentation: Array) -> Array: ...
    def max_pressure(self, indentation: Array) -> Array: ...


def _without_warnings(compute_property: Callable[[Load], Any]) -> Callable[[Load], Any]:
    """Wrap a property of `Load` so that NumPy gives no floating-point warnings."""

    @wraps(compute_property)
    def compute_without_warnings(load: Load) -> Any:
        if type(load.force) is tuple:
            return compute_property(load)
        with numpy.errstate(all="ignore"):
            return compute_property(load)

    return compute_without_warnings


class Load(NamedTuple):
    """Load of a force element at a state, in numbers or in arrays like those of the state.

    Attributes
    ----------
    force : (3,)
        Force on the ball at its centre in N.
    moment : (3,)
        Moment on the ball about its centre in N mm.
    energy : float or array
        Elastic energy of the contact in N mm; of a relaxing liner that of its long-time modulus.
    deflection_rate : (4,)
        Rate of the bristle deflections in mm/s.
    bristle_dissipation : float or array
        Power dissipated by the bristles in N mm/s.
    relaxed_forces : tuple
        Relaxed forces of the liner in N, one for each of its terms.
    relaxed_force_rate : (terms,)
        Rate of the relaxed forces in N/s.
    """

    force: Any
    moment: Any
    energy: Array
    element: LoadedElement
    centre: BallCentre
    contact: Elastic
    position: Vector
    velocity: Vector
    spin: Vector
    deflection_rate: Any = (0.0, 0.0, 0.0, 0.0)
    bristle_dissipation: Array = 0.0
    relaxed_forces: tuple[Array, ...] = ()
    relaxed_force_rate: Any = ()

    def __repr__(self) -> str:
        return f"<Load {self}>"

    def __str__(self) -> str:
        return describe_load(self.force, self.moment, self.energy)

    @property
    def socket_force(self) -> Any:
        """Force on the socket in N."""
        return join_vector(type(self.force), *(-part for part in vector_components(self.force)))

    @property
    @_without_warnings
    def socket_moment(self) -> Any:
        """Moment on the socket about its centre in N mm: -M - r x F."""
        (fx, fy, fz), (mx, my, mz) = vector_components(self.force), vector_components(self.moment)
        x, y, z = self.position
        moment = -mx - y * fz + z * fy, -my - z * fx + x * fz, -mz - x * fy + y * fx
        return join_vector(type(self.force), *moment)

    @property
    def indentation(self) -> Array:
        """Indentation d in mm; negative values are the distance to first touch."""
        return self.centre.distance - (self.element.constants.clearance + self.element.stretch)

    @property
    def attached(self) -> Array:
        """True if the ball is in contact; pass this value to the next call for an adhesive socket."""
        return self.centre.indentation > 0.0

    @property
    @_without_warnings
    def half_angle(self) -> Array:
        """Half angle ε of the contact in rad; 0 without contact."""
        return self.element.half_angle(self.indentation)

    @property
    @_without_warnings
    def max_pressure(self) -> Array:
        """Largest contact pressure in MPa, without the effect of a rim."""
        return self.element.max_pressure(self.indentation)

    @property
    @_without_warnings
    def film_thickness(self) -> Array:
        """Least gap between ball and socket in mm; with a lubricant at least its combined roughness."""
        return film_thickness(self.centre, self.element.constants)[0]

    @property
    @_without_warnings
    def squeeze_pressure(self) -> Array:
        """Pressure in MPa of the squeezed film where it is thinnest, relative to a film as thick as the clearance.

        It is negative for a ball that leaves the wall. A fluid at atmospheric pressure cavitates at about -0.1 MPa,
        which the element does not model.
        """
        return squeeze_pressure(self.centre, self.velocity, self.element.constants)

    @property
    @_without_warnings
    def tangent(self) -> Any:
        """Tangent stiffness ∂²U/∂r² of the elastic contact in N/mm, a symmetric matrix (3, 3).

        That of a relaxing liner is the derivative of the force at constant relaxed forces.
        """
        return tangent_matrix(
            type(self.force), formulas.tangent_stiffness(self.centre, self.contact, self.element.constants)
        )

    @property
    def damping_matrix(self) -> Any:
        """Damping matrix -∂(F, M)/∂(v, ω) at a constant normal force, a symmetric matrix (6, 6)."""
        with numpy.errstate(all="ignore"):
            return damping_matrix(self.centre, self.contact, self.velocity, self.spin, self.element.constants)

    @property
    @_without_warnings
    def dissipation(self) -> Array:
        """Dissipated power in N mm/s, 0 or more."""
        state = self.centre, self.contact, self.velocity, self.spin
        losses = self.bristle_dissipation + self.element.relaxation_loss(self)
        return formulas.dissipation(*state, self.element.constants) + losses

    @property
    @_without_warnings
    def status(self) -> ContactState | Array:
        """State of the contact (free, contact, at the rim, ...): a `ContactState`, or an array of its codes."""
        internal = *vector_components(self.deflection_rate), *self.relaxed_forces
        state = *self.position, *self.velocity, *self.spin, *internal
        return contact_state_of(self.centre, self.contact, is_finite_state(state), self.element.constants)

    def summary(self) -> dict[str, Any]:
        """Return the load as a dictionary for JSON, in N, mm, N mm, MPa and degrees; missing numbers are None."""
        status = self.status
        names = ("force", "moment", "socket_force", "socket_moment", "energy", "dissipation", "indentation")
        return {
            "status": status.name.lower() if isinstance(status, ContactState) else to_list(status),
            **{name: _to_json_value(getattr(self, name)) for name in names},
            "half_angle_deg": _to_json_value(self.half_angle * degrees(1.0)),
            "max_pressure": _to_json_value(self.max_pressure),
            "notes": list(self.notes),
        }

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on states with contact at the rim or without a load, with their positions."""
        codes, notes = numpy.atleast_1d(arrays.to_numpy(self.status)).ravel(), []
        for state in list(ContactState)[ContactState.AT_RIM :]:
            indices = numpy.flatnonzero(codes == state)
            if len(indices):
                x, y, z, d = (
                    float(numpy.broadcast_to(arrays.to_numpy(values), codes.shape).ravel()[indices[0]])
                    for values in (*self.position, self.indentation)
                )
                count = "" if codes.size == 1 else f"{len(indices)} of {codes.size}: "
                values = f"r = ({x:.6g}, {y:.6g}, {z:.6g}) mm, d = {d:.6g} mm"
                notes.append(f"{count}{state.sentence}; {values}, the limit is {self.element.wall:.6g} mm")
        return tuple(notes)


def describe_load(force: Any, moment: Any, energy: Any) -> str:
    """Describe force (N), moment (N mm) and energy (N mm) of one state, or the shape of several."""
    try:
        vectors, number = [[float(part) for part in vector] for vector in (force, moment)], float(energy)
    except (TypeError, ValueError):  # arrays, or a tracer without a value
        return f"of states of shape {tuple(getattr(force, 'shape', ()))[:-1]}"
    texts = [", ".join(f"{part + 0.0:.5g}" for part in vector) for vector in vectors]
    return f"force ({texts[0]}) N, moment ({texts[1]}) N mm, energy {number + 0.0:.5g} N mm"


def _to_json_value(value: Any) -> Any:
    return [to_list(part) for part in value] if type(value) is tuple else to_list(value)


def contact_state_of(
    centre: BallCentre, contact: Elastic, is_finite: Array, constants: Constants
) -> ContactState | Array:
    """Determine the state of the contact: a `ContactState`, or an array of codes; `is_finite` masks the states."""
    d, rim_margin = centre.indentation, contact.rim_margin
    none = 0.0 * where(is_finite, d, 0.0)
    touching = d > -constants.smoothing
    code = where(touching, none + 1.0, none)
    code = where(touching & (rim_margin < 1.0), none + float(ContactState.AT_RIM), code)
    code = where(
        (d > constants.wall) | (touching & (contact.normal != contact.normal)),
        none + float(ContactState.THROUGH_WALL),
        code,
    )
    code = where(touching & (rim_margin <= -1.0), none + float(ContactState.OVER_RIM), code)
    code = where(is_finite, code, none + float(ContactState.NO_NUMBER))
    return to_contact_state(code)


def add_bristle_loads(load: Load, bristles: Bristles, deflection: Any) -> Load:
    """Add friction force, moment and dissipated power of bristles to a load, and return the sum."""
    centre, constants, kind = load.centre, load.element.constants, type(load.force)
    speed = sum(rate * component for rate, component in zip(load.velocity, centre[1:4], strict=True))
    slip = sliding_state(centre, normal_force(load.contact, speed, constants), load.velocity, load.spin, constants)
    like = None if kind is tuple else load.force
    allowed = "bristles must have four deflections, x, y, z and about the load"
    deflections = split_internal_state(deflection, DEFLECTIONS, like, allowed)
    force, rate, dissipated = bristle_forces(centre, slip, deflections, bristles)
    N, R1, (nx, ny, nz) = slip.normal, constants.ball_radius, centre[1:4]
    fx, fy, fz = (-N * part for part in force[:3])
    drilling_moment = -N * sqrt(slip.lever_squared) * force[3]
    (gx, gy, gz), (mx, my, mz) = vector_components(load.force), vector_components(load.moment)
    return load._replace(
        force=join_vector(kind, gx + fx, gy + fy, gz + fz),
        moment=join_vector(
            kind,
            mx + R1 * (ny * fz - nz * fy) + drilling_moment * nx,
            my + R1 * (nz * fx - nx * fz) + drilling_moment * ny,
            mz + R1 * (nx * fy - ny * fx) + drilling_moment * nz,
        ),
        deflection_rate=join_vector(kind, *rate),
        bristle_dissipation=N * dissipated,
    )


def split_internal_state(state: Any, count: int, like: Any, allowed: str) -> tuple[Array, ...]:
    """Split an internal state into components: numbers if `like` is None, otherwise arrays of its library.

    Raises ValueError, which begins with `allowed`: another number of components than `count`, or texts.
    """
    if like is not None and type(state) in (tuple, list):
        state = arrays.namespace(like).asarray(numpy.asarray(state, dtype=float), dtype=like.dtype)
    try:
        parts = tuple(part + 0.0 for part in vector_components(tuple(state) if type(state) is list else state))
    except (AttributeError, TypeError, IndexError):  # a number, or texts
        parts = ()
    if len(parts) != count:
        raise ValueError(f"{allowed}, got {shown(state)}")
    return parts


def vector_components(packed: Any) -> Any:
    """Return the components of a vector, a tuple or an array (..., components)."""
    return packed if type(packed) is tuple else [packed[..., axis] for axis in range(packed.shape[-1])]


def is_finite_state(components: Any) -> Array:
    """Check if all numbers of a state are finite and small enough to square."""
    return arrays.isfinite(_OVERFLOW_GUARD * sum((part * part for part in components), 0.0))


def to_contact_state(code: Array) -> ContactState | Array:
    """Convert a floating-point code to a `ContactState`, or an array of codes to integers."""
    if type(code) is float:
        return ContactState(int(code))
    xp = arrays.namespace(code)
    return xp.astype(code, xp.int8)


def tangent_matrix(kind: type, components: tuple[Array, ...]) -> Any:
    """Join the components xx, yy, zz, xy, yz, zx of a tangent stiffness to rows of tuples, or to arrays (..., 3, 3)."""
    xx, yy, zz, xy, yz, zx = components
    rows = (xx, xy, zx), (xy, yy, yz), (zx, yz, zz)
    return rows if kind is tuple else join_matrix(rows)
