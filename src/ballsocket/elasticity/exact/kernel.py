"""Kernel of the contact equation.

In Abel space (see `abel`) the ball and the socket act through k(x) = Σ ρ_n cos((n + ½) x). ρ_n measures how far mode
n departs from a row of independent springs. Since ρ_n ~ Σ a_j (n + ½)^-j, the sum is split into

    k(x) = g(x²) ln|x| + h(x²) |x| + s(x²) + Σ r_n cos((n + ½) x),

closed forms of Σ (n + ½)^-j cos((n + ½) x), j = 1..6, and a remainder whose r_n decrease like n^-7 or faster. Its
integration is described in `grid` and `intervals`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil

import numpy

from ...core.arrays import Numbers
from .closed_forms import ORDER
from .intervals import CachedIntervals, Intervals, Operators
from .modes import ElasticBall, Socket


@dataclass(frozen=True, kw_only=True)
class Kernel:
    """Kernel k(x) of a socket and a ball (None is rigid), to an absolute error of `tolerance`."""

    socket: Socket
    ball: ElasticBall | None = None
    tolerance: float = 1e-14

    @cached_property
    def compliance(self) -> float:
        """Compliance C of socket and ball together in mm/MPa, the limit of c_n (n + ½) at high degrees."""
        return self.socket.asymptote + (0.0 if self.ball is None else self.ball.asymptote)

    def excess(self, degrees: Numbers) -> Numbers:
        """Compute the excess ρ_n = c_n (n + ½)/C - 1 of the modal compliance of both bodies together."""
        socket = self.socket.excess(degrees)
        if self.ball is None:
            return socket
        share = self.ball.asymptote / self.compliance
        return (1 - share) * socket + share * self.ball.excess(degrees)

    @cached_property
    def expansion(self) -> Numbers:
        """Coefficients a_1 .. a_8 of the expansion of ρ_n in 1/(n + ½)."""
        socket = self.socket.expansion(ORDER + 2)
        if self.ball is None:
            return socket
        share = self.ball.asymptote / self.compliance
        return (1 - share) * socket + share * self.ball.expansion(ORDER + 2)

    @cached_property
    def remainder(self) -> Numbers:
        """Remainders r_n of ρ_n after the closed forms, from n = 0 to the last one above the tolerance."""
        a = self.expansion
        tail = (abs(a[ORDER]) / (ORDER * self.tolerance)) ** (1 / ORDER)
        q = numpy.arange(max(ceil(tail), self.socket.backing_degree(self.tolerance), 24)) + 0.5
        return self.excess((q - 0.5).astype(int)) - sum(a[j] * q ** -(j + 1.0) for j in range(ORDER))

    def operators(self, intervals: Intervals | CachedIntervals) -> Operators:
        """Compute the integral operators of the kernel over [-ε, ε] for even and for odd functions f.

        They are ½ ∫ k(t - s) f(s) ds, see `intervals`.
        """
        operators = intervals.closed_form_operators(self.expansion[:ORDER])
        intervals.add_remainder(self.remainder, operators)
        return operators
