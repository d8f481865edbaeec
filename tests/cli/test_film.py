"""Command `film`: JSON, rates and figure."""

import pytest

from ..places import EXAMPLES
from .command import answer

HIP = ("film", f"{EXAMPLES / 'hip.toml'}", "--force", "1500 N")


def test_json_has_an_entry_for_each_model():
    springs, exact = answer(*HIP, "--model", "hess-forsbach", "--model", "exact", "--viscosity", "2.5 mPa s")["results"]
    for result in (springs, exact):
        assert {"model", "method", "central_nm", "minimum_nm", "lambda", "error", "valid", "notes"} <= set(result)
        assert result["valid"] is True
    assert springs["central_nm"] == pytest.approx(191.3, abs=1.0)
    assert exact["central_nm"] == pytest.approx(160.4, abs=1.5)


def test_rates_have_units_and_an_axis():
    (fast,) = answer(*HIP, "--spin", "180 deg/s", "--method", "Inlet")["results"]
    assert fast["method"] == "inlet"
    assert fast["spin_rad_per_s"] == pytest.approx([3.14159, 0.0, 0.0], abs=1e-4)
    (turned,) = answer(*HIP, "--spin", "1.5", "--spin-axis", "0,2,0", "--method", "inlet")["results"]
    assert turned["spin_rad_per_s"] == pytest.approx([0.0, 1.5, 0.0])
    (about_load,) = answer(*HIP, "--spin-axis", "0,0,1")["results"]
    assert (about_load["central_nm"], about_load["valid"]) == (0.0, False)


@pytest.mark.long
def test_a_tilted_load_turns_the_ball_across_it_and_a_film_is_drawn(tmp_path):
    (tilted,) = answer(*HIP, "--tilt", "30 deg")["results"]
    (axial,) = answer(*HIP, "--model", "exact", "--figure", str(tmp_path / "film.svg"))["results"]
    assert tilted["model"] == "sphere"
    assert tilted["central_nm"] == pytest.approx(axial["central_nm"], rel=0.05)
    assert "film thickness" in (tmp_path / "film.svg").read_text("utf-8")
