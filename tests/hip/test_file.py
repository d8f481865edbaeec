"""Hip files, and the results of the command in JSON, table, report and figures."""

import csv
import json
import re
from dataclasses import replace
from math import acos, cos, degrees, radians, sin
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import ballsocket as bs
from ballsocket.cli.root import app
from ballsocket.hip import WEAR_FACTORS, Activity, Archard, Mix, constrained_share, logarithmic
from ballsocket.hip.config import read_hip, socket_surface
from ballsocket.hip.rim import RimDistance, mask_edge_loading
from ballsocket.hip.wear_laws import read_wear_law
from ballsocket.reports import hip_plots
from ballsocket.reports.hip_comparison import wear_figure

from ..cli.command import answer, printed, refusal
from .hips import COUNTS, QUICK, SHORT, TEXT, TILTED, hip, walked, write_edited_file
from .test_cycle_file import write_table


def read(path, *changes, text=TEXT):
    return read_hip(write_edited_file(path, *changes, text=text))


@pytest.mark.parametrize(("text", "cycles"), [("", 5e6), ("cycles = 1e4\n", 1e4)])
def test_a_file_without_counts_runs_five_million_cycles_with_ten_equal_reports(tmp_path, text, cycles):
    file = read(tmp_path, (COUNTS, text))
    assert file.cycles == cycles
    assert file.report_at == pytest.approx(cycles / 10 * np.arange(1, 11))


@pytest.mark.parametrize("tilt", [30, 89])
def test_tilt_and_inclination_orient_the_cup(tmp_path, tilt):
    changes = (('tilt = "30 deg"', f'{name} = "{tilt} deg"') for name in ("tilt", "inclination"))
    by_tilt, by_inclination = (read(tmp_path, change).use.frame.placed.dome for change in changes)
    assert degrees(acos(by_tilt[2])) == pytest.approx(tilt, abs=1e-5)
    assert by_tilt == pytest.approx(by_inclination)


def test_a_file_reads_a_cycle_table_next_to_it_and_selects_springs_and_a_named_joint(tmp_path):
    write_table(tmp_path / "walk.csv")
    named = read(tmp_path).use.first
    tabular = read(tmp_path, ('name = "iso-14242-1"', 'file = "walk.csv"')).use.first
    assert tabular.volume == pytest.approx(named.volume, rel=5e-3)
    vessel = read(tmp_path, ('contact = "springs"', 'contact = "springs"\nmodel = "vessel"')).use.first
    assert vessel.max_pressure > 1.01 * named.max_pressure
    head, tail = TEXT.split("[joint]")[0], TEXT[TEXT.index("[cup]") :]
    assert read(tmp_path, text=f'{head}joint = "hip-28"\n{tail}').use.joint.ball_radius == 14.0


JOINT_FILE = """
[joint]
head_diameter = 28
clearance = 0.1
liner_thickness = 6
[liner]
material = "uhmwpe"
[cup]
arc_of_cover = "160 deg"
interface = "sliding"
inclination = "40 deg"
[load]
force = "3 kN"
tilt = "30 deg"
"""


def test_a_hip_names_what_it_does_not_use_of_a_joint_file_and_keeps_its_cup(tmp_path):
    (tmp_path / "joint.toml").write_text(JOINT_FILE, encoding="ascii")
    head, tail = TEXT.split("[joint]")[0], TEXT[TEXT.index("[cup]") :]
    tail = re.sub("arc_of_cover.*", "", tail)
    use = read(tmp_path, text=f'{head}joint = "joint.toml"\n{tail}').use
    assert (use.cup.arc_of_cover, use.cup.inclination) == pytest.approx((radians(160), radians(30)))
    assert use.notes[0] == "force and tilt of the load in the joint file: not used, because the cycle loads the hip"
    bonded, real = (replace(use, surface=socket_surface(name)) for name in ("shell", "cup"))
    notes = [str(model.contact_model.validity) for model in (use, bonded, real)]
    assert ["the liner slides on its backing" in note for note in notes] == [True, True, False]
    assert read(tmp_path, text=f'{head}joint = "hip-28"\n{tail}').use.notes == use.notes[1:]


