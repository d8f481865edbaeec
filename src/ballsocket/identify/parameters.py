"""Identification of joint parameters from measurements, with bands and identifiability."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, Any

import numpy

from ..contact import Model
from ..contact.assembly import check_joint
from ..core.arrays import Numbers, is_plain
from ..core.checks import shown
from ..problem import Joint
from ..studies.parameters import varied
from .answers import Answers
from .bands import banded
from .information import Information
from .measured import Measured
from .misfit import Misfit, Slopes, by_differences
from .scatter import NormalScatter, Scatter
from .search import Found, found
from .unknowns import Given, Scales, Unknown, unknowns_of

if TYPE_CHECKING:
    from .experiment import Experiment
    from .posterior import Posterior
    from .sensitivity import Sensitivity

_NORMAL = NormalScatter()


@dataclass(frozen=True)
class Estimate:
    """Estimate of one unknown with its band.

    Attributes
    ----------
    name, unit : str
    value : float
        NaN for an unidentifiable unknown without a stated distribution.
    low, high : float
        Band of 95 % from the profile likelihood within the ranges of all unknowns.
    left : float
        Width of the band over the prior range.
    limited_by : tuple of str
        Unknowns whose ranges limit the band, its own name included. Empty where the data alone limit it.
    """

    name: str
    unit: str
    value: float
    low: float
    high: float
    left: float
    limited_by: tuple[str, ...] = ()

    @property
    def identifiable(self) -> bool:
        """True for an identifiable unknown, or one with a stated distribution."""
        return self.value == self.value

    @property
    def told(self) -> bool:
        """Earlier name of `identifiable`."""
        return self.identifiable

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON; an unidentifiable value is None."""
        value = self.value if self.identifiable else None
        return {
            "name": self.name,
            "unit": self.unit,
            "value": value,
            "low": self.low,
            "high": self.high,
            "identifiable": self.identifiable,
            "told": self.identifiable,
            "limited_by": list(self.limited_by),
        }


