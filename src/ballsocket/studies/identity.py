"""What a study is, as plain data that can be compared: a kept result belongs to one study and one code."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from hashlib import sha256
from types import FunctionType
from typing import Any

import numpy

from ..core.storage.fingerprint import fingerprint
from .axes import Axis, SampleAxis
from .design import Design
from .task import Task

_SHOWN = 40  # values of an axis that are written down one by one


def identity(task: Task) -> dict[str, Any]:
    """Plain data for JSON that is the same for the same study."""
    return {
        "code": fingerprint(),
        "model": plain(task.model),
        "joint": plain(task.joint),
        "axes": axes_of(task.design),
        "fixed": dict(task.design.fixed),
        "quantities": list(task.quantities),
        "block": list(task.blocks.size),
    }


def axes_of(design: Design) -> dict[str, Any]:
    """The axes: values, or how samples are drawn."""
    return {axis.name: _axis(axis) for axis in design.axes}


def plain(value: Any) -> Any:
    """A value as plain data: dataclasses and functions by their names, arrays by what they hold."""
    if is_dataclass(value) and not isinstance(value, type):
        return {"kind": _name(type(value)), **{each.name: plain(getattr(value, each.name)) for each in fields(value)}}
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, numpy.ndarray | numpy.generic):
        return _numbers(numpy.asarray(value))
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, float):
        return value if numpy.isfinite(value) else str(value)
    if value is None or isinstance(value, str | int):
        return value
    if isinstance(value, type):
        return _name(value)
    if isinstance(value, FunctionType):
        return _function(value)
    raise ValueError(f"a store cannot tell {value!r} from others: make it a dataclass or a function")


def _name(thing: Any) -> str:
    return f"{thing.__module__}.{thing.__qualname__}"


def _function(function: FunctionType) -> Any:
    """A function of this package by its name; any other also by its code and what it encloses."""
    if function.__module__.startswith("ballsocket.") and function.__closure__ is None:
        return _name(function)
    code = function.__code__
    digest = sha256(repr((code.co_code, code.co_names, [str(each) for each in code.co_consts])).encode()).hexdigest()
    enclosed = [plain(cell.cell_contents) for cell in function.__closure__ or ()]
    return {"name": _name(function), "code": digest, "encloses": enclosed, "defaults": plain(function.__defaults__)}


def _axis(axis: Axis) -> Any:
    return plain(axis) if isinstance(axis, SampleAxis) else {name: _numbers(each) for name, each in axis.values.items()}


def _numbers(values: numpy.ndarray) -> Any:
    if values.size <= _SHOWN:
        return plain(values.tolist())
    digest = sha256(numpy.ascontiguousarray(values).tobytes()).hexdigest()
    return {"count": values.size, "first": float(values.flat[0]), "last": float(values.flat[-1]), "digest": digest}


def differences(kept: Mapping[str, Any], asked: Mapping[str, Any], path: str = "") -> list[str]:
    """Where two identities differ, in words."""
    found = []
    for name in dict.fromkeys((*kept, *asked)):
        key, one, other = _short(name), kept.get(name), asked.get(name)
        if isinstance(one, Mapping) and isinstance(other, Mapping):
            found += differences(one, other, f"{path}{key}.")
        elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
            numbered = [{f"{key}[{place}]": value for place, value in enumerate(each)} for each in (one, other)]
            found += differences(numbered[0], numbered[1], path)[:1]
        elif one != other:
            found.append(f"{path}{key} is {_short(one)} there and {_short(other)} here")
    return found


def _short(value: Any) -> str:
    text = "missing" if value is None else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
