"""What the socket's surface can be made of: springs, a closed shell, or the cup as it is built."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy

from ...core.arrays import Numbers
from ...models.modulus import Modulus, hess_forsbach
from ...problem import Joint
from ...problem.cup import Cup
from ..exact.modes import socket_of

if TYPE_CHECKING:
    from .edges import Edges
    from .grid import Grid


class Surface(Protocol):
    """How the bore gives way."""

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        """The mean displacement of cells by the pressure of cells, for each m, in mm/MPa: (m, rings, rings)."""
        ...

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> Edges:
        """Return the relation of pressure and gap at the edge of a contact."""
        ...


@dataclass(frozen=True, kw_only=True)
class RealCup:
    """The cup as it is built: its rim, arc of cover, chamfer, the layers behind it, by finite elements of its meridian.

    One stiffness for each harmonic about the cup's own axis, whatever direction the load has. What it takes a second
    to set up is kept on disk, for each R2/L, ν, arc of cover, chamfer and backing; Young's modulus scales it.
    """

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        from .real_cup import cup_rings

        return grid.averaged(cup_rings(joint, cup, grid))

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> Edges:
        from .edges import elastic_edges

        return elastic_edges(joint, grid, bounded=cup.chamfer == 0)


@dataclass(frozen=True, kw_only=True)
class ClosedShell:
    """A shell that is closed all around, as `Exact` has it: the rim ends the contact and nothing else."""

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        from .rings_of_modes import modal_rings

        return grid.averaged(modal_rings(socket_of(joint).compliance, grid))

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> Edges:
        from .edges import elastic_edges

        return elastic_edges(joint, grid, bounded=False)


@dataclass(frozen=True, kw_only=True)
class Springs:
    """Radial springs that know nothing of each other: the paper's foundation.

    Parameters
    ----------
    modulus : Modulus
        From a joint to K in MPa/mm; the paper's fit by default.
    """

    modulus: Modulus = hess_forsbach

    def rings(self, joint: Joint, cup: Cup, grid: Grid) -> Numbers:
        each = numpy.eye(grid.rings) / float(self.modulus(joint))
        return numpy.broadcast_to(each, (grid.degrees + 1, *each.shape))

    def edges(self, joint: Joint, cup: Cup, grid: Grid) -> Edges:
        from .edges import spring_edges

        return spring_edges(float(self.modulus(joint)), grid)
