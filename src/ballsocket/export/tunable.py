"""Parameters of damping and friction that stay adjustable in exported elements."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
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


# name, constant, unit here, unit and factor in the International System, meaning
TUNABLES = (
    Tunable("hysteresis", "hysteresis", "s/mm", "s/m", 1e3, "damping force per contact force and speed"),
    Tunable("retardation_time", "time", "s", "s", 1.0, "retardation time of the liner"),
    Tunable("friction_coefficient", "sliding", "1", "1", 1.0, "coefficient of sliding friction"),
    Tunable("static_coefficient", "static", "1", "1", 1.0, "static coefficient of friction, at least that of sliding"),
    Tunable(
        "transition_speed",
        "transition_speed",
        "mm/s",
        "m/s",
        1e-3,
        "slip speed at which friction reaches 71 %",
        above=True,
    ),
    Tunable(
        "stribeck_speed",
        "stribeck_speed",
        "mm/s",
        "m/s",
        1e-3,
        "slip speed of the transition from static to sliding friction",
        above=True,
    ),
    Tunable("viscous_friction", "viscous", "s/mm", "s/m", 1e3, "viscous friction per contact force and speed"),
)
"""Adjustable parameters of every exported element, in the order of the C structure."""
