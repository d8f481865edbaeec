"""Fit of a model to data: search for the best point, and the fitted model with its estimates and residuals."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..core.validity import check_domain
from ..problem import Joint
from ..studies.parameters import vary_joint
from .forward_model import insert_model_numbers, split_joint_and_model_values
from .information import Estimate, Information
from .measured import Measured
from .misfit import FitResult, Misfit
from .unknowns import ParameterTransform

_SEARCH_SECONDS = 3.0  # time limit of the global search
_MIN_POINTS, _MAX_POINTS = 16, 128  # points of the global search
_SAME_POINT = 1e-2  # distance in theta below which two searches have one end
_RIVAL_COST = 2.0  # excess of the cost below which another end counts as a rival
_MAX_EVALUATIONS = 60
_EQUAL_COST = 1e-6  # difference of cost that counts as equal


def find_best_fit(misfit: Misfit, seed: int) -> FitResult:
    """Find the best fit of the unknowns: a global search, then least squares from its best points.

    Of equal fits it is the one nearest to the middle of the ranges.

    Raises ValueError: the model has no result for all data at any point within the ranges.
    Raises OutsideDomainError: the model has no result for such joints.
    """
    ends = [minimise_misfit(misfit, start) for start in _choose_starting_points(misfit, seed)]
    least_cost, middle = min(end.cost for end in ends), (misfit.transform.low + misfit.transform.high) / 2
    lowest = [end for end in ends if end.cost <= least_cost + _EQUAL_COST]
    best = min(lowest, key=lambda end: float(numpy.max(abs(end.theta - middle))))
    distant = [end for end in ends if numpy.max(abs(end.theta - best.theta)) > _SAME_POINT]
    rivals = tuple(end.theta for end in distant if end.cost < best.cost + _RIVAL_COST)
    return FitResult(best.theta, best.cost, best.converged, rivals)


def _choose_starting_points(misfit: Misfit, seed: int) -> list[Numbers]:
    """Choose the point of lowest cost of a Sobol sequence over the search ranges, and the best point far from it."""
    from scipy.stats import qmc

    low, high = misfit.transform.low, misfit.transform.high
    model = misfit.forward.model
    seconds_per_point = model.seconds_a_press * len(misfit.value)
    point_count = 1 << (int(numpy.clip(_SEARCH_SECONDS / seconds_per_point, _MIN_POINTS, _MAX_POINTS)).bit_length() - 1)
    fractions = qmc.Sobol(len(low), rng=numpy.random.default_rng(seed)).random(point_count)
    points = low + fractions * (high - low)
    costs = misfit.costs(points)
    if not numpy.isfinite(costs).any():
        check_domain(model.domain, misfit.forward.joint, model.name)
        raise ValueError(
            f"{model.name} has no result for all the data anywhere within the ranges: check the measured values, the "
            "ranges and the model"
        )
    best_index = int(numpy.argmin(costs))
    distant_mask = numpy.max(abs(points - points[best_index]), axis=1) > 0.25 * numpy.max(high - low)
    distant_index = int(numpy.argmin(numpy.where(distant_mask, costs, numpy.inf)))
    has_distant = numpy.isfinite(costs[distant_index]) and distant_mask[distant_index]
    return [points[best_index], points[distant_index]] if has_distant else [points[best_index]]


def minimise_misfit(misfit: Misfit, start: Numbers) -> FitResult:
    """Minimise the misfit from a starting point theta by least squares."""
    from scipy.optimize import least_squares

    cache: dict[bytes, tuple[Numbers, Numbers]] = {}

    def residuals_and_slopes(theta: Numbers) -> tuple[Numbers, Numbers]:
        """Compute residuals and derivatives, and cache those of the last point."""
        key = theta.tobytes()
        if key not in cache:
            cache.clear()
            cache[key] = misfit.residuals_and_slopes(theta)
        return cache[key]

    solution = least_squares(
        lambda theta: residuals_and_slopes(theta)[0],
        start,
        jac=lambda theta: residuals_and_slopes(theta)[1],
        bounds=(misfit.transform.low, misfit.transform.high),
        x_scale=1.0,
        ftol=1e-10,
        xtol=1e-8,
        gtol=1e-8,
        max_nfev=_MAX_EVALUATIONS,
    )
    return FitResult(solution.x, float(solution.cost), bool(solution.success))


@dataclass(frozen=True, eq=False, repr=False)
class FittedModel:
    """Contact model fitted to measured data, with estimates and residuals.

    Attributes
    ----------
    misfit : Misfit
        Data, model and unknowns.
    best : FitResult
        Point of the smallest misfit.
    information : Information
        Information at that point, and profile intervals of the unknowns.
    """

    misfit: Misfit
    best: FitResult
    information: Information

    @property
    def model(self) -> Model:
        """Contact model, whose parameters have their best-fit values."""
        return insert_model_numbers(self.misfit.forward.model, split_joint_and_model_values(self.point)[1])

    @property
    def data(self) -> tuple[Measured, ...]:
        """Data sets to which the model is fitted."""
        return self.misfit.forward.data

    @property
    def transform(self) -> ParameterTransform:
        """Transform between values of the unknowns and scaled parameters theta of the search."""
        return self.misfit.transform

    @cached_property
    def point(self) -> dict[str, float]:
        """Best-fit value of each unknown, by name, in mm, N, MPa and rad.

        Other values of an unidentifiable unknown fit the data as well.
        """
        values = self.transform.to_values(self.best.theta).tolist()
        return dict(zip(self.transform.names, values, strict=True))

    @property
    def joint(self) -> Joint:
        """Joint, whose numbers have their best-fit values."""
        return vary_joint(self.misfit.forward.joint, split_joint_and_model_values(self.point)[0])[0]

    @cached_property
    def estimates(self) -> dict[str, Estimate]:
        """Estimate with 95 % band of each unknown, by name; the value is NaN if unidentifiable."""
        estimates, information = {}, self.information
        for index, unknown in enumerate(self.transform.unknowns):
            interval, name = information.intervals[index], unknown.name
            values = (self.transform.to_values(end.theta)[index] for end in (interval.low, interval.high))
            low, high = (  # an end of the search range, except for rounding
                next((end for end in (unknown.low, unknown.high) if abs(value - end) <= 1e-9 * abs(end)), float(value))
                for value in values
            )
            value = float("nan") if name in information.unidentifiable else self.point[name]
            width_ratio, limiting_names = information.deviations[name], information.limited_by(name)
            estimates[name] = Estimate(name, unknown.quantity.unit, value, low, high, width_ratio, limiting_names)
        return estimates

    def __getitem__(self, name: str) -> Estimate:
        key = name.replace(".", "_")
        return self.estimates[key if key in self.estimates else name]

    @cached_property
    def results(self) -> tuple[Numbers, ...]:
        """Model results for the best-fit values, one array for each data set."""
        return self._split_by_data_set(self.misfit.results_at(self.best.theta[None])[0])

    def curve(self, index: int, count: int = 60) -> tuple[Numbers, Numbers]:
        """Compute model results at equally spaced loads over the load range of a data set.

        The data set has no angles. Returns the loads, from the least to the largest, and the results of the model at
        the best point, both of shape (count,).
        """
        measured = self.data[index]
        loads = numpy.linspace(measured.loads.min(), measured.loads.max(), count)
        changes: dict[str, Any] = {measured.load: loads, "values": numpy.ones(count), "saturation": inf}
        load_order = numpy.argsort(measured.loads)
        reading_numbers = numpy.interp(loads, measured.loads[load_order], measured.order[load_order])
        curve_data = replace(
            measured, uncertainty=1.0, relative_uncertainty=0.0, load_uncertainty=0.0, order=reading_numbers, **changes
        )
        forward = replace(self.misfit.forward, data=(curve_data,))
        return loads, forward.results_at(self.transform.to_values(self.best.theta[None]))[0]

    @property
    def residuals(self) -> tuple[Numbers, ...]:
        """Measured values minus model results, divided by the stated uncertainties; one array per data set.

        For a saturated value it is the shortfall.
        """
        standardised = self.misfit.widening * self.misfit.standardised_residuals(numpy.concatenate(self.results))
        return self._split_by_data_set(
            numpy.where(self.misfit.saturated, numpy.maximum(-standardised, 0.0), -standardised)
        )

    @property
    def uncertainties(self) -> tuple[Numbers, ...]:
        """Standard uncertainties of the values, stated or estimated, before any widening; one array per data set."""
        return self._split_by_data_set(self.misfit.uncertainty)

    def _split_by_data_set(self, values: Numbers) -> tuple[Numbers, ...]:
        return tuple(numpy.split(values, numpy.cumsum([len(measured) for measured in self.data])[:-1]))

    @property
    def freedom(self) -> int:
        """Number of degrees of freedom: values minus unknowns without a stated distribution."""
        return self.misfit.freedom

    @property
    def spread(self) -> float:
        """Birge's ratio, the root of χ² over the degrees of freedom; 1 for correct uncertainties.

        It is NaN without degrees of freedom.
        """
        chi_squared = sum(float(numpy.sum(residuals**2)) for residuals in self.residuals)
        return (chi_squared / self.freedom) ** 0.5 if self.freedom > 0 else float("nan")

    @property
    def identifiable(self) -> bool:
        """True if every unknown without a stated distribution is identifiable."""
        return not self.information.unidentifiable
