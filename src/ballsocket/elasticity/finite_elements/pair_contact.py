"""Contact on one pair of surfaces: with its edge inside the socket, or filling the bore up to its end.

The pressure is that of the `SurfacePair`, with hat functions φ_i up to the node φ_k, three or four elements before
the edge. From there it decreases as in the exact solution, with t = sqrt((ε - φ)/(ε - φ_k)) like p_k t + q (t - t³).
The gap is closed in the mean, weighted with each of these functions. One more weight is the slope of t in ε, which is
singular at the edge like the pressure of a contact of the wrong size. It belongs to no pressure and so determines the
indentation. There is no penalty. If all pressures are positive and no gap is negative, the complementarity conditions
of contact hold.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy

from ...core.arrays import Numbers, gauss_legendre
from ...problem.gaps import Gap
from .bodies import SurfacePair

_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(6))
_INDENTATION_TOLERANCE = 1e-13  # relative
_SKIPPED_NODES, _FITTED_NODES = 2, 5  # beyond an edge, which is extrapolated from them
_POLE_FRACTION = 0.35  # fraction of the contact whose pressures determine the one at the pole, by an even polynomial


class PairContact(ABC):
    """Quantities of a contact on a surface pair that follow from its pressures."""

    pair: SurfacePair
    gap: Gap
    half_angle: float  # ε in rad
    indentation: float  # d in mm

    @property
    @abstractmethod
    def nodal_pressures(self) -> Numbers:
        """Pressures in MPa of the nodes from the pole on."""

    @abstractmethod
    def integrate_pressure(self, function: Callable[[Numbers], Numbers]) -> float:
        """Integrate the pressure times a function of the polar angle over the contact area."""

    @cached_property
    def force(self) -> float:
        """Force F in N."""
        return self.integrate_pressure(numpy.cos)

    @property
    def strain_energy(self) -> float:
        """Strain energy ½ ∫ p u dA in N mm."""
        return self.integrate_pressure(lambda angle: self.gap.displacement(angle, self.indentation)) / 2

    @property
    def pressure_integral(self) -> float:
        """Integral of the pressure over the contact area, ∫ p dA, in N."""
        return self.integrate_pressure(numpy.ones_like)

    @property
    def tension(self) -> float:
        """Largest tension as a fraction of the pole pressure; negative if all pressures are positive."""
        return float(-self.nodal_pressures.min() / self.pole_pressure)

    @cached_property
    def pole_pressure(self) -> float:
        """Pressure p0 at the pole in MPa, extrapolated because the node at the pole has almost no area."""
        pressures = self.nodal_pressures
        return pressure_at_pole(self.pair.angle[: len(pressures)], pressures, self.half_angle)


@dataclass(frozen=True, kw_only=True, eq=False)
class PartialContact(PairContact):
    """Contact of half angle ε (rad) on a surface pair; `last` is the node k before the edge functions."""

    fills_bore: ClassVar[bool] = False

    pair: SurfacePair
    gap: Gap
    half_angle: float
    last: int

    # --- edge functions of the pressure: a hat that decreases like t, and t - t³ ---

    @cached_property
    def _edge_functions(self) -> tuple[Numbers, Numbers, Numbers, Numbers]:
        """Edge functions of the pressure at quadrature points, with angles, weights and slope.

        The arrays are angles in rad, weights of ∫ dA in mm², edge functions (2, angles), and the slope of t in ε.
        """
        previous, start = self.pair.angle[self.last - 1 : self.last + 1]
        # the first function increases between the last two nodes, then decreases to the edge
        rise_ends = self._corners_between(previous, start)
        rise_steps = numpy.diff(rise_ends)[:, None]
        rising_angle = (rise_ends[:-1, None] + rise_steps * _NODES).ravel()
        width = self.half_angle - start
        to_edge = self.half_angle - self._corners_between(start, self.half_angle)
        t_ends = numpy.sqrt(numpy.maximum(to_edge, 0.0) / width)[::-1]
        t_steps = numpy.diff(t_ends)[:, None]
        t = (t_ends[:-1, None] + t_steps * _NODES).ravel()  # φ = ε - width t²
        falling_angle = self.half_angle - width * t * t
        angle = numpy.concatenate([rising_angle, falling_angle])
        weights = numpy.concatenate([(rise_steps * _WEIGHTS).ravel(), (t_steps * _WEIGHTS).ravel() * 2 * width * t])
        zero = numpy.zeros_like(rising_angle)
        hat = numpy.concatenate([(rising_angle - previous) / (start - previous), t])
        shape = numpy.stack([hat, numpy.concatenate([zero, t - t**3])])
        slope = numpy.concatenate([zero, (1 / t - t) / (2 * width)])
        return angle, weights * self.pair.area(angle), shape, slope

    def _corners_between(self, start: float, end: float) -> Numbers:
        """Return the angles `start` and `end` and the corners of elements between them."""
        corners = self.pair.corners
        inside = corners[(corners > start + 1e-9) & (corners < end - 1e-9)]
        return numpy.concatenate([[start], inside, [end]])

    @cached_property
    def _edge_moments(self) -> tuple[Numbers, Numbers]:
        """Mean displacements per pressure function: weighted with the edge functions, and with the slope of t."""
        angle, weights, shape, slope = self._edge_functions
        tail, edge = numpy.zeros((2, self.last + 2)), numpy.zeros(self.last + 2)
        for surface, displaced in zip(self.pair.surfaces, self.pair.displacements, strict=True):
            force = numpy.stack([surface.nodal_sums(angle, weights * function) for function in shape], axis=-1)
            steep = surface.nodal_sums(angle, weights * slope)
            moved = numpy.column_stack([displaced[:, : self.last], surface.compliance @ force])
            tail += force.T @ moved
            edge += steep @ moved
        return tail, edge

    # --- pressures by right-hand sides: moments of a gap with all functions ---

    @cached_property
    def _bordered_blocks(self) -> tuple[Numbers, Numbers, Numbers]:
        """Leading block of W, the border columns multiplied by it, and the Schur complement of the edge functions."""
        tail, _ = self._edge_moments
        W = self.pair.whitening[: self.last, : self.last]
        border = W @ tail[:, :-2].T
        return W, border, tail[:, -2:] - border.T @ border

    def _solve_pressures(self, side: Numbers) -> Numbers:
        W, border, pivot = self._bordered_blocks
        inner = W @ side[:-2]
        last = numpy.linalg.solve(pivot, side[-2:] - border.T @ inner)
        inner -= border @ last
        return numpy.append(W.T @ inner, last)

    def _right_hand_side(self, displacement: Numbers, edge_displacement: Numbers) -> Numbers:
        """Compute the right-hand side from displacements at the pair's points and at the edge points."""
        _, weights, shape, _ = self._edge_functions
        inside = self.pair.integrate_with_shapes(displacement)[: self.last]
        return numpy.append(inside, (weights * shape) @ edge_displacement)

    @cached_property
    def _slope_pressures(self) -> Numbers:
        """Pressures in MPa that displace the surfaces like a pressure equal to the slope of t by ε."""
        return self._solve_pressures(self._edge_moments[1])

    def _edge_residual(self, displacement: Numbers, edge_displacement: Numbers) -> float:
        """Compute the mean remaining gap, weighted with the slope of t by ε; the indentation makes it 0."""
        _, weights, _, slope = self._edge_functions
        side = self._right_hand_side(displacement, edge_displacement)
        return float((weights * slope) @ edge_displacement - self._slope_pressures @ side)

    def _ball_displacements(self, d: float) -> tuple[Numbers, Numbers]:
        """Compute the displacements in mm that a rigid ball imposes, at the pair's and at the edge points."""
        return self.gap.displacement(self.pair.points[0], d), self.gap.displacement(self._edge_functions[0], d)

    # --- results ---

    @cached_property
    def indentation(self) -> float:  # type: ignore[override]
        """Indentation d in mm for this half angle, by the secant method (one step for the linear gap).

        NaN for a contact that is wider than the perfect fit.
        """
        d, step = 0.0, 1e-3 * self.pair.radius * self.half_angle**2
        residual = self._edge_residual(*self._ball_displacements(d))
        for _ in range(self.gap.steps + 1):
            next_residual = self._edge_residual(*self._ball_displacements(d + step))
            if next_residual == residual:
                break
            secant_step = -residual * step / (next_residual - residual)  # from d to the root of the secant
            d, residual, step = d + step, next_residual, secant_step - step
            if abs(step) <= _INDENTATION_TOLERANCE * abs(d):
                break
        return d + step if d + step > 0 else numpy.nan

    @cached_property
    def pressures(self) -> Numbers:
        """Pressures p_0 .. p_k of the nodes and q of the second edge function, in MPa."""
        return self._solve_pressures(self._right_hand_side(*self._ball_displacements(self.indentation)))

    @property
    def nodal_pressures(self) -> Numbers:
        return self.pressures[:-1]

    def integrate_pressure(self, function: Callable[[Numbers], Numbers]) -> float:
        side = self._right_hand_side(function(self.pair.points[0]), function(self._edge_functions[0]))
        return float(self.pressures @ side)

    @property
    def edge_element(self) -> float:
        """Length in rad of the elements at the edge."""
        return float(self.pair.angle[self.last] - self.pair.angle[self.last - 1])

    @property
    def overlap(self) -> float:
        """Largest overlap of the bodies beyond the contact, as a fraction of the indentation; negative for a gap."""
        beyond = slice(self.last + 3, None)
        imposed = self.pair.integrate_with_shapes(self._ball_displacements(self.indentation)[0])[beyond]
        elastic = sum(
            hats[:, beyond].T @ (surface.compliance @ self.forces(index))
            for index, (surface, hats) in enumerate(zip(self.pair.surfaces, self.pair.forces, strict=True))
        )
        area = self.pair.integrate_with_shapes(numpy.ones_like(self.pair.points[0]))[beyond]
        return float(numpy.max((imposed - elastic) / area, initial=-numpy.inf) / self.indentation)

    def forces(self, surface: int) -> Numbers:
        """Compute normal forces in N on the nodes of a surface: 0 is the socket, 1 the ball."""
        angle, weights, shape, _ = self._edge_functions
        edge_forces = self.pair.surfaces[surface].nodal_sums(angle, weights * (self.pressures[-2:] @ shape))
        return self.pair.forces[surface][:, : self.last] @ self.pressures[:-2] + edge_forces

    def pressure(self, angle: Numbers) -> Numbers:
        """Compute the contact pressure p(φ) in MPa at polar angles (rad); 0 outside the contact."""
        nodes = self.pair.angle[: self.last + 1]
        inside = numpy.interp(angle, nodes, numpy.append(self.pole_pressure, self.nodal_pressures[1:]))
        t = numpy.sqrt(numpy.clip((self.half_angle - angle) / (self.half_angle - nodes[-1]), 0.0, 1.0))
        return numpy.where(angle <= nodes[-1], inside, self.pressures[-2] * t + self.pressures[-1] * (t - t**3))


