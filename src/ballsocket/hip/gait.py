"""Cycles of load and motion: what a hip goes through in a step, as values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi, radians
from types import MappingProxyType
from typing import Any

import numpy

from ..arrays import Numbers
from ..checks import known_name, require, shown
from .sliding import rotation_matrices, rotation_vectors

INSTANTS = 100
_FEWEST, _MOST = 8, 10_000
_FINE = 10_000

Course = Callable[[Numbers], Numbers]
"""From phases 0 to 1 of a cycle to a quantity, with the phases as the last axis."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Cycle:
    """A cycle of load and motion, cut into instants of equal length.

    Directions are those of the body, or of the machine: x to the side (lateral), y to the front, z upwards. The socket
    stands still and the ball turns by R = the product of three rotations, flexion about x, adduction about y,
    inward rotation about z.

    Parameters
    ----------
    name : str
    force : function
        From phases (n,) in 0 to 1 to forces of the ball on the socket (3, n) in N, or to their sizes (n,) upwards; what
        pulls the ball off, a size below 0, is no contact.
    angles : function
        From phases to flexion, adduction and rotation (3, n) in rad.
    instants : int
    order : str
        The axes as they are multiplied: "xyz" is R = Rx Ry Rz.
    duration : float
        In s.
    cup_tilt : float, optional
        In rad from the load, where a standard says how a socket is put in.
    notes : tuple of str
        What is to be said of it.

    Raises
    ------
    ValueError
        Numbers that are not finite; a number of instants or an order that is none.
    """

    name: str
    force: Course
    angles: Course
    instants: int = INSTANTS
    order: str = "xyz"
    duration: float = 1.0
    cup_tilt: float | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_instants(self.instants)
        object.__setattr__(self, "order", order_of(self.order))
        for name, values in {"force": self.forces, "angle": self.rotations}.items():
            require(name, values, numpy.isfinite(values), "the numbers of a cycle are finite")

    @property
    def phases(self) -> Numbers:
        """The middle of each instant, 0 to 1."""
        return (numpy.arange(self.instants) + 0.5) / self.instants

    @cached_property
    def forces(self) -> Numbers:
        """In the middle of each instant, in N: (instants, 3)."""
        return self._forces_at(self.phases)

    def _forces_at(self, phases: Numbers) -> Numbers:
        found = numpy.asarray(self.force(phases), dtype=float)
        if found.ndim == 1:
            size = numpy.maximum(found, 0.0)
            found = numpy.stack([0 * size, 0 * size, size])
        return numpy.ascontiguousarray(found.T)

    @cached_property
    def largest_force(self) -> float:
        """In the whole cycle, between the instants too, in N."""
        return float(numpy.linalg.norm(self._forces_at(numpy.linspace(0.0, 1.0, _FINE + 1)), axis=1).max())

    @cached_property
    def sizes(self) -> Numbers:
        """Sizes of the forces in N: (instants,)."""
        return numpy.linalg.norm(self.forces, axis=1)

    @cached_property
    def rotations(self) -> Numbers:
        """Rotation matrices of the ball at the ends of the instants, the last one the first: (instants + 1, 3, 3)."""
        angles = numpy.asarray(self.angles(numpy.arange(self.instants) / self.instants), dtype=float).T
        turned = rotation_matrices(angles, self.order)
        return numpy.concatenate([turned, turned[:1]])

    @cached_property
    def turns(self) -> Numbers:
        """How the ball turns during each instant: rotation vectors in rad, (instants, 3)."""
        return rotation_vectors(self.rotations[1:] @ self.rotations[:-1].swapaxes(1, 2))

    def scaled(self, factor: float) -> Cycle:
        """A cycle of this motion under forces that are larger by a factor."""
        return replace(self, force=lambda phases: factor * self.force(phases))


def check_instants(count: Any) -> int:
    """A number of instants, if it is one.

    Raises
    ------
    ValueError
        No whole number from 8 to 10 000.
    """
    if isinstance(count, bool) or not isinstance(count, int) or not _FEWEST <= count <= _MOST:
        raise ValueError(f"instants = {shown(count)} is not allowed: a whole number from {_FEWEST} to {_MOST}")
    return count


_AXES = {
    **dict.fromkeys(("flexion", "flexion-extension", "fe", "f", "x"), "x"),
    **dict.fromkeys(("adduction", "abduction", "abduction-adduction", "adduction-abduction", "aa", "a", "y"), "y"),
    **dict.fromkeys(("rotation", "inward rotation", "inward-outward rotation", "ier", "ie", "r", "z"), "z"),
}


def order_of(text: Any) -> str:
    """The axes of "flexion, adduction, rotation", "FE-AA-IER" or "xyz" as they are multiplied: "xyz".

    Raises
    ------
    ValueError
        Not the three rotations, each of them once.
    """
    words = text if isinstance(text, list | tuple) else _words(text) if isinstance(text, str) else []
    axes = "".join(_AXES.get(str(word).strip().lower(), "?") for word in words)
    if sorted(axes) != ["x", "y", "z"]:
        known = "'flexion, adduction, rotation' in any order"
        raise ValueError(f"rotation_order = {shown(text)} is not allowed: {known} (R is their product from the left)")
    return axes


def _words(text: str) -> list[str]:
    parts = text.replace(";", ",").split(",") if "," in text else text.replace("-", " ").split()
    return list(parts[0].strip()) if len(parts) == 1 and len(parts[0].strip()) == 3 else parts


def half_cosines(phases: Numbers, knots: Numbers, values: Numbers) -> Numbers:
    """Between knots of a cycle each value passes into the next by half a cosine."""
    left = numpy.clip(numpy.searchsorted(knots, phases, side="right") - 1, 0, len(knots) - 2)
    share = (phases - knots[left]) / (knots[left + 1] - knots[left])
    return values[left] + (values[left + 1] - values[left]) * (1 - numpy.cos(pi * share)) / 2


