"""`ballsocket film` and `ballsocket identify`: JSON, rates, figures."""

import numpy as np
import pytest

import ballsocket as bs

from ..joints import HIP
from ..places import EXAMPLES
from .command import answer, printed

FORCE = np.array([250.0, 500.0, 1000.0, 1500.0, 2000.0, 3000.0])
CONTACT = bs.HessForsbach().press(HIP, force=FORCE)
COLUMNS = {"indentation": "indentation_mm", "area": "area_mm2"}
QUESTION = """
model = "hess-forsbach"
joint = "joint.toml"
[free]
clearance = "0.02..0.3 mm"
liner.young = "0.4..2 GPa"
[[data]]
file = "{name}.csv"
uncertainty = "2 %"
"""


@pytest.fixture
def folder(tmp_path):
    for name, column in COLUMNS.items():
        rows = "\n".join(f"{force:g},{value:.8g}" for force, value in zip(FORCE, getattr(CONTACT, name), strict=True))
        (tmp_path / f"{name}.csv").write_text(f"# synthetic\nforce_N,{column}\n{rows}\n", "utf-8")
        (tmp_path / f"{name}.toml").write_text(QUESTION.format(name=name), "utf-8")
    liner = f'[liner]\nyoung = "{HIP.liner.young} MPa"\npoisson = {HIP.liner.poisson}\n'
    lengths = "".join(f"{name} = {getattr(HIP, name)}\n" for name in ("ball_radius", "clearance", "liner_thickness"))
    (tmp_path / "joint.toml").write_text(f"[joint]\n{lengths}{liner}", "utf-8")
    return tmp_path


def test_an_identifiable_unknown_has_a_value_and_a_band(folder):
    said = answer("identify", "indentation.toml", folder=folder)
    values = {each["name"]: each["value"] for each in said["estimates"]}
    assert values == pytest.approx({"clearance": HIP.clearance, "liner_young": HIP.liner.young}, rel=1e-4)
    assert all(each["low"] < each["value"] < each["high"] for each in said["estimates"])
    assert said["valid"] is True
    assert said["information"]["rank"] == 2
    assert said["experiment"][0]["bits"] > 0


def test_areas_alone_identify_only_the_product(folder):
    said = answer("identify", "area.toml", folder=folder)
    assert said["valid"] is False
    assert said["products"][0]["value"] == pytest.approx(HIP.clearance * HIP.liner.young, rel=1e-2)


@pytest.mark.long
def test_the_command_writes_figures_and_samples(folder):
    pytest.importorskip("emcee")
    pictures = ("--figure", "fit.png", "--corner", "corner.png", "--experiment", "next.png")
    assert "R-hat 1.0" in printed("identify", "indentation.toml", "--samples", "200", *pictures, folder=folder)
    assert all((folder / name).stat().st_size > 10_000 for name in pictures[1::2])


FILM = ("film", f"{EXAMPLES / 'hip.toml'}", "--force", "1500 N")


def test_json_has_an_entry_for_each_model():
    models = ("--model", "hess-forsbach", "--model", "exact")
    springs, exact = answer(*FILM, *models, "--viscosity", "2.5 mPa s")["results"]
    for result in (springs, exact):
        assert {"model", "method", "central_nm", "minimum_nm", "lambda", "error", "valid", "notes"} <= set(result)
        assert result["valid"] is True
    assert springs["central_nm"] == pytest.approx(191.3, abs=1.0)
    assert exact["central_nm"] == pytest.approx(160.4, abs=1.5)


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
