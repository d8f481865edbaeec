"""A study over two axes becomes a map, with its limits. Nothing is solved here."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy

from ..core.quantities import QUANTITIES
from ..studies.limits import Limit, allowed, margin_on_plane

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.contour import ContourSet
    from matplotlib.figure import Figure

SHOWN = ("max_pressure", "area", "half_angle")
"""What a design map shows."""

_VEIL = 0.65


def design_map(
    study: xarray.Dataset, limits: Sequence[Limit] = (), quantities: Iterable[str] = SHOWN, best: Any = None
) -> Figure:
    """Contours of answers over the two axes of a study, pale where a limit is broken, hatched where the model is
    not to be trusted.

    Parameters
    ----------
    study : xarray.Dataset
        From `study`, with two axes of more than one value.
    limits : sequence of Limit
        Their ends are dotted lines, by name.
    quantities : iterable of str
    best : mapping of str to float, optional
        A point to mark.

    Raises
    ------
    ValueError
        A study that has not two axes.
    """
    from matplotlib.figure import Figure

    names = [name for name in quantities if name in study.data_vars]
    across, up = _two_axes(study)
    figure = Figure(figsize=(4.4 * len(names) + 0.4, 4.4), layout="constrained")
    answered, trusted = (each.transpose(up, across).values for each in (allowed(study, ()), study.valid))
    for axes, name in zip(figure.subplots(1, len(names), squeeze=False).ravel(), names, strict=True):
        values = read(study, name).transpose(up, across).values
        x, y = read(study, across).values, read(study, up).values
        axes.contourf(x, y, values, levels=14, cmap="viridis")
        lines = axes.contour(x, y, values, levels=7, colors="white", linewidths=0.6)
        if not answered.all():
            axes.contourf(x, y, (~answered).astype(float), levels=[0.5, 1.5], colors="white", alpha=_VEIL)
        if not trusted.all():
            doubt = axes.contourf(x, y, (~trusted).astype(float), levels=[0.5, 1.5], colors="none", hatches=["//"])
            doubt.set_edgecolor("0.85")
            doubt.set_linewidth(0)
        _draw_limits(axes, study, limits, across, up)
        _label(axes, lines)
        if best is not None:
            place = (best[axis] * QUANTITIES[axis].shown.factor for axis in (across, up))
            axes.plot(*place, "o", color="white", markeredgecolor="black", markersize=8)
        axes.set_xlabel(QUANTITIES[across].label())
        axes.set_ylabel(QUANTITIES[up].label())
        axes.set_title(QUANTITIES[name].label(), fontsize=10)
    figure.suptitle(_title(study), fontsize=10, parse_math=False)
    within = allowed(study, limits).transpose(up, across).values
    said = [(within, "pale: a limit is broken, or no answer"), (trusted, "hatched: the model is not to be trusted")]
    figure.supxlabel("; ".join(words for where, words in said if not where.all()), fontsize=8, color="0.3")
    return figure


def read(study: xarray.Dataset, name: str) -> xarray.DataArray:
    """A quantity or axis in the unit in which it is drawn."""
    return study[name] * QUANTITIES[name].shown.factor


def _two_axes(study: xarray.Dataset) -> tuple[str, str]:
    long = [str(dim) for dim, size in study.sizes.items() if size > 1]
    if len(long) != 2:
        raise ValueError(f"a map needs two axes of more than one value, got {', '.join(long) or 'none'}")
    for name in long:
        if name not in QUANTITIES:
            raise ValueError(f"a map has axes of numbers, and {name} has names")
    return long[0], long[1]


def _title(study: xarray.Dataset) -> str:
    """The joint by its name, what does not vary of what is asked, and who answers."""
    fixed = [
        _said(str(name), "=", float(each))
        for name, each in study.coords.items()
        if not each.dims and name in QUANTITIES and numpy.issubdtype(each.dtype, numpy.number)
    ]
    joint = json.loads(study.attrs["joint"])["name"]
    return "; ".join([*([joint] if joint else []), *fixed, f"answered by {study.attrs['model']}"])


def _said(name: str, sign: str, value: float) -> str:
    quantity = QUANTITIES[name]
    return f"{quantity.title} {sign} {value * quantity.shown.factor:.4g} {quantity.shown.text}".strip()


def _draw_limits(axes: Axes, study: xarray.Dataset, limits: Iterable[Limit], across: str, up: str) -> None:
    """A veil over what each limit forbids, up to a dotted line that says which it is."""
    x, y = read(study, across).values, read(study, up).values
    nearest = numpy.full((len(y), len(x)), numpy.inf)
    for limit in limits:
        values = margin_on_plane(study, limit, across, up)
        size = float(numpy.nanmax(abs(values), initial=0.0, where=numpy.isfinite(values)))
        nearest = numpy.minimum(nearest, values / (size or 1.0))
    if numpy.nanmin(nearest) < 0:
        axes.contourf(x, y, numpy.clip(nearest, -1.0, 1.0), levels=[-2.0, 0.0], colors="white", alpha=_VEIL)
    for limit in limits:
        for end in _ends(limit):
            values = margin_on_plane(study, end, across, up)
            if numpy.nanmin(values) < 0 < numpy.nanmax(values):
                line = axes.contour(x, y, values, levels=[0.0], colors="black", linestyles=":")
                _label(axes, line, _of(end))


def _ends(limit: Limit) -> list[Limit]:
    """Each end of a limit as one of its own."""
    ends = (replace(limit, high=numpy.inf), replace(limit, low=-numpy.inf))
    return [end for end in ends if (end.low, end.high) != (-numpy.inf, numpy.inf)]


def _of(limit: Limit) -> str:
    return _said(limit.name, "≤", limit.high) if limit.high < numpy.inf else _said(limit.name, "≥", limit.low)


def _label(axes: Axes, lines: ContourSet, text: str = "") -> None:
    """Numbers, or a text, on lines: dark in a light halo, so that they can be read on every colour."""
    from matplotlib.patheffects import withStroke

    fmt: Any = {float(level): text for level in lines.levels} if text else None
    for label in axes.clabel(lines, fontsize=8, colors="black", fmt=fmt):
        label.set_path_effects([withStroke(linewidth=2.0, foreground="white", alpha=0.8)])
