"""Table [uncertainty] of a hip file: quantities that differ between patients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from ..core.checks import shown
from ..core.deprecation import RenamedAttribute
from ..core.kinds import Kind
from ..io.toml import table_of
from ..io.units import parse
from ..studies.distributions import check_nominal
from ..studies.scatter import Read, distribution_of
from .law_fields import wear_factor
from .simulation import HipSimulation
from .variability import DEFAULT_COUNT, SAMPLED_QUANTITIES, PatientVariability
from .wear_law import coefficient_field

UNCERTAINTY_KEYS = ("count", "seed", *SAMPLED_QUANTITIES)
"""Keys of the table."""

_KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        "clearance": Kind.LENGTH,
        **dict.fromkeys(("inclination", "anteversion", "tilt"), Kind.ANGLE),
        "body_weight": Kind.FORCE,
        "cycles_per_year": Kind.NUMBER,
    }
)
"""Physical kinds of the sampled quantities except the wear coefficient, whose unit depends on the law."""

_MAX_INTEGER = 1 << 20
"""Largest count and seed."""


@dataclass(frozen=True, kw_only=True, eq=False)
class UncertaintySettings:
    """Settings of the table [uncertainty].

    Attributes
    ----------
    variability : PatientVariability
        Distributions of the patients.
    count : int
        Number of samples, a power of two.
    seed : int
        Seed of the samples.
    """

    variability: PatientVariability
    count: int
    seed: int

    scatter = RenamedAttribute("variability")


def read_uncertainty(content: Mapping[str, Any], use: HipSimulation) -> UncertaintySettings:
    """Read the table [uncertainty] of a file.

    Parameters
    ----------
    content : mapping
        Content of the file. The table has distributions by name of `SAMPLED_QUANTITIES`, as in study files.
        It may have `count`, a power of two, and `seed`.
    use : HipSimulation
        Hip of the nominal patient.

    Raises
    ------
    ValueError
        A value or a name that is not allowed.
    """
    table = table_of(content, "uncertainty")
    distributions = {
        name: distribution_of(name, table[name], _read(name, use)) for name in SAMPLED_QUANTITIES if name in table
    }
    count = _read_integer("count", table.get("count", DEFAULT_COUNT))
    seed = _read_integer("seed", table.get("seed", 0))
    if count < 2 or count & (count - 1):
        raise ValueError(f"count = {count} is not allowed: it must be a power of two, such as {DEFAULT_COUNT}")
    weight = _read_body_weight(content) if "body_weight" in distributions else None
    variability = PatientVariability(use=use, distributions=distributions, body_weight=weight)
    for name, value in _nominal(use).items():
        if name in distributions:
            check_nominal(name, value, distributions[name], _KINDS.get(name, Kind.NUMBER).written)
    return UncertaintySettings(variability=variability, count=count, seed=seed)


def _nominal(use: HipSimulation) -> dict[str, float]:
    """Return the nominal values of the quantities that may differ between patients."""
    coefficient, cup = coefficient_field(use.wear), use.placed
    values = {"clearance": use.joint.clearance, "inclination": cup.inclination, "anteversion": cup.anteversion}
    known = values if coefficient is None else {**values, "coefficient": getattr(use.wear, coefficient.name)}
    return {name: float(value) for name, value in known.items()}


def _read_body_weight(content: Mapping[str, Any]) -> float | None:
    """Read the body weight that the forces belong to; return None if the file does not state it."""
    tables = (content, table_of(content, "cycle"), *content.get("activity", []))
    weights = {parse("body_weight", table["body_weight"], Kind.FORCE) for table in tables if "body_weight" in table}
    if len(weights) > 1:
        raise ValueError("body_weight has several values, but patients need one: give it once, at the top of the file")
    return weights.pop() if weights else None


def _read(name: str, use: HipSimulation) -> Read:
    if name != "coefficient":
        return lambda key, value: parse(key, value, _KINDS[name])
    coefficient = coefficient_field(use.wear)
    return wear_factor if coefficient is None else coefficient.unit.read


def _read_integer(name: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= _MAX_INTEGER:
        raise ValueError(f"{name} = {shown(value)} is not allowed: it must be an integer from 0 to {_MAX_INTEGER}")
    return value