def edge_beyond(last: int, angle: Numbers, gap: Numbers) -> float:
    """Compute the half angle in rad from the gaps at the angles after the `last` closed one; see `edge_angle`."""
    nodes = numpy.arange(last + 1, len(angle))
    if len(nodes) == 0:
        return float(angle[-1])
    nodes = nodes[_SKIPPED_NODES if len(nodes) > _SKIPPED_NODES + 2 else 0 :][:_FITTED_NODES]
    opening = gap[nodes] ** (2 / 3)
    return float(numpy.polynomial.Polynomial.fit(opening, angle[nodes], min(2, len(nodes) - 1))(0.0))


def pressure_at_pole(angle: Numbers, pressures: Numbers, half_angle: float) -> float:
    """Extrapolate the pressure at the pole in MPa by an even polynomial through the nodes around it."""
    count = max(int(numpy.searchsorted(angle, _POLE_FRACTION * half_angle)), 4)
    degree = 1 if count < 5 else 2
    return float(numpy.polynomial.polynomial.polyfit(angle[1:count] ** 2, pressures[1:count], degree)[0])


def partial_contact(pair: SurfacePair, gap: Gap, half_angle: float) -> PartialContact:
    """Make the contact of a half angle (rad), with edge functions three to four elements wide."""
    last = max(int(numpy.searchsorted(pair.angle, half_angle, side="right")) - 4, 1)
    return PartialContact(pair=pair, gap=gap, half_angle=half_angle, last=last)


