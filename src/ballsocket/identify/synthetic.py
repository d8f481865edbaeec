"""Coverage of the bands: identification of a known joint from many synthetic sets of data."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from .bands import banded
from .measured import Measured
from .search import found as searched

if TYPE_CHECKING:
    from .parameters import Identified


@dataclass(frozen=True, eq=False)
class Trials:
    """Estimates and bands from many synthetic sets of data.

    Attributes
    ----------
    names : tuple of str
    truth : array (unknowns,)
        In deviations of what was known, as all that follows.
    middle, low, high : array (trials, unknowns)
        Estimates, and the ends of their bands of 95 %.
    """

    names: tuple[str, ...]
    truth: Numbers
    middle: Numbers
    low: Numbers
    high: Numbers

    @property
    def half(self) -> Numbers:
        """Half the widths of the bands."""
        return (self.high - self.low) / 2

    @property
    def coverage(self) -> dict[str, float]:
        """The share of the bands that hold the truth, by unknown: 0.95 is right."""
        held = (self.low <= self.truth) & (self.truth <= self.high)
        return dict(zip(self.names, held.mean(axis=0).tolist(), strict=True))

    @property
    def bias(self) -> dict[str, float]:
        """How far the estimates are off on average, in widths of the band, by unknown: 0 is right."""
        off = (self.middle - self.truth).mean(axis=0) / (2 * self.half.mean(axis=0))
        return dict(zip(self.names, off.tolist(), strict=True))

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {"trials": len(self.middle), "coverage": self.coverage, "bias": self.bias}


def trials(found: Identified, count: int = 200, seed: int = 0) -> Trials:
    """Identify again and again from data drawn about the best point, as scattered as the uncertainties say.

    Parameters
    ----------
    found : Identified
        Its best point is the truth.
    count : int
        Sets of data, 1 or more.
    seed : int
    """
    require("count", count, count > 0, "1 trial or more")
    random = numpy.random.default_rng(seed)
    stated = replace(found.misfit, uncertainty=found.misfit.widening * found.misfit.uncertainty, widening=1.0)
    middle, low, high = [], [], []
    for number in range(count):
        misfit = replace(stated, answers=replace(stated.answers, data=drawn(found, random)))
        _, best, information = banded(misfit, searched(misfit, seed + number))
        middle.append(best.places)
        low.append([each.low.theta[index] for index, each in enumerate(information.intervals)])
        high.append([each.high.theta[index] for index, each in enumerate(information.intervals)])
    return Trials(found.scales.names, found.best.places, *map(numpy.array, (middle, low, high)))


def drawn(found: Identified, random: numpy.random.Generator) -> tuple[Measured, ...]:
    """Draw synthetic measurements for the joint of the best point; load errors are included in the values."""
    effective = found.misfit.widening * found.misfit.uncertainty
    wide = numpy.split(effective, numpy.cumsum([len(each) for each in found.data])[:-1])
    return tuple(
        replace(each, values=_values(each, row, off * found.misfit.scatter.draw(len(each), random)))
        for each, row, off in zip(found.data, found.answers, wide, strict=True)
    )


def _values(each: Measured, answers: Numbers, off: Numbers) -> Numbers:
    """Readings, cut off where the film saturates, and none below 0 but by a machine."""
    read = answers + off
    return numpy.minimum(read if each.machine.name else numpy.maximum(read, 0.0), each.saturation)
