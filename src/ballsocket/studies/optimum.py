"""The best joint: the smallest answer over ranges of its numbers, within limits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from types import MappingProxyType
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..core.checks import check_names, needs, require
from ..problem import Joint
from .design import Design, grid, sample
from .distributions import Rectangular
from .limits import EDGE_DISTANCE, Limit, allowed, refusal
from .parameters import LOADS, PARAMETERS, PARTS_OF, varied
from .run import study
from .slopes import Derive, differences
from .task import QUANTITIES

_SEARCH = 3.0  # s that the search for a start may take
_FEWEST, _MOST = 64, 4096
_STARTS = 3
_NONE: Mapping[str, Any] = MappingProxyType({})


@dataclass(frozen=True, kw_only=True)
class Optimum:
    """The best joint that was found.

    Attributes
    ----------
    point : dict of str to float
        What was varied, in mm, MPa, rad.
    materials : dict of str to str
        The names of materials that were chosen, by the part that is made of them.
    value : float
        The quantity that was minimised.
    joint : Joint
    active : tuple of str
        Limits and ends of ranges that it touches: giving way there would help.
    slopes : dict of str to float
        Derivative of the quantity with respect to what was varied.
    valid : bool
        Whether the model can be trusted there.
    searched : int
        Joints that the search for a start looked at.
    """

    minimise: str
    point: dict[str, float]
    value: float
    joint: Joint
    active: tuple[str, ...]
    slopes: dict[str, float]
    valid: bool
    searched: int
    materials: dict[str, str] = field(default_factory=dict)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "minimise": self.minimise,
            "value": self.value,
            "point": self.point,
            "materials": self.materials,
            "active": list(self.active),
            "slopes": self.slopes,
            "joint": self.joint.summary(),
            "valid": self.valid,
            "searched": self.searched,
        }


def optimise(
    model: Model,
    joint: Joint,
    vary: Mapping[str, tuple[float, float]],
    *,
    load: Mapping[str, float],
    among: Mapping[str, Sequence[Any]] = _NONE,
    minimise: str = "max_pressure",
    limits: Iterable[Limit] = (),
    seed: int = 0,
    derive: Derive = differences,
) -> Optimum:
    """Minimise one answer over ranges of a joint's numbers.

    A global search by Sobol's points finds where to start, then sequential quadratic programming (SLSQP) with
    derivatives of the model finds the point; of several starts the best is taken.

    Parameters
    ----------
    model, joint
        What is pressed; numbers that do not vary stay.
    vary : mapping of str to (low, high)
        Ranges in mm, MPa.
    load : mapping of str to float
        One of force (N), indentation (mm), half_angle (rad).
    among : mapping of str to sequence
        What comes in sizes: numbers (in mm, MPa, rad) by their names, materials by `liner` or `ball`. Every combination
        is looked at.
    minimise : str
        A quantity of a contact.
    limits : iterable of Limit
    seed : int
        Of the search.
    derive : callable
        Where derivatives come from: `differences`, or `traced` by JAX (`ballsocket.studies.slopes`).

    Raises
    ------
    ValueError
        A name that is not known, an empty range, or no joint within the limits.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.studies.limits import Limit
    >>> shell = [Limit(name="outer_radius", high=26.0), Limit(name="liner_thickness", low=4.0)]
    >>> ranges = {"ball_radius": (11.0, 23.0), "liner_thickness": (3.0, 15.0)}
    >>> hip = bs.joints["hess-forsbach"]
    >>> best = optimise(bs.HessForsbach(), hip, ranges, load={"force": 3000.0}, limits=shell)
    >>> round(best.value, 2), best.active
    (10.34, ('outer_radius ≤ 26',))
    """
    needs("study", "xarray")
    check_names(vary, PARAMETERS, "among what varies")
    check_names(among, (*PARAMETERS, *PARTS_OF), "among what is chosen")
    check_names([minimise], QUANTITIES, "among the quantities")
    for name, (low, high) in vary.items():
        require(name, low, low < high, f"a range goes upwards, to {high:g}")
    if not (vary or among):
        raise ValueError("at least one number must vary")
    choices = [dict(zip(among, values, strict=True)) for values in product(*among.values())]
    search = _Search(model, dict(vary), minimise, tuple(limits), derive, seed, _SEARCH / max(1, len(choices)))
    found, refused = [], ValueError("an empty list leaves nothing to choose")
    for choice in choices:
        try:
            found.append(search.best(joint, load, choice))
        except ValueError as error:
            refused = error
    if not found:
        raise refused
    return replace(min(found, key=lambda each: each.value), searched=sum(each.searched for each in found))


@dataclass(frozen=True, eq=False)
class _Search:
    """What is asked of every combination of sizes."""

    model: Model
    vary: dict[str, tuple[float, float]]
    minimise: str
    limits: tuple[Limit, ...]
    derive: Derive
    seed: int
    seconds: float

    def best(self, joint: Joint, load: Mapping[str, float], choice: Mapping[str, Any]) -> Optimum:
        """The best joint of one combination."""
        materials = {name: value for name, value in choice.items() if name in PARTS_OF}
        sizes = {name: float(value) for name, value in choice.items() if name not in PARTS_OF}
        made = joint.replace(**materials)
        problem = _Problem(
            self.model, made, self.vary, self.minimise, self.limits, dict(load), self.derive, sizes, self.seconds
        )
        starts, searched = problem.starts(self.seed)
        share = min(map(problem.refined, starts), key=lambda each: each[1])[0]
        chosen = {name: value.name or str(value) for name, value in materials.items()}
        return replace(problem.optimum(share, searched), materials=chosen)


@dataclass(frozen=True, eq=False)
class _Problem:
    """Points are scaled: each number runs from 0 to 1 over its range."""

    model: Model
    joint: Joint
    vary: dict[str, tuple[float, float]]
    minimise: str
    limits: tuple[Limit, ...]
    load: dict[str, float]
    derive: Derive
    sizes: dict[str, float]
    seconds: float

    @property
    def quantities(self) -> tuple[str, ...]:
        """What is minimised, and what the limits ask for."""
        named = ("half_angle" if limit.name == EDGE_DISTANCE else limit.name for limit in self.limits)
        loads = [name for name in LOADS if name in self.load]
        wanted = (self.minimise, *(name for name in named if name in QUANTITIES and name not in loads))
        return tuple(dict.fromkeys(wanted))

    def at(self, share: Numbers) -> dict[str, float]:
        return self.sizes | {
            name: float(low + one * (high - low))
            for one, (name, (low, high)) in zip(share, self.vary.items(), strict=True)
        }

    def starts(self, seed: int) -> tuple[list[Numbers], int]:
        """The best few allowed points of a search, and how many were pressed."""
        if not self.vary:
            return [self._alone()], 1
        count = int(numpy.clip(self.seconds / self.model.seconds_a_press, _FEWEST, _MOST))
        count = 1 << (count.bit_length() - 1)
        ranges: dict[str, Any] = {name: Rectangular(low=low, high=high) for name, (low, high) in self.vary.items()}
        points = self.study(sample(count, seed=seed, **ranges) * grid(**self.sizes))
        value = points[self.minimise].where(allowed(points, self.limits)).values
        if numpy.isnan(value).all():
            within = f"of {count} joints within the ranges"
            raise ValueError(refusal(points, self.limits, f"none {within} is allowed", f"for any {within}"))
        best = numpy.argsort(value)[: min(_STARTS, int(numpy.isfinite(value).sum()))]
        shares = numpy.stack(
            [(points[name].values[best] - low) / (high - low) for name, (low, high) in self.vary.items()], axis=-1
        )
        return list(shares), count

    def _alone(self) -> Numbers:
        """The one point where nothing runs over a range."""
        point = self.study(grid(**self.sizes))
        if not bool(allowed(point, self.limits)):
            chosen = " and ".join(f"{name} = {value:g}" for name, value in self.sizes.items()) or "the joint"
            raise ValueError(refusal(point, self.limits, f"{chosen} is not allowed", f"for {chosen}"))
        return numpy.zeros(0)

    def study(self, design: Design) -> Any:
        return study(self.model, self.joint, design * grid(**self.load), quantities=self.quantities)

    def refined(self, start: Numbers) -> tuple[Numbers, float]:
        """SLSQP from a start; the start itself where that leads nowhere better."""
        if not self.vary:
            return start, self.value(start)[0]
        from scipy.optimize import minimize

        scale = self.value(start)[0]
        constraints = [
            {"type": "ineq", "fun": lambda share, limit=limit: self.margin(share, limit)} for limit in self.limits
        ]

        def relative(share: Numbers) -> tuple[float, Numbers]:
            value, slope = self.value(share)
            return value / scale, slope / scale

        answer = minimize(
            relative, start, jac=True, method="SLSQP", bounds=[(0.0, 1.0)] * len(start), constraints=constraints
        )
        end = numpy.clip(answer.x, 0.0, 1.0)
        good = all(self.margin(end, limit) > -1e-6 for limit in self.limits) and self.value(end)[0] <= scale
        best = end if good else start
        return best, self.value(best)[0]

    def value(self, share: Numbers) -> tuple[float, Numbers]:
        """The quantity and its slope along each share."""
        at = self.at(share)
        answers, found = self.derive(self.model, self.joint, [self.minimise], {**at, **self.load})
        slope = [found[self.minimise][name] * (high - low) for name, (low, high) in self.vary.items()]
        return answers[self.minimise], numpy.array(slope)

    def margin(self, share: Numbers, limit: Limit) -> float:
        return float(limit.margin(self.study(grid(**self.at(share)))))

    def optimum(self, share: Numbers, searched: int) -> Optimum:
        at = self.at(share)
        value, slope = self.value(share)
        ends = [
            f"{name} = {low if one < 0.5 else high:g}"
            for one, (name, (low, high)) in zip(share, self.vary.items(), strict=True)
            if min(one, 1 - one) < 1e-6
        ]
        touched = [str(limit) for limit in self.limits if abs(self.margin(share, limit)) < _TOUCH * _size(limit)]
        made, _ = varied(self.joint, dict(at))
        spans = numpy.array([high - low for low, high in self.vary.values()])
        return Optimum(
            minimise=self.minimise,
            point=at,
            value=value,
            joint=made,
            active=(*touched, *ends),
            slopes=dict(zip(self.vary, (slope / spans).tolist(), strict=True)),
            valid=bool(self.study(grid(**at)).valid),
            searched=searched,
        )


_TOUCH = 1e-5  # of a limit's size: what lies nearer to it is held by it


def _size(limit: Limit) -> float:
    finite = [abs(end) for end in (limit.low, limit.high) if numpy.isfinite(end)]
    return max([*finite, 1e-3])
