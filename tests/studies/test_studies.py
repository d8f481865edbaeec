"""Studies: every point is a press, whoever computes it; labels tell what it is; files carry all of it."""

import csv
import json
from dataclasses import replace
from importlib import import_module
from itertools import product
from subprocess import DEVNULL

import numpy as np
import pandas
import pyarrow
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from pyarrow import parquet

import ballsocket as bs
from ballsocket.contact.verdict import Verdict
from ballsocket.core.executors import Processes, Serial
from ballsocket.core.quantities import PLASTIC
from ballsocket.design_checks import assess_strength
from ballsocket.model_catalogue import with_yielding
from ballsocket.studies.design import Span, grid, sample, table
from ballsocket.studies.distributions import tolerance
from ballsocket.studies.file import read_study
from ballsocket.studies.file_formats import export
from ballsocket.studies.limits import Limit
from ballsocket.studies.parameters import vary_joint
from ballsocket.studies.study_answer import study_summary
from ballsocket.studies.task import Blocks

from ..cli.command import run
from ..places import symlink_or_skip
from ..processes import PATIENCE
from .servers import cluster

HIP = bs.joints["hess-forsbach"]
AXES = {"clearance": [0.05, 0.1, 0.2], "ball_radius": [14.0, 17.9], "force": [500.0, 1500.0, 3000.0, 4000.0]}
LINERS = [bs.UHMWPE, bs.CROSSLINKED_PE, bs.POM]


@pytest.mark.parametrize("name", ["hess-forsbach", "tabulated", "exact", "plane-layer"])
def test_every_point_is_a_press(name):
    model = bs.catalogue[name]
    found = bs.study(model, HIP, quantities=["indentation", "area", "stiffness"], **AXES)
    assert found.sizes == {"clearance": 3, "ball_radius": 2, "force": 4}
    for clearance, radius, force in ((0.2, 14.0, 500.0), (0.05, 17.9, 4e3)):
        contact = model.press(HIP.replace(ball_radius=radius, clearance=clearance), force=force)
        here = found.sel(clearance=clearance, ball_radius=radius, force=force)
        for quantity in ("indentation", "area", "stiffness"):
            assert here[quantity].item() == pytest.approx(getattr(contact, quantity), rel=1e-9)
        assert here.valid.item() == contact.valid


def test_labels_state_units_and_sources():
    found = bs.study(bs.HessForsbach(), HIP, clearance=[0.1], half_angle=np.radians([20.0, 40.0]))
    assert found.force.attrs == {"long_name": "normal force", "symbol": "F", "units": "N"}
    assert (found.half_angle.attrs["units"], found.clearance.attrs["units"]) == ("rad", "mm")
    assert "Heß & Forsbach 2021" in found.attrs["references"]
    assert json.loads(found.attrs["joint"])["liner"]["young"] == 1000.0
    assert not (found.max_pressure.values.flags.writeable)
    assert not (found.valid.values.flags.writeable)
    assert found.status.attrs["flag_meanings"].split()[:2] == ["not_computed", "ok"]


