"""Figures and tables of studies show what was asked, in the units beside their numbers."""

import re
from math import degrees

import pytest

import ballsocket as bs
from ballsocket.reports import study_plots
from ballsocket.reports.study_tables import print_optimum, print_study
from ballsocket.studies.design import Span, grid, sample
from ballsocket.studies.distributions import tolerance
from ballsocket.studies.limits import Limit
from ballsocket.studies.optimisation import optimise

HIP = bs.joints["hess-forsbach"]


def test_a_map_says_what_it_shows_and_names_its_limits():
    spans = {"ball_radius": Span(11.0, 23.0, 9), "liner_thickness": Span(3.0, 15.0, 9)}
    space = bs.study(bs.HessForsbach(), HIP, **spans, force=3000.0)
    limits = (Limit(name="outer_radius", high=26.0), Limit(name="liner_thickness", low=4.0, high=12.0))
    figure = study_plots.design_map(space, limits, best={"ball_radius": 19.6, "liner_thickness": 6.3})
    titles = ["largest pressure pmax [MPa]", "contact area A [mm²]", "half angle ε [°]"]
    assert [axes.get_title() for axes in figure.axes] == titles
    assert figure.get_suptitle() == "hess-forsbach; normal force = 3000 N; model hess-forsbach"
    shown = {text.get_text() for text in figure.axes[0].texts}
    assert {"outer radius ≤ 26 mm", "liner thickness ≥ 4 mm", "liner thickness ≤ 12 mm"} <= shown
    (alone,) = study_plots.design_map(space, limits, ["max_pressure"]).axes
    assert alone.get_title() == titles[0]
    with pytest.raises(ValueError, match="bands need samples"):
        study_plots.band_figure(space)


def test_axes_are_drawn_in_the_unit_that_they_name():
    """An indentation of 0.02 to 0.06 mm runs from 20 to 60 µm, and so do its bands, its limits and the best point."""
    space = bs.study(bs.HessForsbach(), HIP, ball_radius=Span(11.0, 23.0, 9), indentation=Span(0.02, 0.06, 9))
    limits = (Limit(name="indentation", high=0.05),)
    figure = study_plots.design_map(space, limits, best={"ball_radius": 16.0, "indentation": 0.04})
    for axes in figure.axes:
        assert axes.get_ylabel() == "indentation d [µm]"
        assert axes.get_ylim() == pytest.approx((20.0, 60.0))
        assert axes.lines[0].get_xydata()[0] == pytest.approx((16.0, 40.0))
    scattered = sample(64, clearance=tolerance(0.1, 0.05)) * grid(indentation=Span(0.02, 0.06, 5))
    study = bs.study(bs.HessForsbach(), HIP, scattered)
    bands = study_plots.band_figure(study).axes[0]
    assert bands.get_xlabel() == "indentation d [µm]"
    assert bands.lines[0].get_xdata()[-1] == pytest.approx(60.0)
    assert "median" in bands.get_legend_handles_labels()[1]
    with pytest.raises(ValueError, match="a map needs two axes"):
        study_plots.design_map(study.isel(indentation=0))


def test_a_study_is_told_in_micrometres_and_degrees(capsys):
    found = bs.study(bs.HessForsbach(), bs.joints["hip-28"], force=[1000.0, 3000.0])
    print_study(found)
    rows = {line.split()[0]: line.split() for line in capsys.readouterr().out.splitlines() if line.strip()}
    deepest = bs.HessForsbach().press(bs.joints["hip-28"], force=3000.0)
    assert rows["indentation"][1] == "µm"
    assert float(rows["indentation"][4]) == pytest.approx(1e3 * deepest.indentation, rel=1e-3)
    assert rows["half_angle"][1] == "°"
    assert float(rows["half_angle"][4]) == pytest.approx(degrees(deepest.half_angle), rel=1e-3)


def test_a_slope_is_told_in_the_units_of_its_numbers(capsys):
    """Micrometres of indentation per mm of thickness, when micrometres stand above them."""
    thickness, load = {"liner_thickness": (4.0, 8.0)}, {"force": 3000.0}
    best = optimise(bs.HessForsbach(), bs.joints["hip-28"], thickness, load=load, minimise="indentation")
    print_optimum(best)
    told = capsys.readouterr().out
    assert re.search(rf"^indentation {1e3 * best.value:.4g} µm$", told, flags=re.MULTILINE)
    assert f"{1e3 * best.slopes['liner_thickness']:.4g}" in told
