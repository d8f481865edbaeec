"""Studies: every point is a press, whoever computes it; labels tell what it is; files carry all of it."""

import csv
import json
import sys
import time
from contextlib import contextmanager
from importlib import import_module
from subprocess import DEVNULL, Popen

import numpy as np
import pandas
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import ballsocket as bs
from ballsocket.core.executors import Processes, Serial
from ballsocket.core.executors.dask import Distributed
from ballsocket.core.executors.processes import count_text
from ballsocket.studies.design import Method, Span, grid, sample, table
from ballsocket.studies.distributions import Normal, Rectangular, tolerance
from ballsocket.studies.export import export
from ballsocket.studies.file import read_study
from ballsocket.studies.limits import Limit
from ballsocket.studies.run import read
from ballsocket.studies.task import Blocks

from ..cli.command import run
from ..extent import either, some

HIP = bs.joints["hess-forsbach"]
AXES = {"clearance": [0.05, 0.1, 0.2], "ball_radius": [14.0, 17.9], "force": [500.0, 1500.0, 3000.0, 4000.0]}


def same(one, other):
    return all(one[name].values.tobytes() == other[name].values.tobytes() for name in one.data_vars) and set(
        one.data_vars
    ) == set(other.data_vars)


@pytest.mark.parametrize(
    "model", [bs.HessForsbach(), bs.Tabulated(), bs.Exact(), bs.PlaneLayer()], ids=lambda m: m.name
)
def test_every_point_is_a_press(model):
    found = bs.study(model, HIP, quantities=["indentation", "area", "stiffness"], **AXES)
    assert found.sizes == {"clearance": 3, "ball_radius": 2, "force": 4}
    for place in (
        {"clearance": 0.2, "ball_radius": 14.0, "force": 500.0},
        {"clearance": 0.05, "ball_radius": 17.9, "force": 4e3},
    ):
        joint = bs.Joint(
            ball_radius=place["ball_radius"],
            clearance=place["clearance"],
            liner_thickness=HIP.liner_thickness,
            liner=HIP.liner,
            ball=HIP.ball,
        )
        contact = model.press(joint, force=place["force"])
        here = found.sel(place)
        for name in ("indentation", "area", "stiffness"):
            assert here[name].item() == pytest.approx(getattr(contact, name), rel=1e-9)
        assert here.valid.item() == contact.valid


def test_labels_say_what_units_and_who():
    found = bs.study(bs.HessForsbach(), HIP, clearance=[0.1], half_angle=np.radians([20.0, 40.0]))
    assert found.force.attrs == {"long_name": "normal force", "symbol": "F", "units": "N"}
    assert found.half_angle.attrs["units"] == "rad"
    assert found.clearance.attrs["units"] == "mm"
    assert "Heß & Forsbach 2021" in found.attrs["references"]
    assert json.loads(found.attrs["joint"])["liner"]["young"] == 1000.0
    assert found.status.attrs["flag_meanings"].split()[:2] == ["not_computed", "ok"]
    assert json.loads(json.dumps(found.attrs))


def test_a_number_is_fixed_and_is_no_axis():
    found = bs.study(bs.HessForsbach(), HIP, clearance=[0.05, 0.1], force=3000.0)
    assert found.sizes == {"clearance": 2}
    assert found.force.item() == 3000.0
    assert bs.study(bs.HessForsbach(), HIP, force=3000.0).max_pressure.item() == pytest.approx(11.27, abs=0.01)


def test_derived_parameters_make_the_joint_they_say():
    found = bs.study(bs.HessForsbach(), HIP, outer_radius=26.0, socket_radius=[15.0, 20.0], clearance=0.2, force=2000.0)
    for radius, pressure in zip((15.0, 20.0), found.max_pressure.values, strict=True):
        joint = bs.Joint(
            ball_radius=radius - 0.2, clearance=0.2, liner_thickness=26.0 - radius, liner=HIP.liner, ball=HIP.ball
        )
        assert pressure == pytest.approx(bs.HessForsbach().press(joint, force=2000.0).max_pressure, rel=1e-12)


