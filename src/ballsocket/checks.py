"""Bad input gets one clear sentence: what, its value, what is allowed."""

from __future__ import annotations

from typing import Any

from .arrays import Array, is_plain, namespace, truth


def require(name: str, value: Array, good: Array, allowed: str) -> None:
    """Raise ValueError naming the first element of `value` for which `good` is false.

    Nothing is checked where the values are not known yet (inside `jax.jit`).
    """
    if truth(good) is not False:
        return
    raise ValueError(f"{name}{_first_bad(value, good)} is not allowed: {allowed}")


def _first_bad(value: Array, good: Array) -> str:
    shape = tuple(getattr(value, "shape", ()))
    if not shape:
        return f" = {float(value):g}"
    xp = namespace(good)
    bad = ~xp.reshape(good, (-1,))
    first = int(xp.argmax(xp.astype(bad, xp.int32)))
    count = int(xp.sum(xp.astype(bad, xp.int32)))
    index, rest = [], first
    for size in reversed(shape):
        index.append(rest % size)
        rest //= size
    others = f" (and {count - 1} more)" if count > 1 else ""
    return f"[{', '.join(map(str, reversed(index)))}] = {float(xp.reshape(value, (-1,))[first]):g}{others}"


def numeric(name: str, value: Any) -> Array:
    """`value` if it is a number or an array; TypeError with a way out if it is not."""
    if isinstance(value, bool) or not (is_plain(value) or isinstance(value, list | tuple) or hasattr(value, "dtype")):
        raise TypeError(
            f"{name} must be a number or an array in mm, N, MPa or rad, got {value!r}"
            + ("; text with units belongs in a joint file or on the command line" if isinstance(value, str) else "")
        )
    if isinstance(value, list | tuple):
        return namespace().asarray(value, dtype=float)
    return value


def one_load(**loads: Any) -> tuple[str, Any]:
    """The one load that was given, with its name."""
    given = {name: value for name, value in loads.items() if value is not None}
    if len(given) != 1:
        got = ", ".join(given) if given else "none"
        raise ValueError(f"exactly one of {', '.join(loads)} is needed, got {got}")
    return next(iter(given.items()))
