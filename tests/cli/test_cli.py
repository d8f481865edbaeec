"""The program on joints: tables, JSON, error messages and exit statuses."""

import json
import re
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

import ballsocket as bs
from ballsocket import cli
from ballsocket.cli.json_answers import echo_json

from ..extent import some
from ..places import EXAMPLES
from .command import run, run_process

EXAMPLE = str(EXAMPLES / "hip.toml")
NUMBERS = ("--ball-radius", "16", "--clearance", "0.1", "--liner-thickness", "6")
NUMBERS += ("--young", "1GPa", "--poisson", "0.4", "--force", "3kN")


@pytest.mark.parametrize(
    ("words", "encoding"),
    some(
        [
            (("press", EXAMPLE, "--force", "1e12", "--model", "bartel"), "ascii"),
            (("press", EXAMPLE, "--model", "bartel", "--json"), "ascii"),
            (("press", EXAMPLE, "--model", "bartel"), "utf-8"),
            (("presets",), "utf-8"),
            (("press", "hip-29", "--force", "1"), "utf-8"),
        ],
        1,
    ),
)
def test_a_process_prints_what_a_call_prints(words, encoding):
    """The other tests call the command: it is the same."""
    here, there = (way(*words, encoding=encoding) for way in (run, run_process))
    assert (there.returncode, there.stdout, there.stderr) == (here.returncode, here.stdout, here.stderr)


