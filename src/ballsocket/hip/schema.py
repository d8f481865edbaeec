"""Schema of hip files: their tables and keys, with those of all registered laws and cycles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Self

import msgspec

from ..core.checks import shown
from ..files.columns import HeadKeys
from ..files.joint_file import CupTable, JointTables, ReportDetails
from ..files.schema import (
    QUANTITIES_SCHEMA,
    Angle,
    Duration,
    FileTable,
    Force,
    Length,
    Parsed,
    PlainNumber,
    QuantityValue,
    Text,
    Texts,
    Value,
    Viscosity,
    WholeNumber,
    Word,
    meaning,
    with_keys,
)
from ..model_catalogue import catalogue
from ..problem.cup import Side
from ..studies.expressions import DISTRIBUTION_SCHEMA
from .creep_laws import CONFINEMENTS, CREEP_LAWS
from .cycle import DEFAULT_STEPS, MAX_STEPS, MIN_STEPS
from .cycle_registry import CYCLES
from .cycle_tables import DEFAULT_CLOSURE
from .kinematics import parse_rotation_order
from .law_fields import Law
from .measured_wear import RATES, WEAR_QUANTITIES
from .variability import DEFAULT_COUNT, SAMPLED_QUANTITIES
from .wear_laws import BALL_COEFFICIENT, WEAR_FACTORS, WEAR_LAWS


class Steps(WholeNumber):
    """Number of time steps of a cycle."""

    limits = (MIN_STEPS, MAX_STEPS)


class RotationOrder(Parsed):
    """Order of the three rotations, such as "flexion, adduction, rotation"."""

    schema: ClassVar[Mapping[str, Any]] = {"type": ["string", "array"], "items": {"type": "string"}}

    @classmethod
    def parse(cls, name: str, value: Any) -> str:
        """Convert an order of rotations to letters of axes."""
        return parse_rotation_order(value)


class CycleName(Word):
    """Name of a cycle."""

    noun, choices = "cycle", tuple(CYCLES)


class SideName(Word):
    """Side of the body."""

    choices = tuple(side.value for side in Side)


class FrameName(Word):
    """Frame of a force."""

    choices = ("body", "femur", "cup")


class LoadedPart(Word):
    """Body that a force acts on."""

    choices = ("socket", "ball")


_PARAMETERS = {parameter.key: parameter for cycle in CYCLES.values() for parameter in cycle.parameters}


@with_keys(
    {
        key: Annotated[QuantityValue.of(parameter.kind), meaning(parameter.meaning or key.replace("_", " "))]
        for key, parameter in _PARAMETERS.items()
    }
)
class CycleKeys(HeadKeys, frozen=True, kw_only=True):
    """Cycle of loads and rotations: by name with its parameters, or from tables of measurements."""

    name: Annotated[CycleName | None, meaning("name of the cycle")] = None
    file: Annotated[Texts | None, meaning("tables of measurements of one cycle, whose heads have units")] = None
    instants: Annotated[Steps, meaning("number of time steps of a cycle")] = Steps(DEFAULT_STEPS)
    rotation_order: Annotated[RotationOrder | None, meaning("order of the rotations; flexion first by default")] = None
    body_weight: Annotated[Force | None, meaning("body weight, for loads in multiples of it")] = None
    times_body_weight: Annotated[PlainNumber | None, meaning("largest load in multiples of the body weight")] = None
    side: Annotated[SideName | None, meaning("side of the hip in the table; right by default")] = None
    frame: Annotated[FrameName | None, meaning("frame of the force")] = None
    force_on: Annotated[LoadedPart | None, meaning("body that the force acts on")] = None
    begin: Annotated[PlainNumber | None, meaning("start of the cycle in the table: s, or phase")] = msgspec.field(
        name="from", default=None
    )
    end: Annotated[PlainNumber | None, meaning("end of the cycle in the table: s, or phase")] = msgspec.field(
        name="to", default=None
    )
    closing: Annotated[
        PlainNumber | None, meaning(f"allowed difference of the ends over the range; {DEFAULT_CLOSURE:g} by default")
    ] = None
    motion: Annotated[CycleName | None, meaning("name of the cycle whose rotations are used")] = None

    def parameter(self, key: str) -> float | None:
        """Return the value of a parameter of a named cycle; None without one."""
        value: QuantityValue | None = getattr(self, key)
        return None if value is None else float(value)


class ActivityTable(CycleKeys, frozen=True, kw_only=True):
    """Activity: a cycle and the number of its repetitions."""

    per_year: Annotated[PlainNumber | None, meaning("cycles a year")] = None
    share: Annotated[PlainNumber | None, meaning("share of cycles_per_year")] = None


class CycleTables(JointTables, frozen=True, kw_only=True):
    """Joint with its cycle, or with a mix of activities."""

    body_weight: Annotated[Force | None, meaning("body weight, for loads in multiples of it")] = None
    cycles_per_year: Annotated[PlainNumber | None, meaning("cycles a year, of which activities have shares")] = None
    cycle: CycleKeys | None = None
    activity: list[ActivityTable] | None = None


class Cycles(Value, float):
    """Number of cycles."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "number"}
    example: ClassVar[str] = "5e6"

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a number without a unit."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"{name} = {shown(value)} must be a number, such as {cls.example}")
        return cls(value)


