"""Makes the tables and the figure of `explanation/hip_validation.md`: `python docs/make_hip_validation.py`, by hand."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from matplotlib.figure import Figure

from ballsocket.evidence.hip_wear import INPUTS, PUBLISHED, Predicted, Ratio, patients, ratios, simulators
from ballsocket.output.style import BLUE, VERMILLION, finish

DOCS = Path(__file__).parent
_UNITS = {"mm3/Mc": "mm³/Mc", "mm3/year": "mm³/year"}
PAGE = DOCS / "explanation" / "hip_validation.md"


def ratio_table(found: Iterable[Ratio]) -> str:
    rows = []
    for each in found:
        one, other = PUBLISHED[each.numerator], PUBLISHED[each.denominator]
        area = "" if each.area is None else f"{each.area:.2f}"
        what = f"{one.description}, over {other.description}"
        rows.append((what, f"{one.value / other.value:.2f}", f"{each.archard:.2f}", area, one.source))
    return _table(("measured over measured", "measured", "Archard", "area law", "source"), rows)


def band_table(found: Iterable[Predicted]) -> str:
    rows = []
    for each in found:
        told = PUBLISHED[each.name]
        spread = f" ({told.spread})" if told.spread else ""
        rows.append(
            (
                told.description,
                f"{told}{spread} {_UNITS.get(told.unit, told.unit)}",
                _short(each.median),
                f"{_short(each.low)} to {_short(each.high)}",
                told.source if told.read == "abstract" else f"{told.source} ({told.read})",
            )
        )
    return _table(("what", "measured", "predicted", "95 % of the predictions", "source"), rows)


def _short(value: float) -> str:
    return f"{float(f'{value:.2g}'):g}"


def _table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    lines = [list(heads), *map(list, rows)]
    lines.insert(1, ["---"] * len(lines[0]))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def inputs() -> str:
    return "\n".join(f"- {each}." for each in INPUTS)


def figure(panels: dict[str, list[Predicted]]) -> Figure:
    """Measured numbers beside the bands of their predictions, a panel for each unit."""
    drawn = Figure(figsize=(9.0, 4.6), layout="constrained")
    for axes, (title, found) in zip(drawn.subplots(1, len(panels)), panels.items(), strict=True):
        for row, each in enumerate(found):
            told = PUBLISHED[each.name]
            axes.plot([each.low, each.high], [row, row], color=BLUE, linewidth=7, alpha=0.3, solid_capstyle="butt")
            axes.plot(each.median, row, "|", color=BLUE, markersize=12)
            axes.errorbar(
                told.value, row, xerr=told.half_width or None, fmt="o", color=VERMILLION, markersize=5, capsize=3
            )
        axes.set_yticks(range(len(found)), [PUBLISHED[each.name].description for each in found], fontsize=8)
        axes.invert_yaxis()
        axes.set_xlim(left=0)
        finish(axes, title, "")
    drawn.suptitle("dots: measured; bars: 95 % of the predictions, whose inputs are assumed", fontsize=10)
    return drawn


def main() -> None:
    shaken, walked = list(simulators()), list(patients())
    found = {"inputs": inputs(), "ratios": ratio_table(ratios()), "bands": band_table([*shaken, *walked])}
    text = PAGE.read_text(encoding="utf-8")
    for name, part in found.items():
        text = re.sub(rf"(?<=% {name} begin\n).*?(?=% {name} end)", f"\n{part}\n\n", text, flags=re.S)
    PAGE.write_text(text, encoding="utf-8")
    panels = {
        unit: [each for each in (*shaken, *walked) if PUBLISHED[each.name].unit in units]
        for unit, units in {"mm³ a million cycles": ("mm3/Mc",), "mm, and mm a year": ("mm", "mm/year")}.items()
    }
    figure(panels).savefig(DOCS / "hip_validation.png", dpi=130)


if __name__ == "__main__":
    main()
