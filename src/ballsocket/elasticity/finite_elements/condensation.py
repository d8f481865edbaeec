"""Condensation of a body onto its contact surface.

The nodes of a structured block are ordered by nested dissection, which needs no graph here: halve the longer side and
place the line between the halves last. The contact's normal displacements come at the very end. The last block of the
factors is then the factored Schur complement, the stiffness at the contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy
from scipy.sparse.linalg import splu

from ...core.arrays import Numbers
from .elasticity import ElasticBlock

_MAX_LEAF_SIZE = 24  # nodes in a part that is not halved further


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedBody:
    """Elastic block with supports, and normal loads on its contact surface.

    Parameters
    ----------
    elastic : ElasticBlock
    fixed_unknowns : array of bool (unknowns,)
        Mask of the unknowns that the supports fix to zero.
    contact : array (nodes,)
        Nodes of the contact surface, from the pole outwards.
    """

    elastic: ElasticBlock
    fixed_unknowns: Numbers
    contact: Numbers

    @property
    def normal_unknowns(self) -> Numbers:
        """Indices of the unknowns that are normal displacements of contact nodes."""
        return 2 * self.contact + 1

    @cached_property
    def _elimination_order(self) -> Numbers:
        """Indices of the free unknowns in the order of elimination, those of the contact last."""
        block = self.elastic.block
        # the two nodes of a sliding interface share a grid point, and so a rank
        grid = numpy.arange(len(block.angle) * (block.level[-1] + 1)).reshape(len(block.angle), -1)
        rank = numpy.empty(grid.size, dtype=int)
        rank[nested_dissection(grid, block.order)] = numpy.arange(grid.size)
        node_rank = rank[grid[:, block.level]].ravel()
        free = numpy.unique(self.elastic.element_unknowns)
        free = free[~self.fixed_unknowns[free] & ~numpy.isin(free, self.normal_unknowns)]
        return numpy.concatenate([free[numpy.argsort(node_rank[free // 2], kind="stable")], self.normal_unknowns])

    def _factorize_stiffness(self) -> Any:
        """Compute the LU factors of the stiffness matrix in the order of elimination."""
        ordered = self.elastic.stiffness_matrix()[self._elimination_order][:, self._elimination_order].tocsc()
        return splu(ordered, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    def compliance(self) -> Numbers:
        """Compute the compliance matrix of the contact nodes: normal displacements by unit normal forces."""
        factors, count = self._factorize_stiffness(), len(self.contact)
        stiffness = factors.L[-count:, -count:].toarray() @ factors.U[-count:, -count:].toarray()
        return numpy.linalg.inv((stiffness + stiffness.T) / 2)

    def displacements(self, forces: Numbers) -> Numbers:
        """Compute the displacements u_φ and u_r of all nodes, (nodes, 2), under normal forces on contact nodes."""
        load = numpy.zeros(len(self._elimination_order))
        load[-len(self.contact) :] = forces
        solution = numpy.zeros(len(self.fixed_unknowns))
        solution[self._elimination_order] = self._factorize_stiffness().solve(load)
        for column in self.elastic.block.sliding:
            number = self.elastic.block.number
            solution[2 * number[:, column + 1] + 1] = solution[2 * number[:, column] + 1]
        return solution.reshape(-1, 2)


def nested_dissection(nodes: Numbers, order: int, start: tuple[int, int] = (0, 0)) -> Numbers:
    """Order the nodes of a grid by nested dissection along lines between elements.

    `start` is the index of the part's first node in the full grid.
    """
    if nodes.size <= _MAX_LEAF_SIZE or min(nodes.shape) <= 2:
        return nodes.ravel()
    along = 0 if nodes.shape[0] >= nodes.shape[1] else 1
    lines = nodes if along == 0 else nodes.T
    middle = len(lines) // 2
    middle += (start[along] + middle) % order  # counted in the full block
    second_start = (start[0] + middle + 1, start[1]) if along == 0 else (start[0], start[1] + middle + 1)
    first, second = (half if along == 0 else half.T for half in (lines[:middle], lines[middle + 1 :]))
    return numpy.concatenate(
        [nested_dissection(first, order, start), nested_dissection(second, order, second_start), lines[middle]]
    )
