"""Best joints within limits: the smallest contact quantity over ranges of parameters, and Pareto fronts of two."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy

from ..contact import Model
from ..contact.verdict import Verdict
from ..core.arrays import Numbers
from ..core.checks import check_names, needs, require
from ..core.unit_systems import Amount, Sentence
from ..problem import Joint
from .derivatives import DerivativeFunction, finite_differences
from .design import Design, grid, sample
from .distributions import Rectangular
from .limits import Limit, allowed, count_verdicts, limited_quantities, refusal_reason
from .parameters import MATERIAL_PARTS, PARAMETERS, hold, vary_joint
from .run import study
from .task import QUANTITIES

if TYPE_CHECKING:
    import xarray

_SEARCH_SECONDS = 3.0  # time in s that the search for starts may take
_MIN_SAMPLES, _MAX_SAMPLES = 64, 4096  # range of the number of samples of the search
_STARTS = 3  # number of starts of the local optimisation
_MARGIN_TOLERANCE = 1e-6  # largest violation of a limit by an optimum, in the unit of the limit
_ACTIVE_MARGIN = 1e-5  # margin, relative to the size of a limit, below which the limit is active
_ACTIVE_FRACTION = 1e-6  # distance from the end of a range, as a fraction of the range, below which the end is active
_NO_CHOICES: Mapping[str, Any] = MappingProxyType({})


@dataclass(frozen=True, kw_only=True)
class Optimum:
    """Result of `optimise`.

    Attributes
    ----------
    minimise : str
        Name of the minimised quantity.
    point : dict of str to float
        Varied parameters, in mm, MPa, rad.
    value : float
        Minimised quantity.
    joint : Joint
        Optimal joint.
    active : tuple of str
        Limits and ends of ranges that the optimum touches. A wider limit would reduce the value.
    slopes : dict of str to float
        Derivative of the quantity with respect to each parameter with a range.
    valid : bool
        True if the model is valid for the contact of the optimum.
    searched : int
        Number of joints in the search for starts.
    undecided : int
        Number of these joints whose error bar contains a limit. The optimum keeps all limits by its whole error bar.
    materials : dict of str to str
        Names of the chosen materials, by part.
    held : dict of str to float
        Lengths of the joint in mm that stay while others vary.
    """

    minimise: str
    point: dict[str, float]
    value: float
    joint: Joint
    active: tuple[str, ...]
    slopes: dict[str, float]
    valid: bool
    searched: int
    undecided: int = 0
    materials: dict[str, str] = field(default_factory=dict)
    held: dict[str, float] = field(default_factory=dict)

    def summary(self) -> dict[str, Any]:
        """Return a dictionary of the optimum for JSON."""
        return {
            **vars(self),
            "active": list(self.active),
            "joint": self.joint.summary(),
            "verdict": Verdict.KEPT.word,
        }


def optimise(
    model: Model,
    joint: Joint,
    vary: Mapping[str, tuple[float, float]],
    *,
    load: Mapping[str, float],
    choices: Mapping[str, Sequence[Any]] = _NO_CHOICES,
    minimise: str = "max_pressure",
    limits: Iterable[Limit] = (),
    seed: int = 0,
    derive: DerivativeFunction = finite_differences,
) -> Optimum:
    """Minimise one contact quantity over ranges of parameters.

    Samples of Sobol points give the starts. Sequential quadratic programming (SLSQP) with derivatives of the model
    refines each start, and the best result is returned.

    Parameters
    ----------
    model : Model
    joint : Joint
        Values of the parameters that do not vary.
    vary : mapping of str to (low, high)
        Ranges in mm, MPa.
    load : mapping of str to float
        One of force (N), indentation (mm), half_angle (rad).
    choices : mapping of str to sequence
        Listed sizes: numbers (in mm, MPa, rad) by parameter, materials by `liner` or `ball`. Every combination is
        optimised.
    minimise : str
        Quantity of a contact.
    limits : iterable of Limit
        Limits that the optimum must meet.
    seed : int
        Seed of the samples.
    derive : callable
        Method of differentiation: `finite_differences`, or `jax_derivatives` (`ballsocket.studies.derivatives`).

    Raises
    ------
    ValueError
        An unknown name, an empty range, or no joint within the limits.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.studies.limits import Limit
    >>> shell = [Limit(name="outer_radius", high=26.0), Limit(name="liner_thickness", low=4.0)]
    >>> ranges = {"ball_radius": (11.0, 23.0), "liner_thickness": (3.0, 15.0)}
    >>> hip = bs.joints["hess-forsbach"]
    >>> best = optimise(bs.HessForsbach(), hip, ranges, load={"force": 3000.0}, limits=shell)
    >>> round(best.value, 2), best.active
    (10.34, ('outer_radius ≤ 26 mm',))
    """
    needs("study", "xarray")
    check_names(vary, PARAMETERS, "among what varies")
    check_names(choices, (*PARAMETERS, *MATERIAL_PARTS), "among what is chosen")
    check_names([minimise], QUANTITIES, "among the quantities")
    for name, (low, high) in vary.items():
        require(name, low, low < high, f"a range goes upwards, to {high:g}")
    if not (vary or choices):
        raise ValueError("at least one number must vary")
    combinations = [dict(zip(choices, values, strict=True)) for values in product(*choices.values())]
    seconds = _SEARCH_SECONDS / max(1, len(combinations))
    search = _Search(model, dict(vary), minimise, tuple(limits), dict(load), derive, seed, seconds)
    optima, refused = [], ValueError("an empty list has nothing to choose from")
    for combination in combinations:
        try:
            optima.append(search.optimise_combination(joint, combination))
        except ValueError as error:
            refused = error
    if not optima:
        raise refused
    best = min(optima, key=lambda optimum: optimum.value)
    return replace(
        best,
        searched=sum(optimum.searched for optimum in optima),
        undecided=sum(optimum.undecided for optimum in optima),
    )


@dataclass(frozen=True, eq=False)
class _Search:
    """Settings of an optimisation, the same for every combination of listed sizes."""

    model: Model
    ranges: dict[str, tuple[float, float]]
    minimise: str
    limits: tuple[Limit, ...]
    load: dict[str, float]
    derive: DerivativeFunction
    seed: int
    seconds: float

    def optimise_combination(self, joint: Joint, combination: Mapping[str, Any]) -> Optimum:
        """Find the optimum for one combination of listed sizes and materials."""
        materials = {name: value for name, value in combination.items() if name in MATERIAL_PARTS}
        sizes = {name: float(value) for name, value in combination.items() if name not in MATERIAL_PARTS}
        problem = _Problem(self, joint.replace(**materials), sizes)
        starts, searched, undecided = problem.find_starts()
        fractions = min(map(problem.refine, starts), key=lambda refined: refined[1])[0]
        names = {part: material.name or str(material) for part, material in materials.items()}
        return replace(problem.make_optimum(fractions, searched), materials=names, undecided=undecided)


@dataclass(frozen=True, eq=False)
class _Problem:
    """Optimisation over ranges at fixed sizes; a point is given by fractions of the ranges, from 0 to 1."""

    search: _Search
    joint: Joint
    sizes: dict[str, float]

    def parameters(self, fractions: Numbers) -> dict[str, float]:
        """Return the parameters at a point."""
        return self.sizes | {
            name: float(low + fraction * (high - low))
            for fraction, (name, (low, high)) in zip(fractions, self.search.ranges.items(), strict=True)
        }

    def find_starts(self) -> tuple[list[Numbers], int, int]:
        """Return the best allowed points of a set of samples, the number of samples, and of the undecided ones."""
        ranges, limits = self.search.ranges, self.search.limits
        if not ranges:
            return [self._check_sizes()], 1, 0
        count = int(numpy.clip(self.search.seconds / self.search.model.seconds_a_press, _MIN_SAMPLES, _MAX_SAMPLES))
        count = 1 << (count.bit_length() - 1)
        uniform: dict[str, Any] = {name: Rectangular(low=low, high=high) for name, (low, high) in ranges.items()}
        points = self.study(sample(count, seed=self.search.seed, **uniform) * grid(**self.sizes))
        undecided = count_verdicts(points, limits)[Verdict.UNDECIDED.word]
        value = points[self.search.minimise].where(allowed(points, limits)).values
        if numpy.isnan(value).all():
            joints = f"of {count} joints within the ranges"
            raise ValueError(refusal_reason(points, limits, f"none {joints} is allowed", f"for any {joints}"))
        best = numpy.argsort(value)[: min(_STARTS, int(numpy.isfinite(value).sum()))]
        columns = [(points[name].values[best] - low) / (high - low) for name, (low, high) in ranges.items()]
        return list(numpy.stack(columns, axis=-1)), count, undecided

    def _check_sizes(self) -> Numbers:
        """Check the only point of a problem without ranges; raise ValueError if it is not allowed."""
        point = self.study(grid(**self.sizes))
        if not bool(allowed(point, self.search.limits)):
            sizes = " and ".join(f"{name} = {value:g}" for name, value in self.sizes.items()) or "the joint"
            raise ValueError(refusal_reason(point, self.search.limits, f"{sizes} is not allowed", f"for {sizes}"))
        return numpy.zeros(0)

    def study(self, design: Design) -> Any:
        """Press the joint at the points of a design."""
        points = design * grid(**self.search.load)
        names = dict.fromkeys((self.search.minimise, *limited_quantities(self.search.limits, self.search.model)))
        return study(self.search.model, self.joint, points, quantities=names)

    def refine(self, start: Numbers) -> tuple[Numbers, float]:
        """Minimise from a start with SLSQP; return the start itself if the result is not better or not allowed."""
        if not self.search.ranges:
            return start, self.value_and_gradient(start)[0]
        from scipy.optimize import minimize

        scale = self.value_and_gradient(start)[0]
        constraints = [
            {"type": "ineq", "fun": lambda fractions, limit=limit: self.margin(fractions, limit)}
            for limit in self.search.limits
        ]

        def relative_value(fractions: Numbers) -> tuple[float, Numbers]:
            value, gradient = self.value_and_gradient(fractions)
            return value / scale, gradient / scale

        result = minimize(
            relative_value, start, jac=True, method="SLSQP", bounds=[(0.0, 1.0)] * len(start), constraints=constraints
        )
        end = numpy.clip(result.x, 0.0, 1.0)
        is_allowed = all(self.margin(end, limit) > -_MARGIN_TOLERANCE for limit in self.search.limits)
        best = end if is_allowed and self.value_and_gradient(end)[0] <= scale else start
        return best, self.value_and_gradient(best)[0]

    def value_and_gradient(self, fractions: Numbers) -> tuple[float, Numbers]:
        """Compute the minimised quantity and its derivatives with respect to the fractions."""
        minimise, point = self.search.minimise, self.parameters(fractions)
        values, slopes = self.search.derive(self.search.model, self.joint, [minimise], {**point, **self.search.load})
        gradient = [slopes[minimise][name] * (high - low) for name, (low, high) in self.search.ranges.items()]
        return values[minimise], numpy.array(gradient)

    def margin(self, fractions: Numbers, limit: Limit) -> float:
        """Compute the margin of a limit for the worse end of the error bar, negative if the limit is not kept."""
        return float(limit.margin(self.study(grid(**self.parameters(fractions)))).low)

    def make_optimum(self, fractions: Numbers, searched: int) -> Optimum:
        """Create the result at the optimal point."""
        point, ranges = self.parameters(fractions), self.search.ranges
        value, gradient = self.value_and_gradient(fractions)
        ends = [
            Sentence("{} = {}", name, Amount(low if fraction < 0.5 else high, PARAMETERS[name].shown, 6))
            for fraction, (name, (low, high)) in zip(fractions, ranges.items(), strict=True)
            if min(fraction, 1 - fraction) < _ACTIVE_FRACTION
        ]
        limits = self.search.limits
        touched = [str(limit) for limit in limits if abs(self.margin(fractions, limit)) < _ACTIVE_MARGIN * _size(limit)]
        widths = numpy.array([high - low for low, high in ranges.values()])
        return Optimum(
            minimise=self.search.minimise,
            point=point,
            value=value,
            joint=vary_joint(self.joint, dict(point))[0],
            active=(*touched, *ends),
            slopes=dict(zip(ranges, (gradient / widths).tolist(), strict=True)),
            valid=bool(self.study(grid(**point)).valid),
            searched=searched,
            held=hold(self.joint, point),
        )


def _size(limit: Limit) -> float:
    """Return the largest finite end of a limit, at least 0.001."""
    return max(abs(end) for end in (limit.low, limit.high, 1e-3) if numpy.isfinite(end))


def pareto(
    study: xarray.Dataset, minimise: tuple[str, str] = ("area", "max_pressure"), limits: Iterable[Limit] = ()
) -> xarray.Dataset:
    """Select the allowed points of a study for which no other allowed point is better in both quantities.

    Parameters
    ----------
    study : xarray.Dataset
        Result of `study`.
    minimise : tuple of two str
        Quantities of the study. By default a small contact area for little wear, and a low peak pressure for strength.
    limits : iterable of Limit
        Limits that each point must meet.

    Returns
    -------
    xarray.Dataset
        Points along the dimension `point`, in the order of the first quantity.

    Raises
    ------
    ValueError
        A quantity that the study does not have; no allowed point.
    """
    check_names(minimise, [str(name) for name in study.data_vars], "among the quantities of the study")
    limits = tuple(limits)
    good = allowed(study, limits)
    points = study.stack(point=list(study.sizes), create_index=False)
    mask = good.stack(point=list(good.dims), create_index=False).values if good.dims else numpy.array([bool(good)])
    if not mask.any():
        raise ValueError(refusal_reason(study, limits, "no point is allowed", "at any point"))
    points = points.isel(point=numpy.flatnonzero(mask))
    first, second = (points[name].values for name in minimise)
    order = numpy.lexsort((second, first))
    lowest = numpy.minimum.accumulate(second[order])
    better = numpy.append(True, second[order][1:] < lowest[:-1])
    return points.isel(point=order[better])
