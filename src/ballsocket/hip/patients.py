"""Patients with one kind of hip: what differs between them scatters, and each goes through its own cycles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, radians
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import check_names, require
from ..elasticity.off_axis.surfaces import Springs
from ..studies.distributions import Distribution
from .contact_checks import utilisation_and_validity
from .cycle import Cycle
from .history import Report
from .mix import Mix
from .simulation import HipSimulation, check_total_wear, make_report
from .wear_integrator import WearIntegrator
from .wear_law import with_coefficient

SCATTERS = ("coefficient", "clearance", "inclination", "anteversion", "tilt", "body_weight", "cycles_per_year")
"""What may differ between patients: mm³/(N m), mm, rad, rad, rad, N, and a number."""

ANSWERS: Mapping[str, str] = {
    "volume": "mm3",
    "depth": "mm",
    "penetration": "mm",
    "max_pressure": "MPa",
    "creep_depth": "mm",
    "edge_distance": "mm",
}
"""What is seen of each patient, with its unit; see `Report`."""

_RINGS, _INSTANTS = radians(8.0), 32
"""Of a patient's run: many patients ask for quick ones, and scatter more than these are off."""

_UNSETTLED = "a contact did not balance its load"


@dataclass(frozen=True, kw_only=True, eq=False)
class Scatter:
    """What differs between patients, independently of each other.

    Parameters
    ----------
    use : HipSimulation
        The usual patient's. Contact of the others is on radial springs, of rings of 8° and 32 instants a cycle.
    distributions : mapping of str to Rectangular, Normal or LogNormal
        By name of `SCATTERS`. Forces grow with `body_weight`, cycles in a time with `cycles_per_year`; `coefficient` is
        that of the law, on a straight track where it has two, of which the other keeps its ratio.
    body_weight : float, optional
        In N, for which the cycle's forces are; the median by default.

    Raises
    ------
    ValueError
        Nothing that scatters, or what nobody has; a tilt beside an orientation; a law without a coefficient.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.hip import Archard, HipSimulation, Scatter, iso_14242_1
    >>> from ballsocket.studies import LogNormal
    >>> joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
    >>> use = HipSimulation(joint=joint, cycle=iso_14242_1(), wear=Archard(coefficient=1e-6))
    >>> scatter = Scatter(use=use, distributions={"coefficient": LogNormal(median=1e-6, factor=1.5)})
    >>> seen = scatter.patient({"coefficient": 2e-6}).seen([1e6])
    >>> round(seen[0].volume / scatter.patient({}).seen([1e6])[0].volume, 1)
    2.1
    """

    use: HipSimulation
    distributions: Mapping[str, Distribution]
    body_weight: float | None = None

    def __post_init__(self) -> None:
        check_names(self.distributions, SCATTERS, "among what scatters")
        if not self.distributions:
            raise ValueError("nothing scatters: " + ", ".join(SCATTERS))
        if "tilt" in self.distributions:
            for name in ("inclination", "anteversion"):
                if name in self.distributions:
                    raise ValueError(f"tilt and {name} are one too many: either says where the cup faces")
        if "coefficient" in self.distributions:
            with_coefficient(self.use.wear, 0.0)
        for name in ("body_weight", "cycles_per_year"):
            if name in self.distributions:
                middle = float(self.distributions[name].frozen.median())
                require(f"the median of {name}", middle, 0 < middle < inf, "it is positive")

    @cached_property
    def _medians(self) -> dict[str, float]:
        return {name: float(each.frozen.median()) for name, each in self.distributions.items()}

    @property
    def cycles_per_year(self) -> float | None:
        """Cycles that the usual patient does in a year: those of a mix, or the median; None where nobody says it."""
        cycle = self.use.cycle
        return cycle.per_year if isinstance(cycle, Mix) else self._medians.get("cycles_per_year")

    @cached_property
    def quick(self) -> HipSimulation:
        """The usual patient's as those of the others are: springs, wide rings and few instants."""
        use = self.use
        return replace(
            use,
            surface=use.surface if isinstance(use.surface, Springs) else Springs(),
            ring_width=max(use.ring_width, _RINGS),
            cycle=_sampled(use.cycle),
            cup=use.placed,
        )

    def patient(self, values: Mapping[str, float]) -> Patient:
        """The patient with these numbers, by name of `SCATTERS`; what is not there is the usual one's.

        Raises
        ------
        ValueError
            Numbers that no hip has, or that dislocate it.
        """
        use, cup = self.quick, self.quick.cup
        cup = cup.tilted(values["tilt"]) if "tilt" in values else cup
        facing: Any = {name: values[name] for name in ("inclination", "anteversion") if name in values}
        cup = replace(cup, **facing)
        pace, heavier = self._over(values, "cycles_per_year"), self._over(values, "body_weight")
        wear = use.wear
        if "coefficient" in values:
            require("coefficient", values["coefficient"], values["coefficient"] >= 0, "it is at least 0")
            wear = with_coefficient(wear, values["coefficient"])
        seconds = use.seconds_per_cycle
        return Patient(
            use=replace(
                use,
                joint=replace(use.joint, clearance=values.get("clearance", use.joint.clearance)),
                cup=cup,
                wear=wear,
                cycle=use.cycle.scaled(heavier) if heavier != 1 else use.cycle,
                seconds_per_cycle=None if seconds is None else seconds / pace,
            ),
            pace=pace,
        )

    def _over(self, values: Mapping[str, float], name: str) -> float:
        """A number over the usual one."""
        if name not in values:
            return 1.0
        said = self.body_weight if name == "body_weight" else self.cycles_per_year
        require(name, values[name], 0 < values[name] < inf, "it is positive")
        return values[name] / (said or self._medians[name])