_ISO_TILT = radians(30.0)
_ISO_FORCE = (numpy.array([0, 12, 32, 50, 62, 100]) / 100, numpy.array([300.0, 3000.0, 1500.0, 3000.0, 300.0, 300.0]))
_ISO_ANGLES = (
    (numpy.array([0, 50, 100]) / 100, numpy.radians([25.0, -18.0, 25.0])),
    (numpy.array([0, 21, 50, 71, 100]) / 100, numpy.radians([3.0, 7.0, -4.0, -4.0, 3.0])),
    (numpy.array([0, 50, 100]) / 100, numpy.radians([-10.0, 2.0, -10.0])),
)
_UNREAD = "the key points of ISO 14242-1 are as quoted in the literature; the standard itself was not read"


def _iso_force(phases: Numbers) -> Numbers:
    return half_cosines(phases, *_ISO_FORCE)


def _iso_generators(phases: Numbers) -> Numbers:
    """Flexion 25° to -18°, adduction 7° to -4°, inward rotation -10° to 2°, each a cosine."""
    turn = 2 * pi * phases
    flexion = 3.5 + 21.5 * numpy.cos(turn)
    adduction = 1.5 + 5.5 * numpy.cos(turn - 2 * pi * 0.21)
    rotation = -4.0 - 6.0 * numpy.cos(turn)
    return numpy.radians([flexion, adduction, rotation])


def _iso_key_points(phases: Numbers) -> Numbers:
    return numpy.stack([half_cosines(phases, *course) for course in _ISO_ANGLES])


def iso_14242_1(instants: int = INSTANTS, order: str = "xyz", key_points: Course | None = None) -> Cycle:
    """Walking as hip simulators do it (ISO 14242-1): 300 to 3000 N, the load fixed to the socket, 1 Hz.

    The angles follow smooth generators, one cosine each.

    Parameters
    ----------
    instants : int
    order : str
        Of the rotations, which the standard does not name; see `Cycle`.
    """
    return Cycle(
        name="iso-14242-1",
        force=_iso_force,
        angles=key_points or _iso_generators,
        instants=instants,
        order=order,
        cup_tilt=_ISO_TILT,
        notes=(_UNREAD,),
    )


def iso_14242_1_key_points(instants: int = INSTANTS, order: str = "xyz") -> Cycle:
    """ISO 14242-1 with half cosines between the key points of every angle; see `iso_14242_1`."""
    return replace(iso_14242_1(instants, order, _iso_key_points), name="iso-14242-1-key-points")


def flexion(instants: int = INSTANTS, order: str = "xyz") -> Cycle:
    """The force and the flexion of ISO 14242-1 alone: every track is an arc that is passed twice."""
    return Cycle(
        name="flexion",
        force=_iso_force,
        angles=lambda phases: _iso_generators(phases) * numpy.array([[1.0], [0.0], [0.0]]),
        instants=instants,
        order=order,
        cup_tilt=_ISO_TILT,
        notes=(_UNREAD,),
    )


def rocking(
    instants: int = INSTANTS, order: str = "xyz", *, amplitude: float = radians(23.0), peak: float = 2000.0
) -> Cycle:
    """Biaxial rocking: the ball's axis goes round a cone of this half angle once a cycle, without spin of its own.

    Parameters
    ----------
    instants : int
    order : str
        Changes nothing: the cone is the same.
    amplitude : float
        In rad.
    peak : float
        The force goes from 0.1 of it to all of it as a sine, in N.
    """
    order_of(order)
    return Cycle(
        name="biaxial-rocking",
        force=lambda phases: peak * (0.55 - 0.45 * numpy.cos(2 * pi * phases)),
        angles=lambda phases: _leaning(amplitude, 2 * pi * phases),
        instants=instants,
    )


def _leaning(tilt: float, around: Numbers) -> Numbers:
    """The angles about x, y and z, in this order, of turns by a tilt about level axes in these directions."""
    # R = cos γ 1 + (1 - cos γ) a aᵀ + sin γ [a], a = (cos ψ, sin ψ, 0); R02, R12, R22, R01, R00 of Rx Ry Rz
    c, s = numpy.cos(around), numpy.sin(around)
    lean, level = numpy.sin(tilt), 1 - numpy.cos(tilt)
    adduction = numpy.arcsin(lean * s)
    flexion = numpy.arctan2(lean * c, numpy.cos(tilt) + 0 * c)
    rotation = numpy.arctan2(-level * c * s, 1 - level * s * s)
    return numpy.stack([flexion, adduction, rotation])


def constant_load(
    instants: int = INSTANTS, order: str = "xyz", *, force: float = 3000.0, amplitude: float = radians(21.5)
) -> Cycle:
    """A constant load in N under flexion to both sides by an amplitude in rad."""
    return Cycle(
        name="constant-load",
        force=lambda phases: force + 0 * phases,
        angles=lambda phases: amplitude * numpy.stack([numpy.cos(2 * pi * phases), 0 * phases, 0 * phases]),
        instants=instants,
        order=order,
    )


CYCLES: Mapping[str, Callable[[int, str], Cycle]] = MappingProxyType(
    {
        "iso-14242-1": iso_14242_1,
        "iso-14242-1-key-points": iso_14242_1_key_points,
        "flexion": flexion,
        "biaxial-rocking": rocking,
        "constant-load": constant_load,
    }
)


def named_cycle(name: Any, instants: int = INSTANTS, order: str = "xyz") -> Cycle:
    """A cycle by its name; ValueError with the nearest one where there is none of that name."""
    return CYCLES[known_name("cycle", name, CYCLES)](instants, order)
