"""Frozen values of numbers: made without checks where those were done before, and written short."""

from __future__ import annotations

from typing import Any

from ..core.arrays import Array, is_plain, where


def make_unchecked(cls: Any, **fields: Any) -> Any:
    """A material, layer or joint from numbers that have been checked before, or are not known yet."""
    made = object.__new__(cls)
    set_fields(made, **fields)
    return made


def set_fields(made: Any, **fields: Any) -> None:
    """Fields of a frozen value that is being made."""
    for name, value in fields.items():
        object.__setattr__(made, name, value)


def short_text(value: Array) -> str:
    """A number in six digits, or what stands in its place."""
    shape = tuple(getattr(value, "shape", ()))
    try:
        return f"{float(value):g}" if not shape else f"<array {'x'.join(map(str, shape))}>"
    except TypeError:  # a tracer has no value yet
        return "<traced>"


def larger(one: Array, other: Array) -> Array:
    """The larger of two, element by element."""
    return max(one, other) if is_plain(one) and is_plain(other) else where(one > other, one, other)
