"""Propagated uncertainty at the worst case: bands of 95 % over the tolerances, and which of them matter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy

from ..catalogue import reference
from ..core.arrays import Numbers, to_numpy
from ..core.quantities import QUANTITIES
from ..studies.axes import Method
from ..studies.default_model import default_model
from ..studies.design import sample
from ..studies.parameters import AIMS, LOADS, PARAMETERS, press_arguments
from ..studies.sensitivity import sensitivity
from .matrix import Case
from .question import ALMOST_ALL, Question

ANSWERS = ("max_pressure", "half_angle", "area", "indentation")
BAND = (2.5, 50.0, 97.5)
"""Percentiles."""

_QUICK, _SOLVED = 1024, 64
"""Samples from tables, and of the exact answer."""

_SEED = 1


def scattered(question: Question, case: Case) -> dict[str, Any]:
    """Bands of a case's answers over the tolerances, and the shares that each has in their variance.

    What the matrix varies and a tolerance is given for scatters as that says; loads off the axis are taken along it.
    """
    spreads = question.tolerances
    load = {name: value for name, value in case.items() if name in LOADS and name not in spreads}
    fixed = {name: value for name, value in case.items() if name not in (*AIMS, *load, *spreads)}
    joint, _, _ = press_arguments(question.file.joint, fixed)
    ends = {name: [float(spread.frozen.ppf(share)) for share in ALMOST_ALL] for name, spread in spreads.items()}
    model = default_model(joint, {name: each for name, each in ends.items() if name not in LOADS})
    count = _SOLVED if model is reference else _QUICK
    drawn = sample(count, seed=_SEED, method=Method.SOBOL, **spreads).values_in([slice(None)])
    made, loads, possible = press_arguments(joint, {**drawn, **load})
    contact = model.press(made, **loads)
    good = to_numpy(possible)
    values = {name: _known(getattr(contact, name), good, count) for name in ANSWERS}
    shares = sensitivity(model, joint, spreads, quantities=("max_pressure", "half_angle"), count=count // 4, load=load)
    return {
        "model": model.name,
        "samples": count,
        "seed": _SEED,
        "bands": {QUANTITIES[name].key: _band(name, found) for name, found in values.items()},
        "sobol": {
            QUANTITIES[name].key: {
                each: float(shares.total_order.sel(quantity=name, parameter=each)) for each in spreads
            }
            for name in ("max_pressure", "half_angle")
        },
        "aligned": any(name in AIMS for name in case),
        "notes": list(_outside(question, case)),
        "call": "ballsocket.evidence.scatter.scattered(question, case)",
    }


def _outside(question: Question, case: Case) -> Iterator[str]:
    """Note the inputs of the worst case that lie outside their tolerance."""
    for name in (name for name in question.tolerances if name in case):
        low, high = (float(question.tolerances[name].frozen.ppf(end)) for end in (0.0, 1.0))
        if not low <= case[name] <= high:
            quantity = PARAMETERS[name]
            value, least, most = (f"{number * quantity.written.factor:g}" for number in (case[name], low, high))
            unit = f" {quantity.written.text}".rstrip()
            yield (
                f"{quantity.title} {value}{unit} of the worst case lies outside its tolerance of {least} to "
                f"{most}{unit}: the bands cover the tolerance and do not include the worst case"
            )


def _known(values: Any, good: Numbers, count: int) -> Numbers:
    found: Numbers = numpy.where(good, numpy.broadcast_to(to_numpy(values), count), numpy.nan)
    return found[numpy.isfinite(found)]


def _band(name: str, values: Numbers) -> Mapping[str, float]:
    factor = QUANTITIES[name].written.factor
    ends = numpy.percentile(values, BAND) * factor
    return {"low": float(ends[0]), "median": float(ends[1]), "high": float(ends[2]), "answered": len(values)}
