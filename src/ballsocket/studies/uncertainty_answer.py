"""Description of the surroundings of a contact: elasticities, and bands from the tolerances."""

from __future__ import annotations

from ..core.answers import Column, Row, Table
from ..core.quantities import QUANTITIES
from .derivatives import LocalUncertainty
from .extremes import amount_of
from .sensitivity_answer import rounded


def uncertainty_tables(surroundings: LocalUncertainty) -> list[Table]:
    """List the elasticities of a contact, and its bands."""
    names = list(next(iter(surroundings.changes.values())))
    heads = [Column.of_words("quantity", "change in % if 1 % is added to the")]
    heads += [Column.of_number(name, QUANTITIES[name].title, digits=3) for name in names]
    changes = [
        Row([QUANTITIES[name].title, *(rounded(slopes[parameter]) for parameter in names)])
        for name, slopes in surroundings.changes.items()
    ]
    ends = (
        Column.of_words("quantity", "95 % band from the tolerances"),
        *map(Column.of_number, ("low", "median", "high")),
    )
    bands = [
        Row([QUANTITIES[name].title, *(amount_of(name, end) for end in band)])
        for name, band in surroundings.band.items()
    ]
    method = f"From {surroundings.presses} presses by {surroundings.model}: a quadratic of each tolerance."
    lines = [] if bands else ["No tolerances are stated."]
    return [
        Table("elasticities", "Elasticities", heads, changes),
        Table("bands", "Bands", ends, bands, [method] if surroundings.presses else lines),
    ]
