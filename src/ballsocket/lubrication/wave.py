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

_COURANT = 0.8  # largest part of the film of a cell that may leave it in one step
_TINY = 1e-300  # film in mm that keeps a quotient of zeros at zero

_EDGE_LENGTHS = 3.0
"""Distance from an elastic edge, in inlet lengths, within which the pressure of the film is not the dry one."""

_FLOODED = 4.0  # film around the contact, relative to the inlet film; the flow into the contact does not depend on it


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmWave:
    """Flow of a thin film over a dry contact."""

    contact: DryContact
    viscosity: float  # viscosity in MPa s
    spin: Numbers  # (3,), rotation rate of the ball in rad/s
    # film around the contact in mm, and largest film within it; by default four times the inlet film
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
        return numpy.flatnonzero(self.contact.inside)

    @cached_property
    def _numbers(self) -> Numbers:
        """Numbers of the cells within the contact; all cells outside have the last number."""
        numbers = numpy.full(self.contact.mesh.cells, len(self._cells))
        numbers[self._cells] = numpy.arange(len(self._cells))
        return numbers

    @cached_property
    def _sides(self) -> tuple[Numbers, Numbers]:
        """Cells on both sides of each face, numbered within the contact."""
        mesh = self.contact.mesh
        return self._numbers[mesh.first[self._faces]], self._numbers[mesh.second[self._faces]]

    @cached_property
    def _inverse_area(self) -> Numbers:
        """Inverse areas of the cells in contact in 1/mm², and 0 around them."""
        return numpy.append(1 / self.contact.mesh.area[self._cells], 0.0)

    @cached_property
    def _carried(self) -> Numbers:
        """Half the velocity across each face times its width, in mm²/s."""
        velocity, _ = self.contact.mesh.face_velocity(self.spin)
        return (0.5 * velocity * self.contact.mesh.width)[self._faces]

    @cached_property
    def _pressed(self) -> Numbers:
        """Factor of h³ in the flow against the pressure across each face, in 1/s."""
        mesh, faces, pressure = self.contact.mesh, self._faces, self.contact.signed_pressure
        rise = mesh.normal_rise(pressure, faces)
        distance = (mesh.first_distance + mesh.second_distance)[faces]
        pressed = mesh.width[faces] * rise / (distance * 12 * self.viscosity)
        if not self.contact.edge.prescribed:
            return pressed
        # near an elastic edge the film changes the dry pressure
        speed, depth = numpy.asarray(self.contact.speed(self.spin)), self.contact.edge_distance
        reach = _EDGE_LENGTHS * float(self.contact.edge.inlet_length(self.viscosity, speed))
        return numpy.where(numpy.maximum(depth[mesh.first[faces]], depth[mesh.second[faces]]) < reach, 0.0, pressed)

    @cached_property
    def _turning(self) -> Numbers:
        """Film in mm of the largest or least flow across each face; NaN or infinite without one."""
        with numpy.errstate(divide="ignore", invalid="ignore"):
            turning = numpy.asarray(numpy.sqrt(self._carried / (3 * self._pressed)))
        for edge, _ in self._supply:
            turning[edge] = numpy.nan
        return turning

    @cached_property
    def _supply(self) -> tuple[tuple[Numbers, Numbers], tuple[Numbers, Numbers]]:
        """Faces at the edge of a contact on springs whose first, and whose second cell is outside, and films there.

        The film in mm is that of the largest flow across the edge, h² = 2 η U·n/G, with the slope G of the pressure and
        the normal n of the edge. The faces of the cells may have other directions. A thicker film within the contact
        continues outside: it leaves, or moves along the edge. Without a pressure that continues beyond the edge there
        are no such faces, and Godunov's flux at each face draws its own film.
        """
        contact, mesh, faces = self.contact, self.contact.mesh, self._faces
        if contact.continuation is None:
            none = numpy.zeros(0, dtype=int), numpy.zeros(0)
            return none, none
        edge = numpy.flatnonzero(contact.inside[mesh.first[faces]] != contact.inside[mesh.second[faces]])
        first, second = mesh.first[faces[edge]], mesh.second[faces[edge]]
        level = contact.continuation if contact.level is None else contact.level
        slope, normal = (
            (mesh.gradient(field, first) + mesh.gradient(field, second)) / 2 for field in (contact.continuation, level)
        )
        normal /= numpy.maximum(numpy.linalg.norm(normal, axis=1), _TINY)[:, None]
        rise = (slope * normal).sum(axis=1)
        velocity = mesh.radius * numpy.cross(self.spin, mesh.direction[first] + mesh.direction[second]) / 2
        inward = numpy.maximum((velocity * normal).sum(axis=1), 0.0)
        largest = numpy.sqrt(2 * self.viscosity * inward / numpy.maximum(rise, _TINY))
        film = numpy.minimum(largest, self._flood)
        enters = contact.inside[second]
        return (edge[enters], film[enters]), (edge[~enters], film[~enters])

    @cached_property
    def _inflow(self) -> tuple[Numbers, Numbers]:
        """Numbers of the faces at an elastic inlet, and the flow through each from first to second cell in mm³/s."""
        mesh, faces = self.contact.mesh, self._faces
        if not self.contact.edge.prescribed:
            return numpy.zeros(0, dtype=int), numpy.zeros(0)
        first_inside = self.contact.inside[mesh.first[faces]]
        second_inside = self.contact.inside[mesh.second[faces]]
        enters = numpy.where(second_inside, self._carried > 0, self._carried < 0) & (first_inside != second_inside)
        inlet = numpy.flatnonzero(enters)
        inner = numpy.where(second_inside, mesh.second[faces], mesh.first[faces])[inlet]
        speed = self.contact.inward_speed(self.spin, mesh.direction[inner])
        return inlet, self._carried[inlet] * self.contact.edge.inlet_film(self.viscosity, speed)

    @cached_property
    def _reconstruction(self) -> tuple[Any, Numbers]:
        """Matrix from films to slopes at the faces from both sides; factors (2, faces), 0 next to the edge."""
        from scipy.sparse import csr_matrix  # slow to import

        mesh, faces, interior = self.contact.mesh, self._faces, self.contact.interior
        rows = mesh.face_slopes[numpy.concatenate([faces, faces + len(mesh.first)])]
        shape = (rows.shape[0], len(self._cells) + 1)
        slopes = csr_matrix((rows.data, self._numbers[rows.indices], rows.indptr), shape)
        total = mesh.first_distance[faces] + mesh.second_distance[faces]
        factors = numpy.stack(
            [
                interior[mesh.first[faces]] * mesh.first_distance[faces] / total,
                interior[mesh.second[faces]] * mesh.second_distance[faces] / total,
            ]
        )
        return slopes, factors

    def _at_faces(self, film: Numbers) -> tuple[Numbers, Numbers]:
        """Compute the film on both sides of each face by linear functions in the cells, without new extremes."""
        first, second = self._sides
        slopes, factors = self._reconstruction
        upstream, downstream = film[first], film[second]
        for (edge, supply), outside, within in zip(
            self._supply, (upstream, downstream), (downstream, upstream), strict=True
        ):
            outside[edge] = numpy.maximum(supply, within[edge])
        step = downstream - upstream
        change = factors * limited_slope((slopes @ film).reshape(2, -1), step)
        return upstream + change[0], downstream - change[1]

    def _growth(self, film: Numbers) -> Numbers:
        """Compute the growth rate of the film in mm/s in the cells in contact, and 0 around them."""
        flow = godunov_flow(self._carried, self._pressed, self._turning, *self._at_faces(film))
        inlet, inflow = self._inflow
        flow[inlet] = inflow
        first, second = self._sides
        balance = numpy.bincount(second, flow, len(film)) - numpy.bincount(first, flow, len(film))
        return balance * self._inverse_area

    @cached_property
    def _leaving(self) -> tuple[Numbers, Numbers]:
        """Rates a and b, with which at most a + b h² of the film h leaves each cell: in 1/s and 1/(mm² s)."""
        first, second = self._sides
        count = len(self._cells) + 1
        out, back = numpy.maximum(self._carried, 0.0), numpy.maximum(-self._carried, 0.0)
        carried = numpy.bincount(first, out, count) + numpy.bincount(second, back, count)
        out, back = numpy.maximum(-self._pressed, 0.0), numpy.maximum(self._pressed, 0.0)
        pressed = numpy.bincount(first, out, count) + numpy.bincount(second, back, count)
        return carried * self._inverse_area, 3 * pressed * self._inverse_area

    def advance(self, film: Numbers, duration: float) -> Numbers:
        """Carry a film (cells,) in mm over a time in s by Heun's method; return its thickness in mm."""
        flood, (carried, pressed) = self._flood, self._leaving
        time, inner = 0.0, numpy.append(film[self._cells], flood)
        while time < duration and len(inner) > 1:
            fastest = float((carried + pressed * inner**2).max())  # only a part of a film leaves in a step, at f'(h)
            step = min(_COURANT / fastest if fastest > 0 else numpy.inf, duration - time)
            growth = self._growth(inner)
            predicted = numpy.minimum(numpy.maximum(inner + step * growth, 0.0), flood)
            growth += self._growth(predicted)
            inner = numpy.minimum(numpy.maximum(inner + step / 2 * growth, 0.0), flood)
            time += step
        later = film.copy()
        later[self._cells] = inner[:-1]
        return later

    def solve_steady(self, tolerance: float = 1e-3, max_steps: int = 12) -> tuple[Numbers, bool]:
        """Solve for the steady film in mm, and state whether it is steady.

        Its mean change while the ball turns by the width of the contact is then below `tolerance`, relative to the mean
        film, after at most `max_steps` such turns.
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


def limited_slope(twice_mean: Numbers, centred: Numbers) -> Numbers:
    """Compute van Leer's slope of a centred and an upwind slope, from twice their mean and the centred slope.

    It is their harmonic mean, and 0 where their signs differ.
    """
    product = (twice_mean - centred) * centred
    return numpy.asarray(2 * numpy.maximum(product, 0.0) / (twice_mean + _TINY))


def godunov_flow(
    carried: Numbers, pressed: Numbers, turning: Numbers, upstream: Numbers, downstream: Numbers
) -> Numbers:
    """Compute Godunov's flow of f(h) = carried · h - pressed · h³ between two films; f' is 0 at the film `turning`.

    It is the least value of f between the films where the film grows, and the largest where it falls.
    """
    flow_first = (carried - pressed * upstream**2) * upstream
    flow_second = (carried - pressed * downstream**2) * downstream
    rises = upstream <= downstream
    flow = numpy.where(rises == (flow_first <= flow_second), flow_first, flow_second)
    # the turning film between two films is rare: its flow is computed there alone
    between = numpy.flatnonzero((turning > upstream) != (turning >= downstream))
    extreme = 2 / 3 * carried[between] * turning[between]
    rising = rises[between]
    flow[between] = numpy.where(rising, numpy.minimum(flow[between], extreme), numpy.maximum(flow[between], extreme))
    return flow
