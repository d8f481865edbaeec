"""Helpers of frozen values: construction without checks, short text, and maximum."""

from __future__ import annotations

from typing import Any

from ..core.arrays import Array, is_plain_number, where


def make_unchecked(cls: Any, **fields: Any) -> Any:
    """Make a material, layer or joint without the checks of its initialiser.

    The numbers have been checked, or JAX traces them.
    """
    instance = object.__new__(cls)
    set_fields(instance, **fields)
    return instance


def set_fields(instance: Any, **fields: Any) -> None:
    """Set fields of a frozen dataclass instance during its construction."""
    for name, value in fields.items():
        object.__setattr__(instance, name, value)


def short_text(value: Array) -> str:
    """Format a number with six digits, or the shape of an array; "<traced>" without a value."""
    shape = tuple(getattr(value, "shape", ()))
    try:
        return f"{float(value):g}" if not shape else f"<array {'x'.join(map(str, shape))}>"
    except TypeError:  # a tracer has no value yet
        return "<traced>"


def elementwise_maximum(x: Array, y: Array) -> Array:
    """Return the elementwise maximum of two values."""
    return max(x, y) if is_plain_number(x) and is_plain_number(y) else where(x > y, x, y)
