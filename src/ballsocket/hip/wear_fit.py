"""Wear coefficient from measured volumes, depths, penetrations or rates, of a wear test or of patients."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import exp, inf, isfinite, log, nan
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import known_name, require, shown
from ..core.display import finite_or_none, plain_number
from .history import History, NumericalError
from .law_fields import law_summary
from .simulation import HipSimulation, check_total_wear, run_to_report_points
from .specimens import mean_of_specimens
from .wear_integrator import WearIntegrator
from .wear_law import coefficient_field, with_coefficient

WEAR_QUANTITIES: Mapping[str, str] = MappingProxyType(
    {"volume": "mm³", "depth": "mm", "penetration": "mm", "radiographic_penetration": "mm"}
)
"""Measured quantities with units: worn volume, deepest wear, displacement of the ball, and that in a radiograph."""

RATES = ("initial", "steady", "mean")
"""Kinds of rates: of the new bore, between two cycle counts, and from the new bore to a cycle count."""

_MILLION = 1e6
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
class MeasuredWear:
    """Measured wear: totals at cycle counts, or a rate per million cycles.

    Parameters
    ----------
    quantity : str
        One of `WEAR_QUANTITIES`.
    values : number or array
        Totals in mm³ or mm, or rates in mm³ or mm per million cycles.
    cycles : number or array, optional
        Cycle count of each total.
    rate : str, optional
        Kind of a rate: "initial" of the new bore, "steady" from `begin` to `end`, "mean" from 0 to `end`.
    begin, end : float, optional
        Cycle counts of a rate.
    uncertainty : number or array, optional
        Standard uncertainty (k = 1) in the unit of the values. Without any, it is estimated from the scatter.
    relative_uncertainty : float, optional
        Standard uncertainty as a share of each true value, for which the fit has its fitted values: a reading that is
        low by chance has no larger weight.
    station : str or sequence of str, optional
        Station (specimen) of all values, or of each. Readings of one station at several cycle counts are cumulative
        and no independent values. Without it a data set is one specimen, and further values at the same cycle counts
        are further specimens, in the order of the values.
    density : float, optional
        Density in mg/mm³ by which a measured mass is the volume of the values; it is printed as the mass.
    name : str
        Name in messages.
    remark : str
        Sentence on lines of its file that are left out; empty without any.

    Raises
    ------
    ValueError
        A quantity or rate that is not known, missing cycles, or a number that is not allowed.

    Examples
    --------
    >>> MeasuredWear(quantity="volume", values=38.0, rate="steady", begin=5e6, end=1e7).description
    'volume rate, steady from 5 to 10 million cycles'
    """

    quantity: str
    values: Any
    cycles: Any = None
    rate: str | None = None
    begin: float | None = None
    end: float | None = None
    uncertainty: Any = None
    relative_uncertainty: float | None = None
    station: str | Sequence[str] | None = None
    density: float | None = None
    name: str = ""
    remark: str = ""

    def __post_init__(self) -> None:
        known_name("quantity", self.quantity, WEAR_QUANTITIES)
        values = _positive_array(self.quantity, self.values, "a measured wear is positive and finite")
        object.__setattr__(self, "values", values)
        if self.rate is None:
            self._check_totals(values)
        else:
            self._check_rate(known_name("rate", self.rate, RATES))
        if self.uncertainty is not None:
            sigma = _positive_array("uncertainty", self.uncertainty, "a standard uncertainty is positive and finite")
            if sigma.size not in (1, values.size):
                raise ValueError(f"uncertainty must have 1 or {values.size} numbers, got {sigma.size}")
            object.__setattr__(self, "uncertainty", numpy.broadcast_to(sigma, values.shape))
        if (share := self.relative_uncertainty) is not None:
            require("relative_uncertainty", share, 0 < share < inf, "a share of each value is positive and finite")
            if self.uncertainty is not None:
                raise ValueError("uncertainty and relative_uncertainty exclude each other: state one of them")
        if self.station is not None:
            names = (self.station,) * values.size if isinstance(self.station, str) else tuple(self.station)
            if len(names) != values.size:
                raise ValueError(f"station has {len(names)} names for {values.size} values: one name, or one for each")
            object.__setattr__(self, "station", names)

    def _check_totals(self, values: Numbers) -> None:
        if self.begin is not None or self.end is not None:
            raise ValueError(f"from and to belong to a rate of {self.quantity}: state rate, or cycles for totals")
        if self.cycles is None:
            raise ValueError(
                f"{self.quantity} needs the cycles of its values, or else the kind of its rate: {', '.join(RATES)}"
            )
        cycles = _positive_array("cycles", self.cycles, "a number of cycles is positive and finite")
        if cycles.size != values.size:
            raise ValueError(f"{self.quantity} has {values.size} values and {cycles.size} cycles: one for each value")
        object.__setattr__(self, "cycles", cycles)

    def _check_rate(self, rate: str) -> None:
        quantity, begin = self.quantity, self.begin or 0.0
        if self.cycles is not None:
            raise ValueError(f"a rate of {quantity} takes from and to, not cycles")
        if rate == "initial":
            if quantity not in ("volume", "depth"):
                raise ValueError(f"an initial rate of {quantity} is not defined: use volume, or a steady rate")
            if self.begin is not None or self.end is not None:
                raise ValueError("an initial rate is that of the new bore: remove from and to")
            return
        if self.end is None or (rate == "steady" and self.begin is None):
            needed = "from and to" if rate == "steady" else "to"
            raise ValueError(f"a {rate} rate of {quantity} needs {needed}: numbers of cycles, such as to = 5e6")
        if rate == "mean" and self.begin:
            raise ValueError(f"a mean rate is from 0 cycles, got from = {shown(self.begin)}: use rate = 'steady'")
        rule = f"it is above the {plain_number(begin)} cycles of from, and finite"
        require("to", self.end, 0 <= begin < self.end < inf, rule)

    def __len__(self) -> int:
        return len(self.values)

    @property
    def specimen_numbers(self) -> list[int]:
        """Number of the specimen of each value in a data set without stations, from 0: its repetition of a count."""
        counts = [0.0] * len(self) if self.rate is not None else self.cycles.tolist()
        return [counts[:index].count(count) for index, count in enumerate(counts)]

    def standard_uncertainty(self, fitted: Numbers) -> Numbers:
        """Compute the standard uncertainty of each value from its fitted value, which it is itself if unknown."""
        if self.uncertainty is not None:
            return numpy.asarray(self.uncertainty)
        return fitted if self.relative_uncertainty is None else self.relative_uncertainty * fitted

    @property
    def unit(self) -> str:
        """Unit of the values: mm³ or mm, for a rate per million cycles (Mc)."""
        return WEAR_QUANTITIES[self.quantity] + ("" if self.rate is None else "/Mc")

    @property
    def measured_quantity(self) -> str:
        """Measured quantity in words: the mass, if a density is stated."""
        return self.quantity.replace("_", " ") if self.density is None else "mass"

    @property
    def description(self) -> str:
        """Quantity, kind of rate and cycle counts in words."""
        quantity = self.measured_quantity
        if self.rate is None:
            return f"{quantity} after {', '.join(f'{count / _MILLION:g}' for count in self.cycles)} million cycles"
        if self.rate == "initial":
            return f"{quantity} rate, initial, of the new bore"
        begin, end = ((count or 0.0) / _MILLION for count in (self.begin, self.end))
        return f"{quantity} rate, {self.rate} from {begin:g} to {end:g} million cycles"

    @property
    def counts(self) -> list[float]:
        """Cycle counts at which the simulation is needed; empty for an initial rate."""
        if self.rate is None:
            return [float(count) for count in self.cycles]
        return [float(count) for count in (self.begin, self.end) if count]

    def predict(self, totals: Callable[[float], float], initial: float) -> Numbers:
        """Compute the values of this data set from totals by cycle count, and the initial rate per million cycles."""
        if self.rate is None:
            return numpy.array([totals(count) for count in self.counts])
        if self.rate == "initial":
            return numpy.full(len(self), initial)
        begin, end = float(self.begin or 0.0), float(self.end or 0.0)
        start = totals(begin) if begin else 0.0
        return numpy.full(len(self), _MILLION * (totals(end) - start) / (end - begin))

    def other_readings(self) -> Iterator[MeasuredWear]:
        """Yield this rate as those of other kinds: of the new bore, of the second million, from 5 to 10 million."""
        if self.quantity in ("volume", "depth"):
            yield replace(self, rate="initial", begin=None, end=None)
        for begin, end in ((1e6, 2e6), (5e6, 1e7)):
            yield replace(self, rate="steady", begin=begin, end=end)


def _positive_array(name: str, numbers: Any, rule: str) -> Numbers:
    """Convert a number or a sequence to an array; ValueError for numbers that are not positive and finite."""
    array = numpy.atleast_1d(numpy.asarray(numbers, dtype=float))
    require(name, array, (array > 0) & (array < inf), rule)
    return array


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
        counts = sorted({count for measured in self.data for count in measured.counts}) or [_MILLION]
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
            yield f"the last reading is after {last:g} cycles: if these are millions, write 'cycles [Mc]' or {last:g}e6"
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
                f"(k = 1); the band is by Student's quantile with {count - 1} degree{'s' * (count > 2)} of freedom"
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
        title, numbers = measured.name or f"data {number}", measured.specimen_numbers
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
        check_total_wear(simulation, counts[-1] if counts else _MILLION)
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
