"""Hip files: wear simulations in TOML with units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import degrees, inf, pi
from pathlib import Path
from types import MappingProxyType
from typing import Any

import msgspec

from ..core.checks import number_of_percent, require, shown
from ..core.kinds import Kind
from ..elasticity.off_axis.surfaces import ClosedShell, RealCup, Springs
from ..files.columns import ALL_COLUMNS
from ..files.joint_file import NO_DETAILS, CupTable, JointFile, ReportDetails, cup_of, details_in, joint_in
from ..files.tables import quantities_of, read_table
from ..files.toml import read_toml
from ..files.units import convert, parse, parse_units, split_quantity
from ..lubrication import Lubricant, Stribeck
from ..model_catalogue import catalogue
from ..models.foundation import RadialFoundation
from ..studies.distributions import check_nominal
from ..studies.expressions import Read, distribution_of
from .creep_law import CreepLaw
from .creep_laws import read_creep_law
from .cycle_file import cycle_of
from .film_limit import FilmLimit
from .law_fields import select_law_class
from .measured_wear import MILLION, RATES, MeasuredWear, read_stations
from .schema import FilmTable, HipCupTable, HipTable, PatientNumber, UncertaintyTable, WearDataTable
from .simulation import HipSimulation, check_cycles
from .variability import DEFAULT_COUNT, SAMPLED_QUANTITIES, PatientVariability
from .wear_law import COEFFICIENT, coefficient_field, wear_factor
from .wear_laws import MATERIAL, WEAR_LAWS, read_ball_law, read_wear_law

_DEFAULT_CYCLES = 5e6
_DEFAULT_N_REPORTS = 10


@dataclass(frozen=True, kw_only=True, eq=False)
class HipFile:
    """Contents of a hip file."""

    use: HipSimulation
    cycles: float  # number of cycles
    report_at: tuple[float, ...]  # cycle counts of the reports
    # lubricant of the film; None if neither [film] nor a limit of the film ratio asks for one
    lubricant: Lubricant | None
    # distributions of quantities that differ between patients; None without a table [uncertainty]
    uncertain: UncertaintySettings | None = None
    data: tuple[MeasuredWear, ...] = ()  # measured wear of the tables [[data]]
    name: str = ""  # name of the simulation; empty if the file states none
    report: ReportDetails = NO_DETAILS  # head of a report; without [report] that of the joint file


def read_hip(path: str | Path) -> HipFile:
    """Read a hip file.

    The joint is described as in joint files, or named: a preset, or a joint file in the same folder. The page "Keys of
    files" of the reference lists all tables and keys. Paths are relative to the folder of the file.

    Raises ValueError: a wrong key or value. The message is one sentence, with the nearest known name or the allowed
    values.
    Raises OSError: a file cannot be read.
    """
    path = Path(path)
    return read_toml(path, "hip", lambda content: _parse_hip(content, path.parent))


def read_wear_test(path: str | Path) -> HipFile:
    """Read a hip file with measured wear in [[data]]; its wear coefficient is fitted and may be missing.

    Raises ValueError: as `read_hip`, or a file without [[data]].
    Raises OSError: a file cannot be read.
    """
    path = Path(path)
    hip_file = read_toml(path, "wear test", lambda content: _parse_hip(_with_coefficient(content), path.parent))
    if not hip_file.data:
        raise ValueError(f"{path.name}: no measured wear: add [[data]] with quantity, values and cycles, or a file")
    return hip_file


def _with_coefficient(content: Mapping[str, Any]) -> Mapping[str, Any]:
    """Add a wear coefficient to start from, if the file states none."""
    law_numbers = content.get("wear", {})
    if not isinstance(law_numbers, Mapping) or {COEFFICIENT, MATERIAL} & set(law_numbers):
        return content
    law = select_law_class(law_numbers, WEAR_LAWS, "law")
    examples = [field.example for field in law.law_fields() if field.key == COEFFICIENT]
    return {**content, "wear": {**law_numbers, COEFFICIENT: examples[0]}} if examples else content


def _parse_hip(content: Mapping[str, Any], folder: Path) -> HipFile:
    tables = read_table(content, HipTable)
    joint_file = _parse_joint(tables, folder)
    cycle, law_numbers = cycle_of(tables, folder), content.get("wear", {})
    seconds = None if tables.creep is None else tables.creep.seconds_per_cycle
    limit = tables.wear.film_limit
    lubricant = None if tables.film is None and limit is None else _lubricant(tables.film or FilmTable())
    use = HipSimulation(
        joint=joint_file.joint,
        cup=joint_file.cup,
        cycle=cycle,
        wear=read_wear_law(law_numbers),
        ball_wear=read_ball_law(law_numbers),
        surface=socket_surface(tables.wear.contact, tables.wear.model),
        creep=parse_creep(content, float(joint_file.joint.liner.poisson)),
        seconds_per_cycle=None if seconds is None else float(seconds),
        film_limit=None if limit is None or lubricant is None else FilmLimit(ratio=float(limit), lubricant=lubricant),
        remarks=unused_load(joint_file),
        **quantities_of(tables.wear, "ring_width"),
    )
    cycles, report_at = _length(tables, cycle.per_year)
    check_cycles(cycles, report_at)
    return HipFile(
        use=use,
        cycles=cycles,
        report_at=report_at,
        lubricant=lubricant,
        uncertain=None if tables.uncertainty is None else _read_uncertainty(tables, tables.uncertainty, use),
        data=tuple(_parse_measured_wear(table, cycle.per_year, tables, folder) for table in tables.data or ()),
        name=str(tables.name or ""),
        report=joint_file.report if tables.report is None else details_in(folder, tables.report),
    )


_PER_MILLION, _PER_YEAR = ("Mc", "million cycles"), ("year", "a")  # ends of the unit of a rate, behind the slash


def _lubricant(table: FilmTable) -> Lubricant:
    values: dict[str, Any] = quantities_of(table)
    boundary = values.pop("boundary_friction", None)
    if boundary is None:
        return Lubricant(**values)
    if "friction" in values:
        raise ValueError("[film] has friction and boundary_friction: give a constant coefficient or one by the film")
    return Lubricant(**values, friction=Stribeck(boundary=boundary))


_WEAR_UNITS = {"volume": "mm^3", "mass": "mg"}  # units of measured wear; others are in mm


def _parse_measured_wear(table: WearDataTable, per_year: float | None, tables: HipTable, folder: Path) -> MeasuredWear:
    """Create the measured wear of a table [[data]]; a mass becomes a volume by its density."""
    if table.quantity is None:
        raise ValueError("[[data]] of measured wear needs its quantity")
    quantity = str(table.quantity)
    stated, cycles, station, remark = _stated_readings(table, quantity, folder)
    if per_year is None and tables.cycles_per_year is not None:
        per_year = float(tables.cycles_per_year)
    unit, density = _WEAR_UNITS.get(quantity, "mm"), _density(table, quantity)
    factor = 1.0 if density is None else density

    def parse_all(name: str, numbers: Any) -> list[float]:
        """Convert a number or a list of numbers with units to mm³ or mm."""
        listed = numbers if isinstance(numbers, list) else [numbers]
        return [_parse_wear(name, number, unit, table.rate is not None, per_year) / factor for number in listed]

    text = None if table.uncertainty is None else table.uncertainty.value
    percent = number_of_percent(text)
    begin, end = (None if count is None else float(count) for count in (table.begin, table.end))
    return MeasuredWear(
        quantity="volume" if quantity == "mass" else quantity,
        values=parse_all("values" if table.file is None else f"{table.file}: values", stated),
        cycles=cycles,
        rate=None if table.rate is None else str(table.rate),
        begin=begin,
        end=end,
        uncertainty=None if text is None or percent is not None else parse_all("uncertainty", text),
        relative_uncertainty=None if percent is None else parse("uncertainty", percent, Kind.NUMBER) / 100,
        station=station,
        density=density,
        name=str(table.name or ""),
        remark=remark,
    )


def _stated_readings(table: WearDataTable, quantity: str, folder: Path) -> tuple[Any, Any, Any, str]:
    """Return values with units, cycles, stations and a remark of a table [[data]], as stated or from its file."""
    if (table.values is None) == (table.file is None):
        raise ValueError("[[data]] of measured wear needs its values, or else the file with a table of them")
    if table.values is not None:
        if table.unit is not None:
            raise ValueError("unit belongs to a file: write the values with it, such as '38 mm^3'")
        if table.choice() != ALL_COLUMNS:
            raise ValueError("columns and skip belong to a file: remove them, or name the file")
        names = table.station
        return table.values.value, table.cycles, names[0] if names is not None and len(names) == 1 else names, ""
    for key in ("cycles", "station"):
        if getattr(table, key) is not None:
            raise ValueError(f"{key} and file exclude each other: the file has a column of them; remove {key}")
    readings = read_stations(folder / str(table.file), quantity, table.unit, table.choice())
    return list(readings.values), list(readings.cycles) or None, readings.stations, readings.remark


def _density(table: WearDataTable, quantity: str) -> float | None:
    """Return the density in mg/mm³ by which a mass is a volume; None for other quantities."""
    if (table.density is None) == (quantity == "mass"):
        raise ValueError(
            "a mass needs the density of the worn material, such as density = '0.94 g/cm^3'"
            if quantity == "mass"
            else f"density belongs to quantity = 'mass', and the quantity is {quantity}"
        )
    if table.density is None:
        return None
    value = table.density.value
    try:
        number, text = split_quantity(str(value))
        density = convert(number, parse_units(text), parse_units("mg/mm^3"))
    except ValueError as error:
        raise ValueError(f"density = {shown(value)} must be a number with a unit, such as '0.94 g/cm^3'") from error
    require("density", density, 0 < density < inf, "a density (mg/mm³) is positive and finite")
    return density


def _parse_wear(name: str, value: Any, unit: str, is_rate: bool, per_year: float | None) -> float:
    """Convert a total or a rate with its unit to mm³ or mm, or to mm³ or mm per million cycles."""
    total_text, _, period = value.rpartition("/") if isinstance(value, str) else ("", "", "")
    has_period = period.strip() in (*_PER_MILLION, *_PER_YEAR)
    if is_rate and not has_period:
        raise ValueError(f"{name} = {shown(value)} of a rate needs a unit such as '38 {unit}/Mc' or '8 {unit}/year'")
    if has_period and not is_rate:
        raise ValueError(f"{name} = {shown(value)} is a rate: state its kind, rate = {', '.join(map(repr, RATES))}")
    try:
        number, text = split_quantity(total_text if has_period else str(value))
        total = convert(number, parse_units(text or unit), parse_units(unit))
    except ValueError as error:
        raise ValueError(
            f"{name} = {shown(value)} must be a number with {unit} or a unit that converts to it, such as '38 {unit}'"
        ) from error
    if not 0 < total < inf:
        raise ValueError(
            f"{name} = {shown(value)} is not allowed: a measured wear and its uncertainty are positive and finite; "
            "leave out readings without wear"
        )
    if period.strip() not in _PER_YEAR:
        return total
    if per_year is None:
        raise ValueError(f"{name} = {shown(value)} is per year: state cycles_per_year at the top of the file")
    return total * MILLION / per_year


def parse_creep(content: Mapping[str, Any], poisson: float) -> CreepLaw | None:
    """Read the creep law of the table [creep], for a liner with a Poisson's ratio; None without the table."""
    return read_creep_law(content["creep"], poisson) if "creep" in content else None


