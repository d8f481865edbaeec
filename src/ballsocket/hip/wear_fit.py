"""Wear coefficient from measured wear, with its band."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import exp, inf, isfinite, log, nan
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.display import counted, finite_or_none
from .history import History, NumericalError
from .law_fields import law_summary
from .measured_wear import MILLION, MeasuredWear
from .simulation import HipSimulation, check_total_wear, run_to_report_points
from .wear_integrator import WearIntegrator
from .wear_law import coefficient_field, with_coefficient

_NODES = numpy.linspace(-0.5, 0.5, 5)  # ln(coefficient) of the runs minus that of the centre
_DEGREE = 3  # degree of the polynomial of ln(result) over ln(coefficient) through the nodes
_MAX_SHIFT = 0.3  # largest difference of ln(coefficient) between centre and best; beyond it the nodes are shifted
_MAX_CENTRES = 6
_MAX_STEPS, _STEP_TOLERANCE = 100, 1e-12
_MAX_LOG_RANGE = 20.0  # range of ln(coefficient) to both sides in which other readings of a rate are searched
_SIGNIFICANCE = 0.05  # probability of the scatter below which Student's quantile applies
_FEW_CYCLES = 1e4  # number of cycles below which no wear is measured
_MIN_NOTED_WIDENING = 1.05
_ROUNDING = 1e-9  # width of a band, relative to the coefficient, that is rounding alone
_PREDICTED, _LEAST = 10, 1e-6  # steps of a prediction; share of the coefficient that stands for a band's end at 0


@dataclass(frozen=True, kw_only=True, eq=False)
class WearFit:
    """Wear coefficient that is fitted to measured wear, with its 95 % band.

    Attributes
    ----------
    simulation : HipSimulation
        Simulation with the best coefficient.
    data : tuple of MeasuredWear
    coefficient : float
        Best coefficient in the unit of the law, such as mm³/(N m).
    low, high : float
        Ends of the 95 % band; NaN for a single value without an uncertainty.
    stations : mapping of str to float
        Coefficient of each specimen, by the name of its station.
    scatter : float
        Relative standard deviation (k = 1) of the coefficient between specimens; NaN for one specimen.
    results : tuple of array
        Values of the simulation at the best coefficient, for each data set.
    uncertainty : array (data,)
        Standard uncertainties of the readings, stated or estimated; NaN without a scatter within specimens.
    noise_estimated : bool
        True if uncertainties were not stated and are estimated from the scatter.
    widening : float
        Factor on the stated uncertainties of one specimen by the scatter of its readings, at least 1.
    readings : mapping of str to float
        Coefficient for each kind of the measured rates, by its description.
    specimens : mapping of str to array
        Indices of the values of each specimen, by the name of its station.
    """

    simulation: HipSimulation
    data: tuple[MeasuredWear, ...]
    coefficient: float
    low: float
    high: float
    stations: Mapping[str, float]
    scatter: float
    results: tuple[Numbers, ...]
    uncertainty: Numbers
    noise_estimated: bool
    widening: float
    readings: Mapping[str, float]
    specimens: Mapping[str, Numbers]

    @property
    def unit(self) -> str:
        """Unit of the coefficient, such as mm³/(N m)."""
        field = coefficient_field(self.simulation.wear)
        return "" if field is None else field.unit.text

    @property
    def residuals(self) -> Numbers:
        """Measured minus simulated values, in standard uncertainties: (data,); NaN without an uncertainty."""
        return (_join(self.data) - numpy.concatenate(self.results)) / self.uncertainty

    def predict(self, cycles: float = 0.0) -> tuple[History, History, History]:
        """Simulate the coefficient and both ends of its band, with reports at the cycle counts of the data.

        Parameters
        ----------
        cycles : float
            Number of cycles of the prediction, where it goes further than the data.
        """
        counts = sorted({count for measured in self.data for count in measured.counts}) or [MILLION]
        counts += [count for count in numpy.linspace(0, cycles, _PREDICTED + 1).tolist() if count > counts[-1]]
        best = self.coefficient
        ends = (end if isfinite(end) else best for end in (max(self.low, _LEAST * best), self.high))
        runs = (replace(self.simulation, wear=with_coefficient(self.simulation.wear, end)) for end in (best, *ends))
        best_run, low_run, high_run = (run.after(counts[-1], counts) for run in runs)
        return best_run, low_run, high_run

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on rates, uncertainties, scatter and the simulation."""
        remarks = dict.fromkeys(measured.remark for measured in self.data if measured.remark)
        return (*remarks, *self._fit_notes(), *self.simulation.notes)

    def _fit_notes(self) -> Iterator[str]:
        kinds = dict.fromkeys(measured.description for measured in self.data if measured.rate is not None)
        if kinds:
            yield f"the coefficient holds for the measured rate as stated: {'; '.join(kinds)}"
        for density in dict.fromkeys(measured.density for measured in self.data if measured.density is not None):
            yield f"the measured mass is a volume by the density {density:g} mg/mm³"
        last = max((measured.cycles.max() for measured in self.data if measured.cycles is not None), default=inf)
        if last < _FEW_CYCLES:
            millions = f"if these are millions, write 'cycles [Mc]' or {last:g}e6"
            yield f"the last reading is after {counted(last, 'cycle')}: {millions}"
        yield from self._specimen_notes()
        if not isfinite(self.high):
            yield "no band: one value without an uncertainty has no scatter; state uncertainty, such as '10 %'"
        elif self.noise_estimated and numpy.isfinite(self.uncertainty).all():
            share = float((self.uncertainty / numpy.concatenate(self.results)).mean())
            yield (
                f"no uncertainty was stated: it is estimated from the scatter of the readings, {100 * share:.2g} % of "
                "each value (k = 1)"
            )
        if self.widening > _MIN_NOTED_WIDENING:
            yield f"the data scatter more than stated: the band is {self.widening:.3g} times as wide"
        yield "the band has the uncertainty of the measured wear alone, not that of loads, geometry or law"

    def _specimen_notes(self) -> Iterator[str]:
        count, unnamed = len(self.stations), [measured for measured in self.data if measured.station is None]
        if count > 1:
            yield (
                f"the coefficient is the mean of {count} specimens, which scatter by {100 * self.scatter:.2g} % "
                f"(k = 1); the band is by Student's quantile with {counted(count - 1, 'degree')} of freedom"
            )
            if self.high - self.low <= _ROUNDING * self.coefficient:
                yield "the specimens agree exactly: their scatter gives no band; state uncertainty, such as '5 %'"
            if unnamed:
                yield (
                    "no station is stated: each data set is a specimen of its own, and so is each further value at the "
                    "same cycles, in the order of the values; name the stations by the key station"
                )
        elif sum(map(len, self.data)) > 1:
            by = "the scatter of its readings as one value" if self.noise_estimated else "its stated uncertainty"
            yield (
                f"all {sum(map(len, self.data))} values are cumulative readings of one specimen"
                f"{', since no station is stated' if unnamed else ''}: the band is for this specimen alone, by {by}; "
                "other specimens scatter more, which takes several stations to see (key station)"
            )

    def summary(self) -> dict[str, Any]:
        """Return the fit as a dictionary for JSON."""
        data = [
            {
                "quantity": measured.quantity,
                "rate": measured.rate,
                "cycles": None if measured.rate is not None else measured.cycles.tolist(),
                "from": measured.begin,
                "to": measured.end,
                "unit": measured.unit,
                "density": measured.density,
                "measured": measured.values.tolist(),
                "simulated": values.tolist(),
                "stations": None if measured.station is None else list(measured.station),
            }
            for measured, values in zip(self.data, self.results, strict=True)
        ]
        ends = {"low": finite_or_none(self.low), "high": finite_or_none(self.high)}
        return {
            "law": law_summary(self.simulation.wear),
            "coefficient": {"value": self.coefficient, **ends, "unit": self.unit},
            "stations": dict(self.stations),
            "station_scatter": finite_or_none(self.scatter),
            "readings": dict(self.readings),
            "data": data,
            "noise_estimated": self.noise_estimated,
            "widening": self.widening,
            "notes": list(self.notes),
        }


