"""Socket whose liner yields: its internal forces and tangent stiffness, condensed onto the bore.

The elastic stiffness is assembled once. A plastic strain is an initial strain of the deviator, which the elements do
not project, and their change of volume stays elastic and projected: Q2/P1 and Q1/P0 do not lock in plastic flow either.
Elements that yield in an increment correct the tangent, which is factored again; the others are those of the elastic
socket. Lengths are in units of the bore's radius, stresses in units of the liner's Young's modulus.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy
from scipy.sparse import csc_matrix

from ...core.arrays import Numbers
from ...problem.hardening import Hardening
from .bodies import CondensedBody, factorize, last_factors
from .elasticity import Gradients, element_quadrature
from .plasticity import PlasticStrain, YieldLaw

_LINER = 0  # index of the layer that yields


@dataclass(frozen=True, kw_only=True, eq=False)
class Tangent:
    """Factored tangent stiffness of the free unknowns, those of the bore last."""

    factors: Any
    count: int  # number of bore unknowns

    @cached_property
    def bore_compliance(self) -> Numbers:
        """Normal displacements of the bore's nodes by unit normal forces on them."""
        lower, upper = last_factors(self.factors, self.count)
        stiffness = lower @ upper
        return numpy.linalg.inv((stiffness + stiffness.T) / 2)


@dataclass(frozen=True, kw_only=True, eq=False)
class PlasticBody:
    """Socket with an elastic-plastic liner; `displacement` arguments are of the free unknowns, the bore's last."""

    body: CondensedBody
    hardening: Hardening  # in units of the liner's Young's modulus

    @cached_property
    def law(self) -> YieldLaw:
        return YieldLaw(shear=float(self.body.elastic.moduli[0][_LINER]), hardening=self.hardening)

    @cached_property
    def elements(self) -> Numbers:
        """Indices of the elements of the liner."""
        return numpy.flatnonzero(self.body.elastic.block.layers == _LINER)

    @cached_property
    def gradients(self) -> Gradients:
        """Strains of the liner's elements at their quadrature points."""
        return self.body.elastic.gradients(self.elements, element_quadrature(self.body.elastic.block.order)[0])

    @cached_property
    def volume(self) -> Numbers:
        """Volume of each quadrature point (elements, points)."""
        return self.gradients.volume * element_quadrature(self.body.elastic.block.order)[1]

    @cached_property
    def _rows(self) -> Numbers:
        """Deviator per unknown in the orthonormal basis: (elements, points, 3, unknowns)."""
        across, axial, shear, hoop = numpy.moveaxis(self.gradients.strain, 2, 0)
        parts = (across - axial) / numpy.sqrt(2), (2 * hoop - across - axial) / numpy.sqrt(6), shear / numpy.sqrt(2)
        return numpy.stack(parts, axis=2)

    @property
    def free_unknowns(self) -> Numbers:
        """Indices of the free unknowns in the order of elimination."""
        return self.body.free_unknowns

    @cached_property
    def _unknowns(self) -> Numbers:
        """Position of each unknown of the liner's elements among the free ones; their number if it is fixed."""
        position = numpy.full(len(self.body.fixed_unknowns), len(self.free_unknowns))
        position[self.free_unknowns] = numpy.arange(len(self.free_unknowns))
        return position[self.body.elastic.element_unknowns[self.elements]]

    @cached_property
    def _stiffness(self) -> csc_matrix:
        """Elastic stiffness of the free unknowns in order."""
        matrix = self.body.free_stiffness()
        matrix.sort_indices()
        return matrix

    @cached_property
    def _entries(self) -> Numbers:
        """Position in the stiffness' data of each entry of the liner's element matrices; the end for fixed unknowns."""
        size, K = len(self.free_unknowns), self._stiffness
        keys = numpy.repeat(numpy.arange(size), numpy.diff(K.indptr)) * size + K.indices
        rows, columns = self._unknowns[:, :, None], self._unknowns[:, None, :]
        positions = numpy.searchsorted(keys, columns * size + rows)
        return numpy.where((rows < size) & (columns < size), positions, len(keys))

    @cached_property
    def elastic_tangent(self) -> Tangent:
        """Tangent without plastic flow."""
        return self._factorize(self._stiffness)

    def _factorize(self, matrix: csc_matrix) -> Tangent:
        return Tangent(factors=factorize(matrix), count=len(self.body.contact))

    def strain(self, displacement: Numbers) -> Numbers:
        """Compute the strain deviators (elements, points, 3) of the liner."""
        u = numpy.append(displacement, 0.0)[self._unknowns]
        return numpy.einsum("eqsu,eu->eqs", self._rows, u, optimize=True)

    def internal_forces(self, displacement: Numbers, plastic: PlasticStrain) -> Numbers:
        """Compute the nodal forces of the stresses."""
        initial = 2 * self.law.shear * self.volume[..., None] * plastic.deviator
        forces = numpy.einsum("eqsu,eqs->eu", self._rows, initial, optimize=True)
        sums = numpy.bincount(self._unknowns.ravel(), weights=forces.ravel(), minlength=len(self.free_unknowns) + 1)
        return self._stiffness @ displacement - sums[:-1]

    def tangent(self, strain: Numbers, plastic: PlasticStrain, a: Numbers, b: Numbers) -> Tangent:
        """Compute the consistent tangent with the factors of `YieldLaw.update`."""
        flowing = numpy.flatnonzero((a < 1).any(axis=1))
        if not len(flowing):
            return self.elastic_tangent
        rows, weight = self._rows[flowing], 2 * self.law.shear * self.volume[flowing]
        stress = strain[flowing] - plastic.deviator[flowing]
        direction = stress / numpy.maximum(numpy.linalg.norm(stress, axis=-1, keepdims=True), 1e-300)
        along = (direction[..., None, :] @ rows)[..., 0, :]
        softening = numpy.sqrt(weight * (1 - a[flowing]))[..., None, None] * rows
        softening = softening.reshape(len(flowing), -1, rows.shape[-1])
        change = along.swapaxes(1, 2) @ ((weight * (b - a)[flowing])[..., None] * along)
        change -= softening.swapaxes(1, 2) @ softening
        data = numpy.bincount(self._entries[flowing].ravel(), weights=change.ravel(), minlength=self._stiffness.nnz + 1)
        K = self._stiffness
        return self._factorize(csc_matrix((K.data + data[:-1], K.indices, K.indptr), shape=K.shape))

    def _elastic_deviator(self, displacement: Numbers, plastic: PlasticStrain) -> Numbers:
        return self.strain(displacement) - plastic.deviator

    def von_mises(self, displacement: Numbers, plastic: PlasticStrain) -> Numbers:
        """Compute the von Mises stress at the quadrature points of the liner (elements, points)."""
        size = numpy.linalg.norm(self._elastic_deviator(displacement, plastic), axis=-1)
        return numpy.sqrt(1.5) * 2 * self.law.shear * size

    def elastic_energy(self, displacement: Numbers, plastic: PlasticStrain) -> float:
        """Compute the elastic energy ½ ∫ σ : (ε - ε_p) dV."""
        elastic = self._elastic_deviator(displacement, plastic)
        initial = 2 * self.law.shear * numpy.sum(self.volume * numpy.sum(elastic * plastic.deviator, axis=-1))
        return float(displacement @ self.internal_forces(displacement, plastic) - initial) / 2