def test_a_file_states_laws_creep_and_film(tmp_path):
    energy = ('law = "archard"', 'law = "energy"\nfriction = 0.05\nball_coefficient = "1e-6 mm^3/J"')
    use = read(tmp_path, energy, ("1.066e-6 mm^3/(N m)", "2e-2 mm^3/kJ")).use
    assert (use.wear.coefficient, use.wear.friction) == (pytest.approx(2e-5), 0.05)
    assert use.ball_wear.coefficient == pytest.approx(1e-6)
    file = read(tmp_path, text=f'{TEXT}\n[creep]\n[film]\ncup_roughness = "0.5 um"\nfriction = 0.04\n')
    assert (len(file.use.creep.times), file.use.creep.confinement) == (9, 1.0)
    assert file.lubricant.cup_roughness == pytest.approx(5e-4)
    walls = read(tmp_path, text=f'{TEXT}\n[creep]\nconfinement = "constrained"\n')
    assert walls.use.creep.confinement == constrained_share(0.4)
    chain = "[creep]\ncompliances = [1e-3, 2e-3]\ntimes = [60, 3600]\nseconds_per_cycle = 3\n"
    use = read(tmp_path, text=f"{TEXT}\n{chain}").use
    assert (use.creep.times, use.seconds) == ((60.0, 3600.0), 3.0)


def read_csv(path):
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def test_json_has_the_results_of_python(solved_file):
    folder, answer = solved_file
    file = read_hip(folder / "hip.toml")
    use, history = file.use, file.use.after(file.cycles, file.report_at, store=folder / "store")
    expected = {
        "slide_mm": use.frame.slide,
        "pressure_slide_integral_Nm": use.first.work,
        "cross_shear_mean": use.first.cross_shear,
        "crossing_angle_mean_deg": degrees(use.crossing_angle),
    }
    assert {name: answer["cycle"][name] for name in expected} == pytest.approx(expected, rel=1e-9)
    peaks = answer["cycle"]["peaks"]
    assert peaks["force_N"] == pytest.approx(use.first.max_force, rel=1e-9)
    assert peaks["speed_mm_s"] == pytest.approx(14.0 * 2 * np.pi * 0.375, rel=0.1)  # R ω of flexion
    initial = {"wear_mm3_per_Mc": use.first.volume, "depth_mm_per_Mc": use.first.depth}
    assert answer["initial"] == pytest.approx(initial, rel=1e-9)
    assert [report["cycles"] for report in answer["history"]] == [5e3, 1e4]
    for stated, report in zip(answer["history"], history.reports, strict=True):
        for name in ("volume", "depth", "penetration", "max_pressure", "creep_depth"):
            assert stated[name] == pytest.approx(getattr(report, name), rel=1e-6)
    assert answer["error"]["volume"] == pytest.approx(history.error.volume, rel=1e-6)
    assert answer["valid"] is history.valid
    assert set(history.notes) <= set(answer["notes"])


def test_a_report_has_figures_and_results_and_stands_alone(solved_file):
    folder, answer = solved_file
    page = (folder / "hip.html").read_text(encoding="utf-8")
    assert page.count("data:image/png;base64") == 6
    for text in ("<h1>Wear of a hip: hip in use</h1>", "<dd>Acme &lt;Ortho&gt;</dd>", "<img class='logo'"):
        assert text in page
    assert not re.search(r"(src|href)='http", page)
    assert (folder / "store" / "hip_in_use.npz").exists()
    (*_, last) = read_csv(folder / "hip.csv")
    assert float(last["volume_mm3"]) == pytest.approx(answer["history"][-1]["volume"], rel=1e-4)


def test_results_are_printed_before_the_report_fails(tmp_path, monkeypatch):
    def fail(path, *rest):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("ballsocket.reports.hip_report.hip_report", fail)
    words = ["hip", str(write_edited_file(tmp_path, *SHORT)), "--json", "--report", str(tmp_path / "hip.html")]
    result = CliRunner().invoke(app, words)
    assert isinstance(result.exception, OSError)
    assert json.loads(result.stdout)["history"][-1]["cycles"] == 1e4


def test_a_missing_logo_is_refused(tmp_path):
    file = write_edited_file(tmp_path, text=f'{TEXT}\n[report]\nlogo = "logo.svg"\n')
    assert "logo.svg" in refusal("hip", str(file), "--report", str(tmp_path / "a.html"))


