"""Several hips in one call, tables and figures of a run, and what its terminal and files say of rim and radiograph."""

import csv
import json
from dataclasses import replace
from math import cos, radians, sin
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import WEAR_FACTORS, Archard, logarithmic
from ballsocket.hip.rim import RimDistance, mask_edge_loading
from ballsocket.hip.wear_laws import read_wear_law
from ballsocket.reports.hip_comparison import wear_figure

from ..cli.command import run
from .hips import QUICK, SHORT, TILTED, hip, write_edited_file

pytestmark = pytest.mark.usefixtures("short_film")


@pytest.fixture
def files(tmp_path):
    """Two hips, of which the second has a published wear factor and a scatter of the clearance."""
    text = write_edited_file(tmp_path, *SHORT, ('name = "hip in use"', "")).read_text(encoding="utf-8")
    coefficient = 'coefficient = "1.066e-6 mm^3/(N m)"'
    assert coefficient in text
    scatter = '[uncertainty]\nclearance = {low = "0.05 mm", high = "0.2 mm"}\ncount = 2\n'
    (tmp_path / "a.toml").write_text(text, encoding="utf-8")
    linked = text.replace(coefficient, 'material = "crosslinked-pe"')
    (tmp_path / "b.toml").write_text(f"{linked}\n{scatter}", encoding="utf-8")
    return str(tmp_path / "a.toml"), str(tmp_path / "b.toml")


def read_csv(path):
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def test_two_files_are_side_by_side_in_json_table_csv_and_figure(files, tmp_path):
    out = ["--csv", str(tmp_path / "ab.csv"), "--figure", str(tmp_path / "ab.svg")]
    process = run("hip", *files, *out)
    assert process.returncode == 0, process.stderr
    lines = [line.split() for line in process.stdout.splitlines()]
    reports = [line[:2] for line in lines if line[:1] in (["0.005"], ["0.01"])]
    assert reports[:4] == [["0.005", "a"], ["0.005", "b"], ["0.01", "a"], ["0.01", "b"]]
    text = " ".join(process.stdout.split())
    assert "b: wear factor of crosslinked-pe: 2e-07 mm³/(N m)" in text
    assert "patients" not in text
    rows = read_csv(tmp_path / "ab.csv")
    assert [row["hip"] for row in rows] == ["a", "a", "b", "b"]
    assert float(rows[1]["volume_mm3"]) / float(rows[3]["volume_mm3"]) == pytest.approx(5.33, rel=0.05)
    assert rows[0]["volume_low_mm3"] == ""
    assert float(rows[3]["volume_low_mm3"]) < float(rows[3]["volume_mm3"]) < float(rows[3]["volume_high_mm3"])
    assert (tmp_path / "ab.svg").read_text(encoding="utf-8").count("<svg") == 1
    answer, alone = (json.loads(run("hip", *names, "--json").stdout) for names in (files, files[:1]))
    assert [(result["name"], result["file"]) for result in answer["results"]] == [("a", files[0]), ("b", files[1])]
    assert answer["results"][0]["history"] == alone["history"]
    assert answer["valid"] is all(result["valid"] for result in answer["results"])
    assert answer["results"][1]["laws"]["wear"]["source"].startswith("wear factor of crosslinked-pe")
    assert "results" not in alone
    assert alone["name"] == "a"


def test_a_stated_name_stands_in_table_csv_figure_and_json(files, tmp_path):
    text, named = Path(files[0]).read_text(encoding="utf-8"), []
    for stem, name in {"a": 'name = "conventional 28"\n', "b": 'name = "conventional 28"\n', "c": ""}.items():
        named.append(tmp_path / f"named_{stem}.toml")
        named[-1].write_text(name + text, encoding="utf-8")
    names = ["conventional 28 (named_a)", "conventional 28 (named_b)", "named_c"]
    paths = [str(path) for path in named]
    process = run("hip", *paths, "--csv", str(tmp_path / "n.csv"), "--figure", str(tmp_path / "n.svg"))
    assert process.returncode == 0, process.stderr
    assert all(f"0.01 {name}" in process.stdout for name in names)
    assert list(dict.fromkeys(row["hip"] for row in read_csv(tmp_path / "n.csv"))) == names
    assert all(name in (tmp_path / "n.svg").read_text(encoding="utf-8") for name in names)
    alone = run("hip", paths[0], "--csv", str(tmp_path / "n.csv")).stdout
    assert alone.startswith("conventional 28: R1 14 mm")
    assert "conventional 28," in (tmp_path / "n.csv").read_text(encoding="utf-8")


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


def test_a_flexed_direction_has_no_part_in_the_plane_of_its_view():
    history = hip(**QUICK).after(1e4)
    frame = np.array(history.use.placed.frame)
    moved = replace(history.last, displacement=frame @ np.array([0.0, 0.3, 0.0]))
    assert history.radiographic_penetration(moved) == pytest.approx(0.0, abs=1e-12)
    angle = 0.4
    moved = replace(history.last, displacement=frame @ np.array([sin(angle), 5.0, cos(angle)]))
    assert history.radiographic_penetration(moved) == pytest.approx(1.0)
