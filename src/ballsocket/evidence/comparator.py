"""A published number beside ours: every input, which of them is assumed, and over which joints it reaches."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy

from ..core.arrays import Array, to_numpy, where
from ..problem import Joint
from ..studies.parameters import LOADS, press_arguments
from .matrix import Row
from .question import ALMOST_ALL, Question

Ranges = Mapping[str, Sequence[float]]
"""Least and largest of each of the numbers that a linear contact depends on."""

_RIGID = 0.02
"""A liner so much softer than its ball: that takes no part."""


def _stiffness(joint: Joint) -> Array:
    ratio = 0.0 if joint.ball is None else joint.liner.young / joint.ball.young
    return where(ratio < _RIGID, 0.0, ratio)


SIMILARITY: Mapping[str, Callable[[Joint, Array], Array]] = MappingProxyType(
    {
        "c/R1": lambda joint, force: joint.clearance / joint.ball_radius,
        "R1/L": lambda joint, force: joint.ball_radius / joint.liner_thickness,
        "ν": lambda joint, force: joint.liner.poisson,
        "F/(E R1²)": lambda joint, force: force / (joint.liner.young * joint.ball_radius**2),
        "E/E of the ball": lambda joint, force: _stiffness(joint),
    }
)
"""What a linear contact depends on, without units: two joints that share these are one, whatever their sizes. A liner
of less than a fiftieth of its ball's stiffness counts as on a rigid one."""


@dataclass(frozen=True, kw_only=True)
class Comparator:
    """A published number beside ours.

    Attributes
    ----------
    name, title, source : str
    read : str
        What of the source was read.
    kind : str
        How the number was found: measured, or computed by others.
    inputs, assumed : mapping of str to str
        What was published, and what we had to assume.
    published : mapping of str to str
    ours : mapping of str to tuple of float
        The least and the most over what is assumed, by name with unit; empty where our models have no answer.
    reaches : mapping of str to tuple of float
        The joints behind it, by the numbers of `SIMILARITY`.
    agreement : str
        In a sentence, gaps named.
    """

    name: str
    title: str
    source: str
    read: str
    kind: str
    inputs: Mapping[str, str]
    assumed: Mapping[str, str]
    published: Mapping[str, str]
    agreement: str
    ours: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    reaches: Ranges = field(default_factory=dict)

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        return {
            "name": self.name,
            "title": self.title,
            "source": self.source,
            "read": self.read,
            "kind": self.kind,
            "inputs": dict(self.inputs),
            "assumed": dict(self.assumed),
            "published": dict(self.published),
            "ours": {name: list(ends) for name, ends in self.ours.items()},
            "reaches": {name: list(ends) for name, ends in self.reaches.items()},
            "agreement": self.agreement,
            "call": f"ballsocket.evidence.comparators.PUBLISHED[{self.name!r}]()",
        }


def reach_of(pressed: Iterable[tuple[Joint, Any]]) -> Ranges:
    """The ranges over joints, each with its forces in N."""
    listed = list(pressed)
    return {name: _ends([each(*one) for one in listed]) for name, each in SIMILARITY.items()}


def _ends(values: Iterable[Any]) -> tuple[float, float]:
    flat = numpy.concatenate([to_numpy(each).ravel() for each in values])
    return float(numpy.nanmin(flat)), float(numpy.nanmax(flat))


def reach_asked(question: Question, found: Sequence[Row]) -> Ranges:
    """The ranges over a question's matrix, with the forces that its cases came to, and over its tolerances."""
    cases = {name: numpy.array([row.case[name] for row in found]) for name in found[0].case}
    forces = numpy.array([row.numbers.get("force", numpy.nan) for row in found])
    spreads = {name: spread.frozen.ppf(ALMOST_ALL) for name, spread in question.tolerances.items() if name not in LOADS}
    ends = [{}, *({name: end} for name, both in spreads.items() for end in both)]
    return reach_of((press_arguments(question.file.joint, {**cases, **end})[0], forces) for end in ends)


def applicability(reaches: Mapping[str, Sequence[float]], asked: Ranges, tilted: bool) -> dict[str, Any]:
    """Whether a comparator speaks of what is asked, as one dictionary for JSON.

    Parameters
    ----------
    reaches, asked : mapping of str to pair of float
        The comparator's ranges, and the question's, by the numbers of `SIMILARITY`.
    tilted : bool
        Whether the question tilts the load; every comparator presses along its axis.
    """
    where = {name: _place(asked[name], reaches[name]) for name in reaches}
    why = [
        f"{name} {between(asked[name])} against {between(reaches[name])}"
        for name, place in where.items()
        if place != "within"
    ]
    why += ["a tilted load against one along the axis"] if tilted else []
    why += [] if where else ["no joint of one lined socket is behind it"]
    verdict = _verdict(where, bool(why))
    return {"verdict": verdict, "where": where, "text": ": ".join(filter(None, [verdict, "; ".join(why)]))}


def _verdict(where: Mapping[str, str], gaps: bool) -> str:
    outside = [name for name, place in where.items() if place == "outside"]
    if not where or "E/E of the ball" in outside or len(outside) > len(where) / 2:
        return "does not apply"
    return "applies in part" if gaps else "applies"


_CLOSE = 1e-9


def _place(asked: Sequence[float], reached: Sequence[float]) -> str:
    """Where one range lies against another."""
    low, high = reached[0] * (1 - _CLOSE), reached[1] * (1 + _CLOSE)
    if low <= asked[0] and asked[1] <= high:
        return "within"
    return "in part" if asked[0] <= high and low <= asked[1] else "outside"


def between(ends: Sequence[float]) -> str:
    """Two ends in words."""
    low, high = (f"{end:.3g}" for end in ends)
    return low if low == high else f"{low} to {high}"
