"""What a file says of wear, creep and the film."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from ..catalogue import catalogue
from ..core.checks import known_name
from ..core.kinds import Kind
from ..elasticity.off_axis.surfaces import ClosedShell, RealCup, Springs
from ..io.toml import table_of
from ..io.units import parse
from ..models.foundation import RadialFoundation
from .creep_law import CreepLaw
from .creep_laws import CREEP_LAWS, read_creep_law
from .film import Lubricant
from .law_fields import law_keys
from .wear_laws import BALL_COEFFICIENT, WEAR_LAWS

KEYS = ("law", *law_keys(WEAR_LAWS), BALL_COEFFICIENT, "contact", "model", "ring_width")
"""Keys of the table [wear]."""

CREEP_KEYS = ("law", *law_keys(CREEP_LAWS), "confinement", "seconds_per_cycle")
"""Keys of the table [creep]."""


def given_creep(content: Mapping[str, Any], poisson: float) -> CreepLaw | None:
    """Read the creep law of a file for a liner of this Poisson's ratio; None without a table [creep]."""
    return read_creep_law(table_of(content, "creep"), poisson) if "creep" in content else None


def given_seconds(table: Mapping[str, Any]) -> float | None:
    """How long a cycle of creep stands for, where [creep] says it."""
    value = table.get("seconds_per_cycle")
    return None if value is None else parse("seconds_per_cycle", value, Kind.NUMBER)


def given_lubricant(table: Mapping[str, Any]) -> Lubricant:
    """The lubricant of [film]."""
    words = {name: parse(name, table[name], Kind.NUMBER) for name in ("viscosity", "friction") if name in table}
    words |= {
        name: parse(name, table[name], Kind.LENGTH) for name in ("ball_roughness", "cup_roughness") if name in table
    }
    return Lubricant(**words)


_CONTACTS: Mapping[str, ClosedShell | RealCup | None] = MappingProxyType(
    {"springs": None, "shell": ClosedShell(), "cup": RealCup()}
)


def given_surface(table: Mapping[str, Any]) -> Springs | ClosedShell | RealCup:
    """The contact of [wear]."""
    contact = known_name("contact", table.get("contact", "springs"), _CONTACTS)
    elastic = _CONTACTS[contact]
    if elastic is not None:
        if "model" in table:
            raise ValueError(f"a model has springs, and the contact is {contact!r}: leave one of them out")
        return elastic
    model = catalogue[known_name("model", table.get("model", "hess-forsbach"), catalogue)]
    if not isinstance(model, RadialFoundation):
        names = ", ".join(name for name, each in catalogue.items() if isinstance(each, RadialFoundation))
        raise ValueError(f"the model {model.name!r} has no radial springs; those that have: {names}")
    return Springs(modulus=model.modulus)
