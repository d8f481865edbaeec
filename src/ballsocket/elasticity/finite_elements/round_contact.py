"""One contact of a given half angle: the pressure that closes the gap, and the indentation at which it ends just there.

The pressure is that of the `SurfacePair`, with hats φ_i up to the node φ_k, three or four elements before the edge. From
there it falls as it does in truth, with t = sqrt((ε - φ)/(ε - φ_k)) like p_k t + q (t - t³). The gap is closed in the
mean, weighted with each of these shapes. One more weight, the slope of t in ε, which is singular at the edge like the
pressure of a contact of the wrong size, belongs to no pressure and so says what the indentation must be. There is no
penalty, and where all pressures are positive and no gap is negative the complementarity conditions of contact hold.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy

from ...core.arrays import Numbers, gauss_legendre
from ...problem.gaps import Gap
from .surfaces import SurfacePair

_NODES, _WEIGHTS = (numpy.array(part) for part in gauss_legendre(6))
_NEWTON = 1e-13  # of the indentation
_POLE = 0.35
"""Share of the contact whose pressures give the one at the pole, by an even polynomial."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PartialContact:
    """A contact of half angle ε (rad) on a pair; `last` is the node k from which the pressure falls to the edge."""

    pair: SurfacePair
    gap: Gap
    half_angle: float
    last: int

    # --- the last two shapes of the pressure: a hat that falls like t, and t - t³ ---

    @cached_property
    def _tail(self) -> tuple[Numbers, Numbers, Numbers, Numbers]:
        """Angles, weights of ∫ dA, the last shapes (2, angles), and the slope of t in ε."""
        before, here = self.pair.angle[self.last - 1 : self.last + 1]
        rise = self._between(before, here)
        widths = numpy.diff(rise)[:, None]
        up = (rise[:-1, None] + widths * _NODES).ravel()
        width = self.half_angle - here
        t_ends = numpy.sqrt(numpy.maximum(self.half_angle - self._between(here, self.half_angle), 0.0) / width)[::-1]
        steps = numpy.diff(t_ends)[:, None]
        t = (t_ends[:-1, None] + steps * _NODES).ravel()  # φ = ε - width t²
        down = self.half_angle - width * t * t
        angle = numpy.concatenate([up, down])
        weights = numpy.concatenate([(widths * _WEIGHTS).ravel(), (steps * _WEIGHTS).ravel() * 2 * width * t])
        zero = numpy.zeros_like(up)
        shape = numpy.stack(
            [numpy.concatenate([(up - before) / (here - before), t]), numpy.concatenate([zero, t - t**3])]
        )
        slope = numpy.concatenate([numpy.zeros_like(up), (1 / t - t) / (2 * width)])
        return angle, weights * self.pair.area(angle), shape, slope

    def _between(self, start: float, end: float) -> Numbers:
        corners = self.pair.corners
        inside = corners[(corners > start + 1e-9) & (corners < end - 1e-9)]
        return numpy.concatenate([[start], inside, [end]])

    @cached_property
    def _moments(self) -> tuple[Numbers, Numbers]:
        """What all shapes as pressures do to the mean displacement: under the last two (2, shapes), under the slope."""
        angle, weights, shape, slope = self._tail
        tail, edge = numpy.zeros((2, self.last + 2)), numpy.zeros(self.last + 2)
        for surface, displaced in zip(self.pair.surfaces, self.pair.displaced, strict=True):
            force = numpy.stack([surface.gathered(angle, weights * one) for one in shape], axis=-1)
            steep = surface.gathered(angle, weights * slope)
            moved = numpy.column_stack([displaced[:, : self.last], surface.compliance @ force])
            tail += force.T @ moved
            edge += steep @ moved
        return tail, edge

    # --- pressures by right-hand sides: moments of a gap with all shapes ---

    @cached_property
    def _borders(self) -> tuple[Numbers, Numbers, Numbers]:
        """The leading block of W, the borders in its terms, and the pivots of the last shapes."""
        tail, _ = self._moments
        W = self.pair.whitening[: self.last, : self.last]
        border = W @ tail[:, :-2].T
        return W, border, tail[:, -2:] - border.T @ border

    def _pressed(self, side: Numbers) -> Numbers:
        """Pressures p_0 .. p_k and q that meet a right-hand side (shapes,)."""
        W, border, pivot = self._borders
        inner = W @ side[:-2]
        last = numpy.linalg.solve(pivot, side[-2:] - border.T @ inner)
        inner -= border @ last
        return numpy.append(W.T @ inner, last)

    def _side(self, asked: Numbers, asked_tail: Numbers) -> Numbers:
        """The right-hand side of a gap that is given at the pair's points and those of the tail."""
        _, weights, shape, _ = self._tail
        return numpy.append(self.pair.weighted(asked)[: self.last], (weights * shape) @ asked_tail)

    @cached_property
    def _undoing(self) -> Numbers:
        """The pressures that undo what the slope would do as a pressure."""
        return self._pressed(self._moments[1])

    def _unclosed(self, asked: Numbers, asked_tail: Numbers) -> float:
        """What is left of a gap in the mean weighted with the slope."""
        _, weights, _, slope = self._tail
        return float((weights * slope) @ asked_tail - self._undoing @ self._side(asked, asked_tail))

    def _sides(self, d: float) -> tuple[Numbers, Numbers]:
        """What a rigid ball at an indentation asks for, at the pair's points and those of the tail."""
        return self.gap.displacement(self.pair.points[0], d), self.gap.displacement(self._tail[0], d)

    @cached_property
    def _cosines(self) -> tuple[Numbers, Numbers]:
        return numpy.cos(self.pair.points[0]), numpy.cos(self._tail[0])

    # --- what is asked ---

    @cached_property
    def indentation(self) -> float:
        """d in mm at which the contact ends here, by the secant method (a straight line for the linear gap).

        NaN where there is none: the contact is wider than the perfect fit's.
        """
        d, step = 0.0, 1e-3 * self.pair.radius * self.half_angle**2
        miss = self._unclosed(*self._sides(d))
        for _ in range(self.gap.steps + 1):
            ahead = self._unclosed(*self._sides(d + step))
            if ahead == miss:
                break
            move = -miss * step / (ahead - miss)
            d, miss, step = d + step, ahead, move - step
            if abs(step) <= _NEWTON * abs(d):
                break
        return d + step if d + step > 0 else numpy.nan

    @cached_property
    def pressures(self) -> Numbers:
        """p_0 .. p_k and q in MPa."""
        return self._pressed(self._side(*self._sides(self.indentation)))

    @cached_property
    def force(self) -> float:
        """F in N."""
        return float(self.pressures @ self._side(*self._cosines))

    @property
    def strain_energy(self) -> float:
        """Half of ∫ p u dA in N mm."""
        return float(self.pressures @ self._side(*self._sides(self.indentation))) / 2

    @property
    def pressure_integral(self) -> float:
        """∫ p dA in N."""
        return float(self.pressures @ self._side(*(numpy.ones_like(part) for part in self._cosines)))

    @property
    def tension(self) -> float:
        """The largest pull over the pressure at the pole; negative where everything presses."""
        return float(-self.pressures[:-1].min() / self.pole_pressure)

    @property
    def edge_element(self) -> float:
        """Length in rad of the elements at the edge."""
        return float(self.pair.angle[self.last] - self.pair.angle[self.last - 1])

    @property
    def overlap(self) -> float:
        """How far the bodies overlap beyond the contact in the mean, over the indentation; negative is a gap."""
        beyond = slice(self.last + 3, None)
        asked = self.pair.weighted(self._sides(self.indentation)[0])[beyond]
        given = sum(
            hats[:, beyond].T @ (surface.compliance @ self.forces(index))
            for index, (surface, hats) in enumerate(zip(self.pair.surfaces, self.pair.forces, strict=True))
        )
        area = self.pair.weighted(numpy.ones_like(self.pair.points[0]))[beyond]
        return float(numpy.max((asked - given) / area, initial=-numpy.inf) / self.indentation)

    def forces(self, surface: int) -> Numbers:
        """Normal forces on the nodes of one of the surfaces, in N."""
        angle, weights, shape, _ = self._tail
        tail = self.pair.surfaces[surface].gathered(angle, weights * (self.pressures[-2:] @ shape))
        return self.pair.forces[surface][:, : self.last] @ self.pressures[:-2] + tail

    def pressure(self, angle: Numbers) -> Numbers:
        """p(φ) in MPa, 0 outside the contact."""
        nodes = self.pair.angle[: self.last + 1]
        inside = numpy.interp(angle, nodes, numpy.append(self.pole_pressure, self.pressures[1:-1]))
        t = numpy.sqrt(numpy.clip((self.half_angle - angle) / (self.half_angle - nodes[-1]), 0.0, 1.0))
        return numpy.where(angle <= nodes[-1], inside, self.pressures[-2] * t + self.pressures[-1] * (t - t**3))

    @cached_property
    def pole_pressure(self) -> float:
        """p0 in MPa: even around the pole, since the pole's own node stands for hardly any area."""
        return pole(self.pair.angle[: self.last + 1], self.pressures[:-1], self.half_angle)


def pole(angle: Numbers, pressures: Numbers, half_angle: float) -> float:
    """The pressure at the pole by an even polynomial through the nodes around it."""
    near = max(int(numpy.searchsorted(angle, _POLE * half_angle)), 4)
    degree = 1 if near < 5 else 2
    return float(numpy.polynomial.polynomial.polyfit(angle[1:near] ** 2, pressures[1:near], degree)[0])


def partial_contact(pair: SurfacePair, gap: Gap, half_angle: float) -> PartialContact:
    """The contact of a half angle, its last shapes three to four elements wide."""
    last = max(int(numpy.searchsorted(pair.angle, half_angle, side="right")) - 4, 1)
    return PartialContact(pair=pair, gap=gap, half_angle=half_angle, last=last)
