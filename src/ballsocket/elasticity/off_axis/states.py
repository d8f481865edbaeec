"""Balls at rest in one bore side by side, each quantity one number a contact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy

from ...contact.per_joint import QUANTITIES
from ...core.arrays import Numbers
from .edges import Edges
from .patch import Patch
from .rim import edge_margins
from .search import Bed, Rest

_AREAS = {
    "force": 0.3,
    "indentation": 0.2,
    "max_pressure": 0.3,
    "pole_pressure": 0.3,
    "energy": 0.4,
    "pressure_integral": 0.3,
}
_EDGES = {"half_angle": 0.1, "stiffness": 0.6}
"""Errors that contacts have shown against the exact answer: in squares of a ring over the half angle, and in such.

The first follow from the pressures, the second from which cells touch. A test draws such contacts anew.
"""
_SHARPEST = 3e-4  # of all quantities: what the elements of the cup leave


Loaded = Callable[["Bed", Numbers, Numbers, "Edges"], "States"]
"""From a bed, loads (contacts,), their directions (contacts, 3) in the cup's frame, and what edges are like."""


@dataclass(frozen=True, kw_only=True, eq=False)
class States:
    """Contacts of one joint.

    Attributes
    ----------
    bed : Bed
    rest : Rest
    axes : array (contacts, 3)
        Unit vectors along which the pressure at the pole is read and angles count, in the cup's frame.
    edges : Edges
    dislocated : array of bool (contacts,)
        Whether the bore does not hold the ball.
    load : array (contacts,)
        What was asked for along the axes.
    press : function
        From a bed, other loads of that kind, their axes and what edges are like, to their contacts.
    too_wide : array of bool (contacts,)
        Whether no contact in this bore is as wide as asked for.
    """

    bed: Bed
    rest: Rest
    axes: Numbers
    edges: Edges
    dislocated: Numbers
    load: Numbers
    press: Loaded
    too_wide: Numbers | bool = False

    @property
    def lost(self) -> Numbers:
        """1 where the ball leaves the bore."""
        return self.dislocated.astype(float)

    @property
    def unsettled(self) -> Numbers:
        """1 where the iteration did not end."""
        return (~self.rest.found & ~self.dislocated).astype(float)

    @property
    def reached(self) -> Numbers:
        """Whether a contact can be as wide as asked for."""
        return ~(self.too_wide & ~self.dislocated)

    @cached_property
    def patches(self) -> tuple[Patch, ...]:
        grid, inset = self.bed.compliance.grid, self.edges.inset
        rows = zip(self.rest.pressure, self.levels, self.axes, strict=True)
        return tuple(Patch(grid=grid, pressure=p, level=level, axis=axis, inset=inset) for p, level, axis in rows)

    @cached_property
    def levels(self) -> Numbers:
        """Level in mm of every cell, positive in the contact, minus the gap outside: (contacts, rings, meridians)."""
        p = self.rest.pressure
        gap = self.bed.compliance.displacement(p) - self.bed.separation.overlap(self.rest.displacement)
        return self.edges.levels(p, gap)

    @cached_property
    def force_vector(self) -> Numbers:
        """The load on the cup in N: (3, contacts), in the cup's frame."""
        return self.bed.force(self.rest.pressure).T

    @property
    def displacement(self) -> Numbers:
        """Places of the ball's centre from the centre of the bore in mm: (3, contacts)."""
        return self.rest.displacement.T

    @property
    def force(self) -> Numbers:
        """The size of the load in N; in a preloaded joint the load along its axis, below 0 where it pulls."""
        if self._preloaded:
            return self._along(self.force_vector)
        return numpy.linalg.norm(self.force_vector, axis=0)

    @property
    def indentation(self) -> Numbers:
        """How far the ball moved on after it could first touch, in mm; in a preloaded joint along the load's axis."""
        moved = self._along(self.displacement) if self._preloaded else numpy.linalg.norm(self.displacement, axis=0)
        return moved - self.bed.separation.clearance

    @property
    def _preloaded(self) -> bool:
        return self.bed.separation.clearance < 0

    def _along(self, vectors: Numbers) -> Numbers:
        return numpy.einsum("kn,nk->n", vectors, self.axes)

    @cached_property
    def tangent(self) -> Numbers:
        """The stiffness in N/mm: (3, 3, contacts)."""
        stretched = self.bed.stretched(self.rest.displacement, self.rest.pressure, tolerance=1e-6)
        return numpy.moveaxis(self.bed.tangent(stretched), 0, -1)

    @property
    def stiffness(self) -> Numbers:
        """Slope of force over indentation, in N/mm."""
        if self._preloaded:
            return numpy.einsum("nk,kln,nl->n", self.axes, self.tangent, self.axes)
        along, way = (_unit(each) for each in (self.force_vector, self.displacement))
        return numpy.einsum("kn,kln,ln->n", along, self.tangent, way)

    @property
    def energy(self) -> Numbers:
        """Stored in both bodies, in N mm."""
        p = self.rest.pressure
        given = self.bed.compliance.displacement(p)
        return self.bed.area * self.bed.compliance.grid.total(p, given) / 2

    @property
    def pressure_integral(self) -> Numbers:
        """∫ p dA in N."""
        p = self.rest.pressure
        return self.bed.area * self.bed.compliance.grid.total(p, numpy.ones_like(p))

    def _each(self, law: str) -> Numbers:
        return numpy.array([getattr(patch, law) for patch in self.patches])

    @property
    def half_angle(self) -> Numbers:
        """Half angles in rad of round contacts of the same area."""
        return self._each("half_angle")

    @property
    def edge_loaded(self) -> Numbers:
        """1 where there is pressure at the end of the bore."""
        return self._each("edge_loaded").astype(float)

    @cached_property
    def edge_margin(self) -> Numbers:
        """The angle in rad from the contact to the end of the bore, below 0 where it is reached: see `edge_margins`."""
        return edge_margins(self)

    @property
    def unbounded(self) -> Numbers:
        """1 where the pressure has no largest value, at an edge that digs in."""
        return self.edge_loaded * (not self.edges.bounded)

    @property
    def max_pressure(self) -> Numbers:
        """The largest pressure in MPa, infinite at an edge that digs in."""
        largest = numpy.array([patch.largest[0] for patch in self.patches])
        return numpy.where(self.unbounded == 1, numpy.inf, largest)

    @property
    def max_pressure_at(self) -> Numbers:
        """Unit vectors to the largest pressures: (3, contacts)."""
        return numpy.array([patch.largest[1] for patch in self.patches]).reshape(-1, 3).T

    @property
    def max_pressure_angle(self) -> Numbers:
        """From the load to the largest pressure, in rad."""
        across = numpy.linalg.norm(numpy.cross(self.max_pressure_at.T, self.axes), axis=1)
        return numpy.arctan2(across, (self.max_pressure_at.T * self.axes).sum(axis=1))

    @property
    def pole_pressure(self) -> Numbers:
        """Where the axis of the load meets the bore, in MPa."""
        return numpy.array([float(patch.at(patch.axis)) for patch in self.patches])

    def pressure(self, angle: Numbers) -> Numbers:
        """p in MPa at angles (anything, contacts) from the load, in its plane with the cup's axis, towards the rim."""
        columns = [patch.along(angle[:, i]) for i, patch in enumerate(self.patches)]
        return numpy.stack(columns, axis=-1) if columns else numpy.zeros_like(angle)

    def errors(self, kind: str) -> dict[str, Numbers]:
        """Relative errors as those of contacts so wide on rings of this width; what was given is exact."""
        grid = self.bed.compliance.grid
        area = ((self.rest.pressure > 0) * grid.areas).sum(axis=(1, 2))
        share = grid.width**2 * numpy.pi / numpy.maximum(area, grid.areas.min())  # of a flat circle of that area
        errors = {name: _SHARPEST + factor * share for name, factor in _AREAS.items()}
        errors |= {name: _SHARPEST + factor * numpy.sqrt(share) for name, factor in _EDGES.items()}
        if kind == "half_angle":
            return {name: errors[name] + power * errors[kind] for name, power in self._powers().items()}
        errors[kind] = 0.0 * share
        return {name: errors[name] for name in QUANTITIES}

    def _powers(self) -> dict[str, Numbers]:
        """By which powers of the half angle the quantities grow: in springs, d as 1/cos ε - 1, the others with d."""
        angle = numpy.minimum(self.half_angle, 1.5)
        x = numpy.cos(angle)
        growth = angle / numpy.tan(angle / 2) / x
        powers = dict.fromkeys(QUANTITIES, growth)
        powers |= {"force": (2 - 2 * (1 - x) * (1 + x) / (2 + x)) * growth, "energy": (2 + x) * growth}
        return powers | {"pressure_integral": (1 + x) * growth, "half_angle": 0.0 * x}


def _unit(vectors: Numbers) -> Numbers:
    """Vectors (3, contacts) of length 1; those that have none stay so."""
    length = numpy.linalg.norm(vectors, axis=0)
    return vectors / numpy.where(length > 0, length, 1.0)
