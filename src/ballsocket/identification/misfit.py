"""Residuals of a model against the data, and their derivatives by differences or by JAX."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import needs
from .forward_model import ForwardModel
from .scatter import ScatterModel
from .unknowns import ParameterTransform, log_prior

Slopes = Callable[[ForwardModel, ParameterTransform, Numbers], tuple[Numbers, Numbers]]
"""Function from theta (..., unknowns) to results (..., data) and derivatives (..., data, unknowns)."""


def by_differences(forward: ForwardModel, transform: ParameterTransform, theta: Numbers) -> tuple[Numbers, Numbers]:
    """Compute model results and their derivatives with respect to theta by central differences; see `Slopes`.

    One array call computes all points. At the ends of the ranges, differences are one-sided. A result is NaN where the
    model has none.
    """
    unknown_count = theta.shape[-1]
    points = theta.reshape(-1, 1, unknown_count)
    step = forward.model.smooth_step * numpy.eye(unknown_count)
    stencil = numpy.concatenate([points, points + step, points - step], axis=1)
    stencil = numpy.clip(stencil, transform.low, transform.high)
    results = forward.results_at(transform.to_values(stencil.reshape(-1, unknown_count))).reshape(
        *stencil.shape[:2], -1
    )
    centre, above, below = results[:, 0], results[:, 1 : 1 + unknown_count], results[:, 1 + unknown_count :]
    theta_above, theta_below = (
        numpy.diagonal(half_stencil, axis1=1, axis2=2) for half_stencil in numpy.split(stencil[:, 1:], 2, axis=1)
    )
    above, theta_above = _replace_missing_neighbours(above, theta_above, centre, points[:, 0])
    below, theta_below = _replace_missing_neighbours(below, theta_below, centre, points[:, 0])
    slopes = (above - below) / numpy.where(theta_above > theta_below, theta_above - theta_below, inf)[..., None]
    shape = theta.shape[:-1]
    return centre.reshape(*shape, -1), slopes.swapaxes(1, 2).reshape(*shape, -1, unknown_count)


def _replace_missing_neighbours(
    results: Numbers, theta: Numbers, centre: Numbers, points: Numbers
) -> tuple[Numbers, Numbers]:
    """Replace neighbouring points at which the model has no result by the central point."""
    missing = numpy.isnan(results).any(axis=-1)
    return numpy.where(missing[..., None], centre[:, None], results), numpy.where(missing, points, theta)


def by_tracing(forward: ForwardModel, transform: ParameterTransform, theta: Numbers) -> tuple[Numbers, Numbers]:
    """Compute model results and their derivatives with respect to theta by JAX.

    Theta has the shape (..., unknowns), results (..., data), derivatives (..., data, unknowns). The first call for a
    set of data compiles the model, which takes seconds.

    Raises ValueError: a model that JAX cannot trace.
    Raises ImportError: JAX is not installed.
    """
    if not forward.model.differentiable:
        raise ValueError(f"{forward.model.name} cannot be traced by JAX: use by_differences")
    needs("jax", "jax")
    import jax

    values = transform.to_values(theta)
    with jax.enable_x64(True):
        results_and_slopes = [
            _compile_forward_model(forward)(point_values) for point_values in values.reshape(-1, values.shape[-1])
        ]
    results, slopes = (
        numpy.stack([numpy.asarray(point_result[index]) for point_result in results_and_slopes]) for index in (0, 1)
    )
    shape = theta.shape[:-1]
    slopes = slopes.reshape(*shape, -1, theta.shape[-1])
    return results.reshape(*shape, -1), slopes * transform.derivatives(theta)[..., None, :]


@lru_cache(maxsize=8)
def _compile_forward_model(forward: ForwardModel) -> Callable[[Numbers], tuple[Any, Any]]:
    import jax

    def results_of_point(values: Any) -> Any:
        return forward.results_at(values[None, :])[0]

    compiled: Callable[[Numbers], tuple[Any, Any]] = jax.jit(
        lambda values: (results_of_point(values), jax.jacfwd(results_of_point)(values))
    )
    return compiled


@dataclass(frozen=True, eq=False)
class FitResult:
    """Result of a search for the best fit."""

    theta: Numbers  # (unknowns,), best point, in standard deviations of the priors
    cost: float  # minus ln of the posterior density, up to a constant
    converged: bool
    rivals: tuple[Numbers, ...] = ()  # distant ends of other searches with nearly the same cost


@dataclass(frozen=True, eq=False)
class Misfit:
    """Residuals between data and model results for a least-squares fit.

    Half of their sum of squares is minus ln of the posterior density, up to a constant.
    """

    forward: ForwardModel
    transform: ParameterTransform
    scatter: ScatterModel
    slopes: Slopes  # `by_differences`, or `by_tracing`
    uncertainty: Numbers  # (data,)
    widening: float = 1.0  # factor on all uncertainties, 1 or more: observed scatter over the stated uncertainties
    noise_freedom: float = inf  # degrees of freedom of estimated uncertainties; infinite if all are stated

    @cached_property
    def value(self) -> Numbers:
        """Measured values (data,); a saturated value is replaced by its limit."""
        return numpy.concatenate([numpy.minimum(data.values, data.saturation) for data in self.forward.data])

    @cached_property
    def saturated(self) -> Numbers:
        """Mask (data,) of the values that are lower bounds."""
        return numpy.concatenate([data.saturated for data in self.forward.data])

    @property
    def freedom(self) -> int:
        """Number of degrees of freedom: values minus unknowns without a stated distribution."""
        return len(self.value) - int(numpy.sum(~self.transform.has_distribution))

    def results_at(self, theta: Numbers) -> Numbers:
        """Compute the model results (points, data) at points theta (points, unknowns)."""
        return self.forward.results_at(self.transform.to_values(theta))

    def standardised_residuals(self, results: Numbers) -> Numbers:
        """Compute the residuals (result - value)/uncertainty of model results."""
        return (results - self.value) / (self.widening * self.uncertainty)

    def residuals(self, results: Numbers) -> Numbers:
        """Compute the least-squares residuals of model results for the distribution of the scatter.

        Half the sum of squares is minus ln of the likelihood, up to a constant.
        """
        z = self.standardised_residuals(results)
        return numpy.where(self.saturated, self.scatter.censored(z)[0], self.scatter.misfit(z))

    def residuals_and_slopes(self, theta: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the residuals (..., data) of data and priors at theta, and their derivatives."""
        results, slopes = self.slopes(self.forward, self.transform, theta)
        standardised = self.standardised_residuals(results)
        residual_slopes = numpy.where(
            self.saturated, self.scatter.censored(standardised)[1], self.scatter.slope(standardised)
        ) / (self.widening * self.uncertainty)
        has_distribution = self.transform.has_distribution
        prior_slopes = numpy.eye(theta.shape[-1])[has_distribution]
        prior_slopes = numpy.broadcast_to(prior_slopes, (*theta.shape[:-1], *prior_slopes.shape))
        residuals = [self.residuals(results), self.transform.prior_residuals(theta)[..., has_distribution]]
        all_slopes = [residual_slopes[..., None] * slopes, prior_slopes]
        return numpy.concatenate(residuals, axis=-1), numpy.concatenate(all_slopes, axis=-2)

    def costs(self, theta: Numbers) -> Numbers:
        """Compute half of the sum of squared residuals at each point theta (points, unknowns): (points,).

        The priors are the stated distributions. The cost is infinite without a result; shape (points,).
        """
        residuals = numpy.concatenate(
            [self.residuals(self.results_at(theta)), self.transform.prior_residuals(theta)], axis=1
        )
        cost = numpy.sum(residuals**2, axis=1) / 2
        return numpy.where(numpy.isfinite(cost), cost, inf)

    def log_posterior(self, theta: Numbers) -> Numbers:
        """Compute the logarithm of the posterior density at each point theta, up to a constant: (points,).

        All values in a range are equally likely.
        """
        log_prior_density = log_prior(self.transform, theta)
        residuals = self.residuals(self.results_at(numpy.clip(theta, self.transform.low, self.transform.high)))
        log_density = log_prior_density - numpy.sum(residuals**2, axis=1) / 2
        return numpy.where(numpy.isfinite(log_density), log_density, -inf)

    def weighted_slopes(self, theta: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the derivatives J (data, unknowns) of the results at theta, and Jᵀ W with the weights of the values.

        Jᵀ W J is the Fisher information of the data about theta. The weight of a value is its Fisher information about
        the model result, in 1/unit². For a saturated value it is -d²/dz² of ln P(reading above): h² + h s, with the
        hazard h and the slope s of -ln of the density.
        """
        results, slopes = self.slopes(self.forward, self.transform, theta)
        z = self.standardised_residuals(results)
        residual, slope = self.scatter.censored(z)
        hazard, density_slope = -residual * slope, self.scatter.misfit(z) * self.scatter.slope(z)
        censored = numpy.maximum(hazard * (hazard + density_slope), 0.0)
        information = numpy.where(self.saturated, censored, self.scatter.information)
        return slopes, slopes.T * (information / (self.widening * self.uncertainty) ** 2)
