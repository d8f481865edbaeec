"""Schema of hip files: their tables and keys, with those of all registered laws and cycles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Self

import msgspec

from ..core.checks import shown
from ..files.joint_file import CupTable, JointTables
from ..files.schema import (
    QUANTITY_SCHEMA,
    Angle,
    Force,
    Length,
    Number,
    Quantity,
    Table,
    Text,
    Texts,
    Value,
    Whole,
    meaning,
    table_of_quantities,
)
from .creep_laws import CREEP_LAWS
from .cycle_registry import CYCLES
from .law_fields import Law
from .variability import SAMPLED_QUANTITIES
from .wear_laws import BALL_COEFFICIENT, WEAR_LAWS


class Count(Value, float):
    """Number of cycles or years, without a unit."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "number"}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a number."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"{name} = {shown(value)} must be a number, such as {_EXAMPLES.get(name, '5e6')}")
        return cls(value)


_EXAMPLES = {"years": "20"}


class Counts(Value, list[float]):
    """List of numbers of cycles or years."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "array", "items": {"type": "number"}}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a list of numbers."""
        if not isinstance(value, list):
            raise ValueError(f"{name} = {shown(value)} must be a list of numbers")
        return cls(Count.read(name, number) for number in value)


class LawNumber(Value):
    """Number of a law, which the law itself reads."""

    schema: ClassVar[Mapping[str, Any]] = {"type": ["number", "string", "array"]}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Accept any value: the law states unit and limits."""
        return cls()


class PatientNumber(Value):
    """Distribution among patients: `{low, high}`, `{mean, deviation}`, `{median, factor}`, `{nominal, plus_minus}`."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "object", "additionalProperties": QUANTITY_SCHEMA}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Accept any value: its unit depends on the wear law."""
        return cls()


def _law_keys(laws: Mapping[str, type[Law]]) -> dict[str, Any]:
    """Return the type of each key of the laws, with its meaning and unit."""
    fields = {field.key: field for law in laws.values() for field in law.law_fields()}
    return {
        key: Annotated[
            LawNumber | None, meaning(f"{field.meaning}{f' in {field.unit.text}' if field.unit.text else ''}")
        ]
        for key, field in fields.items()
    }


def _table(name: str, keys: Mapping[str, Any], base: type[Table]) -> type[Any]:
    """Create a table with optional keys of the given types and those of a base."""
    return msgspec.defstruct(
        name, [(key, kind, None) for key, kind in keys.items()], bases=(base,), kw_only=True, module=__name__
    )


class HipCupTable(CupTable, kw_only=True):
    """Cup, with an orientation in the body or a tilt from the load."""

    tilt: Annotated[Angle | None, meaning("tilt from the load, in place of inclination and anteversion")] = None


class CycleKeys(Table, kw_only=True):
    """Cycle of loads and rotations: by name, or from tables of measurements."""

    name: Annotated[Text | None, meaning("name of the cycle")] = None
    file: Annotated[Texts | None, meaning("tables of measurements of one cycle, whose heads have units")] = None
    instants: Annotated[Whole | None, meaning("number of instants of a cycle")] = None
    rotation_order: Annotated[Text | None, meaning("order of the rotations; flexion, adduction, rotation")] = None
    body_weight: Annotated[Force | None, meaning("body weight, for loads in multiples of it")] = None
    times_body_weight: Annotated[Number | None, meaning("largest load in multiples of the body weight")] = None
    side: Annotated[Text | None, meaning("side of the hip in the table: right or left")] = None
    frame: Annotated[Text | None, meaning("frame of the force: body, femur or cup")] = None
    force_on: Annotated[Text | None, meaning("body that the force acts on: socket or ball")] = None
    begin: Annotated[Number | None, meaning("start of the cycle in the table: s, or phase 0 to 1")] = msgspec.field(
        name="from", default=None
    )
    end: Annotated[Number | None, meaning("end of the cycle in the table: s, or phase 0 to 1")] = msgspec.field(
        name="to", default=None
    )
    closing: Annotated[Number | None, meaning("allowed difference of the ends over the range; 0.01 by default")] = None
    motion: Annotated[Text | None, meaning("name of the cycle whose rotations are used")] = None


