"""Custom observables: quantities that follow from a contact, such as a frequency or a friction torque."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf, pi
from types import MappingProxyType
from typing import Any

from ..contact import Contact
from ..core.arrays import Array
from ..core.checks import degrees_hint, require
from ..core.kinds import Kind
from ..core.quantities import Quantity


@dataclass(frozen=True)
class CustomObservable:
    """Custom measured quantity that is computed from a contact.

    Attributes
    ----------
    described : Quantity
        Name, title and unit.
    read : callable
        Function from a contact, and from the `numbers` by name, to the values of the quantity.
    numbers : tuple of str
        Names of `registry.OBSERVABLE_NUMBERS` that the quantity depends on; each must be an unknown.
    """

    described: Quantity
    read: Callable[..., Any]
    numbers: tuple[str, ...] = ()


FREQUENCY = Quantity(
    "frequency",
    "f",
    "frequency of oscillation",
    Kind.FREQUENCY,
    "Frequency of a small oscillation of a mass about its load; the contact's stiffness is constant within it.",
)
"""Frequency of a small oscillation."""


def oscillation(mass: float) -> CustomObservable:
    """Make a custom observable: the frequency in Hz of a mass that oscillates on the contact.

    The frequency is sqrt(dF/dd / m) / 2π.

    Parameters
    ----------
    mass : float
        Mass in kg that moves along the load.

    Raises
    ------
    ValueError
        A mass that is not above 0 and finite.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.HessForsbach().press(bs.joints["hip-36"], force=3000.0)
    >>> round(oscillation(2.0).read(contact))
    1241
    """
    require("mass", mass, 0 < mass < inf, "a mass (kg) is above 0 and finite")

    def read_frequency(contact: Contact) -> Array:
        return (1e3 * contact.stiffness / mass) ** 0.5 / (2 * pi)  # 1e3 from N/mm to N/m

    return CustomObservable(FREQUENCY, read_frequency)


FRICTION_COEFFICIENT = Quantity(
    "friction_coefficient",
    "μ",
    "coefficient of friction",
    Kind.NUMBER,
    "Friction stress over pressure, equal at all points of the contact.",
    allows=lambda value: (value >= 0) & (value < inf),
    allowed="a coefficient of friction is 0 or more and finite",
)
"""Coefficient of friction, an unknown of data that measure a friction torque."""

FRICTION_TORQUE = Quantity(
    "friction_torque",
    "Mf",
    "friction torque",
    Kind.ENERGY,
    "Torque of Coulomb friction about an axis through the centre of the ball; every point of the contact slides.",
)
"""Torque of Coulomb friction on a sliding ball in N mm."""


def sliding_torque(axis_angle: float = pi / 2) -> CustomObservable:
    """Make a custom observable: the friction torque in N mm of a sliding ball.

    Its coefficient of friction, `friction_coefficient`, must be an unknown.

    Parameters
    ----------
    axis_angle : float
        Angle in rad between the axis of rotation and the load: π/2 is flexion, 0 is spin about the load.

    Raises
    ------
    ValueError
        An angle beyond a right angle: it describes the same axis as a smaller one.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.HessForsbach().press(bs.joints["hip-36"], force=3000.0)
    >>> round(sliding_torque().read(contact, friction_coefficient=0.05))
    2846
    """
    rule = f"the angle between axis and load is 0 to π/2 radians; {degrees_hint(axis_angle)}"
    require("axis_angle", axis_angle, 0 <= axis_angle <= pi / 2, rule)

    def read_torque(contact: Contact, friction_coefficient: Array) -> Array:
        return contact.friction_torque(friction_coefficient, axis_angle)

    return CustomObservable(FRICTION_TORQUE, read_torque, numbers=(FRICTION_COEFFICIENT.name,))


@dataclass(frozen=True)
class FileObservable:
    """Observable that a file can name as the quantity of its data, with one argument."""

    described: Quantity
    make: Callable[[float], CustomObservable]  # function from the argument to the observable
    argument: str  # key of the argument in files
    kind: Kind  # kind of the argument, which sets its units
    default: float | None = None  # default of the argument; None if a file must state it


FILE_OBSERVABLES: Mapping[str, FileObservable] = MappingProxyType(
    {
        FREQUENCY.name: FileObservable(FREQUENCY, oscillation, "mass", Kind.MASS),
        FRICTION_TORQUE.name: FileObservable(FRICTION_TORQUE, sliding_torque, "axis_angle", Kind.ANGLE, pi / 2),
    }
)
"""Observables of files by the names of their quantities."""
