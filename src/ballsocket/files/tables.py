"""Tables of files: read from the content of a file, written to it, and their values."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any

import msgspec

from .schema import FileTable, Parsed, QuantityValue, TableType, read_value


def parsed_values(table: FileTable | None, content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the objects of the `Parsed` values of a table, in the order of the file's `content`; empty without one."""
    values = {} if table is None else {name: getattr(table, name, None) for name in content}
    return {name: value.value for name, value in values.items() if isinstance(value, Parsed)}


def quantities_of(table: FileTable, *names: str) -> dict[str, float]:
    """Return the numbers of a table that the file states, by key; all quantities without names."""
    values = {name: getattr(table, name) for name in names or table.__struct_fields__}
    return {name: float(value) for name, value in values.items() if isinstance(value, QuantityValue)}


def written_in(table: FileTable) -> dict[str, Any]:
    """Return the quantities of a table as the file writes them, by key."""
    values = {name: getattr(table, name) for name in table.__struct_fields__}
    return {name: value.written for name, value in values.items() if isinstance(value, QuantityValue)}


def read_table(content: Mapping[str, Any], table: type[TableType]) -> TableType:
    """Convert the content of a file.

    Raises ValueError: one sentence: the table, the key, the value and what is allowed.
    """
    try:
        return msgspec.convert(dict(content), table, dec_hook=read_value)
    except msgspec.ValidationError as error:
        from .refusals import format_refusal  # not loaded for files without faults

        raise ValueError(format_refusal(error, content, table)) from error


def write_table(table: FileTable, with_units: bool = False) -> dict[str, Any]:
    """Return a table as the content of a file, without defaults.

    Parameters
    ----------
    table : Table
    with_units : bool
        True for texts with units, such as "16.0 mm"; otherwise numbers are bare in mm, N, MPa and degrees.
    """
    return {key: _write(value, with_units) for key, value in table.stated().items()}


def _write(value: Any, with_units: bool) -> Any:
    if isinstance(value, FileTable):
        return write_table(value, with_units)
    if isinstance(value, QuantityValue):
        return value.write(with_units)
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Parsed):
        return str(value.value)
    if isinstance(value, list):
        return [_write(item, with_units) for item in value]
    return ", ".join(map(repr, value)) if isinstance(value, tuple) else value
