"""Studies in a terminal have the units that stand beside their numbers."""

import re
from math import degrees

import pytest

import ballsocket as bs
from ballsocket.reports.study_tables import print_optimum, print_study
from ballsocket.studies.optimisation import optimise

HIP = bs.joints["hip-28"]


def test_a_study_is_told_in_micrometres_and_degrees(capsys):
    found = bs.study(bs.HessForsbach(), HIP, force=[1000.0, 3000.0])
    print_study(found)
    rows = {line.split()[0]: line.split() for line in capsys.readouterr().out.splitlines() if line.strip()}
    deepest = bs.HessForsbach().press(HIP, force=3000.0)
    assert rows["indentation"][1] == "µm"
    assert float(rows["indentation"][4]) == pytest.approx(1e3 * deepest.indentation, rel=1e-3)
    assert rows["half_angle"][1] == "°"
    assert float(rows["half_angle"][4]) == pytest.approx(degrees(deepest.half_angle), rel=1e-3)


def test_a_slope_is_told_in_the_units_of_its_numbers(capsys):
    """Micrometres of indentation per mm of thickness, when micrometres stand above them."""
    best = optimise(
        bs.HessForsbach(), HIP, {"liner_thickness": (4.0, 8.0)}, load={"force": 3000.0}, minimise="indentation"
    )
    print_optimum(best)
    told = capsys.readouterr().out
    assert re.search(rf"^indentation {1e3 * best.value:.4g} µm$", told, flags=re.MULTILINE)
    assert f"{1e3 * best.slopes['liner_thickness']:.4g}" in told
