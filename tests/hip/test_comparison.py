"""Several hips in one call, tables and figures of a run, and what its terminal and files say of rim and radiograph."""

import csv
import json
import sys
from dataclasses import replace
from math import cos, radians, sin

import numpy as np
import pytest
from typer.testing import CliRunner

import ballsocket as bs
from ballsocket.cli.root import app
from ballsocket.hip import WEAR_FACTORS, Archard, logarithmic
from ballsocket.hip.rim import RimDistance, mask_edge_loading
from ballsocket.hip.wear_laws import read_wear_law
from ballsocket.reports.hip_comparison import wear_figure

from .test_file import write_edited_file
from .test_wear import QUICK, TILTED, hip

SHORT = (("5e6\n", "2e5\n"), ("[1e6, 2e6, 5e6]", "[1e5]"), ("instants = 100", "instants = 16"))


@pytest.fixture
def files(tmp_path):
    """Two hips, of which the second has a published wear factor and a scatter of the clearance."""
    file = write_edited_file(tmp_path, *SHORT)
    text = file.read_text(encoding="utf-8").replace('contact = "springs"', 'ring_width = "8 deg"')
    text = text.replace('name = "hip in use"', "")
    (tmp_path / "a.toml").write_text(text, encoding="utf-8")
    coefficient = 'coefficient = "1.066e-6 mm^3/(N m)"'
    assert coefficient in text
    scatter = '[uncertainty]\nclearance = {low = "0.05 mm", high = "0.2 mm"}\ncount = 2\n'
    linked = text.replace(coefficient, 'material = "crosslinked-pe"')
    (tmp_path / "b.toml").write_text(f"{linked}\n{scatter}", encoding="utf-8")
    return str(tmp_path / "a.toml"), str(tmp_path / "b.toml")


def invoke(*words):
    return CliRunner().invoke(app, ["hip", *words])


def test_two_files_are_side_by_side_in_table_csv_and_figure(files, tmp_path):
    out = ["--csv", str(tmp_path / "ab.csv"), "--figure", str(tmp_path / "ab.svg")]
    done = invoke(*files, *out)
    assert done.exit_code == 0, done.output
    lines = [line.split() for line in done.stdout.splitlines()]
    reports = [line[:2] for line in lines if line[:1] in (["0.1"], ["0.2"])]
    assert reports[:4] == [["0.1", "a"], ["0.1", "b"], ["0.2", "a"], ["0.2", "b"]]
    text = " ".join(done.stdout.split())
    assert "b: wear factor of crosslinked-pe: 2e-07 mm³/(N m)" in text
    assert "patients" not in text
    rows = list(csv.DictReader((tmp_path / "ab.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["hip"] for row in rows] == ["a", "a", "b", "b"]
    assert float(rows[1]["volume_mm3"]) / float(rows[3]["volume_mm3"]) == pytest.approx(5.33, rel=0.05)
    assert rows[0]["volume_low_mm3"] == ""
    assert float(rows[3]["volume_low_mm3"]) < float(rows[3]["volume_mm3"]) < float(rows[3]["volume_high_mm3"])
    assert (tmp_path / "ab.svg").read_text(encoding="utf-8").count("<svg") == 1


def test_json_of_several_files_has_an_entry_for_each(files, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["ballsocket", "hip", *files, "--json"])
    answer = json.loads(invoke(*files, "--json").stdout)
    alone = json.loads(invoke(files[0], "--json").stdout)
    assert [result["name"] for result in answer["results"]] == ["a", "b"]
    assert [result["file"] for result in answer["results"]] == list(files)
    assert answer["results"][0]["history"] == alone["history"]
    assert answer["valid"] is all(result["valid"] for result in answer["results"])
    assert answer["results"][1]["laws"]["wear"]["source"].startswith("wear factor of crosslinked-pe")
    assert "results" not in alone
    assert alone["name"] == "a"


def test_a_stated_name_stands_in_table_csv_figure_and_json(files, tmp_path):
    named = []
    for number, stem in enumerate("abc"):
        path = tmp_path / f"named_{stem}.toml"
        name = "" if number == 2 else 'name = "conventional 28"\n'
        quick = (tmp_path / "a.toml").read_text(encoding="utf-8").replace("2e5", "1e4").replace("[1e5]", "[1e4]")
        path.write_text(name + quick, encoding="utf-8")
        named.append(str(path))
    names = ["conventional 28 (named_a)", "conventional 28 (named_b)", "named_c"]
    done = invoke(*named, "--csv", str(tmp_path / "n.csv"), "--figure", str(tmp_path / "n.svg"))
    assert done.exit_code == 0, done.output
    assert all(f"0.01 {name}" in done.stdout for name in names)
    assert [
        row["hip"] for row in csv.DictReader((tmp_path / "n.csv").read_text(encoding="utf-8").splitlines())
    ] == names
    assert all(name in (tmp_path / "n.svg").read_text(encoding="utf-8") for name in names)
    alone = invoke(named[0], "--csv", str(tmp_path / "n.csv")).stdout
    assert alone.startswith("conventional 28: R1 14 mm")
    assert "conventional 28," in (tmp_path / "n.csv").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["a.toml", "b.toml", "--report", "ab.html"], "--report shows one hip, got 2 files"),
        (["a.toml", "b.toml", "--patients", "4"], "--patients needs one file, got 2"),
        (["b.toml", "--patients", "4", "--csv", "b.csv"], "--csv shows one hip: leave out --csv or --patients"),
        (["a.toml", "a.toml"], "two files are the same"),
        (["a.toml", "--csv", "a.txt"], "must end in .csv"),
        (["a.toml", "--figure", "a.gif"], "must end in .png, .svg, .pdf"),
    ],
)
def test_options_that_do_not_fit_are_refused(files, tmp_path, monkeypatch, words, message):
    monkeypatch.chdir(tmp_path)
    assert message in str(invoke(*words).exception)


