"""What differs between patients, in a file about a hip in use: its table [uncertainty]."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from ..core.checks import shown
from ..core.kinds import Kind
from ..io.toml import table_of
from ..io.units import parse
from ..studies.distributions import check_nominal
from ..studies.scatter import Read, distribution_of
from .law_fields import wear_factor
from .patients import SCATTERS, Scatter
from .simulation import HipSimulation
from .uncertainty import COUNT
from .wear_law import coefficient_field

KEYS = ("count", "seed", *SCATTERS)
_KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        "clearance": Kind.LENGTH,
        **dict.fromkeys(("inclination", "anteversion", "tilt"), Kind.ANGLE),
        "body_weight": Kind.FORCE,
        "cycles_per_year": Kind.NUMBER,
    }
)
_LARGEST = 1 << 20


@dataclass(frozen=True, kw_only=True, eq=False)
class Uncertain:
    """What a file says of patients: what scatters, and how many samples are taken with which seed."""

    scatter: Scatter
    count: int
    seed: int


def uncertain(content: Mapping[str, Any], use: HipSimulation) -> Uncertain:
    """What the table [uncertainty] of a file says.

    Parameters
    ----------
    content : mapping
        Of the whole file. The table has by name of `SCATTERS` a distribution, as in study files; `count`, a power of
        two, and `seed`.
    use : HipSimulation
        The usual patient's.

    Raises
    ------
    ValueError
        One sentence: what is wrong.
    """
    table = table_of(content, "uncertainty")
    scattered = {name: distribution_of(name, table[name], _read(name, use)) for name in SCATTERS if name in table}
    count, seed = _whole("count", table.get("count", COUNT)), _whole("seed", table.get("seed", 0))
    if count < 2 or count & (count - 1):
        raise ValueError(f"count = {count} is not allowed: a power of two of samples, such as {COUNT}")
    weight = _weight(content) if "body_weight" in scattered else None
    scatter = Scatter(use=use, distributions=scattered, body_weight=weight)
    for name, value in _nominal(use).items():
        if name in scattered:
            check_nominal(name, value, scattered[name], _KINDS.get(name, Kind.NUMBER).written)
    return Uncertain(scatter=scatter, count=count, seed=seed)


def _nominal(use: HipSimulation) -> dict[str, float]:
    """Return the nominal values of the quantities that may differ between patients."""
    coefficient, cup = coefficient_field(use.wear), use.placed
    values = {"clearance": use.joint.clearance, "inclination": cup.inclination, "anteversion": cup.anteversion}
    known = values if coefficient is None else {**values, "coefficient": getattr(use.wear, coefficient.name)}
    return {name: float(value) for name, value in known.items()}


def _weight(content: Mapping[str, Any]) -> float | None:
    """The body's weight that the forces are for, where the file says it."""
    parts = (content, table_of(content, "cycle"), *content.get("activity", []))
    given = {parse("body_weight", part["body_weight"], Kind.FORCE) for part in parts if "body_weight" in part}
    if len(given) > 1:
        raise ValueError("body_weight scatters, and there are several: one is needed, at the top")
    return given.pop() if given else None


def _read(name: str, use: HipSimulation) -> Read:
    if name != "coefficient":
        return lambda key, value: parse(key, value, _KINDS[name])
    coefficient = coefficient_field(use.wear)
    return wear_factor if coefficient is None else coefficient.unit.read


def _whole(name: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= _LARGEST:
        raise ValueError(f"{name} = {shown(value)} is not allowed: a whole number from 0 to {_LARGEST}")
    return value