def test_diameters_are_axes():
    diameters = {"head_diameter": [30.0, 36.0], "diametral_clearance": 0.2, "outer_diameter": 52.0}
    found = bs.study(bs.HessForsbach(), HIP, **diameters, force=2000.0)
    radii = {"ball_radius": [15.0, 18.0], "clearance": 0.1, "outer_radius": 26.0}
    np.testing.assert_array_equal(
        found.max_pressure, bs.study(bs.HessForsbach(), HIP, **radii, force=2000.0).max_pressure
    )
    for name, limit in (("outer_radius", 26.0), ("ball_radius", [15.0, 18.0]), ("clearance", 0.1)):
        np.testing.assert_allclose(Limit(name=name).evaluate(found), limit, rtol=1e-12)
    with pytest.raises(ValueError, match="head_diameter and ball_radius|ball_radius and head_diameter"):
        bs.study(bs.HessForsbach(), HIP, head_diameter=[30.0], ball_radius=[15.0], force=1.0)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: bs.study(bs.Exact(), "hip-28", force=1.0), "joint must be a Joint, got 'hip-28'"),
        (lambda: bs.study(bs.Exact(), HIP, 3000.0), r"design must be a Design, .* got 3000\.0; loads have names"),
    ],
)
def test_what_is_something_else_is_told_in_a_sentence(ask, message):
    with pytest.raises(TypeError, match=message):
        ask()


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: bs.studies.Limit(name="half_angle", high=45), "half_angle = 45 .*; 45 degrees are 0.7854 radians$"),
    ],
)
def test_an_angle_that_can_only_be_degrees_is_told_in_radians(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


LINERS = [bs.UHMWPE, bs.CROSSLINKED_PE, bs.POM]


@pytest.mark.parametrize("store", [None, "kept"])
def test_materials_are_an_axis(store, tmp_path):
    folder = None if store is None else tmp_path / store
    found = bs.study(bs.HessForsbach(), HIP, force=[1000.0, 3000.0], liner=LINERS, store=folder)
    assert found.max_pressure.dims == ("force", "liner")
    assert found.liner.values.tolist() == ["UHMWPE", "cross-linked PE", "POM"]
    for liner in LINERS:
        pressed = bs.HessForsbach().press(HIP.replace(liner=liner), force=np.array([1000.0, 3000.0]))
        np.testing.assert_array_equal(found.max_pressure.sel(liner=liner.name), pressed.max_pressure)
        assert found.liner_young.sel(liner=liner.name).item() == liner.young
    for ending in ("csv", "nc"):
        export(found, tmp_path / f"study.{ending}")
    rows = list(csv.DictReader((tmp_path / "study.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["liner"] for row in rows[:3]] == [liner.name for liner in LINERS]
    with xr.open_dataset(tmp_path / "study.nc", engine="h5netcdf") as again:
        assert again.liner.values.tolist() == found.liner.values.tolist()


def test_a_rigid_ball_takes_materials():
    rigid = HIP.replace(ball=None)
    found = bs.study(bs.Hertz(), rigid, ball=[bs.COCR, bs.POM], force=100.0)
    assert found.max_pressure.values[1] == bs.Hertz().press(rigid.replace(ball=bs.POM), force=100.0).max_pressure


def test_one_material_is_fixed():
    found = bs.study(bs.HessForsbach(), HIP, liner=bs.POM, force=[1000.0])
    assert found.max_pressure.dims == ("force",)
    assert found.liner_young.item() == bs.POM.young


@pytest.mark.parametrize(
    ("axes", "message"),
    [
        ({"liner": ["uhmwpe"]}, r"liner must be a list of Materials, got \['uhmwpe'\]"),
        ({"liner": 1000.0}, "liner must be a Material or a list of Materials, got 1000"),
        ({"liner": []}, "liner has no values"),
        ({"liner": [bs.POM, bs.POM]}, "liner has POM twice"),
        ({"liner": LINERS, "liner_young": [1.0]}, "liner_young varies along two axes"),
    ],
)
def test_what_is_no_axis_of_materials_is_told(axes, message):
    with pytest.raises(ValueError, match=message):
        bs.study(bs.HessForsbach(), HIP, **axes, force=1.0)


ORDERED = """
joint = "hip-36"
[axes]
ball_radius = [15, 16, 17]
outer_radius = [24, 25]
liner = ["uhmwpe", "pom"]
clearance = [0.05, 0.1]
force = 3000
"""


def test_a_study_has_one_order_wherever_it_is_kept_and_by_whom_it_is_computed(tmp_path):
    (tmp_path / "study.toml").write_text(ORDERED, encoding="utf-8")
    given = read_study(tmp_path / "study.toml")
    heads = "ball_radius_mm,outer_radius_mm,liner,liner_young_MPa,liner_poisson,liner_yield_stress_MPa,"
    heads += "clearance_mm,force_N,"
    texts = []
    for name, engine in (("here", Serial()), ("there", Processes(workers=2))):
        for store in (None, tmp_path / name):
            found = bs.study(given.model, given.joint, given.design, store=store, engine=engine)
            assert list(found.sizes) == ["ball_radius", "outer_radius", "liner", "clearance"]
            export(found, tmp_path / "study.csv")
            texts.append((tmp_path / "study.csv").read_text(encoding="utf-8"))
    assert texts[0].startswith(f"{heads}indentation_mm,half_angle_deg,max_pressure_MPa,area_mm2,status,valid")
    assert len(set(texts)) == 1


def test_an_outer_radius_is_that_of_the_shell():
    backed = HIP.replace(backing=(bs.Layer(thickness=3.0, material=bs.TITANIUM),))
    found = bs.study(bs.Exact(), backed, outer_radius=[26.0], force=2000.0)
    thickness = Limit(name="liner_thickness").evaluate(found)
    np.testing.assert_allclose(thickness, 26.0 - 18.0 - 3.0)
    made = backed.replace(liner_thickness=5.0)
    assert found.max_pressure.item() == pytest.approx(bs.Exact().press(made, force=2000.0).max_pressure, rel=1e-9)


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Exact()], ids=lambda m: m.name)
def test_numbers_that_make_no_joint_are_a_status(model):
    found = bs.study(model, HIP, outer_radius=20.0, ball_radius=[15.0, 19.9, 25.0], force=1000.0)
    assert found.status.values.tolist() == [0, int(bs.Status.NO_JOINT), int(bs.Status.NO_JOINT)]
    assert np.isnan(found.max_pressure.values).tolist() == [False, True, True]
    assert found.valid.values.tolist() == [True, False, False]


def test_a_block_outside_the_domain_is_a_status():
    found = bs.study(bs.BondedLayer(), HIP, liner_poisson=[0.4, 0.5], force=1000.0)
    assert found.status.values.tolist() == [0, int(bs.Status.OUTSIDE_DOMAIN)]
    assert bs.study(bs.BondedLayer(), HIP, liner_poisson=[0.5], force=1000.0).max_pressure.isnull().all()


@given(
    shape=st.lists(st.integers(1, 25), min_size=0, max_size=3).map(tuple),
    most=st.integers(1, 2000),
)
def test_blocks_cover_every_point_once(shape, most):
    blocks = Blocks.divide(shape, most)
    seen = np.zeros(shape, dtype=int)
    for number in range(len(blocks)):
        seen[blocks[number]] += 1
        assert blocks.n_points(number) <= most
    assert (seen == 1).all()
    with pytest.raises(IndexError):
        blocks[len(blocks)]


@settings(max_examples=either(quick=5, long=25))
@given(mean=st.floats(0.05, 0.2), deviation=st.floats(0.001, 0.03), seed=st.integers(0, 1000))
def test_samples_follow_their_distributions(mean, deviation, seed):
    design = sample(
        512, seed=seed, clearance=Normal(mean=mean, deviation=deviation), liner_poisson=Rectangular(low=0.3, high=0.4)
    )
    values = design.values_in([slice(None)])
    assert values["clearance"].mean() == pytest.approx(mean, abs=deviation / 20)
    assert values["clearance"].std() == pytest.approx(deviation, rel=0.05)
    assert values["liner_poisson"].min() >= 0.3
    again = sample(
        512, seed=seed, clearance=Normal(mean=mean, deviation=deviation), liner_poisson=Rectangular(low=0.3, high=0.4)
    )
    assert (again.values_in([slice(None)])["clearance"] == values["clearance"]).all()


def test_a_tolerance_is_cut_off_at_its_limits():
    design = sample(4096, method=Method.LATIN_HYPERCUBE, clearance=tolerance(0.1, 0.05))
    values = design.values_in([slice(None)])["clearance"]
    assert 0.05 <= values.min() < 0.06
    assert 0.14 < values.max() <= 0.15
    assert values.mean() == pytest.approx(0.1, abs=1e-3)


def test_samples_times_a_grid_are_bands():
    scattered = sample(64, clearance=tolerance(0.1, 0.05)) * grid(force=Span(500.0, 3000.0, 3))
    found = bs.study(bs.HessForsbach(), HIP, scattered)
    assert found.sizes == {"sample": 64, "force": 3}
    spread = found.max_pressure.quantile(0.95, dim="sample") - found.max_pressure.quantile(0.05, dim="sample")
    assert (spread > 0).all()
    assert found.clearance.dims == ("sample",)
    drawn = json.loads(found.attrs["design"])["sample"]
    assert (drawn["count"], drawn["seed"], drawn["method"]) == (64, 0, "sobol")


def test_rows_of_a_table(tmp_path):
    (tmp_path / "rows.csv").write_text("ball_radius,clearance,force,half_angle_deg\n16,0.1,,\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"force in row 0 of rows.csv = nan is not allowed"):
        table(tmp_path / "rows.csv")
    (tmp_path / "rows.csv").write_text(
        "ball_radius,clearance,half_angle_deg\n16,0.1,40\n14,0.05,50\n", encoding="utf-8"
    )
    found = bs.study(bs.HessForsbach(), HIP, table(tmp_path / "rows.csv"))
    assert found.sizes == {"row": 2}
    assert np.degrees(found.half_angle.values).tolist() == pytest.approx([40.0, 50.0])
    (tmp_path / "bad.csv").write_text("ball_radius,clearence\n16,0.1\n", encoding="utf-8")
    with pytest.raises(ValueError, match="did you mean 'clearance'"):
        table(tmp_path / "bad.csv")
    import pyarrow
    from pyarrow import parquet

    parquet.write_table(pyarrow.table({"ball_radius": [16.0], "force": [3000.0]}), tmp_path / "rows.parquet")
    assert bs.study(bs.HessForsbach(), HIP, table(tmp_path / "rows.parquet")).max_pressure.shape == (1,)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b'force\n"1\n2\n', "rows.csv is not CSV: unexpected end of data, in line 3"),
        (b'force\n"1"2\n', "rows.csv is not CSV: .* in line 2"),
        (b"force\n" + b"1" * 99_000 + b"\n", "force in row 0 of rows.csv = inf"),
        (b"force\n" + b"1" * 200_000 + b"\n", "rows.csv has a line of more than 100000 characters"),
        (b'force\n"' + b"1\n" * 80_000 + b'"', "rows.csv is not CSV: field larger than field limit"),
        (",".join(f"c{i}" for i in range(20_000)).encode(), "more than 100000 characters"),
        (b",".join([b"force"] * 16_000), "rows.csv has force twice"),
        (b"force\n" + b"," * 90_000, "row 0 of rows.csv has more cells than there are columns"),
        (b"\x1b[31m\n1\n", r"'.x1b\[31m' among the columns of rows.csv is not known"),
        (b"a" * 90_000 + b"\n1\n", "'a{39}... among the columns of rows.csv is not known"),
        (b"force\n\xff\n", "rows.csv is not text in UTF-8: invalid start byte"),
        (b"force\n1\0\n", "force in row 0 of rows.csv = nan"),
    ],
    ids=range(12),
)
def test_a_csv_that_is_none_is_one_sentence_at_once(content, message, tmp_path):
    (tmp_path / "rows.csv").write_bytes(content)
    start = time.process_time()
    with pytest.raises(ValueError, match=message) as refused:
        table(tmp_path / "rows.csv")
    assert time.process_time() - start < 1.0
    assert len(str(refused.value)) < 300


