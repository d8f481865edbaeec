"""A hip in use: a joint, how its cup stands, what it goes through, and how that wears it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import inf, radians
from pathlib import Path
from typing import Any

import numpy

from ..arrays import Numbers, is_plain
from ..checks import require
from ..cup import Cup
from ..fem.shapes import socket_shape
from ..sphere.grid import Grid, even_grid, grid
from ..sphere.model import Sphere
from ..sphere.surfaces import ClosedShell, RealCup, Springs
from ..validity import inside
from .blocks import Run
from .checkpoint import checkpoint
from .creep import Ladder
from .edge import Edge, edge_of
from .elastic_bed import elastic_bed
from .facing import ball_grid
from .film import Film, Lubricant, film
from .history import Error, First, History
from .laws import Law, Pass
from .looks import check_cycles, looks
from .placing import Placed
from .sliding import Sliding
from .springs import CycleBed, Rest, spring_bed


@dataclass(frozen=True, kw_only=True, eq=False)
class InUse(Placed):
    """A hip in use.

    Parameters
    ----------
    joint : Joint
        Of plain numbers.
    cycle : Cycle or Mix
        In the body's frame, as the cup's orientation is. On a left cup it is mirrored.
    wear : Law
        `Archard`, `AreaLaw`, `CrossShear` or `OwnLaw`.
    cup : Cup
        Arc of cover and where it faces; where the cycle's standard says a tilt, that of a cup that faces down.
    surface : Springs, ClosedShell or RealCup
        How the bore gives way; the paper's springs by default.
    ring_width : float
        Of the rings of the wear map in rad, 3° by default.
    ball_wear : Law, optional
        How the ball wears too, as hard ones do, in its own frame; not at all by default.
    creep : Ladder, optional
        How the liner creeps; not at all by default.
    seconds_per_cycle : float, optional
        In which creep goes on; those that the cycle lasts by default.
    tolerance : float
        Of a block, over the largest depth so far. Default 4e-3.

    Raises
    ------
    ValueError
        A load that pushes the ball over the rim, with its instant; a number that is not allowed.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.hip import Archard, InUse, iso_14242_1
    >>> joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
    >>> use = InUse(joint=joint, cycle=iso_14242_1(), wear=Archard(coefficient=1e-6))
    >>> round(use.first.volume, 1)
    30.1
    """

    wear: Law
    surface: Springs | ClosedShell | RealCup = Springs()  # noqa: RUF009 (frozen)
    ring_width: float = radians(3.0)
    ball_wear: Law | None = None
    creep: Ladder | None = None
    seconds_per_cycle: float | None = None
    tolerance: float = 4e-3

    def __post_init__(self) -> None:
        if not all(map(is_plain, self.joint.numbers())):
            raise ValueError("a hip in use is one joint, and this one has arrays of numbers")
        require("ring_width", self.ring_width, radians(0.5) <= self.ring_width <= radians(10.0), "0.5 to 10 degrees")
        require("tolerance", self.tolerance, 1e-9 <= self.tolerance <= 0.1, "1e-9 to 0.1")
        if not isinstance(self.surface, Springs):
            inside(Sphere(cup=self._around).domain, self.joint, "full elasticity")
        if self.creep is not None:
            thickness = float(self.joint.liner_thickness)
            require("liner_thickness", thickness, thickness < inf, "creep needs a liner that ends")
        if self.ball_wear is not None and (self.creep is not None or not isinstance(self.surface, Springs)):
            raise ValueError("a ball that wears is on springs, in a socket that does not creep")
        require("seconds_per_cycle", self.seconds, 0 < self.seconds < inf, "a time (s) is positive and finite")
        self._check_held()

    def __getstate__(self) -> dict[str, Any]:
        """For other processes: the hip itself, without what was found of it."""
        return {each.name: getattr(self, each.name) for each in fields(self)}

    @property
    def seconds(self) -> float:
        """That a cycle stands for in the life of the liner."""
        return self.cycle.duration if self.seconds_per_cycle is None else self.seconds_per_cycle

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be said of the cycle, the cup and the law."""
        crept = self.creep.notes if self.creep else ()
        worn = (*self.wear.notes, *(self.ball_wear.notes if self.ball_wear else ()))
        return (*self.cycle.notes, *self._placing_notes, *worn, *crept)

    @cached_property
    def grid(self) -> Grid:
        """The cells of the bore."""
        reach = socket_shape(self.joint, self.cup).reach
        return grid(reach, self.ring_width) if isinstance(self.surface, Springs) else even_grid(reach, self.ring_width)

    @cached_property
    def bed(self) -> CycleBed:
        joint = self.joint
        if not isinstance(self.surface, Springs):
            return elastic_bed(self.surface, joint, self._around, self.ring_width)
        return spring_bed(
            self.grid,
            modulus=float(self.surface.modulus(joint)),
            clearance=float(joint.clearance),
            socket_radius=float(joint.socket_radius),
        )

    @cached_property
    def ball_areas(self) -> Numbers:
        """Areas of the ball's own cells in mm²: (cells,)."""
        own = ball_grid(self.ring_width)
        return numpy.repeat(own.areas[:, 0], own.meridians) * float(self.joint.ball_radius) ** 2

    @property
    def _around(self) -> Cup:
        """The cup, wherever it faces."""
        return Cup(arc_of_cover=self.cup.arc_of_cover, chamfer=self.cup.chamfer, interface=self.cup.interface)

    @cached_property
    def sliding(self) -> Sliding:
        return Sliding(radius=float(self.joint.ball_radius), turns=self.turns, directions=self.bed.directions)

    def edge(self, rest: Rest, depth: Numbers | float = 0.0) -> Edge:
        """How near the edge of each contact comes to the end of the bore, and where."""
        return edge_of(self, self.bed.edge_field(rest, self._everywhere(depth)))

    def edge_distance(self, rest: Rest, depth: Numbers | float = 0.0) -> Numbers:
        """The arc in mm from the edge of each contact to the end of the bore where it is nearest: (loaded,).

        0 where the contact reaches it: edge loading.
        """
        return self.edge(rest, depth).distance

    def rest(self, depth: Numbers | float = 0.0, start: Rest | None = None) -> Rest:
        """The contacts of a cycle on a bore that is worn by a depth in mm (cells,)."""
        return self.bed.rest(self.loads, self._everywhere(depth), start)

    def _everywhere(self, depth: Numbers | float) -> Numbers:
        """A depth of each cell, (cells,), or of each in each instant, (loaded, cells)."""
        field = numpy.asarray(depth)
        return field if field.ndim == 2 else numpy.broadcast_to(field, self.bed.areas.shape)

    def passed(self, rest: Rest) -> Pass:
        """What the points of the socket go through under these contacts."""
        return Pass(pressure=rest.pressure, sliding=self.sliding)

    @cached_property
    def unworn(self) -> Rest:
        """The contacts of the first cycle."""
        return self.rest()

    def film(self, lubricant: Lubricant, depth: Numbers | float = 0.0) -> Film:
        """The film and the friction of a cycle on a bore that is worn by a depth in mm (cells,)."""
        return film(self, self.rest(depth), lubricant)

    @cached_property
    def first(self) -> First:
        """The first cycle, on a bore that is not worn, a million times over."""
        done, areas = self.passed(self.unworn), self.bed.areas
        depth, work = self.wear.depth(done), done.work * areas
        whole = float(work.sum())
        return First(
            slide=self.slide,
            work=whole / 1e3,
            cross_shear=float(done.cross_shear @ work) / whole if whole > 0 else 0.0,
            volume=1e6 * float(depth @ areas),
            depth=1e6 * float(depth.max(initial=0.0)),
            max_pressure=float(done.pressure.max(initial=0.0)),
            max_force=self.cycle.largest_force,
        )

    @property
    def crossing_angle(self) -> float:
        """Between sliding and its principal direction in the first cycle, in rad: its mean, weighted by p v."""
        done = self.passed(self.unworn)
        touched = numpy.flatnonzero(done.work > 0)
        weight = (done.work * self.bed.areas)[touched]
        found = self.sliding.part(touched).crossing_angle(done.pressure[:, touched])
        return float(found @ weight / weight.sum()) if len(touched) else 0.0

    @property
    def largest_speed(self) -> float:
        """The largest speed of sliding in contact in the first cycle, in mm/s."""
        within = numpy.where(self.unworn.pressure > 0, self.sliding.steps, 0.0)
        return float((within / self.cycle.seconds[self.loaded][:, None]).max(initial=0.0))

    def after(
        self,
        cycles: float,
        report_at: Sequence[float] = (),
        listen: Callable[[float], None] = lambda done: None,
        lubricant: Lubricant = Lubricant(),  # noqa: B008 (frozen)
        store: Path | None = None,
    ) -> History:
        """The hip after so many cycles.

        Parameters
        ----------
        cycles : float
        report_at : sequence of float
            Cycles at which to look; the end is always looked at.
        listen : function
            Called with the number of cycles done after each block.
        lubricant : Lubricant
            Of the film that `summary` tells of.
        store : Path, optional
            A folder to keep the run in after each block: one that was stopped goes on from there.

        Raises
        ------
        ValueError
            Numbers of cycles that are not allowed; a store that keeps another run.
        """
        counts = check_cycles(cycles, report_at)
        run = Run(use=self)
        reports = looks(run, counts, listen, None if store is None else checkpoint(self, store))
        return History(use=self, reports=reports, error=self.error(run.missed), steps=run.steps, lubricant=lubricant)

    def error(self, blocks: float) -> Error:
        """What the volume may be off by: blocks as they estimate it, rings and instants by halving them once."""
        finer = replace(self, ring_width=self.ring_width / 2, cycle=self.cycle.finer())
        mine, other = self.first, finer.first
        rates = (
            abs(getattr(mine, name) / getattr(other, name) - 1) if getattr(other, name) else 0.0 for name in _RATES
        )
        volume, depth = rates
        return Error(blocks=blocks, volume=blocks + volume, depth=blocks + depth)


_RATES = ("volume", "depth")
