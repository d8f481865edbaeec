"""Variables of the FMU for both versions of the standard: real numbers in SI units."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from ...dynamics import ForceElement
from ..tunable import TUNABLES

UNITS: Mapping[str, Mapping[str, int]] = {
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "rad/s": {"rad": 1, "s": -1},
    "rad": {"rad": 1},
    "s": {"s": 1},
    "s/m": {"s": 1, "m": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "1": {},
}
"""Powers of the base units for each unit."""


@dataclass(frozen=True, kw_only=True)
class Variable:
    """Input, output or parameter of the FMU.

    `reference` is its number in the standard, and `needs` are the inputs that it depends on.
    """

    reference: int
    name: str
    causality: str
    unit: str
    description: str
    start: float | None = None
    needs: tuple[int, ...] = ()


_VECTORS = {
    "position": ("m", "position of the ball centre relative to the socket centre, in axes fixed to the socket"),
    "velocity": ("m/s", "velocity of the ball centre relative to the socket"),
    "spin": ("rad/s", "angular velocity of the ball relative to the socket"),
}
_LOADS = {
    "force": ("N", "force on the ball at its centre"),
    "moment": ("N.m", "moment on the ball about its centre"),
}
_SCALARS = {
    "energy": ("J", "elastic energy of the contact"),
    "half_angle": ("rad", "half angle of the contact"),
    "max_pressure": ("Pa", "largest contact pressure"),
}
_STATE, _POSITION = tuple(range(1, 10)), (1, 2, 3)


def variables(element: ForceElement) -> tuple[Variable, ...]:
    """List the variables of an FMU in the order of their references, from 1."""
    parts = [*_inputs(), *_outputs(), *_parameters(element)]
    return tuple(Variable(reference=number, **part) for number, part in enumerate(parts, 1))


def _inputs() -> Iterator[dict]:
    for name, (unit, meaning) in _VECTORS.items():
        for axis in (1, 2, 3):
            yield {"name": f"{name}[{axis}]", "causality": "input", "unit": unit, "description": meaning, "start": 0.0}


def _outputs() -> Iterator[dict]:
    for name, (unit, meaning) in _LOADS.items():
        for axis in (1, 2, 3):
            described = {"name": f"{name}[{axis}]", "unit": unit, "description": meaning}
            yield {**described, "causality": "output", "needs": _STATE}
    for name, (unit, meaning) in _SCALARS.items():
        yield {"name": name, "causality": "output", "unit": unit, "description": meaning, "needs": _POSITION}


def _parameters(element: ForceElement) -> Iterator[dict]:
    for parameter in TUNABLES:
        start = getattr(element.constants, parameter.constant) * parameter.si
        properties = {"unit": parameter.si_unit, "description": parameter.meaning, "start": start}
        yield {"name": parameter.name, "causality": "parameter", **properties}
