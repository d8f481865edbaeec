"""Description of the films of a contact by several models."""

from __future__ import annotations

from collections.abc import Sequence

import numpy

from ..core.answers import Answer, Column, Row, Table
from ..core.kinds import NANOMETRES, PERCENT, Unit
from ..core.unit_systems import Amount, Sentence
from .film import FilmResult

_COLUMNS = (
    Column.of_words("model"),
    Column.of_words("method"),
    Column(key="central_nm", name="central_nm", head="central", unit=NANOMETRES, written=NANOMETRES),
    Column(key="minimum_nm", name="minimum_nm", head="minimum", unit=NANOMETRES, written=NANOMETRES),
    Column.of_number("lambda", "λ", digits=3),
    Column.of_number("error", unit=PERCENT, digits=2),
    Column.of_words("valid"),
)


def describe_films(films: Sequence[FilmResult]) -> Answer:
    """Describe the films of one joint, one for each model."""
    first = films[0]
    motion = (Amount(float(numpy.linalg.norm(first.spin)), Unit("rad/s")), Amount(first.speed, Unit("mm/s"), 3))
    viscosity = Amount(first.lubricant.viscosity, Unit("mPa s", 1e3))
    rows = [
        Row([one.contact.model.name, one.method, one.central, one.minimum, one.ratio, one.error, one.valid])
        for one in films
    ]
    return Answer(
        title=str(first.contact.joint),
        lines=[Sentence("film at {}, {}, viscosity {}", *motion, viscosity)],
        tables=[Table("film", "Film", _COLUMNS, rows, ["λ minimum film over the combined roughness of both surfaces"])],
        notes=[Sentence("{}: {}", one.contact.model.name, note) for one in films for note in one.notes],
    )
