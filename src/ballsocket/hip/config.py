"""Hip files: wear simulations in TOML with units. Unknown keys are rejected, as in joint files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import degrees, pi
from pathlib import Path
from types import MappingProxyType
from typing import Any

from ..catalogue import catalogue
from ..core.checks import known_name, require, shown
from ..core.deprecation import RenamedAttribute
from ..core.kinds import Kind
from ..elasticity.off_axis.surfaces import ClosedShell, RealCup, Springs
from ..files.joint_file import KEYS, JointFile, check_keys, read_cup
from ..files.named_joint import PARTS, joint_in
from ..files.toml import read_toml, table_of
from ..files.units import parse
from ..models.foundation import RadialFoundation
from ..problem.cup import Cup
from ..studies.distributions import check_nominal
from ..studies.scatter import Read, distribution_of
from .creep_law import CreepLaw
from .creep_laws import CREEP_LAWS, read_creep_law
from .cycle_file import KEYS as CYCLE_KEYS
from .cycle_file import parse_cycle
from .film import Lubricant
from .law_fields import law_keys
from .simulation import HipSimulation, check_cycles
from .variability import DEFAULT_COUNT, SAMPLED_QUANTITIES, PatientVariability
from .wear_law import coefficient_field, wear_factor
from .wear_laws import BALL_COEFFICIENT, WEAR_LAWS, read_ball_law, read_wear_law

UNCERTAINTY_KEYS = ("count", "seed", *SAMPLED_QUANTITIES)
"""Keys of the table."""

_TABLES: Mapping[str, tuple[str, ...]] = {
    "": (
        *("name", "source", *PARTS, "cycle", "activity", "wear", "creep", "film", "uncertainty"),
        *("body_weight", "cycles_per_year", "cycles", "report_at", "years", "report_years"),
    ),
    "cup": (*KEYS["cup"], "tilt"),
    "cycle": CYCLE_KEYS,
    "creep": ("law", *law_keys(CREEP_LAWS), "confinement", "seconds_per_cycle"),
    "film": ("viscosity", "ball_roughness", "cup_roughness", "friction"),
    "wear": ("law", *law_keys(WEAR_LAWS), BALL_COEFFICIENT, "contact", "model", "ring_width"),
    "uncertainty": UNCERTAINTY_KEYS,
}
FILE_KEYS = {**{name: KEYS[name] for name in PARTS}, **_TABLES}
"""Keys of a hip file by table; an empty name stands for the top."""

_DEFAULT_CYCLES = 5e6
_DEFAULT_N_REPORTS = 10


@dataclass(frozen=True, kw_only=True, eq=False)
class HipFile:
    """Contents of a hip file.

    Attributes
    ----------
    use : HipSimulation
    cycles : float
        Number of cycles.
    report_at : tuple of float
        Cycle counts of the reports.
    lubricant : Lubricant
    uncertain : optional
        Distributions of quantities that differ between patients; None without a table [uncertainty].
    """

    use: HipSimulation
    cycles: float
    report_at: tuple[float, ...]
    lubricant: Lubricant
    uncertain: UncertaintySettings | None = None


def read_hip(path: str | Path) -> HipFile:
    """Read a hip file.

    Tables: `joint`, `liner`, `ball`, `backing` and `cup` as in joint files (`joint` may be the name of a preset or of a
    joint file); in `cup` a `tilt` from the load may take the place of inclination and anteversion. `cycle` has a `name`
    (see `named_cycle`), with what its machine takes (`force`, `amplitude`, `mismatch`, `stiffness`, `swing_load`), or a
    `file` or several (see `read_cycle`), with `side`, `frame`, `force_on`, `from`, `to`, `closing` and the name of a
    `motion`; and `instants`, `rotation_order`, `body_weight`, `times_body_weight`. In its place an array of tables
    `activity` takes the same, each with how often it is done: `per_year`, or its `share` of `cycles_per_year`. `wear`
    has a `law` (a name of `WEAR_LAWS`: "archard", "energy", "area", "cross-shear") with its numbers, such as the
    `coefficient`, the `ball_coefficient` of a ball that wears too, `contact` ("springs", "shell", "cup"), the `model`
    with these springs, `ring_width`. `creep`, which may be empty, has a `law` (a name of `CREEP_LAWS`: "logarithmic",
    unverified, or "kelvin-voigt" with `compliances` in 1/MPa and `times` in s), a `confinement` ("unconfined" or
    "constrained") and `seconds_per_cycle`. `film` has `viscosity`
    in Pa s, `ball_roughness`, `cup_roughness`, `friction`. `uncertainty` lists the quantities that differ between
    patients (`coefficient`, `clearance`, `inclination`, `anteversion` or `tilt`, `body_weight`, `cycles_per_year`),
    each by a distribution as in study files, with `count` (of samples, a power of two) and `seed`. At the top:
    `cycles`, `report_at` (a list), or of activities `years` and `report_years`; `body_weight`.

    Raises
    ------
    ValueError
        A wrong key or value. The message is one sentence, with the nearest known name or the allowed values.
    OSError
        A file cannot be read.
    """
    path = Path(path)
    return read_toml(path, "hip", lambda content: _parse_hip(content, path.parent))


def _parse_hip(content: Mapping[str, Any], folder: Path) -> HipFile:
    """Build a `HipFile` from the content of a hip file; paths in the file are relative to a folder."""
    check_keys(content, "", "at the top", FILE_KEYS)
    for name in ("cup", "cycle", "wear", "creep", "film", "uncertainty"):
        check_keys(table_of(content, name), name, f"in [{name}]", FILE_KEYS)
    joint_file = _parse_joint(content, folder)
    cycle, wear = parse_cycle(content, folder), table_of(content, "wear")
    width = {name: parse(name, wear[name], Kind.ANGLE) for name in ("ring_width",) if name in wear}
    use = HipSimulation(
        joint=joint_file.joint,
        cup=joint_file.cup,
        cycle=cycle,
        wear=read_wear_law(wear),
        ball_wear=read_ball_law(wear),
        surface=parse_surface(wear),
        creep=parse_creep(content, float(joint_file.joint.liner.poisson)),
        seconds_per_cycle=_parse_seconds(table_of(content, "creep")),
        **width,
    )
    if cycle.per_year is not None and "years" in content:
        cycles, report_at = _parse_years(content, cycle.per_year)
    else:
        cycles, report_at = _parse_cycles(content)
    check_cycles(cycles, report_at)
    return HipFile(
        use=use,
        cycles=cycles,
        report_at=report_at,
        lubricant=_parse_lubricant(table_of(content, "film")),
        uncertain=read_uncertainty(content, use) if "uncertainty" in content else None,
    )


def parse_creep(content: Mapping[str, Any], poisson: float) -> CreepLaw | None:
    """Read the creep law of the table [creep], for a liner with a Poisson's ratio; None without the table."""
    return read_creep_law(table_of(content, "creep"), poisson) if "creep" in content else None