def test_radii_and_diameters_that_follow_from_others_make_the_joint_they_say():
    found = bs.study(bs.HessForsbach(), HIP, outer_radius=26.0, socket_radius=[15.0, 20.0], clearance=0.2, force=2000.0)
    radii = np.array([15.0, 20.0])
    joint = HIP.replace(ball_radius=radii - 0.2, clearance=0.2, liner_thickness=26.0 - radii)
    np.testing.assert_allclose(found.max_pressure, bs.HessForsbach().press(joint, force=2e3).max_pressure, rtol=1e-12)
    backed = HIP.replace(backing=(bs.Layer(thickness=3.0, material=bs.TITANIUM),))  # the outer radius is the shell's
    found = bs.study(bs.Exact(), backed, outer_radius=[26.0], ball_radius=17.9, force=2000.0)
    np.testing.assert_allclose(Limit(name="liner_thickness").bar(found).value, 26.0 - 18.0 - 3.0)
    made = bs.Exact().press(backed.replace(liner_thickness=5.0), force=2000.0)
    assert found.max_pressure.item() == pytest.approx(made.max_pressure, rel=1e-9)
    joint, possible = vary_joint(HIP, {"socket_radius": np.array([18.0, 17.9, 18.1]), "ball_radius": 18.0})
    assert joint.clearance.tolist() == pytest.approx([0.0, 0.0, 0.1])
    assert joint.clearance[0] == 0.0
    assert possible.tolist() == [True, False, True]
    diameters = {"head_diameter": [30.0, 36.0], "diametral_clearance": 0.2, "outer_diameter": 52.0}
    found = bs.study(bs.HessForsbach(), HIP, **diameters, force=2000.0)
    radii = {"ball_radius": [15.0, 18.0], "clearance": 0.1, "outer_radius": 26.0}
    by_radii = bs.study(bs.HessForsbach(), HIP, **radii, force=2000.0)
    np.testing.assert_array_equal(found.max_pressure, by_radii.max_pressure)
    for name, limit in radii.items():
        np.testing.assert_allclose(Limit(name=name).bar(found).value, limit, rtol=1e-12)


def test_a_material_keeps_its_strength_while_its_elastic_constants_vary():
    hip = bs.joints["hip-28"]
    axes = {"liner_young": [1000.0, 700.0], "liner_poisson": [0.4, 0.45]}
    found = bs.study(bs.Exact(), hip, quantities=["utilisation"], force=3000.0, **axes)
    for young, poisson in product(*axes.values()):
        liner = replace(bs.UHMWPE, young=young, poisson=poisson)
        expected = bs.Exact().press(hip.replace(liner=liner), force=3000.0).utilisation
        got = found.utilisation.sel(liner_young=young, liner_poisson=poisson).item()
        assert got == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("ball", [bs.COCR, None])
def test_a_material_without_a_yield_stress_leaves_the_utilisation_of_the_others(ball, tmp_path):
    hip, liners = replace(bs.joints["hip-28"], ball=ball), [bs.UHMWPE, bs.ALUMINA, bs.POM]
    found = bs.study(bs.Exact(), hip, quantities=["utilisation"], force=3000.0, liner=liners)
    contacts = [bs.Exact().press(hip.replace(liner=liner), force=3000.0) for liner in liners]
    np.testing.assert_allclose(found.utilisation, [float(contact.utilisation) for contact in contacts], rtol=1e-9)
    expected = [assess_strength(contact).verdict for contact in contacts]
    assert expected == [Verdict.KEPT, Verdict.UNDECIDED, Verdict.KEPT]
    assert found.verdict.values.tolist() == [0, -1 if ball is None else 1, 0]
    reason = study_summary(found)["notes"][-1].removeprefix("utilisation: ")
    assert reason.startswith("strength not checked: the liner has no yield stress, give yield_stress in its table")
    export(found, tmp_path / "study.csv")
    reasons = [row["why_no_utilisation"] for row in rows_of(tmp_path / "study.csv")]
    assert reasons == ["", reason if ball is None else "", ""]


def test_each_point_that_is_not_valid_has_its_reason(tmp_path):
    hip = bs.joints["hip-28"].replace(liner=bs.Material(young=1000.0, poisson=0.4))
    asked = {"quantities": ["max_pressure", "utilisation"], "clearance": [0.01, 3.0], "force": [1.0, 3000.0]}
    found = bs.study(bs.Hertz(), hip, **asked)
    export(found, tmp_path / "hertz.csv")
    rows = rows_of(tmp_path / "hertz.csv")
    joints = [hip.replace(clearance=float(row["clearance_mm"])) for row in rows]
    pressed = [bs.Hertz().press(joint, force=float(row["force_N"])) for joint, row in zip(joints, rows, strict=True)]
    for row, contact in zip(rows, pressed, strict=True):
        assert (row["valid"] == "1") == contact.valid == (row["why_not_valid"] == "")
        assert row["why_not_valid"] in ("", *contact.notes)
    reasons = [row["why_not_valid"] for row in rows if row["why_not_valid"]]
    notes = study_summary(found)["notes"]
    assert sum(int(note.split(" of ")[0]) for note in notes if " of 4: " in note) == len(reasons)
    assert all(any(reason in note for note in notes) for reason in reasons)
    assert any(note.startswith("utilisation: ") and "no yield stress" in note for note in notes)


