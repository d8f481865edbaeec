"""Checks of inputs: each message states the name, the value and the allowed values."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from difflib import get_close_matches
from importlib.util import find_spec
from math import radians
from typing import Any, TypeVar
from unicodedata import category

import numpy

from .arrays import Array, all_true, is_plain_number, namespace, owned, to_common_arrays, to_numpy
from .display import html_list

Value = TypeVar("Value")

_MAX_TEXT_LENGTH = 1000  # largest number of characters of a text
_MAX_LIST_LENGTH = 200  # largest number of characters of a list of names in a message
_MAX_SHOWN_LENGTH = 60  # largest number of characters of a value in a message
_PREVIEW_LENGTH = 40  # number of characters of a longer value in a message


def require(name: str, value: Array, valid: Array, allowed: str) -> None:
    """Check that all elements of a value are allowed; raise ValueError otherwise.

    The message has the name, the first element for which the mask `valid` is false, and the description `allowed`.

    Traced values (inside `jax.jit`) are not checked.
    """
    if valid is True or all_true(valid) is not False:
        return
    raise ValueError(f"{name}{_format_invalid_element(value, valid)} is not allowed: {allowed}")


@contextmanager
def refusals_of(name: str, kinds: tuple[type[Exception], ...] = (ValueError,)) -> Iterator[None]:
    """Raise the errors of some kinds within the block as ValueError, whose message begins with a name, as of a file."""
    try:
        yield
    except kinds as error:
        raise ValueError(f"{name}: {error}") from error


def first_invalid(value: Array, valid: Array) -> float:
    """Return the first element of `value` where `valid` is false."""
    return float(to_numpy(value).ravel()[to_numpy(valid).argmin()]) if _array_shape(value) else value


def _format_invalid_element(value: Array, valid: Array) -> str:
    """Format index and value of the first invalid element for a message, with the number of further ones."""
    shape = _array_shape(value)
    if not shape:
        return f" = {shown(value) if isinstance(value, int) else format(float(value), 'g')}"
    mask = to_numpy(valid)
    index, count = numpy.unravel_index(mask.argmin(), shape), mask.size - numpy.count_nonzero(mask)
    further = f" (and {count - 1} more)" if count > 1 else ""
    return f"[{', '.join(map(str, index))}] = {first_invalid(value, valid):g}{further}"


def _array_shape(value: Array) -> tuple[int, ...]:
    return tuple(getattr(value, "shape", ()))


def check_numeric(name: str, value: Any) -> Array:
    """Check that a value is a number or an array of real numbers; return a copy of an array, and lists as arrays.

    The caller may reuse the array without a change of what was made from it.

    Raises TypeError: any other value, such as text, booleans, complex numbers or masked arrays.
    Raises ValueError: an integer that is too large for a float.
    """
    if isinstance(value, list | tuple):
        try:
            listed = numpy.asarray(value)
        except (ValueError, OverflowError) as error:  # rows of different lengths
            raise TypeError(_format_type_error(name, value)) from error
        value = listed.astype(float) if listed.dtype.kind in "iuf" else listed
    if is_plain_number(value) and not isinstance(value, bool):
        try:
            float(value)
        except OverflowError as error:
            raise ValueError(f"{name} is not allowed: the integer is too large for a floating-point number") from error
        return value
    if (
        not hasattr(value, "dtype")
        or any(kind.__name__ in _REJECTED_ARRAYS for kind in type(value).__mro__)
        or hasattr(value, "to_numpy")
        or not _has_real_numbers(value)
    ):
        raise TypeError(_format_type_error(name, value))
    return owned(to_common_arrays(value)[0])  # of floats: sums of small integers would overflow


def check_number(name: str, value: Any) -> float:
    """Check that a value is a single number, and return it as a float; raise TypeError otherwise."""
    number = check_numeric(name, value)
    if _array_shape(number):
        raise TypeError(f"{name} must be one number, got {shown(value)}")
    return float(number)


def check_vectors(name: str, value: Any, axes: str) -> Array:
    """Check that a value is an array of vectors with three components, and return it.

    `axes` describes the last axis in the message, such as "x, y, z (mm)".

    Raises ValueError: a last axis that is not of length 3.
    """
    value = check_numeric(name, value)
    shape = _array_shape(value)
    if shape[-1:] != (3,):
        raise ValueError(f"{name} of shape {shape} is not allowed: its last axis holds {axes}")
    return value


def check_shape(name: str, value: Any, allowed: tuple[tuple[int, ...], ...]) -> Array:
    """Check that a value has real numbers and one of several shapes, and return it.

    Raises TypeError: another type than real numbers.
    Raises ValueError: another shape.
    """
    value = check_numeric(name, value)
    if _array_shape(value) not in allowed:
        shapes = " or ".join(dict.fromkeys(map(str, allowed)))
        raise ValueError(f"{name} of shape {_array_shape(value)} is not allowed: its shape is {shapes}")
    return value


def _has_real_numbers(value: Any) -> bool:
    """Check if an array has integers, or floats of single or double precision."""
    xp = namespace(value)
    if xp.isdtype(value.dtype, "integral"):
        return True
    return bool(xp.isdtype(value.dtype, "real floating")) and xp.finfo(value.dtype).bits >= 32


def _format_type_error(name: str, value: Any) -> str:
    text = f"an array of {value.dtype}" if getattr(value, "shape", ()) and hasattr(value, "dtype") else shown(value)
    for kind in type(value).__mro__:
        text = _REJECTED_ARRAYS.get(kind.__name__, text)
    if hasattr(value, "to_numpy"):  # of pandas, xarray or polars
        name_of_type = type(value).__name__
        column = "of one of its columns" if name_of_type in ("DataFrame", "Dataset") else "of it"
        text = f"a {name_of_type}: use .to_numpy() {column}"
    hint = "; text with units belongs in a joint file or on the command line" if isinstance(value, str) else ""
    return f"{name} must be a number or an array of real numbers in mm, N, MPa or rad, got {text}{hint}"


_REJECTED_ARRAYS = {"MaskedArray": "a masked array", "matrix": "a numpy.matrix: use numpy.asarray"}
"""Arrays by the name of their class: NumPy imports the module of masked arrays when it is named."""


def reject_unnamed_loads(loads: tuple[Any, ...]) -> None:
    """Raise TypeError for loads that are passed without a keyword such as `force=`."""
    if loads:
        load = shown(loads[0])
        raise TypeError(f"a load needs its name: force={load} in N, indentation={load} in mm or half_angle={load}")


def degrees_hint(value: float) -> str:
    """Format a hint on radians: "40 degrees are 0.6981 radians"."""
    return f"{value:g} degrees are {radians(value):.4g} radians"


def select_load(**loads: Any) -> tuple[str, Any]:
    """Return name and value of the only load that is not None.

    Raises ValueError if there is none, or more than one.
    """
    stated = [(name, value) for name, value in loads.items() if value is not None]
    if len(stated) != 1:
        got = ", ".join(name for name, _ in stated) or "none"
        raise ValueError(f"exactly one of {', '.join(loads)} is needed, got {got}")
    return stated[0]


def needs(extra: str, *modules: str) -> None:
    """Raise ImportError with the command that installs an optional extra unless its modules are installed."""
    for module in modules:
        if find_spec(module) is None:
            raise ImportError(f'{module} is not installed: pip install "ballsocket[{extra}]"', name=module)


def unique(pairs: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Return pairs of name and value as a dictionary; raise ValueError for a name that occurs twice."""
    values: dict[str, Any] = {}
    for name, value in pairs:
        if name in values:
            raise ValueError(f"{name} is given twice; one is needed")
        values[name] = value
    return values


