"""Simulated patient cohorts: samples, pieces, the store and its resumption, and the table of patients."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.executors import Processes
from ballsocket.hip import population, read_hip
from ballsocket.hip.cohort import CohortRun, cohort_store, sample_patients, table_columns, write_csv
from ballsocket.hip.variability import RESULT_UNITS, CohortResult
from ballsocket.studies import LogNormal, Rectangular

from ..cli.command import answer, printed
from ..processes import stopped_program
from .hips import QUICK, K, hip, refuses
from .test_uncertainty import short_file
from .test_variability import COEFFICIENT, FEW_CYCLES, TIGHT, WEIGHT, variability


def cohort_run(n_patients, patients=None, counts=(FEW_CYCLES,)):
    patients = patients or variability(clearance=TIGHT)
    return CohortRun(variability=patients, counts=counts, values=sample_patients(patients, n_patients, 0))


def test_more_patients_keep_the_first_ones():
    one = variability(clearance=TIGHT, body_weight=WEIGHT)
    few, more = sample_patients(one, 5, 3), sample_patients(one, 9, 3)
    for name in ("clearance", "body_weight"):
        np.testing.assert_array_equal(more[name][:5], few[name])
    assert (sample_patients(one, 5, 4)["clearance"] != few["clearance"]).any()


def test_a_patient_without_a_result_has_its_error_and_a_worker_of_another_version_is_refused():
    run = cohort_run(4, variability(tilt=Rectangular(low=0.0, high=2.0)))
    cohort = replace(run, values={"tilt": np.array([0.1, 1.9, 0.1])}).simulate()
    assert [bool(error) for error in cohort.refused] == [False, True, False]
    assert np.isnan(cohort.table[1]).all()
    assert np.isnan(cohort.contact[1]).all()
    np.testing.assert_array_equal(cohort.table[0], cohort.table[2])
    assert np.isfinite(cohort.table[0]).all()
    assert (cohort.table.shape, cohort.contact.shape) == ((3, 1, len(RESULT_UNITS)), (3, 2, 3))
    refuses("the run was started by 0.9[+]old", replace(cohort_run(1), code="0.9+old"), 0)


def test_stored_patients_are_not_simulated_again(tmp_path, monkeypatch):
    one, calls, finished = variability(clearance=TIGHT), [], []

    def simulate(self, number):
        calls.append(number)
        return np.full((1, len(RESULT_UNITS)), float(number)), np.ones((2, 2)), "dislocated: µ" * (number == 3)

    monkeypatch.setattr(CohortRun, "_simulate_patient", simulate)
    store = cohort_store(tmp_path / "store", one, [FEW_CYCLES], 0)
    first = cohort_run(20).simulate(store=store).table
    assert calls == list(range(20))
    (tmp_path / "store" / "patients_000000.npz").write_bytes(b"damaged")
    calls.clear()
    more = cohort_run(40).simulate(store=store, progress=finished.append).table
    assert sorted(calls) == list(range(40))  # the first piece is damaged, the second one was incomplete
    assert finished == [0, 16, 32, 40]
    np.testing.assert_array_equal(more[:20], first)
    calls.clear()
    again = cohort_run(40).simulate(store=store)
    np.testing.assert_array_equal(again.table, more)
    assert {number: text for number, text in enumerate(again.refused) if text} == {3: "dislocated: µ"}
    np.testing.assert_array_equal(cohort_run(32).simulate(store=store, progress=finished.append).table, more[:32])
    assert calls == []
    assert finished[4:] == [32]


def test_another_cohort_is_refused(tmp_path):
    one, none = variability(coefficient=COEFFICIENT), tmp_path / "none"
    with pytest.raises(ValueError, match="patients = 0 is not allowed"):
        population(one, [FEW_CYCLES], patients=0, store=cohort_store(none, one, [FEW_CYCLES], 0))
    assert not none.exists()
    cohort_store(tmp_path, one, [FEW_CYCLES], 0).create()
    cohort_store(tmp_path, one, [FEW_CYCLES], 0)
    others = [
        (variability(coefficient=LogNormal(median=K, factor=2.0)), [FEW_CYCLES], 0),
        (replace(one, body_weight=800.0), [FEW_CYCLES], 0),
        (variability(hip(**QUICK, clearance=0.2), coefficient=COEFFICIENT), [FEW_CYCLES], 0),
        (one, [2 * FEW_CYCLES], 0),
        (one, [FEW_CYCLES], 1),
    ]
    for other in others:
        refuses("has another cohort, or one of another version; choose another folder", cohort_store, tmp_path, *other)
    for content in (b"", b"[]", b"3", b"{}", b"\xff"):
        (tmp_path / "patients.json").write_bytes(content)
        with pytest.raises(ValueError, match="patients.json is not the label of a patient cohort; delete it"):
            cohort_store(tmp_path, one, [FEW_CYCLES], 0)


def test_the_table_has_a_row_for_each_patient(tmp_path):
    values = {"clearance": [0.1, 0.2], "tilt": [0.0, np.pi / 6], "cycles_per_year": [1e6, 2e6]}
    values = {name: np.array(numbers) for name, numbers in values.items()}
    one = variability(clearance=TIGHT, tilt=Rectangular(low=0.0, high=1.0), cycles_per_year=TIGHT)
    run = CohortRun(variability=one, counts=(1e3, 5e6), values=values)
    table = np.arange(24.0).reshape(2, 2, 6)
    table[1, 0, 3] = np.nan
    contact = np.array([[[0.1, 1, 0], [0.3, 1, 0], [0.2, 1, 1]], [[0.5, 1, 0], [0.4, 0, 0], [0.6, 1, 0]]])
    cohort = CohortResult(table=table, refused=np.array(["", ""]), contact=contact)
    columns = {name: numbers.tolist() for name, numbers in table_columns(run, cohort)}
    assert list(columns)[:4] == ["clearance_mm", "tilt_deg", "cycles_per_year", "volume_mm3_at_1000"]
    assert columns["tilt_deg"] == pytest.approx([0.0, 30.0])
    assert columns["max_pressure_MPa_at_5e+06"] == [9.0, 21.0]
    assert columns["peak_utilisation_at_1000"] == [0.3, 0.5]
    assert columns["peak_utilisation_at_5e+06"] == [0.3, 0.6]
    assert columns["valid_at_5e+06"] == columns["edge_loaded_at_5e+06"] == [1.0, 0.0]
    assert len(columns) == 3 + 2 * (len(RESULT_UNITS) + 3)
    names, first, second = write_csv(tmp_path / "a.csv", run, cohort).read_text(encoding="utf-8").splitlines()
    assert names.split(",") == list(columns)
    assert first.split(",")[:5] == ["0.1", "0", "1000000", "0", "1"]
    assert second.split(",")[:7] == ["0.2", "30", "2000000", "12", "13", "14", ""]


@pytest.mark.long
def test_a_cohort_with_the_real_cup_states_its_foundation(tmp_path):
    path = short_file(tmp_path, ("[uncertainty]", '[uncertainty]\ncontact = "cup"'))
    settings = read_hip(path).uncertain
    assert settings.variability.surface == bs.RealCup()
    on_cup = replace(settings.variability, use=hip(**QUICK), distributions={"clearance": TIGHT})
    _, bands = population(on_cup, [FEW_CYCLES], patients=2)
    assert bands.n_failed == 0
    assert "the bands are for full elasticity (RealCup) on rings of 6°" in bands.notes
    _, springs = population(replace(on_cup, surface=None), [FEW_CYCLES], patients=2)
    assert bands.cohort.table[:, 0, 0] == pytest.approx(springs.cohort.table[:, 0, 0], rel=0.01)
    assert not any("full elasticity" in note for note in springs.notes)


def test_the_command_stores_every_patient(tmp_path):
    file = short_file(tmp_path, ("instants = 16", "instants = 40"))  # more than the coarse simulation of a patient
    said = answer("hip", str(file), "--patients", "5", "--store", str(tmp_path / "store"))
    names, *rows = (tmp_path / "store" / "patients.csv").read_text(encoding="utf-8").splitlines()
    assert names.startswith("coefficient,clearance_mm,volume_mm3_at_5000,")
    assert len(rows) == 5
    volumes = [float(row.split(",")[2]) for row in rows]
    assert said["bands"][0]["volume"]["median"] == pytest.approx(np.median(volumes), rel=1e-6)
    assert 0 < said["uncertainty"]["quick_run_off"]["volume"] < 0.01
    assert said["valid"] is True


def test_the_command_prints_bands_uncut_and_reasons_of_invalid_contacts(tmp_path):
    """In 80 columns, with springs outside the range of their formula."""
    path = short_file(tmp_path, ('liner_thickness = "8 mm"', 'liner_thickness = "1.2 mm"'))
    words = "hip", str(path), "--patients", "4"
    shown = printed(*words, columns=80)
    assert "…" not in shown
    assert "valid in 0 % of the predictions" in shown
    notes = answer(*words)["notes"]
    assert any(note.startswith("outside R2/L") and "nominal patient, in the first cycle" in note for note in notes)
    assert any("4 of 4 patients have contacts outside the validity" in note for note in notes)


@pytest.mark.long
def test_results_do_not_depend_on_the_executor():
    run = cohort_run(20)
    np.testing.assert_array_equal(run.simulate().table, run.simulate(Processes(workers=2)).table)


@pytest.mark.long
def test_a_killed_cohort_resumes(tmp_path):
    file, store = short_file(tmp_path, ("cycles = 1e4", "cycles = 1e6")), tmp_path / "store"
    words = ["hip", str(file), "--patients", "64", "--store", str(store)]
    program = stopped_program(12, ".npz")  # the fourth file has a folder and a content, but not yet its name
    subprocess.run([sys.executable, "-c", program, *words], stdout=subprocess.DEVNULL)
    times = {path.name: path.stat().st_mtime_ns for path in store.glob("*.npz")}
    assert len(times) == 3
    again = answer(*words)
    assert all((store / name).stat().st_mtime_ns == when for name, when in times.items())
    assert again["bands"] == answer(*words[:4])["bands"]
