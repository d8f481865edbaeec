"""One input: a result over one number of the joint, with the present design and the limits."""

from __future__ import annotations

from typing import Any

import numpy

from ...contact.verdict import Verdict
from ...core.quantities import QUANTITIES
from ...reports.figure_files import figure_bytes
from ...reports.study_plots import result_figure
from ...reports.style import INK, VERMILLION, LineStyle
from ...studies.limits import verdicts
from ...studies.study_answer import describe_study
from ...studies.variance_shares import uncertainty_tables
from ..pictures.chart import Curve, chart, charts, spans
from ..pressing import axis_end, effects_are_slow, effects_of
from ..state.screen import MAPPED, Screen
from ..view import Document, View
from ..widgets.blocks import Block, Content, answer_blocks, sentence
from ..widgets.controls import Control, chosen, tolerances_input
from ..widgets.limit_rows import limit_text, present_value
from ..widgets.words import alert
from .design_map import axis_control, checked, end_control, limit_inputs, study_rows
from .map_study import limits_of, models_of, swept

_LIMIT = LineStyle(VERMILLION, (2.0, 1.5))


class OneInput(View):
    """View of a result over one parameter, computed as a study by a quick model."""

    name, title = "curve", "One input"
    body = """
<div class="inputs-row" id="curve-inputs"></div>
<div data-field="curve.limits"></div>
<div id="curve-trouble" role="alert"></div>
<div id="curve-chart"></div>
<h3>Sensitivity and tolerances</h3>
<div data-field="curve.tolerances"></div>
<div id="curve-effects"></div>
"""

    def controls(self, screen: Screen) -> list[Control]:
        controls = [
            axis_control(screen, "across").but(label="Input"),
            end_control(screen, "across", "low").but(label="from"),
            end_control(screen, "across", "high").but(label="to"),
            chosen(screen, "quantity", "Result", [(name, QUANTITIES[name].title) for name in MAPPED]),
            chosen(screen, "map_model", "Model", models_of(screen), name="model"),
        ]
        edits = [Control(control.field, checked(screen, control.read, ["across"])) for control in controls]
        return [*edits, *limit_inputs(screen, swept), tolerances_input(screen)]

    def show(self, screen: Screen) -> None:
        if not self.channel.shown_value("#curve-chart"):
            self.put(chart="<p class='quiet'>Preparing the curve …</p>")
        self.expect("chart", "effects")
        self.compute(lambda: result_chart(swept(screen), screen), lambda drawn: self.put(trouble="", chart=[drawn]))
        self.compute(lambda: _effects(screen), lambda content: self.put(effects=content))

    def document(self, screen: Screen) -> Document:
        results, units = swept(screen), screen.reading.units
        limits = [limit for limit in limits_of(screen) if limit.name == screen.quantity]
        (table,) = describe_study(results).tables
        return Document(
            picture=lambda form: figure_bytes(result_figure(results, screen.quantity, limits, units), form),
            rows=lambda: study_rows(results, screen.reading),
            sections=lambda: {"curve": ("Results over one input", answer_blocks(table, units))},
        )


def _effects(screen: Screen) -> Content:
    """Tabulate the effect of one percent of each number, and of the tolerances, unless its presses take seconds."""
    try:
        if effects_are_slow(screen.file):
            ratio = float(screen.file.joint.thickness_ratio)
            return [sentence(f"Too slow here at R2/L = {ratio:.3g}: the report of Contact has it.")]
        effects = effects_of(screen.file, screen.asked.tolerances)
    except ValueError as error:
        return alert(str(error))
    if effects is None:
        return [sentence("Computed for loads above 0 along the axis of the cup.")]
    blocks = (answer_blocks(table, screen.reading.units) for table in uncertainty_tables(effects))
    return [block for table in blocks for block in table]


def result_chart(results: Any, screen: Screen) -> Block:
    """Draw a result over one parameter, with a point at the present design; red where a limit is exceeded."""
    reading, axis, quantity = screen.reading, QUANTITIES[screen.across.name], QUANTITIES[screen.quantity]
    x, y = (results[part.name].values * reading.unit(part).factor for part in (axis, quantity))
    if numpy.isnan(y).all():
        raise ValueError(f"{results.attrs['model']} has no result over this input: choose another model")
    here = present_value(screen.file, axis.name) * reading.unit(axis).factor
    value = float(numpy.interp(here, x, y, left=numpy.nan, right=numpy.nan))
    mark = (here, value) if numpy.isfinite(value) else None
    curves = {quantity.title: Curve(x, y, LineStyle(INK), results.valid.values, mark)}
    for limit in (limit for limit in screen.limits if limit.name == quantity.name):
        for end in filter(numpy.isfinite, (limit.low, limit.high)):
            level = numpy.full(2, end * reading.unit(quantity).factor)
            curves[limit_text(limit, reading)] = Curve(x[[0, -1]], level, _LIMIT)
    exceeded = spans(x, verdicts(results, limits_of(screen)).values == int(Verdict.EXCEEDED))
    label = f"{reading.label(quantity)} over {reading.label(axis)}, by the model {results.attrs['model']}"
    top = axis_end(1.05 * max(float(numpy.nanmax(curve.y)) for curve in curves.values()))
    labels, ends = (reading.label(axis), reading.label(quantity)), (float(x[-1]), top)
    red = ["", "red: a limit is exceeded"] if exceeded else []
    drawn = chart(label, *labels, curves, ends, flagged=exceeded, start=float(x[0]), caption=red)
    return charts(drawn, legend=["● this design"])
