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

_FLOODED = 10.0
"""Film around the contact, relative to the largest film within and to the inlet film."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Wave:
    """Flow of a thin film over a dry contact.

    Attributes
    ----------
    contact : DryContact
    viscosity : float
        Viscosity in MPa s.
    spin : array (3,)
        Rotation rate of the ball in rad/s.
    """

    contact: DryContact
    viscosity: float
    spin: Numbers

    @cached_property
    def inlet_film(self) -> float:
        """Film in mm at the inlet of the streamline through the pole of the load."""
        speed = self.contact.speed(self.spin)
        return float(self.contact.edge.inlet_film(self.viscosity, numpy.asarray(speed)))

    @cached_property
    def _cells(self) -> tuple[Numbers, Numbers, Numbers]:
        """Faces with a cell in contact, and the cells on both sides of them."""
        mesh, inside = self.contact.mesh, self.contact.inside
        faces = numpy.flatnonzero(inside[mesh.left] | inside[mesh.right])
        return faces, mesh.left[faces], mesh.right[faces]

    @cached_property
    def _border(self) -> tuple[Numbers, Numbers]:
        """Masks of the faces whose left, or right, cell lies outside the contact."""
        _, left, right = self._cells
        inside = self.contact.inside
        return ~inside[left], ~inside[right]

    @cached_property
    def _carried(self) -> Numbers:
        """Half the velocity across each face times its width, in mm²/s."""
        velocity, _ = self.contact.mesh.face_velocity(self.spin)
        return (0.5 * velocity * self.contact.mesh.width)[self._cells[0]]

    @cached_property
    def _pressed(self) -> Numbers:
        """Factor of h³ in the flow against the pressure across each face, in 1/s."""
        mesh, (faces, left, right) = self.contact.mesh, self._cells
        pressure = self.contact.pressure
        distance = (mesh.left_distance + mesh.right_distance)[faces]
        pressed = mesh.width[faces] * (pressure[right] - pressure[left]) / (distance * 12 * self.viscosity)
        return numpy.where(self._near_edge, 0.0, pressed)

    @cached_property
    def _near_edge(self) -> Numbers:
        """Mask of the faces so near an elastic edge that the film changes the dry pressure."""
        _, left, right = self._cells
        if not self.contact.edge.prescribed:
            return numpy.zeros(len(left), dtype=bool)
        speed = numpy.asarray(self.contact.speed(self.spin))
        reach = _EDGE_LENGTHS * float(self.contact.edge.inlet_length(self.viscosity, speed))
        deepest = numpy.maximum(self.contact.edge_distance[left], self.contact.edge_distance[right])
        return deepest < reach

    @cached_property
    def _inflow(self) -> Numbers:
        """Prescribed flow from left to right across faces at an elastic inlet, in mm³/s; NaN elsewhere."""
        _, left, right = self._cells
        first_outside, second_outside = self._border
        inner = numpy.where(first_outside, right, left)
        enters = numpy.where(first_outside, self._carried > 0, self._carried < 0) & (first_outside | second_outside)
        if not self.contact.edge.prescribed:
            return numpy.full(len(left), numpy.nan)
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
        _, left, right = self._cells
        reservoir = _FLOODED * max(float(film[inside].max(initial=0.0)), self.inlet_film)
        surrounded = numpy.where(inside, film, reservoir)
        upstream, downstream = surrounded[left], surrounded[right]
        flow = godunov_flow(self._carried, self._pressed, upstream, downstream)
        flow = numpy.where(self._is_inflow, self._inflow, flow)
        cells = mesh.cells
        growth = (numpy.bincount(right, flow, cells) - numpy.bincount(left, flow, cells)) / mesh.area
        first_outside, second_outside = self._border
        highest = numpy.maximum(
            numpy.where(first_outside, 0.0, upstream), numpy.where(second_outside, 0.0, downstream)
        )
        speed = numpy.abs(self._carried) + 3 * numpy.abs(self._pressed) * highest**2
        crossing = (numpy.bincount(left, speed, cells) + numpy.bincount(right, speed, cells)) / mesh.area
        fastest = float(crossing[inside].max(initial=0.0))
        return numpy.where(inside, growth, 0.0), _COURANT / fastest if fastest > 0 else numpy.inf

    def advance(self, film: Numbers, duration: float) -> Numbers:
        """Carry the film over a time in s; return its thickness in mm."""
        time = 0.0
        while time < duration:
            growth, stable = self.rate(film)
            step = min(stable, duration - time)
            film = numpy.maximum(film + step * growth, 0.0)
            time += step
        return film

    def solve_steady(self, tolerance: float = 1e-3, most: int = 12) -> tuple[Numbers, bool]:
        """Solve for the steady film in mm, and state whether it is steady.

        Parameters
        ----------
        tolerance : float
            Largest mean change while the ball turns by the width of the contact, relative to the mean film.
        most : int
            Largest number of such turns.
        """
        inside = self.contact.inside
        film = numpy.where(inside, self.inlet_film, 0.0)
        crossing = 4 * self.contact.half_angle / float(numpy.linalg.norm(self.spin))
        for _ in range(most):
            later = self.advance(film, crossing)
            change = float(numpy.abs(later - film)[inside].mean() / later[inside].mean())
            film = later
            if change < tolerance:
                return film, True
        return film, False


def godunov_flow(carried: Numbers, pressed: Numbers, upstream: Numbers, downstream: Numbers) -> Numbers:
    """Compute Godunov's flow of f(h) = carried · h - pressed · h³ between two films.

    It is the least value of f between the films where the film grows, and the largest where it falls.
    """
    flow_left = (carried - pressed * upstream**2) * upstream
    flow_right = (carried - pressed * downstream**2) * downstream
    least, largest = numpy.minimum(flow_left, flow_right), numpy.maximum(flow_left, flow_right)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        turning = numpy.sqrt(carried / (3 * pressed))
    low, high = numpy.minimum(upstream, downstream), numpy.maximum(upstream, downstream)
    between = (turning > low) & (turning < high)
    extreme = numpy.where(between, 2 / 3 * carried * turning, flow_left)
    return numpy.where(upstream <= downstream, numpy.minimum(least, extreme), numpy.maximum(largest, extreme))
