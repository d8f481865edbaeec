"""Description of a fitted wear coefficient: its band, its value for each kind of rate, and the measured wear."""

from __future__ import annotations

from math import isfinite

from ..core.answers import Answer, Cell, Column, Row, Table
from ..core.display import counted
from ..core.kinds import Unit
from ..core.unit_systems import Amount, Sentence
from .wear_fit import WearFit


def describe_wear_fit(fit: WearFit) -> Answer:
    """Describe a fitted wear coefficient."""
    use = fit.simulation
    law = str(getattr(use.wear, "name", type(use.wear).__name__))
    title, unit = "{}; {}: coefficient of the wear law {}", Unit(fit.unit)
    columns = [Column.of_words("coefficient"), Column.of_number("best", unit=unit)]
    columns += [Column.of_number("band", "95 %", unit)]
    rows = [Row(["coefficient", fit.coefficient, (fit.low, fit.high) if isfinite(fit.high) else None])]
    if len(fit.stations) > 1:
        rows += [Row([station, coefficient, None]) for station, coefficient in fit.stations.items()]
    tables = [Table("coefficient", "Coefficient", columns, rows)]
    if fit.readings:
        heads = [Column.of_words("rate", "the same as another rate"), Column.of_number("coefficient", unit=unit)]
        tables.append(Table("readings", "Rates of other kinds", heads, list(map(Row, fit.readings.items()))))
    return Answer(
        title=Sentence(title, str(use.joint), use.cycle.name, repr(law)),
        tables=[*tables, _measured(fit)],
        notes=fit.notes,
    )


def _measured(fit: WearFit) -> Table:
    several = len(fit.specimens) > 1
    columns = [Column.of_words("measured"), Column.of_number("value"), Column.of_number("fit")]
    columns += [Column.of_words("station")] if several else []
    stations = {int(row): station for station, indices in fit.specimens.items() for row in indices}
    rows: list[Row] = []
    for measured, results in zip(fit.data, fit.results, strict=True):
        factor = measured.density or 1.0
        unit = Unit(measured.unit if measured.density is None else measured.unit.replace("mm³", "mg"), factor)
        for number, (value, result) in enumerate(zip(measured.values, results, strict=True)):
            after = "" if measured.rate else f" after {counted(measured.cycles[number], 'cycle')}"
            title = measured.description if measured.rate else f"{measured.measured_quantity}{after}"
            cells: list[Cell] = [title, Amount(float(value), unit), Amount(float(result), unit)]
            rows.append(Row([*cells, stations[len(rows)]] if several else cells))
    return Table("measured", "Measured wear", columns, rows)
