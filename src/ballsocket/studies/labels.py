"""Names, units and sources that go with the numbers of a study."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy

from ..arrays import Numbers
from ..fingerprint import fingerprint
from ..quantities import QUANTITIES
from ..validity import Status
from .design import Design
from .identity import axes_of
from .task import Task

if TYPE_CHECKING:
    import xarray


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
    quantity = QUANTITIES[name]
    return {"long_name": quantity.title, "symbol": quantity.symbol, "units": quantity.unit}


def attributes(task: Task) -> dict[str, Any]:
    """Attributes of the whole study: who computed what, and after whom."""
    return {
        "title": f"{task.model.title}, pressed at {task.design.size} points",
        "model": task.model.name,
        "joint": json.dumps(task.joint.summary(), ensure_ascii=False),
        "references": "; ".join(map(str, dict.fromkeys(task.model.sources))),
        "design": json.dumps(axes_of(task.design)),
        "source": f"ballsocket {fingerprint()}",
        "Conventions": "CF-1.10",
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

    return xarray.Dataset(
        {name: (task.design.dims, values, described(name)) for name, values in answers.items()},
        coords={name: (dims, values, described(name)) for name, (dims, values) in coordinates(task.design).items()},
        attrs=attributes(task),
    )
