"""What can be tuned in an element that has left Python: what it loses."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Tunable:
    """A parameter of the exported element.

    Attributes
    ----------
    name : str
    constant : str
        What it is called among the `Constants` of a `ForceElement`.
    unit, si_unit : str
        Of the package, and of the International System.
    si : float
        One of the unit in that of the International System.
    meaning : str
    above : bool
        Whether it must be above 0; else 0 or more.
    """

    name: str
    constant: str
    unit: str
    si_unit: str
    si: float
    meaning: str
    above: bool = False


TUNABLES = (
    Tunable(
        name="hysteresis",
        constant="hysteresis",
        unit="s/mm",
        si_unit="s/m",
        si=1e3,
        meaning="damping of the contact over its force and speed",
    ),
    Tunable(
        name="retardation_time",
        constant="time",
        unit="s",
        si_unit="s",
        si=1.0,
        meaning="time of retardation of the liner",
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
        meaning="coefficient of friction of a ball that hardly moves; that of sliding where it is less",
    ),
    Tunable(
        name="transition_speed",
        constant="transition_speed",
        unit="mm/s",
        si_unit="m/s",
        si=1e-3,
        meaning="slip at which friction has 71 % of its size",
        above=True,
    ),
    Tunable(
        name="stribeck_speed",
        constant="stribeck_speed",
        unit="mm/s",
        si_unit="m/s",
        si=1e-3,
        meaning="slip over which static friction goes over into sliding",
        above=True,
    ),
    Tunable(
        name="viscous_friction",
        constant="viscous",
        unit="s/mm",
        si_unit="s/m",
        si=1e3,
        meaning="friction that is added per speed, over the force",
    ),
)
"""All of them."""