def test_figures_show_the_results_of_the_run():
    walk = Activity(cycle=replace(walked(2000.0, -1.0), n_steps=40), per_year=1e6)
    history = hip(creep=logarithmic(), **QUICK).after(1e5, [5e4])
    lines = hip_plots.penetration_curve(history).axes[0].get_lines()
    assert [line.get_label() for line in lines] == ["penetration", "wear alone", "creep alone", "deepest wear"]
    assert np.asarray(lines[0].get_ydata())[1:] == pytest.approx([report.penetration for report in history.reports])
    mixed = hip_plots.edge_figure(hip(cycle=Mix(activities=(walk, walk)), ring_width=0.15).after(1e4)).axes[0]
    assert np.isnan(mixed.get_lines()[0].get_ydata()).sum() == 1 + 2 * 20  # where it parts, and lifts off
    assert [label.get_text() for label in mixed.get_xticklabels()] == ["iso-14242-1"] * 2
    film = history.use.film()
    curves = hip_plots.film_figure(history.use, film).axes[0].get_lines()
    curves = {line.get_label(): line.get_ydata() for line in curves}
    assert np.asarray(curves["smallest"]) == pytest.approx(1e6 * film.least)
    assert np.asarray(curves["Hamrock-Dowson, smallest"]) == pytest.approx(1e6 * film.comparison)


# several hips in one call, and results that terminal, files and figures state


@pytest.fixture
def files(tmp_path):
    """Two hips, of which the second has a published wear factor and a scatter of the clearance."""
    text = write_edited_file(tmp_path, *SHORT, ('name = "hip in use"', "")).read_text(encoding="utf-8")
    (tmp_path / "a.toml").write_text(text, encoding="utf-8")
    linked = text.replace('coefficient = "1.066e-6 mm^3/(N m)"', 'material = "crosslinked-pe"')
    scatter = '[uncertainty]\nclearance = {low = "0.05 mm", high = "0.2 mm"}\ncount = 2\n'
    (tmp_path / "b.toml").write_text(f"{linked}\n{scatter}", encoding="utf-8")
    return str(tmp_path / "a.toml"), str(tmp_path / "b.toml")


def test_two_files_are_side_by_side_in_json_table_csv_and_figure(files, tmp_path):
    out = ["--csv", str(tmp_path / "ab.csv"), "--figure", str(tmp_path / "ab.svg")]
    shown = printed("hip", *files, *out)
    lines = [line.split() for line in shown.splitlines()]
    reports = [line[:2] for line in lines if line[:1] in (["0.005"], ["0.01"])]
    assert reports[:4] == [["0.005", "a"], ["0.005", "b"], ["0.01", "a"], ["0.01", "b"]]
    assert "b: wear factor of crosslinked-pe: 2e-07 mm³/(N m)" in " ".join(shown.split())
    rows = read_csv(tmp_path / "ab.csv")
    assert [row["hip"] for row in rows] == ["a", "a", "b", "b"]
    assert float(rows[1]["volume_mm3"]) / float(rows[3]["volume_mm3"]) == pytest.approx(5.33, rel=0.05)
    assert rows[0]["volume_low_mm3"] == ""
    assert float(rows[3]["volume_low_mm3"]) < float(rows[3]["volume_mm3"]) < float(rows[3]["volume_high_mm3"])
    assert (tmp_path / "ab.svg").read_text(encoding="utf-8").count("<svg") == 1
    both, alone = (answer("hip", *names) for names in (files, files[:1]))
    assert [(result["name"], result["file"]) for result in both["results"]] == [("a", files[0]), ("b", files[1])]
    assert both["results"][0]["history"] == alone["history"]
    assert both["valid"] is all(result["valid"] for result in both["results"])
    assert both["results"][1]["laws"]["wear"]["source"].startswith("wear factor of crosslinked-pe")
    assert "results" not in alone
    assert alone["name"] == "a"


