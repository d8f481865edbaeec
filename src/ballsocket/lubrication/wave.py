"""Thin film as a kinematic wave on the dry pressure: a conservation law with Godunov's flux.

For thin films the pressure is that of the dry contact, and the film obeys

    ∂h/∂t + ∇·(½ U h - h³ ∇p/(12 η)) = 0

on the dry contact patch, with lubricant in plenty outside. The flux has a largest value over h; the inlet draws that
value, as a weir does. Godunov's flux finds it without a condition at the inlet.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy

from ..core.arrays import Numbers
from .mesh import FilmMesh

_COURANT = 0.8
"""Largest part of a cell that the film may cross in one step."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Wave:
    """Flow of a thin film over the patch of a dry contact.

    Attributes
    ----------
    mesh : FilmMesh
    viscosity : float
        Viscosity in MPa s.
    spin : array (3,)
        Rotation rate of the ball in rad/s.
    pressure : array (cells,)
        Pressure of the dry contact in MPa.
    reservoir : float
        Film thickness outside the contact in mm, far above that within.
    """

    mesh: FilmMesh
    viscosity: float
    spin: Numbers
    pressure: Numbers
    reservoir: float

    @cached_property
    def inside(self) -> Numbers:
        """Mark the cells in contact."""
        return self.pressure > 0

    @cached_property
    def _faces(self) -> Numbers:
        """Select the faces with a cell in contact."""
        return numpy.flatnonzero(self.inside[self.mesh.left] | self.inside[self.mesh.right])

    @cached_property
    def _carried(self) -> Numbers:
        """Compute half the velocity across each selected face times its width, in mm²/s."""
        velocity, _ = self.mesh.face_velocity(self.spin)
        return (0.5 * velocity * self.mesh.width)[self._faces]

    @cached_property
    def _pressed(self) -> Numbers:
        """Compute the factor of h³ in the flow against the pressure, in 1/s."""
        mesh, faces = self.mesh, self._faces
        left, right = mesh.left[faces], mesh.right[faces]
        distance = (mesh.left_distance + mesh.right_distance)[faces]
        rise = self.pressure[right] - self.pressure[left]
        return mesh.width[faces] * rise / (distance * 12 * self.viscosity)

    def rate(self, film: Numbers) -> tuple[Numbers, float]:
        """Compute the growth rate of the film in mm/s, and the largest stable time step in s.

        Parameters
        ----------
        film : array (cells,)
            Film thickness in mm; only cells in contact are used.
        """
        mesh, faces = self.mesh, self._faces
        left, right = mesh.left[faces], mesh.right[faces]
        whole = numpy.where(self.inside, film, self.reservoir)
        upstream, downstream = whole[left], whole[right]
        flow = godunov_flow(self._carried, self._pressed, upstream, downstream)
        cells = mesh.cells
        growth = (numpy.bincount(right, flow, cells) - numpy.bincount(left, flow, cells)) / mesh.area
        highest = numpy.maximum(numpy.where(self.inside[left], upstream, 0), numpy.where(self.inside[right], downstream, 0))
        speed = numpy.abs(self._carried) + 3 * numpy.abs(self._pressed) * highest**2
        crossing = (numpy.bincount(left, speed, cells) + numpy.bincount(right, speed, cells)) / mesh.area
        fastest = float(crossing[self.inside].max(initial=0.0))
        return numpy.where(self.inside, growth, 0.0), _COURANT / fastest if fastest > 0 else numpy.inf

    def advance(self, film: Numbers, duration: float) -> Numbers:
        """Carry the film over a time in s; return its thickness in mm."""
        time = 0.0
        while time < duration:
            growth, stable = self.rate(film)
            step = min(stable, duration - time)
            film = film + step * growth
            time += step
        return film


def godunov_flow(carried: Numbers, pressed: Numbers, upstream: Numbers, downstream: Numbers) -> Numbers:
    """Compute Godunov's flow of f(h) = carried · h - pressed · h³ between two films.

    The least value of f between the films where the film grows, the largest where it falls.
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
