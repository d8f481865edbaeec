"""Pareto front: designs for which no other design is better in both of two quantities."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy

from ..core.checks import check_names
from .limits import Limit, allowed, refusal_reason

if TYPE_CHECKING:
    import xarray


def pareto(
    study: xarray.Dataset, minimise: tuple[str, str] = ("area", "max_pressure"), limits: Iterable[Limit] = ()
) -> xarray.Dataset:
    """Select the allowed points of a study for which no other allowed point is better in both quantities.

    Parameters
    ----------
    study : xarray.Dataset
        Result of `study`.
    minimise : tuple of two str
        Quantities of the study. By default a small contact area for little wear, and a low peak pressure for strength.
    limits : iterable of Limit
        Limits that each point must meet.

    Returns
    -------
    xarray.Dataset
        Points along the dimension `point`, in the order of the first quantity.

    Raises
    ------
    ValueError
        A quantity that the study does not have; no allowed point.
    """
    check_names(minimise, [str(name) for name in study.data_vars], "among the quantities of the study")
    limits = tuple(limits)
    good = allowed(study, limits)
    points = study.stack(point=list(study.sizes), create_index=False)
    mask = good.stack(point=list(good.dims), create_index=False).values if good.dims else numpy.array([bool(good)])
    if not mask.any():
        raise ValueError(refusal_reason(study, limits, "no point is allowed", "at any point"))
    points = points.isel(point=numpy.flatnonzero(mask))
    first, second = (points[name].values for name in minimise)
    order = numpy.lexsort((second, first))
    lowest = numpy.minimum.accumulate(second[order])
    better = numpy.append(True, second[order][1:] < lowest[:-1])
    return points.isel(point=order[better])
