"""Hip files, and the results of the command in JSON, table, report and figures."""

import csv
import json
import re
from dataclasses import replace
from math import acos, degrees

import numpy as np
import pytest
from typer.testing import CliRunner

from ballsocket.cli.root import app
from ballsocket.hip import Activity, Mix, constrained_share, logarithmic
from ballsocket.hip.config import read_hip
from ballsocket.reports import hip_plots

from ..cli.command import run
from ..places import EXAMPLES
from .hips import QUICK, SHORT, TEXT, hip, walked, write_edited_file
from .test_cycle_file import write_table

# files


def test_a_file_without_counts_runs_five_million_cycles_with_ten_equal_reports(tmp_path):
    counts = "cycles = 5e6\nreport_at = [1e6, 2e6, 5e6]\n"
    file = read_hip(write_edited_file(tmp_path, (counts, "")))
    assert file.cycles == 5e6
    assert file.report_at == pytest.approx([5e5 * number for number in range(1, 11)])
    short = read_hip(write_edited_file(tmp_path, (counts, "cycles = 1e4\n")))
    assert short.report_at == pytest.approx([1e3 * number for number in range(1, 11)])


def test_tilt_and_inclination_orient_the_cup(tmp_path):
    for tilt in (0, 30, 89):
        by_tilt, by_inclination = (
            read_hip(write_edited_file(tmp_path, ('tilt = "30 deg"', f'{name} = "{tilt} deg"'))).use.placed
            for name in ("tilt", "inclination")
        )
        assert degrees(acos(by_tilt.dome[2])) == pytest.approx(tilt, abs=1e-5)
        assert by_tilt.dome == pytest.approx(by_inclination.dome)


def test_file_reads_a_cycle_table_next_to_it(tmp_path):
    write_table(tmp_path / "walk.csv")
    tabular = read_hip(write_edited_file(tmp_path, ('name = "iso-14242-1"', 'file = "walk.csv"')))
    named = read_hip(write_edited_file(tmp_path))
    assert tabular.use.first.volume == pytest.approx(named.use.first.volume, rel=5e-3)


def test_file_selects_the_springs_of_a_model(tmp_path):
    vessel = read_hip(write_edited_file(tmp_path, ('contact = "springs"', 'contact = "springs"\nmodel = "vessel"')))
    assert vessel.use.first.max_pressure > 1.01 * read_hip(write_edited_file(tmp_path)).use.first.max_pressure


def test_file_accepts_the_name_of_a_joint(tmp_path):
    head, tail = TEXT.split("[joint]")[0], TEXT[TEXT.index("[cup]") :]
    named = read_hip(write_edited_file(tmp_path, text=f'{head}joint = "hip-28"\n{tail}'))
    assert named.use.joint.ball_radius == 14.0


def test_file_reads_the_energy_law_and_ball_wear(tmp_path):
    energy = ('law = "archard"', 'law = "energy"\nfriction = 0.05\nball_coefficient = "1e-6 mm^3/J"')
    use = read_hip(write_edited_file(tmp_path, energy, ("1.066e-6 mm^3/(N m)", "2e-2 mm^3/kJ"))).use
    assert (use.wear.coefficient, use.wear.friction) == (pytest.approx(2e-5), 0.05)
    assert use.ball_wear.coefficient == pytest.approx(1e-6)


def test_file_reads_creep_and_film(tmp_path):
    film = '[film]\nviscosity = 1e-3\ncup_roughness = "0.5 um"\nfriction = 0.04\n'
    file = read_hip(write_edited_file(tmp_path, text=f"{TEXT}\n[creep]\n{film}"))
    assert len(file.use.creep.times) == 9
    assert file.use.creep.confinement == 1.0
    assert file.lubricant.cup_roughness == pytest.approx(5e-4)
    walls = read_hip(write_edited_file(tmp_path, text=f'{TEXT}\n[creep]\nconfinement = "constrained"\n'))
    assert walls.use.creep.confinement == constrained_share(0.4)
    chain = "[creep]\ncompliances = [1e-3, 2e-3]\ntimes = [60, 3600]\nseconds_per_cycle = 3\n"
    file = read_hip(write_edited_file(tmp_path, text=f"{TEXT}\n{chain}"))
    assert (file.use.creep.times, file.use.seconds) == ((60.0, 3600.0), 3.0)


# results


def test_json_has_the_results_of_python(solved_file):
    folder, answer = solved_file
    file = read_hip(folder / "hip.toml")
    use, history = file.use, file.use.after(file.cycles, file.report_at)
    expected = {
        "slide_mm": use.slide,
        "pressure_slide_integral_Nm": use.first.work,
        "cross_shear_mean": use.first.cross_shear,
        "crossing_angle_mean_deg": degrees(use.crossing_angle),
    }
    assert {name: answer["cycle"][name] for name in expected} == pytest.approx(expected, rel=1e-9)
    assert answer["cycle"]["peaks"]["force_N"] == pytest.approx(use.first.max_force, rel=1e-9)
    assert answer["cycle"]["peaks"]["speed_mm_s"] == pytest.approx(14.0 * 2 * np.pi * 0.375, rel=0.1)  # R ω of flexion
    initial = {"wear_mm3_per_Mc": use.first.volume, "depth_mm_per_Mc": use.first.depth}
    assert answer["initial"] == pytest.approx(initial, rel=1e-9)
    assert [report["cycles"] for report in answer["history"]] == [5e3, 1e4]
    for stated, report in zip(answer["history"], history.reports, strict=True):
        for name in ("volume", "depth", "penetration", "max_pressure", "creep_depth"):
            assert stated[name] == pytest.approx(getattr(report, name), rel=1e-6)
    assert answer["error"]["volume"] == pytest.approx(history.error.volume, rel=1e-6)
    assert answer["valid"] is history.valid
    assert set(history.notes) <= set(answer["notes"])