class Years(Cycles):
    """Number of years."""

    example = "20"


class Counts(Value, list[float]):
    """List of numbers of cycles or years."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "array", "items": Cycles.schema}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a list of numbers without units."""
        if not isinstance(value, list):
            raise ValueError(f"{name} = {shown(value)} must be a list of numbers")
        return cls(Cycles.read(f"{name}[{i}]", number) for i, number in enumerate(value))


_MAX_INTEGER = 1 << 20  # largest number of samples and largest seed


class SampleNumber(WholeNumber):
    """Whole number."""

    limits = (0, _MAX_INTEGER)


class LawNumber(Parsed):
    """Number of the law."""

    schema: ClassVar[Mapping[str, Any]] = {"type": ["number", "string", "array"]}


class PatientNumber(Parsed):
    """Distribution `{low, high}`, `{mean, deviation}`, `{median, factor}` or `{nominal, plus_minus}`."""

    schema: ClassVar[Mapping[str, Any]] = DISTRIBUTION_SCHEMA


class WearLawName(Word):
    """Name of a wear law."""

    noun, choices = "law", tuple(WEAR_LAWS)


class CreepLawName(Word):
    """Name of a creep law."""

    noun, choices = "creep law", tuple(CREEP_LAWS)


class Confinement(Word):
    """Confinement of a liner."""

    choices = tuple(CONFINEMENTS)


class ContactName(Word):
    """Foundation of a socket."""

    choices = ("springs", "shell", "cup")


class SpringModel(Word):
    """Name of a model with springs."""

    noun, choices = "model", tuple(catalogue)


def _law_keys(laws: Mapping[str, type[Law]]) -> dict[str, Any]:
    """Return the type of each key of the laws, with its meaning and unit."""
    fields = {field.key: field for law in laws.values() for field in law.law_fields()}
    units = {key: f" in {field.unit.text}" if field.unit.text else "" for key, field in fields.items()}
    return {key: Annotated[LawNumber, meaning(f"{field.meaning}{units[key]}")] for key, field in fields.items()}


class HipCupTable(CupTable, frozen=True, kw_only=True):
    """Cup, with an orientation in the body or a tilt from the load."""

    tilt: Annotated[Angle | None, meaning("tilt from the load, in place of inclination and anteversion")] = None


@with_keys(
    {
        **_law_keys(WEAR_LAWS),
        BALL_COEFFICIENT: Annotated[LawNumber, meaning("wear coefficient of the ball, if it wears too")],
    }
)
class WearTable(FileTable, frozen=True, kw_only=True):
    """Wear law, with the numbers of all registered laws, and the foundation of the contacts."""

    law: Annotated[WearLawName | None, meaning("wear law")] = None
    material: Annotated[
        Text | None, meaning(f"material of a published coefficient, in its place: {', '.join(WEAR_FACTORS)}")
    ] = None
    contact: Annotated[ContactName, meaning("foundation of the socket")] = ContactName("springs")
    model: Annotated[SpringModel | None, meaning("model with the springs; hess-forsbach by default")] = None
    ring_width: Annotated[Angle | None, meaning("width of the rings of the wear map; 3 degrees by default")] = None
    film_limit: Annotated[
        PlainNumber | None, meaning("film ratio below which the surfaces wear, by the lubricant of [film]")
    ] = None


@with_keys(_law_keys(CREEP_LAWS))
class CreepTable(FileTable, frozen=True, kw_only=True):
    """Creep law of the liner, with the numbers of all registered laws."""

    law: Annotated[CreepLawName | None, meaning("creep law")] = None
    confinement: Annotated[Confinement | None, meaning("confinement of the liner; unconfined by default")] = None
    seconds_per_cycle: Annotated[Duration | None, meaning("time that a cycle stands for")] = None


