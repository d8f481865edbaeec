"""Cycles of hip simulators and their standards."""

from __future__ import annotations

from dataclasses import replace
from math import inf, pi, radians

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.kinds import Kind
from .cycle import DEFAULT_STEPS, Cycle, CycleDefinition, CycleParameter, PhaseFunction, Spring
from .kinematics import parse_rotation_order

_ISO_TILT = radians(30.0)
_ISO_FORCE = (numpy.array([0, 12, 32, 50, 62, 100]) / 100, numpy.array([300.0, 3000.0, 1500.0, 3000.0, 300.0, 300.0]))
_ISO_ANGLES = (
    (numpy.array([0, 50, 100]) / 100, numpy.radians([25.0, -18.0, 25.0])),
    (numpy.array([0, 21, 50, 71, 100]) / 100, numpy.radians([3.0, 7.0, -4.0, -4.0, 3.0])),
    (numpy.array([0, 50, 100]) / 100, numpy.radians([-10.0, 2.0, -10.0])),
)
_ISO_PEAK = 3000.0
_ISO_FLEXION_MIDDLE, _ISO_FLEXION_AMPLITUDE = 3.5, 21.5  # in degrees
_MISMATCH_NOTE = (
    "mismatch, spring and swing load are taken from published tests after ISO 14242-4, not from the standard itself"
)
_ISO_NOTE = "the key points of ISO 14242-1 are taken from publications, not from the standard itself"
_TWO_AXIS_NOTE = "the waveform of the two-axis simulator is a typical one, not that of a specific machine"


def half_cosines(phases: Numbers, knots: Numbers, values: Numbers) -> Numbers:
    """Interpolate between values at knots of a cycle by half cosines, with zero slope at each knot."""
    interval = numpy.clip(numpy.searchsorted(knots, phases, side="right") - 1, 0, len(knots) - 2)
    fraction = (phases - knots[interval]) / (knots[interval + 1] - knots[interval])
    return values[interval] + (values[interval + 1] - values[interval]) * (1 - numpy.cos(pi * fraction)) / 2


def _iso_14242_1_force(phases: Numbers) -> Numbers:
    return half_cosines(phases, *_ISO_FORCE)


def _iso_14242_1_angles(phases: Numbers) -> Numbers:
    """Compute flexion of 25° to -18°, adduction of 7° to -4° and rotation of -10° to 2° in rad, one cosine each."""
    cycle_angle = 2 * pi * phases
    flexion = 3.5 + 21.5 * numpy.cos(cycle_angle)
    adduction = 1.5 + 5.5 * numpy.cos(cycle_angle - 2 * pi * 0.21)
    rotation = -4.0 - 6.0 * numpy.cos(cycle_angle)
    return numpy.radians([flexion, adduction, rotation])


def iso_14242_1(n_steps: int = DEFAULT_STEPS, order: str = "xyz", angles: PhaseFunction | None = None) -> Cycle:
    """Create the walking cycle of hip simulators (ISO 14242-1): 300 to 3000 N along a line fixed to the socket, 1 Hz.

    Each angle is one cosine.

    Parameters
    ----------
    n_steps, order
        As in `Cycle`; the standard does not state the order.
    angles : function, optional
        Rotations that replace the cosines; see `Cycle`.
    """
    return Cycle(
        name="iso-14242-1",
        force=_iso_14242_1_force,
        angles=angles or _iso_14242_1_angles,
        n_steps=n_steps,
        order=order,
        cup_tilt=_ISO_TILT,
        notes=(_ISO_NOTE,),
    )


def iso_14242_1_key_points(n_steps: int = DEFAULT_STEPS, order: str = "xyz") -> Cycle:
    """Create the cycle of ISO 14242-1 with half cosines between the key points of each angle; see `iso_14242_1`."""
    return replace(
        iso_14242_1(n_steps, order),
        name="iso-14242-1-key-points",
        angles=lambda phases: numpy.stack([half_cosines(phases, *key_points) for key_points in _ISO_ANGLES]),
    )