def test_a_history_is_a_frame_and_a_figure(monkeypatch):
    history = hip(**QUICK).after(2e4, [1e4])
    frame = history.to_frame()
    assert frame["volume_mm3"].tolist() == [report.volume for report in history.reports]
    assert frame["cycles"].tolist() == [1e4, 2e4]
    assert "penetration" in history.plot().axes[1].get_ylabel()
    assert len(wear_figure([history, history]).axes[0].lines) == 2
    assert ", 2 reports, last " in repr(history)
    monkeypatch.setattr("ballsocket.core.checks.find_spec", lambda name: None)
    with pytest.raises(ImportError, match=r'pandas is not installed: pip install "ballsocket\[study\]"'):
        history.to_frame()
    assert len(history.table()) == 2


def test_the_terminal_states_assumptions_and_no_creep_without_creep(files):
    plain = invoke(files[0]).stdout
    text = " ".join(plain.split())
    assert "creep" not in plain
    assert "assumed for the film: viscosity 2.5 mPa s, roughness Ra 0.02 µm (ball) and 1 µm (cup)" in text
    assert "penetration in a radiograph from the front, by wear:" in text


def test_the_radiograph_shows_the_displacement_in_the_frontal_plane():
    """Of an anteverted cup it lacks the part to the front; the length is that of the two other components."""
    cup = bs.Cup(inclination=radians(45.0), anteversion=radians(30.0))
    history = hip(cup=cup, creep=logarithmic(), **QUICK).after(1e4)
    body = np.array(history.use.placed.frame).T @ history.last.displacement
    assert history.radiographic_displacement(history.last) == pytest.approx(body[[0, 2]])
    assert history.radiographic_penetration(history.last) == pytest.approx(np.hypot(body[0], body[2]))
    upright = hip(cup=TILTED, **QUICK).after(1e4)
    lateral, upward = upright.radiographic_displacement(upright.last)
    assert upward == pytest.approx(upright.last.penetration, rel=0.05)  # the load is upwards
    assert abs(lateral) < 0.2 * upward
    entry = history.summary()["history"][-1]
    assert entry["radiographic_penetration"] == pytest.approx(np.hypot(*entry["radiographic_vector"]))


def test_a_bore_worn_to_the_rim_is_no_edge_loading():
    worn = hip(wear=Archard(coefficient=1e-5), **QUICK).after(1e6)
    edge = worn.summary()["history"][-1]["edge"]
    assert (edge["kind"], edge["instants_edge_loaded"], edge["instants_at_rim"]) == ("worn to the rim", 0, 16)
    (note,) = (note for note in worn.notes if "rim" in note)
    assert note.startswith("worn to the rim: after 1e+06 cycles the worn bore fits the ball")
    assert "this is not edge loading" in note
    steep = hip(cup=bs.Cup(inclination=radians(80.0)), **QUICK).after(1e4)
    assert steep.worst.kind == "edge loading"
    assert steep.summary()["history"][-1]["edge"]["instants_edge_loaded"] > 0
    assert any(note.startswith("edge loading: in the first cycle the contact reaches the rim") for note in steep.notes)


def test_edge_loading_is_a_load_near_the_rim_or_the_largest_pressure_there():
    def distances(distance, pressure=0.0):
        return RimDistance(distance=np.array(distance), azimuth=np.zeros(3), pressure=np.full(3, pressure))

    at_rim, clear = distances([0.0, 0.0, 1.0], 5.0), distances([1.0, 0.0, 2.0])
    assert mask_edge_loading(at_rim, clear, 9.0).tolist() == [False, True, False]
    assert mask_edge_loading(at_rim, clear, 5.0).tolist() == [True, True, False]


# wear factors by material


def test_a_material_gives_its_published_factor_with_the_source():
    law = read_wear_law({"material": "crosslinked-pe"})
    assert law == Archard.of_material("crosslinked-pe")
    assert law.coefficient == WEAR_FACTORS["crosslinked-pe"].value == 2e-7
    assert "range 1e-07 to 4e-07" in law.notes[0]
    assert law.with_coefficient(1e-7) == Archard(coefficient=1e-7)
    for factor in WEAR_FACTORS.values():
        assert factor.low < factor.value < factor.high
        assert factor.source


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"material": "pom"}, "no published wear factor of 'pom' is known here: state coefficient"),
        ({"material": "uhmwp"}, "material 'uhmwp' is not known; did you mean 'uhmwpe'"),
        ({"material": "uhmwpe", "coefficient": 1e-6}, "material and coefficient exclude each other"),
        ({"material": "uhmwpe", "law": "energy"}, "material gives the wear factor of the law 'archard'"),
    ],
)
def test_materials_without_a_factor_are_refused(table, message):
    with pytest.raises(ValueError, match=message):
        read_wear_law(table)


def test_a_flexed_direction_has_no_part_in_the_plane_of_its_view():
    history = hip(**QUICK).after(1e4)
    frame = np.array(history.use.placed.frame)
    moved = replace(history.last, displacement=frame @ np.array([0.0, 0.3, 0.0]))
    assert history.radiographic_penetration(moved) == pytest.approx(0.0, abs=1e-12)
    angle = 0.4
    moved = replace(history.last, displacement=frame @ np.array([sin(angle), 5.0, cos(angle)]))
    assert history.radiographic_penetration(moved) == pytest.approx(1.0)
