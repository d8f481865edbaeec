"""Results of a wear simulation: reports at cycle counts, with numerical errors and notes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from itertools import chain
from math import degrees, inf, nan
from typing import Any

import numpy

from ..contact.verdict import Verdict
from ..core import answers
from ..core.answers import QUIET, Column, Row, Table
from ..core.arrays import Numbers
from ..core.display import OneLine, counted, load_plot
from ..core.kinds import MEGAPASCALS, MILLIMETRES
from ..core.quantities import QUANTITIES
from ..core.records import Record
from ..core.unit_systems import Amount, Sentence
from ..lubrication import Lubricant
from .contact_checks import COLUMNS, WORN_ERRORS, ContactCheck, largest_utilisation, list_check_notes, worst_verdict
from .film import Film
from .hip_setup import HipSetup
from .law_fields import law_summary
from .rim import ClosestApproach, RimDistance


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Report(Record, OneLine):
    """Results of a wear simulation after a number of cycles.

    Attributes
    ----------
    cycles : float
    wear : array (rings, meridians)
        Worn depth in mm on the grid of the bore.
    volume, depth : float
        Worn volume in mm³ and largest worn depth in mm.
    work : float
        ∫ p v dA dt of all cycles so far, in N mm.
    displacement : array (3,)
        Displacement of the ball's centre at the largest force since the first cycle, in mm, in the cup's frame.
    wear_displacement, creep_displacement : array (3,)
        The same for a bore with the wear alone, and for a bore with the creep alone.
    max_pressure : float
        Largest pressure of the cycle in MPa.
    edge_distance : array (loaded,)
        Arc from the edge of each contact of the cycle to the end of the bore in mm; 0 where the contact reaches it.
    edge_place : array (loaded,)
        Azimuth of that edge around the cup's axis, in rad from its uppermost point.
    edge_pressure : array (loaded,)
        Largest pressure in MPa in the outermost ring of cells.
    edge_loaded : array of bool (loaded,)
        Contacts that are edge loading; see `RimDistance.edge_loaded`.
    crept : array (rings, meridians)
        Depth of creep in mm.
    creep_depth : float
        Largest depth of creep in mm.
    ball_wear : array (cells,)
        Worn depth of the ball in mm, in the cells of `HipSimulation.ball_grid`; empty for a ball without wear.
    ball_volume, ball_depth : float
        Worn volume of the ball in mm³ and largest worn depth in mm.
    worst_contacts : array (activities, 5)
        Contact with the largest pressure in each activity; see `contact_checks.COLUMNS`.
    converged : bool
        True if every contact balanced its load.
    """

    cycles: float
    wear: Numbers
    volume: float
    depth: float
    work: float
    displacement: Numbers
    wear_displacement: Numbers
    creep_displacement: Numbers
    max_pressure: float
    edge_distance: Numbers
    edge_place: Numbers
    edge_pressure: Numbers
    edge_loaded: Numbers
    crept: Numbers
    creep_depth: float = 0.0
    ball_wear: Numbers = field(default_factory=lambda: numpy.zeros(0))
    ball_volume: float = 0.0
    ball_depth: float = 0.0
    worst_contacts: Numbers = field(default_factory=lambda: numpy.zeros((0, len(COLUMNS))))
    converged: bool = True

    @property
    def penetration(self) -> float:
        """Distance in mm by which the ball's centre has moved since the first cycle."""
        return float(numpy.linalg.norm(self.displacement))

    @property
    def edge(self) -> RimDistance:
        """Distance of each contact from the rim, with azimuth, pressure and edge loading."""
        return RimDistance(
            distance=self.edge_distance,
            azimuth=self.edge_place,
            pressure=self.edge_pressure,
            edge_loaded=self.edge_loaded,
        )

    def __str__(self) -> str:
        numbers = f"{self.volume:.4g} mm³ worn, penetration {self.penetration:.4g} mm"
        return f"after {counted(self.cycles, 'cycle')}: {numbers}, largest pressure {self.max_pressure:.4g} MPa"