def test_rows_are_read_from_files_alone_and_as_far_as_there_is_memory(tmp_path, monkeypatch):
    (tmp_path / "endless.csv").symlink_to("/dev/zero")
    with pytest.raises(ValueError, match="endless.csv is not a regular file"):
        table(tmp_path / "endless.csv")
    for content in (b"", b"PAR1" * 100, b"force\n1\n"):
        (tmp_path / "rows.parquet").write_bytes(content)
        with pytest.raises(ValueError, match="rows.parquet is not a readable Parquet file"):
            table(tmp_path / "rows.parquet")
    import pyarrow
    from pyarrow import parquet

    parquet.write_table(pyarrow.table({"force": np.ones(10**6)}), tmp_path / "rows.parquet")
    (tmp_path / "rows.csv").write_text("force\n" + "1\n" * 10**5, encoding="utf-8")
    monkeypatch.setattr("ballsocket.core.executors.processes.available_memory", lambda: 10**6)
    with pytest.raises(ValueError, match=r"1e\+06 rows of rows.parquet take about 24 MB, and there are 1 MB of memory"):
        table(tmp_path / "rows.parquet")
    with pytest.raises(ValueError, match="rows of rows.csv take about .* and there are 1 MB of memory"):
        table(tmp_path / "rows.csv")