_ELASTIC_SURFACES: Mapping[str, ClosedShell | RealCup | None] = MappingProxyType(
    {"springs": None, "shell": ClosedShell(), "cup": RealCup()}
)


def socket_surface(contact: str = "springs", model: str | None = None) -> Springs | ClosedShell | RealCup:
    """Return the foundation of the socket by its name in files, with the model of its springs."""
    elastic = _ELASTIC_SURFACES[contact]
    if elastic is not None:
        if model is not None:
            raise ValueError(
                f"model needs contact = 'springs', and contact is {str(contact)!r}: remove model or contact"
            )
        return elastic
    springs = catalogue[model or "hess-forsbach"]
    if not isinstance(springs, RadialFoundation):
        names = ", ".join(name for name, model in catalogue.items() if isinstance(model, RadialFoundation))
        raise ValueError(f"the model {springs.name!r} has no radial springs; models with springs: {names}")
    return Springs(modulus=springs.modulus)


def _length(tables: HipTable, per_year: float | None) -> tuple[float, tuple[float, ...]]:
    """Return the number of cycles of a run and of its reports, ten by default; a file may state them in years."""
    if per_year is None or tables.years is None:
        for name in ("years", "report_years"):
            if getattr(tables, name) is not None:
                raise ValueError(f"{name} needs activities with counts a year, and years: [[activity]]")
        unit, end, points = 1.0, float(_DEFAULT_CYCLES if tables.cycles is None else tables.cycles), tables.report_at
    else:
        for name in ("cycles", "report_at"):
            if getattr(tables, name) is not None:
                raise ValueError(f"{name} and years exclude each other: both set the length of the run; remove one")
        unit, end, points = per_year, float(tables.years), tables.report_years
    steps = range(1, _DEFAULT_N_REPORTS + 1)
    listed = [step * end / _DEFAULT_N_REPORTS for step in steps] if points is None else map(float, points)
    return end * unit, tuple(point * unit for point in listed)


