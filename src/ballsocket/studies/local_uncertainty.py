"""Local uncertainty of one contact: elasticities, and bands from tolerances."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy

from ..problem import Joint
from ..problem.cup import Cup
from .default_model import default_model
from .derivatives import Derivatives, elasticities, press_quantities
from .design import check_values, sample
from .distributions import Distribution, check_nominal
from .parameters import LOADS, PARAMETERS, nominal_value

REPORTED_QUANTITIES = ("max_pressure", "half_angle", "indentation", "area", "stiffness")
"""Quantities whose elasticities and bands are computed."""

_VARIED_LENGTHS = ("ball_radius", "clearance", "liner_thickness")
"""Dimensions of the joint with an elasticity."""

_SAMPLE_COUNT = 512
_BAND_PROBABILITIES = (0.025, 0.5, 0.975)

Bands = dict[str, tuple[float, ...]]
"""Low end of a band, median, and high end, by quantity."""


@dataclass(frozen=True, kw_only=True)
class LocalUncertainty:
    """Elasticities and bands of the quantities of one contact.

    Attributes
    ----------
    model : str
        Name of the model.
    changes : dict of str to dict of str to float
        Change of each quantity in percent for one percent of each parameter, by quantity and parameter.
    band : dict of str to tuple of float
        Low end of the band of 95 % of the joints within the tolerances, median, and high end, by quantity, in mm, N,
        MPa, rad. Empty without tolerances.
    """

    model: str
    changes: Derivatives
    band: Bands


def local_uncertainty(
    joint: Joint, cup: Cup, load: Mapping[str, float], tolerances: Mapping[str, Distribution]
) -> LocalUncertainty:
    """Compute the elasticities of a contact, and its bands for tolerances.

    Parameters
    ----------
    joint : Joint
        Joint of plain numbers.
    cup : Cup
        Rim of the socket.
    load : mapping of str to float
        One of force (N), indentation (mm), half_angle (rad), above 0.
    tolerances : mapping of str to Rectangular, Normal or LogNormal
        Independent distributions, by parameter.

    Raises
    ------
    ValueError
        An unknown name, a load of 0, joints without a result, or a joint or load outside its own tolerances.
    """
    for name, distribution in tolerances.items():
        value = load.get(name) if name in LOADS else nominal_value(joint, name)
        if value is not None:
            check_nominal(name, value, distribution, PARAMETERS[name].written)
    numbers = {name: float(getattr(joint, name)) for name in _VARIED_LENGTHS}
    numbers |= {"liner_young": float(joint.liner.young), "liner_poisson": float(joint.liner.poisson)}
    point = {name: number for name, number in numbers.items() if 0 < number < numpy.inf}
    model = default_model(joint, {name: [number] for name, number in load.items()}).in_cup(cup)
    changes = elasticities(model, joint, REPORTED_QUANTITIES, {**point, **load})
    bands = _compute_bands(joint, cup, load, tolerances) if tolerances else {}
    return LocalUncertainty(model=model.name, changes=changes, band=bands)


def _compute_bands(joint: Joint, cup: Cup, load: Mapping[str, float], tolerances: Mapping[str, Distribution]) -> Bands:
    """Compute the bands of the quantities from samples within the tolerances."""
    design = sample(_SAMPLE_COUNT, **dict[str, Any](tolerances))
    check_values(design)
    samples = design.values_in([slice(None)])
    fixed = {} if set(samples) & set(load) else dict(load)
    ranges = {name: [values.min(), values.max()] for name, values in samples.items()}
    model = default_model(joint, {**ranges, **{name: [number] for name, number in fixed.items()}}).in_cup(cup)
    results = press_quantities(model, joint, {**samples, **fixed}, REPORTED_QUANTITIES)
    if not all(numpy.isfinite(values).all() for values in results.values()):
        raise ValueError("some joints within the tolerances have no result; narrow the tolerances")
    return {
        name: tuple(float(end) for end in numpy.quantile(values, _BAND_PROBABILITIES))
        for name, values in results.items()
    }
