"""Best joints within limits: the smallest contact quantity over ranges of parameters, and Pareto fronts of two."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import product
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy

from ..contact import Model
from ..contact.verdict import Verdict
from ..core.arrays import Numbers
from ..core.checks import check_names, needs, require
from ..core.display import counted
from ..core.quantities import QUANTITIES as ALL_QUANTITIES
from ..core.unit_systems import Amount, Sentence
from ..problem import Joint
from .derivatives import DerivativeFunction, finite_differences
from .design import Design, grid, sample
from .distributions import Rectangular
from .limits import Limit, allowed, count_verdicts, limited_quantities, refusal_reason
from .metadata import as_data
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
        objective = ALL_QUANTITIES[self.minimise]
        units = {name: ALL_QUANTITIES[name].written.factor / objective.written.factor for name in self.slopes}
        return {
            **vars(self),
            "minimise": objective.key,
            "value": self.value * objective.written.factor,
            "point": as_data(self.point),
            "slopes": {ALL_QUANTITIES[name].key: slope / units[name] for name, slope in self.slopes.items()},
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
    optima, refused = [], ValueError("an empty list has nothing to choose from")
    for combination in combinations:
        materials = {name: value for name, value in combination.items() if name in MATERIAL_PARTS}
        sizes = {name: float(value) for name, value in combination.items() if name not in MATERIAL_PARTS}
        try:
            varied = joint.replace(**materials)
            search = _Search(model, varied, sizes, dict(vary), dict(load), minimise, tuple(limits), derive)
            names = {part: material.name or str(material) for part, material in materials.items()}
            optima.append(replace(search.find_optimum(seed, seconds), materials=names))
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
    """Optimisation over ranges at fixed sizes; a point is given by fractions of the ranges, from 0 to 1."""

    model: Model
    joint: Joint
    sizes: dict[str, float]
    ranges: dict[str, tuple[float, float]]
    load: dict[str, float]
    minimise: str
    limits: tuple[Limit, ...]
    derive: DerivativeFunction

    def find_optimum(self, seed: int, seconds: float) -> Optimum:
        """Find the best point from the best samples that fit into a time in s."""
        starts, searched, undecided = self._find_starts(seed, seconds)
        fractions = min(map(self._refine, starts), key=lambda point: self._value_and_gradient(point)[0])
        point, widths = self._parameters(fractions), [high - low for low, high in self.ranges.values()]
        value, gradient = self._value_and_gradient(fractions)
        active: list[str] = []
        for limit in self.limits:
            size = max(abs(end) for end in (limit.low, limit.high, 1e-3) if numpy.isfinite(end))
            if abs(self._margin(limit, fractions)) < _ACTIVE_MARGIN * size:
                active.append(str(limit))
        for fraction, (name, (low, high)) in zip(fractions, self.ranges.items(), strict=True):
            if min(fraction, 1 - fraction) < _ACTIVE_FRACTION:
                end = low if fraction < 0.5 else high
                active.append(Sentence("{} = {}", name, Amount(end, PARAMETERS[name].shown, 6)))
        return Optimum(
            minimise=self.minimise,
            point=point,
            value=value,
            joint=vary_joint(self.joint, dict(point))[0],
            active=tuple(active),
            slopes=dict(zip(self.ranges, (gradient / numpy.array(widths)).tolist(), strict=True)),
            valid=bool(self._study(grid(**point)).valid),
            searched=searched,
            undecided=undecided,
            held=hold(self.joint, point),
        )

    def _parameters(self, fractions: Numbers) -> dict[str, float]:
        return self.sizes | {
            name: float(low + fraction * (high - low))
            for fraction, (name, (low, high)) in zip(fractions, self.ranges.items(), strict=True)
        }

    def _study(self, design: Design) -> Any:
        names = dict.fromkeys((self.minimise, *limited_quantities(self.limits, self.model)))
        return study(self.model, self.joint, design * grid(**self.load), quantities=names)

    def _find_starts(self, seed: int, seconds: float) -> tuple[list[Numbers], int, int]:
        """Return the best allowed points of a set of samples, the number of samples, and of the undecided ones."""
        if self.ranges:
            count = int(numpy.clip(seconds / self.model.seconds_a_press, _MIN_SAMPLES, _MAX_SAMPLES))
            count = 1 << (count.bit_length() - 1)
            uniform: dict[str, Any] = {
                name: Rectangular(low=low, high=high) for name, (low, high) in self.ranges.items()
            }
            design = sample(count, seed=seed, **uniform) * grid(**self.sizes)
            joints = f"of {counted(count, 'joint')} within the ranges"
            refused, place = f"none {joints} is allowed", f"for any {joints}"
        else:
            design = grid(**self.sizes)
            sizes = " and ".join(f"{name} = {value:g}" for name, value in self.sizes.items()) or "the joint"
            refused, place = f"{sizes} is not allowed", f"for {sizes}"
        points = self._study(design)
        values = points[self.minimise].where(allowed(points, self.limits)).values.ravel()
        n_allowed = int(numpy.isfinite(values).sum())
        if not n_allowed:
            raise ValueError(refusal_reason(points, self.limits, refused, place))
        starts = [
            numpy.array([(points[name].values[best] - low) / (high - low) for name, (low, high) in self.ranges.items()])
            for best in numpy.argsort(values)[: min(_STARTS, n_allowed)]
        ]
        return starts, values.size, count_verdicts(points, self.limits)[Verdict.UNDECIDED.word]

    def _refine(self, start: Numbers) -> Numbers:
        """Minimise from a start with SLSQP; return the start itself if the result is not better or not allowed."""
        if not self.ranges:
            return start
        from scipy.optimize import minimize

        scale = self._value_and_gradient(start)[0]

        def relative_value(fractions: Numbers) -> tuple[float, Numbers]:
            value, gradient = self._value_and_gradient(fractions)
            return value / scale, gradient / scale

        result = minimize(
            relative_value,
            start,
            jac=True,
            method="SLSQP",
            bounds=[(0.0, 1.0)] * len(start),
            constraints=[{"type": "ineq", "fun": partial(self._margin, limit)} for limit in self.limits],
        )
        end = numpy.clip(result.x, 0.0, 1.0)
        is_allowed = all(self._margin(limit, end) > -_MARGIN_TOLERANCE for limit in self.limits)
        return end if is_allowed and self._value_and_gradient(end)[0] <= scale else start

    def _value_and_gradient(self, fractions: Numbers) -> tuple[float, Numbers]:
        """Compute the minimised quantity and its derivatives with respect to the fractions."""
        point = {**self._parameters(fractions), **self.load}
        values, slopes = self.derive(self.model, self.joint, [self.minimise], point)
        gradient = [slopes[self.minimise][name] * (high - low) for name, (low, high) in self.ranges.items()]
        return values[self.minimise], numpy.array(gradient)

    def _margin(self, limit: Limit, fractions: Numbers) -> float:
        """Compute the margin of a limit for the worse end of the error bar, negative if the limit is not kept."""
        return float(limit.margin(self._study(grid(**self._parameters(fractions)))).low)


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