def flexion(
    n_steps: int = DEFAULT_STEPS,
    order: str = "xyz",
    *,
    peak: float = _ISO_PEAK,
    amplitude: float = radians(_ISO_FLEXION_AMPLITUDE),
) -> Cycle:
    """Create a cycle with the force and the flexion of ISO 14242-1 only: each track is an arc, passed twice.

    Parameters
    ----------
    n_steps, order
        As in `Cycle`.
    peak : float
        Largest force in N. The other forces of ISO 14242-1 change in proportion.
    amplitude : float
        Amplitude of the flexion in rad about its middle of 3.5°.
    """
    force_ratio, angle_ratio = peak / _ISO_PEAK, amplitude / radians(_ISO_FLEXION_AMPLITUDE)
    middle = radians(_ISO_FLEXION_MIDDLE)

    def flexion_angles(phases: Numbers) -> Numbers:
        angles = _iso_14242_1_angles(phases) * numpy.array([[1.0], [0.0], [0.0]])
        if angle_ratio != 1:
            angles[0] = middle + angle_ratio * (angles[0] - middle)
        return angles

    return Cycle(
        name="flexion",
        force=lambda phases: force_ratio * _iso_14242_1_force(phases),
        angles=flexion_angles,
        n_steps=n_steps,
        order=order,
        cup_tilt=_ISO_TILT,
        notes=(_ISO_NOTE,),
    )


def iso_14242_4(
    n_steps: int = DEFAULT_STEPS,
    order: str = "xyz",
    *,
    mismatch: float = 4.0,
    stiffness: float = 100.0,
    swing_load: float = 70.0,
) -> Cycle:
    """Create the walking cycle with lateral mismatch (ISO 14242-4): a spring pulls the ball out in the swing phase.

    Parameters
    ----------
    n_steps, order
        As in `Cycle`.
    mismatch : float
        Offset of the centres in mm.
    stiffness : float
        Stiffness of the spring in N/mm.
    swing_load : float
        Load in the swing phase in N.
    """
    require("swing_load", swing_load, 0 < swing_load < inf, "a load (N) of the swing phase is positive and finite")
    knots, values = _ISO_FORCE
    return replace(
        iso_14242_1(n_steps, order),
        name="iso-14242-4",
        force=lambda phases: half_cosines(phases, knots, numpy.where(values > 300.0, values, swing_load)),
        spring=Spring(stiffness=stiffness, mismatch=mismatch),
        notes=(_ISO_NOTE, _MISMATCH_NOTE),
    )


def two_axis(
    n_steps: int = DEFAULT_STEPS,
    order: str = "xyz",
    *,
    peak: float = 2000.0,
    amplitude: float = radians(23.0),
) -> Cycle:
    """Create the cycle of a two-axis simulator: flexion over 46° and adduction over 12°, a quarter of a cycle apart.

    Parameters
    ----------
    n_steps, order
        As in `Cycle`.
    peak : float
        Largest force in N. The force has the waveform of ISO 14242-1, between a fifth of the peak and the peak.
    amplitude : float
        Amplitude of the flexion in rad. That of the adduction stays 6°.
    """
    return Cycle(
        name="two-axis",
        force=lambda phases: peak * (0.2 + 0.8 * (_iso_14242_1_force(phases) - 300.0) / 2700.0),
        angles=lambda phases: numpy.stack(
            [amplitude * numpy.cos(2 * pi * phases), radians(6.0) * numpy.sin(2 * pi * phases), 0 * phases]
        ),
        n_steps=n_steps,
        order=order,
        notes=(_TWO_AXIS_NOTE,),
    )


