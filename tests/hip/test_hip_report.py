"""Report and figures of a wear simulation."""

import json
import re
from dataclasses import replace
from math import radians

import numpy as np
import pytest
from typer.testing import CliRunner

from ballsocket.cli.root import app
from ballsocket.hip import Activity, Mix, logarithmic
from ballsocket.reports.hip_report import write_hip_report

from ..cli.command import run
from .test_file import write_edited_file
from .test_wear import QUICK, hip, walked


def test_a_report_has_figures_and_results(tmp_path):
    file = write_edited_file(
        tmp_path, ("5e6\n", "2e5\n"), ("[1e6, 2e6, 5e6]", "[1e5]"), ("instants = 100", "instants = 24")
    )
    head = '\n[report]\ncustomer = "Acme <Ortho>"\nlogo = "logo.svg"\n'
    file.write_text(file.read_text(encoding="utf-8") + head, encoding="utf-8")
    words = ("hip", str(file), "--report", str(tmp_path / "hip.html"))
    assert "logo.svg" in run(*words).stderr  # refused before the run
    (tmp_path / "logo.svg").write_text("<svg/>", encoding="utf-8")
    done = run("hip", str(file), "--report", str(tmp_path / "hip.html"), "--store", str(tmp_path / "store"))
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "hip.html").read_text(encoding="utf-8")
    assert page.count("data:image/png;base64") == 6
    assert "<h1>Wear of a hip: hip in use</h1>" in page
    assert "<dd>Acme &lt;Ortho&gt;</dd>" in page
    assert "<img class='logo'" in page
    assert "Cross-shear" in page
    assert "mm³ worn and a penetration of" in page
    assert not re.search(r"(src|href)='http", page)
    assert (tmp_path / "store" / "hip_in_use.npz").exists()


def test_a_report_without_contact_has_no_figure(tmp_path):
    write_hip_report(hip(cycle=walked(0.0, 0.0)).after(1e5), tmp_path / "none.html")
    assert "data:image" not in (tmp_path / "none.html").read_text(encoding="utf-8")


def test_an_unwritable_report_is_refused_before_the_run(tmp_path):
    file = str(write_edited_file(tmp_path))
    assert "must end in .html" in run("hip", file, "--report", str(tmp_path / "hip.txt")).stderr
    assert "cannot write hip.html" in run("hip", file, "--report", str(tmp_path / "no" / "hip.html")).stderr


SHORT = (("5e6\n", "1e4\n"), ("[1e6, 2e6, 5e6]", "[]"), ("instants = 100", "instants = 24"))
"""Changes of the example to few cycles and instants."""


def test_results_are_printed_before_the_report_fails(tmp_path, monkeypatch):
    def full(path, *rest):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("ballsocket.reports.hip_report.write_hip_report", full)
    words = ["hip", str(write_edited_file(tmp_path, *SHORT)), "--json"]
    done = CliRunner().invoke(app, [*words, "--report", str(tmp_path / "hip.html")])
    assert isinstance(done.exception, OSError)
    assert json.loads(done.stdout)["history"][0]["cycles"] == 1e4


def test_figures_show_the_results_of_the_run(tmp_path):
    from ballsocket.reports import hip_plots

    walk = Activity(cycle=replace(walked(2000.0, -1.0), n_steps=40), per_year=1e6)
    history = hip(creep=logarithmic(), **QUICK).after(1e5, [5e4])
    lines = hip_plots.penetration_curve(history).axes[0].get_lines()
    assert [line.get_label() for line in lines] == ["penetration", "wear alone", "creep alone", "deepest wear"]
    assert np.asarray(lines[0].get_ydata())[1:] == pytest.approx([report.penetration for report in history.reports])
    mixed = hip_plots.edge_figure(hip(cycle=Mix(activities=(walk, walk)), ring_width=radians(9.0)).after(1e4)).axes[0]
    assert np.isnan(mixed.get_lines()[0].get_ydata()).sum() == 1 + 2 * 20  # where it parts, and lifts off
    assert [label.get_text() for label in mixed.get_xticklabels()] == ["iso-14242-1"] * 2
    curves = {line.get_label(): line.get_ydata() for line in hip_plots.film_figure(history).axes[0].get_lines()}
    film = history.use.film(history.lubricant)
    assert np.asarray(curves["smallest"]) == pytest.approx(1e6 * film.least)
    assert np.asarray(curves["Hamrock-Dowson, smallest"]) == pytest.approx(1e6 * film.comparison)
