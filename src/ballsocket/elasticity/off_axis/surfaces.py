"""Surfaces of the socket: springs, a closed shell, or a real cup; their compliance and the edge of a contact on them.

The edge of a contact is the line of zero pressure and zero gap. It runs between the cells.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy

from ...core.arrays import Numbers
from ...models.kinematics import linear_indentation
from ...models.modulus import Modulus, as_modulus, hess_forsbach
from ...problem import Joint
from ...problem.cup import Cup
from ..exact.modes import socket_of
from .ring_matrices import cup_ring_slopes, cup_rings, difference_rings, sphere_rings

if TYPE_CHECKING:
    from .grid import Grid

_ELASTIC_INSET = 0.113
"""Distance from a cell's middle to the contact's edge at the first load of the cell, as a fraction of its width."""

_GAP_TO_PRESSURE = 2 / 3
"""Factor k of the edge between two cells, which balances p w of the last loaded cell and k E* g of the first open cell.

Both constants are fitted to a Hertz line contact on a half-plane in equal cells, at 40 positions of its edge. Their
error of the edge is 0.01 cells.
"""


@dataclass(frozen=True, kw_only=True, eq=False)
class EdgeRelation:
    """Relation of pressure and gap that locates the edge of a contact between cells."""

    compliance: Numbers  # (rings, 1), gap in mm of an open cell that is equivalent to 1 MPa in a loaded cell
    # distance of the edge inside a cell's middle at the first load of that cell, as a fraction of a ring's width
    inset: float
    bounded: bool  # True if the pressure stays finite in a contact that reaches the end of the bore

    def levels(self, pressure: Numbers, gap: Numbers) -> Numbers:
        """Compute levels in mm: positive by the pressure in loaded cells, minus the gap in open ones."""
        return numpy.where(pressure > 0, pressure * self.compliance, -numpy.maximum(gap, 0.0))


def elastic_edges(joint: Joint, grid: Grid, bounded: bool) -> EdgeRelation:
    """Return the relation between pressure and gap near the contact edge of elastic bodies.

    At the distance s from the edge the pressure falls as s^(1/2), and the gap opens as s^(3/2).
    """
    bodies = [joint.liner] if joint.ball is None else [joint.liner, joint.ball]
    softness = sum((1 - float(body.poisson) ** 2) / float(body.young) for body in bodies)  # 1/E*
    width = numpy.diff(grid.edges)[:, None] * float(joint.socket_radius)
    return EdgeRelation(compliance=width * softness / _GAP_TO_PRESSURE, inset=_ELASTIC_INSET, bounded=bounded)


def spring_edges(modulus: float, grid: Grid) -> EdgeRelation:
    """Return the linear relation of pressure and gap near the contact edge on springs of a modulus in MPa/mm."""
    return EdgeRelation(compliance=numpy.full((grid.rings, 1), 1 / modulus), inset=0.0, bounded=True)


class Surface(ABC):
    """Compliance of a bore, and the edge of a contact on it."""

    edge_exponent: ClassVar[float] = 0.5  # n of the pressure p ~ s^n at a distance s from the edge of a contact

    @property
    def isotropic(self) -> Surface:
        """Surface with the same compliance about every axis, which differs from this one by smooth displacements."""
        return self

    @abstractmethod
    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        """Compute the compliance matrices between cells for each harmonic m in mm/MPa: (m, rings, rings)."""

    def ring_slopes(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        """Compute the derivatives (3, m, rings, rings) of `rings` by E, ν and thickness of the liner."""
        return difference_rings(lambda varied: self.rings(varied, cup, grid), joint)

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> EdgeRelation:
        """Return the relation between pressure and gap that locates the edge of a contact between cells."""
        return elastic_edges(joint, grid, bounded=False)


@dataclass(frozen=True, kw_only=True)
class RealCup(Surface):
    """Real cup with rim, arc of cover, chamfer and backing layers, by finite elements of its meridian.

    Each harmonic about the cup's axis has one stiffness for all directions of the load. Setting it up takes a second.
    It is cached on disk for each R2/L, ν, arc of cover, chamfer and backing, and scales with Young's modulus.
    """

    @property
    def isotropic(self) -> ClosedShell:
        return ClosedShell()

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        return grid.average_over_cells(cup_rings(joint, cup, grid))

    def ring_slopes(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        return grid.average_slopes(cup_rings(joint, cup, grid), cup_ring_slopes(joint, cup, grid))

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> EdgeRelation:
        return elastic_edges(joint, grid, bounded=cup.chamfer == 0)


@dataclass(frozen=True, kw_only=True)
class ClosedShell(Surface):
    """Closed shell without an opening, as in `Exact`: the rim ends the contact but does not soften the liner."""

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        return grid.average_over_cells(sphere_rings(socket_of(joint).compliance, grid))


@dataclass(frozen=True, kw_only=True)
class Springs(Surface):
    """Independent radial springs, the foundation of the paper.

    Parameters
    ----------
    modulus : Modulus
        Function from a joint to the foundation modulus K in MPa/mm; the paper's fit by default.
    """

    modulus: Modulus = hess_forsbach

    edge_exponent: ClassVar[float] = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "modulus", as_modulus(self.modulus))

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        diagonal = numpy.eye(grid.rings) / float(self.modulus(joint))
        return numpy.broadcast_to(diagonal, (grid.max_harmonic + 1, *diagonal.shape))

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> EdgeRelation:
        return spring_edges(float(self.modulus(joint)), grid)


def initial_displacement(bore: Any, modulus: float, depth: Numbers, force: Numbers, axes: Numbers) -> Numbers:
    """Estimate displacements (n, 3) in mm along the loads, from springs in a full sphere at the largest wear depth.

    `bore` has a clearance and a socket_radius in mm. The modulus of the foundation is that of the bore under uniform
    pressure, in MPa/mm. `depth` is that of the worn bore below its sphere, in mm. The loads have magnitudes (n,) in N
    and unit vectors (n, 3).
    """
    clearance = max(bore.clearance, 0.0)
    indentation = linear_indentation(bore.socket_radius, clearance, modulus, force)
    return axes * (clearance + indentation + float(depth.max(initial=0.0)))[:, None]