def fit_wear_coefficient(simulation: HipSimulation, data: MeasuredWear | Sequence[MeasuredWear]) -> WearFit:
    """Fit the coefficient of a wear law to measured wear, with its 95 % band.

    The simulation runs at several coefficients. Between them, ln(result) is a polynomial of ln(coefficient). The
    coefficient of each specimen minimises χ² of its readings. That of several specimens is their mean, whose band has
    the scatter between them: see `mean_of_specimens`.

    Parameters
    ----------
    simulation : HipSimulation
        Hip with its cycle and wear law; its coefficient is the start of the search.
    data : MeasuredWear, or several

    Raises
    ------
    ValueError
        No data, a law without a coefficient, uncertainties of some data only, or wear that the law cannot reach.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.hip import Archard, HipSimulation, iso_14242_1
    >>> joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
    >>> simulation = HipSimulation(joint=joint, cycle=iso_14242_1(10), wear=Archard(coefficient=1e-6), ring_width=0.15)
    >>> fit = fit_wear_coefficient(simulation, MeasuredWear(quantity="volume", values=38.0, rate="initial"))
    >>> round(fit.coefficient * 1e6, 1)
    1.3
    """
    sets = (data,) if isinstance(data, MeasuredWear) else tuple(data)
    if not sets:
        raise ValueError("data must have at least one measured wear, got none")
    stated = {measured.uncertainty is not None or measured.relative_uncertainty is not None for measured in sets}
    if len(stated) > 1:
        raise ValueError("some data have an uncertainty and others have none: state it for all, or for none")
    field = coefficient_field(simulation.wear)
    if field is None:
        raise ValueError("the wear law has no coefficient: use a WearLaw such as Archard")
    start = float(getattr(simulation.wear, field.name)) or float(field.example)
    model = _WearModel(simulation=simulation, start=start, data=sets)
    nodes = _find_nodes(model)
    best = _mean_coefficient(nodes, sets, noise_estimated=False in stated)
    results = nodes.results(best.coefficient)
    return WearFit(
        simulation=replace(simulation, wear=with_coefficient(simulation.wear, best.coefficient)),
        data=sets,
        coefficient=best.coefficient,
        low=max(best.coefficient - best.half_band, 0.0),
        high=best.coefficient + best.half_band,
        stations=MappingProxyType(best.stations),
        scatter=best.scatter,
        results=tuple(numpy.split(results, numpy.cumsum([len(measured) for measured in sets])[:-1])),
        uncertainty=best.share * _standard_uncertainty(sets, results),
        noise_estimated=False in stated,
        widening=best.widening,
        readings=MappingProxyType(_readings(model, nodes)),
        specimens=MappingProxyType(_specimens(sets)),
    )


