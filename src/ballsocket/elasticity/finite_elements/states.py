"""Solved contacts side by side, and how far off they may be."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter

import numpy

from ...contact.peak_pressure import PeakPressure, find_peak_pressure
from ...contact.per_joint import QUANTITIES
from ...core.arrays import Numbers
from .full_contact import Brimful
from .work import Solved, stiffness, work

_TENSION, _OVERLAP = (
    1e-3,
    1e-3,
)  # over the pressure at the pole; over the indentation
_NOISE = 5e-4  # of the pressures at nodes, over the one at the pole

_LAWS: dict[str, Callable[[Solved], float]] = {"stiffness": stiffness, "energy": work}


@dataclass(frozen=True, kw_only=True, eq=False)
class States(PeakPressure):
    """Solved contacts side by side, each quantity one number a contact; None and NaN where there is none."""

    solved: tuple[Solved | None, ...]

    def __getattr__(self, name: str) -> Numbers:
        if name not in QUANTITIES:
            raise AttributeError(name)
        return self._each(_LAWS.get(name, attrgetter(name)))

    def _each(self, law: Callable[[Solved], float]) -> Numbers:
        return numpy.array([numpy.nan if one is None else law(one) for one in self.solved])

    @property
    def at_rim(self) -> Numbers:
        """1 where the contact fills its socket."""
        return self._each(lambda one: float(isinstance(one, Brimful)))

    @property
    def unsound(self) -> Numbers:
        """1 where something pulls or overlaps: the contact is not the round patch that was assumed."""
        return self._each(lambda one: float(one.tension > _TENSION or one.overlap > _OVERLAP))

    @property
    def edge_element(self) -> Numbers:
        """Length of the elements at the edge over the half angle."""
        return self._each(lambda one: one.edge_element / one.half_angle)

    @cached_property
    def largest(self) -> tuple[Numbers, Numbers]:
        """The largest pressure of each contact in MPa, and its polar angle in rad."""
        return find_peak_pressure(self.pressure, self.pole_pressure, self.half_angle, _NOISE)

    def pressure(self, angle: Numbers) -> Numbers:
        """p(φ) in MPa at angles (anything, loads)."""
        columns = [
            numpy.full(len(angle), numpy.nan) if one is None else one.pressure(angle[:, i])
            for i, one in enumerate(self.solved)
        ]
        return numpy.stack(columns, axis=-1) if columns else numpy.zeros_like(angle)


_SAFETY = 2.0  # over what Richardson's extrapolation takes off
_LEAST = {
    "force": 0.03,
    "indentation": 0.03,
    "half_angle": 0.7,
    "max_pressure": 0.2,
    "pole_pressure": 0.2,
    "stiffness": 1.0,
    "energy": 0.07,
    "pressure_integral": 0.02,
}
"""Errors that random contacts have shown against the exact answer, in squares of the element over the half angle.

For biquadratic elements; bilinear ones have shown three times as much. A test draws such contacts anew: the true error
lies within the error bar (test_fem.py).
"""


def errors_of(kind: str, fine: States, coarse: States, order: int) -> dict[str, Numbers]:
    """Relative errors of the fine solution by Richardson's extrapolation, with some safety.

    Both meshes may be off by the same by chance, so an error is at least what elements of this size have shown. What
    was given is exact.
    """
    errors = {}
    for name in QUANTITIES:
        apart = abs(getattr(coarse, name) / getattr(fine, name) - 1)
        least = _LEAST[name] * (3 if order == 1 else 1) * fine.edge_element**2
        errors[name] = numpy.maximum(_SAFETY * apart / (2**order - 1), least)
    errors[kind] = 0.0 * errors[kind]
    return errors