def unused_load(file: JointFile) -> tuple[str, ...]:
    """Return the note that a hip does not use the load of its joint file; empty without one."""
    names = " and ".join(file.load | file.aim)
    return (f"{names} of the load in the joint file: not used, because the cycle loads the hip",) if names else ()


def _parse_joint(tables: HipTable, folder: Path) -> JointFile:
    """Create joint and cup of a hip file; the cup may have a tilt in place of angles, also with a named joint."""
    table = tables.cup or HipCupTable()
    file = joint_in(msgspec.structs.replace(tables, cup=None), folder)
    if any(getattr(table, key) is not None for key in CupTable.__struct_fields__):
        file = replace(file, cup=cup_of(table, file.cup))
    if table.tilt is None:
        return file
    for name in ("inclination", "anteversion"):
        if getattr(table, name) is not None:
            raise ValueError(f"tilt and {name} exclude each other: both set the orientation of the cup; remove one")
    angle = float(table.tilt)
    require("tilt", degrees(angle), 0 <= angle <= pi / 2, "a cup's tilt from the load is 0 to 90 degrees")
    return replace(file, cup=file.cup.tilted(angle))


_SAMPLED_KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        "clearance": Kind.LENGTH,
        **dict.fromkeys(("inclination", "anteversion", "tilt"), Kind.ANGLE),
        "body_weight": Kind.FORCE,
        "cycles_per_year": Kind.NUMBER,
    }
)
"""Physical kinds of the sampled quantities except the wear coefficient, whose unit depends on the law."""


