"""Cycles by name: what simulators and their standards let a hip go through."""

from __future__ import annotations

from dataclasses import replace
from math import inf, pi, radians

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.deprecation import renamed_arguments
from .cycle import DEFAULT_STEPS, Course, Cycle, Spring, order_of


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
_TWO = radians(23.0), radians(6.0)
_SET_OFF = (
    "mismatch, spring and swing load are as in published tests after ISO 14242-4; the standard itself was not read"
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


@renamed_arguments(instants="n_steps")
def iso_14242_1(n_steps: int = DEFAULT_STEPS, order: str = "xyz", key_points: Course | None = None) -> Cycle:
    """Walking as hip simulators do it (ISO 14242-1): 300 to 3000 N, the load fixed to the socket, 1 Hz.

    The angles follow smooth generators, one cosine each.

    Parameters
    ----------
    n_steps : int
    order : str
        Of the rotations, which the standard does not name; see `Cycle`.
    """
    return Cycle(
        name="iso-14242-1",
        force=_iso_force,
        angles=key_points or _iso_generators,
        n_steps=n_steps,
        order=order,
        cup_tilt=_ISO_TILT,
        notes=(_UNREAD,),
    )


@renamed_arguments(instants="n_steps")
def iso_14242_1_key_points(n_steps: int = DEFAULT_STEPS, order: str = "xyz") -> Cycle:
    """ISO 14242-1 with half cosines between the key points of every angle; see `iso_14242_1`."""
    return replace(iso_14242_1(n_steps, order, _iso_key_points), name="iso-14242-1-key-points")


@renamed_arguments(instants="n_steps")
def flexion(n_steps: int = DEFAULT_STEPS, order: str = "xyz") -> Cycle:
    """The force and the flexion of ISO 14242-1 alone: every track is an arc that is passed twice."""
    return Cycle(
        name="flexion",
        force=_iso_force,
        angles=lambda phases: _iso_generators(phases) * numpy.array([[1.0], [0.0], [0.0]]),
        n_steps=n_steps,
        order=order,
        cup_tilt=_ISO_TILT,
        notes=(_UNREAD,),
    )


@renamed_arguments(instants="n_steps")
def iso_14242_4(
    n_steps: int = DEFAULT_STEPS,
    order: str = "xyz",
    *,
    mismatch: float = 4.0,
    stiffness: float = 100.0,
    swing: float = 70.0,
) -> Cycle:
    """Walking with a socket that is set off to the side (ISO 14242-4): in the swing phase a spring pulls the ball out.

    Parameters
    ----------
    n_steps : int
    order : str
        Of the rotations; see `Cycle`.
    mismatch : float
        Of the centres in mm.
    stiffness : float
        Of the spring in N/mm.
    swing : float
        The load in the swing phase, in N.
    """
    require("swing", swing, 0 < swing < inf, "a load (N) of the swing phase is positive and finite")
    knots, values = _ISO_FORCE
    return replace(
        iso_14242_1(n_steps, order),
        name="iso-14242-4",
        force=lambda phases: half_cosines(phases, knots, numpy.where(values > 300.0, values, swing)),
        spring=Spring(stiffness=stiffness, mismatch=mismatch),
        notes=(_UNREAD, _SET_OFF),
    )


@renamed_arguments(instants="n_steps")
def two_axis(n_steps: int = DEFAULT_STEPS, order: str = "xyz", *, peak: float = 2000.0) -> Cycle:
    """A simulator of two axes: flexion by 46° and adduction by 12° in all, a quarter of a cycle apart.

    Parameters
    ----------
    n_steps : int
    order : str
        Of the rotations; see `Cycle`.
    peak : float
        The force has the course of ISO 14242-1 between a fifth of it and all of it, in N.
    """
    return Cycle(
        name="two-axis",
        force=lambda phases: peak * (0.2 + 0.8 * (_iso_force(phases) - 300.0) / 2700.0),
        angles=lambda phases: numpy.stack(
            [_TWO[0] * numpy.cos(2 * pi * phases), _TWO[1] * numpy.sin(2 * pi * phases), 0 * phases]
        ),
        n_steps=n_steps,
        order=order,
        notes=("the course of the two-axis simulator is a typical one, and no machine's own",),
    )


@renamed_arguments(instants="n_steps")
def rocking(
    n_steps: int = DEFAULT_STEPS, order: str = "xyz", *, amplitude: float = radians(23.0), peak: float = 2000.0
) -> Cycle:
    """Biaxial rocking: the ball's axis goes round a cone of this half angle once a cycle, without spin of its own.

    Parameters
    ----------
    n_steps : int
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
        n_steps=n_steps,
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


@renamed_arguments(instants="n_steps")
def constant_load(
    n_steps: int = DEFAULT_STEPS, order: str = "xyz", *, force: float = 3000.0, amplitude: float = radians(21.5)
) -> Cycle:
    """A constant load in N under flexion to both sides by an amplitude in rad."""
    return Cycle(
        name="constant-load",
        force=lambda phases: force + 0 * phases,
        angles=lambda phases: amplitude * numpy.stack([numpy.cos(2 * pi * phases), 0 * phases, 0 * phases]),
        n_steps=n_steps,
        order=order,
    )
