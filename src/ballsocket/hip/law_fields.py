"""Fields of wear and creep laws: units, limits, and their values in files and JSON."""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, field, fields
from math import inf
from numbers import Real
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar

from ..core.checks import known_name, require, shown
from ..core.kinds import Kind
from ..files.units import parse


@dataclass(frozen=True, kw_only=True)
class LawUnit:
    """Unit of a field of a wear or creep law."""

    text: str  # unit after a number in texts; empty for a plain number
    typed: str  # unit as files write it
    suffix: str  # end of a key in JSON
    read: Callable[[str, Any], Any]  # function from name and value in a file to the value in this unit

    def example(self, value: Any) -> str:
        """Format an example value with its unit, as it is written in files."""
        if isinstance(value, tuple):
            return f"[{', '.join(f'{number:g}' for number in value)}]"
        return f"'{value:g} {self.typed}'" if self.typed else f"{value:g}"


def kind_unit(kind: Kind) -> LawUnit:
    """Create the unit of a field from its kind of quantity, such as a pressure."""
    text = "" if kind is Kind.NUMBER else kind.unit
    return LawUnit(text=text, typed=text, suffix=text, read=lambda name, value: parse(name, value, kind))


def bare_unit(text: str, suffix: str) -> LawUnit:
    """Create a unit for a field that files state as a plain number, without unit text."""
    return LawUnit(text=text, typed="", suffix=suffix, read=lambda name, value: parse(name, value, Kind.NUMBER))


def list_unit(text: str, suffix: str) -> LawUnit:
    """Create a unit for a field that is a list of plain numbers."""

    def read_numbers(name: str, value: Any) -> tuple[float, ...]:
        if not isinstance(value, list) or not value:
            raise ValueError(f"{name} = {shown(value)} must be a list of numbers, in {text}")
        return tuple(parse(name, number, Kind.NUMBER) for number in value)

    return LawUnit(text=text, typed=text, suffix=suffix, read=read_numbers)


NUMBER = kind_unit(Kind.NUMBER)  # unit of a plain number
PRESSURE = kind_unit(Kind.MODULUS)  # unit of a pressure: MPa


@dataclass(frozen=True, kw_only=True)
class LawField:
    """Field of a wear or creep law: one number or a list, with unit, meaning and limits."""

    name: str  # name of the attribute
    key: str  # key in files
    unit: LawUnit
    meaning: str  # noun phrase for messages and labels
    example: Any  # value for messages, and initial value in the explorer
    required: bool  # True if the law has no default for it
    # limits; `high` itself is excluded
    low: float
    high: float
    low_included: bool  # True if `low` itself is allowed

    @property
    def is_list(self) -> bool:
        """True if the value of the field is a tuple of numbers."""
        return isinstance(self.example, tuple)

    def check(self, value: Any) -> None:
        """Check type and limits of a value of this field; TypeError or ValueError otherwise."""
        for number in value if self.is_list else (value,):
            if not isinstance(number, Real) or isinstance(number, bool):
                wanted = "a tuple of numbers" if self.is_list else "one number"
                raise TypeError(f"{self.name} must be {wanted}, got {value!r:.60}")
            float_number = float(number)
            above_low = self.low <= float_number if self.low_included else self.low < float_number
            low = f"{'at least' if self.low_included else 'above'} {self.low:g}"
            high = "finite" if self.high == inf else f"below {self.high:g}"
            rule = f"{self.meaning} ({self.unit.text or 'a number'}) is {low}, and {high}"
            require(self.name, number, above_low and float_number < self.high, rule)


def law_field(
    unit: LawUnit,
    meaning: str,
    *,
    example: Any,
    key: str | None = None,
    default: Any = MISSING,
    low: float = 0.0,
    high: float = inf,
    low_included: bool = True,
) -> Any:
    """Define a dataclass field of a law, with unit, meaning (noun phrase for messages and labels) and limits.

    The key in files is the name of the field by default. Without a default value the field is required. `high` itself
    is excluded, `low` only with `low_included=False`.
    """
    limits = {"low": low, "high": high, "low_included": low_included}
    metadata = {"unit": unit, "meaning": meaning, "example": example, "key": key, **limits}
    return field(default=default, metadata={"law": metadata})