@pytest.mark.parametrize(
    "words", some([("press", EXAMPLE, "--json"), ("presets",), ("models",), ("cite",)], 1), ids=" ".join
)
def test_a_closed_reader_ends_the_program_without_a_message(words):
    command = [sys.executable, "-m", "ballsocket", *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8") as process:
        process.stdout.close()  # before anything is written, as `head` does after a line
        assert process.stderr.read() == ""
        assert process.wait() == 141


def test_a_full_disk_is_reported_in_one_line():
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("there is no such device here")
    with full.open("w") as out:
        done = subprocess.run(
            [sys.executable, "-m", "ballsocket", "presets"], stdout=out, stderr=subprocess.PIPE, encoding="utf-8"
        )
        wrong = subprocess.run([sys.executable, "-m", "ballsocket", "pres"], stderr=out, stdout=subprocess.PIPE)
    assert (done.returncode, done.stderr) == (2, "ballsocket: output: No space left on device\n")
    assert (wrong.returncode, wrong.stdout) == (2, b"")


def test_the_table_of_an_unknown_width_is_that_of_80_columns():
    usual, unknown = (run("press", "hip-28", "--force", "1000", columns=columns) for columns in (80, 0))
    assert unknown.returncode == 0
    assert unknown.stdout == usual.stdout


@pytest.mark.parametrize("force", ["1e308", "-1e308", "1.1e9"])
def test_a_force_above_1e9_newton_is_refused_in_one_line(force, tmp_path):
    rows = "\n".join(f"{i / 10},{force if i else 1000},{i * (10 - i)}" for i in range(11))
    (tmp_path / "cycle.csv").write_text(f"time [s],force [N],flexion [deg]\n{rows}\n", encoding="ascii")
    (tmp_path / "hip.toml").write_text(
        'joint = "hip-28"\n[cycle]\nfile = "cycle.csv"\nclosing = 0.5\n[wear]\ncoefficient = 1e-6\n', encoding="ascii"
    )
    done = run("hip", "hip.toml", "--json", folder=tmp_path)
    size = f"{float(force.strip('-')):.4g}".replace("+", r"\+")
    assert (done.returncode, done.stdout) == (2, "")
    assert re.fullmatch(
        rf"ballsocket: hip.toml: cycle.csv: force goes to {size} N; allowed are forces up to 1e\+09 N\n", done.stderr
    )


def test_an_infinite_result_is_a_failure_in_one_line(monkeypatch, capsys):
    with pytest.raises(ArithmeticError, match="a result is infinite"):
        echo_json({"results": [], "valid": True, "error": {}, "notes": [], "volume": float("inf")})
    assert capsys.readouterr().out == ""


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals")
def test_a_terminated_process_removes_its_unfinished_files(tmp_path):
    study = "joint = 'hip-28'\n[axes]\nforce = {from = 1, to = 3000, count = 400_000}\n"
    (tmp_path / "s.toml").write_text(study, encoding="utf-8")
    process = subprocess.Popen(
        [sys.executable, "-m", "ballsocket", "study", "s.toml", "--out", "s.csv"],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    deadline = time.monotonic() + 60
    while not list(tmp_path.glob(".s.csv.*/s.csv")) and time.monotonic() < deadline:  # it is writing the numbers
        time.sleep(0.001)
    process.terminate()
    process.communicate(timeout=60)
    assert process.returncode == 143
    assert [path.name for path in tmp_path.iterdir()] == ["s.toml"]


@pytest.mark.long
def test_control_characters_in_file_names_are_escaped(tmp_path):
    done = run("press", "a\x1b[31m.toml", folder=tmp_path)
    assert done.stderr.startswith(r"ballsocket: 'a\x1b[31m.toml' is neither a file nor a preset")
    (tmp_path / "a\x1b[31m.toml").write_text("joint = 3", encoding="utf-8")
    done = run("press", "a\x1b[31m.toml", folder=tmp_path)
    assert done.stderr == "ballsocket: a\\x1b[31m.toml: joint = 3 must be a table: [joint]\n"
    (tmp_path / "s.toml").write_text('joint = "hip-28"\nmodel = "hertz"\n[axes]\nforce = [1, 2]', encoding="utf-8")
    done = run("study", "s.toml", "--out", "a\x1b[31m.csv", folder=tmp_path)
    assert done.stdout.endswith("\na\\x1b[31m.csv\n")


def test_an_error_message_is_one_line_below_700_characters(tmp_path):
    """Whatever is repeated in it, and whatever was about to be shown."""
    done = run("press", "hip-28", "x" * 3000)
    assert done.returncode == 2
    assert len(done.stderr) < 700
    (tmp_path / "s.toml").write_text('joint = "hip-28"\n[axes]\nclearance = 0.1', encoding="utf-8")
    done = run("study", "s.toml", folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("ballsocket: one load is needed")
    done = run("build-tables", "--out", "no/where.npz", folder=tmp_path)
    assert done.stderr == "ballsocket: no/where.npz: No such file or directory\n"


@pytest.mark.long
def test_two_samples_print_no_warning():
    """Two samples that are one have no interval; that is no warning to a user."""
    words = (
        "hip-22",
        "--force",
        "3.61e3",
        "--spread",
        "clearance=0.005+-0.005",
        "--count",
        "2",
        "--model",
        "tabulated",
    )
    done = run("sensitivity", *words)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("columns", some([40, 50, 60, 80, 160, 100], 2))
def test_the_table_is_not_wider_than_the_terminal(columns):
    done = run("press", EXAMPLE, "--all", columns=columns)
    lines = done.stdout.split("\n")
    assert max(map(len, lines)) <= columns
    assert "…" not in done.stdout
    assert re.search(r"^model .* pmax .*valid", done.stdout, flags=re.MULTILINE)
    for name in bs.catalogue:
        assert re.search(rf"^{name} .* (yes|no)", done.stdout, flags=re.MULTILINE)
    assert ("█" in done.stdout) == (columns >= 100)


def test_a_terminal_without_greek_letters_shows_ascii():
    done = run("press", EXAMPLE, "--all", encoding="ascii")
    assert done.returncode == 0
    assert "#" in done.stdout
    assert "outside e <= 7o" in done.stdout
    assert run("models", encoding="ascii").returncode == 0
    answer = run("press", EXAMPLE, "--json", "--model", "bonded-layer", encoding="ascii")
    assert json.loads(answer.stdout)["joint"]["name"] == "hip, Heß & Forsbach 2021, Fig. 3"
    refused = run("press", EXAMPLE, "--force", "3 ħ", encoding="ascii")
    assert (refused.returncode, refused.stdout) == (2, "")
    assert "is not a force" in refused.stderr


def test_an_infinite_thickness_is_shown_as_massive():
    done = run("press", "tilting-pad-pivot", "--force", "3 kN", "--model", "hertz")
    assert "massive" in done.stdout
    assert "inf mm" not in done.stdout


@pytest.mark.parametrize("load", ["--force=-0", "--indentation=-0.0", "--half-angle=-0"])
def test_a_load_of_minus_zero_is_zero(load):
    assert "-0" not in re.sub(r"hip-28", "", run("press", "hip-28", load, "--model", "hertz").stdout)
    answer = json.loads(run("press", "hip-28", load, "--model", "hertz", "--json").stdout)
    said = answer.pop("next")
    assert "-0" not in json.dumps(answer)
    assert all(load in step["command"] for step in said if "press" in step["command"])


def test_json_has_the_joint_and_a_result_per_model():
    done = run("press", EXAMPLE, "--model", "hess-forsbach", "--model", "bartel", "--json")
    answer = json.loads(done.stdout)
    assert list(answer) == ["version", "joint", "results", "valid", "error", "notes", "sources", "next"]
    assert answer["version"] == bs.__version__
    assert answer["joint"]["socket_radius"] == pytest.approx(18.0)
    assert answer["joint"]["ball"]["young"] == 230000.0
    assert [result["model"] for result in answer["results"]] == ["hess-forsbach", "bartel", "exact"]
    paper = answer["results"][0]
    assert set(paper) == {
        *("model", "force", "indentation", "half_angle_deg", "max_pressure", "area", "stiffness", "energy"),
        *(
            "foundation_modulus",
            "pole_pressure",
            "max_pressure_angle_deg",
            "utilisation",
            "utilisation_note",
            "valid",
            "notes",
            "deviation",
        ),
    }
    assert answer["results"][2]["deviation"] is None
    exact = bs.Exact().press(bs.read_joint(EXAMPLE).joint, force=3000.0)
    assert paper["deviation"]["max_pressure"] == pytest.approx(paper["max_pressure"] / exact.max_pressure - 1)
    file = bs.read_joint(EXAMPLE)
    contact = bs.HessForsbach().press(file.joint, **file.load)
    assert paper["max_pressure"] == contact.max_pressure
    assert paper["valid"] is True
    assert paper["notes"] == []


def test_json_writes_an_infinite_thickness_as_text():
    done = run("press", "tilting-pad-pivot", "--force", "3 kN", "--all", "--json")
    answer = json.loads(done.stdout)
    assert done.returncode == 0
    assert answer["joint"]["liner_thickness"] == "inf"
    missing = next(result for result in answer["results"] if result["model"] == "bonded-layer")
    assert missing["max_pressure"] is None
    assert missing["valid"] is False
    assert "infinite thickness" in missing["notes"][0]


def test_a_joint_is_built_from_options():
    done = run("press", *NUMBERS, "--json")
    joint = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE)
    expected = bs.HessForsbach().press(joint, force=3000.0).indentation
    assert json.loads(done.stdout)["results"][0]["indentation"] == expected
    by_material = run("press", *NUMBERS[:6], "--liner", "UHMWPE", "--ball", "steel", "--force", "3kN", "--json")
    assert json.loads(by_material.stdout)["joint"]["ball"]["young"] == 230000.0


@pytest.mark.parametrize(
    ("load", "name", "value"),
    [
        ("--indentation=40um", "indentation", 0.04),
        ("--half-angle=30", "half_angle_deg", 30.0),
        ("--force=1kN", "force", 1e3),
    ],
)
def test_a_load_option_replaces_the_load_of_the_file(load, name, value):
    done = run("press", EXAMPLE, load, "--json")
    assert json.loads(done.stdout)["results"][0][name] == pytest.approx(value, rel=1e-12)


def pressed(*words):
    """The joint that is pressed, and the largest pressures, by JSON."""
    answer = json.loads(run("press", *words, "--force", "3 kN", "--json").stdout)
    return answer["joint"], [result["max_pressure"] for result in answer["results"]]


def test_a_byte_order_mark_is_ignored(tmp_path):
    (tmp_path / "joint.toml").write_bytes(b"\xef\xbb\xbf" + Path(EXAMPLE).read_bytes())
    assert pressed(str(tmp_path / "joint.toml")) == pressed(EXAMPLE)


@pytest.mark.parametrize("command", ["press", "study"])
def test_an_empty_file_is_reported_as_empty(tmp_path, command):
    (tmp_path / "it.toml").write_text("# nothing yet\n", encoding="utf-8")
    kind = {"press": "joint", "study": "study"}[command]
    said = f"ballsocket: it.toml is empty: a {kind} file has tables, such as [joint]\n"
    assert run(command, str(tmp_path / "it.toml")).stderr == said


def test_an_unknown_option_is_reported_with_where_options_are_listed():
    unknown = run("sensitivity", "hip-36", "--vary", "clearance=0.1..0.2 mm")
    assert (unknown.returncode, unknown.stderr) == (
        2,
        "ballsocket: No such option: --vary; ballsocket sensitivity -h lists them\n",
    )
    assert "--clearance" in run("press", "hip-36", "--clearence", "0.1", "--force", "1").stderr
    several = run("press", "hip-36", "--liner", "uhmwpe,pom", "--force", "1")
    assert "'uhmwpe,pom' are several, and one is needed: optimise and studies choose" in several.stderr


def test_help_lists_press_first_and_hides_build_tables():
    text = run("-h").stdout
    assert text == run("--help").stdout
    commands = re.findall(r"^  ([a-z-]+) ", text.partition("Commands:")[2], flags=re.MULTILINE)
    assert commands[0] == "press"
    assert "build-tables" not in commands
    assert run("build-tables", "-h").returncode == 0
    assert "±" in run("sensitivity", "-h").stdout


def test_models_describes_one_model_in_full():
    text = run("models", "Hess Forsbach").stdout
    assert text.startswith("hess-forsbach: radial springs")
    assert "fitted at 1 to 3 kN" in text
    assert "10.3390/app112311170" in text
    assert "hertz" not in text
    listed = json.loads(run("models", "--json").stdout)["models"]
    assert {each["name"] for each in listed} >= set(bs.catalogue)
    (one,) = json.loads(run("models", "hess-forsbach", "--json").stdout)["models"]
    assert one in listed
    assert one["promise"]["within"] == bs.HessForsbach().promise.within
    assert run("models", "hess").stderr == "ballsocket: model 'hess' is not known; did you mean 'hess-forsbach'?\n"


def test_presets_describes_one_preset_in_full():
    text = run("presets", "hip-36").stdout
    for words in (
        "head diameter         36 mm",
        "diametral clearance   0.2 mm",
        "outer diameter        46.2 mm",
        "alumina",
    ):
        assert words in text
    text = run("presets", "UHMWPE").stdout
    assert bs.UHMWPE.source[:30] in text
    assert "wear factor           1.066e-06 mm³/(N m), range 7e-07 to 1.6e-06" in text
    assert "687 (unverified); range: a factor of 1.5 (assumed)" in " ".join(text.split())
    assert "wear factor" not in run("presets", "pom").stdout
    listed = json.loads(run("presets", "--json").stdout)
    assert (set(listed["joints"]), set(listed["materials"])) == (set(bs.joints), set(bs.materials))
    assert listed["joints"]["hip-36"]["source"] == bs.joints["hip-36"].source
    assert listed["materials"]["crosslinked-pe"]["wear_factor"]["high"] == 4e-7
    assert "did you mean 'hip-36'?" in run("presets", "hip36").stderr


@pytest.mark.parametrize("model", ["Exact", "EXACT", " exact"])
def test_names_of_models_ignore_case_and_separators(model):
    answer = json.loads(run("press", "Hip_36", "--model", model, "--force", "1 kN", "--json").stdout)
    assert [result["model"] for result in answer["results"]] == ["exact"]


def test_a_joint_is_defined_by_its_diameters():
    joint, pressures = pressed(
        *("--head-diameter", "36 mm", "--diametral-clearance", "0.2 mm", "--outer-diameter", "48 mm"),
        *("--liner", "crosslinked-pe", "--ball", "alumina"),
    )
    assert (joint["ball_radius"], joint["clearance"], joint["liner_thickness"]) == (18.0, 0.1, 5.9)
    assert pressures == pressed("hip-36", "--liner-thickness", "5.9")[1]


def test_options_replace_values_of_a_preset():
    joint, pressures = pressed("hip-36", "--liner", "uhmwpe", "--head-diameter", "32 mm")
    made = bs.joints["hip-36"].replace(liner=bs.UHMWPE, head_diameter=32.0)
    assert joint == made.summary()
    assert bs.HessForsbach().press(made, force=3000.0).max_pressure in pressures
    stiffer, _ = pressed("hip-36", "--young", "2 GPa")
    assert stiffer["liner"] == {**bs.joints["hip-36"].liner.summary(), "young": 2000.0}


def test_options_replace_values_of_a_file():
    joint, _ = pressed(EXAMPLE, "--poisson", "0.45", "--liner", "pom")
    assert joint["liner"] == {**bs.POM.summary(), "poisson": 0.45}  # as in a file: numbers win over the material's


def test_a_mistake_in_a_file_is_reported_with_its_name(tmp_path):
    path = tmp_path / "joint.toml"
    path.write_text(Path(EXAMPLE).read_text().replace("clearance", "clearence"))
    done = run("press", str(path))
    assert done.returncode == 2
    assert done.stderr == "ballsocket: joint.toml: 'clearence' in [joint] is not known; did you mean 'clearance'?\n"


UNREACHED = "the model does not reach this load"


def test_a_model_without_a_result_among_others_is_a_note():
    words = ["press", EXAMPLE, "--force", "1e12", "--model", "bartel", "--model", "hess-forsbach"]
    done = run(*words)
    assert (done.returncode, done.stderr) == (0, "")
    assert f"bartel: {UNREACHED}" in done.stdout
    assert "hess-forsbach" in done.stdout
    notes = {result["model"]: result["notes"] for result in json.loads(run(*words, "--json").stdout)["results"]}
    assert notes["bartel"] == [UNREACHED]


@pytest.mark.long
def test_all_models_solve_for_a_half_angle():
    done = run("press", "hip-28", "--half-angle", "30", "--all")
    assert (done.returncode, done.stderr) == (0, "")
    assert f"cosine-limit: {UNREACHED}" in done.stdout


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_no_result_at_all_gives_status_3_and_no_figure(form, tmp_path):
    path = tmp_path / "a.png"
    done = run("press", EXAMPLE, "--force", "1e12", "--model", "bartel", "--figure", str(path), *form)
    assert done.returncode == 3
    assert done.stderr == "ballsocket: no answer from bartel (see the notes)\n"
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


def test_numbers_near_the_float_limit_are_reported_in_one_line():
    numbers = ["--ball-radius", "1e308", "--clearance", "0.1", "--liner-thickness", "6", "--liner", "uhmwpe"]
    done = run("press", *numbers, "--force", "1")
    assert done.returncode in (0, 3)
    assert "Traceback" not in done.stderr


@pytest.mark.long
def test_a_figure_of_zero_load_prints_no_warning(tmp_path):
    done = run("press", "hip-28", "--force", "0", "--figure", str(tmp_path / "a.png"))
    assert (done.returncode, done.stderr) == (0, "")


def test_lists_references_version_and_help_are_printed():
    catalogue = run("models", columns=140)
    for name in (*bs.catalogue, "pin-in-hole"):
        assert name in catalogue.stdout
    assert "ν 0.3 to 0.49" in catalogue.stdout
    assert "Heß & Forsbach 2021" in catalogue.stdout
    presets = run("presets")
    assert "hip-28" in presets.stdout
    assert "cocr" in presets.stdout
    assert run("cite", "hertz").stdout.startswith("@article{hertz1882,")
    assert "@phdthesis{persson1964" in run("cite").stdout
    assert "@article{plank2007," in run("cite", "hip-28").stdout
    assert run("--version").stdout == f"ballsocket {bs.__version__}\n"
    for words in ([], ["--help"], ["press", "--help"]):
        assert "Usage" in run(*words).stdout


@pytest.mark.long
def test_press_by_finite_elements_shows_mesh_time_and_error_bars():
    done = run("press", EXAMPLE, "--model", "fem", columns=160)
    assert (done.returncode, done.stderr) == (0, "")
    _, _, indentation, half_angle = re.search(r"^fem .*", done.stdout, flags=re.MULTILINE)[0].split()[:4]
    assert (float(indentation), float(half_angle)) == pytest.approx((40.07, 42.4), rel=2e-3)  # µm, degrees
    mesh = r"^fem: \d+ elements, [\d.]+ mm at the contact, [\d.]+ s; error of the mesh: d ±.* %, ε ±.* %, pmax ±"
    assert re.search(mesh, done.stdout, flags=re.MULTILINE)
    answer = json.loads(run("press", EXAMPLE, "--model", "fem", "--meshes", "1", "--json").stdout)["results"][0]
    assert answer["model"] == "fem"
    assert answer["error"]["indentation"] is None
    assert answer["mesh"]["elements"] > 1000


@pytest.mark.long
def test_cup_options_and_vtk_files_of_the_finite_elements(tmp_path):
    file = tmp_path / "cup.toml"
    file.write_text(Path(EXAMPLE).read_text(encoding="utf-8") + '\n[cup]\narc_of_cover = "100 deg"\nchamfer = "1 mm"\n')
    files = ("--section", str(tmp_path / "cup.png"), "--vtk", str(tmp_path / "cup.vtu"))
    done = run("press", str(file), "--model", "fem", "--force", "9 kN", *files, columns=160)
    assert done.returncode == 0
    assert "the contact fills the socket and reaches its rim" in done.stdout
    assert (tmp_path / "cup.png").stat().st_size > 20_000
    assert (tmp_path / "cup.vtu").stat().st_size > 20_000
    wider = run("press", str(file), "--model", "fem", "--force", "9 kN", "--arc-of-cover", "180 deg", columns=160)
    assert "reaches its rim" not in wider.stdout


@pytest.mark.long
def test_deck_writes_input_files_and_expected_results(tmp_path):
    done = run("deck", EXAMPLE, "--out", str(tmp_path), "--steps", "2", "--force", "1 kN")
    assert done.returncode == 0
    assert re.search(r"ballsocket\.inp: \d+ elements, 2 steps", done.stdout.replace("\n", ""))
    assert (tmp_path / "ballsocket.inp").read_text(encoding="ascii").count("*END STEP") == 2
    for words, message in (
        (("--steps", "0"), "--steps"),
        (("--steps", "1000000"), "less than or equal to 1000"),
        (("--scale", "7"), "scale = 7 is not allowed"),
        (("--force", "0"), "need a contact under load"),
    ):
        wrong = run("deck", EXAMPLE, "--out", str(tmp_path), *words)
        assert wrong.returncode == 2
        assert message in wrong.stderr


@pytest.mark.long
def test_an_invalid_exact_result_is_not_first():
    shown = run("press", str(EXAMPLES / "tilted_hip.toml")).stdout
    assert shown.index("\nsphere ") < shown.index("\nexact ")


def test_the_exact_result_is_first_and_deviations_follow():
    lines = run("press", "hess-forsbach", "--force", "3 kN").stdout.splitlines()
    rows = {line.split()[0]: line.split() for line in lines if line.startswith(("exact", "hess-forsbach ", "  Δ"))}
    assert list(rows) == ["exact", "hess-forsbach", "Δ"]
    exact, paper = ([float(word) for word in rows[name][2:9]] for name in ("exact", "hess-forsbach"))
    differences = [100 * (value / reference - 1) for value, reference in zip(paper, exact, strict=True)]
    assert [float(word) for word in rows["Δ"][2:9]] == pytest.approx(differences, abs=0.1)  # printed with 0.1 %


@pytest.mark.parametrize("ending", some(["png", "svg", "pdf"], 1))
def test_press_writes_a_figure_in_each_format(tmp_path, ending):
    path = tmp_path / f"press.{ending}"
    done = run("press", EXAMPLE, "--all", "--figure", str(path))
    assert done.returncode == 0
    assert path.stat().st_size > 5_000
    assert path.read_bytes().startswith({"png": b"\x89PNG\r", "svg": b"<?xml", "pdf": b"%PDF-"}[ending])


def test_imperial_units_show_inches_and_pounds():
    words = ("press", "hess-forsbach", "--force", "3 kN", "--model", "exact")
    shown = run(*words, "--units", "Imperial").stdout.splitlines()
    heads, units, numbers = (line.split() for line in shown[-5:-2])
    values = dict(zip(heads, [None, *map(float, numbers[1:9])], strict=False))
    assert units == ["lbf", "mil", "°", "psi", "in²", "kip/in", "lbf", "in", "ksi/in"]
    contact = bs.Exact().press(bs.joints["hess-forsbach"], force=3000.0)
    expected = {"F": 3000 / 4.448222, "d": contact.indentation / 0.0254, "pmax": contact.max_pressure / 6.894757e-3}
    expected |= {"dF/dd": contact.stiffness / 175.1268, "K": contact.foundation_modulus / 0.2714471}
    assert {name: values[name] for name in expected} == pytest.approx(expected, rel=1e-3)  # four digits are printed
    assert run(*words, "--json", "--units", "imperial").stdout == run(*words, "--json").stdout
