"""Element types and element sizes of ball and socket."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import inf, pi

from ...core.arrays import is_plain_number
from ...core.checks import check_numeric, require, shown
from .shapes import Resolution

_CLASS_COUNT = 24
_CLASS_RATIO = 2**-0.5  # of a class's narrowest contact to its widest
_DEFAULT_ELEMENTS = 60
_MIN_ELEMENTS = 12  # in the narrowest contact of a uniform mesh
_REACH_FACTOR = 1.2  # of a class's widest contact: extent of its small elements


class Element(Enum):
    """Type of quadrilateral elements, by the degree of their displacements; neither locks near ν = ½."""

    BILINEAR = 1
    BIQUADRATIC = 2


@dataclass(frozen=True, kw_only=True)
class Adapted:
    """Elements adapted to the width of the contact, larger away from it.

    Contacts are sorted into classes, each 0.7 times as wide as the previous one and with its own mesh. A contact
    therefore spans between 0.7 times `elements` and `elements`, or more for a thin liner: an element is at most a
    quarter of the liner thickness.

    Parameters
    ----------
    elements : int
        Number of elements along the widest contact of each class, from the pole to its edge; an even number from 24 on.
        Default 60.
    growth : float
        Ratio of the lengths of successive elements of the coarse mesh away from the contact, 1 to 2. It applies to 60
        elements; more elements grow more slowly.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    """

    elements: int = _DEFAULT_ELEMENTS
    growth: float = 1.3

    def __post_init__(self) -> None:
        valid = isinstance(self.elements, int) and self.elements >= 24 and self.elements % 2 == 0
        require("elements", self.elements, valid, "the number of elements along a contact must be even and at least 24")
        _check_growth(self.growth)

    def classes(self, reach: float, radius: float) -> tuple[float, ...]:
        """Compute the limits of the classes of contacts: half angles in rad, descending."""
        return tuple(reach * _CLASS_RATIO**number for number in range(_CLASS_COUNT + 1))

    def coarse(self, widest: float, radius: float, thickness: float, order: int) -> Resolution:
        """Compute the element sizes of the coarse mesh of a class; the fine mesh halves them."""
        scale = _DEFAULT_ELEMENTS / self.elements
        return Resolution(
            size=min(2 * widest / self.elements, scale * thickness / (2 * radius)),
            reach=_REACH_FACTOR * widest,
            growth=self.growth**scale,
            widest=scale * pi / 12,
            deepest=min(scale / 3, 0.5),
            order=order,
        )


@dataclass(frozen=True, kw_only=True)
class Uniform:
    """Elements of one size along both surfaces, independent of the contact.

    Parameters
    ----------
    size : float
        Element size in mm. Heß & Forsbach (2021) used 0.05 mm.
    growth : float
        Ratio of the depths of successive elements of the coarse mesh away from the contact, 1 to 2.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    """

    size: float
    growth: float = 1.03

    def __post_init__(self) -> None:
        if not is_plain_number(check_numeric("size", self.size)):
            raise TypeError(f"size must be one number, got {shown(self.size)}")
        require("size", self.size, 0 < self.size < inf, "an element size (mm) must be above 0 and finite")
        _check_growth(self.growth)

    def classes(self, reach: float, radius: float) -> tuple[float, ...]:
        """Compute the limits of the single class of contacts: half angles in rad, descending."""
        return (reach, min(_MIN_ELEMENTS * self.size / radius, reach / 2))

    def coarse(self, widest: float, radius: float, thickness: float, order: int) -> Resolution:
        """Compute the element sizes of the coarse mesh; the fine mesh halves them."""
        size = 2 * self.size / radius
        return Resolution(size=size, reach=inf, growth=self.growth, widest=size, deepest=1 / 3, order=order)


def _check_growth(growth: float) -> None:
    """Raise ValueError for a growth outside 1 to 2."""
    require("growth", growth, 1 <= growth <= 2, "growth must lie between 1 and 2")


Spacing = Adapted | Uniform
SPACINGS = (Adapted, Uniform)
