"""Custom models: functions as moduli, and Python files that only the command line runs."""

from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.input_files import restriction_variables
from ballsocket.core.sources import Source
from ballsocket.model_catalogue import named_model
from ballsocket.studies.file import read_study

from ..refusals import text_tables
from .command import answer, printed, refusal

HIP = bs.joints["hip-28"]
MODELS = '''
import ballsocket as bs
def winkler(joint):
    """Columns of the liner."""
    return 1.5 * joint.liner.young / joint.liner_thickness
winkler.source = "J. Doe, thesis, 2026"
def exact(): return bs.RadialFoundation(modulus=winkler, kinematics=bs.exact_kinematics)
fit = bs.polynomial(0.9, 1.41, 0.05)
number = 3.0
def broken(joint):
    return joint.nothing
def negative(joint): return -1.0
def catalogued(): return bs.Hertz()
class Unfinished(bs.ClosedForm): pass
class Nameless(type(bs.Hertz())):
    name = ""
class Twice(type(bs.Hertz())):
    name = "twice"
    def stiffness(self, joint, indentation): return 2 * super().stiffness(joint, indentation)
class Lossy(type(bs.Hertz())):
    name = "lossy"
    def energy(self, joint, indentation): return 0.9 * super().energy(joint, indentation)
'''


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wrong = {"fails": "\n1 / 0\n", "wrong": "x = (\n", "leaves": "raise SystemExit(3)\n", "json": "x = 1\n"}
    for name, text in {"own": MODELS, **wrong}.items():
        (tmp_path / f"{name}.py").write_text(text)
    return tmp_path


@pytest.mark.parametrize("name", ["winkler", "exact", "fit"])
def test_models_of_a_file_press_as_in_python(name, folder):
    said = answer("press", "hip-28", "--force", "3000", "--model", f"own.py:{name}", "--model", "hertz")
    custom, hertz, exact = said["results"]
    K = {"fit": 0.9 + 1.41 * 2.82 + 0.05 * 2.82**2}.get(name)
    modulus = 1.5 * 1000 / 5 if K is None else K * 1000 / 14.1
    kinematics = bs.exact_kinematics if name == "exact" else bs.linear_kinematics
    model = bs.RadialFoundation(modulus=bs.constant(modulus), kinematics=kinematics)
    assert custom["max_pressure"] == pytest.approx(model.press(HIP, force=3000.0).max_pressure, rel=1e-12)
    assert (hertz["model"], exact["model"]) == ("hertz", "exact")
    assert custom["deviation"]["max_pressure"] == pytest.approx(custom["max_pressure"] / exact["max_pressure"] - 1)


(REFUSED,) = text_tables(Path(__file__).parent / "refused_models.txt")


@pytest.mark.parametrize(("value", "message"), REFUSED)
def test_what_is_no_model_is_refused_in_one_sentence(value, message, folder):
    assert message in refusal("press", "hip-28", "--force", "3000", "--model", value)


def test_other_commands_take_a_model_file(folder):
    for words in (
        "curve hip-28 --force 3000 --points 2",
        "optimise hip-28 --force 3000 --vary clearance=0.05..0.1",
        "export table hip-28 --out element",
    ):
        printed(*words.split(), "--model", "own.py:winkler")


def test_only_the_command_line_runs_a_model_file(folder, monkeypatch):
    """Not a process that serves others (tools), nor a file, a link, the explorer or the names of the catalogue."""
    name = "own.py:winkler"
    with pytest.raises(ValueError, match="model 'own.py:winkler' is not known"):
        named_model(name)
    study = folder / "study.toml"
    study.write_text(f'joint = "hip-28"\nmodel = "{name}"\n[axes]\nforce = [1000, 2000]\n')
    with pytest.raises(ValueError, match="model 'own.py:winkler' is not known"):
        read_study(study)
    for key, value in restriction_variables([folder]).items():
        monkeypatch.setenv(key, value)
    refused = refusal("press", "hip-28", "--force", "3000", "--model", name)
    assert "only the command line of a user runs a model file" in refused


@pytest.mark.parametrize("key", ["answered_by", "shown", "map_model"])
def test_no_link_of_the_explorer_runs_a_model_file(key, folder):
    pytest.importorskip("tornado", reason="the explorer's extra is not installed")
    from ballsocket.app.state.screen import read_link

    with pytest.raises(ValueError, match=f"'own.py:winkler' as {key} is not known"):
        read_link({key: ["own.py:winkler"]})


def test_a_function_is_a_modulus():
    def stepped(joint):
        return 300.0 if joint.liner_thickness > 5.5 else 200.0  # one joint at a time

    joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=np.array([5.0, 6.0]), liner=bs.UHMWPE)
    contact = bs.RadialFoundation(modulus=stepped).press(joint, force=3000.0)
    assert contact.foundation_modulus.tolist() == [200.0, 300.0]
    table = bs.RadialFoundation(modulus=lambda joint: joint.liner.young / joint.liner_thickness)
    assert table.press(joint, force=3000.0).foundation_modulus == pytest.approx([200.0, 1000 / 6])
    adhesive = bs.AdhesiveSocket(modulus=stepped)
    assert adhesive.press(HIP, force=3000.0).foundation_modulus == 200.0


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (3.0, "modulus must be a Modulus, .* got 3.0; for a number, use bs.constant"),
        (bs.polynomial, "call it, such as bs.polynomial"),
        (lambda joint: "stiff", "modulus lambda must be a number"),
    ],
)
def test_what_is_no_modulus_is_refused_in_one_sentence(value, message):
    with pytest.raises(TypeError, match=message):
        bs.RadialFoundation(modulus=value).press(HIP, force=3000.0)
    with pytest.raises(TypeError, match="kinematics must be a Kinematics"):
        bs.RadialFoundation(kinematics="linear")


def test_the_source_of_a_custom_model_is_cited():
    own = bs.RadialFoundation(modulus=bs.polynomial(0.9, 1.4, 0.05, source="J. Doe {thesis}, 2026"))
    text = bs.cite(own.press(HIP, force=3000.0))
    assert "@misc{polynomial-linear," in text
    assert "note  = {J. Doe thesis, 2026}," in text
    assert "{hess2021," in text
    named = bs.polynomial(0.9, 1.4, 0.05, source="refit of Plank et al. 2007")
    assert "{plank2007," in bs.cite(bs.RadialFoundation(modulus=named))
    entry = "@article{doe2026,\n  author = {Doe, Jane and Roe, R.},\n  year = {2026},\n  doi = {10.1/x}\n}"
    source = Source("doe2026", "(3)", bibtex=entry)
    assert (str(source), source.doi, bs.cite(source)) == ("Doe & Roe 2026, (3)", "10.1/x", entry)
    with pytest.raises(ValueError, match="give its entry, Source\\('doe2026', bibtex="):
        bs.cite(Source("doe2026"))
    with pytest.raises(ValueError, match="bibtex must be one entry with the key 'doe'"):
        Source("doe", bibtex=entry)


def test_compare_takes_a_list_of_models_and_names():
    answers = bs.compare(HIP, force=3000.0, models=[bs.Exact(), "hertz"])
    assert list(answers) == ["exact", "hertz"]
    assert answers["hertz"].max_pressure == bs.Hertz().press(HIP, force=3000.0).max_pressure
    with pytest.raises(ValueError, match="two of the models are named 'exact': use a mapping"):
        bs.compare(HIP, force=1.0, models=[bs.Exact(), "exact"])
