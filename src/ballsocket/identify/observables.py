"""Custom observables: quantities that follow from a contact, such as the frequency of a small oscillation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, pi
from typing import Any

from ..contact import Contact
from ..core.arrays import Array
from ..core.checks import require
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
        Function from a contact to the values of the quantity.
    """

    described: Quantity
    read: Callable[[Contact], Any]


FREQUENCY = Quantity(
    "frequency",
    "f",
    "frequency of oscillation",
    Kind.FREQUENCY,
    "Frequency of a small oscillation of a mass about its load; the contact's stiffness is constant within it.",
)
"""Frequency of a small oscillation."""


def oscillation(mass: float) -> CustomObservable:
    """Make a custom observable for the oscillation frequency in Hz of a mass on the contact.

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

    def read(contact: Contact) -> Array:
        return (1e3 * contact.stiffness / mass) ** 0.5 / (2 * pi)  # 1e3 from N/mm to N/m

    return CustomObservable(FREQUENCY, read)