def _join(sets: Sequence[MeasuredWear]) -> Numbers:
    return numpy.concatenate([measured.values for measured in sets])


def _standard_uncertainty(sets: Sequence[MeasuredWear], fitted: Numbers) -> Numbers:
    """Join the standard uncertainties of all values, from their fitted values: (data,)."""
    parts = numpy.split(fitted, numpy.cumsum([len(measured) for measured in sets])[:-1])
    return numpy.concatenate([m.standard_uncertainty(part) for m, part in zip(sets, parts, strict=True)])


def _specimens(sets: Sequence[MeasuredWear]) -> dict[str, Numbers]:
    names: list[str] = []
    for number, measured in enumerate(sets, start=1):
        if measured.station is not None:
            names += measured.station
            continue
        counts = [0.0] * len(measured) if measured.rate is not None else measured.cycles.tolist()
        numbers = [counts[:index].count(count) for index, count in enumerate(counts)]  # repetitions of a cycle count
        title = measured.name or f"data {number}"
        title = f"{title} ({number})" if title in names else title
        names += [f"{title}, specimen {n + 1}" if max(numbers) else title for n in numbers]
    return {name: numpy.flatnonzero(numpy.array(names) == name) for name in dict.fromkeys(names)}


@dataclass(frozen=True, kw_only=True, eq=False)
class _WearModel:
    """Results of a simulation for all data sets, and for other readings of rates, at any coefficient."""

    simulation: HipSimulation
    start: float  # coefficient of the runs whose exposure is varied
    data: tuple[MeasuredWear, ...]

    @cached_property
    def readings(self) -> tuple[MeasuredWear, ...]:
        """Rates of the data in all kinds, each only once."""
        rates = [measured for measured in self.data if measured.rate is not None]
        readings = [reading for rate in rates for reading in (rate, *rate.other_readings())]
        return tuple({reading.description: reading for reading in readings}.values())

    @cached_property
    def counts(self) -> list[float]:
        """Cycle counts of all data sets and readings, in ascending order."""
        return sorted({count for measured in (*self.data, *self.readings) for count in measured.counts})

    def log_results(self, coefficients: Numbers) -> Numbers:
        """Compute ln of the results of all data sets, then of all readings, at each coefficient: (nodes, results)."""
        ratios = coefficients / self.start
        if self.simulation.creep is None and self.simulation.ball_wear is None:  # coefficient times cycles counts
            exposures = sorted({float(count * ratio) for count in self.counts for ratio in ratios})
            history = self._run(self.start, exposures)
            rows = [self._row(history, ratio, float(ratio)) for ratio in ratios]
        else:
            rows = [self._row(self._run(float(value), self.counts), 1.0, 1.0) for value in coefficients]
        return numpy.log(numpy.array(rows))

    def _run(self, coefficient: float, counts: Sequence[float]) -> History:
        simulation = replace(self.simulation, wear=with_coefficient(self.simulation.wear, coefficient))
        check_total_wear(simulation, counts[-1] if counts else MILLION)
        integrator = WearIntegrator(setup=simulation)
        reports = run_to_report_points(integrator, counts, lambda cycles: None, None)
        return History(use=simulation, reports=reports, error=NumericalError(blocks=0, volume=0, depth=0), steps=0)

    def _row(self, history: History, exposure_ratio: float, initial_ratio: float) -> list[float]:
        """Compute the results of all data sets and readings from a run whose exposures are scaled."""
        reports = {report.cycles: report for report in history.reports}
        row: list[float] = []
        for measured in (*self.data, *self.readings):

            def total(count: float, quantity: str = measured.quantity) -> float:
                report = reports[float(count * exposure_ratio)]
                if quantity == "radiographic_penetration":
                    return history.radiographic_penetration(report)
                return float(getattr(report, quantity))

            initial = getattr(history.use.first, measured.quantity, nan) * initial_ratio
            row += measured.predict(total, initial).tolist()
        return row


