"""Every door of a result says the same: terminal, page and data have the same numbers, in both systems of units."""

import re
from functools import cache
from html import unescape
from io import StringIO

import pint
import pytest

from ballsocket.core.answers import PAGE, named_records, records
from ballsocket.core.unit_systems import Amount, Units
from ballsocket.hip.bands_answer import describe_bands
from ballsocket.hip.comparison_answer import HipRun, describe_hips
from ballsocket.hip.history_answer import describe_history
from ballsocket.lubrication import Lubricant
from ballsocket.reports.pages import answer_lede, answer_sections
from ballsocket.reports.terminal import print_answer

from ..hip.hips import QUICK, hip
from ..hip.test_uncertainty import bands

WIDE = 2000
METRIC = re.compile(r"\d (?:mm|mm³|µm|nm|MPa|kN|N|N m)(?![\w/(])")
SYMBOLS = {
    "mm²": "mm**2",
    "mm³": "mm**3",
    "in²": "in**2",
    "in³": "in**3",
    "°": "deg",
    "µin": "microinch",
    "mil": "thou",
}
SYMBOLS |= {"million": "1", "": "1", "%": "1", "N m": "N*m", "lbf in": "lbf*in", "mm³/(N m)": "mm**3/(N*m)"}
COUNTS = {"million": 1e-6, "%": 100.0}


@cache
def history():
    return hip(**QUICK).after(2e4, [1e4], lubricant=Lubricant())


ANSWERS = {
    "wear of a hip": lambda: describe_history(history()),
    "bands of patients": lambda: describe_bands(bands()),
    "hips side by side": lambda: describe_hips(
        [HipRun(name="new", history=history()), HipRun(name="b", history=history())]
    ),
}
"""Descriptions of cheap results of every kind."""


@cache
def registry():
    return pint.UnitRegistry()


def converted(value, metric, shown):
    """Convert a number by pint, which is independent of the factors of the package."""
    metric, counted = SYMBOLS.get(metric, metric), COUNTS.get(shown, 1.0)
    return registry().Quantity(value, metric).to(SYMBOLS.get(shown, shown)).magnitude * counted


def numbers_in(line):
    return [float(number) for number in re.findall(r"(?<![\w.])-?\d+\.?\d*(?:e[-+]?\d+)?(?![\w.])", line)]


def contains(line, expected):
    """Check that a line has the expected numbers, in their order, to the digits that are printed."""
    found = iter(numbers_in(line))
    return all(any(number == approx for number in found) for approx in expected)


def expected_numbers(row, table, units, most_rank):
    """Return the numbers of a row as a reader of its data expects them in the unit that the door writes."""
    (keyed,) = records(table._replace(rows=[row]))
    for cell, column in zip(row.cells, table.columns, strict=True):
        if column.unit is None or column.rank > most_rank or isinstance(cell, str):
            continue
        value, metric, digits = keyed[column.key], column.written.text, column.digits
        shown = units.written(column.unit).text
        if isinstance(cell, Amount):
            value, metric, digits = cell.value * cell.unit.factor, cell.unit.text, cell.digits
            shown = units.amount(cell).rpartition(" ")[2] if cell.unit.text else ""
        for end in value if isinstance(value, list) else [value]:
            if end is not None and end == end:
                number = end if metric == shown else converted(end, metric, shown)
                yield pytest.approx(number, rel=0.6 * 10 ** (1 - digits), abs=1e-12)


def printed(answer, units):
    terminal = StringIO()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", str(WIDE))
        patch.setattr("sys.stdout", terminal)
        print_answer(answer, units)
    page = "".join(html for _, html in answer_sections(answer, units).values()) + answer_lede(answer, units)
    rows = re.findall(r"<(?:tr|p|li)>(.*?)</(?:tr|p|li)>", page, re.S)
    return terminal.getvalue().splitlines(), [unescape(re.sub(r"<[^>]+>", " ", row)) for row in rows]


@pytest.mark.parametrize("units", Units)
@pytest.mark.parametrize("name", ANSWERS)
def test_every_door_has_the_same_numbers_and_sentences(name, units):
    answer = ANSWERS[name]()
    terminal, page = printed(answer, units)
    for table in answer.tables:
        assert [[*row.values()] for row in records(table)] == [[*row.values()] for row in named_records(table)]
        for lines, most_rank in ((terminal, PAGE - 1), (page, PAGE)):
            for row in table.rows:
                expected = list(expected_numbers(row, table, units, most_rank))
                assert row.rank > most_rank or any(contains(line, expected) for line in lines), (table.key, expected)
    sentences = [*answer.lines, *(line for table in answer.tables for line in table.lines), *answer.notes]
    for lines in (terminal, page):
        folded = " ".join(" ".join(lines).split())
        assert all(" ".join(units.sentence(sentence).split()) in folded for sentence in sentences)
        assert units is Units.SI or not METRIC.search(folded), METRIC.search(folded)