@dataclass(frozen=True, kw_only=True)
class NumericalError:
    """Estimated relative errors of worn volume and depth for this joint, law and cycle.

    Attributes
    ----------
    blocks : float
        Part of the error by blocks of cycles with one geometry.
    volume, depth : float
        Total errors, by blocks, rings and time steps.
    """

    blocks: float
    volume: float
    depth: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class History(OneLine):
    """Results of a wear simulation: reports at several cycle counts.

    Attributes
    ----------
    use : HipSimulation
    reports : tuple of Report
    error : NumericalError
    steps : int
        Number of blocks of cycles, each with one geometry.
    lubricant : Lubricant, optional
        Lubricant of the film; None for a hip without film.
    """

    use: HipSetup
    reports: tuple[Report, ...]
    error: NumericalError
    steps: int
    lubricant: Lubricant | None = None

    @property
    def last(self) -> Report:
        """Last report, at the end of the run."""
        return self.reports[-1]

    def radiographic_displacement(self, report: Report) -> Numbers:
        """Compute the displacement (2,) of the ball's centre in mm in the plane of a radiograph from the front.

        The components are to the right and upwards. They are those of the displacement by wear and creep since the
        first cycle, at the largest force. Femoral head penetration by ASTM F2385 is this distance. Its scope was read,
        its full text was not.
        """
        right, _, upward = report.displacement @ numpy.array(self.use.frame.placed.frame)
        return numpy.array([right, upward])

    def radiographic_penetration(self, report: Report) -> float:
        """Compute the length in mm of `radiographic_displacement`: wear plus creep, as a radiograph shows it."""
        return float(numpy.linalg.norm(self.radiographic_displacement(report)))

    def table(self) -> Table:
        """List the wear at each report."""
        per_year, ranks = self.use.cycle.per_year, dict(_WEAR_RANKS)
        if per_year is not None:
            ranks["years"] = 0
        if self.use.creep is not None:
            ranks["creep_depth"] = 0
        if self.use.ball_wear is not None:
            ranks |= {"ball_volume": 0, "ball_depth": 0}
        heads = {"edge_distance": "to the rim"}
        columns = [Column.of(QUANTITIES[name], rank=rank, head=heads.get(name, "")) for name, rank in ranks.items()]
        columns.append(Column.of_words("edge_loaded_instants", rank=QUIET))
        columns.append(Column.of(QUANTITIES["utilisation"], rank=QUIET))
        columns += [Column.of_words(key, rank=QUIET) for key in ("verdict", "valid")]
        rows = []
        for report, checks in zip(self.reports, self.contact_checks, strict=True):
            numbers = {
                "years": nan if per_year is None else report.cycles / per_year,
                "penetration_of_wear": float(numpy.linalg.norm(report.wear_displacement)),
                "penetration_of_creep": float(numpy.linalg.norm(report.creep_displacement)),
                "radiographic_penetration": self.radiographic_penetration(report),
                "edge_distance": float(report.edge_distance.min(initial=inf)),
                "edge_pressure": float(report.edge_pressure.max(initial=0.0)),
            }
            cells = [numbers[name] if name in numbers else getattr(report, name) for name in ranks]
            valid, verdict = report.converged and all(check.valid for check in checks), worst_verdict(checks)
            rows.append(Row([*cells, int(report.edge_loaded.sum()), largest_utilisation(checks), verdict.word, valid]))
        return Table("history", "Numbers", columns, rows)

    def to_frame(self) -> Any:
        """Return the reports as a pandas DataFrame, one row for each; heads have units: "volume_mm3"."""
        return answers.to_frame(self.table())

    def plot(self) -> Any:
        """Draw worn volume and penetration over the cycles; return the matplotlib figure."""
        return load_plot("wear")({"": self})

    @property
    def converged(self) -> bool:
        """True if the contacts balance their loads in all reports."""
        return all(report.converged for report in self.reports)

    @cached_property
    def contact_checks(self) -> tuple[tuple[ContactCheck, ...], ...]:
        """Checks of the contact model at each report, one for each activity with contact."""
        return tuple(
            self.use.contact_checks(report.worst_contacts, report.edge, WORN_ERRORS) for report in self.reports
        )

    @property
    def valid(self) -> bool:
        """True if all contacts balance their loads and the worst contacts are valid for the contact model."""
        return self.converged and self.contact_valid

    @property
    def contact_valid(self) -> bool:
        """True if the worst contacts at the start and at all reports are valid for the contact model."""
        return all(check.valid for check in (*self.use.unworn_checks, *chain(*self.contact_checks)))

    @property
    def verdict(self) -> Verdict:
        """Verdict on the yield stress in the first cycle and at each report."""
        return worst_verdict((*self.use.unworn_checks, *chain(*self.contact_checks)))

    @property
    def utilisation(self) -> float | None:
        """Largest ratio of von Mises to yield stress during the run; None if it is unknown."""
        return largest_utilisation((*self.use.unworn_checks, *chain(*self.contact_checks)))

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on cycle, cup, laws, contact model and rim, for reports."""
        return tuple(self._list_notes())

    def _list_notes(self) -> Iterator[str]:
        use = self.use
        later = [f"after {counted(report.cycles, 'cycle')}" for report in self.reports]
        yield from list_check_notes([(_FIRST_CYCLE, use.unworn_checks), *zip(later, self.contact_checks, strict=True)])
        yield from use.notes
        liner = float(use.joint.liner_thickness)
        for limit, sentence in ((1.0, _WORN_THROUGH), (_THIN_LINER, _WORN_THIN)):
            first = next((report for report in self.reports if report.depth > limit * liner), None)
            if first is not None:
                depths = Amount(first.depth, MILLIMETRES, 3), Amount(liner, MILLIMETRES)
                yield Sentence(sentence, counted(first.cycles, "cycle"), *depths)
                break
        approaches = [self.worst, *(report.edge.closest_approach(use.frame) for report in self.reports)]
        first_stages: dict[str, tuple[str, ClosestApproach]] = {}  # by the kind of contact at the rim
        highest: dict[str, float] = {}  # pressure at the rim in any stage
        for stage, nearest in zip([_FIRST_CYCLE, *later], approaches, strict=True):
            if nearest is not None and nearest.steps_at_rim:
                first_stages.setdefault(nearest.kind, (stage, nearest))
                highest[nearest.kind] = max(highest.get(nearest.kind, 0.0), nearest.pressure)
        count = counted(len(use.frame.loaded), "instant")
        unworn_distance = Amount(0.0 if self.worst is None else self.worst.distance, MILLIMETRES, 3)
        for kind, (stage, nearest) in sorted(first_stages.items()):
            pressure = Amount(highest[kind], MEGAPASCALS, 3)
            if nearest.steps_edge_loaded:
                steps = str(nearest.steps_edge_loaded)
                yield Sentence(_EDGE_LOADING, stage, steps, count, nearest.location, pressure)
            else:
                yield Sentence(_WORN_TO_RIM, stage, str(nearest.steps_at_rim), count, unworn_distance, pressure)
        if not self.converged:
            yield "a contact did not balance its load: the results of this run are invalid"

    @property
    def worst(self) -> ClosestApproach | None:
        """Closest approach of the contact to the rim in the first cycle; None without contact."""
        return self.use.edge(self.use.unworn).closest_approach(self.use.frame)

    def __str__(self) -> str:
        joint, count = self.use.joint, len(self.reports)
        state = "" if self.converged else "; not converged"
        return f"of {joint.name or joint.dimensions}, {counted(count, 'report')}, last {self.last}{state}"

    def _repr_html_(self) -> str:
        notes = "".join(f"<div>{escape(note)}</div>" for note in self.notes)
        return f"<div>{escape(str(self.use))}</div>{answers.to_html(self.table())}{notes}"

    def summary(self) -> dict[str, Any]:
        """Return the results as a dictionary for JSON."""
        first, worst, separation, limit = self.use.first, self.worst, self.use.frame.separation, self.use.film_limit
        film = None if self.film is None else self.film.summary()
        if film and self.lubricant is not None:
            film["hamrock_dowson"] = self.use.film(self.lubricant, method="hamrock-dowson").summary()
        return {
            "cycle": {
                "name": self.use.cycle.name,
                "instants": self.use.cycle.n_steps,
                "slide_mm": first.slide,
                "pressure_slide_integral_Nm": first.work,
                "cross_shear_mean": first.cross_shear,
                "crossing_angle_mean_deg": degrees(self.use.crossing_angle),
                "edge": None if worst is None else worst.summary(),
                "microseparation": None if separation is None else separation.summary(self.use.cycle),
                "peaks": {
                    "force_N": first.max_force,
                    "max_pressure_MPa": first.max_pressure,
                    "speed_mm_s": self.use.largest_speed,
                },
            },
            "contact": {
                "model": self.use.contact_model.name,
                "valid": self.contact_valid,
                "utilisation": self.utilisation,
                "verdict": self.verdict.word,
                "unworn": [check.summary() for check in self.use.unworn_checks],
            },
            "laws": {
                "wear": law_summary(self.use.wear),
                "ball_wear": law_summary(self.use.ball_wear),
                "creep": law_summary(self.use.creep),
                "film_limit": None if limit is None else limit.summary(self.use.excluded_work_share),
            },
            "film": film,
            "initial": {"wear_mm3_per_Mc": first.volume, "depth_mm_per_Mc": first.depth},
            "history": [
                self._report_summary(*parts)
                for parts in zip(answers.records(self.table()), self.reports, self.contact_checks, strict=True)
            ],
            "error": {"volume": self.error.volume, "depth": self.error.depth, "blocks": self.error.blocks},
            "notes": list(self.notes),
        }

    @property
    def film(self) -> Film | None:
        """Film of the first cycle by the wave; None for a hip without film."""
        return None if self.lubricant is None else self.use.film(self.lubricant)

    def _report_summary(self, record: Mapping[str, Any], report: Report, checks: Sequence[ContactCheck]) -> Any:
        edge = report.edge.closest_approach(self.use.frame)
        return {
            **record,
            "penetration_vector": [float(part) for part in report.displacement],
            "radiographic_vector": [float(part) for part in self.radiographic_displacement(report)],
            "edge": None if edge is None else edge.summary(),
            "contact": [check.summary() for check in checks],
        }


_WEAR_RANKS = {
    "cycles": 0,
    "years": QUIET,
    "volume": 0,
    "depth": 0,
    "penetration": 0,
    "penetration_of_wear": QUIET,
    "penetration_of_creep": QUIET,
    "radiographic_penetration": QUIET,
    "max_pressure": 0,
    "creep_depth": QUIET,
    "ball_volume": QUIET,
    "ball_depth": QUIET,
    "edge_distance": 0,
    "edge_pressure": QUIET,
}
"""Quantities of the table of wear; those that a hip does not have are in data only."""

_THIN_LINER = 0.25  # worn depth above which a note appears, relative to the thickness of the liner
_WORN_THROUGH = "worn through: after {} the depth is {} in a liner of {}; later reports are void"
_WORN_THIN = "after {} {} of a liner of {} are worn away; its stiffness is still that of the unworn liner"
_FIRST_CYCLE = "in the first cycle"
_EDGE_LOADING = (
    "edge loading: {} the contact reaches the rim in {} of {}, most at {}; "
    "the pressure in the outermost ring is at most {}"
)
_WORN_TO_RIM = (
    "worn to the rim: {} the worn bore fits the ball and touches it up to the rim in {} of {}; this is not "
    "edge loading, since under the same loads the unworn contact ends {} before the rim; the pressure in the "
    "outermost ring is at most {}"
)
