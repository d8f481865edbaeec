"""Field terms for inputs, limits and numbers, as the record and the page write them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..core.quantities import QUANTITIES, Quantity
from ..studies.parameters import PARAMETERS
from .matrix import NAMES

LIMITED: Mapping[str, Quantity] = {**QUANTITIES, **PARAMETERS, **NAMES}
"""By name."""

KEYS: Mapping[str, Quantity] = {quantity.key: quantity for quantity in LIMITED.values()}
"""By the names of JSON."""

_HUGE = 1e9
_MORE = {"utilisation": "utilisation (von Mises stress over yield stress)"}
_ENDS = (("low", "at least"), ("high", "at most"))


def title_of(name: str) -> str:
    """Return the title of a number by its name."""
    return _MORE.get(name) or LIMITED[name].title


def number(value: Any) -> str:
    """Return five digits; a number of a usual size has no exponent."""
    if value is None or isinstance(value, str):
        return value or "–"
    text = f"{value:.5g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < _HUGE else text


def limit_text(limit: Mapping[str, Any]) -> str:
    """Return a limit with the title and the unit of its number: "largest pressure at most 15 MPa"."""
    quantity = KEYS.get(limit["name"]) or LIMITED[limit["name"]]
    unit = quantity.written.text
    ends = [f"{word} {number(limit[end])} {unit}".strip() for end, word in _ENDS if limit[end] is not None]
    return f"{title_of(limit['name'])} {' and '.join(ends)}"


def input_title(name: str) -> str:
    """Return the field's term for an input.

    Examples
    --------
    >>> input_title("liner_young"), input_title("backing[0].thickness")
    ("Young's modulus of the liner", 'thickness of layer 1 behind the liner')
    """
    if name == "friction.coefficient":
        return "coefficient of friction"
    layer, _, inside = name.rpartition(".")
    if layer:
        index = int(layer.removeprefix("backing[").removesuffix("]")) + 1
        return f"{LIMITED[inside].title} of layer {index} behind the liner"
    part, _, strength = name.partition("_")
    return LIMITED[name].title if name in LIMITED else f"{LIMITED[strength].title} of the {part}"