def _parse_seconds(table: Mapping[str, Any]) -> float | None:
    """Read `seconds_per_cycle` in s from the table [creep]; None without the key."""
    value = table.get("seconds_per_cycle")
    return None if value is None else parse("seconds_per_cycle", value, Kind.NUMBER)


_LUBRICANT_KINDS = {
    **dict.fromkeys(("viscosity", "friction"), Kind.NUMBER),
    **dict.fromkeys(("ball_roughness", "cup_roughness"), Kind.LENGTH),
}


def _parse_lubricant(table: Mapping[str, Any]) -> Lubricant:
    """Read the lubricant of the table [film]."""
    return Lubricant(
        **{name: parse(name, table[name], kind) for name, kind in _LUBRICANT_KINDS.items() if name in table}
    )


_ELASTIC_SURFACES: Mapping[str, ClosedShell | RealCup | None] = MappingProxyType(
    {"springs": None, "shell": ClosedShell(), "cup": RealCup()}
)


def parse_surface(table: Mapping[str, Any]) -> Springs | ClosedShell | RealCup:
    """Read the foundation of the socket from the key `contact` of the table [wear]."""
    contact = known_name("contact", table.get("contact", "springs"), _ELASTIC_SURFACES)
    elastic = _ELASTIC_SURFACES[contact]
    if elastic is not None:
        if "model" in table:
            raise ValueError(f"model needs contact = 'springs', and contact is {contact!r}: remove model or contact")
        return elastic
    model = catalogue[known_name("model", table.get("model", "hess-forsbach"), catalogue)]
    if not isinstance(model, RadialFoundation):
        names = ", ".join(name for name, model in catalogue.items() if isinstance(model, RadialFoundation))
        raise ValueError(f"the model {model.name!r} has no radial springs; models with springs: {names}")
    return Springs(modulus=model.modulus)


def _parse_cycles(content: Mapping[str, Any]) -> tuple[float, tuple[float, ...]]:
    """Read the number of cycles and the cycle counts of the reports."""
    for name in ("years", "report_years"):
        if name in content:
            raise ValueError(f"{name} needs activities with counts a year, and years: [[activity]]")
    cycles = _parse_count("cycles", content.get("cycles", _DEFAULT_CYCLES))
    return cycles, _parse_report_points(content, "report_at", cycles)


def _parse_years(content: Mapping[str, Any], per_year: float) -> tuple[float, tuple[float, ...]]:
    """Read the years of a run and of its reports, and convert both to numbers of cycles."""
    for name in ("cycles", "report_at"):
        if name in content:
            raise ValueError(f"{name} and years exclude each other: both set the length of the run; remove one")
    years = _parse_count("years", content["years"])
    reports = _parse_report_points(content, "report_years", years)
    return years * per_year, tuple(year * per_year for year in reports)