def test_a_stated_name_stands_in_table_csv_and_figure(files, tmp_path):
    text, paths = Path(files[0]).read_text(encoding="utf-8"), []
    for stem, name in {"a": 'name = "conventional 28"\n', "b": 'name = "conventional 28"\n', "c": ""}.items():
        paths.append(str(tmp_path / f"named_{stem}.toml"))
        Path(paths[-1]).write_text(name + text, encoding="utf-8")
    names = ["conventional 28 (named_a)", "conventional 28 (named_b)", "named_c"]
    shown = printed("hip", *paths, "--csv", str(tmp_path / "n.csv"), "--figure", str(tmp_path / "n.svg"))
    figure = (tmp_path / "n.svg").read_text(encoding="utf-8")
    assert all(name in " ".join(shown.split()) and name in figure for name in names)
    assert list(dict.fromkeys(row["hip"] for row in read_csv(tmp_path / "n.csv"))) == names
    assert printed("hip", paths[0]).startswith("conventional 28: R1 14 mm")


def test_a_history_is_a_frame_and_a_figure():
    history = hip(**QUICK).after(2e4, [1e4])
    frame = history.to_frame()
    assert frame["volume_mm3"].tolist() == [report.volume for report in history.reports]
    assert frame["cycles"].tolist() == [1e4, 2e4]
    assert "penetration" in history.plot().axes[1].get_ylabel()
    assert len(wear_figure([history, history]).axes[0].lines) == 2
    assert len(history.table().rows) == 2


def test_the_radiograph_shows_the_displacement_in_the_frontal_plane():
    """Of an anteverted cup it lacks the part to the front; the length is that of the two other components."""
    cup = bs.Cup(inclination=radians(45.0), anteversion=radians(30.0))
    history = hip(cup=cup, creep=logarithmic(), **QUICK).after(1e4)
    frame = np.array(history.use.frame.placed.frame)
    body = frame.T @ history.last.displacement
    assert history.radiographic_displacement(history.last) == pytest.approx(body[[0, 2]])
    for moved, length in (([0.0, 0.3, 0.0], 0.0), ([sin(0.4), 5.0, cos(0.4)], 1.0)):
        report = replace(history.last, displacement=frame @ np.array(moved))
        assert history.radiographic_penetration(report) == pytest.approx(length, abs=1e-12)
    upright = hip(cup=TILTED, **QUICK).after(1e4)
    lateral, upward = upright.radiographic_displacement(upright.last)
    assert upward == pytest.approx(upright.last.penetration, rel=0.05)  # the load is upwards
    assert abs(lateral) < 0.2 * upward
    entry = history.summary()["history"][-1]
    assert entry["radiographic_penetration"] == pytest.approx(np.hypot(*entry["radiographic_vector"]))


def test_edge_loading_is_a_load_near_the_rim_or_the_largest_pressure_there_and_no_bore_worn_to_it():
    worn = hip(wear=Archard(coefficient=1e-5), **QUICK).after(1e6, [5e5, 1e6])
    edges = [report["edge"] for report in worn.summary()["history"]]
    edge, highest = edges[-1], max(edge["pressure_at_rim_MPa"] for edge in edges)
    assert (edge["kind"], edge["instants_edge_loaded"], edge["instants_at_rim"]) == ("worn to the rim", 0, 16)
    (note,) = (note for note in worn.notes if "rim" in note)
    assert note.startswith("worn to the rim: after 500000 cycles the worn bore fits the ball")
    assert note.endswith(f"the pressure in the outermost ring is at most {highest:.3g} MPa")
    assert "this is not edge loading" in note
    at_rim = RimDistance(distance=np.array([0.0, 0.0, 1.0]), azimuth=np.zeros(3), pressure=np.full(3, 5.0))
    clear = replace(at_rim, distance=np.array([1.0, 0.0, 2.0]), pressure=np.zeros(3))
    assert mask_edge_loading(at_rim, clear, 9.0).tolist() == [False, True, False]
    assert mask_edge_loading(at_rim, clear, 5.0).tolist() == [True, True, False]


def test_a_material_gives_its_published_factor_with_the_source():
    law = read_wear_law({"material": "crosslinked-pe"})
    assert law == Archard.of_material("crosslinked-pe")
    assert law.coefficient == WEAR_FACTORS["crosslinked-pe"].value == 2e-7
    assert "range 1e-07 mm³/(N m) to 4e-07 mm³/(N m)" in law.notes[0]
    assert law.with_coefficient(1e-7) == Archard(coefficient=1e-7)
    for factor in WEAR_FACTORS.values():
        assert factor.low < factor.value < factor.high
        assert factor.source
