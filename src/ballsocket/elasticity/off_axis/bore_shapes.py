"""Shapes of a bore that is not a sphere: worn, oval, or measured."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf, pi
from typing import TYPE_CHECKING, Protocol

import numpy

from ...core.arrays import Numbers
from ...core.checks import check_number, degrees_hint, require, shown
from .directions import polar_angle

if TYPE_CHECKING:
    from scipy.interpolate import RegularGridInterpolator


class BoreShape(Protocol):
    """Depth of a bore below its sphere, as a function of direction."""

    def depth(self, directions: Numbers) -> Numbers:
        """Compute the depth of the bore below its sphere in mm, at unit vectors (3, ...) in the cup's frame.

        The depth is positive where material is missing.
        """
        ...


@dataclass(frozen=True, kw_only=True)
class BoreDeviation:
    """Deviation of a worn, oval or imperfect bore from a sphere, as a function.

    Parameters
    ----------
    of : function
        From unit vectors (3, ...) in the cup's frame to the depth in mm, positive where material is missing. z points
        to the pole of the dome, and x lies in the plane in which a tilt counts.

    Raises
    ------
    TypeError
        An object that cannot be called.

    Examples
    --------
    An ellipse that a press fit squeezes by 30 µm across y:

    >>> squeezed = BoreDeviation(of=lambda n: 0.030 * (n[0] ** 2 - n[1] ** 2) / 2)
    """

    of: Callable[[Numbers], Numbers]

    def __post_init__(self) -> None:
        if not callable(self.of):
            raise TypeError(f"of must be a function from directions to depths (mm), got {shown(self.of)}")

    def depth(self, directions: Numbers) -> Numbers:
        """Compute the depth of the bore in mm at unit vectors (3, ...), as in `BoreShape`."""
        return self.of(directions)


@dataclass(frozen=True, kw_only=True)
class OvalBore:
    """Deviation of an oval bore from a sphere, as after a press fit.

    At the equator one diameter shrinks as much as the other grows.

    Parameters
    ----------
    squeeze : float
        Decrease in mm of the diameter along the press fit, and increase of the one perpendicular to it.
    direction : float
        Azimuth in rad of the squeezed diameter, from the cup's x.

    Raises
    ------
    ValueError
        A number that is not finite, a direction beyond 2π.
    TypeError
        An array or an object that is not a number.

    Examples
    --------
    A shell that its press fit pinches by 60 µm in diameter:

    >>> import numpy
    >>> OvalBore(squeeze=0.06).depth(numpy.eye(3)).round(3) + 0.0
    array([-0.03,  0.03,  0.  ])
    """

    squeeze: float
    direction: float = 0.0

    def __post_init__(self) -> None:
        squeeze, direction = (check_number(name, getattr(self, name)) for name in ("squeeze", "direction"))
        require("squeeze", squeeze, abs(squeeze) < inf, "a squeeze (mm) is finite")
        hint = f"; {degrees_hint(direction)}"
        require("direction", direction, abs(direction) <= 2 * pi, f"a direction is in radians, at most 6.283{hint}")

    def depth(self, directions: Numbers) -> Numbers:
        """Compute the depth of the bore in mm at unit vectors (3, ...), as in `BoreShape`."""
        x, y, _ = directions
        twofold = (x * x - y * y) * numpy.cos(2 * self.direction) + 2 * x * y * numpy.sin(2 * self.direction)
        return -self.squeeze / 2 * twofold


class InterpolatedDeviation:
    """Deviation interpolated between measured points; the depth at the last read-only directions is cached."""

    def depth(self, directions: Numbers) -> Numbers:
        """Compute the depth of the bore in mm at unit vectors (3, ...), as in `BoreShape`."""
        if directions.flags.writeable:
            return self.interpolate(directions)
        last, depth = vars(self).get("_last", (None, None))
        if last is not directions:
            depth = self.interpolate(directions)
            vars(self)["_last"] = directions, depth
        return depth

    @abstractmethod
    def interpolate(self, directions: Numbers) -> Numbers:
        """Interpolate the depth of the bore in mm at unit vectors (3, ...) in the cup's frame."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DepthTable(InterpolatedDeviation):
    """Depth of a bore in a table of polar angles and azimuths, with linear interpolation.

    Parameters
    ----------
    polar : array (angles,)
        Angles from the pole of the dome in rad, ascending. Beyond the last one the depth is constant.
    azimuth : array (azimuths,)
        Angles about the cup's axis from its x in rad, ascending within one turn. The table is periodic.
    values : array (angles, azimuths)
        Depth in mm, positive where material is missing.

    Raises
    ------
    ValueError
        Shapes that do not fit, angles that do not ascend or exceed a turn, a depth that is not finite.
    """

    polar: Numbers
    azimuth: Numbers
    values: Numbers

    def __post_init__(self) -> None:
        for name in ("polar", "azimuth", "values"):
            object.__setattr__(self, name, numpy.asarray(getattr(self, name), dtype=float))
        for name, limit in (("polar", pi), ("azimuth", 2 * pi)):
            angles = getattr(self, name)
            if angles.ndim != 1 or len(angles) < 2:
                raise ValueError(f"{name} of shape {angles.shape} is not allowed: give a row of at least two angles")
            require(name, angles, abs(angles) <= limit + 1e-9, f"an angle is in radians, at most {limit:.4g}")
            require(name, angles, numpy.append(True, numpy.diff(angles) > 0), "angles ascend")
        if self.values.shape != (len(self.polar), len(self.azimuth)):
            raise ValueError(
                f"values of shape {self.values.shape} are not allowed: give one row per polar angle "
                "and one column per azimuth"
            )
        require("values", self.values, numpy.isfinite(self.values), "a depth (mm) is finite")

    @cached_property
    def _interpolator(self) -> RegularGridInterpolator:
        from scipy.interpolate import RegularGridInterpolator  # slow to import

        azimuth = numpy.concatenate([self.azimuth, [self.azimuth[0] + 2 * pi]])
        values = numpy.hstack([self.values, self.values[:, :1]])
        if self.azimuth[-1] - self.azimuth[0] >= 2 * pi - 1e-9:
            azimuth, values = self.azimuth, self.values
        return RegularGridInterpolator((self.polar, azimuth), values)

    def interpolate(self, directions: Numbers) -> Numbers:
        """Interpolate the depth of the bore in mm at unit vectors (3, ...) in the cup's frame."""
        x, y, _ = directions
        polar = numpy.clip(polar_angle(directions), self.polar[0], self.polar[-1])
        first = self._interpolator.grid[1][0]
        azimuth = first + (numpy.arctan2(y, x) - first) % (2 * pi)
        return self._interpolator(numpy.stack([polar, azimuth], axis=-1))
