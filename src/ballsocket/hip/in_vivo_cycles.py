"""Cycles from loads measured in patients, as multiples of body weight."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import pi, radians
from types import MappingProxyType

import numpy

from ..core.arrays import Numbers
from ..core.checks import known_name, require
from ..core.display import plain_number
from .cycle import DEFAULT_STEPS, Cycle, CycleDefinition, PhaseFunction
from .simulator_cycles import iso_14242_1

_ISO_WALKING = iso_14242_1()
_ISO_ASSUMPTION = "waveform and motion are those of ISO 14242-1"
_MAX_BODY_WEIGHT = 1e4  # largest allowed body weight in N
_UNLOADED_SHARE = 0.1  # force of the muscles on an unloaded leg, as a share of the peak


def _single_peak_waveform(end: float) -> PhaseFunction:
    """Make a force waveform with one peak between phase 0 and `end`, constant and small afterwards."""
    return lambda phases: (
        _UNLOADED_SHARE + (1 - _UNLOADED_SHARE) * numpy.sin(pi * numpy.minimum(phases / end, 1.0)) ** 2
    )


def _zero_angles(phases: Numbers) -> Numbers:
    return numpy.zeros((3, len(phases)))


@dataclass(frozen=True, kw_only=True)
class InVivo:
    """Activity with a measured peak load, and an assumed waveform and motion."""

    percent: float  # peak force in percent of body weight
    source: str  # publication of the peak force
    # function from phases to the force as a share of the peak
    waveform: Callable[[Numbers], Numbers] = lambda phases: numpy.asarray(_ISO_WALKING.force(phases)) / 3000.0
    # function from phases to flexion, adduction and rotation (3, n) in rad
    angles: Callable[[Numbers], Numbers] = _ISO_WALKING.angles
    duration: float = 1.0  # duration in s
    assumption: str = _ISO_ASSUMPTION  # assumed waveform and motion, in words


_BERGMANN_2016 = "ten instrumented implants, Bergmann 2016, 10.1371/journal.pone.0155612"
_BERGMANN_2001 = "average patient, Bergmann 2001, 10.1016/S0021-9290(01)00040-9"
_BERGMANN_1993 = "Bergmann 1993, 10.1016/0021-9290(93)90058-M"

_ACTIVITIES: Mapping[str, InVivo] = MappingProxyType(
    {
        "walking": InVivo(percent=247, source=_BERGMANN_2016),
        "one-leg-stance": InVivo(
            percent=261,
            source=_BERGMANN_2016,
            waveform=_single_peak_waveform(1.0),
            angles=_zero_angles,
            duration=4.0,
            assumption="one peak, without motion",
        ),
        "stand-up": InVivo(
            percent=215,
            source=_BERGMANN_2016,
            waveform=lambda phases: _single_peak_waveform(0.5)(phases % 0.5),
            angles=lambda phases: radians(80.0) * numpy.stack([numpy.cos(pi * phases) ** 2, 0 * phases, 0 * phases]),
            duration=6.0,
            assumption="standing up and sitting down with 80° of flexion, one peak each",
        ),
        "average-walking": InVivo(percent=238, source=_BERGMANN_2001),
        "stairs-up": InVivo(percent=251, source=_BERGMANN_2001),
        "stairs-down": InVivo(percent=260, source=_BERGMANN_2001),
        "jogging": InVivo(
            percent=550,
            source=_BERGMANN_1993,
            waveform=_single_peak_waveform(0.35),
            duration=0.7,
            assumption="one peak over 35 % of the cycle, motion of ISO 14242-1",
        ),
        "stumbling": InVivo(
            percent=870,
            source=f"{_BERGMANN_1993}, 720 to 870",
            waveform=_single_peak_waveform(0.35),
            angles=_zero_angles,
            assumption="one peak, without motion",
        ),
    }
)


def check_body_weight(body_weight: float) -> float:
    """Check a body weight in N and return it; ValueError if it is not between 0 and 10 kN."""
    allowed = f"a body weight is above 0 and at most {plain_number(_MAX_BODY_WEIGHT)} N"
    require("body_weight", body_weight, 0 < body_weight <= _MAX_BODY_WEIGHT, allowed)
    return body_weight


def in_vivo(name: str, body_weight: float, n_steps: int = DEFAULT_STEPS, order: str = "xyz") -> Cycle:
    """Create the cycle of an activity, such as "walking", from a peak load measured in patients.

    Only the peak force was measured; the notes state the assumed waveform and motion.

    Parameters
    ----------
    name : str
        "walking", "one-leg-stance", "stand-up", "average-walking", "stairs-up", "stairs-down", "jogging" or
        "stumbling".
    body_weight : float
        Body weight in N.
    n_steps, order
        As in `Cycle`.

    Raises
    ------
    ValueError
        The name is unknown (the message suggests the closest one), or the body weight is out of range.

    Examples
    --------
    >>> round(in_vivo("walking", body_weight=880.0).largest_force)
    2174
    """
    check_body_weight(body_weight)
    key = known_name("load", name, _ACTIVITIES)
    load = _ACTIVITIES[key]
    peak = load.percent / 100 * body_weight
    return Cycle(
        name=key,
        force=lambda phases: peak * load.waveform(phases),
        angles=load.angles,
        n_steps=n_steps,
        order=order,
        duration=load.duration,
        notes=(f"{key}: a peak of {load.percent:g} % of body weight ({load.source}); assumed: {load.assumption}",),
    )


IN_VIVO_CYCLES = tuple(
    CycleDefinition(name=name, make=partial(in_vivo, name), source=load.source, per_body_weight=True)
    for name, load in _ACTIVITIES.items()
)
"""Cycles of the activities, with loads in multiples of body weight."""
