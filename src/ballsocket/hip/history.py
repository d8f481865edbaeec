"""What becomes of a hip in use: numbers of the first cycle, and what is seen later on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy

from ..arrays import Numbers

if TYPE_CHECKING:
    from .use import InUse


@dataclass(frozen=True, kw_only=True)
class First:
    """A cycle on a bore that is not worn.

    Attributes
    ----------
    slide : float
        Of the ball past the line of the load, in mm.
    work : float
        ∫∫ p |v| dA dt in N m.
    cross_shear : float
        Its mean over the socket, weighted by p |v|.
    volume, depth : float
        What a million such cycles would wear: mm³, and mm at the deepest point.
    max_pressure, max_force : float
        In MPa and N.
    """

    slide: float
    work: float
    cross_shear: float
    volume: float
    depth: float
    max_pressure: float
    max_force: float


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
        ∫ p |v| dA dt of all cycles so far, in N mm.
    displacement : array (3,)
        How far the ball's centre has moved since the first cycle at the largest force, in mm, in the cup's frame.
    max_pressure : float
        In the cycle, in MPa.
    creep_depth : float
        At the point that has crept furthest, in mm.
    settled : bool
        Whether every contact balanced its load.
    """

    cycles: float
    wear: Numbers
    volume: float
    depth: float
    work: float
    displacement: Numbers
    max_pressure: float
    creep_depth: float = 0.0
    settled: bool = True

    @property
    def penetration(self) -> float:
        """How far the ball's centre has moved, in mm."""
        return float(numpy.linalg.norm(self.displacement))

    def summary(self) -> dict[str, Any]:
        """For JSON, in mm, MPa, mm³."""
        return {
            "cycles": self.cycles,
            "volume": self.volume,
            "depth": self.depth,
            "penetration": self.penetration,
            "penetration_vector": [float(part) for part in self.displacement],
            "max_pressure": self.max_pressure,
            "creep_depth": self.creep_depth,
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
    """

    use: InUse
    reports: tuple[Report, ...]
    error: Error
    steps: int

    @property
    def last(self) -> Report:
        return self.reports[-1]

    @property
    def settled(self) -> bool:
        """Whether every contact balanced its load."""
        return all(report.settled for report in self.reports)

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be said of it."""
        return self.use.notes + (() if self.settled else (_UNSETTLED,))

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        first = self.use.first
        return {
            "cycle": {
                "name": self.use.cycle.name,
                "instants": self.use.cycle.instants,
                "slide_mm": first.slide,
                "pressure_slide_integral_Nm": first.work,
                "cross_shear_mean": first.cross_shear,
                "peaks": {"force_N": first.max_force, "max_pressure_MPa": first.max_pressure},
            },
            "initial": {"wear_mm3_per_Mc": first.volume, "depth_mm_per_Mc": first.depth},
            "history": [report.summary() for report in self.reports],
            "error": {"volume": self.error.volume, "depth": self.error.depth, "blocks": self.error.blocks},
            "notes": list(self.notes),
        }


_UNSETTLED = "a contact did not balance its load: no digit of this run is to be trusted"
