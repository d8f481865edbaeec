"""Figures of a pack of evidence, drawn from its record alone: they print in grey as well."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from math import prod, radians
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.quantities import QUANTITIES, Quantity
from ..evidence.matrix import NAMES
from ..problem import Joint, Layer, Material, Support
from ..problem.cup import Cup
from ..studies.parameters import PARAMETERS
from .joint_section import joint_section
from .style import BLUE, GREY, INK, LEGEND, ORANGE, VERMILLION, finish, numbered

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Record = Mapping[str, Any]

_KEYS: Mapping[str, Quantity] = {
    each.key: each for each in (*QUANTITIES.values(), *PARAMETERS.values(), *NAMES.values())
}
_WRITTEN = 150
"""Cells of a map up to which each has its number."""


def joint_figure(record: Record) -> Figure:
    """The joint where the pressure is worst, cut through, and the arc of its contact where that is about the axis."""
    drawn = record["drawn"]
    joint = _joint(drawn["joint"])
    figure = joint_section(joint, Cup(arc_of_cover=radians(drawn["arc_of_cover_deg"])))
    if drawn["half_angle_deg"] is None:
        return figure
    edge = radians(drawn["half_angle_deg"])
    angle, radius = numpy.linspace(-edge, edge, 121), float(joint.socket_radius)
    axes = figure.axes[0]
    axes.plot(radius * numpy.sin(angle), -radius * numpy.cos(angle), color=VERMILLION, linewidth=3.5)
    axes.text(
        0.0, -0.75 * radius, f"contact to {drawn['half_angle_deg']:.3g}°", color=VERMILLION, ha="center", fontsize=9
    )
    return figure


def _joint(summary: Record) -> Joint:
    """A joint from its summary."""
    ball, layers = summary["ball"], [dict(each) for each in summary["backing"]]
    return Joint(
        ball_radius=summary["ball_radius"],
        clearance=summary["clearance"],
        liner_thickness=float(summary["liner_thickness"]),
        liner=Material(**summary["liner"]),
        ball=None if ball is None else Material(**ball),
        backing=tuple(Layer(thickness=float(each.pop("thickness")), material=Material(**each)) for each in layers),
        support=Support(summary["support"]),
        name=summary["name"],
    )


def matrix_figure(record: Record, name: str = "max_pressure") -> Figure:
    """A number over the matrix, a cell a case: the worst is framed, what a limit forbids is crossed out."""
    rows, key = record["matrix"], NAMES[name].key
    down, across = _sides(rows)
    table = {tuple(row["case"].values()): row for row in rows}
    names = list(rows[0]["case"])
    places = [[_case(names, down, across, one, other) for other in _all(across)] for one in _all(down)]
    values = numpy.array([[_number(table[case]["numbers"].get(key)) for case in line] for line in places])
    figure, axes = _one(min(11.0, 3.4 + 0.62 * values.shape[1]), min(9.0, 2.2 + 0.34 * values.shape[0]))
    drawn = axes.imshow(values, cmap="cividis", aspect="auto")
    figure.colorbar(drawn, label=_UNITS.get(name) or NAMES[name].head(NAMES[name].written), pad=0.02)
    _tick(axes, down, across)
    _mark(axes, values, record, name, places)
    return figure


def _number(value: Any) -> float:
    return numpy.nan if value is None else float(value)


_UNITS = {"edge_distance": "[mm]", "wear_rate": "[mm³/10⁶]"}
Axis = tuple[str, list[float]]


def _sides(rows: Sequence[Record]) -> tuple[list[Axis], list[Axis]]:
    """The axes of the matrix, shared out over two sides of about the same length."""
    axes = [(key, list(dict.fromkeys(row["case"][key] for row in rows))) for key in rows[0]["case"]]
    splits = [(axes[:place], axes[place:]) for place in range(len(axes) + 1)]
    return min(splits, key=lambda pair: abs(2 * _count(pair[0]) - _count(pair[1])))


def _count(axes: Sequence[Axis]) -> int:
    return prod(len(values) for _, values in axes)


def _all(axes: Sequence[Axis]) -> list[tuple[float, ...]]:
    return list(product(*(values for _, values in axes)))


def _case(names: list[str], down: Sequence[Axis], across: Sequence[Axis], one: Any, other: Any) -> tuple[float, ...]:
    found = dict(zip([key for key, _ in (*down, *across)], (*one, *other), strict=True))
    return tuple(found[name] for name in names)


def _tick(axes: Axes, down: Sequence[Axis], across: Sequence[Axis]) -> None:
    for side, set_ticks, set_label in (
        (across, axes.set_xticks, axes.set_xlabel),
        (down, axes.set_yticks, axes.set_ylabel),
    ):
        texts = [" | ".join(f"{value:.4g}" for value in values) for values in _all(side)]
        step = max(1, len(texts) // 40)
        turned: Any = {"rotation": 90} if side is across and max(map(len, texts), default=0) > 9 else {}
        set_ticks(range(0, len(texts), step), texts[::step], fontsize=8, **turned)
        set_label(" | ".join(_head(key) for key, _ in side))


def _mark(axes: Axes, values: Numbers, record: Record, name: str, places: Any) -> None:
    """Numbers in the cells, a frame about the worst, a cross where a limit is not kept."""
    low, high = _allowed(record, name)
    middle = 0.5 * (numpy.nanmin(values) + numpy.nanmax(values))
    worst = tuple(record["worst"][name]["case"].values()) if name in record["worst"] else None
    for (row, column), value in numpy.ndenumerate(values):
        ink = "white" if value < middle else "black"
        if values.size <= _WRITTEN:
            axes.text(column, row, f"{value:.3g}", ha="center", va="center", fontsize=8, color=ink)
        if not low <= value <= high:
            axes.plot(column + 0.38, row - 0.3, marker="x", markersize=6, color=ink, linewidth=0.8)
        if places[row][column] == worst:
            frame: Any = {"fill": False, "edgecolor": VERMILLION, "linewidth": 2.2}
            axes.add_patch(_rectangle(column - 0.47, row - 0.47, 0.94, 0.94, **frame))


def _rectangle(*place: float, **style: Any) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle((place[0], place[1]), *place[2:], **style)


def _allowed(record: Record, name: str) -> tuple[float, float]:
    """The least and the most that the limits of a number leave, in the unit of files."""
    ends = [(each["low"], each["high"]) for each in record["limits"] if each["name"] == name]
    lows, highs = ([end for end in side if end is not None] for side in zip(*ends, strict=True)) if ends else ([], [])
    return max(lows, default=-numpy.inf), min(highs, default=numpy.inf)


def methods_figure(record: Record) -> Figure:
    """Every other method against the one that answers, at each worst case, by quantity, and the required accuracy."""
    pieces = [piece for piece in record["calculation"] if piece["methods"][0]["numbers"]]
    keys = list(dict.fromkeys(key for piece in pieces for key in piece["deviation"]))
    figure, axes = _one(7.2, 1.4 + 0.5 * len(keys))
    pairs = [(method, piece["methods"][0]) for piece in pieces for method in piece["methods"][1:]]
    pairs = [(method, first) for method, first in pairs if method["valid"] and method["aligned"] == first["aligned"]]
    names = list(dict.fromkeys(method["name"] for method, _ in pairs))
    for method, first in pairs:
        _dots(axes, keys, names, method, first)
    required = 100 * record["required"]["accuracy"]
    axes.axvspan(-required, required, color="0.94", zorder=0)
    axes.axvline(0.0, color=INK, linewidth=0.8)
    axes.set_yticks(range(len(keys)), [_KEYS[key].title for key in keys])
    axes.set_ylim(len(keys) - 0.4, -0.6)
    _legend(axes)
    finish(axes, f"away from {pieces[0]['methods'][0]['name']} [%] (grey: required accuracy)", "")
    return figure


def _dots(axes: Axes, keys: Sequence[str], names: Sequence[str], method: Record, first: Record) -> None:
    place = names.index(method["name"])
    common = [key for key in keys if key in method["numbers"] and first["numbers"].get(key)]
    off = [100 * (method["numbers"][key] / first["numbers"][key] - 1) for key in common]
    up = [keys.index(key) + 0.12 * (place - (len(names) - 1) / 2) for key in common]
    style: Any = {"color": numbered(place).colour, "marker": "osD^vP"[place % 6], "linestyle": "", "markersize": 5}
    axes.plot(off, up, **style, label=method["name"])


def _legend(axes: Axes) -> None:
    """Each name once."""
    handles, labels = axes.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    if once:
        axes.legend(once.values(), once.keys(), **LEGEND)


def bands_figure(record: Record) -> Figure:
    """What the tolerances leave of each answer, and which of them matter: bands and Sobol's indices."""
    from matplotlib.figure import Figure

    found = record["uncertainty"]
    names, keys = list(next(iter(found["sobol"].values()))), list(found["bands"])
    figure = Figure(figsize=(9.6, 1.5 + 0.34 * max(len(names), len(keys))), layout="constrained")
    left, right = figure.subplots(1, 2)
    reach = 0.0
    for place, key in enumerate(keys):
        band = found["bands"][key]
        low, high = (100 * (band[end] / band["median"] - 1) for end in ("low", "high"))
        reach = max(reach, -low, high)
        left.barh(place, high - low, left=low, height=0.55, color=BLUE, edgecolor=INK, linewidth=0.6)
        left.text(
            high, place, f"  {band['low']:.4g} to {band['high']:.4g} {_KEYS[key].written.text}", fontsize=8, va="center"
        )
    left.axvline(0.0, color=INK, linewidth=0.8)
    left.set_yticks(range(len(keys)), [_KEYS[key].title for key in keys])
    left.set_xlim(-1.15 * reach, 3.2 * reach)
    left.invert_yaxis()
    finish(left, "away from the median [%], 95 %", "")
    height = 0.8 / len(found["sobol"])
    for number, (key, shares) in enumerate(found["sobol"].items()):
        up = [place + height * (number - (len(found["sobol"]) - 1) / 2) for place in range(len(names))]
        style: Any = {"color": (ORANGE, GREY)[number % 2], "hatch": ("", "///")[number % 2], "edgecolor": INK}
        right.barh(up, [shares[name] for name in names], height, **style, linewidth=0.6, label=_KEYS[key].title)
    right.set_yticks(range(len(names)), [QUANTITIES[name].title for name in names])
    right.set_xlim(0.0, 1.05)
    right.invert_yaxis()
    right.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, **LEGEND)
    finish(right, "share in the variance (total order)", "")
    return figure


def wear_figure(record: Record) -> Figure:
    """What is worn away over the cycles where wear is worst, with its band where patients differ."""
    found = record["wear"]
    figure, axes = _one(5.6, 3.2)
    cycles = [0.0, *(1e-6 * row["cycles"] for row in found["history"])]
    axes.plot(cycles, [0.0, *(row["volume"] for row in found["history"])], color=INK, marker="o", markersize=4)
    bands = [band for band in found.get("bands", ()) if band["volume"]["low"] is not None]
    if bands:
        low, high = ([0.0, *(band["volume"][end] for band in bands)] for end in ("low", "high"))
        through = [0.0, *(1e-6 * band["cycles"] for band in bands)]
        axes.fill_between(through, low, high, color=BLUE, alpha=0.25, linewidth=0)
    finish(axes, "cycles [million]", "worn volume [mm³]" + (", band of 95 %" if bands else ""))
    return figure


def _one(width: float, height: float) -> tuple[Figure, Axes]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots()


def _head(key: str) -> str:
    each = _KEYS[key]
    return f"{each.title}{each.written.text_in_brackets}"
