"""Metadata of a study: labels with units and sources, and the identity that distinguishes stored studies."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from hashlib import sha256
from itertools import chain
from math import inf
from types import FunctionType
from typing import TYPE_CHECKING, Any

import numpy

from ..contact.contact import ELASTIC
from ..contact.strength import unchecked_strength_reason
from ..contact.verdict import Verdict
from ..core import arrays
from ..core.arrays import Numbers
from ..core.display import counted
from ..core.kinds import MILLIMETRES
from ..core.quantities import QUANTITIES, SHELL
from ..core.storage.pieces import fingerprint
from ..core.unit_systems import Amount, Sentence
from ..core.validity import Status
from ..problem.dimensions import LENGTHS, STORED_LENGTHS, derive_lengths, length_of, lost_lengths
from .axes import SampleAxis
from .design import Design
from .parameters import MATERIAL_PARTS
from .task import BOUNDS, VERDICT, Task

if TYPE_CHECKING:
    import xarray


_PARAMETERS = "parameters"  # attribute with the names of varied and fixed parameters, in the order of the design

HELD = "held"
"""Attribute with the lengths of the joint in mm that stay while others vary, as JSON."""

_DERIVED = "derived_lengths"  # attribute with the names of the lengths that follow from varied ones, as JSON
_LIMITS = "limits"  # attribute with the sentences of the limits of the model's validity, as JSON
_MISSING = "missing"  # attribute with the reason why a quantity is missing at some points, by its name, as JSON
_LABELS = "labels"  # attribute with the names of materials by axis, as JSON
_MAX_LISTED_VALUES = 40  # number of values above which an axis is described by its ends and a digest
_MAX_VALUE_CHARACTERS = 60  # characters of a value in a message


def variable_attributes(name: str) -> dict[str, Any]:
    """Return the attributes of a variable or axis by the CF conventions."""
    if name == "status":
        return _flags("how the press ended", {status.name.lower(): int(status) for status in Status})
    if name == "valid":
        return {"long_name": "joint and answer lie where the model can be trusted"}
    if name == "broken_limit":
        return {"long_name": "number of the first of the limits of the model, from 1, that a point breaks; 0 for none"}
    if name in MATERIAL_PARTS:
        return {"long_name": f"material of the {name}"}
    if name == VERDICT:
        return _flags("verdict on the yield stress", {verdict.word: int(verdict) for verdict in Verdict})
    quantity = BOUNDS.get(name) or QUANTITIES[name]
    return {"long_name": quantity.title, "symbol": quantity.symbol, "units": quantity.unit}


def _flags(title: str, codes: Mapping[str, int]) -> dict[str, Any]:
    codes = {"not_computed": -1, **codes}
    return {"long_name": title, "flag_values": list(codes.values()), "flag_meanings": " ".join(codes)}


def study_attributes(task: Task) -> dict[str, Any]:
    """Return the attributes of a study: title, model, joint, design, publications and version."""
    remarks = [axis.remark for axis in task.design.axes if axis.remark]
    labels = {axis.name: axis.labels for axis in task.design.axes if axis.labels}
    # lengths of the joint that follow from varied ones: given ones in their own names, then stored ones
    lengths, derived = [name for name in task.design.names if name in LENGTHS], list[str]()
    if lengths:
        derived = lost_lengths(lengths, task.joint.given_lengths)
        derived = [*derived, *lost_lengths([*lengths, *derived], STORED_LENGTHS)]
    # the name of a material axis comes before its properties
    names = ((*([axis.name] if axis.labels else []), *axis.names) for axis in task.design.axes)
    return {
        "title": f"{task.model.title}, pressed at {counted(task.design.size, 'point')}",
        "model": task.model.name,
        "joint": json.dumps(task.joint.summary(), ensure_ascii=False),
        "references": "; ".join(map(str, dict.fromkeys(task.model.sources))),
        "design": json.dumps(describe_axes(task.design)),
        "source": f"ballsocket {fingerprint()}",
        _PARAMETERS: " ".join((*chain.from_iterable(names), *task.design.constants)),
        HELD: json.dumps(task.design.held),
        _DERIVED: json.dumps(derived),
        _LIMITS: json.dumps([limit.sentence for limit in (*task.model.validity, ELASTIC)], ensure_ascii=False),
        _MISSING: json.dumps(_missing_reasons(task), ensure_ascii=False),
        "Conventions": "CF-1.10",
        **({"comment": "; ".join(remarks)} if remarks else {}),
        **({_LABELS: json.dumps(labels, ensure_ascii=False)} if labels else {}),
    }


def joint_dimension(study: xarray.Dataset, name: str) -> Any:
    """Return a dimension (mm) or material property of the joints of a study: varied, fixed, or derived from others.

    Raises ValueError: the joint has no such number, such as the modulus of a rigid ball.
    """
    if name in study.coords:
        return study[name]
    joint = json.loads(study.attrs["joint"])
    if name in (*LENGTHS, *SHELL):
        varied = {str(coord): study[coord] for coord in study.coords if coord in (*LENGTHS, *SHELL)}
        thickness = float(joint["backing"][0]["thickness"]) if joint["backing"] else inf
        shell = varied.pop("shell_thickness", thickness if thickness < inf else 0.0)
        lengths = derive_lengths(varied or {length: float(joint[length]) for length in STORED_LENGTHS}, shell)
        return shell if name in SHELL else length_of(name, lengths, shell)
    part, _, number = name.rpartition("_")
    value = joint.get(name) if name in joint else (joint.get(part) or {}).get(number)
    if value is None:
        raise ValueError(f"the joint of this study has no {name}")
    return float(value)


def derived_lengths(study: xarray.Dataset) -> dict[str, Any]:
    """Compute the lengths in mm that follow from the varied and held ones, by name."""
    return {name: joint_dimension(study, name) for name in json.loads(study.attrs.get(_DERIVED, "[]"))}


def held_in(result: xarray.Dataset) -> dict[str, float]:
    """Return the lengths of the joint in mm that a study or a sensitivity holds while others vary."""
    held: dict[str, float] = json.loads(result.attrs.get(HELD, "{}"))
    return held


def as_data(numbers: Mapping[str, Any]) -> dict[str, Any]:
    """Return contents by the names of quantities with the keys and units of JSON: half_angle in rad as half_angle_deg.

    A content is a number, a list, or a mapping with numbers and the point `at` which they are.
    """
    return {
        QUANTITIES[name].key if name in QUANTITIES else name: _datum(name, content) for name, content in numbers.items()
    }


def _datum(name: str, content: Any) -> Any:
    if isinstance(content, list):
        return [_datum(name, entry) for entry in content]
    if isinstance(content, Mapping):
        return {key: as_data(part) if key == "at" else _datum(name, part) for key, part in content.items()}
    is_number = isinstance(content, float) and name in QUANTITIES
    number = content * QUANTITIES[name].written.factor if is_number else content
    return arrays.to_list(number) if isinstance(number, float) else number


def held_text(held: Mapping[str, float]) -> Sentence:
    """List lengths in mm that are held while others vary, with titles and units."""
    named = {"interference" if name == "clearance" and value < 0 else name: abs(value) for name, value in held.items()}
    template = ", ".join(f"{QUANTITIES[name].title} {{}}" for name in named)
    return Sentence(template, *(Amount(length, MILLIMETRES) for length in named.values()))


def held_lines(held: Mapping[str, float]) -> list[Sentence]:
    """Return a line with the lengths in mm that are held; none if there are none."""
    return [Sentence("held: {}", held_text(held))] if held else []


def invalid_reasons(study: xarray.Dataset) -> dict[tuple[int, int], str]:
    """Return the sentences on points that are not valid, by their status and their broken limit."""
    limits = json.loads(study.attrs[_LIMITS])
    by_limit = {(int(Status.OK), number): sentence for number, sentence in enumerate(limits, 1)}
    return by_limit | {
        (int(status), number): status.sentence
        for status in Status
        if status is not Status.OK
        for number in range(len(limits) + 1)
    }


def missing_reasons(study: xarray.Dataset) -> dict[str, str]:
    """Return the reason why a quantity is missing at some points of a study, by its name."""
    reasons: dict[str, str] = json.loads(study.attrs[_MISSING])
    return reasons


def _missing_reasons(task: Task) -> dict[str, str]:
    liner, name = task.joint.liner, "liner_yield_stress"
    stated: list[Any] = [axis.values_in()[name] for axis in task.design.axes if axis.labels and name in axis.names]
    stated.append(task.design.fixed.get(name, 0.0))
    unknown = any(numpy.isnan(values).any() for values in stated)
    unknown |= name not in task.design.names and liner.yield_stress is None
    if "utilisation" not in task.quantities or not unknown:
        return {}
    return {"utilisation": unchecked_strength_reason(replace(task.joint, liner=liner.without_strengths()))}


def make_dataset(task: Task, results: dict[str, Numbers]) -> xarray.Dataset:
    """Create the labelled dataset of a study from arrays of its shape."""
    import xarray

    coordinates: dict[str, tuple[tuple[str, ...], Any]] = {
        name: ((axis.name,), values) for axis in task.design.axes for name, values in axis.values_in().items()
    }
    coordinates |= {name: ((), numpy.asarray(value)) for name, value in task.design.constants.items()}
    return order_coordinates(
        xarray.Dataset(
            {
                name: (task.design.dims, arrays.read_only(values), variable_attributes(name))
                for name, values in results.items()
            },
            coords={name: (dims, values, variable_attributes(name)) for name, (dims, values) in coordinates.items()},
            attrs=study_attributes(task),
        )
    )


def order_coordinates(study: xarray.Dataset) -> xarray.Dataset:
    """Return a study with its parameters in the order of the design, and with the names of materials."""
    import xarray

    labels = json.loads(study.attrs.get(_LABELS, "{}"))
    named = {axis: (axis, numpy.array(names), variable_attributes(axis)) for axis, names in labels.items()}
    coords = {**{str(name): coordinate.variable for name, coordinate in study.coords.items()}, **named}
    order = (name for name in study.attrs.get(_PARAMETERS, "").split() if name in coords)
    results = {name: array.variable for name, array in study.data_vars.items()}
    ordered = {name: coords[name] for name in dict.fromkeys((*order, *coords))}
    return xarray.Dataset(results, coords=ordered, attrs=study.attrs)


def study_identity(task: Task) -> dict[str, Any]:
    """Describe a study as data for JSON; equal descriptions have equal results."""
    return {
        "code": fingerprint(),
        "model": _as_plain_data(task.model),
        "joint": _as_plain_data(task.joint),
        "axes": describe_axes(task.design),
        "fixed": task.design.constants,
        "quantities": list(task.quantities),
        "block": list(task.blocks.size),
    }


def describe_axes(design: Design) -> dict[str, Any]:
    """Describe the axes of a design as data for JSON: values, or seed and distributions of samples."""
    return {
        axis.name: _as_plain_data(axis if isinstance(axis, SampleAxis) else axis.values_in()) for axis in design.axes
    }


def _as_plain_data(value: Any) -> Any:
    """Convert a value to data for JSON: dataclasses and functions by name, long arrays by digest."""
    if is_dataclass(value) and not isinstance(value, type):
        values = {field.name: _as_plain_data(getattr(value, field.name)) for field in fields(value)}
        return {"kind": _qualified_name(type(value)), **values}
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, numpy.ndarray | numpy.generic):
        if value.size <= _MAX_LISTED_VALUES:
            return _as_plain_data(value.tolist())
        digest = sha256(numpy.ascontiguousarray(value).tobytes()).hexdigest()
        return {"count": value.size, "first": float(value.flat[0]), "last": float(value.flat[-1]), "digest": digest}
    if isinstance(value, Mapping):
        return {str(key): _as_plain_data(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_as_plain_data(item) for item in value]
    if isinstance(value, float):
        return value if numpy.isfinite(value) else str(value)
    if value is None or isinstance(value, str | int):
        return value
    if isinstance(value, type):
        return _qualified_name(value)
    if isinstance(value, FunctionType):
        return _describe_function(value)
    raise ValueError(f"a store cannot distinguish {value!r} from other values: make it a dataclass or a function")


def _qualified_name(item: Any) -> str:
    return f"{item.__module__}.{item.__qualname__}"


def _describe_function(function: FunctionType) -> Any:
    """Describe a function of this package by its name, another one also by its code, closure and defaults."""
    if function.__module__.startswith("ballsocket.") and function.__closure__ is None:
        return _qualified_name(function)
    code = function.__code__
    constants = [str(constant) for constant in code.co_consts]
    return {
        "name": _qualified_name(function),
        "code": sha256(repr((code.co_code, code.co_names, constants)).encode()).hexdigest(),
        "encloses": [_as_plain_data(cell.cell_contents) for cell in function.__closure__ or ()],
        "defaults": _as_plain_data(function.__defaults__),
    }


def list_differences(stored: Mapping[str, Any], requested: Mapping[str, Any], path: str = "") -> list[str]:
    """List the differences of two identities, one text for each."""
    texts = []
    for name in dict.fromkeys((*stored, *requested)):
        key, old, new = _shorten(name), stored.get(name), requested.get(name)
        if isinstance(old, Mapping) and isinstance(new, Mapping):
            texts += list_differences(old, new, f"{path}{key}.")
        elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
            by_index = [{f"{key}[{index}]": value for index, value in enumerate(values)} for values in (old, new)]
            texts += list_differences(by_index[0], by_index[1], path)[:1]
        elif old != new:
            texts.append(f"{path}{key} is {_shorten(old)} there and {_shorten(new)} here")
    return texts


def _shorten(value: Any) -> str:
    text = "missing" if value is None else str(value)
    return text if len(text) <= _MAX_VALUE_CHARACTERS else f"{text[: _MAX_VALUE_CHARACTERS - 3]}..."
