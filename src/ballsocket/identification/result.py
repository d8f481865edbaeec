"""Result of an identification: a fitted model with its sensitivities, notes, next measurement and posterior."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.display import finite_or_none, load_plot
from ..core.unit_systems import Amount, Sentence
from .experiment import Experiment, experiment
from .fit import FittedModel
from .measured import MEASURED
from .posterior import Posterior, posterior
from .sensitivity import Sensitivity, sensitivities

_OUTLIER_RESIDUAL = 4.0  # residual in uncertainties from which a value is named
_MAX_OUTLIERS = 5  # largest number of values that are named
_MIN_PROBABILITY = 1e-3  # probability of the scatter below which a note is made
_MAX_SHIFT_RATIO = 0.5  # shift over half a band, about one standard uncertainty, above which a machine error is noted
_MIN_NOTED_WIDENING = 1.05  # smallest noted factor on the uncertainties
_MAX_TREND_PROBABILITY = 0.02  # share of random orders with as small a ratio, below which a trend is noted
_MIN_TREND_RESIDUAL = 0.5  # largest residual in uncertainties from which a trend matters
_N_ORDERS = 20_000  # random orders of the residuals
_END_TOLERANCE = 1e-6  # distance in theta from the end of a range


@dataclass(frozen=True, eq=False, repr=False)
class IdentificationResult(FittedModel):
    """Result of an identification: estimates, bands, notes and the next measurement.

    The fields are those of `FittedModel`.
    """

    @cached_property
    def sensitivity(self) -> tuple[Sensitivity, ...]:
        """Shifts of the estimates by machine errors of assumed size that the fit neglects."""
        return sensitivities(self)

    def shift_ratio(self, error: Sensitivity, name: str) -> float:
        """Compute the shift of an estimate by a machine error, divided by half the band width."""
        estimate = self.estimates[name]
        return 2 * abs(error.shifts[name]) / (estimate.high - estimate.low) if estimate.identifiable else 0.0

    @cached_property
    def notes(self) -> tuple[str, ...]:
        """Sentences on identifiability, range ends, fit, machine errors and model validity."""
        writers = (
            _identifiability_notes,
            _band_notes,
            _search_notes,
            _fit_notes,
            _trend_notes,
            _machine_notes,
            _validity_notes,
        )
        remarks = dict.fromkeys(measured.remark for measured in self.data if measured.remark)
        return (*remarks, *(note for write in writers for note in write(self)))

    @cached_property
    def next(self) -> Experiment:
        """Expected information gains of the standard candidates for the next measurement."""
        return experiment(self)

    def posterior(self, samples: int = 4000, seed: int = 0) -> Posterior:
        """Draw samples from the posterior distribution of the unknowns by Markov chains."""
        return posterior(self, samples, seed)

    def plot(self) -> Any:
        """Plot measured values beside the fitted model, and the residuals; return the figure of matplotlib."""
        return load_plot("identification")(self)

    def summary(self) -> dict[str, Any]:
        """Return the result as a dictionary for JSON, in mm, N, MPa and rad."""
        return {
            "model": self.model.name,
            "valid": self.identifiable and self.best.converged,
            "converged": self.best.converged,
            "estimates": [estimate.summary() for estimate in self.estimates.values()],
            "products": [product.summary() for product in self.information.products],
            "information": {
                "rank": self.information.rank,
                "unknowns": len(self.transform.names),
                "condition": finite_or_none(self.information.condition),
                "eigenvalues": self.information.eigenvalues.tolist(),
                "unidentifiable": list(self.information.unidentifiable),
            },
            "sensitivity": [error.summary() for error in self.sensitivity],
            "spread": finite_or_none(self.spread),
            "widening": self.misfit.widening,
            "degrees_of_freedom": self.freedom,
            "data": [
                {
                    "name": measured.name,
                    "quantity": measured.quantity,
                    "residuals": row.tolist(),
                    "uncertainty": uncertainty.tolist(),
                    "uncertainty_estimated": measured.has_unknown_noise,
                }
                for measured, row, uncertainty in zip(self.data, self.residuals, self.uncertainties, strict=True)
            ],
            "notes": list(self.notes),
            "sources": [source.key for source in self.model.sources],
        }

    def __repr__(self) -> str:
        rows = []
        for estimate in self.estimates.values():
            unit = f" {estimate.unit}" if estimate.unit != "1" else ""
            band = f"{estimate.low:.4g} to {estimate.high:.4g}{unit}"
            value = (
                f"= {estimate.value:.4g}{unit} ({band})" if estimate.identifiable else f"is not identifiable: {band}"
            )
            rows.append(f"{estimate.name} {value}")
        products = [
            f"{product.name} = {product.value:.4g} {product.unit} ({product.low:.4g} to {product.high:.4g})"
            for product in self.information.products
        ]
        return "\n".join([*rows, *products, *self.notes])


def _identifiability_notes(result: IdentificationResult) -> Iterator[str]:
    """Yield a sentence on unidentifiable unknowns and on measurements that would identify them."""
    unidentifiable = result.information.unidentifiable
    if not unidentifiable:
        return
    products = result.information.products
    mixed = {name for product in products for name in product.exponents}
    separate = [name for name in result.transform.names if name in {*unidentifiable, *mixed}]
    if products:
        names, verb = _join_names([product.name for product in products]), "is" if len(products) == 1 else "are"
        note = f"only {names} {verb} identifiable from these data, {_join_names(separate)} separately are not"
    else:
        note = f"{_join_names(separate)} {'is' if len(separate) == 1 else 'are'} not identifiable from these data"
    measured = {row.quantity for row in result.data}
    sufficient = [_quantity_title(name) for name in result.next.sufficient_quantities if name not in measured]
    if sufficient:
        yield f"{note}: measure {_join_names(sufficient, 'or')}"
    elif result.next.gains:
        best = _quantity_title(result.next.best.candidate.quantity)
        yield f"{note}; of the usual measurements {best} would add most, though not enough"
    else:
        yield note


def _band_notes(result: IdentificationResult) -> Iterator[str]:
    """Yield sentences on 95 % bands that the search range of an unknown limits."""
    for name, estimate in result.estimates.items():
        if name not in estimate.limited_by:
            continue
        unknown = result.transform.unknowns[result.transform.names.index(name)]
        pairs = ((estimate.low, unknown.low), (estimate.high, unknown.high))
        ends = [Amount(end, unknown.quantity.shown) for end, range_end in pairs if end == range_end]
        if ends:
            gaps = _join_names(["{}"] * len(ends))
            yield Sentence(f"the band of {name} ends at {gaps}, the end of its range", *ends)
        else:
            yield f"the band of {name} ends where {result.model.name} has no result for all the data"
    for name, estimate in result.estimates.items():
        if estimate.limited_by and name not in estimate.limited_by:
            yield f"the band of {name} ends where the range of {_join_names(estimate.limited_by)} ends"


def _quantity_title(quantity: str) -> str:
    return "free play" if quantity == "diametral_clearance" else MEASURED[quantity].title


def _join_names(names: Sequence[str], last_word: str = "and") -> str:
    return f"{', '.join(names[:-1])} {last_word} {names[-1]}" if len(names) > 1 else names[0]


def _search_notes(result: IdentificationResult) -> Iterator[str]:
    """Yield sentences on convergence, other points that fit equally well, and values at an end of their range."""
    if not result.best.converged:
        yield "the search did not converge: the numbers are those of its last step"
    if result.best.rivals and result.identifiable:
        yield "another point fits the data about as well: sample the posterior"
    theta = result.best.theta
    for index, unknown in enumerate(result.transform.unknowns):
        for side, end in ((-1, unknown.low), (1, unknown.high)):
            at_end = abs(theta[index] - unknown.to_scale(end) / unknown.prior_deviation) < _END_TOLERANCE
            if at_end and not unknown.is_physical(side, theta[index]):
                template = "the best {} is {}, the end of its range: widen the range, or check the data"
                yield Sentence(template, unknown.name, Amount(end, unknown.quantity.shown))


def _fit_notes(result: IdentificationResult) -> Iterator[str]:
    """Yield sentences on outliers, large scatter, and widened uncertainties."""
    from scipy.stats import chi2

    outliers = [
        (measured, row, float(residual))
        for measured, residuals in zip(result.data, result.residuals, strict=True)
        for row, residual in enumerate(residuals)
        if abs(residual) > _OUTLIER_RESIDUAL
    ]
    for measured, row, residual in sorted(outliers, key=lambda outlier: -abs(outlier[2]))[:_MAX_OUTLIERS]:
        name = measured.name or measured.quantity
        yield f"value {row + 1} of {name} is {residual:+.3g} uncertainties from the result"
    if result.freedom > 0 and chi2.sf(result.spread**2 * result.freedom, result.freedom) < _MIN_PROBABILITY:
        yield (
            f"scatter of the data {result.spread:.3g} times the stated uncertainties: these are too small, "
            "there are outliers (HeavyTailed), or the model is not valid"
        )
    for measured, uncertainty in zip(result.data, result.uncertainties, strict=True):
        if measured.has_unknown_noise:
            yield Sentence(
                "the uncertainty of {} was not stated: it is estimated from the scatter, {} (k = 1); "
                "bands are by Student's quantile",
                measured.name or measured.quantity,
                Amount(float(uncertainty[0]), measured.described.shown, 3),
            )
    if result.misfit.widening > _MIN_NOTED_WIDENING:
        yield f"bands are {result.misfit.widening:.3g} times as wide as the stated uncertainties make them"


def _trend_notes(result: IdentificationResult) -> Iterator[str]:
    """Yield sentences on residuals that follow the load, or the angle at a single load."""
    for measured, residuals in zip(result.data, result.residuals, strict=True):
        by_angle = measured.angle is not None and numpy.ptp(measured.loads) == 0
        if not (measured.load or by_angle) or abs(residuals).max() < _MIN_TREND_RESIDUAL:
            continue
        axis = measured.angle if by_angle else measured.loads
        ratio, probability = von_neumann_ratio(axis[~measured.saturated], residuals[~measured.saturated])
        if probability < _MAX_TREND_PROBABILITY:
            yield (
                f"the residuals of {measured.name or measured.quantity} have a trend over the "
                f"{'angle' if by_angle else measured.load}: von Neumann's ratio is {ratio:.2g} (2 without a trend, as "
                f"small by chance in {100 * probability:.2g} %); a number that the fit holds is wrong, of the joint or "
                "of the machine: make it an unknown, or try another model"
            )


def von_neumann_ratio(axis: Numbers, residuals: Numbers) -> tuple[float, float]:
    """Compute von Neumann's ratio of residuals in the order of an axis, and its probability without a trend.

    The ratio is the sum of squared successive differences over the sum of squared deviations from the mean, about 2
    for independent residuals and small for a trend of any shape. Residuals at equal values of the axis are averaged.

    The probability is the share of random orders with as small a ratio; 1 for fewer than five values of the axis.

    References
    ----------
    von Neumann 1941, Ann. Math. Stat. 12, 367, https://doi.org/10.1214/aoms/1177731677
    """
    levels, level_of_value = numpy.unique(axis, return_inverse=True)
    if len(levels) < 5:
        return 2.0, 1.0
    means = numpy.bincount(level_of_value, residuals) / numpy.bincount(level_of_value)
    orders = numpy.random.default_rng(0).permuted(numpy.tile(means, (_N_ORDERS, 1)), axis=1)
    squares, total = (numpy.diff(orders) ** 2).sum(axis=1), ((means - means.mean()) ** 2).sum()
    observed = (numpy.diff(means) ** 2).sum()
    return float(observed / total), float((squares <= observed * (1 + 1e-12)).mean())


def _machine_notes(result: IdentificationResult) -> Iterator[str]:
    """Yield sentences on machine errors that shift an estimate by a standard uncertainty or more."""
    numbers = [unknown.name for unknown in result.transform.unknowns if not unknown.of_machine]
    for error in result.sensitivity if numbers else ():
        ratio, name = max((result.shift_ratio(error, name), name) for name in numbers)
        if ratio > _MAX_SHIFT_RATIO:
            unit = result.transform.unknowns[result.transform.names.index(name)].quantity.shown
            yield Sentence(
                f"{{}} would move {name} by {{}}, {ratio:.1f} times half its band: "
                f"measure it, or make {error.part} an unknown of the machine",
                error.title,
                Amount(error.shifts[name], unit, 3),
            )


def _validity_notes(result: IdentificationResult) -> Iterator[str]:
    notes: dict[str, None] = {}
    for measured in result.data:
        if measured.load:
            load = numpy.maximum(measured.loads, 0.0) if measured.load == "indentation" else measured.loads
            contact = result.model.press(result.joint, **{measured.load: load})
            notes |= dict.fromkeys(note for note in contact.notes if note != contact.utilisation_note)
    yield from notes
