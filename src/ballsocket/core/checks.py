"""Bad input gets one clear sentence: what, its value, what is allowed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from importlib.util import find_spec
from math import radians
from typing import Any, TypeVar
from unicodedata import category

import numpy

from .arrays import Array, all_true, is_plain, namespace, to_common_arrays

Value = TypeVar("Value")


def require(name: str, value: Array, good: Array, allowed: str) -> None:
    """Raise ValueError naming the first element of `value` for which `good` is false.

    Nothing is checked where the values are not known yet (inside `jax.jit`).
    """
    if all_true(good) is not False:
        return
    raise ValueError(f"{name}{_first_bad(value, good)} is not allowed: {allowed}")


def first_invalid(value: Array, good: Array) -> float:
    """The first element of `value` for which `good` is false."""
    if not _shape(value):
        return value
    return float(namespace(value).reshape(value, (-1,))[_first(good)[0]])


def _first_bad(value: Array, good: Array) -> str:
    shape = _shape(value)
    if not shape:
        return f" = {shown(value) if isinstance(value, int) else format(float(value), 'g')}"
    first, count = _first(good)
    index, rest = [], first
    for size in reversed(shape):
        index.append(rest % size)
        rest //= size
    others = f" (and {count - 1} more)" if count > 1 else ""
    return f"[{', '.join(map(str, reversed(index)))}] = {first_invalid(value, good):g}{others}"


def _shape(value: Array) -> tuple[int, ...]:
    return tuple(getattr(value, "shape", ()))


def _first(good: Array) -> tuple[int, int]:
    """Where the first false element lies, and how many there are."""
    xp = namespace(good)
    bad = ~xp.reshape(good, (-1,))
    return int(xp.argmax(xp.astype(bad, xp.int32))), int(xp.sum(xp.astype(bad, xp.int32)))


def check_numeric(name: str, value: Any) -> Array:
    """`value` if it is a number or an array; TypeError with a way out if it is not."""
    if isinstance(value, list | tuple):
        value = _array_of(name, value)
    if is_plain(value) and not isinstance(value, bool):
        return _in_range(name, value)
    if not hasattr(value, "dtype") or isinstance(value, numpy.ma.MaskedArray | numpy.matrix) or not _is_real(value):
        raise TypeError(_refusal(name, value))
    return to_common_arrays(value)[0]  # integers as floats, before they are added


def check_number(name: str, value: Any) -> float:
    """`value` as a float, where it is one number."""
    number = check_numeric(name, value)
    if _shape(number):
        raise TypeError(f"{name} must be one number, got {shown(value)}")
    return float(number)


def check_vectors(name: str, value: Any, axes: str) -> Array:
    """`value` as an array whose last axis is that of `axes`, such as "x, y, z (mm)"."""
    value = check_numeric(name, value)
    shape = tuple(getattr(value, "shape", ()))
    if shape[-1:] != (3,):
        raise ValueError(f"{name} of shape {shape} is not allowed: its last axis holds {axes}")
    return to_common_arrays(value)[0]


def _in_range(name: str, value: float) -> float:
    try:
        float(value)
    except OverflowError as error:
        raise ValueError(f"{name} is not allowed: the integer is too large for a floating-point number") from error
    return value


def _array_of(name: str, value: Any) -> numpy.ndarray:
    try:
        listed = numpy.asarray(value)
    except (ValueError, OverflowError) as error:  # rows of different lengths
        raise TypeError(_refusal(name, value)) from error
    return listed.astype(float) if listed.dtype.kind in "iuf" else listed


def _is_real(value: Any) -> bool:
    """Whether `value` is an array of integers, or of floating-point numbers of single or double precision."""
    xp = namespace(value)
    if xp.isdtype(value.dtype, "integral"):
        return True
    return bool(xp.isdtype(value.dtype, "real floating")) and xp.finfo(value.dtype).bits >= 32


def _refusal(name: str, value: Any) -> str:
    what = f"an array of {value.dtype}" if getattr(value, "shape", ()) and hasattr(value, "dtype") else shown(value)
    for kind, title in _OTHER_ARRAYS.items():
        if isinstance(value, kind):
            what = title
    if type(value).__name__ == "DataFrame":
        what = "a DataFrame: take one of its columns"
    hint = "; text with units belongs in a joint file or on the command line" if isinstance(value, str) else ""
    return f"{name} must be a number or an array of real numbers in mm, N, MPa or rad, got {what}{hint}"


_OTHER_ARRAYS = {numpy.ma.MaskedArray: "a masked array", numpy.matrix: "a numpy.matrix: use numpy.asarray"}


def reject_unnamed_loads(loads: tuple[Any, ...]) -> None:
    """Raise TypeError for loads without a name."""
    if loads:
        given = shown(loads[0])
        raise TypeError(f"a load needs its name: force={given} in N, indentation={given} in mm or half_angle={given}")


def degrees_hint(value: float) -> str:
    """What somebody means who gives an angle in degrees."""
    return f"{value:g} degrees are {radians(value):.4g} radians"


def select_load(**loads: Any) -> tuple[str, Any]:
    """The one load that was given, with its name."""
    given = {name: value for name, value in loads.items() if value is not None}
    if len(given) != 1:
        got = ", ".join(given) if given else "none"
        raise ValueError(f"exactly one of {', '.join(loads)} is needed, got {got}")
    return next(iter(given.items()))


def needs(extra: str, *modules: str) -> None:
    """Raise ImportError, with what to install, unless all modules of an extra are there."""
    for module in modules:
        if find_spec(module) is None:
            raise ImportError(f"{module} is not installed: pip install 'ballsocket[{extra}]'", name=module)


def check_names(names: Iterable[str], known: Iterable[str], where: str) -> None:
    """Raise ValueError for the first of `names` that is not `known`."""
    for name in names:
        if name not in known:
            raise ValueError(f"{shown(name)} {where} is not known{nearest(name, known)}")


def nearest(name: Any, known: Iterable[str]) -> str:
    """A hint: the nearest known name, or those that there are."""
    text = normalise_name((name if isinstance(name, str) else shown(name))[:_LONGEST])
    known = {normalise_name(each): each for each in known}
    close = get_close_matches(text, known, n=1, cutoff=0.8)
    close = close or [each for each in known if len(text) > 2 and each.startswith(text)]
    close = close or get_close_matches(text, known, n=1, cutoff=0.5)
    return f"; did you mean {known[close[0]]!r}?" if close else f"; known: {_listed(list(known.values()))}"


def _listed(names: list[str]) -> str:
    """Names, as many as a sentence holds."""
    text = ", ".join(names)
    return text if len(text) <= _LISTED else f"{text[: text.rindex(', ', 0, _LISTED)]}, ..."


def normalise_name(text: str) -> str:
    """A name in small letters with hyphens, as those of materials, joints and models are."""
    return text.strip().lower().replace(" ", "-").replace("_", "-")


def known_name(what: str, name: Any, known: Iterable[str]) -> str:
    """The known name that is meant, however its capitals, spaces, hyphens and underscores are written.

    Raises
    ------
    ValueError
        None is, with the nearest one.
    """
    names = list(known)
    for each in (name, normalise_name(name)) if isinstance(name, str) else ():
        if each in names:
            return each
    raise ValueError(f"{what} {shown(name)} is not known{nearest(name, names)}")


class NamedItems(dict[str, Value]):
    """Things by their names; one that is not known is told with the nearest.

    Examples
    --------
    >>> Named("planet", {"earth": 3, "mars": 4})["Mars"]
    Traceback (most recent call last):
    KeyError: "planet 'Mars' is not known; did you mean 'mars'?"
    """

    def __init__(self, what: str, things: Mapping[str, Value]) -> None:
        super().__init__(things)
        self._what = what

    def __missing__(self, name: Any) -> Value:
        raise KeyError(f"{self._what} {shown(name)} is not known{nearest(name, self)}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._what, dict(self))


def check_text(name: str, value: Any) -> str:
    """`value`, if it is text that any terminal can show."""
    if not isinstance(value, str):
        raise ValueError(f"{name} = {shown(value)} must be text")
    if len(value) > _LONGEST_TEXT or any(category(each) == "Cc" and each not in "\t\n" for each in value):
        raise ValueError(f"{name} = {shown(value)} must be at most {_LONGEST_TEXT} characters, none that controls")
    return value


def shown(value: Any) -> str:
    """Whatever came in, as a refusal shows it: on one line, and short."""
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # an integer of thousands of digits; lists in lists in lists
        return f"({type(value).__name__} too long to show)"
    text = " ".join(line.strip() for line in text.splitlines())
    return text if len(text) < _LONGEST else f"{text[:40]}..."


_LONGEST_TEXT = 1000
_LISTED = 200
_LONGEST = 60  # characters of what is shown, and of a name for which others like it are looked for