@pytest.mark.parametrize(
    ("axes", "message"),
    [
        ({"clearance": [0.1]}, "one load is needed"),
        ({"clearence": [0.1], "force": 1.0}, "did you mean 'clearance'"),
        ({"force": 1.0, "indentation": 0.1}, "one load is needed, got force, indentation"),
        ({"ball_radius": 1.0, "socket_radius": 2.0, "clearance": 1.0, "force": 1.0}, "any two of them fix the third"),
        ({"outer_radius": 20.0, "liner_thickness": 2.0, "force": 1.0}, "either fixes the other"),
        ({"clearance": [], "force": 1.0}, "clearance has no values"),
        ({"clearance": [0.1, float("nan")], "force": 1.0}, r"clearance\[1\] = nan is not allowed"),
        ({"clearance": [0.1, -0.1], "force": 1.0}, r"clearance\[1\] = -0.1 is not allowed for a radial clearance"),
        ({"force": Span(-1.0, 5.0, 10**6)}, r"force\[0\] = -1 is not allowed for a normal force"),
        ({"force": ["1 kN"]}, "force must be a row of numbers"),
        ({"force": lambda: Span(1.0, 2.0, 0)}, "count = 0 is not allowed: a span has at least one value"),
        ({"force": lambda: Span(1.0, 2.0, 10**400)}, "count = 1000.*[.]{3} is not allowed: a span has .* at most 1e15"),
    ],
)
def test_bad_designs_are_one_sentence(axes, message):
    with pytest.raises(ValueError, match=message):
        bs.study(bs.HessForsbach(), HIP, **{name: made() if callable(made) else made for name, made in axes.items()})