def check_names(names: Iterable[str], known: Iterable[str], where: str) -> None:
    """Raise ValueError for the first name that is not known; `where` completes the message."""
    for name in names:
        if not isinstance(name, str) or name not in known:
            raise ValueError(f"{shown(name)} {where} is not known{nearest(name, known)}")


def nearest(name: Any, known: Iterable[str]) -> str:
    """Format a hint for an unknown name: the most similar known name, "; did you mean 'exact'?", or all of them."""
    names = list(known)
    close = closest(name, names)
    if close:
        return f"; did you mean {close!r}?"
    text = ", ".join(names)
    return "; known: " + (
        text if len(text) <= _MAX_LIST_LENGTH else f"{text[: text.rindex(', ', 0, _MAX_LIST_LENGTH)]}, ..."
    )


def closest(name: Any, known: Iterable[str]) -> str:
    """Return the known name that is most similar to an unknown one; "" without one."""
    text = normalise_name((name if isinstance(name, str) else shown(name))[:_MAX_SHOWN_LENGTH])
    names = {normalise_name(known_name): known_name for known_name in known}
    close = get_close_matches(text, names, n=1, cutoff=0.8)
    close = close or [candidate for candidate in names if len(text) > 2 and candidate.startswith(text)]
    close = close or get_close_matches(text, names, n=1, cutoff=0.5)
    return names[close[0]] if close else ""


