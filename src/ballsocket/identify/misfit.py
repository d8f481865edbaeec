"""Residuals of a model against the data, and their derivatives with respect to the unknowns."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf

import numpy

from ..core.arrays import Numbers
from .answers import Answers
from .scatter import Scatter
from .unknowns import Scales, log_prior

Slopes = Callable[[Answers, Scales, Numbers], tuple[Numbers, Numbers]]
"""Function from scaled unknowns (..., unknowns) to results (..., data) and derivatives (..., data, unknowns)."""


def by_differences(answers: Answers, scales: Scales, places: Numbers) -> tuple[Numbers, Numbers]:
    """Compute results and central differences in one array call, one-sided at the range ends."""
    count = places.shape[-1]
    points = places.reshape(-1, 1, count)
    step = answers.model.smooth_step * numpy.eye(count)
    stencil = numpy.clip(numpy.concatenate([points, points + step, points - step], axis=1), scales.low, scales.high)
    found = answers.at(scales.values(stencil.reshape(-1, count))).reshape(*stencil.shape[:2], -1)
    here, above, below = found[:, 0], found[:, 1 : 1 + count], found[:, 1 + count :]
    up, down = (numpy.diagonal(part, axis1=1, axis2=2) for part in numpy.split(stencil[:, 1:], 2, axis=1))
    above, up = _or_here(above, up, here, points[:, 0])
    below, down = _or_here(below, down, here, points[:, 0])
    slopes = (above - below) / numpy.where(up > down, up - down, inf)[..., None]
    shape = places.shape[:-1]
    return here.reshape(*shape, -1), slopes.swapaxes(1, 2).reshape(*shape, -1, count)


def _or_here(found: Numbers, at: Numbers, here: Numbers, points: Numbers) -> tuple[Numbers, Numbers]:
    """Replace a neighbour without a result by the point itself."""
    lost = numpy.isnan(found).any(axis=-1)
    return numpy.where(lost[..., None], here[:, None], found), numpy.where(lost, points, at)


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
    widening : float
        Factor on all uncertainties, 1 or more: observed scatter over the stated uncertainties.
    cut_off : array (data,)
        Which values only say "at least so much".
    """

    answers: Answers
    scales: Scales
    scatter: Scatter
    slopes: Slopes
    uncertainty: Numbers
    widening: float = 1.0
    value: Numbers = field(init=False)
    cut_off: Numbers = field(init=False)

    def __post_init__(self) -> None:
        data = self.answers.data
        cut = numpy.concatenate([each.saturated for each in data])
        limits = numpy.concatenate([numpy.full(len(each), each.saturation) for each in data])
        values = numpy.concatenate([each.values for each in data])
        object.__setattr__(self, "cut_off", cut)
        object.__setattr__(self, "value", numpy.where(cut, limits, values))

    @property
    def freedom(self) -> int:
        """Degrees of freedom: values less the unknowns without a stated distribution."""
        return len(self.value) - sum(not each.known for each in self.scales.unknowns)

    def standard(self, found: Numbers) -> Numbers:
        """Compute (answer - value)/uncertainty with the widened uncertainties."""
        return (found - self.value) / (self.widening * self.uncertainty)

    def residuals(self, found: Numbers) -> Numbers:
        """One for each of the data, whose half sum of squares is -ln of the likelihood but for a constant."""
        z = self.standard(found)
        return numpy.where(self.cut_off, self.scatter.beyond(z)[0], self.scatter.misfit(z))

    def both(self, places: Numbers) -> tuple[Numbers, Numbers]:
        """Compute residuals (..., data), those of stated distributions included, and their derivatives."""
        found, slopes = self.slopes(self.answers, self.scales, places)
        z = self.standard(found)
        bend = numpy.where(self.cut_off, self.scatter.beyond(z)[1], self.scatter.slope(z))
        bend = bend / (self.widening * self.uncertainty)
        known = numpy.array([each.known for each in self.scales.unknowns])
        unit = numpy.broadcast_to(numpy.eye(places.shape[-1])[known], (*places.shape[:-1], known.sum(), len(known)))
        return (
            numpy.concatenate([self.residuals(found), self.scales.surprise(places)[..., known]], axis=-1),
            numpy.concatenate([bend[..., None] * slopes, unit], axis=-2),
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
        return (slopes * self._weights(found)[:, None]).T @ slopes

    def shifts(self, places: Numbers, errors: Numbers) -> Numbers:
        """Compute JᵀW δ for errors δ (kinds, data) of the values: (unknowns, kinds)."""
        found, slopes = self.slopes(self.answers, self.scales, places)
        return slopes.T @ (self._weights(found) * errors).T

    def _weights(self, found: Numbers) -> Numbers:
        """Compute the information of each value about its result, in 1/unit²."""
        each = numpy.where(self.cut_off, self._of_cut_off(found), self.scatter.told)
        return each / (self.widening * self.uncertainty) ** 2

    def _of_cut_off(self, found: Numbers) -> Numbers:
        """-d²/dz² of ln P(reading above): (h² + h pull), h the hazard and pull that of the density."""
        z = self.standard(found)
        residual, slope = self.scatter.beyond(z)
        hazard, pull = -residual * slope, self.scatter.misfit(z) * self.scatter.slope(z)
        return numpy.maximum(hazard * (hazard + pull), 0.0)
