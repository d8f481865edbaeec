"""Loads of one direction are one contact at many sizes: solved at a few of them, straight lines between."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers

_MOST = 12
_ALONG = 1e-9


@dataclass(frozen=True, kw_only=True, eq=False)
class Levels:
    """The loads that are solved, and how all of them follow.

    Attributes
    ----------
    loads : array (levels, 3)
        In N.
    shares : array (loads, levels)
        Of each level in each load; they add up to 1, and the loads with them.
    """

    loads: Numbers
    shares: Numbers

    def between(self, solved: Numbers) -> Numbers:
        """Answers (loads, ...) from those at the levels (levels, ...)."""
        return self.shares @ solved


def each_of(loads: Numbers) -> Levels:
    """All of the loads (loads, 3), each by itself."""
    return Levels(loads=loads, shares=numpy.eye(len(loads)))


def levels_of(loads: Numbers, most: int = _MOST) -> Levels:
    """Levels of loads (loads, 3) in N: at most so many where all have one direction, all of them elsewhere.

    Close to each other where loads are small, whose contacts change most.
    """
    size = numpy.linalg.norm(loads, axis=1)
    if len(loads) <= most or abs(numpy.cross(loads, loads[0])).max() > _ALONG * size.max() ** 2:
        return each_of(loads)
    each = numpy.linspace(size.min() ** 0.5, size.max() ** 0.5, most) ** 2
    each[0], each[-1] = size.min(), size.max()
    if each[-1] - each[0] <= _ALONG * each[-1]:
        each = each[-1:]
        return Levels(loads=each[:, None] * loads[0] / size[0], shares=numpy.ones((len(loads), 1)))
    left = numpy.clip(numpy.searchsorted(each, size, side="right") - 1, 0, most - 2)
    share = (size - each[left]) / (each[left + 1] - each[left])
    shares = numpy.zeros((len(loads), most))
    rows = numpy.arange(len(loads))
    shares[rows, left], shares[rows, left + 1] = 1 - share, share
    return Levels(loads=each[:, None] * loads[0] / size[0], shares=shares)