def rocking(
    n_steps: int = DEFAULT_STEPS, order: str = "xyz", *, amplitude: float = radians(23.0), peak: float = 2000.0
) -> Cycle:
    """Create the biaxial rocking cycle: the ball's axis moves on a cone once a cycle, and the ball does not spin.

    Parameters
    ----------
    n_steps, order
        As in `Cycle`; the order has no effect on this motion.
    amplitude : float
        Half angle of the cone in rad.
    peak : float
        Largest force in N. The force is a sine between a tenth of the peak and the peak.
    """
    parse_rotation_order(order)

    def angles(phases: Numbers) -> Numbers:
        """Convert rotations by the amplitude about horizontal axes at an azimuth into angles about x, y and z."""
        # R = cos γ 1 + (1 - cos γ) a aᵀ + sin γ [a], a = (cos ψ, sin ψ, 0); R02, R12, R22, R01, R00 of Rx Ry Rz
        c, s = numpy.cos(2 * pi * phases), numpy.sin(2 * pi * phases)
        sine, versine = numpy.sin(amplitude), 1 - numpy.cos(amplitude)
        adduction = numpy.arcsin(sine * s)
        flexion = numpy.arctan2(sine * c, numpy.cos(amplitude) + 0 * c)
        rotation = numpy.arctan2(-versine * c * s, 1 - versine * s * s)
        return numpy.stack([flexion, adduction, rotation])

    return Cycle(
        name="biaxial-rocking",
        force=lambda phases: peak * (0.55 - 0.45 * numpy.cos(2 * pi * phases)),
        angles=angles,
        n_steps=n_steps,
    )


def constant_load(
    n_steps: int = DEFAULT_STEPS, order: str = "xyz", *, force: float = 3000.0, amplitude: float = radians(21.5)
) -> Cycle:
    """Create a cycle of constant load with flexion to both sides.

    Parameters
    ----------
    n_steps, order
        As in `Cycle`.
    force : float
        Load in N.
    amplitude : float
        Amplitude of the flexion in rad.
    """
    return Cycle(
        name="constant-load",
        force=lambda phases: force + 0 * phases,
        angles=lambda phases: amplitude * numpy.stack([numpy.cos(2 * pi * phases), 0 * phases, 0 * phases]),
        n_steps=n_steps,
        order=order,
    )


_LARGEST_FORCE = "largest force of the cycle"
_PEAK = CycleParameter(key="force", argument="peak", kind=Kind.FORCE, meaning=_LARGEST_FORCE)
_AMPLITUDE = CycleParameter(key="amplitude", argument="amplitude", kind=Kind.ANGLE, meaning="amplitude of the rotation")

SIMULATOR_CYCLES = (
    CycleDefinition(name="iso-14242-1", make=iso_14242_1, source=_ISO_NOTE),
    CycleDefinition(name="iso-14242-1-key-points", make=iso_14242_1_key_points, source=_ISO_NOTE),
    CycleDefinition(
        name="iso-14242-4",
        make=iso_14242_4,
        source=_MISMATCH_NOTE,
        parameters=(
            CycleParameter(key="mismatch", argument="mismatch", kind=Kind.LENGTH, meaning="offset of the centres"),
            CycleParameter(
                key="stiffness", argument="stiffness", kind=Kind.STIFFNESS, meaning="stiffness of the lateral spring"
            ),
            CycleParameter(key="swing_load", argument="swing_load", kind=Kind.FORCE, meaning="load in the swing phase"),
        ),
    ),
    CycleDefinition(name="flexion", make=flexion, source=_ISO_NOTE, parameters=(_PEAK, _AMPLITUDE)),
    CycleDefinition(
        name="biaxial-rocking",
        make=rocking,
        source="biaxial rocking simulator: constant tilt about a revolving axis, sinusoidal load",
        parameters=(_PEAK, _AMPLITUDE),
    ),
    CycleDefinition(name="two-axis", make=two_axis, source=_TWO_AXIS_NOTE, parameters=(_PEAK, _AMPLITUDE)),
    CycleDefinition(
        name="constant-load",
        make=constant_load,
        source="analytic cycle: constant load, sinusoidal flexion",
        parameters=(CycleParameter(key="force", argument="force", kind=Kind.FORCE, meaning=_LARGEST_FORCE), _AMPLITUDE),
    ),
)
"""Cycles of simulators and their standards, with loads in N."""
