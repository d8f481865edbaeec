"""The next measurement: the quantity and the load from which the data would gain most information."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import log
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from .information import TOLD
from .measured import OF_JOINT, PERFECT, Machine, Measured

if TYPE_CHECKING:
    from .parameters import Identified

USUAL = ("indentation", "half_angle", "max_pressure", "diametral_clearance")
"""What is usually measured: the last is the free play of a joint, and needs no load."""

_SHARE = 0.02  # uncertainty of what has not been measured yet, as a share of its value
_LOADS = 6
_BEYOND = 1.5  # times the largest load of the data


@dataclass(frozen=True)
class Candidate:
    """A measurement that could be made.

    Attributes
    ----------
    quantity : str
        One of `ballsocket.identify.MEASURED`.
    uncertainty : float
        Its standard uncertainty; in its unit.
    force : float or None
        In N; None of a number of the joint.
    machine : Machine
        What would read an indentation.
    order : float
        Number of the reading, for a machine whose zero drifts.
    """

    quantity: str
    uncertainty: float
    force: float | None = None
    machine: Machine = PERFECT
    order: float = 0.0

    def measured(self, value: float) -> Measured:
        """Convert the candidate to a set of data."""
        words: dict[str, Any] = {} if self.force is None else {"force": self.force}
        return Measured(
            quantity=self.quantity,
            values=value,
            uncertainty=self.uncertainty,
            machine=self.machine,
            order=self.order,
            **words,
        )


@dataclass(frozen=True)
class Gain:
    """What a candidate is expected to tell.

    Attributes
    ----------
    candidate : Candidate
    bits : float
        Half log2 of the growth of the information's determinant (D-optimal).
    left : dict of str to float
        By unknown, its uncertainty afterwards over that of today.
    settles : tuple of str
        Unknowns that this measurement would make identifiable.
    """

    candidate: Candidate
    bits: float
    left: dict[str, float]
    settles: tuple[str, ...]

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        words = {"quantity": self.candidate.quantity, "force": self.candidate.force}
        return {**words, "uncertainty": self.candidate.uncertainty, "bits": self.bits, "left": self.left}


@dataclass(frozen=True, eq=False)
class Experiment:
    """Candidates for the next measurement, the one that tells most first."""

    gains: tuple[Gain, ...]
    untold: tuple[str, ...]

    @property
    def best(self) -> Gain:
        return self.gains[0]

    @property
    def each_quantity(self) -> tuple[Gain, ...]:
        """The best of each quantity."""
        firsts: dict[str, Gain] = {}
        for gain in self.gains:
            firsts.setdefault(gain.candidate.quantity, gain)
        return tuple(firsts.values())

    @property
    def settling(self) -> tuple[str, ...]:
        """Quantities that would each make every unknown identifiable."""
        found = [gain.candidate.quantity for gain in self.gains if set(gain.settles) == set(self.untold)]
        return tuple(name for name in USUAL if name in found) if self.untold else ()

    def summary(self) -> list[dict[str, Any]]:
        """A list for JSON."""
        return [gain.summary() for gain in self.gains]


def experiment(found: Identified, candidates: Iterable[Candidate] | None = None) -> Experiment:
    """Expected gains of candidates, at what is the best point today.

    Parameters
    ----------
    found : Identified
    candidates : iterable of Candidate
        By default the usual quantities at loads up to one and a half times those of the data, as uncertain as those of
        the data were, or 2 %.

    Returns
    -------
    Experiment

    References
    ----------
    Chaloner & Verdinelli 1995, Stat. Sci. 10, 273.
    """
    chosen = usual(found) if candidates is None else tuple(candidates)
    rows = _slopes(found, chosen)
    kept = [(each, row) for each, row in zip(chosen, rows, strict=True) if numpy.isfinite(row).all()]
    gains = [_gain(found, each, row) for each, row in kept]
    return Experiment(tuple(sorted(gains, key=lambda gain: -gain.bits)), found.information.unidentifiable)


def usual(found: Identified) -> tuple[Candidate, ...]:
    """What could be measured next: see `experiment`."""
    forces = _forces(found)
    pairs = [(name, None) if name in OF_JOINT else (name, force) for name in USUAL for force in forces]
    plain = [Candidate(name, 1.0, force, *_machine(found, name)) for name, force in dict.fromkeys(pairs)]
    values = _answers(found, plain, found.best.places)
    return tuple(
        replace(each, uncertainty=_uncertainty(found, each.quantity, value))
        for each, value in zip(plain, values.tolist(), strict=True)
        if value > 0
    )


def _forces(found: Identified) -> list[float]:
    loads = [each.loads for each in found.data if each.load == "force"]
    loads += [row for each, row in zip(found.data, found.answers, strict=True) if each.quantity == "force"]
    most = float(numpy.max(numpy.concatenate(loads), initial=0.0)) if loads else 0.0
    return numpy.linspace(0.0, _BEYOND * (most or 2000.0), _LOADS + 1)[1:].tolist()


def _machine(found: Identified, quantity: str) -> tuple[Machine, float]:
    """Choose the machine of the present indentations, and the number of its next reading."""
    orders = {each.machine: each.order for each in found.data if each.machine is not PERFECT}
    if quantity != "indentation" or not orders:
        return PERFECT, 0.0
    machine, order = next(iter(orders.items()))
    return machine, float(order.max()) + 1


def _uncertainty(found: Identified, quantity: str, value: float) -> float:
    """An uncertainty as it was so far, in its unit or relative, whichever varied less; 2 % of what is new."""
    rows = [(each.uncertainty, abs(each.values)) for each in found.data if each.quantity == quantity]
    if not rows:
        return _SHARE * value
    plain, values = (numpy.concatenate(parts) for parts in zip(*rows, strict=True))
    relative = plain / numpy.maximum(values, 1e-300)
    alike = numpy.std(numpy.log(plain)) <= numpy.std(numpy.log(relative))
    return float(numpy.median(plain) if alike else numpy.median(relative) * value)


def _answers(found: Identified, candidates: Sequence[Candidate], places: Numbers) -> Numbers:
    """What the model says that they would read, at many places."""
    answers = replace(found.misfit.answers, data=tuple(each.measured(1.0) for each in candidates))
    return answers.at(numpy.atleast_2d(found.scales.values(places)))[0]


def _slopes(found: Identified, candidates: Sequence[Candidate]) -> Numbers:
    """The slopes of candidates along the places, (candidates, unknowns)."""
    answers = replace(found.misfit.answers, data=tuple(each.measured(1.0) for each in candidates))
    return found.misfit.slopes(answers, found.scales, found.best.places)[1]


def _gain(found: Identified, candidate: Candidate, slopes: Numbers) -> Gain:
    """By the rank-one update of the covariance."""
    before = found.information.covariance
    row = slopes * (found.misfit.scatter.told**0.5 / candidate.uncertainty)
    seen = before @ row
    told = float(row @ seen)
    after = numpy.diagonal(before) - seen**2 / (1 + told)
    names = found.scales.names
    settled = [name for place, name in enumerate(names) if after[place] ** 0.5 < TOLD]
    return Gain(
        candidate=candidate,
        bits=log(1 + told) / log(4),
        left=dict(zip(names, numpy.sqrt(after / numpy.diagonal(before)).tolist(), strict=True)),
        settles=tuple(name for name in found.information.unidentifiable if name in settled),
    )