@dataclass(frozen=True, kw_only=True, eq=False)
class _Nodes:
    """Interpolation of ln(result) over ln(coefficient), linear beyond the outer nodes."""

    centre: float  # ln(coefficient) of the middle node
    polynomials: Numbers  # by ascending power of ln(coefficient) minus the centre: (degree + 1, results)
    n_data: int  # number of the first results that belong to measured values

    def interpolate(self, log_coefficient: float) -> Numbers:
        """Compute ln of all results at a value of ln(coefficient): (results,)."""
        shift = log_coefficient - self.centre
        inside = float(numpy.clip(shift, _NODES[0], _NODES[-1]))
        value = inside ** numpy.arange(len(self.polynomials)) @ self.polynomials
        return numpy.asarray(value + self.slopes(log_coefficient) * (shift - inside))

    def slopes(self, log_coefficient: float) -> Numbers:
        """Compute d ln(result) / d ln(coefficient) of all results: (results,)."""
        inside = float(numpy.clip(log_coefficient - self.centre, _NODES[0], _NODES[-1]))
        powers = numpy.arange(1, len(self.polynomials))
        return numpy.asarray((powers * inside ** (powers - 1)) @ self.polynomials[1:])

    def results(self, coefficient: float) -> Numbers:
        """Compute the results for all measured values: (data,)."""
        return numpy.exp(self.interpolate(log(coefficient))[: self.n_data])

    def fit(self, sets: Sequence[MeasuredWear], rows: Numbers) -> float:
        """Find ln of the coefficient that fits some of the measured values, weighted by their fitted values."""
        values = _join(sets)[rows]
        log_coefficient = self.centre
        for _ in range(_MAX_STEPS):  # Gauss-Newton, with the weights of the last step
            results = self.results(exp(log_coefficient))
            gradient = self.slopes(log_coefficient)[rows] * results[rows]
            weights = _standard_uncertainty(sets, results)[rows] ** -2.0
            step = float(weights * gradient @ (values - results[rows]) / (weights * gradient @ gradient))
            log_coefficient += min(max(step, -1.0), 1.0)
            if abs(step) < _STEP_TOLERANCE:
                break
        return log_coefficient


def _find_nodes(model: _WearModel) -> _Nodes:
    """Find nodes about the coefficient that fits all measured values."""
    values = _join(model.data)
    first = model.log_results(numpy.array([model.start]))[0, : len(values)]
    centre = log(model.start) + float(numpy.mean(numpy.log(values) - first))
    for _ in range(_MAX_CENTRES):
        log_results = model.log_results(numpy.exp(centre + _NODES))
        polynomials = numpy.polynomial.polynomial.polyfit(_NODES, log_results, _DEGREE)
        nodes = _Nodes(centre=centre, polynomials=polynomials, n_data=len(values))
        best = nodes.fit(model.data, numpy.arange(len(values)))
        if abs(best - centre) < _MAX_SHIFT:
            break
        centre = best
    return nodes


@dataclass(frozen=True, kw_only=True, eq=False)
class _MeanCoefficient:
    """Mean coefficient of all specimens, and half of its 95 % band."""

    coefficient: float
    half_band: float
    stations: dict[str, float]
    scatter: float = nan  # relative standard deviation between specimens; NaN for one
    share: float = 1.0  # estimated relative uncertainty of the readings; 1 for stated uncertainties
    widening: float = 1.0


