"""Bores that are no spheres: ovals, tables of a measured depth."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, pi
from typing import TYPE_CHECKING

import numpy

from ...core.arrays import Numbers
from ...core.checks import check_number, degrees_hint, require
from .directions import polar_angle
from .worn import Measured

if TYPE_CHECKING:
    from scipy.interpolate import RegularGridInterpolator


@dataclass(frozen=True, kw_only=True)
class Pinched:
    """A bore that a press fit has squeezed to an oval, by as much at the equator as the diameter lost.

    Parameters
    ----------
    squeeze : float
        In mm: the diameter across the press fit is smaller by this, the one across it larger.
    direction : float
        Azimuth in rad of the squeezed diameter, from the cup's x.

    Raises
    ------
    ValueError
        A number that is not finite, a direction that can only be degrees.
    TypeError
        What is not one number.

    Examples
    --------
    A shell that its press fit pinches by 60 µm in diameter:

    >>> import numpy
    >>> Pinched(squeeze=0.06).depth(numpy.eye(3)).round(3) + 0.0
    array([-0.03,  0.03,  0.  ])
    """

    squeeze: float
    direction: float = 0.0

    def __post_init__(self) -> None:
        squeeze, turned = (check_number(name, getattr(self, name)) for name in ("squeeze", "direction"))
        require("squeeze", squeeze, abs(squeeze) < inf, "a squeeze (mm) is finite")
        meant = f"; {degrees_hint(turned)}"
        require("direction", turned, abs(turned) <= 2 * pi, f"a direction is in radians, at most 6.283{meant}")

    def depth(self, directions: Numbers) -> Numbers:
        x, y, _ = directions
        twice = (x * x - y * y) * numpy.cos(2 * self.direction) + 2 * x * y * numpy.sin(2 * self.direction)
        depth: Numbers = -self.squeeze / 2 * twice
        return depth


@dataclass(frozen=True, kw_only=True, eq=False)
class DepthTable(Measured):
    """A depth that is known at polar angles and azimuths, linear between them.

    Parameters
    ----------
    polar : array (angles,)
        From the dome's pole in rad, ascending; beyond the last the depth is that at the last.
    azimuth : array (azimuths,)
        Around the cup's axis from its x in rad, ascending within one turn; it closes upon itself.
    values : array (angles, azimuths)
        In mm, positive where material is missing.

    Raises
    ------
    ValueError
        Shapes that do not fit, angles that do not ascend or can only be degrees, a depth that is not finite.
    """

    polar: Numbers
    azimuth: Numbers
    values: Numbers

    def __post_init__(self) -> None:
        for name in ("polar", "azimuth", "values"):
            object.__setattr__(self, name, numpy.asarray(getattr(self, name), dtype=float))
        for name, most in (("polar", pi), ("azimuth", 2 * pi)):
            angles = getattr(self, name)
            if angles.ndim != 1 or len(angles) < 2:
                raise ValueError(f"{name} of shape {angles.shape} is not allowed: two angles and more in a row")
            require(name, angles, abs(angles) <= most + 1e-9, f"an angle is in radians, at most {most:.4g}")
            require(name, angles, numpy.append(True, numpy.diff(angles) > 0), "angles ascend")
        if self.values.shape != (len(self.polar), len(self.azimuth)):
            raise ValueError(
                f"values of shape {self.values.shape} are not allowed: one row a polar angle, one column an azimuth"
            )
        require("values", self.values, numpy.isfinite(self.values), "a depth (mm) is finite")

    @cached_property
    def _between(self) -> RegularGridInterpolator:
        from scipy.interpolate import RegularGridInterpolator

        around = numpy.concatenate([self.azimuth, [self.azimuth[0] + 2 * pi]])
        rows = numpy.hstack([self.values, self.values[:, :1]])
        if self.azimuth[-1] - self.azimuth[0] >= 2 * pi - 1e-9:
            around, rows = self.azimuth, self.values
        return RegularGridInterpolator((self.polar, around), rows)

    def between(self, directions: Numbers) -> Numbers:
        x, y, _ = directions
        polar = numpy.clip(polar_angle(directions), self.polar[0], self.polar[-1])
        first = self._between.grid[1][0]
        azimuth = first + (numpy.arctan2(y, x) - first) % (2 * pi)
        table: Numbers = self._between(numpy.stack([polar, azimuth], axis=-1))
        return table
