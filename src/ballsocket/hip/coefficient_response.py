"""Response of wear to a wear coefficient that is unknown but the same for all patients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy

from ..core.arrays import Numbers
from ..core.executors.local import Engine
from .lives import Lives
from .patients import ANSWERS, Scatter

COEFFICIENT = "coefficient"
"""Name of the wear coefficient among the sampled quantities."""

CONVERTED = ("volume", "depth", "penetration")
"""Converted results."""

_COLUMNS = [list(ANSWERS).index(name) for name in CONVERTED]

_NODES = 12
"""Number of runs of the nominal patient over the range of the coefficient."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SharedCoefficient:
    """Results of all patients with one shared wear coefficient, for three coefficients.

    Attributes
    ----------
    values : mapping of str to float
        Coefficients at the lower end, the middle and the upper end of the band of the coefficient.
    results : mapping of str to array (patients, looks, results)
        Results of `CONVERTED`, by the names in `values`.
    """

    values: Mapping[str, float]
    results: Mapping[str, Numbers]

    def quantile(self, coefficient: str, name: str, share: float) -> Numbers:
        """Compute the quantile of a result of `CONVERTED` over the patients at each report."""
        return numpy.nanquantile(self.results[coefficient][:, :, CONVERTED.index(name)], share, axis=0)


def share_coefficient(
    scatter: Scatter,
    counts: tuple[float, ...],
    sampled: Mapping[str, Numbers],
    table: Numbers,
    level: float,
    engine: Engine,
) -> SharedCoefficient | None:
    """Convert the results of patients to shared wear coefficients.

    Each result is multiplied by the ratio of the nominal patient's results at both coefficients. Twice the cycles wear
    as much as twice the coefficient. The ratio is therefore taken at the coefficient times the patient's cycle ratio.

    Parameters
    ----------
    scatter : Scatter
    counts : tuple of float
        Cycles of the nominal patient at the reports.
    sampled : mapping of str to array (patients,)
        Sampled quantities of the patients.
    table : array (patients, looks, results)
        Results of `ANSWERS` at the sampled coefficients.
    level : float
        Share of the coefficients inside their band.
    engine : Engine

    Returns
    -------
    SharedCoefficient or None
        None without a sampled coefficient and another sampled quantity, for a coefficient of 0, or without results.
    """
    if COEFFICIENT not in scatter.distributions or len(scatter.distributions) == 1:
        return None
    tail = (1 - level) / 2
    ends = scatter.distributions[COEFFICIENT].frozen.ppf([tail, 0.5, 1 - tail])
    values = dict(zip(("low", "median", "high"), map(float, ends), strict=True))
    sampled_coefficients, cycle_ratios = sampled[COEFFICIENT], _cycle_ratios(scatter, sampled)
    low, high = (
        min(sampled_coefficients.min(), ends[0]) * cycle_ratios.min(),
        max(sampled_coefficients.max(), ends[-1]) * cycle_ratios.max(),
    )
    if not 0 < low < high or numpy.isnan(table).all():
        return None
    exposures = numpy.geomspace(low, high, _NODES)
    nominal = Lives(scatter=scatter, counts=counts, values={COEFFICIENT: exposures}).all(engine)
    known = nominal.refused == ""
    if not known.any():
        return None
    response = _Response(exposures=exposures[known], table=nominal.table[known][:, :, _COLUMNS])
    at_own = table[:, :, _COLUMNS] / response.at(sampled_coefficients * cycle_ratios)
    results = {name: at_own * response.at(value * cycle_ratios) for name, value in values.items()}
    return SharedCoefficient(values=MappingProxyType(values), results=MappingProxyType(results))


@dataclass(frozen=True, kw_only=True, eq=False)
class _Response:
    """Results of the nominal patient (nodes, looks, results) over coefficient times cycle ratio (nodes,)."""

    exposures: Numbers
    table: Numbers

    def at(self, exposures: Numbers) -> Numbers:
        """Interpolate on logarithmic axes: (points, looks, results), NaN for zero wear."""
        x, nodes = numpy.log(exposures), numpy.log(self.exposures)
        with numpy.errstate(divide="ignore"):
            columns = numpy.log(self.table).reshape(len(nodes), -1).T
        values = numpy.exp(numpy.stack([numpy.interp(x, nodes, column) for column in columns], axis=-1))
        return numpy.where(values > 0, values, numpy.nan).reshape(len(x), *self.table.shape[1:])


def _cycle_ratios(scatter: Scatter, sampled: Mapping[str, Numbers]) -> Numbers:
    """Compute the ratio of each patient's cycles to those of the nominal patient."""
    nominal = scatter.cycles_per_year
    if "cycles_per_year" not in sampled or not nominal:
        return numpy.ones(len(sampled[COEFFICIENT]))
    return sampled["cycles_per_year"] / nominal