def _mean_coefficient(nodes: _Nodes, sets: Sequence[MeasuredWear], noise_estimated: bool) -> _MeanCoefficient:
    from scipy.stats import chi2, norm, t

    values, specimens = _join(sets), _specimens(sets)
    logs = [nodes.fit(sets, rows) for rows in specimens.values()]
    own, slopes = numpy.empty_like(values), numpy.empty_like(values)
    for rows, log_coefficient in zip(specimens.values(), logs, strict=True):
        own[rows] = nodes.results(exp(log_coefficient))[rows]
        slopes[rows] = nodes.slopes(log_coefficient)[: len(values)][rows]
    sigma, freedom = _standard_uncertainty(sets, own), len(values) - len(specimens)
    chi_squared = float((((values - own) / sigma) ** 2).sum())
    share = (chi_squared / freedom) ** 0.5 if freedom else nan
    precision = numpy.array([((slopes[rows] * own[rows] / sigma[rows]) ** 2).sum() for rows in specimens.values()])
    coefficients = numpy.exp(logs)
    errors = coefficients * precision**-0.5 * (share if noise_estimated else 1.0)
    stations = dict(zip(specimens, coefficients.tolist(), strict=True))
    if len(specimens) == 1:
        widening = max(1.0, share) if freedom and not noise_estimated else 1.0
        scattered = noise_estimated or (widening > 1 and chi2.sf(chi_squared, freedom) < _SIGNIFICANCE)
        quantile = float(t.ppf(0.975, freedom) if scattered else norm.ppf(0.975))
        count = len(values) if noise_estimated else 1  # errors of cumulative readings do not cancel
        return _MeanCoefficient(
            coefficient=float(coefficients[0]),
            half_band=quantile * widening * count**0.5 * float(errors[0]),
            stations=stations,
            share=share if noise_estimated else 1.0,
            widening=widening,
        )
    mean = mean_of_specimens(coefficients, numpy.nan_to_num(errors) ** 2, min_ratio=0.0 if noise_estimated else 1.0)
    return _MeanCoefficient(
        coefficient=mean.mean,
        half_band=float(t.ppf(0.975, len(specimens) - 1)) * mean.standard_error,
        stations=stations,
        scatter=mean.scatter / mean.mean,
        share=share if noise_estimated else 1.0,
    )


def _readings(model: _WearModel, nodes: _Nodes) -> dict[str, float]:
    """Compute the coefficient for each kind of the measured rates, by its description."""
    from scipy.optimize import brentq

    readings: dict[str, float] = {}
    start = sum(map(len, model.data))
    for reading in model.readings:
        target = log(float(reading.values.mean()))

        def excess(log_coefficient: float, column: int = start, target: float = target) -> float:
            """Compute ln of the result minus ln of the measured rate."""
            return float(nodes.interpolate(log_coefficient)[column]) - target

        ends = nodes.centre - _MAX_LOG_RANGE, nodes.centre + _MAX_LOG_RANGE
        readings[reading.description] = exp(brentq(excess, *ends))
        start += len(reading)
    return readings


@dataclass(frozen=True, kw_only=True)
class SpecimenMean:
    """Mean over specimens that differ from each other."""

    mean: float
    # standard uncertainty of the mean, for Student's quantile with one degree of freedom less than specimens
    standard_error: float
    scatter: float  # standard deviation between specimens, without the errors of their readings


def mean_of_specimens(values: Numbers, variances: Numbers, min_ratio: float) -> SpecimenMean:
    """Compute the mean over specimens whose values have different variances by their readings; two or more.

    The variance between specimens is by Paule & Mandel 1982 (doi:10.6028/jres.087.022), the standard error by Hartung &
    Knapp 2001 (doi:10.1002/sim.791). For equal variances they are mean and standard error of the values themselves.
    `min_ratio` is the least ratio of the observed scatter to the scatter that the variances explain: 1 for stated
    errors, below which chance is no reason for a narrower band; 0 for errors that are estimated from the same readings.
    """
    from scipy.optimize import brentq

    freedom = len(values) - 1

    def ratio(between: float) -> float:
        """Compute the ratio of observed to explained scatter for a variance between specimens."""
        weights = 1 / (variances + between)
        return float(weights @ (values - weights @ values / weights.sum()) ** 2) / freedom

    squares = float(((values - values.mean()) ** 2).sum())
    negligible = 1e-12 * squares + 1e-30 * float((values**2).max()) + 1e-300  # at least the rounding of the mean
    between, observed = negligible, ratio(negligible)
    if observed > 1:
        between, observed = float(brentq(lambda v: ratio(v) - 1, negligible, 2 * squares, xtol=negligible)), 1.0
    weights = 1 / (variances + between)
    return SpecimenMean(
        mean=float(weights @ values / weights.sum()),
        standard_error=float((max(observed, min_ratio) / weights.sum()) ** 0.5),
        scatter=0.0 if between == negligible else between**0.5,
    )
