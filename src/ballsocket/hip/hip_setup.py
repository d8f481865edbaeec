"""Joint, cup, cycle and laws of a hip, with the contacts and the wear of a single cycle."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property, partial
from math import inf, pi, radians
from typing import Any

import numpy

from ..contact import Model
from ..contact.model import BondedLiner
from ..contact.strength import rim_errors
from ..core.arrays import Numbers, is_plain_number
from ..core.checks import require, shown
from ..core.display import OneLine, html_list
from ..core.records import cached_array
from ..core.validity import check_domain
from ..elasticity.finite_elements.mesh import socket_shape
from ..elasticity.off_axis.grid import Grid, even_grid, graded_grid
from ..elasticity.off_axis.model import MAX_RING_WIDTH, Sphere
from ..elasticity.off_axis.surfaces import ClosedShell, RealCup, Springs
from ..lubrication import Lubricant
from ..models.foundation import RadialFoundation
from ..problem import Joint
from ..problem.cup import Cup
from ..problem.gaps import LinearGap
from .contact_checks import UNWORN_ERRORS, ContactCheck, check_contact, half_angles
from .creep_law import CreepLaw, confinement_note
from .cup_frame import CupFrame
from .cycle import Cycle
from .film import METHODS as FILM_METHODS
from .film import Film, film
from .film_limit import CYCLES as FILM_CYCLES
from .film_limit import FilmLimit
from .kinematics import SurfaceSliding
from .mix import Mix
from .rim import RimDistance, rim_distance
from .socket_foundation import CycleEquilibrium, SocketFoundation, spring_foundation
from .wear_law import AnyWearLaw, CycleExposure, FirstCycleResult

MIN_RING_WIDTH = radians(0.5)  # smallest ring width in rad

_MAX_RING_WIDTH = radians(10.0)  # largest ring width in rad
_DIAMETERS = 1.0, 1000.0  # allowed diameters of head and bore in mm
_CYCLES_PER_MILLION = 1e6  # cycles to which wear rates refer


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class HipSetup(OneLine):
    """Joint, cup, cycle and laws of a hip, with the contacts and the wear of a single cycle; see `HipSimulation`."""

    joint: Joint
    cycle: Cycle | Mix
    wear: AnyWearLaw
    cup: Cup = Cup()  # noqa: RUF009 (frozen)
    surface: Springs | ClosedShell | RealCup = Springs()  # noqa: RUF009 (frozen)
    ring_width: float = radians(3.0)
    ball_wear: AnyWearLaw | None = None
    creep: CreepLaw | None = None
    seconds_per_cycle: float | None = None
    tolerance: float = 4e-3
    film_limit: FilmLimit | None = None
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name, kind in (("joint", Joint), ("cycle", Cycle | Mix), ("cup", Cup)):
            if not isinstance(getattr(self, name), kind):
                raise TypeError(f"{name} must be a {name.capitalize()}, got {shown(getattr(self, name))}")
        if not all(map(is_plain_number, self.joint.numbers())):
            raise ValueError("joint must have single numbers, got arrays; simulate each joint on its own")
        for name, radius in (("head_diameter", self.joint.ball_radius), ("bore diameter", self.joint.socket_radius)):
            diameter = 2.0 * float(radius)
            low, high = _DIAMETERS
            require(name, diameter, low <= diameter <= high, "a diameter is 1 mm to 1000 mm")
        require(
            "ring_width", self.ring_width, MIN_RING_WIDTH <= self.ring_width <= _MAX_RING_WIDTH, "0.5 to 10 degrees"
        )
        require("tolerance", self.tolerance, 1e-9 <= self.tolerance <= 0.1, "1e-9 to 0.1")
        if not self.uses_springs:
            check_domain(Sphere(cup=self._unoriented_cup).domain, self.joint, "full elasticity")
        if self.creep is not None:
            thickness = float(self.joint.liner_thickness)
            require("liner_thickness", thickness, thickness < inf, "creep needs a liner of finite thickness")
        if self.ball_wear is not None and (self.creep is not None or not self.uses_springs):
            raise ValueError("ball_wear needs surface=Springs() and no creep law")
        if self.film_limit is not None:
            if not isinstance(self.film_limit, FilmLimit):
                raise TypeError(f"film_limit must be a FilmLimit, got {shown(self.film_limit)}")
            clearance = float(self.joint.clearance)
            require("clearance", clearance, clearance > 0, "film_limit needs a film, and a film a positive clearance")
        require("seconds_per_cycle", self.seconds, 0 < self.seconds < inf, "a time (s) is positive and finite")
        _ = self.frame  # checks the loads

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields for pickling, without cached results."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def frame(self) -> CupFrame:
        """Loads and rotations of the cycle, transformed to the frame of the cup."""
        return CupFrame(joint=self.joint, cycle=self.cycle, cup=self.cup)

    @property
    def uses_springs(self) -> bool:
        """True if the foundation is independent radial springs, False if it is full elasticity."""
        return isinstance(self.surface, Springs)

    @property
    def seconds(self) -> float:
        """Time in s that each cycle represents in the creep of the liner."""
        return self.cycle.duration if self.seconds_per_cycle is None else self.seconds_per_cycle

    def __str__(self) -> str:
        parts = (self.wear, self.ball_wear, self.creep, self.surface)
        laws = ", ".join(type(part).__name__ for part in parts if part is not None)
        return f"of {self.joint.name or self.joint.dimensions} under {self.cycle.name}: {laws}"

    def _repr_html_(self) -> str:
        named = {"joint": self.joint, "cup": self.cup, "cycle": self.cycle.name, "wear": self.wear}
        named |= {"wear of the ball": self.ball_wear, "creep": self.creep, "foundation": self.surface}
        return html_list(type(self).__name__, [(name, str(part)) for name, part in named.items() if part is not None])

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the cycle, the cup and the laws, for reports."""
        notes = [*self.remarks, self.cycle.remark, *self.cycle.notes, *self.frame.notes, *self.wear.notes]
        if self.ball_wear is not None:
            notes += self.ball_wear.notes
        if self.film_limit is not None:
            notes.append(self.film_limit.note(self.excluded_work_share))
        if self.creep is not None:
            notes += [*self.creep.notes, confinement_note(self.creep, float(self.joint.liner.poisson))]
        return tuple(filter(None, notes))

    @cached_property
    def grid(self) -> Grid:
        """Grid of cells on the bore of the socket."""
        reach = socket_shape(self.joint, self.cup).reach
        return (graded_grid if self.uses_springs else even_grid)(reach, self.ring_width)

    @cached_property
    def foundation(self) -> SocketFoundation:
        """Foundation of the socket: independent radial springs, or coupled elastic cells."""
        joint = self.joint
        if not isinstance(self.surface, Springs):
            from .elastic_foundation import elastic_foundation  # slow to import

            return elastic_foundation(self.surface, joint, self._unoriented_cup, self.ring_width)
        return spring_foundation(
            self.grid,
            modulus=float(self.surface.modulus(joint)),
            clearance=float(joint.clearance),
            socket_radius=float(joint.socket_radius),
        )

    @cached_property
    def ball_grid(self) -> Grid:
        """Grid of cells on the ball, with rings about the axis to the front: cells in contact have similar widths."""
        return even_grid(pi, self.ring_width)

    @cached_array
    def ball_areas(self) -> Numbers:
        """Areas of the ball's cells in mm²: (cells,)."""
        return numpy.repeat(self.ball_grid.areas[:, 0], self.ball_grid.meridians) * float(self.joint.ball_radius) ** 2

    @property
    def _unoriented_cup(self) -> Cup:
        return Cup(arc_of_cover=self.cup.arc_of_cover, chamfer=self.cup.chamfer, interface=self.cup.interface)

    @cached_property
    def sliding(self) -> SurfaceSliding:
        """Sliding of the ball over the cells of the socket at the loaded instants."""
        return SurfaceSliding(
            radius=float(self.joint.ball_radius),
            rotation_increments=self.frame.rotation_increments,
            directions=self.foundation.directions,
        )

    def edge(self, equilibrium: CycleEquilibrium, depth: Numbers | float = 0.0) -> RimDistance:
        """Compute the distance of each contact from the rim (`RimDistance`), for a worn depth (cells,) in mm."""
        field = self.foundation.edge_field(equilibrium, self._depth_field(depth))
        return rim_distance(
            self.grid, self.foundation.socket_radius, field, equilibrium.pressure, self.foundation.edge_inset
        )

    def edge_distance(self, equilibrium: CycleEquilibrium, depth: Numbers | float = 0.0) -> Numbers:
        """Compute the shortest arc in mm from each contact edge to the end of the bore: (loaded,).

        It is 0 where the contact reaches the end of the bore: edge loading.
        """
        return self.edge(equilibrium, depth).distance

    def solve_equilibrium(
        self, depth: Numbers | float = 0.0, start: CycleEquilibrium | None = None
    ) -> CycleEquilibrium:
        """Solve the contacts of a cycle on a worn bore, with a worn depth (cells,) in mm.

        Parameters
        ----------
        depth : float or array
        start : CycleEquilibrium, optional
            Initial guess.
        """
        frame = self.frame
        return self.foundation.solve_equilibrium(frame.loads, self._depth_field(depth), start, frame.lateral_stiffness)

    def _depth_field(self, depth: Numbers | float) -> Numbers:
        """Convert a worn depth to an array in mm: (cells,), or (loaded, cells) if instants differ."""
        field = numpy.asarray(depth)
        return field if field.ndim == 2 else numpy.broadcast_to(field, self.foundation.areas.shape)

    @cached_property
    def contact_model(self) -> Model:
        """Contact model with the same foundation as the simulation: springs, or full elasticity, with a linear gap."""
        if isinstance(self.surface, Springs):
            return BondedLiner(model=RadialFoundation(modulus=self.surface.modulus), cup=self.cup)
        ring_width = min(self.ring_width, MAX_RING_WIDTH)
        return Sphere(cup=self._unoriented_cup, surface=self.surface, ring_width=ring_width, gap=LinearGap)

    def worst_contacts(self, equilibrium: CycleEquilibrium, depth: Numbers | float = 0.0) -> Numbers:
        """Tabulate the contact of largest pressure of each activity: (activities, columns `COLUMNS`)."""
        largest = equilibrium.pressure.max(axis=1, initial=0.0)
        rows = numpy.array([loads[largest[loads].argmax()] for _, loads in self.frame.activities], dtype=int)
        worn = self._depth_field(depth)
        worn = worn[rows] if worn.ndim == 2 else worn
        overlap = equilibrium.displacement[rows] @ self.foundation.normals - self.foundation.clearance - worn
        worst_equilibrium = CycleEquilibrium(
            displacement=equilibrium.displacement[rows],
            pressure=equilibrium.pressure[rows],
            converged=equilibrium.converged,
        )
        return numpy.stack(
            [
                rows,
                numpy.linalg.norm(self.frame.loads[rows], axis=1),
                numpy.maximum(overlap.max(axis=1, initial=0.0), 0.0),
                half_angles(self.grid, self.frame.reach, self.foundation.edge_field(worst_equilibrium, worn)),
                largest[rows],
            ],
            axis=1,
        )

    def contact_checks(
        self, worst: Numbers, edge: RimDistance, stress_errors: tuple[float, float] = UNWORN_ERRORS
    ) -> tuple[ContactCheck, ...]:
        """Check validity and strength of each row of a table of worst contacts, by their distance from the rim.

        The stress of edge loading has no upper bound. A bore worn to its rim has the largest pressure elsewhere.
        """
        frame = self.frame
        steps = worst[:, 0].astype(int)
        distance = numpy.where(edge.is_edge_loaded, 0.0, numpy.maximum(edge.distance, numpy.finfo(float).tiny))
        errors = numpy.maximum(numpy.transpose(rim_errors(self.joint, distance[steps])), stress_errors)
        instants = [self.cycle.describe_step(step) for step in frame.loaded[steps]]
        return tuple(
            check_contact(self.contact_model, self.joint, row, (low, high), activity, instant)
            for (activity, _), row, (low, high), instant in zip(frame.activities, worst, errors, instants, strict=True)
        )

    @cached_array
    def unworn_worst_contacts(self) -> Numbers:
        """Table of the contact of largest pressure of each activity in the first cycle."""
        return self.worst_contacts(self.unworn)

    @cached_property
    def unworn_checks(self) -> tuple[ContactCheck, ...]:
        """Validity and strength of the worst contact of each activity in the first cycle."""
        return self.contact_checks(self.unworn_worst_contacts, self.edge(self.unworn))

    def exposure(self, equilibrium: CycleEquilibrium, depth: Numbers | float = 0.0) -> CycleExposure:
        """Collect pressure and sliding of the socket's cells over a cycle, as input of a wear law."""
        contact_shares = partial(self.foundation.contact_shares, equilibrium, self._depth_field(depth))
        return CycleExposure(pressure=equilibrium.pressure, sliding=self.sliding, contact_shares=contact_shares)

    def wearing_exposure(self, exposure: CycleExposure, cells: Numbers | None = None) -> CycleExposure:
        """Restrict the exposure of some cells (all by default) to instants and cells that wear, by the film ratio."""
        if self.film_limit is None:
            return exposure
        return exposure.select_contact(self._wearing_cells if cells is None else self._wearing_cells[:, cells])

    @cached_array
    def _wearing_cells(self) -> Numbers:
        """Mask (loaded, cells) of the cells that wear, by the film on the unworn bore."""
        limit = self.film_limit
        thickness = None if limit is None else self.film(limit.lubricant, cycles=limit.cycles).thickness
        if limit is None or thickness is None:
            return numpy.ones(self.unworn.pressure.shape, dtype=bool)
        return limit.wearing_cells(thickness, self.foundation.directions)

    @property
    def excluded_work_share(self) -> float:
        """Share of the sliding work of the first cycle without wear, by the limit of the film ratio."""
        exposure, areas = self.exposure(self.unworn), self.foundation.areas
        total = float(exposure.work @ areas)
        return 1.0 - float(self.wearing_exposure(exposure).work @ areas) / total if total > 0 else 0.0

    @cached_property
    def unworn(self) -> CycleEquilibrium:
        """Contacts at all loaded instants of the first cycle, on an unworn bore."""
        return self.solve_equilibrium()

    def film(
        self,
        lubricant: Lubricant = Lubricant(),  # noqa: B008 (frozen)
        depth: Numbers | float = 0.0,
        method: str = FILM_METHODS[0],
        cycles: int = FILM_CYCLES,
    ) -> Film:
        """Compute lubricant film and friction of a cycle.

        Parameters
        ----------
        lubricant : Lubricant
        depth : array (cells,)
            Worn depth of the bore in mm.
        method : str
            "wave" (default) carries the film from instant to instant; its `valid` and `note` state whether the film
            settles. "hamrock-dowson" is a formula for bodies of low conformity.
        cycles : int
            Number of uninterrupted cycles since the bore was flooded, for the wave; 300 by default.

        Raises
        ------
        ValueError
            An unknown method; a number of cycles below 1.
        """
        is_unworn, key = isinstance(depth, float) and depth == 0.0, (lubricant, method, cycles)
        if is_unworn and key in self._unworn_films:
            return self._unworn_films[key]
        frame, foundation, worn = self.frame, self.foundation, self._depth_field(depth)
        equilibrium = self.unworn if is_unworn else self.solve_equilibrium(depth)
        result = film(frame, foundation, self.sliding, equilibrium, worn, lubricant, self.grid, method, cycles)
        if is_unworn:
            self._unworn_films[key] = result
        return result

    @cached_property
    def _unworn_films(self) -> dict[tuple[Lubricant, str, int], Film]:
        return {}

    @cached_property
    def first(self) -> FirstCycleResult:
        """Results of the first cycle on an unworn bore; wear is per million cycles."""
        cycle = self.exposure(self.unworn)
        depth, work = self.wear.depth(self.wearing_exposure(cycle)), cycle.work * self.foundation.areas
        total_work = float(work.sum())
        return FirstCycleResult(
            slide=self.frame.slide,
            work=total_work / 1e3,
            cross_shear=float(cycle.cross_shear @ work) / total_work if total_work > 0 else 0.0,
            volume=_CYCLES_PER_MILLION * float(depth @ self.foundation.areas),
            depth=_CYCLES_PER_MILLION * float(depth.max(initial=0.0)),
            max_pressure=float(cycle.pressure.max(initial=0.0)),
            max_force=self.cycle.largest_force,
        )

    @property
    def crossing_angle(self) -> float:
        """Mean angle in rad between sliding and its principal direction in the first cycle."""
        cycle = self.exposure(self.unworn)
        worn = numpy.flatnonzero(cycle.work > 0)
        weight = (cycle.work * self.foundation.areas)[worn]
        angles = self.sliding.select_points(worn).crossing_angle(cycle.pressure[:, worn])
        return float(angles @ weight / weight.sum()) if len(worn) else 0.0

    @property
    def largest_speed(self) -> float:
        """Largest sliding speed in mm/s at points in contact, in the first cycle."""
        distances = numpy.where(self.unworn.pressure > 0, self.sliding.distances, 0.0)
        return float((distances / self.cycle.seconds[self.frame.loaded][:, None]).max(initial=0.0))
