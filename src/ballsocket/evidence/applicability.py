"""Applicability of a comparator to a question, by the similarity of the joints."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Array, to_numpy, where
from ..problem import Joint
from ..studies.parameters import LOADS, pressable
from .matrix import Row
from .question import ALMOST_ALL, Question

APPLIES, APPLIES_IN_PART, DOES_NOT_APPLY = "applies", "applies in part", "does not apply"
"""Verdicts on the applicability of a comparator."""

WITHIN, IN_PART, OUTSIDE = "within", "in part", "outside"
"""Positions of the range of a question in the range of a comparator."""

Ranges = Mapping[str, Sequence[float]]
"""Smallest and largest value of each similarity number."""

_RIGID_BALL_RATIO = 0.02
"""Ratio of the moduli of liner and ball below which the ball counts as rigid."""


def _modulus_ratio(joint: Joint) -> Array:
    """Compute the ratio of the moduli of liner and ball; 0 for a rigid ball."""
    ratio = 0.0 if joint.ball is None else joint.liner.young / joint.ball.young
    return where(ratio < _RIGID_BALL_RATIO, 0.0, ratio)


SIMILARITY: Mapping[str, Callable[[Joint, Array], Array]] = MappingProxyType(
    {
        "c/R1": lambda joint, force: joint.clearance / joint.ball_radius,
        "R1/L": lambda joint, force: joint.ball_radius / joint.liner_thickness,
        "ν": lambda joint, force: joint.liner.poisson,
        "F/(E R1²)": lambda joint, force: force / (joint.liner.young * joint.ball_radius**2),
        "E/E of the ball": lambda joint, force: _modulus_ratio(joint),
    }
)
"""Similarity numbers of a linear contact, without units: joints with equal numbers are similar at every size. A ball
counts as rigid if its modulus is more than fifty times that of the liner."""


def similarity_ranges(loaded: Iterable[tuple[Joint, Any]]) -> Ranges:
    """Compute the ranges of the similarity numbers over joints with their forces in N."""
    pairs = list(loaded)
    return {name: _range([number(*pair) for pair in pairs]) for name, number in SIMILARITY.items()}


def _range(values: Iterable[Any]) -> tuple[float, float]:
    """Return the smallest and the largest of several arrays; NaN is ignored."""
    flat = numpy.concatenate([to_numpy(value).ravel() for value in values])
    return float(numpy.nanmin(flat)), float(numpy.nanmax(flat))


def question_ranges(question: Question, rows: Sequence[Row]) -> Ranges:
    """Compute the ranges of the similarity numbers over the matrix of a question and over its tolerances."""
    cases = {name: numpy.array([row.case[name] for row in rows]) for name in rows[0].case}
    forces = numpy.array([row.numbers.get("force", numpy.nan) for row in rows])
    ends = {name: spread.frozen.ppf(ALMOST_ALL) for name, spread in question.tolerances.items() if name not in LOADS}
    changes = [{}, *({name: end} for name, pair in ends.items() for end in pair)]
    return similarity_ranges((pressable(question.file.joint, {**cases, **change})[0], forces) for change in changes)


def applicability(reaches: Mapping[str, Sequence[float]], needed: Ranges, tilted: bool) -> dict[str, Any]:
    """Judge the applicability of a comparator to a question; return one dictionary for JSON.

    Parameters
    ----------
    reaches, needed : mapping of str to pair of float
        Ranges of the comparator and of the question, in the numbers of `SIMILARITY`.
    tilted : bool
        True for a question with a tilted load; every comparator has a load along the axis.
    """
    positions = {name: _position(needed[name], reaches[name]) for name in reaches}
    gaps = [
        f"{name} {range_text(needed[name])} against {range_text(reaches[name])}"
        for name, position in positions.items()
        if position != WITHIN
    ]
    gaps += ["a tilted load against one along the axis"] if tilted else []
    gaps += [] if positions else ["no joint of one lined socket is behind it"]
    verdict = _verdict(positions, bool(gaps))
    return {"verdict": verdict, "where": positions, "text": ": ".join(filter(None, [verdict, "; ".join(gaps)]))}


def _verdict(positions: Mapping[str, str], gaps: bool) -> str:
    """Return the verdict on applicability from the positions of the ranges and the existence of gaps."""
    outside = [name for name, position in positions.items() if position == OUTSIDE]
    if not positions or "E/E of the ball" in outside or len(outside) > len(positions) / 2:
        return DOES_NOT_APPLY
    return APPLIES_IN_PART if gaps else APPLIES


_RELATIVE_TOLERANCE = 1e-9


def _position(needed: Sequence[float], reached: Sequence[float]) -> str:
    """Return the position of a needed range in a reached range: within, in part or outside."""
    low, high = reached[0] * (1 - _RELATIVE_TOLERANCE), reached[1] * (1 + _RELATIVE_TOLERANCE)
    if low <= needed[0] and needed[1] <= high:
        return WITHIN
    return IN_PART if needed[0] <= high and low <= needed[1] else OUTSIDE


def range_text(ends: Sequence[float]) -> str:
    """Format a range with three digits, such as "1 to 2.5"."""
    low, high = (f"{end:.3g}" for end in ends)
    return low if low == high else f"{low} to {high}"