def test_what_would_be_ignored_is_refused(tmp_path):
    rigid = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.UHMWPE)
    with pytest.raises(ValueError, match="the ball of this joint is rigid: it has no ball_young"):
        bs.study(bs.Tabulated(), rigid, ball_young=[1e4, 1e5], force=1e3)
    many = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=np.array([5.0, 6.0]), liner=bs.UHMWPE)
    with pytest.raises(ValueError, match="plain numbers"):
        bs.study(bs.HessForsbach(), many, force=[1e3, 2e3])
    with pytest.raises(ValueError, match="two axes have the name sample"):
        sample(4, clearance=tolerance(0.1, 0.05)) * sample(4, liner_poisson=Rectangular(low=0.3, high=0.4))
    with pytest.raises(
        ValueError, match=r"clearance.* is not allowed for a radial clearance; truncate the distribution"
    ):
        bs.study(bs.HessForsbach(), HIP, sample(4096, clearance=Normal(mean=0.1, deviation=0.03)), force=1e3)
    for text, message in (
        ("clearance_deg,force\n6,1000\n", "'clearance_deg' among the columns"),
        ("clearance,clearance,force\n0.1,0.2,1000\n", "has clearance twice"),
        ("clearance,force\n0.1,1000,7\n", "row 0 of rows.csv has more cells"),
    ):
        (tmp_path / "rows.csv").write_text(text, encoding="utf-8")
        with pytest.raises(ValueError, match=message):
            table(tmp_path / "rows.csv")


