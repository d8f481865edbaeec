"""Names, units and sources that go with the numbers of a study."""

from __future__ import annotations

import json
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.quantities import QUANTITIES
from ..core.storage.fingerprint import fingerprint
from ..core.validity import Status
from .design import Design
from .identity import axes_of
from .parameters import PARTS_OF
from .task import Task

if TYPE_CHECKING:
    import xarray


PARAMETERS = "parameters"
"""The attribute with the names of what varies or is fixed, in the order in which they were given."""

LABELS = "labels"
"""The attribute with the names of materials, by axis, as JSON."""


def described(name: str) -> dict[str, Any]:
    """The attributes of a variable or axis, after the CF conventions."""
    if name == "status":
        return {
            "long_name": "how the press ended",
            "flag_values": [-1, *(int(one) for one in Status)],
            "flag_meanings": " ".join(["not_computed", *(one.name.lower() for one in Status)]),
        }
    if name == "valid":
        return {"long_name": "joint and answer lie where the model can be trusted"}
    if name in PARTS_OF:
        return {"long_name": f"material of the {name}"}
    quantity = QUANTITIES[name]
    return {"long_name": quantity.title, "symbol": quantity.symbol, "units": quantity.unit}


def attributes(task: Task) -> dict[str, Any]:
    """Attributes of the whole study: who computed what, and after whom."""
    labels = {axis.name: axis.labels for axis in task.design.axes if axis.labels}
    return {
        "title": f"{task.model.title}, pressed at {task.design.size} points",
        "model": task.model.name,
        "joint": json.dumps(task.joint.summary(), ensure_ascii=False),
        "references": "; ".join(map(str, dict.fromkeys(task.model.sources))),
        "design": json.dumps(axes_of(task.design)),
        "source": f"ballsocket {fingerprint()}",
        PARAMETERS: " ".join(_in_order(task.design)),
        "Conventions": "CF-1.10",
        **({LABELS: json.dumps(labels, ensure_ascii=False)} if labels else {}),
    }


def coordinates(design: Design) -> dict[str, tuple[tuple[str, ...], Numbers]]:
    """Every parameter that varies or is fixed, with its dimensions."""
    varying = {name: ((axis.name,), values) for axis in design.axes for name, values in axis.values.items()}
    fixed: dict[str, tuple[tuple[str, ...], Numbers]] = {
        name: ((), numpy.asarray(value)) for name, value in design.fixed.items()
    }
    return {**varying, **fixed}


def dataset(task: Task, answers: dict[str, Numbers]) -> xarray.Dataset:
    """Arrays of the study's shape, labelled."""
    import xarray

    return arranged(
        xarray.Dataset(
            {name: (task.design.dims, values, described(name)) for name, values in answers.items()},
            coords={name: (dims, values, described(name)) for name, (dims, values) in coordinates(task.design).items()},
            attrs=attributes(task),
        )
    )


def arranged(study: xarray.Dataset) -> xarray.Dataset:
    """A study whose parameters come in the order of its design, its axes of materials with their names."""
    import xarray

    labels = json.loads(study.attrs.get(LABELS, "{}"))
    named = {axis: (axis, numpy.array(names), described(axis)) for axis, names in labels.items()}
    coords = {**{str(name): one.variable for name, one in study.coords.items()}, **named}
    order = (name for name in study.attrs.get(PARAMETERS, "").split() if name in coords)
    answers = {name: one.variable for name, one in study.data_vars.items()}
    placed = {name: coords[name] for name in dict.fromkeys((*order, *coords))}
    return xarray.Dataset(answers, coords=placed, attrs=study.attrs)


def _in_order(design: Design) -> tuple[str, ...]:
    """The parameters, each axis of materials before its numbers."""
    axes = ((*([axis.name] if axis.labels else []), *axis.names) for axis in design.axes)
    return (*chain.from_iterable(axes), *design.fixed)
