"""Variables of an FMU in SI units."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ...dynamics import ContactState, ForceElement, PreloadedElement
from ..tunable import Tunable, joint_tunables, reason_of_fixed_joint, tunables_of

UNITS: Mapping[str, Mapping[str, int]] = {
    "m": {"m": 1},
    "m/s": {"m": 1, "s": -1},
    "rad/s": {"rad": 1, "s": -1},
    "rad": {"rad": 1},
    "s": {"s": 1},
    "s/m": {"s": 1, "m": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/s": {"kg": 1, "m": 1, "s": -3},
    "N.m": {"kg": 1, "m": 2, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "Pa": {"kg": 1, "m": -1, "s": -2},
    "1": {},
    "m/s2": {"m": 1, "s": -2},
    "rad/s2": {"rad": 1, "s": -2},
    "kg": {"kg": 1},
    "kg.m2": {"kg": 1, "m": 2},
}
"""Powers of the base units for each unit."""

_MM = 1e-3


@dataclass(frozen=True, kw_only=True)
class Variable:
    """Input, output, state, rate of a state, parameter or constant of the FMU.

    `reference` is its number in the standard, and `needs` are the inputs and states that it depends on. `state` is the
    reference of the state whose rate it is, 0 for others.
    """

    reference: int
    name: str
    causality: str
    unit: str
    description: str
    variability: str = "continuous"
    start: float | None = None
    needs: tuple[int, ...] = ()
    state: int = 0

    @property
    def is_exact(self) -> bool:
        """True for a state, a parameter or a constant, whose start value is exact."""
        return self.start is not None and self.causality != "input"


_STATUSES = [f"{state.value} {state.name.lower().replace('_', ' ')}" for state in ContactState]
_MOTION = {
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
    "status": ("1", f"status of the contact: {', '.join(_STATUSES)}"),
}
_INTERNAL_STATES = {
    "deflection": ("m", "deflection of the bristles: along the axes of the socket, and the arc about the load"),
    "relaxed_force": ("N", "relaxed force of a term of the liner"),
}
_APPLIED = {
    "applied_force": ("N", "applied force on the ball at its centre, in axes of the socket, which is at rest"),
    "applied_torque": ("N.m", "applied torque on the ball"),
}
_BALL = {"mass": ("kg", "mass of the ball"), "inertia": ("kg.m2", "moment of inertia of the ball about its centre")}
_RATES = {"m": "m/s", "m/s": "m/s2", "rad/s": "rad/s2", "N": "N/s"}
"""Units of the rates of states by those of the states."""


def variables(element: ForceElement | PreloadedElement, ball_mass: float | None = None) -> tuple[Variable, ...]:
    """List all variables of an FMU in the order of their reference numbers, from 1.

    A ball inside, of a mass in kg, has its motion as states; without a ball the motion is an input.
    """
    values = _values(element, ball_mass)
    state = tuple(range(1, 10 + sum(element.internal_states.values())))
    outputs = [
        *_components(_LOADS, causality="output", needs=state),
        *({**each, "causality": "output", "needs": (1, 2, 3)} for each in _properties(_SCALARS)),
    ]
    rates = [
        {
            "name": f"der({value['name']})",
            "causality": "local",
            "unit": _RATES[value["unit"]],
            "description": f"rate of {value['name']}",
            "needs": tuple(range(1, len(values) + 1)),
            "state": number,
        }
        for number, value in enumerate(values, 1)
        if value["causality"] != "input"
    ]
    rows = [*values, *outputs, *rates, *_parameters(element, ball_mass)]
    return tuple(Variable(reference=reference, **row) for reference, row in enumerate(rows, 1))


def _values(element: ForceElement | PreloadedElement, ball_mass: float | None) -> list[dict]:
    """List the properties of position, velocity and spin, of internal states, and of the load on a ball inside."""
    position = element.rest_position if isinstance(element, PreloadedElement) else (0.0, 0.0, 0.0)
    starts = (*(_MM * component for component in position), *(0.0,) * 6)
    motion = [
        {**each, "start": start}
        | ({"causality": "input"} if ball_mass is None else {"causality": "output", "needs": (number,)})
        for number, (each, start) in enumerate(zip(_components(_MOTION), starts, strict=True), 1)
    ]
    internal = [
        each
        for name, count in element.internal_states.items()
        for each in _components({name: _INTERNAL_STATES[name]}, count, causality="local", start=0.0)
    ]
    return [*motion, *internal, *(_components(_APPLIED, causality="input", start=0.0) if ball_mass else ())]


def _parameters(element: ForceElement | PreloadedElement, ball_mass: float | None) -> Iterator[dict]:
    """Yield the properties of parameters, and of constants with the reason why they are no parameters."""
    tunable = {"causality": "parameter", "variability": "tunable"}
    for parameter in tunables_of(element):
        yield {**_parameter_properties(parameter, element), **tunable}
    if ball_mass is not None:
        inertia = 0.4 * ball_mass * (_MM * element.constants.ball_radius) ** 2
        for properties, start in zip(_properties(_BALL), (ball_mass, inertia), strict=True):
            yield {**properties, **tunable, "start": start}
    if reason := reason_of_fixed_joint(element):
        for parameter in joint_tunables(element):
            properties = _parameter_properties(parameter, element)
            meaning = f"{properties['description']}; fixed: {reason}"
            yield {**properties, "causality": "local", "variability": "constant", "description": meaning}


def _properties(quantities: Mapping[str, tuple[str, str]]) -> Iterator[dict]:
    for name, (unit, meaning) in quantities.items():
        yield {"name": name, "unit": unit, "description": meaning}


def _components(quantities: Mapping[str, tuple[str, str]], count: int = 3, **common: Any) -> Iterator[dict]:
    """Yield the properties of the components of vectors."""
    for each in _properties(quantities):
        for number in range(1, count + 1):
            yield {**each, "name": f"{each['name']}[{number}]", **common}


def _parameter_properties(parameter: Tunable, element: ForceElement | PreloadedElement) -> dict:
    """Return name, unit, meaning and start value of a parameter in SI units."""
    start = parameter.value(element) * parameter.si
    return {"name": parameter.name, "unit": parameter.si_unit, "description": parameter.meaning, "start": start}
