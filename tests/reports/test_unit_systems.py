"""Systems of units, and studies: figures, tables and sentences in the units that stand beside their numbers."""

import re

import pytest

import ballsocket as bs
from ballsocket.core.unit_systems import Sentence, Units
from ballsocket.reports import study_plots
from ballsocket.studies.calibration import describe_calibration
from ballsocket.studies.design import Span, grid, sample
from ballsocket.studies.distributions import tolerance
from ballsocket.studies.limits import Limit

from ..cli.command import printed

METRIC = r"\d (?:mm|µm|MPa|kN|N)\b|\[(?:mm|MPa|µm|N)\]"


@pytest.mark.parametrize(
    ("metric", "imperial"),
    [
        ("25.4 mm from the rim", "1 in from the rim"),
        ("1 to 2 kN, or 4.4482216 N", "224.8 to 449.6 lbf, or 1 lbf"),
        ("E 750 MPa, p 1 MPa", "E 108.8 ksi, p 145 psi"),
        ("25.4 µm, Ra 0.0254 µm, 25.4 nm", "1 mil, Ra 1 µin, 1 µin"),
        ("16387.064 mm³ after 2 million cycles, 1 N m", "1 in³ after 2 million cycles, 8.851 lbf in"),
        ("inf mm of a liner, 645.16 mm²", "inf in of a liner, 1 in²"),
        ("R2/L ≥ 1 at 40°, 3 m, 5 Nm, v1.2 mmx", "R2/L ≥ 1 at 40°, 3 m, 5 Nm, v1.2 mmx"),
    ],
)
def test_numbers_with_units_in_a_sentence_are_converted(metric, imperial):
    assert Units.IMPERIAL.sentence(metric) == imperial
    assert Units.SI.sentence(metric) == metric


def test_the_name_of_a_joint_stays_and_so_do_sources_of_presets():
    joint = bs.joints["hip-36"].replace(name="36 mm, 3 kN")
    assert Units.IMPERIAL.sentence(str(joint)).startswith("36 mm, 3 kN: R1 0.7087 in")
    assert Units.IMPERIAL.sentence(Sentence(str(joint))) == Units.IMPERIAL.sentence(str(joint))
    title = describe_calibration(bs.calibrate(joint)).title
    assert Units.IMPERIAL.sentence(title) == Units.IMPERIAL.sentence(str(joint))
    text = " ".join(printed("presets", "bone-cement", "--units", "imperial").split())
    assert "representative of PMMA, 2-2.5 GPa" in text
    assert "MPa" not in text


@pytest.mark.long
def test_orientations_print_and_draw_in_inches_and_pounds(tmp_path):
    angles = ("--inclination", "40..50", "--anteversion", "10..20", "--step", "10 deg", "--ring-width", "6 deg")
    limit = ("--limit", "max_pressure<=10 MPa", "--figure", "orient.svg")
    text = printed("orient", "hip-36", "--force", "2 kN", *angles, *limit, "--units", "imperial", folder=tmp_path)
    assert re.findall(METRIC, text) == []
    assert "limit: max_pressure <= 1450.38 psi" in text
    assert (tmp_path / "orient.svg").stat().st_size > 1000


PAPER_HIP = bs.joints["hess-forsbach"]


def test_a_map_says_what_it_shows_and_names_its_limits():
    spans = {"ball_radius": Span(11.0, 23.0, 9), "liner_thickness": Span(3.0, 15.0, 9)}
    space = bs.study(bs.HessForsbach(), PAPER_HIP, **spans, force=3000.0)
    limits = (Limit(name="outer_radius", high=26.0), Limit(name="liner_thickness", low=4.0, high=12.0))
    figure = study_plots.design_map(space, limits, best={"ball_radius": 19.6, "liner_thickness": 6.3})
    titles = ["largest pressure pmax [MPa]", "contact area A [mm²]", "half angle ε [°]"]
    assert [axes.get_title() for axes in figure.axes] == titles
    title = "hess-forsbach; normal force = 3000 N; radial clearance = 0.1 mm; model hess-forsbach"
    assert figure.get_suptitle() == title
    shown = {text.get_text() for text in figure.axes[0].texts}
    assert {"outer radius ≤ 26 mm", "liner thickness ≥ 4 mm", "liner thickness ≤ 12 mm"} <= shown
    (alone,) = study_plots.design_map(space, limits, ["max_pressure"]).axes
    assert alone.get_title() == titles[0]
    with pytest.raises(ValueError, match="bands need samples"):
        study_plots.band_figure(space)


def test_axes_are_drawn_in_the_unit_that_they_name():
    """An indentation of 0.02 to 0.06 mm runs from 20 to 60 µm, and so do its bands, its limits and the best point."""
    space = bs.study(bs.HessForsbach(), PAPER_HIP, ball_radius=Span(11.0, 23.0, 9), indentation=Span(0.02, 0.06, 9))
    limits = (Limit(name="indentation", high=0.05),)
    figure = study_plots.design_map(space, limits, best={"ball_radius": 16.0, "indentation": 0.04})
    for axes in figure.axes:
        assert axes.get_ylabel() == "indentation d [µm]"
        assert axes.get_ylim() == pytest.approx((20.0, 60.0))
        assert axes.lines[0].get_xydata()[0] == pytest.approx((16.0, 40.0))
    scattered = sample(64, clearance=tolerance(0.1, 0.05)) * grid(indentation=Span(0.02, 0.06, 5))
    study = bs.study(bs.HessForsbach(), PAPER_HIP, scattered)
    bands = study_plots.band_figure(study).axes[0]
    assert bands.get_xlabel() == "indentation d [µm]"
    assert bands.lines[0].get_xdata()[-1] == pytest.approx(60.0)
    assert "median" in bands.get_legend_handles_labels()[1]
    with pytest.raises(ValueError, match="a map needs two axes"):
        study_plots.design_map(study.isel(indentation=0))
