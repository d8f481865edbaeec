"""Systems of units, and studies: figures, tables and sentences in the units that stand beside their numbers."""

import json
import pickle
from pathlib import Path

import pytest

import ballsocket as bs
from ballsocket.core import kinds
from ballsocket.core.unit_systems import Amount, Sentence, Units, from_json, to_json
from ballsocket.reports import study_plots
from ballsocket.studies.calibration import describe_calibration
from ballsocket.studies.design import Span, grid, sample
from ballsocket.studies.distributions import tolerance
from ballsocket.studies.limits import Limit

from ..cli.command import printed
from ..refusals import text_tables

(ROWS,) = text_tables(Path(__file__).parent / "amounts.txt")
AMOUNTS = [(Amount(float(value), getattr(kinds, name)), *texts) for value, name, *texts in ROWS]
AMOUNTS.append((Amount(2e3, kinds.Unit("kN", 1e-3)), "2 kN", "449.6 lbf"))


@pytest.mark.parametrize(("amount", "metric", "imperial"), AMOUNTS)
def test_amounts_of_a_sentence_are_written_in_the_units_of_the_reader(amount, metric, imperial):
    """Texts and names stay, whatever numbers they have; a sentence in another one keeps its amounts."""
    inner = Sentence("at most {} of {}", amount, "the {} 3 mm liner")
    sentence = Sentence("2 kN: {}!", inner)
    assert sentence == f"2 kN: at most {metric} of the {{}} 3 mm liner!"
    assert Units.SI.sentence(sentence) == sentence
    assert Units.IMPERIAL.sentence(sentence) == f"2 kN: at most {imperial} of the {{}} 3 mm liner!"
    for copy in (pickle.loads(pickle.dumps(sentence)), from_json(json.loads(json.dumps(to_json(sentence))))):
        assert [copy, Units.IMPERIAL.sentence(copy)] == [sentence, Units.IMPERIAL.sentence(sentence)]
    assert [Units.IMPERIAL.sentence(inner.upper()), from_json(to_json("3 mm"))] == [inner.upper(), "3 mm"]


def test_the_name_of_a_joint_stays_and_so_do_sources_of_presets():
    joint = bs.joints["hip-36"].replace(name="36 mm, 3 kN")
    assert Units.IMPERIAL.sentence(str(joint)).startswith("36 mm, 3 kN: R1 0.7087 in")
    title = describe_calibration(bs.calibrate(joint)).title
    assert Units.IMPERIAL.sentence(title) == Units.IMPERIAL.sentence(str(joint))
    text = " ".join(printed("presets", "bone-cement", "--units", "imperial").split())
    assert "representative of PMMA, 2-2.5 GPa" in text
    assert "MPa" not in text


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
    (alone,) = study_plots.design_map(space, limits, ["max_pressure"], units=Units.IMPERIAL).axes
    assert alone.get_title() == "largest pressure pmax [psi]"
    assert "outer radius ≤ 1.02362 in" in {text.get_text() for text in alone.texts}
    assert "; normal force = 674.4 lbf; radial clearance = 0.003937 in; " in alone.figure.get_suptitle()
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
    inches = study_plots.band_figure(study, units=Units.IMPERIAL).axes[0].xaxis
    ticks = inches.get_major_locator().tick_values(20.0, 60.0) / 25.4  # 0.8 to 2.4 mil, at round numbers
    assert inches.get_label_text() == "indentation d [mil]"
    assert [float(inches.get_major_formatter()(25.4 * tick)) for tick in ticks] == pytest.approx(ticks, rel=1e-9)
    with pytest.raises(ValueError, match="a map needs two axes"):
        study_plots.design_map(study.isel(indentation=0))
