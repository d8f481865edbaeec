"""Texts and figures of an evidence pack, from its record alone; figures are legible in grey."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from math import inf, radians
from typing import TYPE_CHECKING, Any

import numpy

from ..contact.verdict import Bounded, bar_text
from ..core.arrays import Numbers
from ..core.kinds import Unit
from ..core.quantities import CONTACT, QUANTITIES, Quantity
from ..core.unit_systems import Amount, Sentence, Units
from ..evidence.matrix import KEYS, LIMITED, NAMES, amount_text, number, title_of
from ..files.joint_file import JointFile
from ..problem import Joint, Layer, Material, Support
from ..problem.cup import Cup
from ..problem.hardening import Hardening
from ..studies.parameters import LOADS, PARAMETERS
from .joint_drawing import DrawnLoad, joint_svg
from .style import BLUE, GREY, INK, LEGEND, ORANGE, VERMILLION, finish, new_figure, numbered, single_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Record = Mapping[str, Any]  # content of the JSON file of an evidence pack, or a part of it

_LEAST_ERROR = 1e-5  # relative error below which no error bar is written: it is below the digits of the number


def case_text(case: Mapping[str, float], units: Units = Units.SI) -> str:
    """Describe a case: each input with its value and unit."""
    return ", ".join(f"{KEYS[key].title} {amount_text(KEYS[key], value, units)}" for key, value in case.items())


def unloaded(case: Mapping[str, float]) -> dict[str, float]:
    """Return a case without its load, because a load cycle has its own."""
    return {key: value for key, value in case.items() if KEYS[key].name not in LOADS}


def value_text(name: str, row: Record, units: Units = Units.SI) -> str:
    """Write a number of a case with its unit and error bar."""
    quantity = NAMES[name]
    value = amount_text(quantity, row["numbers"][quantity.key], units)
    error, (low, high) = row["errors"].get(quantity.key), row["bars"].get(quantity.key, (None, None))
    if error is not None or low is None:
        return value + error_text(error)
    factor = units.of_text(quantity.written.text).factor
    bar = bar_text(Bounded(row["numbers"][quantity.key], low, inf if high is None else high).scaled(factor), number)
    return f"{value} ({bar})" if bar else value


def column_head(key: str, units: Units = Units.SI) -> str:
    """Return the head of a column: symbol or title with the unit in brackets."""
    quantity = KEYS[key]
    return f"{quantity.symbol or quantity.title}{units.of_text(quantity.written.text).text_in_brackets}"


def bare_number(key: str, value: float | None, units: Units) -> str:
    """Write a number of the record without its unit, by its key."""
    return number(None if value is None else value * units.of_text(KEYS[key].written.text).factor)


def recentred_text(change: Record, units: Units = Units.SI) -> str:
    """Describe an input whose tolerance states another nominal value than the joint's file."""
    stated, used = (amount_text(LIMITED[change["name"]], change[key], units) for key in ("stated", "used"))
    title = title_of(change["name"])
    return f"{title}: the joint has {stated}, its tolerance states {used}; everything is computed with {used}."


def quantities_of_interest(record: Record) -> list[str]:
    """Return the names of the limited quantities, or of all quantities with a worst case."""
    return list(dict.fromkeys(limit["name"] for limit in record["limits"])) or list(record["worst"])


def error_text(error: float | None) -> str:
    """Write a relative error as an error bar; empty if the error is unknown or below the digits of the number."""
    return f" ± {percent(error)}" if error and error > _LEAST_ERROR else ""


def percent(share: float) -> str:
    """Write a share in percent with two digits."""
    return f"{100 * share:.2g} %"


def band_text(band: Record, factor: float = 1.0) -> str:
    """Write the low and the high end of a band, times a factor."""
    return f"{number(factor * band['low'])} to {number(factor * band['high'])}"


def named_number(name: str, value: Any) -> str:
    """Write a number after its name, which ends in its unit: "pressure, MPa" and 3 give "pressure: 3 MPa"."""
    title, _, unit = name.rpartition(", ")
    return f"{title or unit}: {number(value)} {unit if title else ''}".strip()


_KEYS: Mapping[str, Quantity] = {
    each.key: each for each in (*QUANTITIES.values(), *PARAMETERS.values(), *NAMES.values())
}
_MAX_WRITTEN_CELLS = 150  # cells of a map up to which each contains its number


def joint_drawing(record: Record, units: Units) -> bytes:
    """Draw the section of the joint with the largest pressure, and the edge of an axial contact, as SVG."""
    drawn = record["drawn"]
    file = JointFile(_joint(drawn["joint"]), {}, Cup(arc_of_cover=radians(drawn["arc_of_cover_deg"])))
    if drawn["half_angle_deg"] is None:
        return joint_svg(file, units=units)
    force = record["worst"]["max_pressure"]["numbers"][CONTACT["force"].key]
    load = DrawnLoad(text=units.text_of(CONTACT["force"], force))
    return joint_svg(file, None, radians(drawn["half_angle_deg"]), load, units)


