"""What is told of a study, as dictionaries for JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy

from ..arrays import to_list
from ..studies.limits import Limit, allowed, refusal
from ..studies.parameters import PARTS_OF
from ..studies.pieces import dims_of

if TYPE_CHECKING:
    import xarray


def map_summary(study: xarray.Dataset, limits: Sequence[Limit]) -> dict[str, Any]:
    """Least and largest values with their places.

    Raises
    ------
    ValueError
        Nothing is allowed.
    """
    good = allowed(study, limits)
    if not bool(good.any()):
        raise ValueError(refusal(study, limits, "no point of the map is allowed", "at any point of the map"))
    quantities = {}
    for name in answers(study):
        values = study[name].where(good).transpose(*dims_of(study)).values
        ends = (int(numpy.nanargmin(values)), int(numpy.nanargmax(values)))
        quantities[name] = [{"value": float(values.flat[end]), "at": coordinates(study, end)} for end in ends]
    return {"model": study.attrs["model"], "limits": [str(limit) for limit in limits], "quantities": quantities}


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
        if variable.dims and (name in variable.dims or not set(variable.dims) & set(PARTS_OF))
    ]


def answers(study: xarray.Dataset) -> list[str]:
    """What a study holds of the contacts, by name."""
    return [str(name) for name in study.data_vars if name not in ("status", "valid")]


def coordinates(study: xarray.Dataset, flat: int) -> dict[str, Any]:
    """The parameters at a point, by its number in the order of the dimensions."""
    dims = dims_of(study)
    place = dict(zip(dims, numpy.unravel_index(flat, [study.sizes[dim] for dim in dims]), strict=True))
    found = {}
    for name, variable in study.coords.items():
        here = variable.isel({dim: int(place[dim]) for dim in variable.dims})
        found[str(name)] = here.values.item()
    return found