@dataclass(frozen=True, kw_only=True, eq=False)
class FullContact(PairContact):
    """Contact that fills the bore, at an indentation in mm."""

    fills_bore: ClassVar[bool] = True

    pair: SurfacePair
    gap: Gap
    indentation: float

    @property
    def half_angle(self) -> float:  # type: ignore[override]
        """Polar angle of the bore's end in rad."""
        return float(self.pair.angle[-1])

    @cached_property
    def pressures(self) -> Numbers:
        """Nodal pressures in MPa at the pair's angles."""
        displacement = self.pair.integrate_with_shapes(self.gap.displacement(self.pair.points[0], self.indentation))
        return self.pair.whitening.T @ (self.pair.whitening @ displacement)

    @property
    def nodal_pressures(self) -> Numbers:
        return self.pressures

    def integrate_pressure(self, function: Callable[[Numbers], Numbers]) -> float:
        return float(self.pressures @ self.pair.integrate_with_shapes(function(self.pair.points[0])))

    @property
    def overlap(self) -> float:
        """Overlap of the bodies beyond the contact, minus infinity because the bore ends there."""
        return -numpy.inf

    @property
    def edge_element(self) -> float:
        """Length of the elements at the edge in rad, 0 because the edge is the end of the bore."""
        return 0.0

    @property
    def stiffness(self) -> float:
        """Tangent stiffness dF/dd in N/mm."""
        step = 1e-4 * self.indentation  # the force is linear in the indentation, or nearly (circular gap)
        sides = (replace(self, indentation=self.indentation + sign * step).force for sign in (0.5, -0.5))
        return (next(sides) - next(sides)) / step

    def forces(self, surface: int) -> Numbers:
        """Compute normal forces in N on the nodes of a surface: 0 is the socket, 1 the ball."""
        return self.pair.forces[surface] @ self.pressures

    def pressure(self, angle: Numbers) -> Numbers:
        """Compute the contact pressure p(φ) in MPa at polar angles (rad); 0 beyond the rim."""
        nodes = self.pair.angle
        inside = numpy.interp(angle, nodes, numpy.append(self.pole_pressure, self.pressures[1:]))
        return numpy.where(angle <= nodes[-1], inside, 0.0)
