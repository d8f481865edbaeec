"""Edge of a contact between cells: the line of zero pressure and zero gap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ...core.arrays import Numbers
from ...problem import Joint
from .grid import Grid

_INSET = 0.113
"""Distance from a cell's middle to the contact's edge at the first load of the cell, as a share of its width."""

_GAP_TO_PRESSURE = 2 / 3
"""Factor k of the edge between two cells, which balances p w of the last loaded cell and k E* g of the first open cell.

Both constants are fitted to a Hertz line contact on a half-plane in equal cells, at 40 positions of its edge. Their
error of the edge is 0.01 cells.
"""


@dataclass(frozen=True, kw_only=True, eq=False)
class Edges:
    """Relation of pressure and gap at the edge of a contact, and the kind of the bore's end.

    Attributes
    ----------
    compliance : array (rings, 1)
        Gap in mm of an open cell that is equivalent to 1 MPa in a loaded cell.
    inset : float
        Distance of the edge inside a cell's middle at the first load of that cell, as a share of a ring's width.
    bounded : bool
        True if the pressure stays finite in a contact that reaches the end of the bore.
    """

    compliance: Numbers
    inset: float
    bounded: bool

    def levels(self, pressure: Numbers, gap: Numbers) -> Numbers:
        """Compute levels in mm (..., rings, meridians) from pressures in MPa and gaps in mm."""
        return numpy.where(pressure > 0, pressure * self.compliance, -numpy.maximum(gap, 0.0))


def elastic_edges(joint: Joint, grid: Grid, bounded: bool) -> Edges:
    """Return edges on elastic bodies: with the distance s, p falls as s^(1/2) and the gap opens as s^(3/2)."""
    bodies = [joint.liner] if joint.ball is None else [joint.liner, joint.ball]
    softness = sum((1 - float(body.poisson) ** 2) / float(body.young) for body in bodies)  # 1/E*
    width = numpy.diff(grid.edges)[:, None] * float(joint.socket_radius)
    return Edges(compliance=width * softness / _GAP_TO_PRESSURE, inset=_INSET, bounded=bounded)


def spring_edges(modulus: float, grid: Grid) -> Edges:
    """Return edges on springs: pressure and gap are the same linear function."""
    return Edges(compliance=numpy.full((grid.rings, 1), 1 / modulus), inset=0.0, bounded=True)
