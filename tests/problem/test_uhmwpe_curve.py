"""Limits of the UHMWPE preset and secant moduli of the pages, compared with a published curve."""

import re
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs

from .three_network import compressed_bar

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "materials.md"
STRAIN, STRESS = compressed_bar(rate=0.007)
INITIAL = STRESS[9] / STRAIN[9]


def _secant(stress):
    return np.interp(stress, STRESS, STRESS / STRAIN)


def test_the_secant_modulus_leaves_the_initial_one_at_the_proportional_limit():
    limit = bs.UHMWPE.proportional_limit
    assert _secant(limit) / INITIAL == pytest.approx(0.99, abs=0.005)
    assert _secant(limit - 1.0) / INITIAL > 0.995
    assert _secant(limit + 1.5) / INITIAL < 0.93


def test_the_offset_yield_and_the_stress_at_four_percent_are_those_that_the_page_states():
    offset = STRESS[np.argmax(STRESS < INITIAL * (STRAIN - 0.002))]
    assert offset == pytest.approx(10.6, abs=0.1)
    assert np.interp(0.04, STRAIN, STRESS) == pytest.approx(20.2, abs=0.1)
    assert pytest.approx(1510, abs=5) == INITIAL
    text = PAGE.read_text(encoding="utf-8")
    assert "10.6 MPa" in text
    assert "20.2 MPa" in text


def test_the_secant_moduli_of_the_page_are_those_of_the_curve():
    text = PAGE.read_text(encoding="utf-8")
    stress, ratio = (
        np.array(re.search(rf"{name} = \[(.*)\]", text)[1].split(","), float) for name in ("STRESS", "RATIO")
    )
    assert ratio == pytest.approx(_secant(stress) / INITIAL, abs=0.006)
