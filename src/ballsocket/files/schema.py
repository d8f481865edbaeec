"""Schemas of input files: each key of a table is declared once, with its type, unit and meaning.

A table of a file is a subclass of `Table`, a key of the table is a field of the class:

    class FilmTable(Table):
        ball_roughness: Annotated[Length | None, meaning("Roughness Ra of the ball")] = None

The same declaration reads a file (`read_table`), refuses what it does not allow, describes the file as JSON schema
(`json_schema`) and lists its keys for the documentation (`key_rows`). A key whose name is a quantity of
`ballsocket.core.quantities` has the meaning of that quantity.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, ClassVar, Self, TypeVar

import msgspec
from msgspec import inspect

from ..core.checks import check_text, nearest, shown
from ..core.kinds import Kind
from ..core.quantities import QUANTITIES
from ..core.quantities import Quantity as CoreQuantity
from .units import parse

_NAME = "\0"
"""Placeholder for the name of a key while its value is read; `shown` never lets it through from a file."""

_PATH = re.compile(r" - at `\$(?P<path>[^`]*)`$")
_STEP = re.compile(r"\.(?P<key>\w+)|\[(?P<index>\d+|\.\.\.)\]")


def meaning(text: str) -> msgspec.Meta:
    """Return the annotation of a key that states its meaning."""
    return msgspec.Meta(description=text)


QUANTITY_SCHEMA = {"type": ["number", "string"], "maxLength": 100}
"""JSON schema of a number, or of a text with a unit."""


class Value:
    """Base class of types of values that msgspec does not read itself."""

    schema: ClassVar[Mapping[str, Any]] = {}
    """JSON schema of the accepted values."""

    @classmethod
    def read(cls, name: str, value: Any) -> Any:
        """Convert a value of a file; `name` is its key for messages.

        Raises
        ------
        ValueError
            A value that is not allowed.
        """
        raise NotImplementedError


class Text(Value, str):
    """Text without control characters."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "string", "maxLength": 1000}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a text of a file."""
        return cls(check_text(name, value))


class Texts(Value, list[str]):
    """Text or list of texts."""

    schema: ClassVar[Mapping[str, Any]] = {"type": ["string", "array"], "items": {"type": "string"}}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert one text or a list of texts of a file."""
        return cls(check_text(name, text) for text in (value if isinstance(value, list) else [value]))


_MAX_INTEGER = 1 << 53
"""Largest whole number that a float represents exactly."""


class Whole(Value, int):
    """Whole number."""

    schema: ClassVar[Mapping[str, Any]] = {"type": "integer"}

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a whole number of a file; 4.0 is one."""
        if isinstance(value, float) and value.is_integer():
            value = int(value)
        if isinstance(value, bool) or not isinstance(value, int):
            raise ValueError(f"{name} = {shown(value)} must be a whole number")
        if not -_MAX_INTEGER < value < _MAX_INTEGER:
            raise ValueError(f"{name} = {shown(value)} is too large a number")
        return cls(value)


class Quantity(Value, float):
    """Number in mm, N, MPa or rad, with the number or text of the file in `written`."""

    kind: ClassVar[Kind] = Kind.NUMBER
    schema: ClassVar[Mapping[str, Any]] = QUANTITY_SCHEMA
    written: Any

    @classmethod
    def read(cls, name: str, value: Any) -> Self:
        """Convert a number, or a text with a unit, of a file."""
        number = cls(parse(name, value, cls.kind))
        number.written = value
        return number


class Number(Quantity):
    """Plain number without a unit."""


class Length(Quantity):
    """Length in mm."""

    kind = Kind.LENGTH


class Force(Quantity):
    """Force in N."""

    kind = Kind.FORCE


class Modulus(Quantity):
    """Modulus, stress or pressure in MPa."""

    kind = Kind.MODULUS


class Angle(Quantity):
    """Angle in rad; a bare number of a file is in degrees."""

    kind = Kind.ANGLE


class Mass(Quantity):
    """Mass in kg."""

    kind = Kind.MASS


class Table(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, omit_defaults=True):
    """Base class of the tables of a file: keys that are not fields are refused."""

    qualified: ClassVar[bool] = False
    """True if several tables have these keys, so that messages name the table with the key: "liner.young"."""


TableType = TypeVar("TableType", bound=Table)


