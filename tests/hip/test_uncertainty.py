"""Patients who differ: bands, what matters, many of them, kept and gone on with."""

import json
import os
import pickle
import signal
import subprocess
import sys
import time
from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.executors import Distributed, Processes
from ballsocket.hip import (
    Activity,
    CrossShear,
    CustomWearLaw,
    Mix,
    Scatter,
    iso_14242_1,
    iso_14242_4,
    logarithmic,
    population,
    rocking,
    uncertainty,
)
from ballsocket.hip.config import read_hip
from ballsocket.hip.creep_laws import UNVERIFIED_NOTE
from ballsocket.hip.lives import kept
from ballsocket.hip.patients import Patient
from ballsocket.output.hip_bands import band_sections, print_bands
from ballsocket.output.hip_plots import penetration_curve
from ballsocket.problem.cup import Side
from ballsocket.studies import LogNormal, Normal, Rectangular

from ..cli.command import run
from .test_file import TEXT, told
from .test_wear import K, hip

FEW = 1e3
"""Cycles after which a bore is as good as new: volume is as k, cycles, and nearly as the force."""

SCATTER = """[uncertainty]
coefficient = { median = "1.066e-6 mm^3/(N m)", factor = 1.5 }
clearance = { low = "0.05 mm", high = "0.2 mm" }
"""


def scatter(use=None, **distributions):
    return Scatter(use=use or hip(), distributions=distributions)


def short(path, *changes, extra=SCATTER):
    few = (("cycles = 5e6", "cycles = 1e4"), ("report_at = [1e6, 2e6, 5e6]", "report_at = [5e3]"))
    return told(path, *few, *changes, text=TEXT + extra)


def test_a_factor_of_the_coefficient_is_one_of_the_volume():
    one = scatter(coefficient=LogNormal(median=K, factor=1.5))
    history = one.use.after(FEW)
    found = uncertainty(one, history, count=32)
    low, high = found.band("volume")
    assert high[-1] / low[-1] == pytest.approx(1.5 ** (2 * 1.96), rel=0.1)
    assert found.quantile("volume", 0.5)[-1] == pytest.approx(history.last.volume, rel=0.03)


def test_what_scatters_more_matters_more():
    two = scatter(
        coefficient=Normal(mean=K, deviation=0.1 * K), cycles_per_year=Normal(mean=1.5e6, deviation=0.2 * 1.5e6)
    )
    found = uncertainty(two, two.use.after(FEW), count=32)
    shares = found.indices["first_order"][0]
    assert shares == pytest.approx([0.2, 0.8], abs=0.05)  # squares of the deviations
    assert found.indices["total_order"][0] == pytest.approx([0.2, 0.8], abs=0.05)


def test_the_same_seed_gives_the_same_bands_and_another_does_not():
    one = scatter(clearance=Rectangular(low=0.05, high=0.2), body_weight=Normal(mean=800.0, deviation=100.0))
    history = one.use.after(FEW)
    first, again, other = (uncertainty(one, history, count=4, seed=seed).lived.table for seed in (1, 1, 2))
    assert (first == again).all()
    assert (first != other).any()


def test_the_numbers_of_a_patient_are_those_of_its_hip():
    use = hip(seconds_per_cycle=20.0)
    some = Scatter(
        use=use,
        distributions={
            "body_weight": Normal(mean=800.0, deviation=100.0),
            "cycles_per_year": LogNormal(median=1e6, factor=2.0),
            "inclination": Normal(mean=0.5, deviation=0.1),
            "anteversion": Normal(mean=0.2, deviation=0.1),
            "clearance": Rectangular(low=0.05, high=0.2),
        },
        body_weight=750.0,
    )
    numbers = {"body_weight": 900.0, "inclination": 0.4, "anteversion": 0.1, "clearance": 0.15, "cycles_per_year": 2e6}
    patient = some.patient(numbers)
    assert patient.use.cycle.force_magnitudes == pytest.approx(1.2 * some.quick.cycle.force_magnitudes)
    assert patient.use.placed == bs.Cup(inclination=0.4, anteversion=0.1)
    assert patient.use.joint.clearance == 0.15
    assert patient.pace == 2.0
    assert patient.use.seconds == 10.0  # as much time, twice as many cycles
    assert patient.seen([FEW])[0].cycles == 2 * FEW


