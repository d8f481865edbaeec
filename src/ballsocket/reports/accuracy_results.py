"""Accuracy of models beside their references: text, heat map, and descriptions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy

from ..core.answers import Answer, Column, Row, Table
from ..core.kinds import MILLIMETRES, NEWTONS, Unit
from ..core.quantities import CONTACT, QUANTITIES
from ..core.unit_systems import Amount, Sentence
from ..paper.cases import RATIOS
from ..paper.cases import TableColumn as TableColumn
from .style import single_axes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..elasticity.finite_elements.calculix import CcxAnswer

_LOADS = {"indentation": "force", "max_pressure": "force", "half_angle": "force", "force": "indentation"}
HEADS = {name: f"{CONTACT[name].symbol} at given {CONTACT[load].symbol}" for name, load in _LOADS.items()}
"""Heads of the columns by quantity."""

Record = Mapping[str, Any]


def markdown(rows: Iterable[Record]) -> str:
    """Write a Markdown table: median, 95th percentile and worst error in percent, and the joint of the worst error."""
    lines = [
        f"| model | {' | '.join(HEADS.values())} | worst joint |",
        "|---|" + "---:|" * len(HEADS) + "---|",
    ]
    for row in rows:
        cells = (spread(row["errors"][name]) for name in HEADS)
        lines.append(f"| `{row['model']}` | {' | '.join(cells)} | {worst_joint(row)} |")
    return "\n".join(lines) + "\n"


def spread(error: Record) -> str:
    """Write median, 95th percentile and worst error in percent; one number if they are equal."""
    errors = [percent(error[name]) for name in ("median", "percentile_95", "worst")]
    return errors[0] if len(set(errors)) == 1 else " / ".join(errors)


def percent(share: float) -> str:
    """Write a share in percent with two digits: 0.74, 12, 160; `<0.001` below."""
    value = 100 * share
    if value < 0.001:
        return "<0.001"
    return f"{value:.0f}" if value >= 100 else f"{value:.2g}"


def worst_joint(row: Record) -> str:
    """Describe the joint of the largest error of a model, after the symbol of its quantity."""
    name = max(HEADS, key=lambda quantity: float(row["errors"][quantity]["worst"]))
    return f"{CONTACT[name].symbol}: {place(row['errors'][name])}"


def place(error: Record) -> str:
    """Describe the joint and the load of a worst error."""
    at = _numbers(error)
    digits = {"ball_radius": 3, "clearance": 2, "liner_thickness": 3, "poisson": 2}
    joint = ", ".join(f"{QUANTITIES[name].symbol} {at[name]:.{count}g}" for name, count in digits.items())
    return f"{joint}, {at['force']:g} {CONTACT['force'].unit}"


def table(rows: Iterable[Record]) -> Iterator[Sequence[Any]]:
    """Yield heads, and a row for each model and quantity; errors as shares, lengths in mm, forces in N."""
    yield (*_COLUMNS, "ball_radius", "clearance", "liner_thickness", "poisson", "force")
    for row in rows:
        for name, error in row["errors"].items():
            errors = (error[statistic] for statistic in ("median", "percentile_95", "worst"))
            yield (row["model"], name, *errors, row["answered"], row["valid"], *_numbers(error).values())


_COLUMNS = ("model", "quantity", "median", "percentile_95", "worst", "answered", "valid")


def _numbers(error: Record) -> dict[str, float]:
    """Return the lengths (mm), Poisson's ratio and force (N) of a worst error by name."""
    at = error["worst_at"]
    lengths = {name: at["joint"][name] for name in ("ball_radius", "clearance", "liner_thickness")}
    return {**lengths, "poisson": at["joint"]["liner"]["poisson"], "force": at["force"]}


