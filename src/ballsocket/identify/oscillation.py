"""The frequency of a small oscillation as a measured quantity."""

from __future__ import annotations

from math import inf, pi

from ..contact import Contact
from ..core.arrays import Array
from ..core.checks import require
from ..core.kinds import Kind
from ..core.quantities import Quantity
from .measured import Own

FREQUENCY = Quantity(
    "frequency",
    "f",
    "frequency of oscillation",
    Kind.FREQUENCY,
    "Of a small oscillation of a mass about its load, across which the contact's stiffness does not change.",
)
"""How it is told."""


def oscillation(mass: float) -> Own:
    """The frequency in Hz at which a mass swings on a contact: sqrt(dF/dd / m) / 2π.

    Parameters
    ----------
    mass : float
        In kg, of what moves along the load.

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

    return Own(FREQUENCY, read)