class Law(ABC):
    """Base of wear and creep laws: a name, and fields with units, which files, JSON and the explorer use.

    A law is a frozen dataclass; `law_field` defines its fields.
    """

    name: ClassVar[str]
    title: ClassVar[str]
    storable: ClassVar[bool] = True
    """True if the text of the law identifies it, so that a run can be stored."""

    def __post_init__(self) -> None:
        for law_number in self.law_fields():
            value = getattr(self, law_number.name)
            law_number.check(value)
            if law_number.is_list:  # no array that its owner may change
                object.__setattr__(self, law_number.name, tuple(value))

    @classmethod
    def law_fields(cls) -> tuple[LawField, ...]:
        """List the fields of the law with their units and limits."""
        numbers = [
            (number.name, number.default is MISSING, number.metadata["law"])
            for number in fields(cls)  # type: ignore[arg-type]  # every law is a dataclass
            if "law" in number.metadata
        ]
        return tuple(
            LawField(name=name, required=required, **{**metadata, "key": metadata["key"] or name})
            for name, required, metadata in numbers
        )

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the numbers of the law, for reports."""
        return ()

    def summary(self) -> dict[str, Any]:
        """Return name and numbers of the law as a dictionary for JSON, with units at the ends of keys."""
        summary: dict[str, Any] = {"law": self.name}
        for law_number in self.law_fields():
            key = "_".join(filter(None, (law_number.name, law_number.unit.suffix)))
            value = getattr(self, law_number.name)
            summary[key] = list(map(float, value)) if law_number.is_list else float(value)
        return summary


def law_summary(law: Any) -> dict[str, Any] | None:
    """Return name and numbers of a law as a dictionary for JSON; None without a law."""
    if law is None:
        return None
    return law.summary() if isinstance(law, Law) else {"law": type(law).__name__}


AnyLaw = TypeVar("AnyLaw", bound=Law)


def law_keys(laws: Mapping[str, type[AnyLaw]]) -> tuple[str, ...]:
    """List the keys in files of the fields of several laws, each key once."""
    return tuple(dict.fromkeys(law_number.key for law in laws.values() for law_number in law.law_fields()))


def read_law(
    table: Mapping[str, Any],
    laws: Mapping[str, type[AnyLaw]],
    law: type[AnyLaw],
    keys: Mapping[str, str] = MappingProxyType({}),
    **values: Any,
) -> AnyLaw:
    """Create a law of a given class from a table of a file.

    `laws` is the registry, `keys` has other keys of this table by the usual key, and `values` are those of fields that
    files do not have.
    """
    fields_by_key = {keys.get(law_number.key, law_number.key): law_number for law_number in law.law_fields()}
    for key in law_keys(laws):
        if key in table and key not in {*fields_by_key, *keys}:
            names = [repr(name) for name, other in laws.items() if key in law_keys({name: other})]
            owner = f"the law {names[0]}" if len(names) == 1 else f"the laws {', '.join(names)}"
            raise ValueError(f"{key} belongs to {owner}, and the law is {law.name!r}")
    for key, law_number in fields_by_key.items():
        if law_number.required and key not in table:
            raise ValueError(
                f"the law {law.name!r} needs {key} ({law_number.meaning}), such as "
                f"{key} = {law_number.unit.example(law_number.example)}"
            )
    numbers = {
        law_number.name: law_number.unit.read(key, table[key])
        for key, law_number in fields_by_key.items()
        if key in table
    }
    return law(**numbers, **values)


def select_law_class(table: Mapping[str, Any], laws: Mapping[str, type[AnyLaw]], noun: str) -> type[AnyLaw]:
    """Select the class of a law by its name in a table, else by the keys in the table.

    Without such a key the first law of the registry is the default.
    """
    if "law" in table:
        return laws[known_name(noun, table["law"], laws)]
    stated = (law for law in laws.values() if any(law_number.key in table for law_number in law.law_fields()))
    return next(stated, next(iter(laws.values())))
