"""Creep of a liner under pressure: a ladder of Kelvin-Voigt elements at each point, each exact over any time."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, log

import numpy

from ..core.arrays import Numbers
from ..core.checks import require

MINUTE = 60.0
_EULER = 0.5772156649015329
_AT, _OFFSET, _DECADE = 1e4, 3.491e-3, 7.966e-4
"""Of the logarithmic law: minutes, the strain per MPa by then, and that of every further decade."""

_DECADES = 9
"""Of the ladder that stands for it: to 4000 years, so that the last element never ends."""

UNVERIFIED = "the logarithmic law of creep has coefficients whose source was not read: they are not verified"


@dataclass(frozen=True, kw_only=True)
class Ladder:
    """Kelvin-Voigt elements in series: under a pressure p each strains towards J p with its own time constant.

    The strain is that of the liner's thickness, d = ε L. J is the compliance of a bar that expands sideways freely. A
    thin bonded liner cannot: `confinement` is the ratio of its strain to that of the bar (see `constrained_share`).

    Parameters
    ----------
    compliances : tuple of float
        J of each element in 1/MPa.
    times : tuple of float
        Of each element in s.
    notes : tuple of str
    confinement : float
        Strain of the liner over the strain of a bar, from 0 to 1; 1 is a liner that expands sideways freely.

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
    confinement: float = 1.0

    def __post_init__(self) -> None:
        if len(self.compliances) != len(self.times) or not self.times:
            got = f"{len(self.compliances)} compliances and {len(self.times)} times"
            raise ValueError(f"a ladder has as many compliances as times, and at least one, got {got}")
        for value in self.compliances:
            require("compliance", value, 0 <= value < inf, "a compliance (1/MPa) is at least 0, and finite")
        for value in self.times:
            require("time", value, 0 < value < inf, "a time (s) is positive and finite")
        require(
            "confinement",
            self.confinement,
            0 <= self.confinement <= 1,
            "confinement is 0 to 1: the strain over that of a bar",
        )

    @property
    def _elements(self) -> tuple[Numbers, Numbers]:
        return self.confinement * numpy.array(self.compliances), numpy.array(self.times)

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


def constrained_share(poisson: float) -> float:
    """Compute the strain of a laterally constrained layer over the strain of a bar under the same pressure.

    This is E/M, with the constrained (oedometric) modulus M = E (1 - ν)/((1 + ν)(1 - 2ν)), for a Poisson's ratio that
    is the same at all times. If the volume creeps less than the shape does, the strain is smaller still.

    Parameters
    ----------
    poisson : float
        Poisson's ratio of the liner, from 0 to 0.5.

    Raises
    ------
    ValueError
        A number outside this range.

    Examples
    --------
    >>> round(constrained_share(0.4), 4)
    0.4667
    """
    require("poisson", poisson, 0 <= poisson <= 0.5, "Poisson's ratio of a creeping layer is 0 to 0.5")
    return (1 + poisson) * (1 - 2 * poisson) / (1 - poisson)


def creep_note(creep: Ladder, poisson: float) -> str:
    """Describe the lateral constraint of a creep law for a liner with this Poisson's ratio."""
    if creep.confinement != 1:
        return f"creep strain is {creep.confinement:.3g} of that of a free bar: the liner is laterally constrained"
    if not 0 < poisson <= 0.5:
        return ""
    share = constrained_share(poisson)
    return f"creep strain is that of a free bar; the strain of a laterally constrained liner is {share:.2g} of that"


def logarithmic(confinement: float = 1.0) -> Ladder:
    """Return the creep law of UHMWPE, a strain per MPa of 3.491e-3 + 7.966e-4 (log10 t - 4), t in minutes.

    It is accurate within 2 % after ten minutes. It has one element for each decade of time, all with the same
    compliance. Its coefficients are not verified, as its notes state.
    """
    # Σ (1 - exp(-t/τ 10^-i)) = log10(t/τ) + 1/2 + γ/ln 10 but for a ripple
    begin = 4 - _OFFSET / _DECADE + 0.5 + _EULER / log(10)
    times = tuple(MINUTE * 10 ** (begin + decade) for decade in range(_DECADES))
    return Ladder(compliances=(_DECADE,) * _DECADES, times=times, notes=(UNVERIFIED,), confinement=confinement)
