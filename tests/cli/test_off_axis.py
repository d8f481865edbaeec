"""Tilted loads from the command line and from files."""

import json
import re

import numpy as np
import pytest

import ballsocket as bs

from ..joints import lined
from ..places import EXAMPLES
from .command import answer, run

NUMBERS = ("--ball-radius=17.9", "--clearance=0.1", "--liner-thickness=6.75", "--young=1GPa", "--poisson=0.4")
COARSE = ("--ring-width", "4 deg")


def answered(*words):
    return {result["model"]: result for result in answer("press", *words)["results"]}


def test_a_tilt_selects_the_model_sphere():
    sphere = answered(*NUMBERS, "--model", "sphere", "--tilt", "45", "--indentation", "0.04")["sphere"]
    lateral, across, axial = sphere["force_vector"]
    assert (lateral, axial) == pytest.approx((2101, 2134), rel=2e-3)
    assert across == pytest.approx(0, abs=1e-3)
    assert sphere["max_pressure_at_deg"][0] == pytest.approx(45, abs=0.5)
    assert (sphere["status"], sphere["edge_loaded"]) == ("OK", False)
    assert "sphere" in answered(*NUMBERS, *COARSE, "--tilt", "45 deg", "--force", "1kN")


def test_the_terminal_shows_the_position_of_the_contact_and_a_load_out_of_the_bore_gives_status_3():
    path = str(EXAMPLES / "tilted_hip.toml")
    ways = (), ("--tilt", "75"), ("--tilt", "75", "--chamfer", "1 mm")
    inside, over, dug = (run("press", path, *COARSE, *words, columns=200).stdout for words in ways)
    assert "sphere: load 36.5° from the cup's axis, contact 0.7 mm from the rim, largest pressure 37" in inside
    assert "° from the axis; rings of 4°, " in inside
    assert " s; error of the rings: d ±0.2 %, ε ±0.9 %, pmax ±0.2 %" in inside
    assert re.search(r"contact cut off by \d\.\d mm at the rim, largest pressure 8", over)
    assert "mm at the rim, pressure unbounded there; rings of 4°" in dug
    done = run("press", "hip-36", "--force", "3kN", "--tilt", "120", *COARSE)
    assert done.returncode == 3
    assert "dislocated" in done.stdout
    assert "120.0°" in done.stdout


@pytest.mark.long
def test_a_tilted_load_writes_figures_and_vtk_files(tmp_path):
    import meshio

    cup, vtk, both = (tmp_path / name for name in ("cup.svg", "cup.vtu", "both.svg"))
    run("press", "hip-36", "--force", "3kN", "--tilt", "45", *COARSE, "--figure", str(cup), "--vtk", str(vtk))
    assert "the cup seen from its opening" in cup.read_text("utf-8")
    assert "pressure" in meshio.read(vtk).cell_data
    models = ("--model", "refined", "--model", "sphere")  # where sphere does not lead, curves are compared
    run("press", "hip-36", "--force", "3kN", *COARSE, *models, "--figure", str(both))
    assert "normal force" in both.read_text("utf-8")


def test_orient_maps_edge_distance_and_pressure(tmp_path):
    path, figure = str(EXAMPLES / "tilted_hip.toml"), tmp_path / "map.svg"
    words = ("orient", path, *COARSE, "--points", "3", "--inclination", "30..60", "--figure", str(figure))
    words += ("--limit", "edge_distance>=2 mm")
    told = run(*words).stdout
    assert "furthest from the rim: 5." in told
    assert "mm at inclination 30°, anteversion 0°" in told
    assert "sphere: rings of 4°, 9 orientations in " in told
    assert "edge distance" in figure.read_text("utf-8")
    stood = answer(*words)
    assert stood["inclination_deg"] == pytest.approx([30, 45, 60])
    assert stood["anteversion_deg"] == pytest.approx([0, 15, 30])
    alone = answered(path, *COARSE)["sphere"]  # the file's cup is that of the middle
    assert stood["edge_distance"][1][1] == pytest.approx(alone["edge_distance"], abs=1e-4)
    assert stood["max_pressure"][1][1] == pytest.approx(alone["max_pressure"], rel=1e-6)
    assert stood["edge_loaded"][2][2] is True
    assert stood["within_limits"] == [[distance >= 2.0 for distance in row] for row in stood["edge_distance"]]


TIGHT = ("--ball-radius", "13.5", "--interference", "0.03", "--liner-thickness", "2.5", "--liner", "pom")
HELD = (*TIGHT, "--force", "0", *COARSE)