def _joint(summary: Record) -> Joint:
    ball, layers = summary["ball"], [dict(layer) for layer in summary["backing"]]
    return Joint(
        ball_radius=summary["ball_radius"],
        clearance=summary["clearance"],
        liner_thickness=float(summary["liner_thickness"]),
        liner=_material(summary["liner"]),
        ball=None if ball is None else _material(ball),
        backing=tuple(Layer(thickness=float(layer.pop("thickness")), material=_material(layer)) for layer in layers),
        support=Support(summary["support"]),
        name=summary["name"],
    )


def _material(summary: Record) -> Material:
    hardening = summary.get("hardening")
    return Material(**{**summary, "hardening": None if hardening is None else Hardening(**hardening)})


def matrix_figure(record: Record, name: str = "max_pressure", units: Units = Units.SI) -> Figure:
    """Draw a result over the matrix, one cell for each case; the worst is framed, a broken limit is crossed."""
    rows, key = record["matrix"], NAMES[name].key
    unit = units.of_text(NAMES[name].written.text)
    down, across = _sides(rows)
    table = {tuple(row["case"].values()): row for row in rows}
    axis_names = [name for name, _ in (*down, *across)]
    order = [axis_names.index(name) for name in rows[0]["case"]]
    combined = [[(*row, *column) for column in _combinations(across)] for row in _combinations(down)]
    cases = [[tuple(case[index] for index in order) for case in line] for line in combined]
    values = unit.factor * numpy.array(
        [[table[case]["numbers"].get(key) for case in line] for line in cases], dtype=float
    )
    figure, axes = single_axes(min(11.0, 3.4 + 0.62 * values.shape[1]), min(9.0, 2.2 + 0.34 * values.shape[0]))
    drawn = axes.imshow(values, cmap="cividis", aspect="auto")
    figure.colorbar(drawn, label=NAMES[name].head(unit), pad=0.02)
    _tick(axes, down, across, units)
    _mark(axes, values, record, name, cases, unit.factor)
    return figure


Axis = tuple[str, list[float]]


def _sides(rows: Sequence[Record]) -> tuple[list[Axis], list[Axis]]:
    """Distribute the axes of the matrix over two sides of about the same length."""
    axes = [(key, list(dict.fromkeys(row["case"][key] for row in rows))) for key in rows[0]["case"]]
    splits = [(axes[:split], axes[split:]) for split in range(len(axes) + 1)]
    return min(splits, key=lambda pair: abs(2 * len(_combinations(pair[0])) - len(_combinations(pair[1]))))


def _combinations(axes: Sequence[Axis]) -> list[tuple[float, ...]]:
    return list(product(*(values for _, values in axes)))


