"""The set-up of a hip in use: a joint, how its cup stands, what it goes through, and what its first cycle is."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property, partial
from math import inf, radians
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers, is_plain
from ..core.checks import require, shown
from ..core.validity import check_domain
from ..elasticity.finite_elements.shapes import socket_shape
from ..elasticity.off_axis.grid import Grid, even_grid, grid
from ..elasticity.off_axis.model import Sphere
from ..elasticity.off_axis.surfaces import ClosedShell, RealCup, Springs
from ..models.foundation import RadialFoundation
from ..problem import Joint
from ..problem.cup import Cup
from .contact_checks import ContactCheck, check_contact, half_angles
from .creep import Ladder, creep_note
from .cycle import Cycle
from .elastic_bed import elastic_bed
from .film import Film, Lubricant, film
from .first import First, first_of
from .kinematics import SurfaceSliding
from .laws import Law, Pass
from .mix import Mix
from .placing import Placed
from .rim import RimDistance, rim_distance
from .spots import ball_grid
from .springs import CycleBed, Rest, spring_bed

FINEST = radians(0.5)
"""The narrowest rings."""

_DIAMETERS = 1.0, 1000.0  # mm, of the head and of the bore


@dataclass(frozen=True, kw_only=True, eq=False)
class SetUp(Placed):
    """A hip before it is used, with what can be said of any cycle of it; the fields are told at `InUse`."""

    wear: Law
    surface: Springs | ClosedShell | RealCup = Springs()  # noqa: RUF009 (frozen)
    ring_width: float = radians(3.0)
    ball_wear: Law | None = None
    creep: Ladder | None = None
    seconds_per_cycle: float | None = None
    tolerance: float = 4e-3

    def __post_init__(self) -> None:
        for name, kind in (("joint", Joint), ("cycle", Cycle | Mix), ("cup", Cup)):
            if not isinstance(getattr(self, name), kind):
                raise TypeError(f"{name} must be a {name.capitalize()}, got {shown(getattr(self, name))}")
        if not all(map(is_plain, self.joint.numbers())):
            raise ValueError("a hip in use is one joint, and this one has arrays of numbers")
        for name, radius in (("head_diameter", self.joint.ball_radius), ("bore diameter", self.joint.socket_radius)):
            diameter = 2.0 * float(radius)
            low, high = _DIAMETERS
            require(name, diameter, low <= diameter <= high, "a hip in use has a diameter of 1 mm to 1000 mm")
        require("ring_width", self.ring_width, FINEST <= self.ring_width <= radians(10.0), "0.5 to 10 degrees")
        require("tolerance", self.tolerance, 1e-9 <= self.tolerance <= 0.1, "1e-9 to 0.1")
        if not isinstance(self.surface, Springs):
            check_domain(Sphere(cup=self._around).domain, self.joint, "full elasticity")
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
        worn = (*self.wear.notes, *(self.ball_wear.notes if self.ball_wear else ()))
        return (*self.cycle.notes, *self._placing_notes, *worn, *self._creep_notes)

    @property
    def _creep_notes(self) -> tuple[str, ...]:
        if self.creep is None:
            return ()
        confinement = creep_note(self.creep, float(self.joint.liner.poisson))
        return (*self.creep.notes, *([confinement] if confinement else []))

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
    def sliding(self) -> SurfaceSliding:
        return SurfaceSliding(
            radius=float(self.joint.ball_radius),
            rotation_increments=self.rotation_increments,
            directions=self.bed.directions,
        )

    def edge(self, rest: Rest, depth: Numbers | float = 0.0) -> RimDistance:
        """How near the edge of each contact comes to the end of the bore, and where."""
        field = self.bed.edge_field(rest, self._everywhere(depth))
        return rim_distance(self.grid, self.bed.socket_radius, field, rest.pressure, self.bed.inset)

    def edge_distance(self, rest: Rest, depth: Numbers | float = 0.0) -> Numbers:
        """The arc in mm from the edge of each contact to the end of the bore where it is nearest: (loaded,).

        0 where the contact reaches it: edge loading.
        """
        return self.edge(rest, depth).distance

    def rest(self, depth: Numbers | float = 0.0, start: Rest | None = None) -> Rest:
        """The contacts of a cycle on a bore that is worn by a depth in mm (cells,)."""
        return self.bed.rest(self.loads, self._everywhere(depth), start, self.tether)

    def _everywhere(self, depth: Numbers | float) -> Numbers:
        """A depth of each cell, (cells,), or of each in each instant, (loaded, cells)."""
        field = numpy.asarray(depth)
        return field if field.ndim == 2 else numpy.broadcast_to(field, self.bed.areas.shape)

    @cached_property
    def contact_model(self) -> Model:
        """Contact model that matches the run: radial springs, or the sphere in its cup."""
        if isinstance(self.surface, Springs):
            return RadialFoundation(modulus=self.surface.modulus)
        return Sphere(cup=self._around, surface=self.surface, ring_width=self.ring_width)

    @cached_property
    def _activities(self) -> tuple[tuple[str, Numbers], ...]:
        """Name of each activity with contact, and its loads as indices into the loaded instants."""
        indices = {
            number: numpy.flatnonzero((self.loaded >= part.start) & (self.loaded < part.stop))
            for number, (_, part) in enumerate(self.cycle.activity_slices)
        }
        return tuple((self.cycle.activity_slices[number][0], each) for number, each in indices.items() if len(each))

    def worst_contacts(self, rest: Rest, depth: Numbers | float = 0.0) -> Numbers:
        """Compute the contact with the largest pressure in each activity with contact: (activities, `COLUMNS`)."""
        largest = rest.pressure.max(axis=1, initial=0.0)
        rows = numpy.array([loads[largest[loads].argmax()] for _, loads in self._activities], dtype=int)
        worn = self._everywhere(depth)
        worn = worn[rows] if worn.ndim == 2 else worn
        overlap = rest.displacement[rows] @ self.bed.normals - self.bed.clearance - worn
        chosen = Rest(displacement=rest.displacement[rows], pressure=rest.pressure[rows], settled=rest.settled)
        return numpy.stack(
            [
                rows,
                numpy.linalg.norm(self.loads[rows], axis=1),
                numpy.maximum(overlap.max(axis=1, initial=0.0), 0.0),
                half_angles(self.grid, self.reach, self.bed.edge_field(chosen, worn)),
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

    def passed(self, rest: Rest, depth: Numbers | float = 0.0) -> Pass:
        """Collect pressures and slides of the socket's points under these contacts, on a bore worn by a depth in mm."""
        shares = partial(self.bed.contact_shares, rest, self._everywhere(depth))
        return Pass(pressure=rest.pressure, sliding=self.sliding, shares=shares)

    @cached_property
    def unworn(self) -> Rest:
        """The contacts of the first cycle."""
        return self.rest()

    def film(self, lubricant: Lubricant, depth: Numbers | float = 0.0) -> Film:
        """The film and the friction of a cycle on a bore that is worn by a depth in mm (cells,)."""
        return film(self, self.bed, self.sliding, self.rest(depth), lubricant)

    @cached_property
    def first(self) -> First:
        """The first cycle, on a bore that is not worn, a million times over."""
        done = self.passed(self.unworn)
        return first_of(self.wear, done, self.bed.areas, slide=self.slide, max_force=self.cycle.largest_force)

    @property
    def crossing_angle(self) -> float:
        """Between sliding and its principal direction in the first cycle, in rad: its mean, weighted by p v."""
        done = self.passed(self.unworn)
        touched = numpy.flatnonzero(done.work > 0)
        weight = (done.work * self.bed.areas)[touched]
        found = self.sliding.select_points(touched).crossing_angle(done.pressure[:, touched])
        return float(found @ weight / weight.sum()) if len(touched) else 0.0

    @property
    def largest_speed(self) -> float:
        """The largest speed of sliding in contact in the first cycle, in mm/s."""
        within = numpy.where(self.unworn.pressure > 0, self.sliding.distances, 0.0)
        return float((within / self.cycle.seconds[self.loaded][:, None]).max(initial=0.0))