@dataclass(frozen=True, eq=False, repr=False)
class Identified:
    """Joint parameters identified from measurements.

    Attributes
    ----------
    misfit : Misfit
        Data, model and unknowns.
    best : Found
        Point of the smallest misfit.
    information : Information
        Information at that point, and profile intervals of the unknowns.
    """

    misfit: Misfit
    best: Found
    information: Information

    @property
    def model(self) -> Model:
        return self.misfit.answers.model

    @property
    def data(self) -> tuple[Measured, ...]:
        return self.misfit.answers.data

    @property
    def scales(self) -> Scales:
        return self.misfit.scales

    @property
    def point(self) -> dict[str, float]:
        """Numbers that fit best, in mm, N, MPa, rad; where some are not told these are one choice among many."""
        values = self.scales.values(self.best.places).tolist()
        return dict(zip(self.scales.names, values, strict=True))

    @property
    def joint(self) -> Joint:
        """The joint of the best point."""
        own = {name: value for name, value in self.point.items() if "." not in name}
        return varied(self.misfit.answers.joint, own)[0]

    @cached_property
    def estimates(self) -> dict[str, Estimate]:
        """Estimates with bands of 95 % by unknown; an unidentifiable unknown has no value."""
        return {each.name: self._estimate(index) for index, each in enumerate(self.scales.unknowns)}

    def _estimate(self, index: int) -> Estimate:
        unknown, information = self.scales.unknowns[index], self.information
        interval, name = information.intervals[index], unknown.name
        low, high = (self._end(unknown, self.scales.values(end.theta)[index]) for end in (interval.low, interval.high))
        value = float("nan") if name in information.unidentifiable else self.point[name]
        left, limits = information.deviations[name], information.limited_by(name)
        return Estimate(name, unknown.quantity.unit, value, low, high, left, limits)

    @staticmethod
    def _end(unknown: Unknown, value: float) -> float:
        """Return the end of a band, snapped to the end of the range within rounding."""
        return next((end for end in (unknown.low, unknown.high) if abs(value - end) <= 1e-9 * abs(end)), float(value))

    def __getitem__(self, name: str) -> Estimate:
        return self.estimates[name.replace(".", "_") if name.replace(".", "_") in self.estimates else name]

    @cached_property
    def answers(self) -> tuple[Numbers, ...]:
        """What the model says at the best point, a row for each set of data."""
        found = self.misfit.answers.at(self.scales.values(self.best.places[None]))[0]
        return tuple(numpy.split(found, numpy.cumsum([len(each) for each in self.data])[:-1]))

    def curve(self, place: int, count: int = 60) -> tuple[Numbers, Numbers]:
        """Loads from the least to the largest of a set of data that has no angles, and what the model says there."""
        each = self.data[place]
        loads = numpy.linspace(each.loads.min(), each.loads.max(), count)
        words: dict[str, Any] = {each.load: loads, "values": numpy.ones(count), "saturation": inf}
        sort = numpy.argsort(each.loads)
        order = numpy.interp(loads, each.loads[sort], each.order[sort])
        row = replace(each, uncertainty=1.0, load_uncertainty=0.0, order=order, **words)
        answers = replace(self.misfit.answers, data=(row,))
        return loads, answers.at(self.scales.values(self.best.places[None]))[0]

    @property
    def residuals(self) -> tuple[Numbers, ...]:
        """Values less results in stated uncertainties, a row for each set; for a saturated value its shortfall."""
        z = self.misfit.widening * self.misfit.standard(numpy.concatenate(self.answers))
        short = numpy.where(self.misfit.cut_off, numpy.maximum(-z, 0.0), -z)
        return tuple(numpy.split(short, numpy.cumsum([len(each) for each in self.data])[:-1]))

    @property
    def freedom(self) -> int:
        """Degrees of freedom: values less the unknowns without a stated distribution."""
        return self.misfit.freedom

    @property
    def spread(self) -> float:
        """Root of χ² over the degrees of freedom (Birge's ratio): 1 for right uncertainties; NaN without freedom."""
        total = sum(float(numpy.sum(row**2)) for row in self.residuals)
        return (total / self.freedom) ** 0.5 if self.freedom > 0 else float("nan")

    @property
    def identifiable(self) -> bool:
        """True if every unknown without a stated distribution is identifiable."""
        return not self.information.unidentifiable

    @property
    def told(self) -> bool:
        """Earlier name of `identifiable`."""
        return self.identifiable

    @cached_property
    def sensitivity(self) -> tuple[Sensitivity, ...]:
        """Shifts of the estimates by known machine errors: zero offset, compliance and drift."""
        from .sensitivity import sensitivities

        return sensitivities(self)

    def shift_ratio(self, error: Sensitivity, name: str) -> float:
        """Compute the ratio of a shift to half the width of the band; 0 for an unidentifiable unknown."""
        each = self.estimates[name]
        return 2 * abs(error.shifts[name]) / (each.high - each.low) if each.identifiable else 0.0

    @cached_property
    def notes(self) -> tuple[str, ...]:
        """Remarks on identifiability, ends of ranges, fit, machine errors, and validity of the model."""
        from .remarks import remarks

        return remarks(self)

    @cached_property
    def next(self) -> Experiment:
        """What to measure next, of the usual quantities over the loads of the data; see `experiment`."""
        from .experiment import experiment

        return experiment(self)

    def posterior(self, samples: int = 4000, seed: int = 0) -> Posterior:
        """The distribution of the unknowns by Markov chains; see `ballsocket.identify.posterior.posterior`."""
        from .posterior import posterior

        return posterior(self, samples, seed)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON in mm, N, MPa, rad."""
        return {
            "model": self.model.name,
            "valid": self.identifiable and self.best.converged,
            "converged": self.best.converged,
            "estimates": [each.summary() for each in self.estimates.values()],
            "products": [each.summary() for each in self.information.products],
            "information": {
                "rank": self.information.rank,
                "unknowns": len(self.scales.names),
                "condition": _finite(self.information.condition),
                "eigenvalues": self.information.eigenvalues.tolist(),
                "unidentifiable": list(self.information.unidentifiable),
            },
            "sensitivity": [each.summary() for each in self.sensitivity],
            "spread": _finite(self.spread),
            "widening": self.misfit.widening,
            "degrees_of_freedom": self.freedom,
            "data": [
                {"name": each.name, "quantity": each.quantity, "residuals": row.tolist()}
                for each, row in zip(self.data, self.residuals, strict=True)
            ],
            "notes": list(self.notes),
            "sources": [source.key for source in self.model.sources],
        }

    def __repr__(self) -> str:
        rows = [f"{each.name} {_described(each)}" for each in self.estimates.values()]
        products = [
            f"{each.name} = {each.value:.4g} {each.unit} ({each.low:.4g} to {each.high:.4g})"
            for each in self.information.products
        ]
        return "\n".join([*rows, *products, *self.notes])


def _described(each: Estimate) -> str:
    unit = f" {each.unit}" if each.unit != "1" else ""
    band = f"{each.low:.4g} to {each.high:.4g}{unit}"
    return f"= {each.value:.4g}{unit} ({band})" if each.identifiable else f"is not identifiable: {band}"


def _finite(number: float) -> float | None:
    return number if abs(number) < float("inf") else None


def identify(
    model: Model,
    joint: Joint,
    data: Measured | Sequence[Measured],
    free: Mapping[str, Given],
    *,
    scatter: Scatter = _NORMAL,
    slopes: Slopes = by_differences,
    seed: int = 0,
) -> Identified:
    """Identify joint parameters from measurements, with bands and identifiability.

    The method is maximum likelihood, with the stated distributions of unknowns, by least squares after a global search.
    Bands of 95 % come from the profile likelihood. They widen if the data scatter more than stated.

    Parameters
    ----------
    model : Model
        What answers for the joint.
    joint : Joint
        Plain numbers; those that are not free stay.
    data : Measured, or several
        Sets of measurements; together they need at least as many values as there are unknowns.
    free : mapping of str to (low, high), or Normal, LogNormal, Rectangular
        The unknowns by their names in studies ("clearance", "liner_young" or "liner.young"), with their ends in mm,
        MPa, or with the distribution that is known of them.
    scatter : Scatter
        `NormalScatter()`, or `HeavyTailed()` where outliers are to be expected.
    slopes : callable
        Where derivatives come from: `by_differences`, or `by_tracing` with JAX (`ballsocket.identify.tracing`).
    seed : int
        Of the search for a start.

    Returns
    -------
    Identified

    Raises
    ------
    ValueError
        A name that is not known, an empty range, fewer values than unknowns, data that no contact can give, or no
        point between the ends at which the model answers all data.
    TypeError
        What is no model, no joint, or no set of data.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.identify import Measured
    >>> press = Measured(quantity="indentation", force=[500.0, 1500.0, 3000.0], values=[0.0130, 0.0261, 0.0408],
    ...     uncertainty=0.0002)
    >>> found = bs.identify(bs.HessForsbach(), bs.joints["hess-forsbach"], press, {"clearance": (0.02, 0.3)})
    >>> round(found["clearance"].value, 2)
    0.1
    """
    check_joint(joint)
    if not isinstance(model, Model):
        raise TypeError(f"model must be a model, such as bs.Tabulated(), got {shown(model)}")
    if not all(map(is_plain, joint.numbers())):
        raise ValueError("one joint is identified at a time, and this one has arrays of numbers")
    sets = _sets(data)
    unknowns = unknowns_of(free, sets)
    _check(sets, joint, unknowns)
    answers = Answers(model, joint, sets, tuple(each.name for each in unknowns))
    misfit = Misfit(answers, Scales(unknowns), scatter, slopes, _concatenated(each.uncertainty for each in sets))
    best = found(misfit, seed)
    for _ in range(_ROUNDS if any(each.load and each.load_uncertainty.any() for each in sets) else 0):
        misfit = replace(misfit, uncertainty=_with_loads(misfit, best))
        best = found(misfit, seed)
    return Identified(*banded(misfit, best))


_ROUNDS = 2  # of weights that depend on where the best point is
_LOUDER = 1e-3


def _with_loads(misfit: Misfit, best: Found) -> Numbers:
    """Uncertainties of the values, and what those of the loads make of them, by the slope of the answers there."""
    data, values = misfit.answers.data, misfit.scales.values(best.places[None])
    more, less = (misfit.answers.at(values, louder=side * _LOUDER)[0] for side in (1, -1))
    slope = (more - less) / (2 * _LOUDER)  # by ln of the load
    shares = _concatenated(_share(each) for each in data)
    own = _concatenated(each.uncertainty for each in data)
    return numpy.hypot(own, numpy.where(shares > 0, slope * shares, 0.0))


def _share(each: Measured) -> Numbers:
    """How uncertain the loads are, relative to themselves."""
    if not each.load:
        return numpy.zeros(len(each))
    loads = each.loads
    return numpy.where(loads > 0, each.load_uncertainty / numpy.where(loads > 0, loads, 1.0), 0.0)


def _concatenated(rows: Iterable[Numbers]) -> Numbers:
    return numpy.concatenate(list(rows))


def _sets(data: Any) -> tuple[Measured, ...]:
    sets = tuple(data) if isinstance(data, list | tuple) else (data,)
    if not sets:
        raise ValueError("no data are given: a set of measurements is needed")
    for each in sets:
        if not isinstance(each, Measured):
            raise TypeError(f"data must be sets of Measured, got {shown(each)}")
    return sets


def _check(data: Sequence[Measured], joint: Joint, unknowns: Sequence[Any]) -> None:
    if not unknowns:
        raise ValueError("nothing is free: name an unknown, such as clearance, with its two ends")
    for each in data:
        each.check_within(joint)
    count = sum(map(len, data))
    wanted = [each.name for each in unknowns if not each.known]
    if count < len(wanted):
        raise ValueError(
            f"{count} values cannot tell {len(wanted)} unknowns ({', '.join(wanted)}): measure more, or free fewer"
        )
