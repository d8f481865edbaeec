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

import numpy

from ..core.arrays import Numbers
from .dry_contact import DryContact

_COURANT = 0.8
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
    def _cells(self) -> tuple[Numbers, Numbers, Numbers]:
        """Faces with a cell in contact, and the cells on both sides of them."""
        mesh, inside = self.contact.mesh, self.contact.inside
        faces = numpy.flatnonzero(inside[mesh.first] | inside[mesh.second])
        return faces, mesh.first[faces], mesh.second[faces]

    @cached_property
    def _border(self) -> tuple[Numbers, Numbers]:
        """Masks of the faces whose first, or second, cell lies outside the contact."""
        _, first, second = self._cells
        inside = self.contact.inside
        return ~inside[first], ~inside[second]

    @cached_property
    def _carried(self) -> Numbers:
        """Half the velocity across each face times its width, in mm²/s."""
        velocity, _ = self.contact.mesh.face_velocity(self.spin)
        return (0.5 * velocity * self.contact.mesh.width)[self._cells[0]]

    @cached_property
    def _pressed(self) -> Numbers:
        """Factor of h³ in the flow against the pressure across each face, in 1/s."""
        mesh, (faces, first, second) = self.contact.mesh, self._cells
        pressure = self.contact.pressure
        distance = (mesh.first_distance + mesh.second_distance)[faces]
        pressed = mesh.width[faces] * (pressure[second] - pressure[first]) / (distance * 12 * self.viscosity)
        return numpy.where(self._near_edge, 0.0, pressed)

    @cached_property
    def _near_edge(self) -> Numbers:
        """Mask of the faces so near an elastic edge that the film changes the dry pressure."""
        _, first, second = self._cells
        if not self.contact.edge.prescribed:
            return numpy.zeros(len(first), dtype=bool)
        speed = numpy.asarray(self.contact.speed(self.spin))
        reach = _EDGE_LENGTHS * float(self.contact.edge.inlet_length(self.viscosity, speed))
        deepest = numpy.maximum(self.contact.edge_distance[first], self.contact.edge_distance[second])
        return deepest < reach

    @cached_property
    def _inflow(self) -> Numbers:
        """Prescribed flow from first to second across faces at an elastic inlet, in mm³/s; NaN elsewhere."""
        _, first, second = self._cells
        first_outside, second_outside = self._border
        inner = numpy.where(first_outside, second, first)
        enters = numpy.where(first_outside, self._carried > 0, self._carried < 0) & (first_outside | second_outside)
        if not self.contact.edge.prescribed:
            return numpy.full(len(first), numpy.nan)
        speed = self.contact.inward_speed(self.spin, self.contact.mesh.direction[inner])
        film = self.contact.edge.inlet_film(self.viscosity, speed)
        return numpy.where(enters, self._carried * film, numpy.nan)

    @cached_property
    def _is_inflow(self) -> Numbers:
        """Mask of the faces with a prescribed flow."""
        return ~numpy.isnan(self._inflow)

    def rate(self, film: Numbers) -> tuple[Numbers, float]:
        """Compute the growth rate of the film in mm/s, and the largest stable time step in s.

        Parameters
        ----------
        film : array (cells,)
            Film thickness in mm; only cells in contact are used.
        """
        mesh, inside = self.contact.mesh, self.contact.inside
        _, first, second = self._cells
        surrounded = numpy.where(inside, film, self._flood)
        upstream, downstream = surrounded[first], surrounded[second]
        flow = godunov_flow(self._carried, self._pressed, upstream, downstream)
        flow = numpy.where(self._is_inflow, self._inflow, flow)
        cells = mesh.cells
        growth = (numpy.bincount(second, flow, cells) - numpy.bincount(first, flow, cells)) / mesh.area
        first_outside, second_outside = self._border
        highest = numpy.maximum(numpy.where(first_outside, 0.0, upstream), numpy.where(second_outside, 0.0, downstream))
        speed = numpy.abs(self._carried) + 3 * numpy.abs(self._pressed) * highest**2
        crossing = (numpy.bincount(first, speed, cells) + numpy.bincount(second, speed, cells)) / mesh.area
        fastest = float(crossing[inside].max(initial=0.0))
        return numpy.where(inside, growth, 0.0), _COURANT / fastest if fastest > 0 else numpy.inf

    def advance(self, film: Numbers, duration: float) -> Numbers:
        """Carry the film over a time in s; return its thickness in mm."""
        time = 0.0
        while time < duration:
            growth, stable = self.rate(film)
            step = min(stable, duration - time)
            film = numpy.clip(film + step * growth, 0.0, self._flood)
            time += step
        return film

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
