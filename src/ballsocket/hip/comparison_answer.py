"""Description of several hips side by side: wear at each report, validity, and the notes of each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ..core.answers import Answer, Cell, Column, Row, Table
from ..core.kinds import PERCENT
from ..core.quantities import QUANTITIES
from ..core.unit_systems import Amount, Sentence, joint_sentence
from .bands import Bands
from .history import History

_RESULTS = ("volume", "depth", "penetration", "max_pressure")
_BANDED = ("volume", "penetration")


@dataclass(frozen=True, kw_only=True)
class HipRun:
    """Simulation of one hip with its bands, if any, and its name in tables and figures, such as that of its file."""

    name: str
    history: History
    bands: Bands | None = None


def describe_hips(runs: Sequence[HipRun]) -> Answer:
    """Describe several hips: one below the other at each report."""
    joints = (Sentence("{}: {}; {}", run.name, joint_sentence(run.history.use.joint), _cycle(run)) for run in runs)
    return Answer(title="hips side by side", lines=list(joints), tables=[_table(runs)], notes=list(_notes(runs)))


def _cycle(run: HipRun) -> str:
    return run.history.use.cycle.name


def _table(runs: Sequence[HipRun]) -> Table:
    columns = [Column.of(QUANTITIES["cycles"], digits=6), Column.of_words("hip")]
    columns += [Column.of(QUANTITIES[name]) for name in _RESULTS] + [Column.of_words("edge_loading", "edge loading")]
    if any(run.bands is not None for run in runs):
        columns += [Column.of(QUANTITIES[name], head=f"{name} 95 %", digits=3) for name in _BANDED]
    rows = []
    for cycles in sorted({report.cycles for run in runs for report in run.history.reports}):
        for run in runs:
            for number, report in enumerate(run.history.reports):
                if report.cycles == cycles:
                    cells: list[Cell] = [cycles, run.name, *(float(getattr(report, name)) for name in _RESULTS)]
                    cells += [bool(report.edge_loaded.any()), *(_band(run, name, number) for name in _BANDED)]
                    rows.append(Row(cells[: len(columns)]))
    return Table("hips", "Wear", columns, rows, list(_lines(runs)))


def _band(run: HipRun, name: str, report: int) -> Cell:
    return None if run.bands is None else tuple(float(end[report]) for end in run.bands.band(name))


def _lines(runs: Sequence[HipRun]) -> Iterator[Sentence]:
    for run in runs:
        validity = "valid" if run.history.valid else "NOT VALID, see its notes"
        error = Amount(run.history.error.volume, PERCENT, 2)
        yield Sentence("{}: contact {}; estimated numerical error of the volume {}", run.name, validity, error)


def _notes(runs: Sequence[HipRun]) -> Iterator[Sentence]:
    """Yield the notes of all hips, each with the names of the hips that have it, unless all have it."""
    holders: dict[str, list[str]] = {}
    for run in runs:
        for note in dict.fromkeys((*run.history.notes, *(run.bands.notes if run.bands else ()))):
            holders.setdefault(note, []).append(run.name)
    for note, names in holders.items():
        written = note if isinstance(note, Sentence) else Sentence(note)
        yield written if len(names) == len(runs) else Sentence("{}: {}", ", ".join(names), written)