def rows_of(path):
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def test_materials_are_an_axis_or_fixed(tmp_path, monkeypatch):
    monkeypatch.setattr(import_module("ballsocket.studies.file_formats"), "_MAX_CHUNK_POINTS", 2)
    for store in (None, tmp_path / "kept"):
        found = bs.study(bs.HessForsbach(), HIP, force=[1000.0, 3000.0], liner=LINERS, store=store)
        assert found.max_pressure.dims == ("force", "liner")
        for liner in LINERS:
            pressed = bs.HessForsbach().press(HIP.replace(liner=liner), force=np.array([1000.0, 3000.0]))
            np.testing.assert_allclose(found.max_pressure.sel(liner=liner.name), pressed.max_pressure, rtol=1e-12)
            assert found.liner_young.sel(liner=liner.name).item() == liner.young
    export(found, tmp_path / "study.csv")
    assert [row["liner"] for row in rows_of(tmp_path / "study.csv")[:3]] == ["UHMWPE", "cross-linked PE", "POM"]
    export(found.transpose("liner", "force"), tmp_path / "study.parquet")
    columns = pandas.read_parquet(tmp_path / "study.parquet")
    assert columns["liner"].tolist() == [liner.name for liner in LINERS for _ in range(2)]
    assert columns["force_N"].tolist() == [1e3, 3e3] * 3
    assert columns["max_pressure_MPa"].tolist() == found.max_pressure.values.T.ravel().tolist()
    export(found, tmp_path / "study.nc")
    with xr.open_dataset(tmp_path / "study.nc", engine="h5netcdf") as again:
        assert again.liner.values.tolist() == found.liner.values.tolist()
    fixed, rigid = bs.study(bs.HessForsbach(), HIP, liner=bs.POM, force=[1000.0]), HIP.replace(ball=None)
    assert (fixed.max_pressure.dims, fixed.liner_young.item()) == (("force",), bs.POM.young)
    ball = bs.study(bs.Hertz(), rigid, ball=[bs.COCR, bs.POM], force=100.0).max_pressure.values[1]
    assert ball == pytest.approx(bs.Hertz().press(rigid.replace(ball=bs.POM), force=100.0).max_pressure, rel=1e-12)


ORDERED = 'joint = "hip-36"\n[axes]\nball_radius = [15, 16, 17]\nouter_radius = [24, 25]\nliner = ["uhmwpe", "pom"]\n'
ORDERED += "clearance = [0.05, 0.1]\nforce = 3000\n[samples]\ncount = 2\nball_young = {low = 2e5, high = 3e5}\n"


