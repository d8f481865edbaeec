"""Schema of the cycles of hip files: their tables and keys, with the parameters of all registered cycles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import msgspec

from ..files.joint_file import JointTables
from ..files.schema import (
    Force,
    Parsed,
    PlainNumber,
    QuantityValue,
    Table,
    Texts,
    WholeNumber,
    Word,
    meaning,
    with_keys,
)
from ..problem.cup import Side
from .cycle import DEFAULT_STEPS, MAX_STEPS, MIN_STEPS
from .cycle_registry import CYCLES
from .kinematics import parse_rotation_order
from .waveforms import DEFAULT_CLOSURE


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
class CycleKeys(Table, frozen=True, kw_only=True):
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
