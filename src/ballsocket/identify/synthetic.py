"""Synthetic truth: what the same measurements of a joint whose numbers are known would have told, again and again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy

from ..arrays import Numbers
from ..checks import require
from .information import WIDE, Information
from .measured import Measured
from .search import found as searched

if TYPE_CHECKING:
    from .parameters import Identified


@dataclass(frozen=True, eq=False)
class Trials:
    """What many synthetic sets of data told of a truth.

    Attributes
    ----------
    names : tuple of str
    truth : array (unknowns,)
        In deviations of what was known, as all that follows.
    middle, half : array (trials, unknowns)
        Estimates, and half the widths of their bands of 95 %.
    """

    names: tuple[str, ...]
    truth: Numbers
    middle: Numbers
    half: Numbers

    @property
    def coverage(self) -> dict[str, float]:
        """The share of the bands that hold the truth, by unknown: 0.95 is right."""
        held = abs(self.middle - self.truth) <= self.half
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
    middle, half = [], []
    for number in range(count):
        misfit = replace(found.misfit, answers=replace(found.misfit.answers, data=drawn(found, random)))
        places = searched(misfit, seed + number).places
        left = Information(found.scales, places, misfit.information(places)).covariance
        middle.append(places)
        half.append(WIDE * numpy.sqrt(numpy.diagonal(left)))
    return Trials(found.scales.names, found.best.places, numpy.array(middle), numpy.array(half))


def drawn(found: Identified, random: numpy.random.Generator) -> tuple[Measured, ...]:
    """Measurements drawn once more, of the joint of the best point; what loads are off by is in the values."""
    wide = numpy.split(found.misfit.uncertainty, numpy.cumsum([len(each) for each in found.data])[:-1])
    return tuple(
        replace(each, values=_values(each, row, off * found.misfit.scatter.draw(len(each), random)))
        for each, row, off in zip(found.data, found.answers, wide, strict=True)
    )


def _values(each: Measured, answers: Numbers, off: Numbers) -> Numbers:
    """Readings, cut off where the film saturates, and none below 0 but by a machine."""
    read = answers + off
    return numpy.minimum(read if each.machine.name else numpy.maximum(read, 0.0), each.saturation)