def test_too_many_points_are_refused_with_size_and_time(tmp_path):
    with pytest.raises(ValueError, match="1 000 000 000 000 points take about .* TB and .* hours on one core"):
        bs.study(bs.HessForsbach(), HIP, force=Span(1.0, 2.0, 10**12))
    wide = {"force": Span(1.0, 2.0, 10**7), "clearance": Span(0.05, 0.1, 10**6)}
    with pytest.raises(ValueError, match="on the disk of the store"):
        bs.study(bs.HessForsbach(), HIP, store=tmp_path / "s.zarr", **wide)
    with pytest.raises(ValueError, match="of memory for the values along its axes; use fewer"):
        bs.study(bs.HessForsbach(), HIP, store=tmp_path / "s.zarr", force=Span(1.0, 2.0, 10**12))
    many = sample(10**12, method=Method.LATIN_HYPERCUBE, clearance=Rectangular(low=0.05, high=0.15))
    with pytest.raises(ValueError, match="1 000 000 000 000 points take .* on the disk of the store"):
        bs.study(bs.HessForsbach(), HIP, many, store=tmp_path / "s.zarr", force=1000.0)
    assert not (tmp_path / "s.zarr").exists()


@pytest.mark.long
def test_engines_agree_bit_for_bit(tmp_path, monkeypatch):
    monkeypatch.setattr("ballsocket.studies.run.points_per_block", lambda model: 5)
    for model in some([bs.Exact(), bs.HessForsbach()], 1):
        here = bs.study(model, HIP, **AXES)
        assert same(bs.study(model, HIP, engine=Processes(workers=2), **AXES), here)
        for engine in (Serial(), Distributed(workers=1)):
            store = tmp_path / f"{model.name}-{type(engine).__name__}.zarr"
            stored = bs.study(model, HIP, engine=engine, store=store, **AXES).load()
            assert same(stored, here)
            assert list(stored.data_vars) == [name for name in stored.data_vars if name in here.data_vars]


def test_a_scheduler_is_asked_by_its_address():
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address="127.0.0.1:0", host="127.0.0.1") as cluster:
        found = bs.study(bs.HessForsbach(), HIP, engine=Distributed(address=cluster.scheduler_address), **AXES)
    assert same(found, bs.study(bs.HessForsbach(), HIP, **AXES))
    with pytest.raises(ValueError, match="give an address or a number of workers"):
        Distributed(address="tcp://127.0.0.1:1", workers=2)


@contextmanager
def dask(*words, folder):
    """A command of Dask's that runs until it is no longer needed."""
    with Popen([sys.executable, "-m", "dask", *words], cwd=folder, stdout=DEVNULL, stderr=DEVNULL) as running:
        try:
            yield
        finally:
            running.terminate()


@pytest.mark.long
def test_a_study_file_is_the_same_through_a_scheduler_and_workers_of_the_shell(tmp_path):
    """`dask scheduler` and two of `dask worker`, which share the blocks: the CSV is that of one process."""
    from distributed import Client

    several = "force = { from = '0.1 kN', to = '3 kN', count = 20 }"  # exact presses: several blocks
    text = f"model = 'exact'\n{ORDERED.replace('force = 3000', several)}"
    where, mark = tmp_path / "scheduler.json", ("--no-dashboard", "--host", "127.0.0.1")
    worker = ("worker", *mark, "--no-nanny", "--nthreads", "1", "--scheduler-file", str(where))
    with (
        dask("scheduler", *mark, "--port", "0", "--scheduler-file", str(where), folder=tmp_path),
        dask(*worker, folder=tmp_path),
        dask(*worker, folder=tmp_path),
    ):
        while not where.exists():
            time.sleep(0.1)
        address = json.loads(where.read_text(encoding="utf-8"))["address"]
        with Client(address) as client:
            client.wait_for_workers(2, timeout=60)
        for name, engine in (("here", ""), ("there", f"[engine]\nkind = 'dask'\naddress = '{address}'\n")):
            (tmp_path / f"{name}.toml").write_text(text.replace("[axes]", f"{engine}[axes]"), encoding="utf-8")
            told = run("study", f"{name}.toml", "--store", f"{name}.zarr", "--out", f"{name}.csv", folder=tmp_path)
            assert told.returncode == 0, told.stderr
    here, there = ((tmp_path / f"{name}.csv").read_bytes() for name in ("here", "there"))
    assert here.startswith(b"ball_radius_mm,outer_radius_mm,liner,")
    assert here == there


