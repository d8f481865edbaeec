"""Results of patients who share one wear coefficient, which is unknown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy

from ..core.arrays import Numbers
from ..core.executors.processes import Engine
from .cohort import CohortRun
from .variability import RESULT_UNITS, PatientVariability

COEFFICIENT = "coefficient"
"""Name of the wear coefficient among the sampled quantities."""

CONVERTED = ("volume", "depth", "penetration")
"""Results that are converted to shared coefficients."""

_COLUMNS = [list(RESULT_UNITS).index(name) for name in CONVERTED]

_NODES = 12
"""Number of runs of the nominal patient over the range of the coefficient."""


@dataclass(frozen=True, kw_only=True, eq=False)
class SharedCoefficient:
    """Results of all patients with one shared wear coefficient, for three coefficients.

    Attributes
    ----------
    values : mapping of str to float
        Coefficients at the lower end, the middle and the upper end of the band of the coefficient.
    results : mapping of str to array (patients, reports, results)
        Results of `CONVERTED`, by the names in `values`.
    """

    values: Mapping[str, float]
    results: Mapping[str, Numbers]

    def quantile(self, coefficient: str, name: str, fraction: float) -> Numbers:
        """Compute the quantile of a result of `CONVERTED` over the patients at each report, for one coefficient."""
        return numpy.nanquantile(self.results[coefficient][:, :, CONVERTED.index(name)], fraction, axis=0)


def share_coefficient(
    variability: PatientVariability,
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
    variability : PatientVariability
        Distributions of the patients.
    counts : tuple of float
        Cycles of the nominal patient at the reports.
    sampled : mapping of str to array (patients,)
        Sampled quantities of the patients.
    table : array (patients, reports, results)
        Results of `RESULT_UNITS` at the sampled coefficients.
    level : float
        Fraction of the coefficients inside their band.
    engine : Engine
        Executor of the simulations.

    Returns
    -------
    SharedCoefficient or None
        None without a sampled coefficient and another sampled quantity, for a coefficient of 0, or without results.
    """
    if COEFFICIENT not in variability.distributions or len(variability.distributions) == 1:
        return None
    tail = (1 - level) / 2
    ends = variability.distributions[COEFFICIENT].frozen.ppf([tail, 0.5, 1 - tail])
    values = dict(zip(("low", "median", "high"), map(float, ends), strict=True))
    sampled_coefficients, cycle_ratios = sampled[COEFFICIENT], _cycle_ratios(variability, sampled)
    low, high = (
        min(sampled_coefficients.min(), ends[0]) * cycle_ratios.min(),
        max(sampled_coefficients.max(), ends[-1]) * cycle_ratios.max(),
    )
    if not 0 < low < high or numpy.isnan(table).all():
        return None
    exposures = numpy.geomspace(low, high, _NODES)
    nominal = CohortRun(variability=variability, counts=counts, values={COEFFICIENT: exposures}).simulate(engine)
    known = nominal.refused == ""
    if not known.any():
        return None
    response = _Response(exposures=exposures[known], table=nominal.table[known][:, :, _COLUMNS])
    factors = table[:, :, _COLUMNS] / response.interpolate(sampled_coefficients * cycle_ratios)
    results = {name: factors * response.interpolate(value * cycle_ratios) for name, value in values.items()}
    return SharedCoefficient(values=MappingProxyType(values), results=MappingProxyType(results))


@dataclass(frozen=True, kw_only=True, eq=False)
class _Response:
    """Results of the nominal patient (nodes, reports, results) over coefficient times cycle ratio (nodes,)."""

    exposures: Numbers
    table: Numbers

    def interpolate(self, exposures: Numbers) -> Numbers:
        """Interpolate the results on logarithmic axes: (points, reports, results), NaN for zero wear."""
        x, nodes = numpy.log(exposures), numpy.log(self.exposures)
        with numpy.errstate(divide="ignore"):
            columns = numpy.log(self.table).reshape(len(nodes), -1).T
        values = numpy.exp(numpy.stack([numpy.interp(x, nodes, column) for column in columns], axis=-1))
        return numpy.where(values > 0, values, numpy.nan).reshape(len(x), *self.table.shape[1:])


def _cycle_ratios(variability: PatientVariability, sampled: Mapping[str, Numbers]) -> Numbers:
    """Compute the ratio of each patient's cycles to those of the nominal patient."""
    nominal = variability.cycles_per_year
    if "cycles_per_year" not in sampled or not nominal:
        return numpy.ones(len(sampled[COEFFICIENT]))
    return sampled["cycles_per_year"] / nominal
