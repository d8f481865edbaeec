"""Loads that were measured in patients, as multiples of their weight."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi, radians
from types import MappingProxyType

import numpy

from ..core.arrays import Numbers
from ..core.checks import known_name, require
from ..core.deprecation import renamed_arguments
from .cycle import DEFAULT_STEPS, Cycle
from .gait import iso_14242_1

_WALK = iso_14242_1()
_STEP = "course and motion are those of ISO 14242-1"
_HEAVIEST = 1e4
_REST = 0.1
"""Of the peak: what the muscles keep up while a leg is not loaded."""


def _step(phases: Numbers) -> Numbers:
    return numpy.asarray(_WALK.force(phases)) / 3000.0


def _hump(end: float) -> Callable[[Numbers], Numbers]:
    """One hump up to a phase, then little."""
    return lambda phases: _REST + (1 - _REST) * numpy.sin(pi * numpy.minimum(phases / end, 1.0)) ** 2


def _still(phases: Numbers) -> Numbers:
    return numpy.zeros((3, len(phases)))


def _rise(phases: Numbers) -> Numbers:
    """From a chair, flexed by 80°, and back."""
    return radians(80.0) * numpy.stack([numpy.cos(pi * phases) ** 2, 0 * phases, 0 * phases])


@dataclass(frozen=True, kw_only=True)
class InVivo:
    """A load as it was measured, and what is assumed of the rest of its cycle.

    Attributes
    ----------
    percent : float
        The peak, of the body's weight.
    source : str
    course : function
        From phases to shares of the peak.
    angles : function
        From phases to flexion, adduction and rotation (3, n) in rad.
    duration : float
        In s.
    assumed : str
    """

    percent: float
    source: str
    course: Callable[[Numbers], Numbers] = _step
    angles: Callable[[Numbers], Numbers] = _WALK.angles
    duration: float = 1.0
    assumed: str = _STEP


_HIP_III = "ten instrumented implants, Bergmann 2016, 10.1371/journal.pone.0155612"
_HIP_98 = "average patient, Bergmann 2001, 10.1016/S0021-9290(01)00040-9"
_FIRST = "Bergmann 1993, 10.1016/0021-9290(93)90058-M"

IN_VIVO: Mapping[str, InVivo] = MappingProxyType(
    {
        "walking": InVivo(percent=247, source=_HIP_III),
        "one-leg-stance": InVivo(
            percent=261,
            source=_HIP_III,
            course=_hump(1.0),
            angles=_still,
            duration=4.0,
            assumed="one hump, without motion",
        ),
        "stand-up": InVivo(
            percent=215,
            source=_HIP_III,
            course=lambda phases: _hump(0.5)(phases % 0.5),
            angles=_rise,
            duration=6.0,
            assumed="up from a chair and down again, flexed by 80°, a hump each",
        ),
        "average-walking": InVivo(percent=238, source=_HIP_98),
        "stairs-up": InVivo(percent=251, source=_HIP_98),
        "stairs-down": InVivo(percent=260, source=_HIP_98),
        "jogging": InVivo(
            percent=550,
            source=_FIRST,
            course=_hump(0.35),
            duration=0.7,
            assumed="one hump of 35 % of the cycle, motion of ISO 14242-1",
        ),
        "stumbling": InVivo(
            percent=870,
            source=f"{_FIRST}, 720 to 870",
            course=_hump(0.35),
            angles=_still,
            assumed="one hump, without motion",
        ),
    }
)


def check_weight(weight: float) -> float:
    """A body's weight in N, if it is one; ValueError elsewhere."""
    require("body_weight", weight, 0 < weight <= _HEAVIEST, f"a body weighs more than 0 and at most {_HEAVIEST:g} N")
    return weight


@renamed_arguments(instants="n_steps")
def in_vivo(name: str, body_weight: float, n_steps: int = DEFAULT_STEPS, order: str = "xyz") -> Cycle:
    """A load that was measured in patients, upwards in the body: walking, stairs, jogging, stumbling and others.

    Only the peak was measured so; what is assumed of course and motion stands in the notes.

    Parameters
    ----------
    name : str
        "walking", "one-leg-stance", "stand-up", "average-walking", "stairs-up", "stairs-down", "jogging", "stumbling".
    body_weight : float
        In N.
    n_steps, order
        As of `Cycle`.

    Raises
    ------
    ValueError
        None of that name, with the nearest one; a weight that is none.

    Examples
    --------
    >>> round(in_vivo("walking", body_weight=880.0).largest_force)
    2174
    """
    check_weight(body_weight)
    key = known_name("load", name, IN_VIVO)
    load = IN_VIVO[key]
    peak = load.percent / 100 * body_weight
    return Cycle(
        name=key,
        force=lambda phases: peak * load.course(phases),
        angles=load.angles,
        n_steps=n_steps,
        order=order,
        duration=load.duration,
        notes=(f"{key}: a peak of {load.percent:g} % of body weight ({load.source}); assumed: {load.assumed}",),
    )