class FilmTable(FileTable, frozen=True, kw_only=True):
    """Fluid film and friction; without this table no film is computed."""

    viscosity: Annotated[Viscosity | None, meaning("dynamic viscosity")] = None
    ball_roughness: Annotated[Length | None, meaning("roughness Ra of the ball")] = None
    cup_roughness: Annotated[Length | None, meaning("roughness Ra of the cup")] = None
    friction: Annotated[PlainNumber | None, meaning("coefficient of friction")] = None
    boundary_friction: Annotated[
        PlainNumber | None, meaning("coefficient of friction of touching surfaces; friction then depends on the film")
    ] = None


@with_keys(
    {
        name: Annotated[PatientNumber, meaning(f"{name.replace('_', ' ')} among the patients")]
        for name in SAMPLED_QUANTITIES
    }
)
class UncertaintyTable(FileTable, frozen=True, kw_only=True):
    """Quantities that differ between patients, with their distributions."""

    contact: Annotated[
        ContactName, meaning("foundation of the patients' sockets; 'cup' takes some 80 times as long as 'springs'")
    ] = ContactName("springs")
    count: Annotated[SampleNumber, meaning("number of samples from 2; a power of two fills the space most evenly")] = (
        SampleNumber(DEFAULT_COUNT)
    )
    seed: Annotated[SampleNumber, meaning("seed of the samples")] = SampleNumber(0)


class WearQuantity(Word):
    """Measured wear."""

    noun, choices = "quantity", (*WEAR_QUANTITIES, "mass")


class WearRate(Word):
    """Kind of a rate of wear."""

    noun, choices = "rate", RATES


class WearValues(Parsed):
    """Number with a unit, or list of them: '38 mm^3/Mc', ['33 mm^3', '69 mm^3'], '0.1 mm/year'."""

    schema: ClassVar[Mapping[str, Any]] = QUANTITIES_SCHEMA


class CycleCounts(Value, list[float]):
    """Number of cycles, or list of them."""

    schema: ClassVar[Mapping[str, Any]] = {"anyOf": [Cycles.schema, Counts.schema]}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a number or a list of numbers without units."""
        return cls(Counts.read(name, value if isinstance(value, list) else [value]))


class WearDataTable(HeadKeys, frozen=True, kw_only=True):
    """Measured wear, from which `ballsocket identify` fits the wear coefficient."""

    quantity: Annotated[WearQuantity | None, meaning("measured quantity")] = None
    values: Annotated[WearValues | None, meaning("measured totals, or rates: '38 mm^3/Mc'")] = None
    station: Annotated[
        Texts | None, meaning("station (specimen) of the values, one or one for each; its readings are cumulative")
    ] = None
    file: Annotated[
        Text | None, meaning("table of readings: a column for each station, or columns station and quantity")
    ] = None
    unit: Annotated[Text | None, meaning("unit of the columns of the file whose heads have none")] = None
    density: Annotated[WearValues | None, meaning("density of the worn material, for a mass: '0.94 g/cm^3'")] = None
    cycles: Annotated[CycleCounts | None, meaning("numbers of cycles of the totals")] = None
    rate: Annotated[WearRate | None, meaning("kind of the rate: of the new bore, between two counts, from 0")] = None
    begin: Annotated[Cycles | None, meaning("number of cycles at which a steady rate begins")] = msgspec.field(
        name="from", default=None
    )
    end: Annotated[Cycles | None, meaning("number of cycles at which a rate ends")] = msgspec.field(
        name="to", default=None
    )
    uncertainty: Annotated[
        WearValues | None,
        meaning("standard uncertainty, or '10 %' of the fitted values; by default from the scatter"),
    ] = None
    name: Annotated[Text | None, meaning("name of the data in messages")] = None


class HipTable(CycleTables, frozen=True, kw_only=True):
    """Hip file."""

    name: Annotated[Text | None, meaning("name of the simulation")] = None
    source: Annotated[Text | None, meaning("source of the numbers")] = None
    cycles: Annotated[Cycles | None, meaning("number of cycles; 5e6 by default")] = None
    report_at: Annotated[Counts | None, meaning("numbers of cycles of the reports; ten equal steps by default")] = None
    years: Annotated[Years | None, meaning("years of activities, in place of cycles")] = None
    report_years: Annotated[Counts | None, meaning("years of the reports; ten equal steps by default")] = None
    cup: HipCupTable | None = None
    wear: WearTable = WearTable()
    creep: CreepTable | None = None
    film: FilmTable | None = None
    uncertainty: UncertaintyTable | None = None
    data: Annotated[list[WearDataTable] | None, meaning("measured wear, for ballsocket identify")] = None
    report: ReportDetails | None = None
