"""`ballsocket film` and `ballsocket identify`: JSON, rates, figures."""

import pytest

from ..places import EXAMPLES
from .command import answer, printed


@pytest.mark.long
def test_the_command_writes_figures_and_samples(tmp_path):
    pytest.importorskip("emcee")
    pictures = ("--figure", "fit.png", "--corner", "corner.png", "--experiment", "next.png")
    words = ("identify", str(EXAMPLES / "measured_joint.toml"), "--samples", "200", *pictures)
    assert "R-hat 1.0" in printed(*words, folder=tmp_path)
    assert all((tmp_path / name).stat().st_size > 10_000 for name in pictures[1::2])


FILM = ("film", f"{EXAMPLES / 'hip.toml'}", "--force", "1500 N")


def test_rates_have_units_and_an_axis():
    (fast,) = answer(*FILM, "--spin", "180 deg/s", "--method", "Inlet")["results"]
    assert fast["method"] == "inlet"
    assert fast["spin_rad_per_s"] == pytest.approx([3.14159, 0.0, 0.0], abs=1e-4)
    (turned,) = answer(*FILM, "--spin", "1.5", "--spin-axis", "0,2,0", "--method", "inlet")["results"]
    assert turned["spin_rad_per_s"] == pytest.approx([0.0, 1.5, 0.0])
    (about_load,) = answer(*FILM, "--spin-axis", "0,0,1")["results"]
    assert (about_load["central_nm"], about_load["valid"]) == (0.0, False)


@pytest.mark.long
def test_a_tilted_load_turns_the_ball_across_it_and_a_film_is_drawn(tmp_path):
    (tilted,) = answer(*FILM, "--tilt", "30 deg")["results"]
    (axial,) = answer(*FILM, "--model", "exact", "--figure", str(tmp_path / "film.svg"))["results"]
    assert tilted["model"] == "sphere"
    assert tilted["central_nm"] == pytest.approx(axial["central_nm"], rel=0.05)
    assert "film thickness" in (tmp_path / "film.svg").read_text("utf-8")