def _parse_report_points(content: Mapping[str, Any], name: str, end: float) -> tuple[float, ...]:
    """Read the cycle counts or years of the reports; ten equal steps by default."""
    steps = range(1, _DEFAULT_N_REPORTS + 1)
    points = content.get(name, [step * end / _DEFAULT_N_REPORTS for step in steps])
    if not isinstance(points, list):
        raise ValueError(f"{name} = {shown(points)} must be a list of numbers of {_UNITS[name]}")
    return tuple(_parse_count(name, point) for point in points)


_UNITS = {"cycles": "cycles", "report_at": "cycles", "years": "years", "report_years": "years"}
_EXAMPLES = {"cycles": "5e6", "report_at": "5e6", "years": "20", "report_years": "20"}


def _parse_count(name: str, value: Any) -> float:
    """Read a number of cycles or years."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"{name} = {shown(value)} must be a number of {_UNITS[name]}, such as {_EXAMPLES[name]}")
    return float(value)


def _parse_joint(content: Mapping[str, Any], folder: Path) -> JointFile:
    """Read the joint and the cup of a hip file.

    The cup may have a tilt instead of an orientation, also next to the name of a joint.
    """
    cup_table = dict(table_of(content, "cup"))
    tilt = cup_table.pop("tilt", None)
    file = joint_in({name: table for name, table in content.items() if name != "cup"}, folder)
    if cup_table:
        file = replace(file, cup=read_cup(cup_table))
    return file if tilt is None else replace(file, cup=_tilt_cup(file.cup, tilt, cup_table))


def _tilt_cup(cup: Cup, tilt: Any, cup_table: Mapping[str, Any]) -> Cup:
    """Return the cup tilted from the load by the angle that a hip file states."""
    for name in ("inclination", "anteversion"):
        if name in cup_table:
            raise ValueError(f"tilt and {name} exclude each other: both set the orientation of the cup; remove one")
    angle = parse("tilt", tilt, Kind.ANGLE)
    require("tilt", degrees(angle), 0 <= angle <= pi / 2, "a cup's tilt from the load is 0 to 90 degrees")
    return cup.tilted(angle)


_SAMPLED_KINDS: Mapping[str, Kind] = MappingProxyType(
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
    """Read distributions and sample settings from the table [uncertainty] of a hip file.

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
    names = [name for name in SAMPLED_QUANTITIES if name in table]
    distributions = {name: distribution_of(name, table[name], _quantity_reader(name, use)) for name in names}
    count = _read_integer("count", table.get("count", DEFAULT_COUNT))
    seed = _read_integer("seed", table.get("seed", 0))
    if count < 2 or count & (count - 1):
        raise ValueError(f"count = {count} is not allowed: it must be a power of two, such as {DEFAULT_COUNT}")
    weight = _read_body_weight(content) if "body_weight" in distributions else None
    variability = PatientVariability(use=use, distributions=distributions, body_weight=weight)
    for name, value in _nominal_values(use).items():
        if name in distributions:
            check_nominal(name, value, distributions[name], _SAMPLED_KINDS.get(name, Kind.NUMBER).written)
    return UncertaintySettings(variability=variability, count=count, seed=seed)


def _nominal_values(use: HipSimulation) -> dict[str, float]:
    """Return the nominal values of the quantities that may differ between patients."""
    coefficient, cup = coefficient_field(use.wear), use.frame.placed
    values = {"clearance": use.joint.clearance, "inclination": cup.inclination, "anteversion": cup.anteversion}
    known = values if coefficient is None else {**values, "coefficient": getattr(use.wear, coefficient.name)}
    return {name: float(value) for name, value in known.items()}


def _read_body_weight(content: Mapping[str, Any]) -> float | None:
    """Read the body weight in N that the forces refer to; None if the file states no body weight."""
    tables = (content, table_of(content, "cycle"), *content.get("activity", []))
    weights = {parse("body_weight", table["body_weight"], Kind.FORCE) for table in tables if "body_weight" in table}
    if len(weights) > 1:
        raise ValueError("body_weight has several values, but patients need one: give it once, at the top of the file")
    return weights.pop() if weights else None


def _quantity_reader(name: str, use: HipSimulation) -> Read:
    """Return the function that reads a sampled quantity from text with a unit."""
    if name != "coefficient":
        return lambda key, value: parse(key, value, _SAMPLED_KINDS[name])
    coefficient = coefficient_field(use.wear)
    return wear_factor if coefficient is None else coefficient.unit.read


def _read_integer(name: str, value: Any) -> int:
    """Read an integer from 0 to the largest allowed one."""
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= _MAX_INTEGER:
        raise ValueError(f"{name} = {shown(value)} is not allowed: it must be an integer from 0 to {_MAX_INTEGER}")
    return value