def heat_map(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Draw the errors of every model by quantity; the colour is the 95th percentile."""
    from matplotlib.colors import LogNorm

    errors = [[row["errors"][name] for name in HEADS] for row in rows]
    high = numpy.array([[100 * error["percentile_95"] for error in line] for line in errors])
    figure, axes = single_axes(8.6, 0.42 * len(rows) + 1.3)
    norm = LogNorm(*_HEAT_ENDS)
    image = axes.imshow(high, cmap="YlOrRd", norm=norm, aspect="auto")
    for i, line in enumerate(errors):
        for j, error in enumerate(line):
            dark = norm(high[i, j]) > _DARK
            axes.text(j, i, spread(error), ha="center", va="center", fontsize=8.5, color="white" if dark else "black")
    axes.set_xticks(range(len(HEADS)), list(HEADS.values()))
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(rows)), [row["model"] for row in rows])
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    bar = figure.colorbar(image, ax=axes, extend="both", pad=0.01)
    bar.set_label("95th percentile [%]")
    axes.set_xlabel("median / 95th percentile / worst error in %")
    return figure


_HEAT_ENDS = (0.1, 300.0)  # %
_DARK = 0.72  # of the colours


_KILONEWTONS, _GIGAPASCALS, _PERCENT = Unit("kN", 1e-3), Unit("GPa", 1e-3), Unit("%", 100.0)


def describe_table_3(columns: Sequence[TableColumn]) -> Answer:
    """Describe Table 3 of the paper beside the same fit to the exact solution."""
    rows: list[list[str]] = []
    for i, name in enumerate(("C1", "C2", "C3")):
        rows.append([f"{name}, paper", *(f"{column.paper[i]:.2f}" for column in columns)])
        rows.append([f"{name}, exact", *(f"{column.ours[i]:.2f}" for column in columns)])
    thick = RATIOS < 4.5
    for head, part in ((f"paper's K, R2/L to {RATIOS[thick][-1]:g}", thick), (f"to {RATIOS[-1]:g}", RATIOS > 0)):
        worst = (max(column.difference[part], key=abs) for column in columns)
        rows.append([f"{head}: off by", *(f"{100 * share:+.1f} %" for share in worst)])
    residuals = (float(numpy.max(abs(column.calibration.residual))) for column in columns)
    rows.append(["our fit: largest residual", *(f"{100 * share:.1f} %" for share in residuals)])
    loads = [Amount(float(force), _KILONEWTONS) for force in columns[0].calibration.force]
    spread = Sentence("K over {} to {}: spread", loads[0], loads[-1])
    rows.append([spread, *(f"{100 * column.calibration.spread:.1f} %" for column in columns)])
    for name in ("indentation", "max_pressure", "half_angle", "force"):
        errors = (100 * column.calibration.error[name] for column in columns)
        rows.append([f"closed form: {name.replace('_', ' ')}", *(f"{error:.1f} %" for error in errors)])
    heads = [Column.of_words("fit", " "), *(Column.of_number(f"ν {column.poisson:g}") for column in columns)]
    dimensions = Amount(24.0, MILLIMETRES), Amount(0.1, MILLIMETRES), Amount(1e3, _GIGAPASCALS)
    text = f"{len(RATIOS)} joints, outer radius {{}}, c {{}}, steel head on {{}}; mean of p0/d at {{}}, {{}}, {{}}."
    return Answer(
        title="Table 3 of Heß & Forsbach 2021: K R2/E = C1 + C2 (R2/L) + C3 (R2/L)²",
        tables=[Table("table_3", "Table 3", heads, list(map(Row, rows)))],
        notes=[Sentence(text, *dimensions, *loads)],
    )


def describe_rival(ours: Mapping[str, numpy.ndarray], theirs: CcxAnswer) -> Answer:
    """Describe the result of ballsocket at each loaded step of a deck beside that of CalculiX, with the deviation."""
    loaded = ours["force"] != 0  # the others are after unloading
    own = {**ours, "half_angle": numpy.radians(ours["half_angle_deg"])}
    columns, values = [Column.of(CONTACT["indentation"])], [ours["indentation"][loaded]]
    for name in ("force", "pole_pressure", "half_angle"):
        mine, its = own[name][loaded], getattr(theirs, name)[loaded]
        symbol, unit, is_angle = CONTACT[name].symbol, CONTACT[name].written, name == "half_angle"
        columns += [Column.of_number(name, symbol, unit, digits=5)]
        columns += [Column.of_number(f"{name}_ccx", f"{symbol} ccx", unit, digits=5)]
        columns += [Column.of_number(f"{name}_deviation", f"Δ{symbol}", unit if is_angle else _PERCENT, digits=3)]
        values += [mine, its, its - mine if is_angle else its / mine - 1]
    rows = [Row(cells) for cells in numpy.column_stack(values).tolist()]
    return Answer(title="ballsocket and CalculiX", tables=[Table("steps", "Steps", columns, rows)])


def describe_tilted_rival(ours: Sequence[float], rival: Sequence[float]) -> Answer:
    """Describe the force components (N) of a tilted contact beside those of CalculiX."""
    size = float(numpy.linalg.norm(rival))
    columns = [
        Column.of_words("component", "force"),
        Column.of_number("force", "ballsocket", NEWTONS, digits=6),
        Column.of_number("force_ccx", "ccx", NEWTONS, digits=6),
        Column.of_number("deviation", "Δ of the load", _PERCENT, digits=3),
    ]
    names = ("towards the rim", "across", "towards the dome")
    rows = [Row((name, mine, its, (mine - its) / size)) for name, mine, its in zip(names, ours, rival, strict=True)]
    return Answer(title="ballsocket and CalculiX", tables=[Table("components", "Components", columns, rows)])
