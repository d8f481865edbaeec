"""The program on joints: tables, JSON, error messages and exit statuses."""

import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

import ballsocket as bs
from ballsocket import cli
from ballsocket.cli import root
from ballsocket.cli.json_answers import echo_json

from ..extent import some
from ..places import EXAMPLES
from ..processes import stopped_program
from .command import answer, printed, run

EXAMPLE = str(EXAMPLES / "hip.toml")
PROGRAM = [sys.executable, "-m", "ballsocket"]
UNREACHED = "the model does not reach this load"


@pytest.mark.parametrize(
    ("words", "encoding"),
    some([(("press", EXAMPLE, "--force=1e12", "--model=bartel"), "ascii"), (("press", EXAMPLE), "utf-8")], 1),
)
def test_a_process_prints_what_a_call_prints(words, encoding):
    """The other tests call the command: it is the same."""
    here = run(*words, encoding=encoding)
    variables = {**os.environ, "COLUMNS": "100", "PYTHONIOENCODING": encoding}
    there = subprocess.run([*PROGRAM, *words], capture_output=True, encoding="utf-8", env=variables)
    assert (there.returncode, there.stdout, there.stderr) == (here.returncode, here.stdout, here.stderr)


@pytest.mark.parametrize("words", some([("press", EXAMPLE, "--json"), ("presets",)], 1), ids=" ".join)
def test_a_closed_reader_ends_the_program_without_a_message(words):
    with subprocess.Popen([*PROGRAM, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()  # before anything is written, as `head` does after a line
        assert process.stderr.read() == b""
        assert process.wait() == 141


def test_closed_readers_of_output_and_messages_cost_no_file(tmp_path):
    text = 'joint = "hip-28"\n[axes]\nforce = [1000, 2000]\n'
    (tmp_path / "study.toml").write_text(text, encoding="ascii")
    words = [*PROGRAM, "study", "study.toml", "--out", "table.csv"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=tmp_path) as process:
        process.stdout.close()
        assert process.wait() == 141
    assert len((tmp_path / "table.csv").read_text(encoding="utf-8").splitlines()) == 3


def test_a_full_disk_is_reported_in_one_line():
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("there is no such device here")
    with full.open("w") as out:
        done = subprocess.run([*PROGRAM, "presets"], stdout=out, stderr=subprocess.PIPE, encoding="utf-8")
        wrong = subprocess.run([*PROGRAM, "pres"], stderr=out, stdout=subprocess.PIPE)
    assert (done.returncode, done.stderr) == (2, "ballsocket: output: No space left on device\n")
    assert (wrong.returncode, wrong.stdout) == (2, b"")


@pytest.mark.parametrize("force", ["1e308", "-1.1e9"])
def test_a_force_above_1e9_newton_is_refused_in_one_line(force, tmp_path):
    rows = "\n".join(f"{i / 10},{force if i else 1000},{i * (10 - i)}" for i in range(11))
    (tmp_path / "cycle.csv").write_text(f"time [s],force [N],flexion [deg]\n{rows}\n", encoding="ascii")
    hip = 'joint = "hip-28"\n[cycle]\nfile = "cycle.csv"\nclosing = 0.5\n[wear]\ncoefficient = 1e-6\n'
    (tmp_path / "hip.toml").write_text(hip, encoding="ascii")
    done = run("hip", "hip.toml", "--json", folder=tmp_path)
    size = f"{float(force.strip('-')):.4g}"
    message = f"ballsocket: hip.toml: cycle.csv: force goes to {size} N; allowed are forces up to 1e+09 N\n"
    assert (done.returncode, done.stdout, done.stderr) == (2, "", message)


def test_an_infinite_result_is_a_failure_in_one_line(capsys):
    with pytest.raises(ArithmeticError, match="a result is infinite"):
        echo_json({"results": [], "valid": True, "error": {}, "notes": [], "volume": float("inf")})
    assert capsys.readouterr().out == ""


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
def test_a_terminated_process_removes_its_unfinished_files(tmp_path):
    study = "joint = 'hip-28'\n[axes]\nforce = {from = 1, to = 3000, count = 40}\n"
    (tmp_path / "s.toml").write_text(study, encoding="utf-8")
    program = stopped_program(2, "s.csv", "SIGTERM")  # its folder is there, and the file is being opened
    done = subprocess.run([sys.executable, "-c", program, "study", "s.toml", "--out", "s.csv"], cwd=tmp_path)
    assert done.returncode == 143
    assert [path.name for path in tmp_path.iterdir()] == ["s.toml"]


@pytest.mark.long
def test_control_characters_in_file_names_are_escaped(tmp_path):
    name = "a\x1b[31m.toml"
    done = run("press", name, folder=tmp_path)
    assert done.stderr.startswith(r"ballsocket: 'a\x1b[31m.toml' is neither a file nor a preset")
    (tmp_path / name).write_text("joint = 3", encoding="utf-8")
    done = run("press", name, folder=tmp_path)
    assert done.stderr == "ballsocket: a\\x1b[31m.toml: joint = 3 must be a table: [joint]\n"
    (tmp_path / "s.toml").write_text('joint = "hip-28"\nmodel = "hertz"\n[axes]\nforce = [1, 2]', encoding="utf-8")
    done = run("study", "s.toml", "--out", "a\x1b[31m.csv", folder=tmp_path)
    assert done.stdout.endswith("\na\\x1b[31m.csv\n")


def test_a_long_message_is_one_line_with_its_beginning_and_its_end(capsys):
    assert len(run("press", "hip-28", "x" * 3000).stderr) < 700
    for message in ("begin " + "x " * 1000 + "end", "x" * 600):
        root.print_message(message)
    text, plain = capsys.readouterr().err.splitlines()
    assert text.startswith("ballsocket: begin x x")
    assert text.endswith("x end")
    assert (len(text), text.count(" ... ")) == (len("ballsocket: ") + 300 + 5 + 150, 1)
    assert plain == "ballsocket: " + "x" * 600


@pytest.mark.long
def test_no_warning_is_printed_for_two_equal_samples_nor_for_figure_and_report_of_zero_load(tmp_path):
    spread = ("--spread", "clearance=0.005+-0.005", "--count", "2", "--model", "tabulated")
    for words in (
        ("sensitivity", "hip-22", "--force", "3.61e3", *spread),
        ("press", "hip-28", "--force", "0", "--figure", str(tmp_path / "a.png"), "--report", str(tmp_path / "a.html")),
    ):
        assert run(*words).stderr == ""


def test_a_table_has_all_models_and_that_of_an_unknown_width_has_80_columns():
    unknown, usual, narrow = (run("press", EXAMPLE, "--all", columns=width).stdout for width in (0, 80, 40))
    assert unknown == usual
    assert max(map(len, narrow.split("\n"))) <= 40
    for name in bs.catalogue:
        assert re.search(rf"^{name} .* (yes|no)", narrow, flags=re.MULTILINE)


def test_a_terminal_without_greek_letters_shows_ascii():
    text = run("press", EXAMPLE, "--all", encoding="ascii").stdout
    assert "#" in text
    assert "outside e <= 7o" in text
    assert run("models", encoding="ascii").returncode == 0
    shown = run("press", EXAMPLE, "--json", "--model", "bonded-layer", encoding="ascii")
    assert json.loads(shown.stdout)["joint"]["name"] == "hip, Heß & Forsbach 2021, Fig. 3"
    refused = run("press", EXAMPLE, "--force", "3 ħ", encoding="ascii")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert "is not a force" in refused.stderr


def test_an_infinite_thickness_is_massive_in_a_table_and_text_in_json():
    words = ("press", "tilting-pad-pivot", "--force", "3 kN")
    shown = run(*words, "--model", "hertz").stdout
    assert ("massive" in shown, "inf mm" in shown) == (True, False)
    said = answer(*words, "--all")
    assert said["joint"]["liner_thickness"] == "inf"
    missing = next(result for result in said["results"] if result["model"] == "bonded-layer")
    assert (missing["max_pressure"], missing["valid"]) == (None, False)
    assert "infinite thickness" in missing["notes"][0]


@pytest.mark.parametrize("load", ["--force=-0", "--indentation=-0.0", "--half-angle=-0"])
def test_a_load_of_minus_zero_is_zero(load):
    assert "-0" not in re.sub(r"hip-28", "", run("press", "hip-28", load, "--model", "hertz").stdout)
    said = answer("press", "hip-28", load, "--model", "hertz")
    steps = said.pop("next")
    assert "-0" not in json.dumps(said)
    assert all(load in step["command"] for step in steps if "press" in step["command"])


def test_json_has_the_joint_and_a_result_per_model_and_is_metric_in_every_system_of_units():
    words = ("press", EXAMPLE, "--model", "hess-forsbach", "--model", "bartel")
    said = answer(*words)
    assert said == answer(*words, "--units", "Imperial")
    assert said["version"] == bs.__version__
    assert said["joint"]["socket_radius"] == pytest.approx(18.0)
    assert said["joint"]["ball"]["young"] == 230000.0
    paper, bartel, exact = said["results"]
    assert [result["model"] for result in (paper, bartel, exact)] == ["hess-forsbach", "bartel", "exact"]
    assert exact["deviation"] is None
    file = bs.read_joint(EXAMPLE)
    expected = bs.Exact().press(file.joint, force=3000.0)
    assert paper["deviation"]["max_pressure"] == pytest.approx(paper["max_pressure"] / expected.max_pressure - 1)
    assert paper["max_pressure"] == bs.HessForsbach().press(file.joint, **file.load).max_pressure
    assert (paper["valid"], len(paper["notes"])) == (True, 1)  # on the proportional limit


def pressed(*words):
    """The joint that is pressed, and the largest pressures, by JSON."""
    said = answer("press", *words, "--force", "3 kN")
    return said["joint"], [result["max_pressure"] for result in said["results"]]


def test_presets_describes_one_preset_in_full():
    text = run("presets", "UHMWPE").stdout
    assert bs.UHMWPE.source[:30] in text
    assert re.search(r"^wear factor +1.066e-06 mm³/\(N m\), range 7e-07 mm³", text, flags=re.MULTILINE)
    assert "wear factor" not in run("presets", "pom").stdout
    listed = answer("presets")
    assert (set(listed["joints"]), set(listed["materials"])) == (set(bs.joints), set(bs.materials))
    assert listed["joints"]["hip-36"]["source"] == bs.joints["hip-36"].source
    assert listed["materials"]["crosslinked-pe"]["wear_factor"]["high"] == 4e-7
    assert "did you mean 'hip-36'?" in run("presets", "hip36").stderr


def test_a_joint_is_built_from_radii_or_diameters():
    lengths = ("--ball-radius", "16", "--clearance", "0.1", "--liner-thickness", "6")
    joint = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE)
    expected = bs.HessForsbach().press(joint, force=3000.0).max_pressure
    assert pressed(*lengths, "--young", "1GPa", "--poisson", "0.4")[1][0] == expected
    assert pressed(*lengths, "--liner", "UHMWPE", "--ball", "steel")[0]["ball"]["young"] == 230000.0
    joint, pressures = pressed(
        *("--head-diameter", "36 mm", "--diametral-clearance", "0.2 mm", "--outer-diameter", "48 mm"),
        *("--liner", "crosslinked-pe", "--ball", "alumina"),
    )
    assert (joint["ball_radius"], joint["clearance"], joint["liner_thickness"]) == (18.0, 0.1, 5.9)
    assert pressures == pressed("hip-36", "--liner-thickness", "5.9")[1]


def test_options_replace_values_of_a_preset_or_a_file_with_or_without_a_byte_order_mark(tmp_path):
    joint, pressures = pressed("hip-36", "--liner", "uhmwpe", "--head-diameter", "32 mm")
    made = bs.joints["hip-36"].replace(liner=bs.UHMWPE, head_diameter=32.0)
    assert joint == made.summary()
    assert bs.HessForsbach().press(made, force=3000.0).max_pressure in pressures
    stiffer, _ = pressed("Hip_36", "--young", "2 GPa", "--model", "EXACT", "--model", " bartel")
    assert stiffer["liner"] == {**bs.joints["hip-36"].liner.summary(), "young": 2000.0}
    (tmp_path / "joint.toml").write_bytes(b"\xef\xbb\xbf" + Path(EXAMPLE).read_bytes())
    assert pressed(str(tmp_path / "joint.toml"), "--ball", "alumina") == pressed(EXAMPLE, "--ball", "alumina")


def test_a_model_without_a_result_among_others_is_a_note():
    words = ["press", EXAMPLE, "--force", "1e12", "--model", "bartel", "--model", "hess-forsbach"]
    done = run(*words)
    assert (done.returncode, done.stderr) == (0, "")
    assert f"bartel: {UNREACHED}" in done.stdout
    assert "hess-forsbach" in done.stdout
    notes = {result["model"]: result["notes"] for result in answer(*words)["results"]}
    assert notes["bartel"] == [UNREACHED]


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_no_result_at_all_gives_status_3_and_no_figure(form, tmp_path):
    path = tmp_path / "a.png"
    done = run("press", EXAMPLE, "--force", "1e12", "--model", "bartel", "--figure", str(path), *form)
    assert (done.returncode, done.stderr) == (3, "ballsocket: no answer from bartel (see the notes)\n")
    assert UNREACHED in done.stdout
    assert not path.exists()


def test_an_iteration_without_convergence_gives_status_3(monkeypatch, capsys):
    def unsettled(*_, **load):
        contact = bs.HessForsbach().press(bs.joints["hip-28"], **load)
        return replace(contact, indentation=float("nan"), status=bs.Status.NOT_CONVERGED)

    model = SimpleNamespace(press=unsettled, name="unsettled", in_cup=lambda cup: model)
    monkeypatch.setattr(sys, "argv", ["ballsocket", "press", "hip-28", "--force=1", "--all"])
    monkeypatch.setitem(bs.catalogue, "unsettled", model)
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 3
    assert "no convergence of unsettled" in capsys.readouterr().err


def test_lists_references_and_version_are_printed():
    assert {each["name"] for each in answer("models")["models"]} >= set(bs.catalogue)
    assert "10.3390/app112311170" in run("models", "Hess Forsbach").stdout
    assert "@phdthesis{persson1964" in run("cite").stdout
    assert run("cite", "hertz").stdout.startswith("@article{hertz1882,")
    assert "@article{plank2007," in run("cite", "hip-28").stdout
    assert run("--version").stdout == f"ballsocket {bs.__version__}\n"


@pytest.mark.long
def test_press_by_finite_elements_shows_mesh_time_and_error_bars():
    text = printed("press", EXAMPLE, "--model", "fem", columns=160)
    _, _, indentation, half_angle = re.search(r"^fem .*", text, flags=re.MULTILINE)[0].split()[:4]
    assert (float(indentation), float(half_angle)) == pytest.approx((40.07, 42.4), rel=2e-3)  # µm, degrees
    mesh = r"^fem: \d+ elements, [\d.]+ mm at the contact, [\d.]+ s; error of the mesh: d ±.* %, ε ±.* %, pmax ±"
    assert re.search(mesh, text, flags=re.MULTILINE)
    fem = answer("press", EXAMPLE, "--model", "fem", "--meshes", "1")["results"][0]
    assert (fem["model"], fem["error"]["indentation"]) == ("fem", None)
    assert fem["mesh"]["elements"] > 1000


@pytest.mark.long
def test_press_with_a_liner_that_yields_shows_its_set_beside_the_elastic_result(tmp_path):
    words = ("press", EXAMPLE, "--plastic", "--hardening", "10:0, 14 MPa:0.05", "--force", "8 kN")
    exact, fem = (result for _, result in sorted((one["model"], one) for one in answer(*words)["results"]))
    assert fem["permanent_set"] > 1e-3
    assert "permanent_set" not in exact
    assert fem["max_pressure"] < exact["max_pressure"]
    every = {one["model"]: one for one in answer(*words, "--all", "--meshes", "1")["results"]}
    assert every["fem"]["permanent_set"] == pytest.approx(fem["permanent_set"], rel=1e-9)
    figure = tmp_path / "zone.png"
    assert "us permanent set" in printed(*words, "--section", str(figure), columns=200)
    assert figure.stat().st_size > 20_000


@pytest.mark.long
def test_cup_options_and_vtk_files_of_the_finite_elements(tmp_path):
    file = tmp_path / "cup.toml"
    file.write_text(Path(EXAMPLE).read_text(encoding="utf-8") + '\n[cup]\narc_of_cover = "100 deg"\nchamfer = "1 mm"\n')
    words, files = ("press", str(file), "--model", "fem", "--force", "9 kN"), (tmp_path / "a.png", tmp_path / "a.vtu")
    text = printed(*words, "--section", str(files[0]), "--vtk", str(files[1]), columns=160)
    assert "the contact fills the socket and reaches its rim" in text
    assert all(path.stat().st_size > 20_000 for path in files)
    assert "reaches its rim" not in run(*words, "--arc-of-cover", "180 deg", columns=160).stdout


@pytest.mark.parametrize("ending", some(["png", "svg", "pdf"], 1))
def test_press_writes_a_figure_in_each_format(tmp_path, ending):
    path = tmp_path / f"press.{ending}"
    printed("press", EXAMPLE, "--all", "--figure", str(path))
    assert path.stat().st_size > 5_000
    assert path.read_bytes().startswith({"png": b"\x89PNG\r", "svg": b"<?xml", "pdf": b"%PDF-"}[ending])


@pytest.mark.long
def test_an_optimum_of_two_ranges_is_drawn_as_a_map(tmp_path):
    ranges = ("--vary", "clearance=50..200 um", "--vary", "liner_thickness=4..8 mm", "--points", "3")
    printed("optimise", "hip-36", "--force=3 kN", "--model=bartel", *ranges, "--figure", "a.png", folder=tmp_path)
    assert (tmp_path / "a.png").stat().st_size > 5000
