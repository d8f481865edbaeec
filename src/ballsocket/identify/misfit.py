"""How far a model is from the data at numbers that are tried, and how that changes with them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf

import numpy

from ..arrays import Numbers
from .answers import Answers
from .scatter import Scatter
from .unknowns import Scales, log_prior

Slopes = Callable[[Answers, Scales, Numbers], tuple[Numbers, Numbers]]
"""From places (unknowns,) to the answers (data,) and their slopes (data, unknowns) along the places."""


def by_differences(answers: Answers, scales: Scales, places: Numbers) -> tuple[Numbers, Numbers]:
    """Answers and slopes by central differences in one press of arrays, one-sided at the ends: for any model."""
    step = answers.model.smooth_step * numpy.eye(len(places))
    beside = numpy.clip(numpy.concatenate([places[None], places + step, places - step]), scales.low, scales.high)
    found = answers.at(scales.values(beside))
    count = len(places)
    here, above, below = found[0], found[1 : 1 + count], found[1 + count :]
    up, down = (numpy.diagonal(part) for part in (beside[1 : 1 + count], beside[1 + count :]))
    above, up = _or_here(above, up, here, places)
    below, down = _or_here(below, down, here, places)
    return here, ((above - below) / numpy.where(up > down, up - down, inf)[:, None]).T


def _or_here(found: Numbers, at: Numbers, here: Numbers, places: Numbers) -> tuple[Numbers, Numbers]:
    """The point itself in place of one beside it that has no answer."""
    lost = numpy.isnan(found).any(axis=1)
    return numpy.where(lost[:, None], here, found), numpy.where(lost, places, at)


@dataclass(frozen=True, eq=False)
class Misfit:
    """Data against answers: residuals for least squares, whose half sum of squares is -ln of the posterior.

    Attributes
    ----------
    answers : Answers
    scales : Scales
    scatter : Scatter
    slopes : callable
        `by_differences`, or `by_tracing`.
    value, uncertainty : array (data,)
    cut_off : array (data,)
        Which values only say "at least so much".
    """

    answers: Answers
    scales: Scales
    scatter: Scatter
    slopes: Slopes
    uncertainty: Numbers
    value: Numbers = field(init=False)
    cut_off: Numbers = field(init=False)

    def __post_init__(self) -> None:
        data = self.answers.data
        cut = numpy.concatenate([each.saturated for each in data])
        limits = numpy.concatenate([numpy.full(len(each), each.saturation) for each in data])
        values = numpy.concatenate([each.values for each in data])
        object.__setattr__(self, "cut_off", cut)
        object.__setattr__(self, "value", numpy.where(cut, limits, values))

    def standard(self, found: Numbers) -> Numbers:
        """How many uncertainties the answers are from the values."""
        return (found - self.value) / self.uncertainty

    def residuals(self, found: Numbers) -> Numbers:
        """One for each of the data, whose half sum of squares is -ln of the likelihood but for a constant."""
        z = self.standard(found)
        return numpy.where(self.cut_off, self.scatter.beyond(z)[0], self.scatter.misfit(z))

    def both(self, places: Numbers) -> tuple[Numbers, Numbers]:
        """Residuals, those of what was known among them, and their slopes."""
        found, slopes = self.slopes(self.answers, self.scales, places)
        z = self.standard(found)
        bend = numpy.where(self.cut_off, self.scatter.beyond(z)[1], self.scatter.slope(z)) / self.uncertainty
        known = numpy.array([each.known for each in self.scales.unknowns])
        return (
            numpy.concatenate([self.residuals(found), self.scales.surprise(places)[known]]),
            numpy.concatenate([bend[:, None] * slopes, numpy.eye(len(places))[known]]),
        )

    def costs(self, places: Numbers) -> Numbers:
        """-ln of the likelihood and of what was known, but for a constant; inf where there is no answer. (points,)."""
        residuals = self.residuals(self.answers.at(self.scales.values(places)))
        cost = (numpy.sum(residuals**2, axis=1) + numpy.sum(self.scales.surprise(places) ** 2, axis=-1)) / 2
        return numpy.where(numpy.isfinite(cost), cost, inf)

    def log_posterior(self, places: Numbers) -> Numbers:
        """ln of the posterior by places, but for a constant; two ends make every number between equally likely."""
        prior = log_prior(self.scales, places)
        inside = numpy.clip(places, self.scales.low, self.scales.high)
        residuals = self.residuals(self.answers.at(self.scales.values(inside)))
        total = prior - numpy.sum(residuals**2, axis=1) / 2
        return numpy.where(numpy.isfinite(total), total, -inf)

    def information(self, places: Numbers) -> Numbers:
        """Fisher's information that the data hold about the places, (unknowns, unknowns)."""
        found, slopes = self.slopes(self.answers, self.scales, places)
        weights = numpy.where(self.cut_off, self._of_cut_off(found), self.scatter.told) / self.uncertainty**2
        return (slopes * weights[:, None]).T @ slopes

    def _of_cut_off(self, found: Numbers) -> Numbers:
        """-d²/dz² of ln P(reading above): (h² + h pull), h the hazard and pull that of the density."""
        z = self.standard(found)
        residual, slope = self.scatter.beyond(z)
        hazard, pull = -residual * slope, self.scatter.misfit(z) * self.scatter.slope(z)
        return numpy.maximum(hazard * (hazard + pull), 0.0)
