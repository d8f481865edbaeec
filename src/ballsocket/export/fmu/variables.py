"""The variables of the unit: one list for both versions of the standard, all of them real numbers in SI units."""

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
"""Units by their names, as powers of the base units."""


@dataclass(frozen=True, kw_only=True)
class Variable:
    """An input, output or parameter; `reference` is by what hosts ask for it, `needs` the inputs it depends on."""

    reference: int
    name: str
    causality: str
    unit: str
    description: str
    start: float | None = None
    needs: tuple[int, ...] = ()


_VECTORS = {
    "position": ("m", "of the ball's centre from the socket's, in axes fixed to the socket"),
    "velocity": ("m/s", "of the ball's centre as it is seen from the socket"),
    "spin": ("rad/s", "angular velocity of the ball less that of the socket"),
}
_LOADS = {
    "force": ("N", "on the ball, at its centre"),
    "moment": ("N.m", "on the ball about its centre"),
}
_SCALARS = {
    "energy": ("J", "stored in the contact"),
    "half_angle": ("rad", "of the contact"),
    "max_pressure": ("Pa", "of the contact"),
}
_ALL, _PLACE = tuple(range(1, 10)), (1, 2, 3)


def variables(element: ForceElement) -> tuple[Variable, ...]:
    """All variables of an element, in the order of their references from 1 on."""
    parts = [*_inputs(), *_outputs(), *_parameters(element)]
    return tuple(Variable(reference=number, **part) for number, part in enumerate(parts, 1))


def _inputs() -> Iterator[dict]:
    for name, (unit, about) in _VECTORS.items():
        for axis in (1, 2, 3):
            yield {"name": f"{name}[{axis}]", "causality": "input", "unit": unit, "description": about, "start": 0.0}


def _outputs() -> Iterator[dict]:
    for name, (unit, about) in _LOADS.items():
        for axis in (1, 2, 3):
            described = {"name": f"{name}[{axis}]", "unit": unit, "description": about}
            yield {**described, "causality": "output", "needs": _ALL}
    for name, (unit, about) in _SCALARS.items():
        yield {"name": name, "causality": "output", "unit": unit, "description": about, "needs": _PLACE}


def _parameters(element: ForceElement) -> Iterator[dict]:
    for each in TUNABLES:
        start = getattr(element.constants, each.constant) * each.si
        about = {"unit": each.si_unit, "description": each.meaning, "start": start}
        yield {"name": each.name, "causality": "parameter", **about}