@dataclass(frozen=True, kw_only=True, eq=False)
class Patient:
    """One patient.

    Attributes
    ----------
    use : HipSimulation
    pace : float
        Cycles in a time, over those of the usual patient.
    """

    use: HipSimulation
    pace: float

    def seen(self, counts: Sequence[float]) -> tuple[Report, ...]:
        """What is seen when the usual patient has done so many cycles.

        Raises
        ------
        ValueError
            A contact that did not balance its load; a liner that would be worn through many times over.
        """
        check_total_wear(self.use, self.pace * counts[-1])
        run = WearIntegrator(setup=self.use)
        found = tuple(make_report(run.run_until(self.pace * count, lambda done: None)) for count in counts)
        if not all(report.converged for report in found):
            raise ValueError(_UNSETTLED)
        return found


def answers_of(reports: Sequence[Report]) -> Numbers:
    """The numbers of `ANSWERS` that are seen: (reports, answers)."""
    return numpy.array([[_answer(report, name) for name in ANSWERS] for report in reports])


def contact_over(use: HipSimulation, reports: Sequence[Report]) -> Numbers:
    """Compute utilisation and validity of the contact, unworn and at each report."""
    return utilisation_and_validity(
        use.contact_model, use.joint, [use.unworn_worst, *(report.worst_contacts for report in reports)]
    )


def _answer(report: Report, name: str) -> float:
    value = getattr(report, name)
    return float(value.min(initial=inf)) if name == "edge_distance" else float(value)


@dataclass(frozen=True, eq=False)
class _Table:
    """A course by its values (..., n) at phases, with straight lines between: other processes can receive it."""

    phases: Numbers
    values: Numbers

    def __call__(self, phases: Numbers) -> Numbers:
        each = [numpy.interp(phases, self.phases, row, period=1.0) for row in numpy.atleast_2d(self.values)]
        return numpy.reshape(each, (*self.values.shape[:-1], -1))


def _sampled(cycle: Cycle | Mix) -> Cycle | Mix:
    """A cycle, or a mix of them, in few instants, and as numbers at these."""
    if isinstance(cycle, Mix):
        return Mix(activities=tuple(replace(each, cycle=_numbers(each.cycle)) for each in cycle.activities))
    return _numbers(cycle)


def _numbers(cycle: Cycle) -> Cycle:
    few = replace(cycle, n_steps=min(cycle.n_steps, _INSTANTS))
    middles, begins = few.phases, numpy.arange(few.n_steps) / few.n_steps
    force, angles = (numpy.asarray(of, dtype=float) for of in (few.force(middles), few.angles(begins)))
    return replace(few, force=_Table(middles, force), angles=_Table(begins, angles))
