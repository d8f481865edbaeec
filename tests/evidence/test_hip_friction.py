"""Friction of walking patients: the page of the comparison has the numbers that are computed today."""

from runpy import run_path
from types import SimpleNamespace

import pytest

from ..extent import some
from ..places import ROOT
from ..printed import with_numbers_of

validation = SimpleNamespace(**run_path(str(ROOT / "docs" / "make_hip_validation.py"), run_name="make_hip_validation"))


def page_column(label):
    """Texts of a column of the table of friction on the page, from top to bottom."""
    part = validation.PAGE.read_text(encoding="utf-8").split("% friction begin")[1].split("% friction end")[0]
    head, _, *rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in part.strip().splitlines()]
    return [row[head.index(label)] for row in rows]


@pytest.mark.parametrize("label", some(list(validation.LUBRICANTS)[::-1], 1))
def test_page_has_the_computed_friction(label):
    column, computed = page_column(label), validation.friction_column(label)
    assert [with_numbers_of(*texts) for texts in zip(column, computed, strict=True)] == column


def test_page_says_which_measurements_are_missed():
    """The rise of the coefficient to toe-off and the mean power are too small, with every lubricant."""
    numbers = [[float(text.split()[0]) for text in page_column(label)] for label in validation.LUBRICANTS]
    measured = [float(text.split()[0]) for text in page_column("measured")]
    for _, moment, toe_off, _, swing, power in numbers:
        assert moment < measured[1]
        assert swing / toe_off < 0.6 * measured[4] / measured[2]
        assert power < measured[5]
