"""Schemas of input files: each key of a table is declared once, with its type, unit and meaning.

A table of a file is a subclass of `FileTable`, a key of the table is a field of the class:

    class FilmTable(FileTable, frozen=True, kw_only=True):
        ball_roughness: Annotated[Length | None, meaning("Roughness Ra of the ball")] = None

The same declaration reads a file (`read_table`), refuses what it does not allow (`refusals`), writes a file
(`write_table`), describes the file as JSON schema (`json_schema`) and lists its keys for the documentation (`inputs`).
A key whose name is a quantity of `ballsocket.core.quantities` has the meaning of that quantity.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from math import degrees, inf, isinf, nextafter, radians
from typing import Annotated, Any, ClassVar, Self, TypeVar, cast

import msgspec

from ..core.checks import check_text, check_whole_number, known_name, shown
from ..core.kinds import Kind
from ..core.quantities import Quantity
from .units import LONGEST, parse

KEY = "\0"
"""Placeholder for the name of a key while its value is read; `shown` never lets it through from a file."""

QUANTITY_SCHEMA: Mapping[str, Any] = {
    "type": ["number", "string"],
    "pattern": r"^\s*[-+]?(\.?[0-9]|[iI]nf)",
    "maxLength": LONGEST,
}
"""JSON schema of a number, or of a text with a unit."""

QUANTITIES_SCHEMA: Mapping[str, Any] = {"anyOf": [QUANTITY_SCHEMA, {"type": "array", "items": QUANTITY_SCHEMA}]}
"""JSON schema of a quantity, or of a list of quantities."""


def meaning(text: str = "", **shown: str) -> msgspec.Meta:
    """Return the annotation of a key that states its meaning.

    `shown` may have an `example`, and as `default` what holds where an optional key is missing.
    """
    return msgspec.Meta(description=text or None, extra=dict(shown))


class Value(ABC):
    """Base class of the types of values that msgspec does not read itself."""

    kind: ClassVar[Kind] = Kind.NUMBER
    """Physical kind of its numbers."""

    schema: ClassVar[Mapping[str, Any]] = {}
    """JSON schema of the accepted values."""

    def __init_subclass__(cls, kind: Kind | None = None) -> None:
        super().__init_subclass__()
        cls.kind = kind or cls.kind

    @classmethod
    @abstractmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a value of a file; `name` is its key for messages.

        Raises ValueError: a value that is not allowed.
        """

    @classmethod
    def of(cls, kind: Kind) -> type[Self]:
        """Return the type of such values with numbers of a physical kind."""
        return type(cls.__name__, (cls,), {"__doc__": cls.__doc__}, kind=kind)

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """Return the JSON schema of the accepted values."""
        return dict(cls.schema)


ValueType = TypeVar("ValueType", bound=Value)


class Parsed(Value):
    """Base class of values that are read to an object of another class, the attribute `value`."""

    def __init__(self, value: Any) -> None:
        self.value = value

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        return cls(cls.parse(name, value))

    @classmethod
    def parse(cls, name: str, value: Any) -> Any:
        """Convert a value of a file to the attribute `value`; unchanged where another key determines its meaning."""
        return value


class Text(Value, str):
    """Text without control characters."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "string", "maxLength": 1000}
    choices: ClassVar[Sequence[str]] = ()
    """Known texts, which editors complete."""

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        return cls(check_text(name, value))

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        return choices_schema(cls.choices) if cls.choices else dict(cls.schema)


class Word(Text):
    """One of several words, in any spelling with capitals, blanks and hyphens."""

    noun: ClassVar[str] = ""
    """Kind of the named item in messages; by default the name of the key."""

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a word of a file to its usual spelling."""
        return cls(known_name(cls.noun or f"{name} =", value, cls.choices))


def choices_schema(choices: Sequence[str]) -> dict[str, Any]:
    """Return the JSON schema of words: their usual spelling, or one with capitals, blanks or underscores."""
    return {"type": "string", "anyOf": [{"enum": list(choices)}, {"pattern": "[A-Z_ ]"}]}


class HeadMap(Parsed):
    """Names of columns, such as "force_N", by their heads in a file."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "object", "additionalProperties": {"type": "string"}}

    @classmethod
    def parse(cls, name: str, value: Any) -> dict[str, str]:
        if not isinstance(value, Mapping):
            raise ValueError(f"{name} = {shown(value)} must be a table, such as {{'Kraft' = 'force_N'}}")
        return {check_text(name, head): check_text(name, column) for head, column in value.items()}


class Texts(Value, list[str]):
    """Text or list of texts."""

    schema: ClassVar[Mapping[str, Any]] = {"type": ["string", "array"], "items": {"type": "string"}}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        return cls(check_text(name, text) for text in (value if isinstance(value, list) else [value]))


class WholeNumber(Value, int):
    """Whole number."""

    limits: ClassVar[tuple[int, ...]] = ()
    """Smallest and largest allowed number; by default 0 and the largest that a float represents exactly."""

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a whole number of a file; 4.0 is one."""
        integer = int(value) if isinstance(value, float) and value.is_integer() else value
        return cls(check_whole_number(name, integer, *cls.limits))

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        return {"type": "integer", **dict(zip(("minimum", "maximum"), cls.limits, strict=False))}