def test_a_law_of_two_coefficients_keeps_their_ratio():
    law = scatter(hip(wear=CrossShear(straight=1e-7, circular=5e-7)), coefficient=LogNormal(median=1e-7, factor=1.5))
    worn = law.patient({"coefficient": 3e-7}).use.wear
    assert (worn.straight, worn.circular) == pytest.approx((3e-7, 1.5e-6))
    custom = CustomWearLaw(function=lambda cycle: 1e-9 * cycle.work)
    with pytest.raises(ValueError, match="coefficient cannot be sampled: the wear law has no coefficient"):
        scatter(hip(wear=custom), coefficient=LogNormal(median=1e-7, factor=1.5))


def test_a_quick_run_is_near_the_whole_one():
    one = scatter(clearance=Rectangular(low=0.05, high=0.2))
    history = one.use.after(2e6, [1e6])
    off = uncertainty(one, history, count=2).off
    assert 0 < max(off.values()) < 5e-3


@pytest.mark.parametrize(
    "cycle",
    [
        rocking(),
        iso_14242_4(),
        Mix(activities=(Activity(cycle=iso_14242_1(), per_year=1e6), Activity(cycle=rocking(), per_year=1e5))),
    ],
    ids=lambda cycle: cycle.name,
)
def test_a_quick_run_of_any_cycle_can_be_sent_elsewhere_and_is_near_the_whole_one(cycle):
    use = hip(cycle=cycle, cup=bs.Cup(inclination=radians(30.0), side=Side.LEFT))
    assert use.first.volume > 0
    sent = pickle.loads(pickle.dumps(scatter(use, clearance=Rectangular(low=0.05, high=0.2)).quick))
    assert 1e6 / FEW * Patient(use=sent, pace=1.0).seen([FEW])[0].volume == pytest.approx(use.first.volume, rel=2e-2)


def test_dislocated_patients_are_counted_and_left_out():
    loose = scatter(tilt=Rectangular(low=0.0, high=2.0))
    found = uncertainty(loose, loose.use.after(FEW), count=8)
    assert 0 < found.without < found.patients
    assert np.isfinite(found.band("volume")).all()
    assert found.indices is None
    assert found.summary()["sobol"] is None
    assert any("patients have no answer" in note for note in found.notes)


def test_the_command_tells_bands_and_what_matters_and_what_is_not_verified(tmp_path):
    done = run("hip", str(short(tmp_path, extra=f"[creep]\n{SCATTER}count = 2")), "--json")
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    assert [band["cycles"] for band in answer["bands"]] == [5e3, 1e4]
    last = answer["bands"][-1]
    for name in ("volume", "depth", "penetration"):
        assert 0 < last[name]["low"] < last[name]["median"] < last[name]["high"]
        assert set(answer["sobol"][name]) == {"coefficient", "clearance"}
    assert answer["uncertainty"]["patients"] == 4
    assert answer["valid"] is True
    assert answer["uncertainty"]["scatter"]["coefficient"]["factor"] == 1.5
    assert UNVERIFIED_NOTE in answer["notes"]


def test_the_population_has_a_band_for_each_coefficient_that_all_of_it_shares():
    """Converted results are those of patients who were worn with the shared coefficient."""
    differing = {
        "coefficient": LogNormal(median=K, factor=1.5),
        "body_weight": Normal(mean=800.0, deviation=130.0),
        "cycles_per_year": LogNormal(median=1e6, factor=1.5),
        "clearance": Rectangular(low=0.08, high=0.12),
    }
    one = scatter(**differing)
    lives, bands = population(one, [1e5, 5e5], patients=8)
    table = bands.shared.results
    for name, coefficient in bands.shared.values.items():
        shared = np.full(8, coefficient)
        direct = replace(lives, values={**lives.values, "coefficient": shared}).all().table[:, :, :3]
        assert table[name][:, :, 0] == pytest.approx(direct[:, :, 0], rel=0.02)  # volume
        assert table[name] == pytest.approx(direct, rel=0.15)
        low, high = bands.population_band("volume", name)
        known_low, known_high = np.quantile(direct[:, :, 0], [0.025, 0.975], axis=0)
        assert low == pytest.approx(known_low, rel=0.01)
        assert high == pytest.approx(known_high, rel=0.01)
    assert bands.shared.values["high"] / bands.shared.values["median"] == pytest.approx(1.5**1.96, rel=1e-3)


