"""What a file says of wear, creep and the film."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from ..catalogue import catalogue
from ..core.checks import known_name, shown
from ..core.kinds import Kind
from ..elasticity.off_axis.surfaces import ClosedShell, RealCup, Springs
from ..io.toml import table_of
from ..io.units import parse
from ..models.foundation import RadialFoundation
from .coefficients import share_of_slide, wear_factor, wear_per_energy
from .creep import Ladder, constrained_share, logarithmic
from .film import Lubricant
from .laws import Archard, AreaLaw, CrossShear, EnergyLaw, Law

_LAWS = ("archard", "energy", "area", "cross-shear")
_BELONGS = MappingProxyType(
    {**dict.fromkeys(("circular", "exponent", "reference"), "cross-shear"), "friction": "energy"}
)
KEYS = ("law", "coefficient", "ball_coefficient", *_BELONGS, "contact", "model", "ring_width")
"""Of [wear]."""


def given_law(table: Mapping[str, Any]) -> Law:
    """The law of [wear]."""
    name = known_name("law", table.get("law", "archard"), _LAWS)
    if "coefficient" not in table:
        raise ValueError("[wear] needs a coefficient, such as '1.066e-6 mm^3/(N m)'")
    for each, law in _BELONGS.items():
        if each in table and law != name:
            raise ValueError(f"{each} belongs to the law {law!r}, and the law is {name!r}")
    return _cross_shear(table) if name == "cross-shear" else _plain(table, name, "coefficient")


def given_ball_law(table: Mapping[str, Any]) -> Law | None:
    """The law by which the ball wears too; none without its coefficient."""
    name = known_name("law", table.get("law", "archard"), _LAWS)
    if "ball_coefficient" not in table:
        return None
    if name == "cross-shear":
        raise ValueError("ball_coefficient belongs to the laws 'archard', 'energy' and 'area', not to 'cross-shear'")
    return _plain(table, name, "ball_coefficient")


def _plain(table: Mapping[str, Any], name: str, key: str) -> Law:
    """A law of one coefficient."""
    if name == "area":
        return AreaLaw(coefficient=share_of_slide(key, table[key]))
    if name == "archard":
        return Archard(coefficient=wear_factor(key, table[key]))
    if "friction" not in table:
        raise ValueError("the law 'energy' needs a friction, the coefficient whose work wears")
    return EnergyLaw(
        coefficient=wear_per_energy(key, table[key]), friction=parse("friction", table["friction"], Kind.NUMBER)
    )


def _cross_shear(table: Mapping[str, Any]) -> Law:
    if "circular" not in table:
        raise ValueError("the law 'cross-shear' needs circular, its coefficient on a circle, beside that on a line")
    return CrossShear(
        straight=wear_factor("coefficient", table["coefficient"]),
        circular=wear_factor("circular", table["circular"]),
        exponent=parse("exponent", table.get("exponent", 0.0), Kind.NUMBER),
        reference=parse("reference", table.get("reference", 1.0), Kind.MODULUS),
    )


_CREEPS = ("logarithmic", "kelvin-voigt")
_ELEMENTS = ("compliances", "times")
_CONFINEMENTS: Mapping[str, Callable[[float], float]] = MappingProxyType(
    {"unconfined": lambda poisson: 1.0, "constrained": constrained_share}
)
"""Functions from Poisson's ratio to the strain of the liner over that of a bar, by their names in files."""


def given_creep(content: Mapping[str, Any], poisson: float) -> Ladder | None:
    """Return the creep law of the table [creep] for a liner of this Poisson's ratio; None without that table."""
    if "creep" not in content:
        return None
    table = table_of(content, "creep")
    given = [name for name in _ELEMENTS if name in table]
    name = known_name("creep law", table.get("law", "kelvin-voigt" if given else "logarithmic"), _CREEPS)
    confined = known_name("confinement", table.get("confinement", "unconfined"), _CONFINEMENTS)
    confinement = _CONFINEMENTS[confined](poisson)
    if name == "logarithmic":
        if given:
            raise ValueError(f"{given[0]} belongs to the law 'kelvin-voigt', and the law is {name!r}")
        return logarithmic(confinement)
    compliances, times = (_numbers(each, table.get(each)) for each in _ELEMENTS)
    return Ladder(compliances=compliances, times=times, confinement=confinement)


def _numbers(name: str, value: Any) -> tuple[float, ...]:
    if not isinstance(value, list) or not value:
        raise ValueError(f"{name} = {shown(value)} must be a list of numbers, in 1/MPa and in s")
    return tuple(parse(name, each, Kind.NUMBER) for each in value)


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
