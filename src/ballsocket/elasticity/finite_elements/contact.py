"""Contact by finite elements, with its error estimates, its mesh and the sections of both bodies."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, nan
from typing import TYPE_CHECKING, Any

import numpy

from ...contact.per_joint import JointContacts, SolvedContact, joint_at
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
    """Contact with its mesh, displacements and stresses, available for a single load.

    Attributes
    ----------
    error : dict
        Relative error of each quantity by name at the applied load, estimated from two meshes; NaN with one mesh.
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
    def von_mises_bounds(self) -> tuple[Array, Array]:
        """Lower and upper bound of `von_mises` in MPa without a section; 0 and infinity near a rim."""
        lower, upper = super().von_mises_bounds
        return (lower, upper) if self.model.cup == Cup() else (0.0 * lower, upper + inf)

    def _joint_von_mises(self, index: Numbers, contacts: JointContacts) -> Numbers:
        """Compute the largest von Mises stress in the liner in MPa for the contacts of one joint."""
        from .section import section

        values = [
            nan
            if contact is None
            else section(
                joint_at(self.joint, self.laws.shape, int(index[0])), self.model.cup, contact
            ).peak_stress.von_mises
            for contact in contacts.state.solved
        ]
        return numpy.array(values, dtype=float)

    @property
    def peak_stress(self) -> Peak:
        """Largest von Mises stress in the liner in MPa at the nodes of the mesh, with its depth and polar angle."""
        return self.section.peak_stress

    @property
    def rim_displacement(self) -> tuple[float, float]:
        """Displacement of the end of the bore in mm: away from the load axis, and up against the load."""
        return self.section.rim_displacement

    @property
    def mesh(self) -> MeshSize:
        """Size of the mesh of a single contact: elements and nodes of both bodies, element size at the contact."""
        pair = self._solved.pair
        return mesh_size(self._plain_joint, self.model.cup, pair.resolution, pair.ball_resolution)

    @property
    def _plain_joint(self) -> Joint:
        """Joint with plain numbers."""
        return self.joint.with_numbers([float(to_numpy(number).item()) for number in self.joint.numbers()])

    @property
    def _solved(self) -> Solved:
        """Solved contact on its meshes; ValueError if the load has no solution."""
        solved: Solved | None = self.single_state.solved[0]
        if solved is None:
            raise ValueError("displacements and stresses need a contact with a solution")
        return solved

    def summary(self) -> dict[str, Any]:
        """Return the contact as a dictionary for JSON, with error estimates and the mesh size of a single contact."""
        single = self.laws.shape == () and not Status(self.status).failed and self.indentation > 0
        return {**super().summary(), **({"mesh": self.mesh.summary()} if single else {})}
