"""What becomes of a hip in use: numbers of the first cycle, and what is seen later on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain
from math import degrees
from typing import Any

import numpy

from ..core.arrays import Numbers
from .contact_checks import COLUMNS, ContactCheck, largest_utilisation, list_notes
from .film import Lubricant
from .mix import Mix
from .rim import ClosestApproach, RimDistance
from .set_up import SetUp


@dataclass(frozen=True, kw_only=True, eq=False)
class Report:
    """A hip after a number of cycles.

    Attributes
    ----------
    cycles : float
    wear : array (rings, meridians)
        Worn depth in mm on the grid of the bore.
    volume, depth : float
        Worn away: mm³, and mm at the deepest point.
    work : float
        ∫ p v dA dt of all cycles so far, in N mm.
    displacement : array (3,)
        How far the ball's centre has moved since the first cycle at the largest force, in mm, in the cup's frame.
    worn_in, crept_in : array (3,)
        The same of a bore that were only worn, and of one that had only crept.
    max_pressure : float
        In the cycle, in MPa.
    edge_distance : array (loaded,)
        From the edge of each contact of the cycle to the end of the bore in mm; 0 where it reaches it.
    edge_place : array (loaded,)
        Where that is around the cup's axis, in rad from its uppermost point.
    edge_pressure : array (loaded,)
        Largest pressure in MPa in the outermost ring of cells.
    crept : array (rings, meridians)
        Depth of creep in mm.
    creep_depth : float
        At the point that has crept furthest, in mm.
    ball_wear : array (cells,)
        Worn depth of the ball in mm, in the cells of `facing.ball_grid`; empty where it does not wear.
    ball_volume, ball_depth : float
        Worn away of the ball: mm³, and mm at the deepest point.
    worst_contacts : array (activities, 5)
        Contact with the largest pressure in each activity; see `contact_checks.COLUMNS`.
    settled : bool
        Whether every contact balanced its load.
    """

    cycles: float
    wear: Numbers
    volume: float
    depth: float
    work: float
    displacement: Numbers
    worn_in: Numbers
    crept_in: Numbers
    max_pressure: float
    edge_distance: Numbers
    edge_place: Numbers
    edge_pressure: Numbers
    crept: Numbers
    creep_depth: float = 0.0
    ball_wear: Numbers = field(default_factory=lambda: numpy.zeros(0))
    ball_volume: float = 0.0
    ball_depth: float = 0.0
    worst_contacts: Numbers = field(default_factory=lambda: numpy.zeros((0, len(COLUMNS))))
    settled: bool = True

    @property
    def penetration(self) -> float:
        """How far the ball's centre has moved, in mm."""
        return float(numpy.linalg.norm(self.displacement))

    @property
    def edge(self) -> RimDistance:
        """How near the contacts come to the rim."""
        return RimDistance(distance=self.edge_distance, azimuth=self.edge_place, pressure=self.edge_pressure)

    def summary(self) -> dict[str, Any]:
        """For JSON, in mm, MPa, mm³."""
        return {
            "cycles": self.cycles,
            "volume": self.volume,
            "depth": self.depth,
            "penetration": self.penetration,
            "penetration_vector": [float(part) for part in self.displacement],
            "penetration_of_wear": float(numpy.linalg.norm(self.worn_in)),
            "penetration_of_creep": float(numpy.linalg.norm(self.crept_in)),
            "max_pressure": self.max_pressure,
            "creep_depth": self.creep_depth,
            "ball_volume": self.ball_volume,
            "ball_depth": self.ball_depth,
            "edge_distance": float(self.edge_distance.min()) if len(self.edge_distance) else None,
        }


@dataclass(frozen=True, kw_only=True)
class Error:
    """What volume and depth may be off by, relative to them, for this joint, law and cycle.

    `blocks` is the part of the geometry's updates; rings and instants are in the other two.
    """

    blocks: float
    volume: float
    depth: float


