"""The answer of the finite elements: a contact that knows its own error, its mesh, and the inside of both bodies."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, nan
from typing import TYPE_CHECKING, Any

import numpy

from ...contact.per_joint import Piece, SolvedContact, joint_at
from ...core.arrays import Array, Numbers, to_numpy
from ...core.stress import Peak
from ...core.validity import Status
from ...problem import Joint
from ...problem.cup import Cup
from .memory import MeshSize, mesh_size

if TYPE_CHECKING:
    from .section import Section
    from .tangent import Solved


@dataclass(frozen=True, kw_only=True, repr=False, eq=False)
class MeshedContact(SolvedContact):
    """A contact that knows, where it is a single one, its mesh, displacements and stresses.

    Attributes
    ----------
    error : dict
        By name the relative error of each quantity at the given load, estimated from two meshes; NaN from one.
    """

    model: Any

    @cached_property
    def section(self) -> Section:
        """Displacements and stresses in both bodies, by part, as in `section["liner"].stress.von_mises`.

        Raises
        ------
        ValueError
            More than one contact, or one without load or answer.
        """
        from .section import section

        return section(self._plain_joint, self.model.cup, self._solved)

    @property
    def von_mises_between(self) -> tuple[Array, Array]:
        """What `von_mises` lies between, as far as that is known at once; near a rim that is nothing."""
        least, most = super().von_mises_between
        return (least, most) if self.model.cup == Cup() else (0.0 * least, most + inf)

    def _von_mises_of(self, place: Numbers, piece: Piece) -> Numbers:
        from .section import section

        found = [
            nan
            if one is None
            else section(
                joint_at(self.joint, self.laws.shape, int(place[0])), self.model.cup, one
            ).peak_stress.von_mises
            for one in piece.state.solved
        ]
        return numpy.array(found, dtype=float)

    @property
    def peak_stress(self) -> Peak:
        """The largest von Mises stress in the liner, with its depth and polar angle, at the nodes of the mesh."""
        return self.section.peak_stress

    @property
    def rim_displacement(self) -> tuple[float, float]:
        """Displacement of the bore's end in mm, away from the load axis and up against the load."""
        return self.section.rim_displacement

    @property
    def mesh(self) -> MeshSize:
        """Elements and nodes of both bodies, and the elements' size at the contact, of a single contact."""
        pair = self._solved.pair
        return mesh_size(self._plain_joint, self.model.cup, pair.resolution, pair.ball_resolution)

    @property
    def _plain_joint(self) -> Joint:
        return self.joint.with_numbers([float(to_numpy(number).item()) for number in self.joint.numbers()])

    @property
    def _solved(self) -> Solved:
        solved: Solved | None = self.single_state.solved[0]
        if solved is None:
            raise ValueError("displacements and stresses need a contact that has an answer")
        return solved

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON, with the error estimates and, of a single contact, the size of its mesh."""
        single = self.laws.shape == () and not Status(self.status).failed and self.indentation > 0
        return {**super().summary(), **({"mesh": self.mesh.summary()} if single else {})}
