"""The command, driven as a process."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import ballsocket as bs

EXAMPLE = str(Path(__file__).parents[1] / "examples" / "hip.toml")
NUMBERS = ("--ball-radius", "16", "--clearance", "0.1", "--liner-thickness", "6")
NUMBERS += ("--young", "1GPa", "--poisson", "0.4", "--force", "3kN")


def run(*words: str, columns: int = 100) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "ballsocket", *words],
        capture_output=True,
        encoding="utf-8",
        timeout=120,
        check=False,
        env={**os.environ, "COLUMNS": str(columns), "PYTHONIOENCODING": "utf-8"},
    )


def test_press_a_file():
    done = run("press", EXAMPLE)
    assert done.returncode == 0
    assert done.stderr == ""
    for text in ("Fig. 3", "hess-forsbach", "40.73", "44.72", "11.27", "582.7", "yes", "█"):
        assert text in done.stdout


@pytest.mark.parametrize("columns", [80, 100, 160])
def test_the_table_fits_the_terminal(columns):
    done = run("press", EXAMPLE, "--all", columns=columns)
    table = done.stdout.split("\n")[1:14]
    assert max(map(len, table)) <= columns
    assert not any("…" in line for line in table)
    for name in bs.catalogue:
        assert name in done.stdout


def test_json():
    done = run("press", EXAMPLE, "--model", "hess-forsbach", "--model", "bartel", "--json")
    answer = json.loads(done.stdout)
    assert list(answer) == ["version", "joint", "results"]
    assert answer["version"] == bs.__version__
    assert answer["joint"]["socket_radius"] == pytest.approx(18.0)
    assert answer["joint"]["ball"]["young"] == 230000.0
    assert [result["model"] for result in answer["results"]] == ["hess-forsbach", "bartel"]
    paper = answer["results"][0]
    assert set(paper) == {
        *("model", "force", "indentation", "half_angle_deg", "max_pressure", "area", "stiffness", "energy"),
        *("foundation_modulus", "valid", "notes"),
    }
    file = bs.read_joint(EXAMPLE)
    contact = bs.HessForsbach().press(file.joint, **file.load)
    assert paper["max_pressure"] == contact.max_pressure
    assert paper["valid"] is True
    assert paper["notes"] == []


def test_json_of_a_massive_socket_is_json():
    done = run("press", "tilting-pad-pivot", "--force", "3 kN", "--all", "--json")
    answer = json.loads(done.stdout)
    assert done.returncode == 0
    assert answer["joint"]["liner_thickness"] == "inf"
    missing = next(result for result in answer["results"] if result["model"] == "bonded-layer")
    assert missing["max_pressure"] is None
    assert missing["valid"] is False
    assert "infinite thickness" in missing["notes"][0]


def test_the_joint_in_words():
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
def test_loads_with_units_go_before_the_files(load, name, value):
    done = run("press", EXAMPLE, load, "--json")
    assert json.loads(done.stdout)["results"][0][name] == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_figure(tmp_path, ending):
    path = tmp_path / f"press.{ending}"
    done = run("press", EXAMPLE, "--all", "--figure", str(path))
    assert done.returncode == 0
    assert path.stat().st_size > 5_000
    start = path.read_bytes()[:5]
    assert start == {"png": b"\x89PNG\r", "svg": b"<?xml", "pdf": b"%PDF-"}[ending]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["press"], "a joint is needed: a file, a preset's name, or --ball-radius"),
        (["press", "nothing.toml"], "'nothing.toml' is neither a file nor a preset"),
        (["press", "hip-29", "--force", "1"], "did you mean 'hip-"),
        (["press", "hip-28"], "a load is needed: --force, --indentation or --half-angle"),
        (["press", EXAMPLE, "--force", "3 kg"], "force = '3 kg' is not a force, such as '3 kN'"),
        (["press", EXAMPLE, "--force", "-3"], "force = -3 is not allowed"),
        (["press", EXAMPLE, "--force", "1", "--indentation", "1"], "one load is needed, got force, indentation"),
        (["press", EXAMPLE, "--half-angle", "95"], "half_angle = 1.65806 is not allowed"),
        (["press", EXAMPLE, "--model", "herz"], "model 'herz' is not known; did you mean 'hertz'?"),
        (["press", EXAMPLE, "--figure", "a.jpg"], "figure 'a.jpg' must end in .png, .svg, .pdf"),
        (["press", EXAMPLE, "--figure", "/no/such/folder/a.png"], "No such file or directory"),
        (["press", EXAMPLE, "--young", "1GPa"], "give a joint file or the joint's numbers, not both"),
        (["press", EXAMPLE, "--colour"], "No such option: --colour"),
        (["press", ".", "--force", "1"], "is a folder; a joint file is needed"),
        (["press", *NUMBERS[:4], *NUMBERS[6:]], "liner_thickness is missing"),
        (["press", *NUMBERS[:6], "--force", "1"], "the liner needs a material, or young and poisson"),
        (["press", *NUMBERS[:8], "--poisson", "0.7", "--force", "1"], "poisson = 0.7 is not allowed"),
        (
            ["press", *NUMBERS[:8], "--poisson", "0.5", "--force", "1", "--model", "bonded-layer"],
            "bonded-layer has no answer for ν = 0.5: the modulus is unbounded",
        ),
        (["pres"], "No such command 'pres'"),
        (["cite", "herz"], "model 'herz' is not known; did you mean 'hertz'?"),
    ],
)
def test_misuse_is_one_line_that_says_what_to_change(words, message):
    done = run(*words)
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.startswith("ballsocket: ")
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


def test_a_file_with_a_mistake(tmp_path):
    path = tmp_path / "joint.toml"
    path.write_text(Path(EXAMPLE).read_text().replace("clearance", "clearence"))
    done = run("press", str(path))
    assert done.returncode == 2
    assert done.stderr == "ballsocket: joint.toml: 'clearence' in [joint] is not known; did you mean 'clearance'?\n"


def test_a_numerical_failure_is_3_and_the_others_are_shown():
    done = run("press", EXAMPLE, "--force", "1e12", "--model", "bartel", "--model", "hess-forsbach")
    assert done.returncode == 3
    assert "no answer from bartel" in done.stderr
    assert "the model does not reach this load" in done.stdout
    assert "hess-forsbach" in done.stdout


def test_models_presets_cite_version_help():
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
    assert run("--version").stdout == f"ballsocket {bs.__version__}\n"
    for words in ([], ["--help"], ["press", "--help"]):
        assert "Usage" in run(*words).stdout


def test_a_closed_pipe_is_no_crash():
    command = f"{sys.executable} -m ballsocket models | head -1"
    done = subprocess.run(command, shell=True, capture_output=True, encoding="utf-8", timeout=60, check=False)
    assert "Traceback" not in done.stderr
