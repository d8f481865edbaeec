"""Creep laws, and the registry in which files, the command line and the explorer find them by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import log
from types import MappingProxyType
from typing import Any, ClassVar

from ..core.checks import NamedItems, known_name
from ..core.display import counted
from .creep_law import CreepLaw, constrained_share
from .law_fields import law_field, list_unit, read_law, select_law_class

_MINUTE = 60.0  # seconds in a minute
_EULER_GAMMA = 0.5772156649015329
_STRAIN_AT_REFERENCE = 3.491e-3  # strain per MPa of the logarithmic law after 10^4 minutes
_STRAIN_PER_DECADE = 7.966e-4  # strain per MPa that the logarithmic law adds in each decade of time
_N_DECADES = 9  # number of elements of the logarithmic law, one for each decade: they last 4000 years

UNVERIFIED_NOTE = "the logarithmic law of creep has coefficients whose source was not read: they are not verified"
"""Note on the coefficients of the logarithmic law."""


@dataclass(frozen=True, kw_only=True)
class KelvinVoigtChain(CreepLaw):
    """Creep law of Kelvin-Voigt elements in series.

    Under a pressure p, the strain of each element approaches J p with a retardation time of the element.

    Parameters
    ----------
    compliances : tuple of float
        Compliance J of each element in 1/MPa.
    times : tuple of float
        Retardation time of each element in s.
    notes : tuple of str
    confinement : float
        Strain of the liner over the strain of a bar, from 0 to 1; 1 is a liner that expands sideways freely.

    Raises
    ------
    ValueError
        Different numbers of compliances and times, or numbers that are not allowed.

    Examples
    --------
    >>> chain = KelvinVoigtChain(compliances=(1e-3, 2e-3), times=(60.0, 3600.0))
    >>> round(float(chain.response(3600.0)), 6)
    0.002264
    """

    name: ClassVar[str] = "kelvin-voigt"
    title: ClassVar[str] = "Kelvin-Voigt elements in series"
    compliances: tuple[float, ...] = law_field(list_unit("1/MPa", "per_MPa"), "compliances", example=(1e-3, 2e-3))
    times: tuple[float, ...] = law_field(
        list_unit("s", "s"), "retardation times", example=(60.0, 3600.0), low_included=False
    )
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if len(self.compliances) != len(self.times) or not len(self.times):
            counts = f"{counted(len(self.compliances), 'compliance')} and {counted(len(self.times), 'time')}"
            raise ValueError(f"a KelvinVoigtChain needs as many compliances as times, and at least one, got {counts}")
        super().__post_init__()

    @property
    def elements(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        return self.compliances, self.times


@dataclass(frozen=True, kw_only=True)
class LogarithmicCreep(CreepLaw):
    """Creep law of UHMWPE: strain per MPa of 3.491e-3 + 7.966e-4 (log10 t - 4) after a time t in minutes.

    It is accurate within 2 % from ten minutes on, and 3 % off at one minute. It has one element for each decade of
    time, all with the same compliance. Its coefficients are not verified, as its notes state.

    Parameters
    ----------
    confinement : float
        Strain of the liner over the strain of a bar, from 0 to 1; 1 is a liner that expands sideways freely.
    """

    name: ClassVar[str] = "logarithmic"
    title: ClassVar[str] = "creep with the logarithm of time"

    @property
    def elements(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        return self.compliances, self.times

    @property
    def compliances(self) -> tuple[float, ...]:
        """Compliance of each Kelvin-Voigt element in 1/MPa."""
        return (_STRAIN_PER_DECADE,) * _N_DECADES

    @property
    def times(self) -> tuple[float, ...]:
        """Retardation time of each Kelvin-Voigt element in s."""
        # Σ (1 - exp(-t/τ 10^-i)) = log10(t/τ) + 1/2 + γ/ln 10 but for a ripple
        begin = 4 - _STRAIN_AT_REFERENCE / _STRAIN_PER_DECADE + 0.5 + _EULER_GAMMA / log(10)
        return tuple(_MINUTE * 10 ** (begin + decade) for decade in range(_N_DECADES))

    @property
    def notes(self) -> tuple[str, ...]:
        return (UNVERIFIED_NOTE,)


def logarithmic(confinement: float = 1.0) -> LogarithmicCreep:
    """Create the logarithmic creep law of UHMWPE for a confinement of the liner."""
    return LogarithmicCreep(confinement=confinement)


_CREEP_LAWS: tuple[type[CreepLaw], ...] = (
    LogarithmicCreep,
    KelvinVoigtChain,
)

CREEP_LAWS: Mapping[str, type[CreepLaw]] = NamedItems("creep law", {law.name: law for law in _CREEP_LAWS})
"""Registry of the creep laws by their names in files; the first one is the default."""

CONFINEMENTS: Mapping[str, Callable[[float], float]] = MappingProxyType(
    {"unconfined": lambda poisson: 1.0, "constrained": constrained_share}
)
"""Functions from Poisson's ratio to the strain of the liner over that of a bar, by their names in files."""


def read_creep_law(table: Mapping[str, Any], poisson: float) -> CreepLaw:
    """Read the creep law from the table [creep] of a file, for a liner with a Poisson's ratio."""
    name = known_name("confinement", table.get("confinement", "unconfined"), CONFINEMENTS)
    law = select_law_class(table, CREEP_LAWS, "creep law")
    return read_law(table, CREEP_LAWS, law, confinement=CONFINEMENTS[name](poisson))