def test_the_band_of_the_patients_is_narrower_than_that_of_the_predictions():
    one = scatter(coefficient=LogNormal(median=K, factor=1.5), body_weight=Normal(mean=800.0, deviation=80.0))
    bands = uncertainty(one, one.use.after(FEW), count=8)
    low, high = bands.population_band("volume")
    least, most = bands.band("volume")
    assert least[-1] < low[-1] < high[-1] < most[-1]
    assert high[-1] / low[-1] == pytest.approx(1.1 ** (2 * 1.96), rel=0.15)
    volume = bands.summary()["bands"][-1]["volume"]
    assert list(volume) == ["low", "median", "high", "given_coefficient"]
    assert list(volume["given_coefficient"]) == ["low", "median", "high"]
    assert volume["given_coefficient"]["median"]["high"] == high[-1]
    assert bands.summary()["uncertainty"]["coefficient"] == bands.shared.values
    (note,) = (note for note in bands.notes if "unknown, but the same for all patients: 95 % between 4.8" in note)
    assert note.endswith(" mm³/(N m)")


def test_a_narrow_terminal_shows_every_number_of_the_bands(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    one = scatter(coefficient=LogNormal(median=K, factor=1.5), body_weight=Normal(mean=800.0, deviation=80.0))
    print_bands(uncertainty(one, one.use.after(FEW), count=8))
    printed = capsys.readouterr().out
    assert "coefficient" in printed
    assert "…" not in printed


def test_without_an_unknown_coefficient_bands_are_of_patients_and_with_it_alone_of_predictions():
    tight = population(scatter(clearance=Rectangular(low=0.05, high=0.2)), [FEW], patients=4)[1]
    alone = population(scatter(coefficient=LogNormal(median=K, factor=1.5)), [FEW], patients=4)[1]
    assert (tight.subject, alone.subject) == ("patients", "predictions")
    for bands in (tight, alone):
        assert bands.shared is None
        assert "given_coefficient" not in bands.summary()["bands"][0]["volume"]
        with pytest.raises(ValueError, match="with coefficient and another quantity"):
            bands.population_band("volume")


def test_an_unknown_band_is_refused():
    bands = many(4)[1]
    with pytest.raises(ValueError, match="coefficient = 'middle' is not allowed: low, median, high"):
        bands.population_band("volume", "middle")
    with pytest.raises(ValueError, match="'edge_distance' has no band for one coefficient: volume, depth"):
        bands.population_band("edge_distance")


def test_a_page_has_the_band_of_the_patients_and_what_matters():
    one = scatter(coefficient=LogNormal(median=K, factor=1.5), clearance=Rectangular(low=0.05, high=0.2))
    history = one.use.after(FEW)
    bands = uncertainty(one, history, count=2)
    sections = band_sections(history, bands)
    assert list(sections) == ["penetration", "patients", "matters"]
    assert (
        "the band holds 95 % of the predictions, the dark band that share of the patients" in sections["penetration"][1]
    )
    filled = penetration_curve(history, bands).axes[0].collections[0].get_paths()[0].get_extents()
    assert filled.y1 == pytest.approx(bands.band("penetration")[1][-1])
    dark = penetration_curve(history, bands).axes[0].collections[1].get_paths()[0].get_extents()
    assert dark.y1 == pytest.approx(bands.population_band("penetration")[1][-1])


@pytest.mark.parametrize(
    ("line", "refused"),
    [
        ("clearance = { mean = '0.1 mm' }", r"clearance = .* must be \{low, high\}, \{mean, deviation\}"),
        ("clearance = { low = '0.1 kN', high = '0.2 mm' }", "clearance.low = '0.1 kN' is not a length"),
        ("clearance = { low = 0.2, high = 0.1 }", "clearance.low = 0.2 is not allowed: it is finite and below high"),
        (
            "coefficient = { median = 1e-6, factor = 0.5 }",
            "coefficient.factor = 0.5 is not allowed: that of one standard",
        ),
        ("coefficient = { median = '1e-9 mm^3/(N mm)', factor = 2 }", r"1 mm\^3/\(N mm\) is 1000 mm\^3/\(N m\)"),
        ("weight = { low = 1, high = 2 }", "'weight' in .uncertainty. is not known"),
        ("body_weight = { low = '70 kg', high = '90 kg' }", "body_weight.low = '70 kg' is not a force"),
        ("cycles_per_year = { low = -2, high = 1 }", "the median of cycles_per_year = -0.5 is not allowed"),
        ("tilt = { low = 0, high = 9 }\ninclination = { low = 0, high = 9 }", "tilt and inclination are one too many"),
        ("count = 100\ntilt = { low = 0, high = 9 }", "count = 100 is not allowed: a power of two"),
        ("seed = -1\ntilt = { low = 0, high = 9 }", "seed = -1 is not allowed: a whole number"),
        ("count = 8", "nothing scatters: coefficient, clearance"),
        (
            "clearance = { low = '0.3 mm', high = '0.5 mm' }",
            "clearance = 0.1 mm lies outside its tolerance of 0.3 to 0.5 mm: change one of them",
        ),
        ("coefficient = { median = 1e-5, factor = 1.1 }", "coefficient = 1.066e-06 lies outside its tolerance"),
    ],
)
def test_what_is_wrong_with_what_scatters_is_said(tmp_path, line, refused):
    with pytest.raises(ValueError, match=f"hip.toml: .*{refused}"):
        read_hip(short(tmp_path, extra=f"[uncertainty]\n{line}\n"))


def test_patients_without_what_scatters_and_their_report_are_refused(tmp_path):
    plain = short(tmp_path, extra="")
    for words, said in ([], "--patients needs a table"), (["--report", str(tmp_path / "x.html")], "one hip: leave out"):
        done = run("hip", str(plain), "--patients", "2", *words)
        assert done.returncode == 2
        assert said in done.stderr


# many


def many(patients, store=None, **words):
    one = scatter(coefficient=LogNormal(median=K, factor=1.5), clearance=Rectangular(low=0.05, high=0.2))
    where = None if store is None else kept(store, one, [FEW], 0)
    return population(one, [FEW], patients=patients, store=where, **words)


def test_patients_are_kept_and_more_are_added(tmp_path):
    first = many(20, tmp_path)[1].lived.table
    (tmp_path / "patients_000000.npz").write_bytes(b"damaged")
    told = []
    _, bands = many(40, tmp_path, listen=told.append)
    assert told == [0, 16, 32, 40]  # the second piece was not whole, the first is damaged
    assert (bands.lived.table[:20] == first).all()
    assert many(40, tmp_path, listen=told.append)[1].lived.table[-1] == pytest.approx(bands.lived.table[-1], rel=0)
    assert told[4:] == [40]
    with pytest.raises(ValueError, match="keeps other patients"):
        kept(tmp_path, scatter(coefficient=LogNormal(median=K, factor=2.0)), [FEW], 0)


def test_the_command_prints_bands_of_patients_uncut_and_why_their_contacts_are_not_valid(tmp_path):
    """In 80 columns, of springs outside the range of their formula."""
    path = short(tmp_path, extra=SCATTER)
    path.write_text(path.read_text().replace('liner_thickness = "8 mm"', 'liner_thickness = "1.2 mm"'))
    words = "hip", str(path), "--patients", "4"
    shown = run(*words, columns=80)
    assert shown.returncode == 0, shown.stderr
    assert "…" not in shown.stdout
    assert "valid in 0 % of the predictions" in shown.stdout
    assert "contact at the rim: " in shown.stdout
    notes = json.loads(run(*words, "--json").stdout)["notes"]
    assert any(note.startswith("outside R2/L") and "usual patient, in the first cycle" in note for note in notes)
    assert any("4 of 4 patients have contacts outside the validity" in note for note in notes)


def test_no_patients_leave_no_folder(tmp_path):
    with pytest.raises(ValueError, match="patients = 0 is not allowed"):
        many(0, tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_every_patient_has_a_row(tmp_path):
    file = short(tmp_path, extra=f"[creep]\n{SCATTER}")
    done = run("hip", str(file), "--patients", "5", "--store", str(tmp_path / "kept"), "--json")
    assert done.returncode == 0, done.stderr
    heads, *rows = (tmp_path / "kept" / "patients.csv").read_text(encoding="utf-8").splitlines()
    assert heads.startswith("coefficient,clearance_mm,volume_mm3_at_5000,")
    assert len(rows) == 5
    volumes = [float(row.split(",")[2]) for row in rows]
    band = json.loads(done.stdout)["bands"][0]["volume"]
    assert band["median"] == pytest.approx(np.median(volumes), rel=1e-6)
    assert 0 < json.loads(done.stdout)["uncertainty"]["quick_run_off"]["volume"] < 0.01
    assert UNVERIFIED_NOTE in json.loads(done.stdout)["notes"]
    assert json.loads(done.stdout)["valid"] is True


def test_bands_are_valid_where_every_answered_patient_is():
    one = scatter(clearance=Rectangular(low=0.05, high=0.2))
    bands = population(one, [5e2, FEW], patients=3)[1]
    assert bands.valid is True

    def with_patients(valid, refused):
        contact = np.stack([np.full((3, 3), 0.5), np.array(valid, dtype=float)], axis=-1)
        return replace(bands, lived=replace(bands.lived, contact=contact, refused=np.array(refused)))

    first_report = [[1, 1, 1], [1, 0, 1], [1, 1, 1]]
    assert with_patients(first_report, ["", "", ""]).valid is False
    assert with_patients(first_report, ["", "dislocated", ""]).valid is True
    assert with_patients([[1, 1, 1]] * 3, ["dislocated"] * 3).valid is False


@pytest.mark.long
@pytest.mark.parametrize("engine", [Processes(workers=2), Distributed(workers=2)], ids=["processes", "dask"])
def test_whoever_wears_them_the_numbers_are_the_same(engine):
    alone, together = many(40)[1].lived, many(40, engine=engine)[1].lived
    assert (alone.table == together.table).all()


@pytest.mark.long
def test_a_population_that_is_killed_goes_on_where_it_was(tmp_path):
    file, store = short(tmp_path, ("cycles = 1e4", "cycles = 1e6")), tmp_path / "kept"
    words = ["hip", str(file), "--patients", "160", "--store", str(store), "--json"]
    started = subprocess.Popen([sys.executable, "-m", "ballsocket", *words], stdout=subprocess.DEVNULL)
    while len(list(store.glob("*.npz"))) < 3:
        assert started.poll() is None
        time.sleep(0.02)
    os.kill(started.pid, signal.SIGKILL)
    started.wait()
    done = {path.name: path.stat().st_mtime_ns for path in store.glob("*.npz")}
    assert 3 <= len(done) < 10
    again = json.loads(run(*words).stdout)
    assert all((store / name).stat().st_mtime_ns == then for name, then in done.items())  # not worn anew
    assert again["bands"] == json.loads(run(*words[:4], "--json").stdout)["bands"]


def test_creep_is_that_of_the_patients_time():
    one = scatter(hip(creep=logarithmic()), clearance=Rectangular(low=0.05, high=0.2))
    assert one.patient({"clearance": 0.1}).seen([FEW])[0].creep_depth > 0


def test_the_weight_and_the_years_that_a_file_says_are_the_usual_patients(tmp_path):
    start, rest = TEXT.split("[cycle]")
    walks = '[[activity]]\nname = "walking"\nper_year = 1e6\n\n[wear]' + rest.split("[wear]")[1]
    file = told(
        tmp_path,
        ("cycles = 5e6\nreport_at = [1e6, 2e6, 5e6]", 'years = 2\nreport_years = [1]\nbody_weight = "900 N"'),
        text=f"{start}{walks}\n[uncertainty]\nbody_weight = {{ mean = 800, deviation = 100 }}\n",
    )
    found = read_hip(file).uncertain.scatter
    assert found.cycles_per_year == 1e6
    assert found.patient({"body_weight": 990.0}).use.cycle.largest_force == pytest.approx(
        1.1 * found.quick.cycle.largest_force
    )
