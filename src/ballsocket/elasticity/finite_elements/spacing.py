"""How finely ball and socket are meshed."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import inf, pi

from ...core.arrays import is_plain
from ...core.checks import check_numeric, require, shown
from .shapes import Resolution

_CLASSES = 24
_RATIO = 2**-0.5  # of a class's narrowest contact to its widest
_DEFAULT = 60
_FEWEST = 12  # elements in the narrowest contact of a uniform mesh
_BEYOND = 1.2  # of a class's widest contact: so far its elements stay small


class Element(Enum):
    """Quadrilaterals with displacements of this degree along their sides; neither locks near ν = ½."""

    BILINEAR = 1
    BIQUADRATIC = 2


@dataclass(frozen=True, kw_only=True)
class Adapted:
    """Elements as small as the contact asks for, larger away from it.

    Contacts are sorted into classes, each 0.7 times as wide as the one before and with a mesh of its own, so that a
    contact spans between 0.7 times `elements` and all of them, more where the liner is thin: an element is at most a
    quarter of its thickness.

    Parameters
    ----------
    elements : int
        Along the widest contact of each class, from the pole to its edge; an even number from 24 on. Default 60.
    growth : float
        How much longer each element of the coarse mesh is than its neighbour, away from the contact; 1 to 2. This is
        for 60 elements: with more of them neighbours differ less.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    """

    elements: int = _DEFAULT
    growth: float = 1.3

    def __post_init__(self) -> None:
        good = isinstance(self.elements, int) and self.elements >= 24 and self.elements % 2 == 0
        require("elements", self.elements, good, "elements along a contact are an even number from 24 on")
        _check_growth(self.growth)

    def classes(self, reach: float, radius: float) -> tuple[float, ...]:
        """Half angles in rad, descending: a class lies between each and the next."""
        return tuple(reach * _RATIO**number for number in range(_CLASSES + 1))

    def coarse(self, widest: float, radius: float, thickness: float, order: int) -> Resolution:
        """The coarse mesh of a class; the fine one halves it. All of it is coarser or finer with `elements`."""
        share = _DEFAULT / self.elements
        return Resolution(
            size=min(2 * widest / self.elements, share * thickness / (2 * radius)),
            reach=_BEYOND * widest,
            growth=self.growth**share,
            widest=share * pi / 12,
            deepest=min(share / 3, 0.5),
            order=order,
        )


@dataclass(frozen=True, kw_only=True)
class Uniform:
    """Elements of one size along both surfaces, whatever the contact.

    Parameters
    ----------
    size : float
        In mm. 0.05 mm is that of Heß & Forsbach (2021).
    growth : float
        How much deeper each element of the coarse mesh is than the one above it, away from the contact; 1 to 2.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    """

    size: float
    growth: float = 1.03

    def __post_init__(self) -> None:
        if not is_plain(check_numeric("size", self.size)):
            raise TypeError(f"size must be one number, got {shown(self.size)}")
        require("size", self.size, 0 < self.size < inf, "an element's size (mm) is above 0 and finite")
        _check_growth(self.growth)

    def classes(self, reach: float, radius: float) -> tuple[float, ...]:
        """One class, from a few elements to the widest contact."""
        return (reach, min(_FEWEST * self.size / radius, reach / 2))

    def coarse(self, widest: float, radius: float, thickness: float, order: int) -> Resolution:
        """The coarse mesh; the fine one halves it."""
        size = 2 * self.size / radius
        return Resolution(size=size, reach=inf, growth=self.growth, widest=size, deepest=1 / 3, order=order)


def _check_growth(growth: float) -> None:
    require("growth", growth, 1 <= growth <= 2, "elements grow by a factor of 1 to 2")


Spacing = Adapted | Uniform
SPACINGS = (Adapted, Uniform)