def test_a_study_has_one_order_in_memory_in_a_store_and_from_other_processes(tmp_path):
    (tmp_path / "study.toml").write_text(ORDERED, encoding="utf-8")
    given = read_study(tmp_path / "study.toml")
    texts = set()
    for store, engine in ((None, Serial()), (tmp_path / "here", Serial()), (tmp_path / "there", Processes(workers=2))):
        found = bs.study(given.model, given.joint, given.design, store=store, engine=engine)
        assert list(found.sizes) == ["sample", "ball_radius", "outer_radius", "liner", "clearance"]
        export(found, tmp_path / "study.csv")
        texts.add((tmp_path / "study.csv").read_text(encoding="utf-8"))
    (text,) = texts
    assert text.startswith("ball_young_MPa,ball_radius_mm,outer_radius_mm,liner,liner_young_MPa,")


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Exact()], ids=lambda m: m.name)
def test_numbers_without_a_joint_or_outside_the_domain_are_a_status(model):
    found = bs.study(model, HIP, outer_radius=20.0, ball_radius=[15.0, 19.9, 25.0], force=1000.0)
    assert found.status.values.tolist() == [0, int(bs.Status.NO_JOINT), int(bs.Status.NO_JOINT)]
    assert np.isnan(found.max_pressure.values).tolist() == [False, True, True]
    assert found.valid.values.tolist() == [True, False, False]
    found = bs.study(bs.BondedLayer(), HIP, liner_poisson=[0.4, 0.5], force=1000.0)
    assert found.status.values.tolist() == [0, int(bs.Status.OUTSIDE_DOMAIN)]
    assert bs.study(bs.BondedLayer(), HIP, liner_poisson=[0.5], force=1000.0).max_pressure.isnull().all()


@given(shape=st.lists(st.integers(1, 9), min_size=0, max_size=3).map(tuple), most=st.integers(1, 200))
def test_blocks_cover_every_point_once(shape, most):
    blocks = Blocks.divide(shape, most)
    seen = np.zeros(shape, dtype=int)
    for number in range(len(blocks)):
        seen[blocks[number]] += 1
        assert blocks.n_points(number) <= most
    assert (seen == 1).all()
    with pytest.raises(IndexError):
        blocks[len(blocks)]


def test_samples_times_a_grid_are_bands_and_all_points_are_counted():
    scattered = sample(64, clearance=tolerance(0.1, 0.05)) * grid(force=Span(500.0, 3000.0, 3))
    progress = []
    found = bs.study(bs.HessForsbach(), HIP, scattered, listen=progress.append)
    assert found.sizes == {"sample": 64, "force": 3}
    assert progress[0].n_done == 0
    assert progress[-1].n_done == progress[-1].n_points == 192
    assert progress[-1].seconds_left == 0.0
    assert found.clearance.dims == ("sample",)
    drawn = json.loads(found.attrs["design"])["sample"]
    assert (drawn["count"], drawn["seed"], drawn["method"]) == (64, 0, "sobol")


def test_rows_of_a_table(tmp_path):
    (tmp_path / "rows.csv").write_text("ball_radius,clearance,half_angle_deg\n16,0.1,40\n14,0.05,50\n")
    found = bs.study(bs.HessForsbach(), HIP, table(tmp_path / "rows.csv"))
    assert found.sizes == {"row": 2}
    assert np.degrees(found.half_angle.values).tolist() == pytest.approx([40.0, 50.0])
    parquet.write_table(pyarrow.table({"ball_radius": [16.0], "force": [3000.0]}), tmp_path / "rows.parquet")
    assert bs.study(bs.HessForsbach(), HIP, table(tmp_path / "rows.parquet")).max_pressure.shape == (1,)


@pytest.mark.long
def test_rows_are_read_from_files_alone_and_as_far_as_there_is_memory(tmp_path, monkeypatch):
    (tmp_path / "rows.parquet").write_bytes(b"PAR1" * 100)
    with pytest.raises(ValueError, match="rows.parquet: it is not a readable Parquet file"):
        table(tmp_path / "rows.parquet")
    parquet.write_table(pyarrow.table({"force": ["1 kN"]}), tmp_path / "rows.parquet")
    with pytest.raises(ValueError, match="rows.parquet: column 'force' has values of type object, not numbers"):
        table(tmp_path / "rows.parquet")
    parquet.write_table(pyarrow.table({"force": np.ones(10**6)}), tmp_path / "rows.parquet")
    (tmp_path / "rows.csv").write_text("force\n" + "1\n" * 10**5, encoding="utf-8")
    monkeypatch.setattr("ballsocket.core.executors.processes.available_memory", lambda: 10**6)
    with pytest.raises(ValueError, match="1000000 rows of rows.parquet take about 24 MB, and there are 1 MB of memory"):
        table(tmp_path / "rows.parquet")
    with pytest.raises(ValueError, match="rows of rows.csv take about .* and there are 1 MB of memory"):
        table(tmp_path / "rows.csv")
    symlink_or_skip(tmp_path / "endless.csv", "/dev/zero")
    with pytest.raises(ValueError, match="endless.csv: it is not a regular file"):
        table(tmp_path / "endless.csv")