def _tick(axes: Axes, down: Sequence[Axis], across: Sequence[Axis], units: Units) -> None:
    for side, set_ticks, set_label in (
        (across, axes.set_xticks, axes.set_xlabel),
        (down, axes.set_yticks, axes.set_ylabel),
    ):
        written = [units.of_text(_KEYS[key].written.text) for key, _ in side]
        texts = [
            " | ".join(f"{value * unit.factor:.4g}" for value, unit in zip(values, written, strict=True))
            for values in _combinations(side)
        ]
        step = max(1, len(texts) // 40)
        rotation: Any = {"rotation": 90} if side is across and max(map(len, texts), default=0) > 9 else {}
        set_ticks(range(0, len(texts), step), texts[::step], fontsize=8, **rotation)
        labels = (f"{_KEYS[key].title}{unit.text_in_brackets}" for (key, _), unit in zip(side, written, strict=True))
        set_label(" | ".join(labels))


def _mark(axes: Axes, values: Numbers, record: Record, name: str, cases: Any, factor: float) -> None:
    """Write numbers in the cells, frame the worst case, and cross cells that break a limit."""
    from matplotlib.patches import Rectangle

    low, high = (factor * end for end in _allowed(record, name))
    middle = 0.5 * (numpy.nanmin(values) + numpy.nanmax(values))
    worst = tuple(record["worst"][name]["case"].values()) if name in record["worst"] else None
    for (row, column), value in numpy.ndenumerate(values):
        ink = "white" if value < middle else "black"
        if values.size <= _MAX_WRITTEN_CELLS:
            axes.text(column, row, f"{value:.3g}", ha="center", va="center", fontsize=8, color=ink)
        if not low <= value <= high:
            axes.plot(column + 0.38, row - 0.3, marker="x", markersize=6, color=ink, linewidth=0.8)
        if cases[row][column] == worst:
            frame: Any = {"fill": False, "edgecolor": VERMILLION, "linewidth": 2.2}
            axes.add_patch(Rectangle((column - 0.47, row - 0.47), 0.94, 0.94, **frame))


def _allowed(record: Record, name: str) -> tuple[float, float]:
    """Return the range that the limits of a result allow, in the unit of files."""
    ends = [(limit["low"], limit["high"]) for limit in record["limits"] if limit["name"] == name]
    lows, highs = ([end for end in side if end is not None] for side in zip(*ends, strict=True)) if ends else ([], [])
    return max(lows, default=-numpy.inf), min(highs, default=numpy.inf)


def methods_figure(record: Record) -> Figure:
    """Draw the deviation of every other method by result at each worst case, with the required accuracy."""
    pieces = [piece for piece in record["calculation"] if piece["methods"][0]["numbers"]]
    keys = list(dict.fromkeys(key for piece in pieces for key in piece["deviation"]))
    figure, axes = single_axes(7.2, 1.4 + 0.5 * len(keys))
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
    handles, labels = axes.get_legend_handles_labels()
    if labels:
        once = dict(zip(labels, handles, strict=True))
        axes.legend(once.values(), once.keys(), **LEGEND)
    finish(axes, f"deviation from {pieces[0]['methods'][0]['name']} [%] (grey: required accuracy)", "")
    return figure


def _dots(axes: Axes, keys: Sequence[str], names: Sequence[str], method: Record, first: Record) -> None:
    index = names.index(method["name"])
    common = [key for key in keys if key in method["numbers"] and first["numbers"].get(key)]
    off = [100 * (method["numbers"][key] / first["numbers"][key] - 1) for key in common]
    up = [keys.index(key) + 0.12 * (index - (len(names) - 1) / 2) for key in common]
    style: Any = {"color": numbered(index).colour, "marker": "osD^vP"[index % 6], "linestyle": "", "markersize": 5}
    axes.plot(off, up, **style, label=method["name"])


def bands_figure(record: Record) -> Figure:
    """Draw the band of each result from the tolerances beside the Sobol indices of the tolerances."""
    uncertainty = record["uncertainty"]
    names, keys = list(next(iter(uncertainty["sobol"].values()))), list(uncertainty["bands"])
    figure = new_figure(9.6, 1.5 + 0.34 * max(len(names), len(keys)))
    band_axes, sobol_axes = figure.subplots(1, 2)
    reach = 0.0
    for row, key in enumerate(keys):
        band = uncertainty["bands"][key]
        low, high = (100 * (band[end] / band["median"] - 1) for end in ("low", "high"))
        reach = max(reach, -low, high)
        band_axes.barh(row, high - low, left=low, height=0.55, color=BLUE, edgecolor=INK, linewidth=0.6)
        ends = (Amount(band[end], Unit(_KEYS[key].written.text)) for end in ("low", "high"))
        band_axes.text(high, row, Sentence("  {} to {}", *ends), fontsize=8, va="center")
    band_axes.axvline(0.0, color=INK, linewidth=0.8)
    band_axes.set_yticks(range(len(keys)), [_KEYS[key].title for key in keys])
    band_axes.set_xlim(-1.15 * reach, 3.2 * reach)
    band_axes.invert_yaxis()
    finish(band_axes, "deviation from the median [%], 95 %", "")
    height = 0.8 / len(uncertainty["sobol"])
    for index, (key, sobol_indices) in enumerate(uncertainty["sobol"].items()):
        up = [row + height * (index - (len(uncertainty["sobol"]) - 1) / 2) for row in range(len(names))]
        style: Any = {"color": (ORANGE, GREY)[index % 2], "hatch": ("", "///")[index % 2], "edgecolor": INK}
        sobol_axes.barh(
            up, [sobol_indices[name] for name in names], height, **style, linewidth=0.6, label=_KEYS[key].title
        )
    sobol_axes.set_yticks(range(len(names)), [QUANTITIES[name].title for name in names])
    sobol_axes.set_xlim(0.0, 1.05)
    sobol_axes.invert_yaxis()
    sobol_axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, **LEGEND)
    finish(sobol_axes, "share in the variance (total order)", "")
    return figure


def wear_figure(record: Record) -> Figure:
    """Draw the worn volume over the cycles of the worst case, with the band of patients who differ."""
    wear = record["wear"]
    figure, axes = single_axes(5.6, 3.2)
    cycles = [0.0, *(1e-6 * row["cycles"] for row in wear["history"])]
    axes.plot(cycles, [0.0, *(row["volume"] for row in wear["history"])], color=INK, marker="o", markersize=4)
    bands = [band for band in wear.get("bands", ()) if band["volume"]["low"] is not None]
    if bands:
        low, high = ([0.0, *(band["volume"][end] for band in bands)] for end in ("low", "high"))
        through = [0.0, *(1e-6 * band["cycles"] for band in bands)]
        axes.fill_between(through, low, high, color=BLUE, alpha=0.25, linewidth=0)
    finish(axes, "cycles [million]", "worn volume [mm³]" + (", band of 95 %" if bands else ""))
    return figure
