"""Orientations of a cup as a map of inclination and anteversion, and as text in a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import degrees, isfinite
from typing import TYPE_CHECKING, Any

import numpy
from rich.table import Table
from rich.text import Text

from ..contact.verdict import Verdict
from ..core.arrays import Numbers
from ..core.quantities import CONTACT, CUP, DERIVED, QUANTITIES, Quantity
from ..core.unit_systems import Units, joint_sentence
from ..core.validity import Status
from ..elasticity.off_axis.orientations import Orientations
from ..studies.limits import Limit
from .style import BLUE, INK, LEGEND, VERMILLION, new_figure
from .terminal import Terminal, print_columns, print_folded, text_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEVELS = 12
_LOST_BALL_HATCH, _RIM_HATCH = "xxx", "///"


def orientation_figure(orientations: Orientations, units: Units = Units.SI, limits: Sequence[Limit] = ()) -> Figure:
    """Draw distance to the rim and largest pressure over inclination and anteversion, or over one of them.

    The contact reaches the rim on the dotted line. Two hatchings mark cups that do not hold the ball, and cups whose
    rim digs in, where the pressure is unbounded. A circle marks the orientation of the cup, if it is set. Results for
    one value of the other angle are drawn as curves.

    Parameters
    ----------
    orientations : Orientations
        Results for at least two inclinations or two anteversions.
    units : Units
        Units of every number.
    limits : sequence of Limit
        Limits that are drawn as dashed lines.

    Raises
    ------
    ValueError
        A single orientation.
    """
    if orientations.status.size < 2:
        raise ValueError("a figure needs two values of an angle, got one orientation")
    is_map = min(orientations.status.shape) > 1
    figure = new_figure(10.4, 4.6)
    axes_pair = figure.subplots(1, 2, sharey=is_map)
    quantities = DERIVED["edge_distance"], CONTACT["max_pressure"]
    for axes, quantity in zip(axes_pair, quantities, strict=True):
        if is_map:
            _draw(axes, orientations, getattr(orientations, quantity.name), quantity, units)
            _draw_limits(axes, orientations, limits, units)
        else:
            _draw_curve(axes, orientations, quantity, units, limits)
    if is_map:
        axes_pair[1].set_ylabel("")
    _draw_legend(figure)
    title = units.sentence(f"{orientations.joint.dimensions}; {load_text(orientations)}")
    if not is_map:
        name = "anteversion" if orientations.status.shape[1] == 1 else "inclination"
        title += f"; {name} {_degree_text(float(getattr(orientations, name)[0]))}"
    figure.suptitle(title, fontsize=10, parse_math=False)
    return figure


_LIMIT_LINE: Any = {"color": VERMILLION, "linestyle": "--", "linewidth": 1.6}


def _draw_limits(axes: Axes, orientations: Orientations, limits: Sequence[Limit], units: Units) -> None:
    """Draw each limit as a dashed line over the map where it lies between the values, and mark undecided values."""
    x, y = numpy.degrees(orientations.inclination), numpy.degrees(orientations.anteversion)
    for limit in limits:
        values = getattr(orientations, limit.name).T
        values = numpy.where(numpy.isfinite(values), values, numpy.nan)
        levels = [end for end in (limit.low, limit.high) if (values < end).any() and (values > end).any()]
        if levels:
            axes.contour(x, y, values, levels=sorted(set(levels)), colors=VERMILLION, linestyles="--", linewidths=1.6)
            axes.plot([], [], label=units.sentence(_limit_text(limit)), **_LIMIT_LINE)
    across, up = numpy.nonzero(verdicts(orientations, limits) == Verdict.UNDECIDED)
    if len(across):
        label = "undecided: the error bar contains a limit"
        axes.plot(x[across], y[up], linestyle="", marker="$?$", color=VERMILLION, markersize=8, label=label)


def _draw_curve(
    axes: Axes, orientations: Orientations, quantity: Quantity, units: Units, limits: Sequence[Limit]
) -> None:
    """Draw one field over the angle that changes, with its limits; orientations without a number are left out."""
    name = "inclination" if orientations.status.shape[1] == 1 else "anteversion"
    label, factor = units.axis(quantity.label(quantity.written))
    bar = orientations.error_bar(quantity.name)
    known = orientations.held & numpy.isfinite(bar.value)
    shown, low, high = (factor * numpy.where(known, ends, numpy.nan).ravel() for ends in bar)
    angles, ends = numpy.degrees(getattr(orientations, name)), [shown - low, high - shown]
    axes.errorbar(angles, shown, yerr=ends, fmt="o-", color=BLUE, markersize=4)
    for limit in (limit for limit in limits if limit.name == quantity.name):
        for end in filter(isfinite, (limit.low, limit.high)):
            axes.axhline(factor * end, label=units.sentence(_limit_text(limit)), **_LIMIT_LINE)
    if quantity.name == "edge_distance" and numpy.nanmin(shown, initial=0.0) < 0:
        axes.axhline(0.0, linestyle=":", color=INK, linewidth=1.8, label="the contact reaches the rim")
    axes.set(xlabel=CUP[name].label(), ylabel=label)
    axes.grid(alpha=0.3)


def _draw_legend(figure: Figure) -> None:
    """Add one legend for both maps, with each text once."""
    pairs: dict[str, Any] = {}
    for axes in figure.axes:
        pairs |= {label: handle for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    if pairs:
        figure.legend(list(pairs.values()), list(pairs), loc="outside lower center", ncols=len(pairs), **LEGEND)


def _draw(axes: Axes, orientations: Orientations, values: Numbers, quantity: Quantity, units: Units) -> None:
    """Draw one field with contours, and hatch orientations without a number."""
    x, y = numpy.degrees(orientations.inclination), numpy.degrees(orientations.anteversion)
    label, factor = units.axis(quantity.label(quantity.written))
    shown = factor * numpy.where(orientations.held & numpy.isfinite(values), values, numpy.nan).T
    if numpy.isfinite(shown).any() and numpy.nanmax(shown) > numpy.nanmin(shown):
        axes.contourf(x, y, shown, levels=_LEVELS, cmap="viridis")
        lines = axes.contour(x, y, shown, levels=_LEVELS // 2, colors="white", linewidths=0.6)
        axes.clabel(lines, fontsize=8, fmt="%.4g")
    _draw_rim(axes, orientations, x, y)
    _hatch(axes, x, y, ~orientations.held.T, _LOST_BALL_HATCH, "the load leaves the bore")
    _hatch(axes, x, y, numpy.isposinf(values).T, _RIM_HATCH, "the rim digs in: unbounded pressure")
    _mark(axes, orientations)
    axes.set(xlabel=CUP["inclination"].label(), ylabel=CUP["anteversion"].label())
    axes.set_title(label, fontsize=10)
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))


def _draw_rim(axes: Axes, orientations: Orientations, x: Numbers, y: Numbers) -> None:
    """Draw the line of orientations at which the contact reaches the rim."""
    apart = orientations.edge_distance.T
    if numpy.nanmin(apart, initial=0.0) < 0 < numpy.nanmax(apart, initial=0.0):
        axes.contour(x, y, apart, levels=[0.0], colors="black", linestyles=":", linewidths=1.8)
        axes.plot([], [], ":", color="black", linewidth=1.8, label="the contact reaches the rim")


def _hatch(axes: Axes, x: Numbers, y: Numbers, where: Numbers, hatch: str, label: str) -> None:
    from matplotlib.patches import Rectangle

    if not where.any():
        return
    area = axes.contourf(x, y, where.astype(float), levels=[1e-3, 1.5], colors="white", hatches=[hatch], zorder=1.8)
    area.set_edgecolor("0.5")
    area.set_linewidth(0)
    axes.add_patch(Rectangle((x[0], y[0]), 0.0, 0.0, facecolor="white", edgecolor="0.5", hatch=hatch, label=label))


def _mark(axes: Axes, orientations: Orientations) -> None:
    """Mark the orientation of the cup, if it is set and lies on the map."""
    cup = orientations.model.cup
    inside = (
        orientations.inclination[0] <= cup.inclination <= orientations.inclination[-1]
        and orientations.anteversion[0] <= cup.anteversion <= orientations.anteversion[-1]
    )
    if inside and cup.oriented:
        position = degrees(cup.inclination), degrees(cup.anteversion)
        mark: Any = {
            "color": "white",
            "markeredgecolor": "black",
            "markersize": 8,
            "linestyle": "",
            "label": "this cup",
        }
        axes.plot(*position, "o", clip_on=False, **mark)


def load_text(orientations: Orientations) -> str:
    """Describe the load with its direction in the body."""
    shown = {CONTACT[name].symbol: (value, CONTACT[name].shown) for name, value in orientations.load.items()}
    load = ", ".join(f"{symbol} {value * unit.factor:.4g} {unit.text}" for symbol, (value, unit) in shown.items())
    along = ", ".join(f"{part:g}" for part in orientations.model.direction)
    return f"{load} along ({along}); arc of cover {degrees(orientations.model.cup.arc_of_cover):.4g}°"


LIMITED_FIELDS = ("edge_distance", "max_pressure", "half_angle")  # fields of orientations that can be limited


def verdicts(orientations: Orientations, limits: Sequence[Limit]) -> Numbers:
    """Return the code of the `Verdict` on all limits for each orientation; exceeded where the ball is not held."""
    codes = numpy.where(orientations.held, int(Verdict.KEPT), int(Verdict.EXCEEDED))
    for limit in limits:
        codes = numpy.maximum(codes, orientations.error_bar(limit.name).decide(**limit.ends))
    return codes


def within_limits(orientations: Orientations, limits: Sequence[Limit]) -> Numbers:
    """Return a mask of the orientations that keep all limits by their whole error bars."""
    mask: Numbers = verdicts(orientations, limits) == Verdict.KEPT
    return mask


def inclination_ranges(orientations: Orientations, limits: Sequence[Limit]) -> list[tuple[float, float] | None]:
    """Find the inclinations within all limits, for each anteversion.

    Returns
    -------
    list
        Ends in rad of the longest row of neighbouring inclinations within the limits; None without one.
    """
    ranges: list[tuple[float, float] | None] = []
    for within in within_limits(orientations, limits).T:
        edges = numpy.flatnonzero(numpy.diff(numpy.concatenate([[False], within, [False]]).astype(int)))
        pairs = list(zip(edges[::2], edges[1::2] - 1, strict=True))
        first, last = max(pairs, key=lambda pair: pair[1] - pair[0], default=(0, -1))
        ends = float(orientations.inclination[first]), float(orientations.inclination[last])
        ranges.append(ends if pairs else None)
    return ranges


def limits_summary(orientations: Orientations, limits: Sequence[Limit]) -> dict[str, Any]:
    """Return the limits and the orientations within them for JSON; empty without limits."""
    if not limits:
        return {}
    rows = zip(orientations.anteversion, inclination_ranges(orientations, limits), strict=True)
    return {
        "limits": [_limit_text(limit) for limit in limits],
        "within_limits": within_limits(orientations, limits).tolist(),
        "verdicts": [[Verdict(code).word for code in row] for row in verdicts(orientations, limits).tolist()],
        "inclination_ranges": [
            {
                "anteversion_deg": round(degrees(angle), 9),
                "inclination_deg": None if ends is None else [round(degrees(end), 9) for end in ends],
            }
            for angle, ends in rows
        ],
    }


def print_orientations(orientations: Orientations, limits: Sequence[Limit] = (), units: Units = Units.SI) -> None:
    """Print distance to the rim and largest pressure by orientation, the orientations within limits, and the best ones.

    Every computed orientation is printed; columns that do not fit the terminal follow in a further table.
    """
    terminal = Terminal(units)
    print_folded(terminal, joint_sentence(orientations.joint), "bold")
    print_folded(terminal, load_text(orientations), "bold")
    fields = {DERIVED["edge_distance"]: orientations.edge_distance, CONTACT["max_pressure"]: orientations.max_pressure}
    for quantity, values in fields.items():
        label, factor = units.axis(quantity.label(quantity.written))
        digits = 1 if units is Units.SI else 3 if quantity.name == "edge_distance" else 0
        terminal.print(Text(f"{label}, anteversion by inclination"))
        print_columns(terminal, _table(orientations, factor * values, limits, digits))
    for line in _limit_remarks(orientations, limits) if limits else ():
        print_folded(terminal, line, "bold")
    for line in _remarks(orientations, units):
        print_folded(terminal, line, "dim")


def _limit_remarks(orientations: Orientations, limits: Sequence[Limit]) -> Iterator[str]:
    """Yield sentences on the inclinations within the limits, one for neighbouring anteversions of the same range."""
    codes = verdicts(orientations, limits)
    kept, undecided, _ = (int((codes == verdict).sum()) for verdict in Verdict)
    texts = " and ".join(map(_limit_text, limits))
    yield f"limit: {texts}; kept in {kept} of {codes.size} orientations, exceeded where *"
    if undecided:
        yield f"undecided in {undecided} orientations with ?: their error bar contains the limit"
    ranges = inclination_ranges(orientations, limits)
    starts = [row for row in range(len(ranges)) if row == 0 or ranges[row] != ranges[row - 1]]
    for first, following in zip(starts, [*starts[1:], len(ranges)], strict=True):
        angles = [_degree_text(orientations.anteversion[row]) for row in (first, following - 1)]
        rows = angles[0] if following == first + 1 else f"{angles[0]} to {angles[1]}"
        yield f"at {rows} anteversion the limit holds {_range_text(orientations, ranges[first])}"


def _range_text(orientations: Orientations, ends: tuple[float, float] | None) -> str:
    low, high = (_degree_text(orientations.inclination[index]) for index in (0, -1))
    if ends is None:
        return f"at no inclination from {low} to {high}"
    first, last = map(_degree_text, ends)
    if (first, last) == (low, high):
        return f"at every inclination from {low} to {high}"
    step = _degree_text(float(numpy.diff(orientations.inclination).max()))
    reach = f"up to {last}" if first == low else f"from {first} to {last}"
    return f"{reach} inclination (steps of {step})"


def _limit_text(limit: Limit) -> str:
    """Write a limit with its unit, such as "edge_distance >= 1 mm"."""
    unit = QUANTITIES[limit.name].written
    ends = ((">=", limit.low), ("<=", limit.high))
    return " and ".join(f"{limit.name} {sign} {end * unit.factor:g} {unit.text}" for sign, end in ends if isfinite(end))


def _table(orientations: Orientations, values: Numbers, limits: Sequence[Limit], digits: int) -> Table:
    """Make the table of a field: anteversion by inclination; a star marks an exceeded limit, "?" an undecided one."""
    codes = verdicts(orientations, limits)
    columns = range(len(orientations.inclination))
    table = text_table(["", *map(_degree_text, orientations.inclination)])
    for j in range(len(orientations.anteversion)):
        marks = (_MARKS[codes[i, j]] if limits else "" for i in columns)
        cells = (_cell(orientations, values, i, j, mark, digits) for i, mark in zip(columns, marks, strict=True))
        table.add_row(Text(_degree_text(orientations.anteversion[j]), style="bold"), *cells)
    return table


_MARKS = ("", "?", "*")  # marks of the verdicts on the limits


def _cell(orientations: Orientations, values: Numbers, i: int, j: int, mark: str, digits: int) -> Text:
    """Write one value with a mark; yellow if the rim is loaded, a dash if the ball is not held."""
    if not orientations.held[i, j]:
        return Text("-", style="dim")
    return Text(f"{values[i, j]:.{digits}f}{mark}", style="yellow" if orientations.edge_loaded[i, j] else "")


def _remarks(orientations: Orientations, units: Units) -> Iterator[str]:
    """Yield sentences about the best orientations, loaded rims, failures and the duration."""
    if orientations.held.any():
        yield f"furthest from the rim: {_best_text(orientations, orientations.edge_distance, units)}"
    if (orientations.held & numpy.isfinite(orientations.max_pressure)).any():
        yield f"least pressure: {_best_text(orientations, -orientations.max_pressure, units)}"
    loaded = int((orientations.edge_loaded & orientations.held).sum())
    if loaded:
        yield f"{loaded} of {orientations.status.size} orientations load the rim (below 0: how far beyond first touch)"
    if numpy.isposinf(orientations.max_pressure).any():
        yield "inf: the end of the bore digs in, where the pressure is unbounded"
    for status in Status:
        count = int((orientations.status == int(status)).sum())
        if status.failed and count:
            yield f"{count} of {orientations.status.size}: {status.sentence}"
    took = f"{orientations.status.size} orientations in {orientations.seconds:.2f} s"
    yield f"{orientations.model.name}: rings of {degrees(orientations.model.ring_width):.3g}°, {took}"


def _best_text(orientations: Orientations, values: Numbers, units: Units) -> str:
    inclination, anteversion, index = orientations.best(values)
    value = float(values.flat[index])
    is_distance = values is orientations.edge_distance
    size = units.short_length(value) if is_distance else units.text_of(CONTACT["max_pressure"], -value)
    return f"{size} at inclination {_degree_text(inclination)}, anteversion {_degree_text(anteversion)}"


def _degree_text(angle: float) -> str:
    return f"{degrees(angle):.4g}°"