def test_a_preloaded_joint_without_a_load_is_at_rest_and_states_its_assumptions_and_the_wear_that_loosens_it():
    words = ("press", *TIGHT, *COARSE, "--friction", "0.1", "--static-friction", "0.15")
    printed, at_rest = run(*words, columns=200).stdout, answer(*words)
    for text in (
        "arc of cover 240° assumed for a preloaded joint; set arc_of_cover",
        "after 1000 hours under load it is 1300 MPa (Ticona 2008",
        "uniform wear of the bore by 0.03 mm ends the preload",
        "force 0 assumed, the ball is at rest in its socket; set force",
        "sphere: the contact reaches the rim, as is normal in a preloaded joint, so its stress has no known bound",
        "p, 0° to 120°",
    ):
        assert text in printed
    assert "edge loading" not in printed
    assert at_rest["preload"]["wear_depth_to_loosen"] == pytest.approx(0.03, rel=1e-3)
    assert at_rest["results"][0]["force"] == pytest.approx(0.0, abs=1.0)
    torques = at_rest["results"][0]["friction"]
    assert torques["breakaway_torque"] == pytest.approx(1.5 * torques["running_torque"])
    assert f"running torque {1e-3 * torques['running_torque']:.3g} N m about an axis across the load" in printed
    stated = run(*words, "--arc-of-cover", "260", "--young", "1300 MPa", columns=200).stdout
    assert "assumed for" not in stated
    assert "1000 hours" not in stated
    assert "clearance 0" in run("press", *TIGHT, "--interference", "0").stderr


@pytest.mark.long
def test_friction_of_several_models_stands_beside_each():
    words = ("hip-28", "--force", "1 kN", "--friction", "0.05")
    results = answer("press", *words)["results"]
    assert [result["model"] for result in results] == ["hess-forsbach", "exact"]
    contact = bs.HessForsbach().press(bs.joints["hip-28"], force=1000.0)
    assert results[0]["friction"]["running_torque"] == pytest.approx(contact.friction_torque(0.05))
    assert results[0]["friction"]["running_torque_about_load"] == pytest.approx(contact.friction_torque(0.05, 0.0))
    assert "breakaway torque the same" in run("press", *words, columns=200).stdout


@pytest.mark.long
def test_the_pull_out_force_is_printed_with_its_limits():
    words = ("press", *HELD, "--pull-out", "--friction", "0.1", "--arc-of-cover", "200")
    finished, pulled = run(*words, columns=200), answer(*words)["pull_out"]
    assert pulled["force"] > 0
    assert f"pull-out force {pulled['force']:.4g} N, {pulled['displacement']:.4g} mm" in finished.stdout
    assert "a housing that widens as a ring makes the force smaller" in finished.stdout
    wide = answer("press", *HELD, "--pull-out", "--arc-of-cover", "240")["pull_out"]
    assert wide["force"] is None
    assert "not computed" in wide["notes"][0]


def test_the_json_of_a_dislocated_ball_has_no_numbers():
    """An orientation adds the force in the body to the answer."""
    words = (*NUMBERS, *COARSE, "--arc-of-cover", "180 deg", "--tilt", "110 deg", "--force", "500 N")
    done = run("press", *words, "--model", "sphere", "--json")
    assert done.returncode == 3
    (sphere,) = [result for result in json.loads(done.stdout)["results"] if result["model"] == "sphere"]
    assert sphere["status"] == "DISLOCATED"
    assert sphere["force_vector_in_body"] == [None] * 3


@pytest.mark.parametrize(("gap", "size", "arc", "tilt"), [("clearance", 0.1, 180, 70), ("interference", 0.03, 240, 0)])
def test_a_curve_of_both_signs_has_the_forces_of_displacements_along_the_axis(gap, size, arc, tilt):
    """Against the load the ball meets the bore near the rim of the other side, or is held by its preload."""
    sizes = (*NUMBERS[:1], *NUMBERS[2:], f"--{gap}={size}", f"--arc-of-cover={arc} deg", f"--tilt={tilt} deg")
    words = ("curve", *sizes, "--points", "5", "--model", "sphere", "--both-signs")
    said = answer(*words, "--indentation", "0.04")
    joint = bs.Joint(ball_radius=17.9, liner_thickness=6.75, liner=lined().liner, **{gap: size})
    play, moved = max(joint.clearance, 0.0), np.array(said["displacement_along_load"])
    assert moved == pytest.approx([-play - 0.04, -play - 0.02, 0.0, play + 0.02, play + 0.04])
    axis = np.array([np.sin(np.radians(tilt)), 0.0, np.cos(np.radians(tilt))])
    pressed = bs.Sphere(cup=bs.Cup(arc_of_cover=np.radians(arc))).press(joint, displacement=moved[:, None] * axis)
    assert said["force"] == pytest.approx([-1.0, -1.0, 1.0, 1.0, 1.0] * pressed.force, rel=1e-4, abs=1e-3)
    if play:
        assert said["force"][0] < said["force"][2] == 0.0 < said["force"][4]
    said = answer(*words, "--force", "500 N")
    assert said["force"] == pytest.approx([-500.0, -250.0, 0.0, 250.0, 500.0])
    moved = np.array(said["displacement_along_load"], dtype=float)
    assert (np.diff(moved[np.isfinite(moved)]) > 0.0).all()