_PARAMETERS = {parameter.key: parameter for definition in CYCLES.values() for parameter in definition.parameters}
CycleTable = table_of_quantities("CycleTable", _PARAMETERS, Quantity, (CycleKeys,))
"""Cycle, with the parameters of the named cycles."""


class ActivityTable(CycleTable, kw_only=True):  # type: ignore[misc, valid-type]
    """Activity: a cycle and the number of its repetitions."""

    per_year: Annotated[Number | None, meaning("cycles a year")] = None
    share: Annotated[Number | None, meaning("share of cycles_per_year")] = None


class WearKeys(Table, kw_only=True):
    """Wear law, with its numbers and the foundation of the contacts."""

    law: Annotated[Text | None, meaning(f"wear law: {', '.join(WEAR_LAWS)}")] = None
    contact: Annotated[Text | None, meaning("foundation of the socket: springs, shell or cup; springs by default")] = (
        None
    )
    model: Annotated[Text | None, meaning("model with the springs; hess-forsbach by default")] = None
    ring_width: Annotated[Angle | None, meaning("width of the rings of the wear map; 3 degrees by default")] = None


WearTable = _table(
    "WearTable",
    {
        **_law_keys(WEAR_LAWS),
        BALL_COEFFICIENT: Annotated[LawNumber | None, meaning("wear coefficient of the ball, if it wears too")],
    },
    WearKeys,
)
"""Wear law, with the numbers of all registered laws."""


class CreepKeys(Table, kw_only=True):
    """Creep law of the liner, with its numbers."""

    law: Annotated[Text | None, meaning(f"creep law: {', '.join(CREEP_LAWS)}")] = None
    confinement: Annotated[Text | None, meaning("confinement of the liner: unconfined or constrained")] = None
    seconds_per_cycle: Annotated[Number | None, meaning("time in s that a cycle stands for")] = None


CreepTable = _table("CreepTable", _law_keys(CREEP_LAWS), CreepKeys)
"""Creep law, with the numbers of all registered laws."""


class FilmTable(Table, kw_only=True):
    """Fluid film and friction."""

    viscosity: Annotated[Number | None, meaning("dynamic viscosity in Pa s")] = None
    ball_roughness: Annotated[Length | None, meaning("roughness Ra of the ball")] = None
    cup_roughness: Annotated[Length | None, meaning("roughness Ra of the cup")] = None
    friction: Annotated[Number | None, meaning("coefficient of friction")] = None


class SampleKeys(Table, kw_only=True):
    """Quantities that differ between patients."""

    count: Annotated[Any, meaning("number of samples, a power of two")] = None
    seed: Annotated[Any, meaning("seed of the samples; 0 by default")] = None


UncertaintyTable = _table("UncertaintyTable", dict.fromkeys(SAMPLED_QUANTITIES, PatientNumber | None), SampleKeys)
"""Quantities that differ between patients, with their distributions."""


class HipTable(JointTables, kw_only=True):
    """Hip file."""

    name: Annotated[Text | None, meaning("name of the simulation")] = None
    source: Annotated[Text | None, meaning("source of the numbers")] = None
    body_weight: Annotated[Force | None, meaning("body weight, for loads in multiples of it")] = None
    cycles: Annotated[Count | None, meaning("number of cycles; 5e6 by default")] = None
    report_at: Annotated[Counts | None, meaning("numbers of cycles of the reports; ten equal steps by default")] = None
    cycles_per_year: Annotated[Number | None, meaning("cycles a year, of which activities have shares")] = None
    years: Annotated[Count | None, meaning("years of activities, in place of cycles")] = None
    report_years: Annotated[Counts | None, meaning("years of the reports; ten equal steps by default")] = None
    cup: HipCupTable | None = None
    cycle: CycleTable | None = None  # type: ignore[valid-type]
    activity: list[ActivityTable] | None = None
    wear: WearTable | None = None  # type: ignore[valid-type]
    creep: CreepTable | None = None  # type: ignore[valid-type]
    film: FilmTable | None = None
    uncertainty: UncertaintyTable | None = None  # type: ignore[valid-type]
