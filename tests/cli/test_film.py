"""Command `film`: table, JSON and figure."""

import json

import pytest

from ..places import EXAMPLES
from .command import run

HIP = ("film", f"{EXAMPLES / 'hip.toml'}", "--force", "1500 N")


def results(*words):
    """Results of the command in JSON."""
    done = run(*words, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["results"]


def test_json_has_an_entry_for_each_model():
    springs, exact = results(*HIP, "--model", "hess-forsbach", "--model", "exact", "--viscosity", "2.5 mPa s")
    for result in (springs, exact):
        names = {"model", "method", "central_nm", "minimum_nm", "lambda", "error", "valid", "notes"}
        assert names <= set(result)
        assert result["valid"] is True
    assert springs["central_nm"] == pytest.approx(191.3, abs=1.0)
    assert exact["central_nm"] == pytest.approx(160.4, abs=1.5)


def test_rates_have_units_and_an_axis():
    (fast,) = results(*HIP, "--spin", "180 deg/s", "--method", "Inlet")
    assert fast["method"] == "inlet"
    assert fast["spin_rad_per_s"] == pytest.approx([3.14159, 0.0, 0.0], abs=1e-4)
    (turned,) = results(*HIP, "--spin", "1.5", "--spin-axis", "0,2,0", "--method", "inlet")
    assert turned["spin_rad_per_s"] == pytest.approx([0.0, 1.5, 0.0])
    (about_load,) = results(*HIP, "--spin-axis", "0,0,1")
    assert about_load["central_nm"] == 0.0
    assert about_load["valid"] is False


@pytest.mark.long
def test_a_tilted_load_turns_the_ball_across_it():
    (tilted,) = results(*HIP, "--tilt", "30 deg")
    assert tilted["model"] == "sphere"
    (axial,) = results(*HIP, "--model", "exact")
    assert tilted["central_nm"] == pytest.approx(axial["central_nm"], rel=0.05)


@pytest.mark.long
def test_figure_is_written(tmp_path):
    target = tmp_path / "film.svg"
    assert run(*HIP, "--figure", str(target)).returncode == 0
    assert "film thickness" in target.read_text("utf-8")
