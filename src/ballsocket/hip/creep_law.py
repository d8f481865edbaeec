"""Creep law of a liner: Kelvin-Voigt elements in series at each point, exact for a constant pressure over any time."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from .law_fields import Law


@dataclass(frozen=True, kw_only=True)
class CreepLaw(Law):
    """Base of creep laws: frozen dataclasses with `name`, `title`, fields by `law_field`, and `elements`.

    A law in the registry `CREEP_LAWS` is available in files, on the command line, and in the explorer.

    The strain is that of the liner's thickness, d = ε L. `elements` describes a bar that expands sideways freely. A
    thin bonded liner cannot: `confinement` is the ratio of its strain to that of the bar (see `constrained_share`).

    Parameters
    ----------
    confinement : float
        Strain of the liner over the strain of a bar, from 0 to 1; 1 is a liner that expands sideways freely.
    """

    confinement: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        limits = "confinement is 0 to 1: the strain over that of a bar"
        require("confinement", self.confinement, 0 <= self.confinement <= 1, limits)

    @property
    @abstractmethod
    def elements(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Compliances in 1/MPa and retardation times in s of the Kelvin-Voigt elements of a free bar."""

    @property
    def _confined_elements(self) -> tuple[Numbers, Numbers]:
        compliances, times = self.elements
        return self.confinement * numpy.array(compliances), numpy.array(times)

    def response(self, seconds: Numbers | float) -> Numbers:
        """Compute the creep strain per MPa after a time in s under constant pressure."""
        compliance, time = self._confined_elements
        return -numpy.expm1(-numpy.asarray(seconds)[..., None] / time) @ compliance

    def initial_strain(self, points: int) -> Numbers:
        """Return the creep strains of an unloaded liner: zeros (elements, points)."""
        return numpy.zeros((len(self.elements[1]), points))

    def advance_strain(self, strain: Numbers, pressure: Numbers, seconds: float) -> Numbers:
        """Compute the creep strains (elements, points) after a time in s under constant pressures in MPa."""
        compliance, growth = self._compliance_and_growth(seconds)
        return strain + growth[:, None] * (compliance[:, None] * pressure - strain)

    def linear_response(self, strain: Numbers, seconds: float) -> tuple[Numbers, float]:
        """Compute the total creep strain after a time in s as a linear function of the pressure.

        These are the strain without pressure (points,), and the added strain per MPa.
        """
        compliance, growth = self._compliance_and_growth(seconds)
        return ((1 - growth)[:, None] * strain).sum(axis=0), float(growth @ compliance)

    def _compliance_and_growth(self, seconds: float) -> tuple[Numbers, Numbers]:
        """Compute compliances in 1/MPa of the elements, and their fractions of the final strain after a time in s."""
        compliance, time = self._confined_elements
        return compliance, -numpy.expm1(-seconds / time)


def constrained_share(poisson: float) -> float:
    """Compute the strain of a laterally confined layer divided by that of a free bar, from Poisson's ratio.

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


def confinement_note(creep: CreepLaw, poisson: float) -> str:
    """Describe the lateral confinement that a creep law assumes, for a liner's Poisson's ratio."""
    if creep.confinement != 1:
        return f"creep strain is {creep.confinement:.3g} of that of a free bar: the liner is laterally constrained"
    if not 0 < poisson <= 0.5:
        return ""
    share = constrained_share(poisson)
    return f"creep strain is that of a free bar; the strain of a laterally constrained liner is {share:.2g} of that"