def test_progress_counts_all_points():
    told = []
    bs.study(bs.HessForsbach(), HIP, listen=told.append, **AXES)
    assert told[0].n_done == 0
    assert told[-1].n_done == told[-1].n_points == 24
    assert told[-1].seconds_left == 0.0


def test_files_for_other_programs(tmp_path):
    found = bs.study(bs.HessForsbach(), HIP, clearance=[0.05, 0.1], force=[1000.0, 3000.0])
    export(found, tmp_path / "s.nc")
    with xr.open_dataset(tmp_path / "s.nc", engine="h5netcdf") as again:
        assert np.array_equal(again.max_pressure.values, found.max_pressure.values)
        assert again.max_pressure.attrs["units"] == "MPa"
    export(found, tmp_path / "s.csv")
    rows = list(csv.DictReader((tmp_path / "s.csv").read_text(encoding="utf-8").splitlines()))
    assert len(rows) == 4
    assert float(rows[1]["max_pressure_MPa"]) == found.max_pressure.values[0, 1]
    assert float(rows[3]["half_angle_deg"]) == np.degrees(found.half_angle.values[1, 1])
    export(found, tmp_path / "s.parquet")
    columns = pandas.read_parquet(tmp_path / "s.parquet")
    assert columns.columns.tolist() == list(rows[0])
    assert columns["half_angle_deg"].tolist() == [float(row["half_angle_deg"]) for row in rows]
    assert columns["valid"].tolist() == [True] * 4
    export(found, tmp_path / "s.zarr")
    with xr.open_zarr(tmp_path / "s.zarr", consolidated=False) as again:
        assert again.load().identical(found)
    with pytest.raises(ValueError, match=r"s.zarr exists: choose another name"):
        export(found, tmp_path / "s.zarr")
    with pytest.raises(ValueError, match=r"must end in .nc, .csv, .parquet or .zarr"):
        export(found, tmp_path / "s.xls")


def test_parquet_has_materials_and_the_points_of_all_chunks(tmp_path, monkeypatch):
    monkeypatch.setattr(import_module("ballsocket.studies.export"), "_MAX_CHUNK_POINTS", 2)
    found = bs.study(bs.HessForsbach(), HIP, liner=[bs.UHMWPE, bs.POM], force=[1e3, 2e3, 3e3])
    export(found, tmp_path / "s.parquet")
    columns = pandas.read_parquet(tmp_path / "s.parquet")
    assert columns["liner"].tolist() == ["UHMWPE"] * 3 + ["POM"] * 3
    assert columns["force_N"].tolist() == [1e3, 2e3, 3e3] * 2
    assert columns["max_pressure_MPa"].tolist() == found.max_pressure.values.ravel().tolist()


def test_counts_are_integers_with_spaces():
    assert [count_text(count) for count in (7, 9999, 14800, 10**6)] == ["7", "9999", "14 800", "1 000 000"]


def test_a_stored_study_is_read_by_xarray_alone(tmp_path):
    bs.study(bs.HessForsbach(), HIP, store=tmp_path / "s.zarr", **AXES)
    plain = xr.open_zarr(tmp_path / "s.zarr", consolidated=False)
    assert plain.max_pressure.dims == ("clearance", "ball_radius", "force")
    assert plain.max_pressure.attrs["units"] == "MPa"
    assert read(tmp_path / "s.zarr").max_pressure.sel(
        clearance=0.1, force=3000.0, ball_radius=17.9
    ).item() == pytest.approx(11.27, abs=0.01)
