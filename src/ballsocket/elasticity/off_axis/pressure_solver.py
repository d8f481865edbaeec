"""Frictionless contact: pressures in every cell that close the gap or vanish where it is open.

The stored energy is minimised under p >= 0 by conjugate gradients. They drop cells that would pull and add cells that
would overlap (Polonsky & Keer 1999, doi 10.1016/S0043-1648(99)00113-1). The preconditioner is the stiffness of a bore
under pressure everywhere, which is known exactly for each harmonic. Contacts of one joint are solved in a batch. Steps
have single precision; convergence is checked in double precision.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy

from ...core.arrays import Numbers
from .compliance import Compliance

TOLERANCE = 1e-6
"""Largest complementarity residual: gap in the contact or overlap outside, over the largest undeformed overlap."""

_MAX_ITERATIONS = 200

_MIN_SINGLE_RESIDUAL = 1e-5  # tolerance of the overlap below which convergence is checked in double precision
_MIN_SINGLE_TOLERANCE = 1e-3  # tolerance of pressure changes below which they are computed in double precision


@dataclass(frozen=True, kw_only=True, eq=False)
class PressureSolution:
    """Solved pressures of a batch of contacts."""

    pressure: Numbers  # (batch, rings, meridians), pressure in MPa
    converged: Numbers  # bool (batch,), True where the tolerance was reached
    # (batch,), stored energy on a unit sphere in MPa mm; its relative error is the square of the tolerance
    energy: Numbers
    iterations: int  # number of iterations of the slowest contact


def solve_pressure(
    compliance: Compliance, overlap: Numbers, start: Numbers | None = None, tolerance: Numbers | float = TOLERANCE
) -> PressureSolution:
    """Solve the frictionless contact: pressures that close the gap in the contact, with a gap elsewhere.

    Overlaps of the undeformed surfaces (batch, rings, meridians) are in mm, negative in a gap, and initial pressures in
    MPa, at least 0. The tolerance (batch,) limits the relative complementarity residual.
    """
    if start is None:
        stiff = compliance.stiffness(numpy.maximum(overlap, 0.0))
        start = numpy.where(overlap > 0, numpy.maximum(stiff, 0.0), 0.0)
    tolerances = numpy.broadcast_to(tolerance, len(overlap))
    pressure, converged = numpy.zeros_like(overlap), numpy.zeros(len(overlap), dtype=bool)
    energy = numpy.zeros(len(overlap))
    active = numpy.flatnonzero(overlap.max(axis=(1, 2)) > 0)
    converged[overlap.max(axis=(1, 2)) <= 0] = True
    iteration = _ConjugateGradients(compliance, overlap[active], start[active])
    for number in range(_MAX_ITERATIONS):
        finished = iteration.check_convergence(tolerances[active])
        if finished.any() or number == _MAX_ITERATIONS - 1:
            pressure[active], converged[active], energy[active] = iteration.pressure, finished, iteration.energy
            active = active[~finished]
            iteration.select_contacts(~finished)
        if not len(active):
            break
        iteration.advance_pressures()
    return PressureSolution(pressure=pressure, converged=converged, energy=energy, iterations=number)


class _ConjugateGradients:
    """State of the conjugate-gradient iteration for a batch of contacts."""

    def __init__(self, compliance: Compliance, overlap: Numbers, pressure: Numbers) -> None:
        self.compliance, self.overlap, self.pressure = compliance, overlap, pressure
        self.max_overlap = overlap.max(axis=(1, 2), initial=0.0)
        self.displacement = compliance.single_precision_softness(pressure)
        self.is_single = numpy.ones(len(overlap), dtype=bool)
        self.direction = self.previous_residual = numpy.zeros_like(overlap, dtype=numpy.float32)
        self.descent = numpy.full(len(overlap), numpy.inf)
        self._update_residual()

    def _update_residual(self) -> None:
        """Compute the remaining overlap of cells that are loaded or overlap, and its largest relative value."""
        remaining = self.overlap - self.displacement
        self.touching = self.pressure > 0
        self.residual = numpy.where(self.touching | (remaining > 0), remaining, 0.0).astype(numpy.float32)
        self.relative_residual = abs(self.residual).max(axis=(1, 2), initial=0.0) / self.max_overlap

    @property
    def energy(self) -> Numbers:
        """Stored energy of each contact on a unit sphere in MPa mm.

        It is ∫ p u - ∫ p S p/2, with the compliance S, which is largest at the solution.
        """
        return self.compliance.grid.integrate_product(self.pressure, self.overlap + self.residual) / 2

    def check_convergence(self, tolerance: Numbers) -> Numbers:
        """Return True for contacts within their tolerances (batch,); strict ones are checked in double precision."""
        doubtful = self.is_single & (tolerance < _MIN_SINGLE_RESIDUAL) & (self.relative_residual <= tolerance)
        if doubtful.any():
            self.displacement[doubtful] = self.compliance.softness(self.pressure[doubtful])
            self.is_single &= ~doubtful
            self._update_residual()
        return self.relative_residual <= tolerance

    def select_contacts(self, mask: Numbers) -> None:
        """Continue the iteration with only the contacts in a mask (batch,)."""
        if mask.all():
            return
        names = ("overlap", "pressure", "max_overlap", "displacement", "is_single", "direction", "previous_residual")
        for name in (*names, "descent", "touching", "residual", "relative_residual"):
            setattr(self, name, getattr(self, name)[mask])

    def advance_pressures(self) -> None:
        """Make one conjugate-gradient step, and set negative pressures to 0."""
        integrate = self.compliance.grid.integrate_product
        gradient = numpy.where(self.residual != 0, self.compliance.stiffness(self.residual), 0)
        gradient = numpy.where(self.touching, gradient, numpy.maximum(gradient, 0))
        factor = numpy.maximum(integrate(self.residual - self.previous_residual, gradient) / self.descent, 0.0)
        self.descent = integrate(self.residual, gradient)
        self.direction = numpy.where(self.residual != 0, gradient + factor[:, None, None] * self.direction, 0)
        response = self.compliance.single_precision_softness(self.direction)
        length = (integrate(self.residual, self.direction) / integrate(self.direction, response))[:, None, None]
        self.previous_residual = self.residual
        pressure = self.pressure + length * self.direction
        self.displacement = self.displacement + length * response
        pulling = (pressure < 0).any(axis=(1, 2))
        self.pressure = numpy.maximum(pressure, 0.0)
        if pulling.any():
            self.displacement[pulling] = self.compliance.single_precision_softness(self.pressure[pulling])
        self.is_single[:] = True
        self._update_residual()


def solve_pressure_change(
    compliance: Compliance,
    share: Numbers,
    overlap: Numbers,
    start: Numbers | None = None,
    tolerance: float = 1e-3,
    edge_compliance: Numbers | float = 1.0,
) -> Numbers:
    """Solve the change of pressure in MPa in a fixed set of cells in contact, under an additional overlap in mm.

    All fields are (batch, rings, meridians). `coupled_search.solve_change` explains the shares of the cells in contact
    and the compliance (mm/MPa) of a ring next to it. The tolerance limits the relative residual in the energy norm.
    """
    integrate = compliance.grid.integrate_product
    single = tolerance > _MIN_SINGLE_TOLERANCE
    displacement = compliance.single_precision_softness if single else compliance.softness
    root = numpy.sqrt(share, dtype=numpy.float32 if single else float)
    open_part = 1 - root * root
    open_compliance, open_stiffness = open_part * edge_compliance, open_part / edge_compliance
    target = overlap * root

    def precondition(residual: Numbers) -> Numbers:
        return root * compliance.stiffness(root * residual) + open_stiffness * residual

    change = precondition(target) if start is None else root * start
    residual = target - root * displacement(root * change) - open_compliance * change
    scale = abs(integrate(target, change))
    direction, descent = numpy.zeros_like(change), numpy.full(len(change), numpy.inf)
    for _ in range(_MAX_ITERATIONS):
        gradient = precondition(residual)
        next_descent = integrate(residual, gradient)
        if (next_descent <= tolerance**2 * scale).all():
            break
        direction = gradient + _divide_or_zero(next_descent, descent)[:, None, None] * direction
        response = root * displacement(root * direction) + open_compliance * direction
        length = _divide_or_zero(next_descent, integrate(direction, response))[:, None, None]
        change, residual, descent = change + length * direction, residual - length * response, next_descent
    return root * change


def _divide_or_zero(numerator: Numbers, denominator: Numbers) -> Numbers:
    return numpy.divide(numerator, denominator, out=numpy.zeros_like(numerator), where=denominator > 0)
