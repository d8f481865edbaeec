"""Thin film as a kinematic wave on the dry pressure: a conservation law with Godunov's flux.

For thin films the pressure is that of the dry contact, and the film obeys

    ∂h/∂t + ∇·(½ U h - h³ ∇p/(12 η)) = 0

on the dry contact, with lubricant in plenty around it. On springs the flux has a largest value over h, and the inlet
draws that value, as a weir does. Godunov's flux finds it without a condition at the inlet. In elastic bodies the slope
of the pressure is infinite at the edge: the inlet film is prescribed there, and the pressure acts further in.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy

from ..core.arrays import Numbers
from .dry_contact import DryContact

_COURANT = 0.5
"""Largest part of a cell that the film may cross in one step."""

_EDGE_LENGTHS = 3.0
"""Distance from an elastic edge, in inlet lengths, within which the pressure of the film is not the dry one."""

_FLOODED = 4.0
"""Film around the contact, relative to the inlet film; the flow into the contact does not depend on it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmWave:
    """Flow of a thin film over a dry contact.

    Attributes
    ----------
    contact : DryContact
    viscosity : float
        Viscosity in MPa s.
    spin : array (3,)
        Rotation rate of the ball in rad/s.
    flood : float
        Film around the contact in mm, and largest film within it; by default four times the inlet film.
    """

    contact: DryContact
    viscosity: float
    spin: Numbers
    flood: float = 0.0

    @cached_property
    def inlet_film(self) -> float:
        """Film in mm at the inlet of the streamline through the pole of the load."""
        speed = self.contact.speed(self.spin)
        return float(self.contact.edge.inlet_film(self.viscosity, numpy.asarray(speed)))

    @property
    def _flood(self) -> float:
        """Film around the contact in mm."""
        return max(self.flood, _FLOODED * self.inlet_film)

    @cached_property
    def _faces(self) -> Numbers:
        """Numbers of the faces with a cell in contact."""
        mesh, inside = self.contact.mesh, self.contact.inside
        return numpy.flatnonzero(inside[mesh.first] | inside[mesh.second])

    @cached_property
    def _cells(self) -> Numbers:
        """Numbers of the cells in contact."""
        return numpy.flatnonzero(self.contact.inside)

    @cached_property
    def _sides(self) -> tuple[Numbers, Numbers]:
        """Cells on both sides of each face, numbered within the contact; all cells outside have the last number."""
        mesh = self.contact.mesh
        numbers = numpy.full(mesh.cells, len(self._cells))
        numbers[self._cells] = numpy.arange(len(self._cells))
        return numbers[mesh.first[self._faces]], numbers[mesh.second[self._faces]]

    @cached_property
    def _carried(self) -> Numbers:
        """Half the velocity across each face times its width, in mm²/s."""
        velocity, _ = self.contact.mesh.face_velocity(self.spin)
        return (0.5 * velocity * self.contact.mesh.width)[self._faces]

    @cached_property
    def _pressed(self) -> Numbers:
        """Factor of h³ in the flow against the pressure across each face, in 1/s."""
        mesh, faces, pressure = self.contact.mesh, self._faces, self.contact.pressure
        rise = pressure[mesh.second[faces]] - pressure[mesh.first[faces]]
        distance = (mesh.first_distance + mesh.second_distance)[faces]
        pressed = mesh.width[faces] * rise / (distance * 12 * self.viscosity)
        return numpy.where(self._near_edge, 0.0, pressed)

    @cached_property
    def _near_edge(self) -> Numbers:
        """Mask of the faces so near an elastic edge that the film changes the dry pressure."""
        mesh, faces = self.contact.mesh, self._faces
        if not self.contact.edge.prescribed:
            return numpy.zeros(len(faces), dtype=bool)
        speed = numpy.asarray(self.contact.speed(self.spin))
        reach = _EDGE_LENGTHS * float(self.contact.edge.inlet_length(self.viscosity, speed))
        depth = self.contact.edge_distance
        return numpy.maximum(depth[mesh.first[faces]], depth[mesh.second[faces]]) < reach

    @cached_property
    def _inflow(self) -> tuple[Numbers, Numbers]:
        """Mask of the faces at an elastic inlet, and the flow through each from first to second cell in mm³/s."""
        mesh, faces = self.contact.mesh, self._faces
        none = numpy.zeros(len(faces), dtype=bool)
        if not self.contact.edge.prescribed:
            return none, numpy.zeros(len(faces))
        first_inside = self.contact.inside[mesh.first[faces]]
        second_inside = self.contact.inside[mesh.second[faces]]
        enters = numpy.where(second_inside, self._carried > 0, self._carried < 0) & (first_inside != second_inside)
        inner = numpy.where(second_inside, mesh.second[faces], mesh.first[faces])
        speed = self.contact.inward_speed(self.spin, mesh.direction[inner])
        return enters, self._carried * self.contact.edge.inlet_film(self.viscosity, speed)

    @cached_property
    def _reconstruction(self) -> tuple[Any, Any, Numbers, Numbers]:
        """Slopes at the faces from both sides, and their factors: 0 in cells next to the edge of the contact."""
        mesh, faces, inside = self.contact.mesh, self._faces, self.contact.inside
        interior = inside.copy()
        borders = inside[mesh.first] != inside[mesh.second]
        interior[mesh.first[borders]] = interior[mesh.second[borders]] = False
        total = mesh.first_distance[faces] + mesh.second_distance[faces]
        from_first, from_second = (matrix[faces][:, self._cells] for matrix in mesh.face_slopes)
        return (
            from_first,
            from_second,
            interior[mesh.first[faces]] * mesh.first_distance[faces] / total,
            interior[mesh.second[faces]] * mesh.second_distance[faces] / total,
        )

    def _at_faces(self, film: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the film on both sides of each face by linear functions in the cells, without new extremes."""
        first, second = self._sides
        from_first, from_second, first_share, second_share = self._reconstruction
        surrounded = numpy.append(film, self._flood)
        upstream, downstream = surrounded[first], surrounded[second]
        step = downstream - upstream
        return (
            upstream + first_share * limited_slope(2 * (from_first @ film) - step, step),
            downstream + second_share * limited_slope(2 * (from_second @ film) + step, -step),
        )

    def _growth(self, film: Numbers) -> Numbers:
        """Compute the growth rate of the film in mm/s in the cells in contact."""
        flow = godunov_flow(self._carried, self._pressed, *self._at_faces(film))
        at_inlet, inflow = self._inflow
        flow = numpy.where(at_inlet, inflow, flow)
        first, second = self._sides
        count = len(self._cells) + 1
        balance = numpy.bincount(second, flow, count) - numpy.bincount(first, flow, count)
        return balance[:-1] / self.contact.mesh.area[self._cells]

    def _stable_step(self, film: Numbers) -> float:
        """Compute the largest time step in s in which no film crosses more than a part of its cell."""
        first, second = self._sides
        inner = numpy.append(film, 0.0)
        highest = numpy.maximum(inner[first], inner[second])
        speed = numpy.abs(self._carried) + 3 * numpy.abs(self._pressed) * highest**2
        count = len(self._cells) + 1
        crossing = (numpy.bincount(first, speed, count) + numpy.bincount(second, speed, count))[:-1]
        fastest = float((crossing / self.contact.mesh.area[self._cells]).max(initial=0.0))
        return _COURANT / fastest if fastest > 0 else numpy.inf

    def advance(self, film: Numbers, duration: float) -> Numbers:
        """Carry a film (cells,) in mm over a time in s by Heun's method; return its thickness in mm."""
        time, inner = 0.0, film[self._cells]
        while time < duration and len(inner):
            step = min(self._stable_step(inner), duration - time)
            growth = self._growth(inner)
            predicted = numpy.clip(inner + step * growth, 0.0, self._flood)
            inner = numpy.clip(inner + step / 2 * (growth + self._growth(predicted)), 0.0, self._flood)
            time += step
        later = film.copy()
        later[self._cells] = inner
        return later

    def solve_steady(self, tolerance: float = 1e-3, max_steps: int = 12) -> tuple[Numbers, bool]:
        """Solve for the steady film in mm, and state whether it is steady.

        Parameters
        ----------
        tolerance : float
            Largest mean change while the ball turns by the width of the contact, relative to the mean film.
        max_steps : int
            Largest number of such turns.
        """
        inside = self.contact.inside
        film = numpy.where(inside, self.inlet_film, 0.0)
        crossing = 4 * self.contact.half_angle / float(numpy.linalg.norm(self.spin))
        for _ in range(max_steps):
            later = self.advance(film, crossing)
            change = float(numpy.abs(later - film)[inside].mean() / later[inside].mean())
            film = later
            if change < tolerance:
                return film, True
        return film, False

    def smallest_film(self, film: Numbers, central: float) -> float:
        """Compute the smallest film in the contact in mm.

        On springs it is that of the cells. In elastic contacts the cells do not resolve it: it is the constriction of
        the outlet behind the central film, or the film that enters at the sides.
        """
        edge, speed = self.contact.edge, self.contact.speed(self.spin)
        if not edge.prescribed:
            return float(film[self.contact.inside].min())
        side = edge.side_speed(self.viscosity, speed, self.contact.contact_radius)
        return min(edge.outlet_ratio * central, float(edge.inlet_film(self.viscosity, numpy.asarray(side))))


def limited_slope(upwind: Numbers, centred: Numbers) -> Numbers:
    """Compute a slope between two slopes of one sign, and 0 where their signs differ (van Leer's limiter)."""
    product = upwind * centred
    total = upwind + centred
    return numpy.where(product > 0, 2 * product / numpy.where(total != 0, total, 1.0), 0.0)


def godunov_flow(carried: Numbers, pressed: Numbers, upstream: Numbers, downstream: Numbers) -> Numbers:
    """Compute Godunov's flow of f(h) = carried · h - pressed · h³ between two films.

    It is the least value of f between the films where the film grows, and the largest where it falls.
    """
    flow_first = (carried - pressed * upstream**2) * upstream
    flow_second = (carried - pressed * downstream**2) * downstream
    least, largest = numpy.minimum(flow_first, flow_second), numpy.maximum(flow_first, flow_second)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        turning = numpy.sqrt(carried / (3 * pressed))
    low, high = numpy.minimum(upstream, downstream), numpy.maximum(upstream, downstream)
    between = (turning > low) & (turning < high)
    extreme = numpy.where(between, 2 / 3 * carried * turning, flow_first)
    return numpy.where(upstream <= downstream, numpy.minimum(least, extreme), numpy.maximum(largest, extreme))