@pytest.mark.long
def test_a_study_file_is_the_same_through_a_scheduler_and_workers_of_the_shell(tmp_path):
    """`dask scheduler` and two of `dask worker`, which share the blocks: the CSV is that of one process."""
    from distributed import Client

    several = "force = { from = '0.1 kN', to = '3 kN', count = 4 }"  # exact presses: several blocks
    text = f"model = 'exact'\n{ORDERED.replace('force = 3000', several)}"
    with cluster(tmp_path, 2, DEVNULL) as (_, address):
        with Client(address) as client:
            client.wait_for_workers(2, timeout=PATIENCE)
        for name, engine in (("here", ""), ("there", f"[engine]\nkind = 'dask'\naddress = '{address}'\n")):
            (tmp_path / f"{name}.toml").write_text(text.replace("[axes]", f"{engine}[axes]"), encoding="utf-8")
            told = run("study", f"{name}.toml", "--store", f"{name}.zarr", "--out", f"{name}.csv", folder=tmp_path)
            assert told.returncode == 0, told.stderr
    here, there = ((tmp_path / f"{name}.csv").read_bytes() for name in ("here", "there"))
    assert here.startswith(b"ball_young_MPa,ball_radius_mm,outer_radius_mm,liner,")
    assert here == there


def test_a_study_of_yielding_has_its_results_by_default_and_writes_infinite_ones(tmp_path):
    text = "model = 'fem'\njoint = 'hip-28'\nQUANTITIES\n[axes]\nforce = [1e3, 2e4]\n"
    path = tmp_path / "study.toml"
    path.write_text(text.replace("QUANTITIES", ""), encoding="utf-8")
    given = read_study(path)
    yielding = given.quantities_of(with_yielding(given.model))
    assert set(yielding) - set(given.quantities_of(given.model)) == {*PLASTIC}
    path.write_text(text.replace("QUANTITIES", "quantities = ['minimum_thickness']"), encoding="utf-8")
    printed = run("study", "study.toml", "--plastic", "--json", folder=tmp_path)
    assert printed.returncode == 0, printed.stderr
    found = json.loads(printed.stdout)
    assert found["quantities"]["minimum_thickness"]["largest"]["value"] == "inf"
    assert "inf" in found["values"]["minimum_thickness"]


def test_files_for_other_programs(tmp_path):
    found = bs.study(bs.HessForsbach(), HIP, clearance=[0.05, 0.1], force=[1000.0, 3000.0])
    export(found, tmp_path / "s.nc")
    with xr.open_dataset(tmp_path / "s.nc", engine="h5netcdf") as again:
        assert np.array_equal(again.max_pressure.values, found.max_pressure.values)
        assert again.max_pressure.attrs["units"] == "MPa"
    export(found, tmp_path / "s.csv")
    rows = rows_of(tmp_path / "s.csv")
    assert len(rows) == 4
    assert float(rows[1]["max_pressure_MPa"]) == found.max_pressure.values[0, 1]
    assert float(rows[3]["half_angle_deg"]) == np.degrees(found.half_angle.values[1, 1])
    export(found, tmp_path / "s.parquet")
    columns = pandas.read_parquet(tmp_path / "s.parquet")
    assert columns.columns.tolist() == list(rows[0])
    assert columns["half_angle_deg"].tolist() == [float(row["half_angle_deg"]) for row in rows]
    assert columns["valid"].tolist() == [True] * 4
    with pytest.raises(ValueError, match=r"must end in .nc, .csv, .parquet or .zarr"):
        export(found, tmp_path / "s.xls")
