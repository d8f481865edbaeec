"""A body condensed onto its contact surface: factored once, with the unknowns of the contact last.

The places of a structured block are put in order by nested dissection, which needs no graph here: halve the longer side
and keep the line between the halves for later. With the contact's normal displacements at the very end, the last block
of the factors is the factored Schur complement: the stiffness that the contact feels.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy
from scipy.sparse.linalg import splu

from ...core.arrays import Numbers
from .elasticity import ElasticBlock

_LEAF = 24  # places in a part that is not halved any more


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedBody:
    """An elastic block with supports, and normal loads on its contact surface.

    Parameters
    ----------
    elastic : ElasticBlock
    held : array of bool (unknowns,)
        Unknowns that are zero.
    contact : array (nodes,)
        Nodes of the contact surface, from the pole on.
    """

    elastic: ElasticBlock
    held: Numbers
    contact: Numbers

    @property
    def normals(self) -> Numbers:
        """The unknowns that the contact loads."""
        return 2 * self.contact + 1

    @cached_property
    def _order(self) -> Numbers:
        """The free unknowns, those of the contact last."""
        block = self.elastic.block
        grid = numpy.arange(len(block.angle) * (block.place[-1] + 1)).reshape(len(block.angle), -1)
        rank = numpy.empty(grid.size, dtype=int)
        rank[nested_dissection(grid, block.order)] = numpy.arange(grid.size)
        of_node = rank[grid[:, block.place]].ravel()
        free = numpy.unique(self.elastic.unknowns)
        free = free[~self.held[free] & ~numpy.isin(free, self.normals)]
        return numpy.concatenate([free[numpy.argsort(of_node[free // 2], kind="stable")], self.normals])

    def _factors(self) -> Any:
        ordered = self.elastic.matrix()[self._order][:, self._order].tocsc()
        return splu(ordered, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    def compliance(self) -> Numbers:
        """Normal displacements of the contact's nodes by normal forces on them."""
        factors, count = self._factors(), len(self.contact)
        stiffness = factors.L[-count:, -count:].toarray() @ factors.U[-count:, -count:].toarray()
        return numpy.linalg.inv((stiffness + stiffness.T) / 2)

    def displacements(self, forces: Numbers) -> Numbers:
        """u_φ and u_r of all nodes, shape (nodes, 2), by normal forces on the contact's nodes."""
        load = numpy.zeros(len(self._order))
        load[-len(self.contact) :] = forces
        whole = numpy.zeros(len(self.held))
        whole[self._order] = self._factors().solve(load)
        for column in self.elastic.block.sliding:
            number = self.elastic.block.number
            whole[2 * number[:, column + 1] + 1] = whole[2 * number[:, column] + 1]
        return whole.reshape(-1, 2)


def nested_dissection(part: Numbers, order: int, start: tuple[int, int] = (0, 0)) -> Numbers:
    """The places of a grid in nested dissection order; only lines between elements separate what lies beside them.

    `start` is where the part begins in the whole grid.
    """
    if part.size <= _LEAF or min(part.shape) <= 2:
        return part.ravel()
    along = 0 if part.shape[0] >= part.shape[1] else 1
    lines = part if along == 0 else part.T
    middle = len(lines) // 2
    middle += (start[along] + middle) % order  # counted in the whole block
    beyond = (start[0] + middle + 1, start[1]) if along == 0 else (start[0], start[1] + middle + 1)
    first, second = (half if along == 0 else half.T for half in (lines[:middle], lines[middle + 1 :]))
    return numpy.concatenate(
        [nested_dissection(first, order, start), nested_dissection(second, order, beyond), lines[middle]]
    )
