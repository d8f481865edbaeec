"""A fitted model: best point, information, estimates with bands, and residuals."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..core.deprecation import RenamedAttribute, renamed_arguments
from ..problem import Joint
from ..studies.parameters import vary_joint
from .estimates import Estimate
from .forward_model import insert_numbers, split_numbers
from .information import Information
from .measured import Measured
from .misfit import FitResult, Misfit
from .unknowns import ParameterTransform, Unknown


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
    answers = RenamedAttribute("results")
    scales = RenamedAttribute("transform")

    @property
    def model(self) -> Model:
        """Contact model with the best-fit values of its numbers."""
        return insert_numbers(self.misfit.forward.model, split_numbers(self.point)[1])

    @property
    def data(self) -> tuple[Measured, ...]:
        """Data sets of the fit."""
        return self.misfit.forward.data

    @property
    def transform(self) -> ParameterTransform:
        """Transform between values of the unknowns and scaled parameters theta."""
        return self.misfit.transform

    @cached_property
    def point(self) -> dict[str, float]:
        """Best-fit values by unknown, in mm, N, MPa, rad.

        Other values of an unidentifiable unknown fit the data as well.
        """
        values = self.transform.to_values(self.best.theta).tolist()
        return dict(zip(self.transform.names, values, strict=True))

    @property
    def joint(self) -> Joint:
        """Joint with the best-fit values of its numbers."""
        return vary_joint(self.misfit.forward.joint, split_numbers(self.point)[0])[0]

    @cached_property
    def estimates(self) -> dict[str, Estimate]:
        """Estimates with 95 % bands, by unknown; NaN for the value of an unidentifiable unknown."""
        return {unknown.name: self._estimate(index) for index, unknown in enumerate(self.transform.unknowns)}

    def _estimate(self, index: int) -> Estimate:
        """Make the estimate of one unknown from its profile interval."""
        unknown, information = self.transform.unknowns[index], self.information
        interval, name = information.intervals[index], unknown.name
        ends = (interval.low, interval.high)
        low, high = (_snap_to_range(unknown, self.transform.to_values(end.theta)[index]) for end in ends)
        value = float("nan") if name in information.unidentifiable else self.point[name]
        width, limits = information.deviations[name], information.limited_by(name)
        return Estimate(name, unknown.quantity.unit, value, low, high, width, limits)

    def __getitem__(self, name: str) -> Estimate:
        key = name.replace(".", "_")
        return self.estimates[key if key in self.estimates else name]

    @cached_property
    def results(self) -> tuple[Numbers, ...]:
        """Model results at the best point, one array per data set."""
        results = self.misfit.forward.results_at(self.transform.to_values(self.best.theta[None]))[0]
        return self._split_by_data_set(results)

    @renamed_arguments(place="index")
    def curve(self, index: int, count: int = 60) -> tuple[Numbers, Numbers]:
        """Compute the fitted curve over the load range of a data set.

        The data set has no angles.

        Parameters
        ----------
        index : int
            Index of the data set.
        count : int
            Number of points.

        Returns
        -------
        loads : array (count,)
            Loads from the least to the largest of the data set.
        results : array (count,)
            Results of the model at the best point.
        """
        measured = self.data[index]
        loads = numpy.linspace(measured.loads.min(), measured.loads.max(), count)
        changes: dict[str, Any] = {measured.load: loads, "values": numpy.ones(count), "saturation": inf}
        ascending = numpy.argsort(measured.loads)
        order = numpy.interp(loads, measured.loads[ascending], measured.order[ascending])
        row = replace(measured, uncertainty=1.0, load_uncertainty=0.0, order=order, **changes)
        forward = replace(self.misfit.forward, data=(row,))
        return loads, forward.results_at(self.transform.to_values(self.best.theta[None]))[0]

    @property
    def residuals(self) -> tuple[Numbers, ...]:
        """Residuals (value minus result, over the stated uncertainty), one array per data set.

        For a saturated value it is the shortfall.
        """
        z = self.misfit.widening * self.misfit.standardised_residuals(numpy.concatenate(self.results))
        return self._split_by_data_set(numpy.where(self.misfit.saturated, numpy.maximum(-z, 0.0), -z))

    def _split_by_data_set(self, row: Numbers) -> tuple[Numbers, ...]:
        """Split an array (data,) into one array per data set."""
        return tuple(numpy.split(row, numpy.cumsum([len(measured) for measured in self.data])[:-1]))

    @property
    def freedom(self) -> int:
        """Degrees of freedom: number of values minus unknowns without a stated distribution."""
        return self.misfit.freedom

    @property
    def spread(self) -> float:
        """Birge's ratio: root of χ² over the degrees of freedom, 1 for correct uncertainties.

        It is NaN without degrees of freedom.
        """
        total = sum(float(numpy.sum(row**2)) for row in self.residuals)
        return (total / self.freedom) ** 0.5 if self.freedom > 0 else float("nan")

    @property
    def identifiable(self) -> bool:
        """True if every unknown without a stated distribution is identifiable."""
        return not self.information.unidentifiable


def _snap_to_range(unknown: Unknown, value: float) -> float:
    """Return an end of a band, or the end of the range if both are equal within rounding."""
    return next((end for end in (unknown.low, unknown.high) if abs(value - end) <= 1e-9 * abs(end)), float(value))
