"""What wear, form and fit take off a bore that was a sphere."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from ...core.arrays import Numbers
from ...core.checks import shown


class Shape(Protocol):
    """How much deeper than the sphere a bore is: a function of directions."""

    def depth(self, directions: Numbers) -> Numbers:
        """In mm, positive where material is missing, at unit vectors (3, ...) in the cup's frame."""
        ...


@dataclass(frozen=True, kw_only=True)
class Worn:
    """A bore that is worn, out of round or imperfect, as a function.

    Parameters
    ----------
    of : function
        From unit vectors (3, ...) in the cup's frame (z to the dome's pole, x in the plane in which a tilt counts) to
        the depth in mm, positive where material is missing.

    Raises
    ------
    TypeError
        What is no function.

    Examples
    --------
    An ellipse that a press fit squeezes by 30 µm across y:

    >>> squeezed = Worn(of=lambda n: 0.030 * (n[0] ** 2 - n[1] ** 2) / 2)
    """

    of: Callable[[Numbers], Numbers]

    def __post_init__(self) -> None:
        if not callable(self.of):
            raise TypeError(f"of must be a function from directions to depths (mm), got {shown(self.of)}")

    def depth(self, directions: Numbers) -> Numbers:
        return self.of(directions)


class Measured:
    """A depth between measured points, which takes its time: that at the last directions is remembered."""

    def depth(self, directions: Numbers) -> Numbers:
        """In mm, positive where material is missing, at unit vectors (3, ...) in the cup's frame."""
        if directions.flags.writeable:
            return self.between(directions)
        last, found = vars(self).get("_last", (None, None))
        if last is not directions:
            found = self.between(directions)
            vars(self)["_last"] = directions, found
        depth: Numbers = found
        return depth

    @abstractmethod
    def between(self, directions: Numbers) -> Numbers:
        """The depth in mm at unit vectors (3, ...)."""
