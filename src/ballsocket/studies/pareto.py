"""Two wishes at once: the designs of which none is better in both."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy

from ..core.checks import check_names
from .limits import Limit, allowed, refusal

if TYPE_CHECKING:
    import xarray


def pareto(
    study: xarray.Dataset, minimise: tuple[str, str] = ("area", "max_pressure"), limits: Iterable[Limit] = ()
) -> xarray.Dataset:
    """The points of a study that are allowed and that no other allowed point beats in both quantities.

    Parameters
    ----------
    study : xarray.Dataset
        From `study`.
    minimise : tuple of two str
        Answers of the study. The paper's pair: a small contact area for little wear, a low peak pressure for strength.
    limits : iterable of Limit

    Returns
    -------
    xarray.Dataset
        Along `point`, by the first quantity.

    Raises
    ------
    ValueError
        A quantity that the study does not have; no point that is allowed.
    """
    check_names(minimise, [str(name) for name in study.data_vars], "among the study's answers")
    limits = tuple(limits)
    good = allowed(study, limits)
    flat = study.stack(point=list(study.sizes), create_index=False)
    kept = good.stack(point=list(good.dims), create_index=False).values if good.dims else numpy.array([bool(good)])
    if not kept.any():
        raise ValueError(refusal(study, limits, "no point is allowed", "at any point"))
    flat = flat.isel(point=numpy.flatnonzero(kept))
    first, second = (flat[name].values for name in minimise)
    order = numpy.lexsort((second, first))
    best = numpy.minimum.accumulate(second[order])
    better = numpy.append(True, second[order][1:] < best[:-1])
    return flat.isel(point=order[better])