def normalise_name(text: str) -> str:
    """Convert a name to lower case with hyphens, such as "Hip 36" to "hip-36"."""
    return text.strip().lower().replace(" ", "-").replace("_", "-")


def known_name(kind: str, name: Any, known: Iterable[str]) -> str:
    """Return the known name that matches a name, regardless of capitals, spaces, hyphens and underscores.

    Raises ValueError: an unknown name; the message has the `kind` of the named item and suggests the most similar name.
    """
    names = list(known)
    for candidate in (name, normalise_name(name)) if isinstance(name, str) else ():
        if candidate in names:
            return candidate
    raise ValueError(f"{kind} {shown(name)} is not known{nearest(name, names)}")


class NamedItems(dict[str, Value]):
    """Dictionary of named items whose KeyError has their kind and suggests the most similar name.

    Examples
    --------
    >>> NamedItems("planet", {"earth": 3, "mars": 4})["Mars"]
    Traceback (most recent call last):
    KeyError: "planet 'Mars' is not known; did you mean 'mars'?"
    """

    def __init__(self, kind: str, items: Mapping[str, Value]) -> None:
        super().__init__(items)
        self._kind = kind

    def __missing__(self, name: Any) -> Value:
        raise KeyError(f"{self._kind} {shown(name)} is not known{nearest(name, self)}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._kind, dict(self))

    def __repr__(self) -> str:
        return f"<{len(self)} {self._kind}s: {', '.join(self)}>"

    def _repr_html_(self) -> str:
        rows = [(name, str(getattr(item, "title", item))) for name, item in self.items()]
        return html_list(f"{len(self)} {self._kind}s", rows)


def check_text(name: str, value: Any) -> str:
    """Check that a value is a text of limited length without control characters, and return it.

    Raises ValueError: a value of another type, a text that is too long, or one with halves of surrogate pairs or with
    control characters other than tabs and line ends.
    """
    if not isinstance(value, str):
        raise ValueError(f"{name} = {shown(value)} must be text")
    control = any(category(character) in ("Cc", "Cs") and character not in "\t\n" for character in value)
    if len(value) > _MAX_TEXT_LENGTH or control:
        limit = f"at most {_MAX_TEXT_LENGTH} characters with no control characters"
        raise ValueError(f"{name} = {shown(value)} must be {limit}")
    return value


def check_filled(name: str, text: str, meaning: str = "") -> str:
    """Check that a text is not blank, and return it as plain text; raise ValueError with its meaning otherwise."""
    if not text.strip():
        raise ValueError(f"{name} is empty" + (f": {meaning}" if meaning else ""))
    return str(text)


_MAX_INTEGER = (1 << 53) - 1  # largest whole number up to which a float represents every whole number exactly


def check_whole_number(name: str, value: Any, low: int = 0, high: int = _MAX_INTEGER) -> int:
    """Check that a value is an integer within limits, and return it.

    Raises ValueError: any other value, such as a float or a boolean.
    """
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise ValueError(f"{name} = {shown(value)} is not allowed: a whole number from {low} to {high}")
    return value


_PERCENTAGE = re.compile(r"\s*([-+.\deE]+)\s*(?:%|per\s?cent|pct)\s*", re.IGNORECASE)


def number_of_percent(value: Any) -> str | None:
    """Return the number of a percentage as text, such as "10" of "10 %" or "10 per cent"; None for any other value."""
    match = _PERCENTAGE.fullmatch(value) if isinstance(value, str) else None
    return None if match is None else match[1]


def shown(value: Any) -> str:
    """Format any value on one short line, for a message."""
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # an integer of thousands of digits; lists in lists in lists
        return f"({type(value).__name__} too long to show)"
    text = " ".join(line.strip() for line in text.splitlines())
    return text if len(text) < _MAX_SHOWN_LENGTH else f"{text[:_PREVIEW_LENGTH]}..."