class QuantityValue(Value, float):
    """Number in mm, N, MPa or rad, with the number or text of the file in `written`."""

    schema: ClassVar[Mapping[str, Any]] = QUANTITY_SCHEMA
    written: Any

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a number, or a text with a unit, of a file."""
        number = cls(parse(name, value, cls.kind))
        number.written = value
        return number

    @classmethod
    def stating(cls, number: float, written: str) -> Self:
        """Return a default: a number in mm, N, MPa or rad with its text in a file."""
        value = cls(number)
        value.written = written
        return value

    def write(self, with_unit: bool) -> float | str:
        """Return the number as a file has it: bare in mm, N, MPa and degrees, or as a text with its unit."""
        number, unit = float(self), self.kind.assumed_unit
        if self.kind is Kind.ANGLE:  # the degrees that are read as exactly this angle, a round number if there is one
            nearest = degrees(self)
            candidates = (round(nearest, 9), nearest, nextafter(nearest, inf), nextafter(nearest, -inf))
            number = next((angle for angle in candidates if radians(angle) == self), nearest)
        return f"{number!r} {unit}" if with_unit and unit and not isinf(number) else number


class PlainNumber(QuantityValue):
    """Plain number without a unit."""


class Length(QuantityValue, kind=Kind.LENGTH):
    """Length in mm."""


class Force(QuantityValue, kind=Kind.FORCE):
    """Force in N."""


class Pressure(QuantityValue, kind=Kind.MODULUS):
    """Modulus, stress or pressure in MPa."""


class Viscosity(QuantityValue, kind=Kind.VISCOSITY):
    """Dynamic viscosity in Pa s."""


class RotationRate(QuantityValue, kind=Kind.ROTATION_RATE):
    """Rotation rate in rad/s."""


class Duration(QuantityValue, kind=Kind.DURATION):
    """Time in s."""


class Speed(QuantityValue, kind=Kind.SPEED):
    """Speed in mm/s."""


class Angle(QuantityValue, kind=Kind.ANGLE):
    """Angle in rad; a bare number of a file is in degrees."""


class FileTable(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """Base class of the tables of a file: keys that are not fields are refused."""

    qualified: ClassVar[bool] = False
    """True if several tables have these keys, so that messages name the table with the key: "liner.young"."""

    def stated(self) -> dict[str, Any]:
        """Return the values that are not defaults, by the keys of the file."""
        names = zip(self.__struct_encode_fields__, self.__struct_fields__, self.__struct_defaults__, strict=True)
        values = ((key, getattr(self, name), default) for key, name, default in names)
        return {key: value for key, value, default in values if value is not default}


TableType = TypeVar("TableType", bound=FileTable)


def with_keys(keys: Mapping[str, Any]) -> Callable[[type[TableType]], type[TableType]]:
    """Return a class decorator that adds optional keys to a table; `keys` has the type of their values, with a meaning.

    Examples
    --------
    >>> from ballsocket.files.tables import read_table
    >>> @with_keys({"gap": Annotated[Length, meaning("gap of the test")]})
    ... class TestTable(FileTable, frozen=True, kw_only=True):
    ...     name: Text | None = None
    >>> read_table({"gap": "1 cm"}, TestTable).gap
    10.0
    """
    fields: list[Any] = []
    for key, kind in keys.items():
        metadata = getattr(kind, "__metadata__", ())  # the meaning of the key
        optional = Annotated[kind.__origin__ | None, *metadata] if metadata else kind | None
        fields.append((key, optional, None))

    def decorate(table: type[TableType]) -> type[TableType]:
        extended: Any = msgspec.defstruct(
            table.__name__,
            fields,
            bases=(table,),
            module=table.__module__,
            namespace={"__doc__": table.__doc__},
            frozen=True,
            kw_only=True,
        )
        return cast(type[TableType], extended)

    return decorate


def quantity_keys(quantities: Mapping[str, Quantity], value: type[Value] = QuantityValue) -> dict[str, Any]:
    """Return the types of keys for `with_keys`: one for each quantity, with its title and numbers of its kind."""
    return {key: Annotated[value.of(quantity.kind), meaning(quantity.title)] for key, quantity in quantities.items()}


def read_value(kind: type[ValueType], value: Any) -> ValueType:
    """Read a value of a type of this package for msgspec."""
    return kind.read(KEY, value)
