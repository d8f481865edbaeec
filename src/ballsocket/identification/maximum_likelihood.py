"""Identification of joint parameters from measurements, with bands and identifiability."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy

from ..contact import Model
from ..contact.assembly import check_joint
from ..core.arrays import Numbers, is_plain_number
from ..core.checks import shown
from ..core.display import counted
from ..problem import Joint
from .bands import compute_bands
from .fit import find_best_fit, minimise_misfit
from .forward_model import ForwardModel
from .measured import Measured
from .misfit import FitResult, Misfit, Slopes, by_differences
from .registry import OBSERVABLE_NUMBERS
from .result import IdentificationResult
from .scatter import NormalScatter, ScatterModel
from .unknowns import ParameterTransform, Prior, Unknown, collect_unknowns

_NORMAL = NormalScatter()
_WEIGHT_ITERATIONS = 2  # fits with weights that depend on the best point
_NOISE_ITERATIONS = 20  # largest number of fits with estimated uncertainties
_NOISE_TOLERANCE = 1e-3  # relative tolerance of an estimated uncertainty
_MIN_NOISE_FREEDOM = 0.5  # smallest number of degrees of freedom of an estimated uncertainty
_MIN_RELATIVE_NOISE = 1e-6  # smallest estimated uncertainty over the largest value
_LOAD_STEP = 1e-3  # relative change of the loads for central differences


def identify(
    model: Model,
    joint: Joint,
    data: Measured | Sequence[Measured],
    free: Mapping[str, Prior],
    *,
    scatter: ScatterModel = _NORMAL,
    slopes: Slopes = by_differences,
    seed: int = 0,
) -> IdentificationResult:
    """Identify parameters of a joint from measurements, with 95 % bands and identifiability.

    The method is maximum likelihood, with the stated distributions of unknowns, by least squares after a global search.
    Bands of 95 % come from the profile likelihood. They widen if the data scatter more than stated.

    Parameters
    ----------
    model : Model
        Model of the contact.
    joint : Joint
        Joint of plain numbers; those that are not free are constant.
    data : Measured, or several
        Sets of measurements with at least as many values as there are unknowns.
    free : mapping of str to (low, high), or Normal, LogNormal, Rectangular
        Unknowns by name, with two ends in mm, N, MPa, or with a prior distribution. A name is that of a number of the
        joint ("clearance", "liner_young" or "liner.young"), of the model ("work_of_adhesion") or of an observable
        ("friction_coefficient"). Unknown errors of a machine are stated by the `Machine` of the data.
    scatter : ScatterModel
        `NormalScatter()`, or `HeavyTailed()` for data with outliers.
    slopes : callable
        Derivatives: `by_differences`, or `by_tracing` with JAX (`ballsocket.identification.misfit`).
    seed : int
        Seed of the search for a start.

    Raises
    ------
    ValueError
        An unknown name, a number that model or data do not have, an empty range, fewer values than unknowns, data that
        no contact can give, or ranges without any result of the model for all data.
    TypeError
        A wrong type of model, joint or data.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.identification import Measured
    >>> press = Measured(quantity="indentation", force=[500.0, 1500.0, 3000.0], values=[0.0130, 0.0261, 0.0408],
    ...     uncertainty=0.0002)
    >>> result = bs.identify(bs.HessForsbach(), bs.joints["hess-forsbach"], press, {"clearance": (0.02, 0.3)})
    >>> round(result["clearance"].value, 2)
    0.1
    """
    check_joint(joint)
    if not isinstance(model, Model):
        raise TypeError(f"model must be a model, such as bs.Tabulated(), got {shown(model)}")
    if not all(map(is_plain_number, joint.numbers())):
        raise ValueError("joint must have plain numbers, got arrays: identify one joint at a time")
    sets = tuple(data) if isinstance(data, list | tuple) else (data,)
    if not sets:
        raise ValueError("data must have at least one set of measurements, got none")
    for measured in sets:
        if not isinstance(measured, Measured):
            raise TypeError(f"data must be sets of Measured, got {shown(measured)}")
    unknowns = collect_unknowns(free, [measured.machine for measured in sets], model)
    _check_data(sets, joint, unknowns)
    forward = ForwardModel(model, joint, sets, tuple(unknown.name for unknown in unknowns))
    uncertainty = _joined(measured.uncertainty for measured in sets)
    misfit = Misfit(forward, ParameterTransform(unknowns), scatter, slopes, uncertainty)
    best = find_best_fit(misfit, seed)
    if any(measured.has_unknown_noise for measured in sets):
        misfit, best = _estimate_noise(misfit, best)
    has_fitted_weights = any(
        measured.relative_uncertainty
        or (measured.load and measured.load_uncertainty.any() and not measured.has_unknown_noise)
        for measured in sets
    )
    for _ in range(_WEIGHT_ITERATIONS if has_fitted_weights else 0):
        misfit = replace(misfit, uncertainty=_combine_uncertainties(misfit, best))
        best = find_best_fit(misfit, seed)
    return IdentificationResult(*compute_bands(misfit, best))


def _estimate_noise(misfit: Misfit, best: FitResult) -> tuple[Misfit, FitResult]:
    """Estimate the uncertainty of each data set without one from its residuals, by iterated fits.

    The residuals of a set have as many degrees of freedom as it has values, less its part of the unknowns: the sum of
    the leverages of its values. Saturated values do not count.

    Raises ValueError: a data set whose scatter cannot be estimated, for it has no more values than it determines
    unknowns.
    """
    sets = misfit.forward.data
    ends = numpy.cumsum([len(measured) for measured in sets])
    parts = [slice(end - len(measured), end) for end, measured in zip(ends, sets, strict=True)]
    prior_information = numpy.diag(misfit.transform.has_distribution.astype(float))
    for _ in range(_NOISE_ITERATIONS):
        results, slopes = misfit.slopes(misfit.forward, misfit.transform, best.theta)
        weighted_slopes = slopes / misfit.uncertainty[:, None]
        covariance = numpy.linalg.pinv(weighted_slopes.T @ weighted_slopes + prior_information)
        leverages = numpy.einsum("ij,jk,ik->i", weighted_slopes, covariance, weighted_slopes)
        uncertainty, freedoms = misfit.uncertainty.copy(), []
        for measured, part in zip(sets, parts, strict=True):
            if not measured.has_unknown_noise:
                continue
            used = ~misfit.saturated[part]
            freedom = float(used.sum() - leverages[part][used].sum())
            if freedom < _MIN_NOISE_FREEDOM:
                raise ValueError(
                    f"the uncertainty of {measured.name or measured.quantity} is missing, and cannot be estimated "
                    f"from {counted(len(measured), 'value')}: state uncertainty, or measure more values"
                )
            residuals = (results[part] - misfit.value[part])[used]
            least = _MIN_RELATIVE_NOISE * float(abs(measured.values).max())
            uncertainty[part] = max(float((residuals @ residuals) / freedom) ** 0.5, least)
            freedoms.append(freedom)
        converged = numpy.allclose(uncertainty, misfit.uncertainty, rtol=_NOISE_TOLERANCE)
        misfit = replace(misfit, uncertainty=uncertainty, noise_freedom=min(freedoms))
        best = replace(minimise_misfit(misfit, best.theta), rivals=best.rivals)
        if converged:
            break
    return misfit, best


def _combine_uncertainties(misfit: Misfit, best: FitResult) -> Numbers:
    """Combine the uncertainties of values and loads to one uncertainty for each value.

    Relative ones are of the results. The slope of the results over the load converts those of the loads.
    """
    data, values = misfit.forward.data, misfit.transform.to_values(best.theta[None])
    above, below = (misfit.forward.results_at(values, load_perturbation=side * _LOAD_STEP)[0] for side in (1, -1))
    slope = (above - below) / (2 * _LOAD_STEP)  # by ln of the load
    of_loads = [numpy.zeros(len(measured)) for measured in data]  # relative; 0 for a number of the joint
    for share, measured in zip(of_loads, data, strict=True):
        if measured.load:
            numpy.divide(measured.load_uncertainty, measured.loads, out=share, where=measured.loads > 0)
    results, stated = misfit.forward.results_at(values)[0], _joined(measured.uncertainty for measured in data)
    shares = _joined(numpy.full(len(measured), measured.relative_uncertainty) for measured in data)
    stated = numpy.where((shares > 0) & (results != 0), shares * abs(results), stated)
    is_estimated = _joined(numpy.full(len(measured), measured.has_unknown_noise) for measured in data)
    of_values = numpy.where(is_estimated, misfit.uncertainty, stated)
    relative = _joined(of_loads)
    return numpy.hypot(of_values, numpy.where((relative > 0) & ~is_estimated, slope * relative, 0.0))


def _joined(arrays: Iterable[Numbers]) -> Numbers:
    return numpy.concatenate(list(arrays))


def _check_data(data: Sequence[Measured], joint: Joint, unknowns: Sequence[Unknown]) -> None:
    """Check areas, the number of values, and that the numbers of all custom observables are unknowns."""
    if not unknowns:
        raise ValueError("free has no unknowns: name at least one with two ends, such as clearance")
    for measured in data:
        measured.check_area(joint)
    count = sum(map(len, data))
    ranges = [unknown.name for unknown in unknowns if not unknown.has_distribution]
    if count < len(ranges):
        raise ValueError(
            f"too few data, {counted(count, 'value')} for {counted(len(ranges), 'unknown')} ({', '.join(ranges)}): "
            "measure more values, or free fewer unknowns"
        )
    names = {unknown.name for unknown in unknowns}
    needed = {name: measured for measured in data if measured.observable for name in measured.observable.numbers}
    for name, measured in needed.items():
        if name not in names:
            raise ValueError(f"data of {measured.quantity} depend on {name}: free it, with two ends or a distribution")
    for name in OBSERVABLE_NUMBERS:
        if name in names and name not in needed:
            raise ValueError(f"no data depend on {name}: do not free it, or add data that depend on it")
