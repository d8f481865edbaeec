"""Parameters of damping and friction that stay adjustable in exported elements."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Tunable:
    """Adjustable parameter of an exported element."""

    name: str
    constant: str  # field of the `Constants` of a `ForceElement`
    # unit in this package and in the International System
    unit: str
    si_unit: str
    si: float  # size of `unit` in `si_unit`
    meaning: str
    above: bool = False  # True for a parameter above 0; false for 0 or more


TUNABLES = (
    Tunable(
        name="hysteresis",
        constant="hysteresis",
        unit="s/mm",
        si_unit="s/m",
        si=1e3,
        meaning="damping force per contact force and speed",
    ),
    Tunable(
        name="retardation_time",
        constant="time",
        unit="s",
        si_unit="s",
        si=1.0,
        meaning="retardation time of the liner",
    ),
    Tunable(
        name="friction_coefficient",
        constant="sliding",
        unit="1",
        si_unit="1",
        si=1.0,
        meaning="coefficient of sliding friction",
    ),
    Tunable(
        name="static_coefficient",
        constant="static",
        unit="1",
        si_unit="1",
        si=1.0,
        meaning="static coefficient of friction, at least that of sliding",
    ),
    Tunable(
        name="transition_speed",
        constant="transition_speed",
        unit="mm/s",
        si_unit="m/s",
        si=1e-3,
        meaning="slip speed at which friction reaches 71 %",
        above=True,
    ),
    Tunable(
        name="stribeck_speed",
        constant="stribeck_speed",
        unit="mm/s",
        si_unit="m/s",
        si=1e-3,
        meaning="slip speed of the transition from static to sliding friction",
        above=True,
    ),
    Tunable(
        name="viscous_friction",
        constant="viscous",
        unit="s/mm",
        si_unit="s/m",
        si=1e3,
        meaning="viscous friction per contact force and speed",
    ),
)
"""Adjustable parameters of every exported element, in the order of the C structure."""
