"""Creep of a liner under pressure: a ladder of Kelvin-Voigt elements at each point, each exact over any time."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log

import numpy

from ..arrays import Numbers
from ..checks import require

MINUTE = 60.0
_EULER = 0.5772156649015329
_AT, _OFFSET, _DECADE = 1e4, 3.491e-3, 7.966e-4
"""Of the logarithmic law: minutes, the strain per MPa by then, and that of every further decade."""

_DECADES = 9
"""Of the ladder that stands for it: to 4000 years, so that the last element never ends."""

UNVERIFIED = "the logarithmic law of creep has coefficients whose source was not read: they are not verified"


@dataclass(frozen=True, kw_only=True)
class Ladder:
    """Kelvin-Voigt elements in a row: under a pressure p each strains towards J p, with a time of its own.

    The strain is that of the liner's thickness, d = ε L.

    Parameters
    ----------
    compliances : tuple of float
        J of each element in 1/MPa.
    times : tuple of float
        Of each element in s.
    notes : tuple of str

    Raises
    ------
    ValueError
        Not as many of both, or numbers that are not allowed.

    Examples
    --------
    >>> ladder = Ladder(compliances=(1e-3, 2e-3), times=(60.0, 3600.0))
    >>> round(float(ladder.response(3600.0)), 6)
    0.002264
    """

    compliances: tuple[float, ...]
    times: tuple[float, ...]
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if len(self.compliances) != len(self.times) or not self.times:
            got = f"{len(self.compliances)} compliances and {len(self.times)} times"
            raise ValueError(f"a ladder has as many compliances as times, and at least one, got {got}")
        for value in self.compliances:
            require("compliance", value, 0 <= value < inf, "a compliance (1/MPa) is at least 0, and finite")
        for value in self.times:
            require("time", value, 0 < value < inf, "a time (s) is positive and finite")

    @property
    def _elements(self) -> tuple[Numbers, Numbers]:
        return numpy.array(self.compliances), numpy.array(self.times)

    def response(self, seconds: Numbers | float) -> Numbers:
        """The strain per MPa under a pressure that has lasted so long."""
        compliance, time = self._elements
        return -numpy.expm1(-numpy.asarray(seconds)[..., None] / time) @ compliance

    def rested(self, points: int) -> Numbers:
        """Strains of a liner that has not been pressed: (elements, points)."""
        return numpy.zeros((len(self.times), points))

    def advanced(self, strain: Numbers, pressure: Numbers, seconds: float) -> Numbers:
        """Strains (elements, points) after a time under constant pressures in MPa (points,)."""
        compliance, passed = self._passed(seconds)
        return strain + passed[:, None] * (compliance[:, None] * pressure - strain)

    def linear(self, strain: Numbers, seconds: float) -> tuple[Numbers, float]:
        """What becomes of the whole strain: that without pressure (points,), and what each MPa adds."""
        compliance, passed = self._passed(seconds)
        return ((1 - passed)[:, None] * strain).sum(axis=0), float(passed @ compliance)

    def _passed(self, seconds: float) -> tuple[Numbers, Numbers]:
        compliance, time = self._elements
        return compliance, -numpy.expm1(-seconds / time)


def logarithmic() -> Ladder:
    """The strain of UHMWPE per MPa, 3.491e-3 + 7.966e-4 (log10 t - 4), t in minutes, within 2 % from ten minutes on.

    One element a decade, all of one compliance. Its coefficients are not verified, and its notes say so.
    """
    # Σ (1 - exp(-t/τ 10^-i)) = log10(t/τ) + 1/2 + γ/ln 10 but for a ripple
    begin = 4 - _OFFSET / _DECADE + 0.5 + _EULER / log(10)
    times = tuple(MINUTE * 10 ** (begin + decade) for decade in range(_DECADES))
    return Ladder(compliances=(_DECADE,) * _DECADES, times=times, notes=(UNVERIFIED,))
