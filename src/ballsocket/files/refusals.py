"""Sentences for files that their schema does not allow: table, key, value, and what is allowed."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any

import msgspec
from msgspec import inspect

from ..core.checks import nearest, shown
from .inputs import Input, choices_in, customs_in, meaning_of, parts_of, struct_in, tables_of
from .schema import KEY, FileTable, QuantityValue, read_value

_PATH = re.compile(r" - at `\$(?P<path>[^`]*)`$")
_STEP = re.compile(r"\.(?P<key>\w+)|\[(?P<index>\d+|\.\.\.)\]")
_MAX_HINTS = 3  # largest number of names or tables in a hint
_SIMILAR = 0.8  # least similarity of a key to that of another table, for a hint


@dataclass(frozen=True)
class _Location:
    """Location in a file: its value, its declared type, the name of the table around it and of its key."""

    value: Any
    type: inspect.Type
    table: str = ""
    key: str = ""
    qualified: bool = False

    @property
    def label(self) -> str:
        """Name of the location in messages."""
        return f"{self.table}.{self.key}" if self.qualified and self.table else self.key


def format_refusal(error: msgspec.ValidationError, content: Mapping[str, Any], table: type[FileTable]) -> str:
    """Format the sentence for what a file has and its schema does not allow."""
    root = location = _Location(content, inspect.type_info(table))
    path = _PATH.search(str(error))
    for step in _STEP.finditer(path["path"] if path else ""):
        location = _step_into(location, step)
    struct = struct_in(location.type)
    if error.__cause__ is not None:
        return str(error.__cause__).replace(KEY, location.label) + _table_hint(location, root)
    if struct is not None and isinstance(location.value, Mapping):
        return _unknown_or_missing_key(location, struct, root)
    choices = choices_in(location.type)
    allowed = f"is not allowed: {' or '.join(map(repr, choices))}" if choices else f"must be {_expected(location)}"
    return f"{location.label} = {shown(location.value)} {allowed}{_table_hint(location, root)}"


def _step_into(location: _Location, step: re.Match[str]) -> _Location:
    if step["key"] is not None:
        key, struct = step["key"], struct_in(location.type)
        assert struct is not None
        kind = next(field.type for field in struct.fields if field.encode_name == key)
        qualified = issubclass(struct.cls, FileTable) and struct.cls.qualified
        return _Location(location.value[key], kind, location.key, key, qualified)
    if step["index"] == "...":  # a table whose keys the file chooses
        named = next(part for part in parts_of(location.type) if isinstance(part, inspect.DictType))
        (kind,) = parts_of(named.value_type)
        assert isinstance(kind, inspect.StructType | inspect.CustomType)
        for name, value in location.value.items():
            try:
                msgspec.convert(value, kind.cls, dec_hook=read_value)
            except msgspec.ValidationError:
                return replace(location, value=value, type=kind, key=f"{location.key}.{name}")
        raise AssertionError("one of the entries is refused")
    key = f"{location.key}[{step['index']}]"
    listed = next(part for part in parts_of(location.type) if isinstance(part, inspect.ListType))
    return replace(location, value=location.value[int(step["index"])], type=listed.item_type, key=key)


def _unknown_or_missing_key(location: _Location, struct: inspect.StructType, root: _Location) -> str:
    keys = {field.encode_name: field for field in struct.fields}
    table = location.key
    for key in location.value:
        if key not in keys:
            where = f"in {table if '[' in table else f'[{table}]'}" if table else "at the top"
            return f"{shown(key)} {where} is not known{_hint(key, keys, root, table)}"
    missing = next(field for name, field in keys.items() if field.required and name not in location.value)
    label = f"{table}.{missing.encode_name}" if table else missing.encode_name
    parts = (meaning_of(missing.encode_name, missing.type), ", ".join(choices_in(missing.type)))
    return f"{label} is missing: {'; allowed: '.join(filter(None, parts))}"


def _hint(key: str, keys: Mapping[str, Any], root: _Location, table: str) -> str:
    """Format a hint for an unknown key of a table ("" at the top): longer keys, other tables, or a similar key."""
    longer = [name for name in keys if name.endswith(f"_{key}") or (table and name.startswith(f"{key}_"))]
    if len(longer) > 1:
        separate = [f", or the table {head}" for head, _ in tables_of(root.type) if head.strip("[]") == key != table]
        return f"; did you mean {' or '.join(map(repr, longer[:_MAX_HINTS]))}{''.join(separate)}?"
    heads = {head: {field.encode_name for field in struct.fields} for head, struct in tables_of(root.type)}
    names = {head: head.strip("[]") for head in heads}
    struct = struct_in(root.type)
    if table and struct and key in {field.encode_name for field in struct.fields} - {*names.values()}:
        return f"; it belongs at the top of the file, above the first table: {key} = ..."
    if tables := [head for head in heads if key in heads[head]]:
        return f"; it belongs in {' or '.join(tables[:_MAX_HINTS])}"
    for head, fields in heads.items():
        if key.startswith(f"{names[head]}_") and (field := key.removeprefix(f"{names[head]}_")) in fields:
            return f"; it is {field!r} in {'this table' if field in keys else head}"
        if names[head] == key != table:
            shared = [name for name in keys if name in fields and not choices_in(keys[name].type)]
            of_table = f"; of its keys this table has {' and '.join(map(repr, shared))}" if shared else ""
            return f"; it is a separate table, {head}{of_table}"
    if words := [name for name, field in keys.items() if key in choices_in(field.type)]:
        return f"; it is a value of a key: {words[0]} = {key!r}"
    elsewhere = {name: head for head, fields in reversed(heads.items()) for name in fields}
    similar = get_close_matches(key, [*keys, *elsewhere], n=1, cutoff=_SIMILAR)
    if similar and similar[0] not in keys:
        return f"; did you mean {similar[0]!r} in {elsewhere[similar[0]]}?"
    return nearest(key, keys)


def _table_hint(location: _Location, root: _Location) -> str:
    """Format a hint for a table under the name of a key without a table, such as [cycles] for [cycle]."""
    heads = {head.strip("[]"): head for head, _ in tables_of(root.type)}
    if not isinstance(location.value, Mapping) or location.key not in root.value or location.key in heads:
        return ""
    similar = get_close_matches(location.key, heads, n=1)
    return f"; did you mean {heads[similar[0]]}?" if similar else ""


_NAMING_KEYS = ("material", "name", "law", "file")  # keys of tables that a user writes in place of the table


def _expected(location: _Location) -> str:
    parts = list(parts_of(location.type))
    texts = [text(location, part) for kind, text in _EXPECTED for part in parts if isinstance(part, kind)]
    return " or ".join(texts) or "another kind of value"


def values_of(entry: Input) -> str:
    """Describe the accepted values of a key, for the documentation."""
    if entry.choices:
        return ", ".join(entry.choices)
    customs = customs_in(entry.type)
    if not customs:
        return _expected(_Location(None, entry.type, key=entry.key))
    if issubclass(customs[0], QuantityValue):
        noun, _, usual = customs[0].kind.example.partition(", such as ")
        return f"{noun}, such as {repr(entry.example) if entry.example else usual}"
    text = (customs[0].__doc__ or "").split(".\n")[0].rstrip(".")
    return text[:1].lower() + text[1:]


def _array(location: _Location, kind: inspect.ListType) -> str:
    if struct_in(kind.item_type):
        return f"an array of tables: [[{location.key}]] before each of them"
    items = "texts" if any(issubclass(custom, str) for custom in customs_in(kind.item_type)) else "numbers"
    text = meaning_of(location.key, location.type)
    return f"a list of {items}{f': {text}' if text else ''}"


def _table(location: _Location, kind: inspect.StructType) -> str:
    """Describe a table; the name of a material, a cycle or a file in its place is moved into it."""
    if "[" in location.key:
        return f"a table: [[{location.key.partition('[')[0]}]]"
    key = next((field.encode_name for field in kind.fields if field.encode_name in _NAMING_KEYS), "")
    return f"a table: [{location.key}]" + (f", and below it {key} = ..." if key and location.value else "")


_EXPECTED: Sequence[tuple[type[inspect.Type], Callable[[_Location, Any], str]]] = (
    (inspect.ListType, _array),
    (inspect.StrType, lambda location, kind: "text"),
    (inspect.StructType, _table),
    (inspect.DictType, lambda location, kind: f"a table: [{location.key}]"),
    (inspect.BoolType, lambda location, kind: "true or false"),
)
