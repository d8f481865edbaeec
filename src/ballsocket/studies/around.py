"""What tolerances, and small changes, do to one contact."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy

from ..problem import Joint
from ..problem.cup import Cup
from .design import check_values, sample
from .distributions import Distribution, check_nominal
from .parameters import LOADS, PARAMETERS, nominal
from .slopes import Slopes, elasticities, pressed
from .usual import usual

ASKED = ("max_pressure", "half_angle", "indentation", "area", "stiffness")
"""Quantities that are told."""

_VARIED = ("ball_radius", "clearance", "liner_thickness", "liner_young", "liner_poisson")
_COUNT, _ENDS = 512, (0.025, 0.5, 0.975)


Ends = dict[str, tuple[float, ...]]
"""By quantity the low end of a band, the median, the high end."""


@dataclass(frozen=True, kw_only=True)
class Around:
    """A contact's surroundings.

    Attributes
    ----------
    model : str
        The name of the model that was asked.
    changes : dict
        Percent of change in each quantity for one percent in each number, by quantity and parameter.
    band : dict of str to tuple of float
        By quantity the low end of the band that holds 95 % of the joints within the tolerances, their median, and its
        high end, in the units inside; empty without tolerances.
    """

    model: str
    changes: Slopes
    band: Ends


def around(joint: Joint, cup: Cup, load: Mapping[str, float], tolerances: Mapping[str, Distribution]) -> Around:
    """What a percent of each number, and the tolerances together, do to a contact.

    Parameters
    ----------
    joint : Joint
        Of plain numbers.
    cup : Cup
    load : mapping of str to float
        One of force (N), indentation (mm), half_angle (rad), above 0.
    tolerances : mapping of str to Rectangular, Normal or LogNormal
        By name of a parameter; independent of each other.

    Raises
    ------
    ValueError
        A name that is not known, a load of 0, joints for which there is no answer, or a joint or load outside its
        own tolerances.
    """
    for name, spread in tolerances.items():
        value = load.get(name) if name in LOADS else nominal(joint, name)
        if value is not None:
            check_nominal(name, value, spread, PARAMETERS[name].written)
    numbers = {name: float(getattr(joint, name)) for name in _VARIED[:3]}
    numbers |= {"liner_young": float(joint.liner.young), "liner_poisson": float(joint.liner.poisson)}
    at = {name: number for name, number in numbers.items() if 0 < number < numpy.inf}
    model = usual(joint, {name: [number] for name, number in load.items()}).in_cup(cup)
    changes = elasticities(model, joint, ASKED, {**at, **load})
    return Around(model=model.name, changes=changes, band=_band(joint, cup, load, tolerances) if tolerances else {})


def _band(joint: Joint, cup: Cup, load: Mapping[str, float], tolerances: Mapping[str, Distribution]) -> Ends:
    design = sample(_COUNT, **dict[str, Any](tolerances))
    check_values(design)
    drawn = design.part([slice(None)])
    fixed = {} if set(drawn) & set(load) else dict(load)
    ends = {name: [values.min(), values.max()] for name, values in drawn.items()}
    model = usual(joint, {**ends, **{name: [number] for name, number in fixed.items()}}).in_cup(cup)
    found = pressed(model, joint, {**drawn, **fixed}, ASKED)
    if not all(numpy.isfinite(values).all() for values in found.values()):
        raise ValueError("some joints within the tolerances have no answer; narrow them")
    return {name: tuple(float(end) for end in numpy.quantile(values, _ENDS)) for name, values in found.items()}
