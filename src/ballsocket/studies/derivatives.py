"""Local uncertainty of a contact: derivatives and elasticities of its quantities, and bands from tolerances."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..core.checks import check_names, needs
from ..problem import Joint
from ..problem.cup import Cup
from .axes import check_allowed
from .design import sample
from .distributions import Distribution, check_nominal
from .parameters import AIMS, LENGTHS, LOADS, PARAMETERS, check_aims, nominal_value, press_arguments
from .run import default_model
from .task import EDGE_DISTANCE, QUANTITIES

Derivatives = dict[str, dict[str, float]]
"""Derivatives by quantity and parameter."""

REPORTED_QUANTITIES = ("max_pressure", "half_angle", "indentation", "area", "stiffness")
"""Quantities whose elasticities and bands are computed."""

_VARIED = ("ball_radius", "clearance", "liner_thickness", "liner_young", "liner_poisson")  # have an elasticity
_SAMPLE_COUNT = 512
_QUADRATIC_SAMPLE_COUNT = 8192
_NODE = 3**0.5  # nodes of a quadratic in standard deviations from the mean, as of Gauss-Hermite quadrature
_BAND_PROBABILITIES = (0.025, 0.5, 0.975)

Bands = dict[str, tuple[float, ...]]
"""Low end of a band, median, and high end, by quantity."""


def finite_differences(
    model: Model, joint: Joint, quantities: Iterable[str], at: Mapping[str, float]
) -> tuple[dict[str, float], Derivatives]:
    """Compute quantities and their derivatives at one point by finite differences of second order.

    One press of arrays has all points, for any model. Differences are central, and one-sided if a parameter is at the
    end of its range, such as a clearance of zero. The relative error is 1e-7 for closed forms, 1e-5 for `Exact`, and a
    few percent for finite elements, whose mesh changes with the joint.

    Parameters
    ----------
    model : Model
    joint : Joint
        Joint of plain numbers.
    quantities : iterable of str
        Quantities of a contact.
    at : mapping of str to float
        Point: parameters, one load among them, in mm, N, MPa, rad.

    Returns
    -------
    values : dict of str to float
        Quantities at the point.
    derivatives : dict of str to dict of str to float
        Derivatives by quantity and parameter, in mm, N, MPa, rad.

    Raises
    ------
    ValueError
        An unknown name; no load, or a load of zero, where derivatives are infinite.
    """
    names = _check_arguments(quantities, at)
    steps = {name: _choose_steps(joint, at, name, model.smooth_step) for name in at}
    results = press_quantities(model, joint, _star(at, steps), names)
    derivatives: Derivatives = {}
    for quantity, row in results.items():
        derivatives[quantity] = {}
        for index, (name, (a, b)) in enumerate(steps.items()):
            # slope at 0 of the parabola through 0 and the rises at both steps
            rise_a, rise_b = row[2 * index + 1 : 2 * index + 3] - row[0]
            derivatives[quantity][name] = float((b * b * rise_a - a * a * rise_b) / (a * b * (b - a)))
    return {quantity: float(row[0]) for quantity, row in results.items()}, derivatives


def _star(centre: Mapping[str, float], steps: Mapping[str, tuple[float, float]]) -> dict[str, Numbers]:
    """Return a point in row 0, and in rows 2i + 1 and 2i + 2 the two steps of its parameter i."""
    rows = {name: numpy.full(2 * len(steps) + 1, float(value)) for name, value in centre.items()}
    for index, (name, pair) in enumerate(steps.items()):
        rows[name][2 * index + 1 : 2 * index + 3] += pair
    return rows


def _choose_steps(joint: Joint, at: Mapping[str, float], name: str, relative_step: float) -> tuple[float, float]:
    """Choose the two steps of a parameter: to both sides, or to one side at the end of its range or of the joints."""
    value = float(at[name])
    size = relative_step * abs(value) or relative_step
    choices = ((size, -size), (size, 2 * size), (-size, -2 * size))
    allowed = [steps for steps in choices if PARAMETERS[name].allows(value + numpy.array(steps)).all()]
    if not allowed:
        raise ValueError(f"{name} = {value:g} is not allowed: {PARAMETERS[name].allowed}")
    for steps in allowed:
        if name not in LENGTHS or numpy.all(
            press_arguments(joint, {**at, name: value + numpy.array((0.0, *steps))})[2]
        ):
            return steps
    return allowed[0]


def jax_derivatives(
    model: Model, joint: Joint, quantities: Iterable[str], at: Mapping[str, float]
) -> tuple[dict[str, float], Derivatives]:
    """Compute quantities and their derivatives with JAX, exact to rounding, for a `differentiable` model.

    The first call compiles. Parameters and results are those of `finite_differences`.

    Raises ValueError: a model that JAX cannot trace; an unknown name; no load.
    Raises ImportError: JAX is not installed.
    """
    names = _check_arguments(quantities, at)
    if not model.differentiable:
        raise ValueError(f"{model.name} cannot be traced by JAX: use finite_differences")
    needs("jax", "jax")
    import jax

    with jax.enable_x64(True):
        values, gradients = _compile_jax(model, joint, names)({name: float(value) for name, value in at.items()})
    return (
        {name: float(values[name]) for name in names},
        {quantity: {name: float(gradients[quantity][name]) for name in at} for quantity in names},
    )


@lru_cache(maxsize=16)
def _compile_jax(model: Model, joint: Joint, quantities: tuple[str, ...]) -> Callable[[dict[str, float]], Any]:
    import jax

    def compute(values: dict[str, Any]) -> dict[str, Any]:
        check_aims(model, values)
        varied_joint, load, _ = press_arguments(joint, values)
        contact = model.press(varied_joint, **load)
        return {name: getattr(contact, name) for name in quantities}

    compiled: Callable[[dict[str, float]], Any] = jax.jit(lambda values: (compute(values), jax.jacfwd(compute)(values)))
    return compiled


DerivativeFunction = Callable[[Model, Joint, Iterable[str], Mapping[str, float]], tuple[dict[str, float], Derivatives]]
"""Type of `finite_differences` and `jax_derivatives`."""


def _check_arguments(quantities: Iterable[str], at: Mapping[str, float]) -> tuple[str, ...]:
    """Check the names of parameters and quantities, and that the load is not zero; return the quantities."""
    check_names(at, PARAMETERS, "among the numbers that vary")
    names = tuple(quantities)
    check_names(names, QUANTITIES, "among the quantities")
    if not any(name in at for name in LOADS):
        raise ValueError(f"one load is needed: {', '.join(LOADS)}")
    for name in LOADS:
        if at.get(name) == 0:
            raise ValueError(f"{name} = 0 is first contact, where derivatives are infinite; it must be above 0")
    return names


def elasticities(
    model: Model,
    joint: Joint,
    quantities: Iterable[str],
    at: Mapping[str, float],
    derive: DerivativeFunction = finite_differences,
) -> Derivatives:
    """Compute elasticities (x/y) dy/dx: percent of change in each quantity for one percent of each parameter.

    Parameters and errors are those of `finite_differences`.
    """
    values, derivatives = derive(model, joint, quantities, at)
    return {
        quantity: {name: slope * at[name] / values[quantity] for name, slope in slopes.items()}
        for quantity, slopes in derivatives.items()
    }


def press_quantities(
    model: Model, joint: Joint, values: Mapping[str, Any], quantities: Iterable[str]
) -> dict[str, Any]:
    """Press a joint with varied parameters, and return quantities by name; NaN for impossible joints.

    The `values` of the parameters broadcast against each other.
    """
    check_aims(model, values)
    varied_joint, load, possible = press_arguments(joint, values)
    contact = model.press(varied_joint, **load)
    return {name: numpy.where(possible, getattr(contact, name), numpy.nan) for name in quantities}


@dataclass(frozen=True, kw_only=True)
class LocalUncertainty:
    """Elasticities and bands of the quantities of one contact."""

    model: str  # name of the model
    # change of each quantity in percent for one percent of each parameter, by quantity and parameter
    changes: Derivatives
    # low end of the band of 95 % of the joints within the tolerances, median, and high end, by quantity, in mm,
    # N, MPa, rad. Empty without tolerances.
    band: Bands
    presses: int = 0  # number of presses behind the bands of a quadratic; 0 if every sample was pressed


def local_uncertainty(
    joint: Joint, cup: Cup, load: Mapping[str, float], tolerances: Mapping[str, Distribution]
) -> LocalUncertainty:
    """Compute the elasticities of a contact, and its bands for tolerances.

    The joint has plain numbers; the load is one of force (N), indentation (mm), half_angle (rad), above 0. Tolerances
    are independent distributions, by parameter.

    Raises ValueError: an unknown name, a load of 0, joints without a result, or a joint or load outside its own
    tolerances.
    """
    model = default_model(joint, {name: [number] for name, number in load.items()}).in_cup(cup)
    check_aims(model, tolerances)
    _check_nominal_values(joint, load, tolerances)
    numbers = {name: nominal_value(joint, name) for name in _VARIED}
    point = {name: number for name, number in numbers.items() if number is not None and 0 < number < numpy.inf}
    changes = elasticities(model, joint, REPORTED_QUANTITIES, {**point, **load})
    if not tolerances:
        return LocalUncertainty(model=model.name, changes=changes, band={})
    scattered, values = scattered_joints(joint, load, tolerances)
    results = _press_scattered(scattered.in_cup(cup), joint, values, REPORTED_QUANTITIES)
    bands = {name: _ends(numbers) for name, numbers in results.items()}
    return LocalUncertainty(model=model.name, changes=changes, band=bands)


def scattered_joints(
    joint: Joint, load: Mapping[str, float], tolerances: Mapping[str, Distribution]
) -> tuple[Model, dict[str, Any]]:
    """Sample the joints and loads within tolerances, and choose the model that presses them.

    The arguments are those of `local_uncertainty`. Raises ValueError: a sample that is not allowed.
    """
    samples = sample(_SAMPLE_COUNT, **dict[str, Any](tolerances)).values_in([slice(None)])
    for name, values in samples.items():
        check_allowed(name, values, position=" within its tolerance", hint="; narrow the tolerance")
    fixed = {} if set(samples) & set(load) else dict(load)
    ranges = {name: [values.min(), values.max()] for name, values in samples.items()}
    return default_model(joint, {**ranges, **{name: [number] for name, number in fixed.items()}}), {**samples, **fixed}


def off_axis_uncertainty(
    joint: Joint,
    model: Any,
    load: Mapping[str, float],
    tolerances: Mapping[str, Distribution],
    tilt: float | None = None,
) -> LocalUncertainty:
    """Compute the effect of tolerances on a contact off the cup's axis, from few presses.

    Each quantity is a sum of quadratics, one of each toleranced parameter through three presses. Interactions of the
    parameters are neglected. `band` also has the edge distance.

    Joint, load and tolerances are those of `local_uncertainty`, with at least one tolerance: of the joint, of the load,
    or of its direction. The model has its cup and the direction of the load, unless the `tilt` (rad) between load and
    cup's axis sets it.

    Raises ValueError: an unknown name, joints without a result, or a number outside its own tolerances.
    """
    cup_angles = ("inclination", "anteversion")  # which set the direction of a load in the body
    angles = {name: getattr(model.cup, name) for name in cup_angles} if tilt is None else {"tilt": tilt}
    for name in tolerances:
        if name in AIMS and name not in angles:
            raise ValueError(f"{name} has a tolerance, and the direction of the load is set by {' and '.join(angles)}")
    _check_nominal_values(joint, {**angles, **load}, tolerances)
    means = {name: float(distribution.frozen.mean()) for name, distribution in tolerances.items()}
    steps = numpy.array([_NODE * float(distribution.frozen.std()) for distribution in tolerances.values()])
    fixed = {} if set(means) & set(load) else load
    star = _star({**means, **fixed}, {name: (step, -step) for name, step in zip(means, steps, strict=True)})
    results = _press_scattered(model, joint, star, (*REPORTED_QUANTITIES, EDGE_DISTANCE))
    design = sample(_QUADRATIC_SAMPLE_COUNT, **dict[str, Any](tolerances))
    samples = design.values_in([slice(None)])
    offsets = numpy.stack([samples[name] - mean for name, mean in means.items()])
    changes: Derivatives = {}
    bands: Bands = {}
    for quantity, values in results.items():
        upper, lower = values[1::2] - values[0], values[2::2] - values[0]
        slopes, curvatures = (upper - lower) / (2 * steps), (upper + lower) / (2 * steps**2)
        bands[quantity] = _ends(values[0] + slopes @ offsets + curvatures @ offsets**2)
        if quantity != EDGE_DISTANCE:
            pairs = zip(means.items(), slopes, strict=True)
            changes[quantity] = {name: float(slope * mean / values[0]) for (name, mean), slope in pairs}
    return LocalUncertainty(model=model.name, changes=changes, band=bands, presses=2 * len(means) + 1)


def _check_nominal_values(joint: Joint, stated: Mapping[str, float], tolerances: Mapping[str, Distribution]) -> None:
    """Check that loads and angles, and the numbers of the joint, lie within their own tolerances."""
    for name, distribution in tolerances.items():
        nominal = stated.get(name) if name in (*AIMS, *LOADS) else nominal_value(joint, name)
        if nominal is not None:
            check_nominal(name, float(nominal), distribution, PARAMETERS[name].written)


def _press_scattered(
    model: Model, joint: Joint, values: Mapping[str, Any], quantities: Iterable[str]
) -> dict[str, Numbers]:
    """Press joints within tolerances as `press_quantities`; raise ValueError if one of them has no result."""
    results = press_quantities(model, joint, values, quantities)
    if not all(numpy.isfinite(numbers).all() for numbers in results.values()):
        raise ValueError("some joints within the tolerances have no result; narrow the tolerances")
    return results


def _ends(values: Numbers) -> tuple[float, ...]:
    return tuple(float(end) for end in numpy.quantile(values, _BAND_PROBABILITIES))