@dataclass(frozen=True, kw_only=True, eq=False)
class UncertaintySettings:
    """Settings of the table [uncertainty]."""

    variability: PatientVariability  # distributions of the patients
    count: int  # number of samples, 2 or more
    seed: int  # seed of the samples


def _read_uncertainty(tables: HipTable, table: UncertaintyTable, use: HipSimulation) -> UncertaintySettings:
    coefficient, cup = coefficient_field(use.wear), use.frame.placed
    readers: dict[str, Read] = {name: partial(parse, kind=kind) for name, kind in _SAMPLED_KINDS.items()}
    readers[COEFFICIENT] = wear_factor if coefficient is None else coefficient.unit.read
    nominal = {"clearance": use.joint.clearance, "inclination": cup.inclination, "anteversion": cup.anteversion}
    nominal |= {} if coefficient is None else {COEFFICIENT: getattr(use.wear, coefficient.name)}
    stated = {name: value for name, value in table.stated().items() if isinstance(value, PatientNumber)}
    distributions = {
        name: distribution_of(name, stated[name].value, readers[name]) for name in SAMPLED_QUANTITIES if name in stated
    }
    count = int(table.count)
    require("count", count, count >= 2, f"it must be at least 2, such as {DEFAULT_COUNT}")
    weight = None
    if "body_weight" in distributions:  # the one that the forces refer to
        cycles = [tables.cycle] if tables.cycle is not None else tables.activity or []
        weights = {one.body_weight for one in (tables, *cycles) if one.body_weight is not None}
        if len(weights) > 1:
            raise ValueError(
                "body_weight has several values, but patients need one: give it once, at the top of the file"
            )
        weight = float(weights.pop()) if weights else None
    variability = PatientVariability(
        use=use, distributions=distributions, body_weight=weight, surface=_ELASTIC_SURFACES[table.contact]
    )
    for name, value in nominal.items():
        if name in distributions:
            check_nominal(name, float(value), distributions[name], _SAMPLED_KINDS.get(name, Kind.NUMBER).written)
    return UncertaintySettings(variability=variability, count=count, seed=int(table.seed))
