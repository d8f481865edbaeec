"""What is told of a study, as dictionaries for JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy

from ..core.arrays import to_list
from ..core.validity import Status
from ..studies.export import dimension_names, iterate_chunks
from ..studies.limits import Limit, allowed, refusal_reason
from ..studies.parameters import MATERIAL_PARTS

if TYPE_CHECKING:
    import xarray


class End(NamedTuple):
    """A least or largest value, and the number of its point."""

    value: float
    place: int


@dataclass
class StudyReport:
    """What is told of a study, gathered part by part: it may be larger than the memory."""

    ends: dict[str, tuple[End, End]]
    sampled: dict[str, list[numpy.ndarray]]
    failed: dict[Status, int]
    valid: int = 0

    @classmethod
    def of(cls, study: xarray.Dataset) -> StudyReport:
        names = answers(study)
        nothing = (End(float("nan"), 0), End(float("nan"), 0))
        seen = cls(
            dict.fromkeys(names, nothing), {name: [] for name in names}, {one: 0 for one in Status if one.failed}
        )
        first, stride = 0, max(1, study.status.size // _SAMPLED)
        for part in iterate_chunks(study):
            for name in names:
                seen._add(name, part[name].values.ravel(), first, stride)
            for one in seen.failed:
                seen.failed[one] += int((part.status.values == int(one)).sum())
            seen.valid += int(part.valid.values.sum())
            first += part.status.size
        return seen

    def _add(self, name: str, values: numpy.ndarray, first: int, stride: int) -> None:
        self.sampled[name].append(values[::stride].copy())
        if numpy.isnan(values).all():
            return
        low, high = self.ends[name]
        least, most = int(numpy.nanargmin(values)), int(numpy.nanargmax(values))
        if not values[least] >= low.value:
            low = End(float(values[least]), first + least)
        if not values[most] <= high.value:
            high = End(float(values[most]), first + most)
        self.ends[name] = low, high


_SAMPLED = 1_000_000  # points over which a median is taken
_LISTED = 5000  # points up to which all values are told


def study_summary(study: xarray.Dataset) -> dict[str, Any]:
    """Least, median and largest value of each answer with their places, and all values where these are few."""
    seen, size = StudyReport.of(study), int(study.status.size)
    quantities = {name: _ends_of(study, name, seen) for name in seen.ends}
    return {
        "model": study.attrs["model"],
        "points": size,
        "valid": seen.valid == size,
        "notes": [f"{count} of {size}: {one.sentence}" for one, count in seen.failed.items() if count],
        "quantities": quantities,
        "values": _values(study) if size <= _LISTED else None,
    }


def _values(study: xarray.Dataset) -> dict[str, Any]:
    """What varies and what was answered, point by point in the order of the axes."""
    flat = study.stack(point=dimension_names(study)) if dimension_names(study) else study.expand_dims("point")
    names = [*varying(study), *answers(study)]
    return {name: _plain(flat[name].values) for name in names}


def _plain(values: numpy.ndarray) -> Any:
    return values.tolist() if values.dtype.kind in "OUS" else to_list(values)


def _ends_of(study: xarray.Dataset, name: str, seen: StudyReport) -> dict[str, Any]:
    low, high = seen.ends[name]
    if numpy.isnan(low.value):
        return {"least": None, "median": None, "largest": None}
    told = {
        end: {"value": one.value, "at": coordinates(study, one.place)}
        for end, one in (("least", low), ("largest", high))
    }
    return {**told, "median": float(numpy.nanmedian(numpy.concatenate(seen.sampled[name])))}


def map_summary(study: xarray.Dataset, limits: Sequence[Limit]) -> dict[str, Any]:
    """Least and largest values with their places.

    Raises
    ------
    ValueError
        Nothing is allowed.
    """
    good = allowed(study, limits)
    if not bool(good.any()):
        raise ValueError(refusal_reason(study, limits, "no point of the map is allowed", "at any point of the map"))
    quantities = {}
    for name in answers(study):
        values = study[name].where(good).transpose(*dimension_names(study)).values
        ends = (int(numpy.nanargmin(values)), int(numpy.nanargmax(values)))
        quantities[name] = [{"value": float(values.flat[end]), "at": coordinates(study, end)} for end in ends]
    return {
        "model": study.attrs["model"],
        "limits": [str(limit) for limit in limits],
        "valid": bool(study.valid.where(good, True).all()),
        "quantities": quantities,
    }


def front_summary(front: xarray.Dataset) -> dict[str, Any]:
    """Columns of numbers."""
    names = [str(name) for name in (*front.coords, *front.data_vars) if front[name].dims]
    return {"model": front.attrs["model"], "points": {name: to_list(front[name].values) for name in names}}


def sensitivity_summary(found: xarray.Dataset) -> dict[str, Any]:
    """By quantity, then by number."""
    orders = ("first_order", "first_order_low", "first_order_high", "total_order", "elasticity")
    return {
        "samples": found.attrs["samples"],
        "quantities": {
            quantity: {
                "mean": float(found["mean"].sel(quantity=quantity)),
                "deviation": float(found["deviation"].sel(quantity=quantity)),
                "numbers": {
                    name: {
                        order: to_list(found[order].sel(quantity=quantity, parameter=name).values) for order in orders
                    }
                    for name in found.parameter.values.tolist()
                },
            }
            for quantity in found.quantity.values.tolist()
        },
    }


def varying(study: xarray.Dataset) -> list[str]:
    """The parameters that vary, materials by their names alone."""
    return [
        str(name)
        for name, variable in study.coords.items()
        if variable.dims and (name in variable.dims or not set(variable.dims) & set(MATERIAL_PARTS))
    ]


def answers(study: xarray.Dataset) -> list[str]:
    """What a study holds of the contacts, by name."""
    return [str(name) for name in study.data_vars if name not in ("status", "valid")]


def coordinates(study: xarray.Dataset, flat: int) -> dict[str, Any]:
    """The parameters at a point, by its number in the order of the dimensions."""
    dims = dimension_names(study)
    place = dict(zip(dims, numpy.unravel_index(flat, [study.sizes[dim] for dim in dims]), strict=True))
    found = {}
    for name, variable in study.coords.items():
        here = variable.isel({dim: int(place[dim]) for dim in variable.dims})
        found[str(name)] = here.values.item()
    return found