def table_of_quantities(
    name: str, quantities: Mapping[str, CoreQuantity], value: type[Value], bases: tuple[type[Table], ...] = (Table,)
) -> type[Any]:
    """Create a table with a key for each quantity, whose values are of the given type.

    Parameters
    ----------
    name : str
        Name of the class.
    quantities : mapping
        Quantities by key.
    value : class
        Type of the values. For each kind of quantity it gets a subclass with the attribute `kind`.
    bases : tuple of class
        Tables with further keys.
    """
    kinds = {
        kind: type(f"{value.__name__}{kind.name}", (value,), {"kind": kind, "__doc__": value.__doc__})
        for kind in dict.fromkeys(quantity.kind for quantity in quantities.values())
    }
    keys = [(key, kinds[quantity.kind] | None, None) for key, quantity in quantities.items()]
    return msgspec.defstruct(name, keys, bases=bases, kw_only=True, frozen=True, module=value.__module__)


def values_of(table: Table | None, kind: type[Any], content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of one type in a table, by key in the order of the file's `content`; empty without a table."""
    values = {} if table is None else {name: getattr(table, name) for name in content}
    return {name: value for name, value in values.items() if isinstance(value, kind)}


def quantities_of(table: Table, *names: str) -> dict[str, float]:
    """Return the numbers of a table that the file states, by key; all quantities without names."""
    fields = names or table.__struct_fields__
    values = {name: getattr(table, name) for name in fields}
    return {name: float(value) for name, value in values.items() if isinstance(value, Quantity)}


def written_in(table: Table) -> dict[str, Any]:
    """Return the quantities of a table as the file writes them, by key."""
    values = {name: getattr(table, name) for name in table.__struct_fields__}
    return {name: value.written for name, value in values.items() if isinstance(value, Quantity)}


def read_table(content: Mapping[str, Any], table: type[TableType], name: str = "") -> TableType:
    """Convert the content of a file, or of one of its tables.

    Parameters
    ----------
    content : mapping
    table : class
    name : str
        Name of the table in messages, such as "machine.frame"; empty for a whole file.

    Raises
    ------
    ValueError
        One sentence: the table, the key, the value and what is allowed.
    """
    try:
        return msgspec.convert(dict(content), table, dec_hook=_read_value)
    except msgspec.ValidationError as error:
        raise ValueError(_refusal(error, content, table, name)) from error


def _read_value(kind: type[Any], value: Any) -> Any:
    """Read a value of a type of this package for msgspec."""
    return kind.read(_NAME, value)


@dataclass(frozen=True)
class _Place:
    """Place in a file: the value there, its declared type, the name of the table around it and of its key."""

    value: Any
    type: inspect.Type
    table: str = ""
    key: str = ""
    qualified: bool = False

    @property
    def label(self) -> str:
        """Name of the place in messages."""
        return f"{self.table}.{self.key}" if self.qualified and self.table else self.key


def _refusal(error: msgspec.ValidationError, content: Mapping[str, Any], table: type[Table], name: str) -> str:
    """Format the sentence for what a file has and its schema does not allow."""
    root = _Place(content, inspect.type_info(table), table=name)
    place = root
    found = _PATH.search(str(error))
    for step in _STEP.finditer(found["path"] if found else ""):
        place = _step_into(place, step)
    if error.__cause__ is not None:
        return str(error.__cause__).replace(_NAME, place.label)
    struct = _struct_in(place.type)
    if struct is not None and isinstance(place.value, Mapping):
        return _unknown_or_missing_key(place, struct, root)
    choices = _choices_in(place.type)
    allowed = f"is not allowed: {choices}" if choices else f"must be {_expected(place)}"
    return f"{place.label} = {shown(place.value)} {allowed}"


def _step_into(place: _Place, step: re.Match[str]) -> _Place:
    """Return the place of a key or of an element of a list."""
    if step["key"] is not None:
        key, struct = step["key"], _struct_in(place.type)
        assert struct is not None
        kind = next(field.type for field in struct.fields if field.encode_name == key)
        return _Place(place.value[key], kind, place.key or place.table, key, struct.cls.qualified)
    if step["index"] == "...":
        return _step_into_named_table(place)
    listed = _list_in(place.type)
    assert listed is not None
    key = f"{place.key}[{step['index']}]"
    return replace(place, value=place.value[int(step["index"])], type=listed.item_type, key=key)


def _step_into_named_table(place: _Place) -> _Place:
    """Return the place of the first table that is refused among tables with names that the file chooses."""
    named = next(part for part in _parts(place.type) if isinstance(part, inspect.DictType))
    struct = _struct_in(named.value_type)
    assert struct is not None
    for name, table in place.value.items():
        try:
            msgspec.convert(table, struct.cls, dec_hook=_read_value)
        except msgspec.ValidationError:
            return replace(place, value=table, type=struct, key=f"{place.key}.{name}")
    raise AssertionError("one of the tables is refused")


def _parts(kind: inspect.Type) -> Iterator[inspect.Type]:
    """List the members of a union without their annotations, or the type itself."""
    if isinstance(kind, inspect.Metadata):
        yield from _parts(kind.type)
    elif isinstance(kind, inspect.UnionType):
        for member in kind.types:
            yield from _parts(member)
    else:
        yield kind


def _struct_in(kind: inspect.Type) -> inspect.StructType | None:
    """Return the table among the types of a value; None without one."""
    return next((part for part in _parts(kind) if isinstance(part, inspect.StructType)), None)


def _list_in(kind: inspect.Type) -> inspect.ListType | None:
    """Return the list among the types of a value; None without one."""
    return next((part for part in _parts(kind) if isinstance(part, inspect.ListType)), None)


def _unknown_or_missing_key(place: _Place, struct: inspect.StructType, root: _Place) -> str:
    """Format the sentence for a key that a table does not know, or lacks."""
    keys = {field.encode_name: field for field in struct.fields}
    table = place.key or root.table
    where = f"in {_bracketed(table)}" if table else "at the top"
    for key in place.value:
        if key not in keys:
            return f"{shown(key)} {where} is not known{_hint(key, keys, root)}"
    missing = next(field for name, field in keys.items() if field.required and name not in place.value)
    label = f"{table}.{missing.encode_name}" if table else missing.encode_name
    return f"{label} is missing{_described(missing)}"


def _bracketed(table: str) -> str:
    """Return the name of a table in brackets; an element of an array of tables has its number in place of them."""
    return table if "[" in table else f"[{table}]"


def _head(table: str) -> str:
    """Return the head of a table in a file."""
    return f"[[{table.partition('[')[0]}]]" if "[" in table else f"[{table}]"


def _described(field: inspect.Field) -> str:
    """Return the meaning of a key as the end of a sentence."""
    text = _meaning_of(field.encode_name, field.type)
    return f": {text}" if text else ""


def _hint(key: str, keys: Mapping[str, Any], root: _Place) -> str:
    """Format a hint for an unknown key: the tables that know it, or the nearest key of its own table."""
    heads = dict(_tables_of(root.type))
    if others := [head for head, struct in heads.items() if key in {field.encode_name for field in struct.fields}]:
        return f"; it belongs in {' or '.join(others)}"
    if own := [head for head in heads if head.strip("[]") == key]:
        return f"; it is a table of its own, {own[0]}"
    return nearest(key, keys)


def _tables_of(kind: inspect.Type) -> Iterator[tuple[str, inspect.StructType]]:
    """List the tables of a file with their heads: "[liner]", "[[backing]]"."""
    struct = _struct_in(kind)
    for field in struct.fields if struct else ():
        if inner := _struct_in(field.type):
            yield f"[{field.encode_name}]", inner
        for part in _parts(field.type):
            if isinstance(part, inspect.DictType) and (inner := _struct_in(part.value_type)):
                yield f"[{field.encode_name}.NAME]", inner
        if (listed := _list_in(field.type)) and (inner := _struct_in(listed.item_type)):
            yield f"[[{field.encode_name}]]", inner


def _expected(place: _Place) -> str:
    """Describe what a value must be."""
    parts = list(_parts(place.type))
    texts = [text(place, part) for kind, text in _EXPECTED for part in parts if isinstance(part, kind)]
    return " or ".join(texts) or "another kind of value"


def _array_of(place: _Place, kind: inspect.ListType) -> str:
    """Describe an array of tables, or a list."""
    if _struct_in(kind.item_type):
        return f"an array of tables: [[{place.key}]] before each of them"
    return f"a list of {_plural(kind.item_type)}"


def _plural(kind: inspect.Type) -> str:
    """Name the items of a list."""
    customs = [part.cls for part in _parts(kind) if isinstance(part, inspect.CustomType)]
    return "texts" if any(issubclass(custom, str) for custom in customs) else "numbers"


def _choices_in(kind: inspect.Type) -> str:
    """List the words that a key allows; empty for other keys."""
    for part in _parts(kind):
        if isinstance(part, inspect.EnumType | inspect.LiteralType):
            values = [item.value for item in part.cls] if isinstance(part, inspect.EnumType) else part.values
            return " or ".join(map(repr, values))
    return ""


_EXPECTED: Sequence[tuple[type[inspect.Type], Callable[[_Place, Any], str]]] = (
    (inspect.ListType, _array_of),
    (inspect.StructType, lambda place, kind: f"a table: {_head(place.key)}"),
    (inspect.BoolType, lambda place, kind: "true or false"),
    (inspect.StrType, lambda place, kind: "text"),
)


def _meaning_of(key: str, kind: inspect.Type) -> str:
    """Return the meaning of a key: its own, or that of the quantity of this name."""
    own = (kind.extra_json_schema or {}).get("description") if isinstance(kind, inspect.Metadata) else None
    return str(own or (QUANTITIES[key].title if key in QUANTITIES else ""))


@dataclass(frozen=True)
class Key:
    """Key of a table of files, for the documentation.

    Attributes
    ----------
    table : str
        Head of its table, such as "[joint]" or "[[backing]]"; empty at the top of the file.
    name : str
    unit : str
        Unit of a bare number; empty for other values.
    values : str
        Accepted values in words.
    default : str
        Default as the file writes it; "required", or empty without a default.
    meaning : str
    """

    table: str
    name: str
    unit: str
    values: str
    default: str
    meaning: str


def keys_of(table: type[Table]) -> list[Key]:
    """List the keys of a file, table by table, those at the top first."""
    root = inspect.type_info(table)
    tables = list(_tables_of(root))
    structs: list[tuple[str, Any]] = [("", root), *tables]
    heads = {head.strip("[]") for head, _ in tables}
    return [
        _key(head, field)
        for head, struct in structs
        for field in struct.fields
        if head or field.encode_name not in heads or _takes_text(field.type)
    ]


def _takes_text(kind: inspect.Type) -> bool:
    """Return True if a key takes a text in place of a table."""
    return any(isinstance(part, inspect.StrType) for part in _parts(kind))


def _key(head: str, field: inspect.Field) -> Key:
    """Describe a key for the documentation."""
    parts = [part for part in _parts(field.type) if not isinstance(part, inspect.NoneType | inspect.StructType)]
    customs = [part.cls for part in parts if isinstance(part, inspect.CustomType)]
    kinds = [kind.kind for kind in customs if issubclass(kind, Quantity)]
    place = _Place(None, field.type, key=field.encode_name)
    values = kinds[0].example if kinds else customs[0].__doc__.split(".")[0] if customs else ""
    return Key(
        table=head,
        name=field.encode_name,
        unit=kinds[0].typed if kinds else "",
        values=values or _choices_in(field.type) or _expected(place),
        default="required" if field.required else _default(field),
        meaning=_meaning_of(field.encode_name, field.type),
    )


def _default(field: inspect.Field) -> str:
    """Return the default of a key as a file writes it; empty without a default."""
    value = field.default
    if value is inspect.NODEFAULT or value is None or value == "":
        return ""
    if isinstance(value, Enum):
        return repr(value.value)
    return str(value).lower() if isinstance(value, bool) else repr(value)


def json_schema(table: type[Table], title: str) -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of a kind of file, for editors and other programs."""
    schema = msgspec.json.schema(table, schema_hook=lambda kind: dict(kind.schema))
    definitions = schema.pop("$defs")
    root = definitions.pop(table.__name__)
    described = {name: _with_meanings(part) for name, part in definitions.items()}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": title,
        **{key: part for key, part in _with_meanings(root).items() if key != "title"},
        "$defs": described,
    }


def _with_meanings(definition: dict[str, Any]) -> dict[str, Any]:
    """Add the meanings of quantities to the keys of a table, and leave out null, which TOML does not have."""
    properties = {key: _without_null(part) for key, part in definition.get("properties", {}).items()}
    for key, part in properties.items():
        quantity = QUANTITIES.get(key)
        if "description" not in part and quantity is not None:
            part["description"] = f"{quantity.title}{quantity.written.bracketed}. {quantity.meaning}"
    return {**definition, "properties": properties} if properties else definition


def _without_null(part: dict[str, Any]) -> dict[str, Any]:
    """Remove null from the accepted values and defaults of a key."""
    others = [choice for choice in part.get("anyOf", ()) if choice != {"type": "null"}]
    kept = {key: value for key, value in part.items() if key != "anyOf" and not (key == "default" and value is None)}
    if len(others) == 1:
        return {**others[0], **kept}
    return {**kept, "anyOf": others} if others else kept
