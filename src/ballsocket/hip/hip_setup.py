"""Set-up of a wear simulation: joint, cup, cycle and laws, with the contacts and the wear of single cycles."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property, partial
from math import inf, pi, radians
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers, is_plain_number
from ..core.checks import require, shown
from ..core.deprecation import RenamedAttribute, renamed_arguments
from ..core.validity import check_domain
from ..elasticity.finite_elements.shapes import socket_shape
from ..elasticity.off_axis.grid import Grid, even_grid, graded_grid
from ..elasticity.off_axis.model import Sphere
from ..elasticity.off_axis.surfaces import ClosedShell, RealCup, Springs
from ..models.foundation import RadialFoundation
from ..problem import Joint
from ..problem.cup import Cup
from .contact_checks import ContactCheck, check_contact, half_angles
from .creep_law import CreepLaw, confinement_note
from .cup_frame import CupFrame
from .cycle import Cycle
from .elastic_foundation import elastic_foundation
from .film import Film, Lubricant, film
from .kinematics import SurfaceSliding
from .mix import Mix
from .rim import RimDistance, rim_distance
from .socket_foundation import CycleEquilibrium, SocketFoundation, spring_foundation
from .wear_law import AnyWearLaw, CycleExposure

MIN_RING_WIDTH = radians(0.5)
"""Smallest ring width in rad."""

_MAX_RING_WIDTH = radians(10.0)
"""Largest ring width in rad."""

_DIAMETERS = 1.0, 1000.0
"""Allowed diameters of head and bore in mm."""

_CYCLES_PER_MILLION = 1e6
"""Cycles to which wear rates refer."""


@dataclass(frozen=True, kw_only=True)
class FirstCycleResult:
    """Results of the first cycle, on an unworn bore.

    Attributes
    ----------
    slide : float
        Sliding distance of the ball past the line of the load, in mm.
    work : float
        ∫∫ p v dA dt in N m.
    cross_shear : float
        Mean cross-shear over the socket, weighted by p v.
    volume, depth : float
        Worn volume in mm³ and largest worn depth in mm of a million such cycles.
    max_pressure, max_force : float
        Largest pressure in MPa and largest force in N.
    """

    slide: float
    work: float
    cross_shear: float
    volume: float
    depth: float
    max_pressure: float
    max_force: float


@dataclass(frozen=True, kw_only=True, eq=False)
class HipSetup(CupFrame):
    """Set-up of a wear simulation, with the contacts of single cycles; the fields are those of `HipSimulation`."""

    wear: AnyWearLaw
    surface: Springs | ClosedShell | RealCup = Springs()  # noqa: RUF009 (frozen)
    ring_width: float = radians(3.0)
    ball_wear: AnyWearLaw | None = None
    creep: CreepLaw | None = None
    seconds_per_cycle: float | None = None
    tolerance: float = 4e-3
    bed = RenamedAttribute("foundation")
    rest = RenamedAttribute("solve_equilibrium")
    passed = RenamedAttribute("exposure")

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
        if not isinstance(self.surface, Springs):
            check_domain(Sphere(cup=self._unoriented_cup).domain, self.joint, "full elasticity")
        if self.creep is not None:
            thickness = float(self.joint.liner_thickness)
            require("liner_thickness", thickness, thickness < inf, "creep needs a liner of finite thickness")
        if self.ball_wear is not None and (self.creep is not None or not isinstance(self.surface, Springs)):
            raise ValueError("ball_wear needs surface=Springs() and no creep law")
        require("seconds_per_cycle", self.seconds, 0 < self.seconds < inf, "a time (s) is positive and finite")
        self._check_dislocation()

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields for other processes, without cached results."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def seconds(self) -> float:
        """Time in s that a cycle stands for in the creep of the liner."""
        return self.cycle.duration if self.seconds_per_cycle is None else self.seconds_per_cycle

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes on the cycle, the cup and the laws."""
        law_notes = (*self.wear.notes, *(self.ball_wear.notes if self.ball_wear else ()))
        return (*self.cycle.notes, *self._frame_notes, *law_notes, *self._creep_notes)

    @property
    def _creep_notes(self) -> tuple[str, ...]:
        """Notes on the creep law and its confinement."""
        if self.creep is None:
            return ()
        confinement = confinement_note(self.creep, float(self.joint.liner.poisson))
        return (*self.creep.notes, *([confinement] if confinement else []))

    @cached_property
    def grid(self) -> Grid:
        """Grid of the bore."""
        reach = socket_shape(self.joint, self.cup).reach
        return (
            graded_grid(reach, self.ring_width)
            if isinstance(self.surface, Springs)
            else even_grid(reach, self.ring_width)
        )

    @cached_property
    def foundation(self) -> SocketFoundation:
        """Foundation of the socket: radial springs or full elasticity."""
        joint = self.joint
        if not isinstance(self.surface, Springs):
            return elastic_foundation(self.surface, joint, self._unoriented_cup, self.ring_width)
        return spring_foundation(
            self.grid,
            modulus=float(self.surface.modulus(joint)),
            clearance=float(joint.clearance),
            socket_radius=float(joint.socket_radius),
        )

    @cached_property
    def ball_grid(self) -> Grid:
        """Grid of the ball: rings about the axis to the front, so that the cells in contact have similar widths."""
        return even_grid(pi, self.ring_width)

    @cached_property
    def ball_areas(self) -> Numbers:
        """Areas of the ball's cells in mm²: (cells,)."""
        return numpy.repeat(self.ball_grid.areas[:, 0], self.ball_grid.meridians) * float(self.joint.ball_radius) ** 2

    @property
    def _unoriented_cup(self) -> Cup:
        """Cup without its orientation."""
        return Cup(arc_of_cover=self.cup.arc_of_cover, chamfer=self.cup.chamfer, interface=self.cup.interface)

    @cached_property
    def sliding(self) -> SurfaceSliding:
        """Sliding of the ball over the cells of the socket in the loaded instants."""
        return SurfaceSliding(
            radius=float(self.joint.ball_radius),
            rotation_increments=self.rotation_increments,
            directions=self.foundation.directions,
        )

    @renamed_arguments(rest="equilibrium")
    def edge(self, equilibrium: CycleEquilibrium, depth: Numbers | float = 0.0) -> RimDistance:
        """Find the edge of each contact nearest to the end of the bore, on a bore worn by a depth in mm."""
        field = self.foundation.edge_field(equilibrium, self._depth_field(depth))
        return rim_distance(
            self.grid, self.foundation.socket_radius, field, equilibrium.pressure, self.foundation.edge_inset
        )

    @renamed_arguments(rest="equilibrium")
    def edge_distance(self, equilibrium: CycleEquilibrium, depth: Numbers | float = 0.0) -> Numbers:
        """Compute the shortest arc in mm from the edge of each contact to the end of the bore: (loaded,).

        It is 0 where the contact reaches the end of the bore: edge loading.
        """
        return self.edge(equilibrium, depth).distance

    def solve_equilibrium(
        self, depth: Numbers | float = 0.0, start: CycleEquilibrium | None = None
    ) -> CycleEquilibrium:
        """Solve the contacts of a cycle on a bore worn by a depth in mm: (cells,).

        Parameters
        ----------
        depth : float or array
        start : CycleEquilibrium, optional
            Initial guess.
        """
        return self.foundation.solve_equilibrium(self.loads, self._depth_field(depth), start, self.lateral_stiffness)

    def _depth_field(self, depth: Numbers | float) -> Numbers:
        """Return a depth as an array: (cells,), or (loaded, cells) for a depth that differs between instants."""
        field = numpy.asarray(depth)
        return field if field.ndim == 2 else numpy.broadcast_to(field, self.foundation.areas.shape)

    @cached_property
    def contact_model(self) -> Model:
        """Contact model with the same foundation: radial springs, or full elasticity."""
        if isinstance(self.surface, Springs):
            return RadialFoundation(modulus=self.surface.modulus)
        return Sphere(cup=self._unoriented_cup, surface=self.surface, ring_width=self.ring_width)

    @cached_property
    def _activities(self) -> tuple[tuple[str, Numbers], ...]:
        """Name of each activity with contact, and its loads as indices into the loaded instants."""
        indices = {
            number: numpy.flatnonzero((self.loaded >= part.start) & (self.loaded < part.stop))
            for number, (_, part) in enumerate(self.cycle.activity_slices)
        }
        return tuple((self.cycle.activity_slices[number][0], loads) for number, loads in indices.items() if len(loads))

    @renamed_arguments(rest="equilibrium")
    def worst_contacts(self, equilibrium: CycleEquilibrium, depth: Numbers | float = 0.0) -> Numbers:
        """Compute the contact with the largest pressure in each activity with contact: (activities, `COLUMNS`)."""
        largest = equilibrium.pressure.max(axis=1, initial=0.0)
        rows = numpy.array([loads[largest[loads].argmax()] for _, loads in self._activities], dtype=int)
        worn = self._depth_field(depth)
        worn = worn[rows] if worn.ndim == 2 else worn
        overlap = equilibrium.displacement[rows] @ self.foundation.normals - self.foundation.clearance - worn
        chosen = CycleEquilibrium(
            displacement=equilibrium.displacement[rows],
            pressure=equilibrium.pressure[rows],
            converged=equilibrium.converged,
        )
        return numpy.stack(
            [
                rows,
                numpy.linalg.norm(self.loads[rows], axis=1),
                numpy.maximum(overlap.max(axis=1, initial=0.0), 0.0),
                half_angles(self.grid, self.reach, self.foundation.edge_field(chosen, worn)),
                largest[rows],
            ],
            axis=1,
        )

    def contact_checks(self, worst: Numbers) -> tuple[ContactCheck, ...]:
        """Check the contact model for each activity with contact, from a table of `worst_contacts`."""
        return tuple(
            check_contact(
                self.contact_model, self.joint, row, activity, self.cycle.describe_step(int(self.loaded[int(row[0])]))
            )
            for (activity, _), row in zip(self._activities, worst, strict=True)
        )

    @cached_property
    def unworn_worst(self) -> Numbers:
        """Worst contacts of the first cycle; see `worst_contacts`."""
        return self.worst_contacts(self.unworn)

    @cached_property
    def unworn_checks(self) -> tuple[ContactCheck, ...]:
        """Checks of the contact model in the first cycle."""
        return self.contact_checks(self.unworn_worst)

    @renamed_arguments(rest="equilibrium")
    def exposure(self, equilibrium: CycleEquilibrium, depth: Numbers | float = 0.0) -> CycleExposure:
        """Collect pressures and slides of the socket's points for these contacts, on a bore worn by a depth in mm."""
        contact_shares = partial(self.foundation.contact_shares, equilibrium, self._depth_field(depth))
        return CycleExposure(pressure=equilibrium.pressure, sliding=self.sliding, contact_shares=contact_shares)

    @cached_property
    def unworn(self) -> CycleEquilibrium:
        """Contacts of the first cycle, on an unworn bore."""
        return self.solve_equilibrium()

    def film(self, lubricant: Lubricant, depth: Numbers | float = 0.0) -> Film:
        """Compute film and friction of a cycle on a bore worn by a depth in mm: (cells,)."""
        return film(self, self.foundation, self.sliding, self.solve_equilibrium(depth), lubricant)

    @cached_property
    def first(self) -> FirstCycleResult:
        """Results of the first cycle on an unworn bore, with wear per million cycles."""
        cycle = self.exposure(self.unworn)
        depth, work = self.wear.depth(cycle), cycle.work * self.foundation.areas
        total_work = float(work.sum())
        return FirstCycleResult(
            slide=self.slide,
            work=total_work / 1e3,
            cross_shear=float(cycle.cross_shear @ work) / total_work if total_work > 0 else 0.0,
            volume=_CYCLES_PER_MILLION * float(depth @ self.foundation.areas),
            depth=_CYCLES_PER_MILLION * float(depth.max(initial=0.0)),
            max_pressure=float(cycle.pressure.max(initial=0.0)),
            max_force=self.cycle.largest_force,
        )

    @property
    def crossing_angle(self) -> float:
        """Mean angle in rad between sliding and its principal direction in the first cycle, weighted by p v."""
        cycle = self.exposure(self.unworn)
        worn = numpy.flatnonzero(cycle.work > 0)
        weight = (cycle.work * self.foundation.areas)[worn]
        angles = self.sliding.select_points(worn).crossing_angle(cycle.pressure[:, worn])
        return float(angles @ weight / weight.sum()) if len(worn) else 0.0

    @property
    def largest_speed(self) -> float:
        """Largest speed of sliding in contact in the first cycle, in mm/s."""
        distances = numpy.where(self.unworn.pressure > 0, self.sliding.distances, 0.0)
        return float((distances / self.cycle.seconds[self.loaded][:, None]).max(initial=0.0))