@pytest.mark.long
def test_command_runs_five_million_cycles():
    answer = json.loads(run("hip", str(EXAMPLES / "hip_in_use.toml"), "--json").stdout)
    seen = {report["cycles"]: report for report in answer["history"]}
    assert list(seen) == [1e6, 2e6, 5e6]
    assert seen[5e6]["volume"] == pytest.approx(181.6, rel=1e-2)
    assert seen[5e6]["depth"] == pytest.approx(0.392, rel=2e-2)
    assert 0 < answer["error"]["volume"] < 5e-3


def test_the_table_shows_the_numbers_and_assumptions_of_the_run(solved_file, short_film):
    folder, answer = solved_file
    process = run("hip", str(folder / "hip.toml"), "--store", str(folder / "store"))
    assert process.returncode == 0
    text = " ".join(process.stdout.split())
    shown = {name: re.search(rf"{name} ([0-9.]+)", text)[1] for name in ("slide", "cross-shear")}
    assert float(shown["slide"]) == pytest.approx(answer["cycle"]["slide_mm"], rel=5e-3)
    assert float(shown["cross-shear"]) == pytest.approx(answer["cycle"]["cross_shear_mean"], abs=1e-3)
    rows = [line.split() for line in process.stdout.splitlines() if line.split()[:1] in (["0.005"], ["0.01"])]
    volumes = [report["volume"] for report in answer["history"]]
    assert [float(row[1]) for row in rows[:2]] == pytest.approx(volumes, rel=5e-3)
    assert "creep" not in text
    assert "assumed for the film: viscosity 2.5 mPa s, roughness Ra 0.02 µm (ball) and 1 µm (cup)" in text
    assert "penetration in a radiograph from the front, by wear:" in text


def test_a_report_has_figures_and_results_and_stands_alone(solved_file):
    folder, answer = solved_file
    page = (folder / "hip.html").read_text(encoding="utf-8")
    assert page.count("data:image/png;base64") == 7
    assert "<h1>Wear of a hip: hip in use</h1>" in page
    assert "<dd>Acme &lt;Ortho&gt;</dd>" in page
    assert "<img class='logo'" in page
    assert "Cross-shear" in page
    assert "mm³ worn and a penetration of" in page
    assert not re.search(r"(src|href)='http", page)
    assert (folder / "store" / "hip_in_use.npz").exists()
    (*_, last) = csv.DictReader((folder / "hip.csv").read_text(encoding="utf-8").splitlines())
    assert float(last["volume_mm3"]) == pytest.approx(answer["history"][-1]["volume"], rel=1e-4)


def test_results_are_printed_before_the_report_fails(tmp_path, monkeypatch, short_film):
    def fail(path, *rest):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("ballsocket.reports.hip_report.write_hip_report", fail)
    words = ["hip", str(write_edited_file(tmp_path, *SHORT)), "--json"]
    result = CliRunner().invoke(app, [*words, "--report", str(tmp_path / "hip.html")])
    assert isinstance(result.exception, OSError)
    assert json.loads(result.stdout)["history"][-1]["cycles"] == 1e4


def test_figures_show_the_results_of_the_run(short_film):
    walk = Activity(cycle=replace(walked(2000.0, -1.0), n_steps=40), per_year=1e6)
    history = hip(creep=logarithmic(), **QUICK).after(1e5, [5e4])
    lines = hip_plots.penetration_curve(history).axes[0].get_lines()
    assert [line.get_label() for line in lines] == ["penetration", "wear alone", "creep alone", "deepest wear"]
    assert np.asarray(lines[0].get_ydata())[1:] == pytest.approx([report.penetration for report in history.reports])
    mixed = hip_plots.edge_figure(hip(cycle=Mix(activities=(walk, walk)), ring_width=0.15).after(1e4)).axes[0]
    assert np.isnan(mixed.get_lines()[0].get_ydata()).sum() == 1 + 2 * 20  # where it parts, and lifts off
    assert [label.get_text() for label in mixed.get_xticklabels()] == ["iso-14242-1"] * 2
    curves = {line.get_label(): line.get_ydata() for line in hip_plots.film_figure(history).axes[0].get_lines()}
    film = history.use.film(history.lubricant)
    assert np.asarray(curves["smallest"]) == pytest.approx(1e6 * film.least)
    assert np.asarray(curves["Hamrock-Dowson, smallest"]) == pytest.approx(1e6 * film.comparison)