@dataclass(frozen=True, kw_only=True, eq=False)
class History:
    """What became of a hip in use.

    Attributes
    ----------
    use : InUse
    reports : tuple of Report
    error : Error
    steps : int
        Blocks in which the geometry was updated.
    lubricant : Lubricant
    """

    use: SetUp
    reports: tuple[Report, ...]
    error: Error
    steps: int
    lubricant: Lubricant = Lubricant()  # noqa: RUF009 (frozen)

    @property
    def last(self) -> Report:
        return self.reports[-1]

    @property
    def settled(self) -> bool:
        """Whether every contact balanced its load."""
        return all(report.settled for report in self.reports)

    @cached_property
    def contact_checks(self) -> tuple[tuple[ContactCheck, ...], ...]:
        """Checks of the contact model at each report, one for each activity with contact."""
        return tuple(self.use.contact_checks(report.worst_contacts) for report in self.reports)

    @property
    def valid(self) -> bool:
        """True if every contact balances its load and the worst contacts are inside their model's validity."""
        return self.settled and self.contact_valid

    @property
    def contact_valid(self) -> bool:
        """True if the worst contacts, unworn and at the reports, are inside the validity of their model."""
        return all(check.valid for check in (*self.use.unworn_checks, *chain(*self.contact_checks)))

    @property
    def utilisation(self) -> float | None:
        """Largest utilisation, unworn and at the reports; None where no yield stress is known."""
        return largest_utilisation((*self.use.unworn_checks, *chain(*self.contact_checks)))

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes on cycle, cup, laws, contact model and rim."""
        unsettled = () if self.settled else (_UNSETTLED,)
        return (*self._contact_notes, *self.use.notes, *self._worn_through, *self._at_the_rim, *unsettled)

    @property
    def _contact_notes(self) -> tuple[str, ...]:
        """Notes of the contact model, each at its first occurrence."""
        later = (_LATER.format(report.cycles) for report in self.reports)
        return tuple(list_notes([(_NEW, self.use.unworn_checks), *zip(later, self.contact_checks, strict=True)]))

    @property
    def _worn_through(self) -> tuple[str, ...]:
        """When the liner is gone, or so thin that it is another spring."""
        liner = float(self.use.joint.liner_thickness)
        for limit, sentence in ((1.0, _THROUGH), (_THIN, _THINNER)):
            found = next((report for report in self.reports if report.depth > limit * liner), None)
            if found is not None:
                return (sentence.format(found.cycles, found.depth, liner),)
        return ()

    @property
    def worst(self) -> ClosestApproach | None:
        """The instant of the first cycle in which the contact comes nearest to the rim."""
        return self.use.edge(self.use.unworn).closest_approach(self.use)

    @property
    def _at_the_rim(self) -> tuple[str, ...]:
        """When a contact reaches the rim first, in which instant most, and where."""
        seen = [(_NEW, self.worst)]
        seen += [(_LATER.format(report.cycles), report.edge.closest_approach(self.use)) for report in self.reports]
        for when, worst in seen:
            if worst is not None and worst.steps_at_rim:
                of = len(self.use.loaded)
                return (_REACHES.format(when, worst.steps_at_rim, of, worst.location, worst.pressure),)
        return ()

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        first, apart = self.use.first, self.use.separation
        return {
            "cycle": {
                "name": self.use.cycle.name,
                "instants": self.use.cycle.n_steps,
                "slide_mm": first.slide,
                "pressure_slide_integral_Nm": first.work,
                "cross_shear_mean": first.cross_shear,
                "crossing_angle_mean_deg": degrees(self.use.crossing_angle),
                "edge": _told(self.worst),
                "microseparation": None if apart is None else apart.summary(self.use.cycle),
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
                "unworn": [check.summary() for check in self.use.unworn_checks],
            },
            "film": self.use.film(self.lubricant).summary(),
            "initial": {"wear_mm3_per_Mc": first.volume, "depth_mm_per_Mc": first.depth},
            "history": list(map(self._seen, self.reports, self.contact_checks)),
            "error": {"volume": self.error.volume, "depth": self.error.depth, "blocks": self.error.blocks},
            "notes": list(self.notes),
        }

    def _seen(self, report: Report, checks: Sequence[ContactCheck]) -> dict[str, Any]:
        """Return a report as data for JSON, with its contacts, and with years if the cycles per year are known."""
        mix = self.use.cycle
        years = {"years": report.cycles / mix.per_year} if isinstance(mix, Mix) else {}
        contact = {
            "valid": report.settled and all(check.valid for check in checks),
            "utilisation": largest_utilisation(checks),
            "contact": [check.summary() for check in checks],
        }
        return {**report.summary(), **years, "edge": _told(report.edge.closest_approach(self.use)), **contact}


_THIN = 0.25
_THROUGH = "worn through: after {:g} cycles the depth is {:.3g} mm in a liner of {:g} mm; what follows has no meaning"
_THINNER = "after {:g} cycles {:.3g} mm of a liner of {:g} mm are worn away; its stiffness is still that of a whole one"
_NEW, _LATER = "in the first cycle", "after {:g} cycles"
_REACHES = (
    "edge loading: {} the contact reaches the rim in {} of {} instants, most at {}; "
    "the pressure in the outermost ring is at most {:.3g} MPa"
)
_UNSETTLED = "a contact did not balance its load: no digit of this run is to be trusted"


def _told(worst: ClosestApproach | None) -> dict[str, Any] | None:
    return None if worst is None else worst.summary()
