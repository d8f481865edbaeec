"""A run that is stopped goes on; what it is kept in; the page of a run."""

import json
import re
from dataclasses import replace
from math import radians

import numpy as np
import pytest
from typer.testing import CliRunner

from ballsocket.cli.root import app
from ballsocket.hip import Activity, Archard, CustomWearLaw, Mix, logarithmic
from ballsocket.output.hip_report import write_hip_report

from ..cli.command import run
from .test_file import told
from .test_wear import K, hip, walked


class KilledError(Exception):
    pass


def killed_after(blocks):
    def listen(done):
        nonlocal blocks
        blocks -= 1
        if blocks == 0:
            raise KilledError

    return listen


@pytest.mark.parametrize("creep", [None, logarithmic()])
def test_a_run_that_is_killed_goes_on_and_ends_the_same(tmp_path, creep):
    use, at = hip(creep=creep), [1e5, 3e5]
    whole = use.after(4e5, at)
    with pytest.raises(KilledError):
        use.after(4e5, at, progress=killed_after(6), store=tmp_path)
    seen = []
    again = use.after(4e5, at, progress=seen.append, store=tmp_path)
    assert len(seen) == whole.steps - 6  # no block is lost
    assert again.steps == whole.steps
    for one, other in zip(whole.reports, again.reports, strict=True):
        assert other.cycles == one.cycles
        assert other.volume == pytest.approx(one.volume, rel=1e-6)
        assert other.wear == pytest.approx(one.wear, abs=1e-6 * one.depth)
        assert other.creep_depth == pytest.approx(one.creep_depth, rel=1e-5)
        assert other.max_pressure == pytest.approx(one.max_pressure, rel=1e-6)


def test_what_is_done_is_not_done_again_and_more_is_added(tmp_path):
    use = hip()
    first = use.after(2e5, store=tmp_path)
    seen = []
    assert use.after(2e5, progress=seen.append, store=tmp_path).last.volume == first.last.volume
    assert not seen
    longer = use.after(4e5, [2e5], store=tmp_path)
    assert longer.reports[0].volume == first.last.volume
    assert longer.last.volume == pytest.approx(use.after(4e5).last.volume, rel=1e-3)
    with pytest.raises(ValueError, match="the store has reached 400000 cycles without a report at 100000"):
        use.after(4e5, [1e5], store=tmp_path)


def test_another_run_and_what_is_none_are_refused(tmp_path):
    hip().after(1e4, store=tmp_path)
    with pytest.raises(ValueError, match="keeps another run: another hip, cycle or law"):
        hip(wear=Archard(coefficient=2 * K)).after(1e4, store=tmp_path)
    (tmp_path / "hip_in_use.npz").write_bytes(b"no archive")
    with pytest.raises(ValueError, match="hip_in_use.npz is not a run that was kept; remove it to begin anew"):
        hip().after(1e4, store=tmp_path)


def test_a_law_of_ones_own_is_not_kept(tmp_path):
    with pytest.raises(ValueError, match="runs with a CustomWearLaw cannot be stored"):
        hip(wear=CustomWearLaw(function=lambda cycle: 1e-9 * cycle.work)).after(1e4, store=tmp_path)


def test_the_page_of_a_run(tmp_path):
    file = told(tmp_path, ("5e6\n", "2e5\n"), ("[1e6, 2e6, 5e6]", "[1e5]"))
    done = run("hip", str(file), "--report", str(tmp_path / "hip.html"), "--store", str(tmp_path / "kept"))
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "hip.html").read_text(encoding="utf-8")
    assert page.count("data:image/png;base64") == 6
    assert "Cross-shear" in page
    assert "mm³ worn and a penetration of" in page
    assert not re.search(r"(src|href)='http", page)
    assert (tmp_path / "kept" / "hip_in_use.npz").exists()


def test_a_page_of_nothing_that_is_pressed(tmp_path):
    write_hip_report(hip(cycle=walked(0.0, 0.0)).after(1e5), tmp_path / "none.html")
    assert "data:image" not in (tmp_path / "none.html").read_text(encoding="utf-8")


def test_a_page_that_cannot_be_written_is_said_before_the_run(tmp_path):
    file = str(told(tmp_path))
    assert "must end in .html" in run("hip", file, "--report", str(tmp_path / "hip.txt")).stderr
    assert (
        "is no folder to write hip.html into" in run("hip", file, "--report", str(tmp_path / "no" / "hip.html")).stderr
    )


def test_a_page_on_a_full_disk_takes_no_answer_with_it(tmp_path, monkeypatch):
    def full(path, *rest):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("ballsocket.cli.hip.write_hip_report", full)
    words = ["hip", str(told(tmp_path, ("5e6\n", "1e4\n"), ("[1e6, 2e6, 5e6]", "[]"))), "--json"]
    done = CliRunner().invoke(app, [*words, "--report", str(tmp_path / "hip.html")])
    assert isinstance(done.exception, OSError)
    assert json.loads(done.stdout)["history"][0]["cycles"] == 1e4


def test_figures_show_what_the_run_has(tmp_path):
    from ballsocket.output import hip_plots

    walk = Activity(cycle=replace(walked(2000.0, -1.0), n_steps=40), per_year=1e6)
    history = hip(creep=logarithmic()).after(1e5, [5e4])
    lines = hip_plots.penetration_curve(history).axes[0].get_lines()
    assert [line.get_label() for line in lines] == ["penetration", "wear alone", "creep alone", "deepest wear"]
    assert np.asarray(lines[0].get_ydata())[1:] == pytest.approx([report.penetration for report in history.reports])
    mixed = hip_plots.edge_figure(hip(cycle=Mix(activities=(walk, walk)), ring_width=radians(9.0)).after(1e4)).axes[0]
    assert np.isnan(mixed.get_lines()[0].get_ydata()).sum() == 1 + 2 * 20  # where it parts, and lifts off
    assert [label.get_text() for label in mixed.get_xticklabels()] == ["iso-14242-1"] * 2
    film = hip_plots.film_figure(history).axes[0].get_lines()[0]
    assert np.asarray(film.get_ydata()) == pytest.approx(1e6 * history.use.film(history.lubricant).least)
