"""Questions asked of many joints: maps, fronts, optima, tolerances, sensitivities; in Python and in the shell."""

import csv
import json
import re
import shlex
from dataclasses import replace
from importlib.util import find_spec
from math import pi
from pathlib import Path

import numpy as np
import pytest
import xarray

import ballsocket as bs
from ballsocket.core.kinds import Unit
from ballsocket.files.units import parse
from ballsocket.model_catalogue import named_model
from ballsocket.studies.derivatives import elasticities, finite_differences, jax_derivatives, off_axis_uncertainty
from ballsocket.studies.design import Span
from ballsocket.studies.distributions import Normal, Rectangular, check_nominal, tolerance
from ballsocket.studies.expressions import distribution_of, parse_distribution, parse_limit, parse_range
from ballsocket.studies.file import read_study
from ballsocket.studies.limits import Limit, allowed, limited_quantities, margin_on_plane, verdicts
from ballsocket.studies.metadata import joint_dimension
from ballsocket.studies.optimisation import optimise, pareto
from ballsocket.studies.run import default_model
from ballsocket.studies.study_answer import map_summary, study_summary
from ballsocket.studies.task import OUTCOMES
from ballsocket.studies.variance_shares import sensitivity

from ..cli.command import answer, refusal, run
from ..extent import either, some
from ..refusals import text_tables, unescaped

HIP = bs.joints["hess-forsbach"]
SHELL = (Limit(name="outer_radius", high=26.0), Limit(name="liner_thickness", low=4.0))
TINY = Limit(name="outer_radius", high=1.0)
AT = {"ball_radius": 16.0, "clearance": 0.1, "liner_thickness": 6.0, "force": 3000.0}
RANGES = {"ball_radius": (11.0, 23.0), "liner_thickness": (3.0, 15.0)}
LOAD = {"force": 3000.0}
SPREAD = "--spread 'clearance=0.1+-0.05 mm' --spread 'liner_young=700..1100 MPa'"


def study_ranges(model, count):
    return bs.study(model, HIP, **{name: Span(*ends, count) for name, ends in RANGES.items()}, **LOAD)


@pytest.fixture(scope="module")
def design_space():
    return study_ranges(bs.HessForsbach(), 25)


def test_limits_know_dimensions_that_follow_from_others_and_the_arc_of_the_socket_to_its_edge(design_space):
    outer = joint_dimension(design_space, "outer_radius")
    assert outer.sel(ball_radius=20.0, liner_thickness=6.0).item() == pytest.approx(26.1)
    radii = {"outer_radius": 26.0, "socket_radius": Span(15.0, 20.0, 6)}
    other = bs.study(bs.HessForsbach(), HIP, **radii, clearance=0.1, force=1e3)
    assert joint_dimension(other, "liner_thickness").values.tolist() == pytest.approx([11.0, 10.0, 9.0, 8.0, 7.0, 6.0])
    assert joint_dimension(other, "ball_radius").values[0] == pytest.approx(14.9)
    assert joint_dimension(other, "ball_young") == 230000.0
    with pytest.raises(ValueError, match="has no ball_young"):
        joint_dimension(bs.study(bs.HessForsbach(), HIP.replace(ball=None), force=1e3), "ball_young")
    massive = bs.study(bs.Hertz(), bs.joints["tilting-pad-pivot"], liner_thickness=[3.0, 6.0, np.inf], force=1e3)
    assert allowed(massive, [Limit(name="liner_thickness", low=4.0)]).values.tolist() == [False, True, True]
    cup = bs.Cup(arc_of_cover=2.8, inclination=0.5)
    edge = Limit(name="edge_distance", low=10.0, cup=cup, direction=(-np.sin(0.3), 0.0, np.cos(0.3)))
    here = design_space.sel(ball_radius=16.0, liner_thickness=6.0)
    arc = (1.4 - 0.2 - here.half_angle.item()) * 16.1
    assert edge.bar(here).value.item() == pytest.approx(arc)
    assert edge.margin(here).value.item() == pytest.approx(arc - 10.0)
    upright = (pi / 2 - here.half_angle.item()) * 16.1
    assert Limit(name="edge_distance").bar(here).value.item() == pytest.approx(upright)


def test_a_limit_that_depends_on_one_axis_fills_the_plane():
    """Zero is a value like any other on the second axis."""
    axes = {"clearance": [0.1, 0.2], "friction": [0.0, 0.1, 0.2]}
    study = xarray.Dataset({"max_pressure": ("clearance", [8.0, 12.0])}, coords=axes)
    margin = margin_on_plane(study, Limit(name="max_pressure", high=10.0), "clearance", "friction")
    assert (np.sign(margin.value) == [[1, -1]] * 3).all()


def test_a_front_is_beaten_by_nothing_and_misses_nothing(design_space):
    coarse = design_space.round(0)  # many values are equal
    for study in (design_space, coarse.assign(area=coarse.area.round(-1))):
        good = allowed(study, SHELL).values.ravel()
        area, pressure = (study[name].values.ravel()[good] for name in ("area", "max_pressure"))
        pairs = list(zip(area, pressure, strict=True))
        beaten = [((area <= a) & (pressure <= p) & ((area < a) | (pressure < p))).any() for a, p in pairs]
        front = pareto(study, limits=SHELL)
        best = sorted({pair for pair, worse in zip(pairs, beaten, strict=True) if not worse})
        assert list(zip(front.area.values, front.max_pressure.values, strict=True)) == best
    with pytest.raises(ValueError, match="no point is allowed by outer_radius ≤ 1"):
        pareto(design_space, limits=[TINY])


def test_only_the_whole_error_bar_keeps_a_limit():
    """The pressure of the springs is known to 15 %, and so is their stress at least."""
    springs, limit = bs.HessForsbach(), Limit(name="max_pressure", high=15.0)
    names = ["utilisation", *limited_quantities([limit], springs)]
    found = bs.study(springs, HIP, ball_radius=np.linspace(10.0, 20.0, 21), force=3000.0, quantities=names)
    codes = np.select([1.15 * found.max_pressure <= 15.0, 0.85 * found.max_pressure > 15.0], [0, 2], 1)
    assert (verdicts(found, [limit]).values.tolist(), set(codes)) == (codes.tolist(), {0, 1, 2})
    assert (found.verdict == (found.utilisation_high > 1.0).astype(int) + (found.utilisation_low > 1.0)).all()
    best = optimise(springs, HIP, {"ball_radius": (10.0, 20.0)}, load=LOAD, limits=[limit], minimise="area")
    assert springs.press(best.joint, force=3000.0).max_pressure == pytest.approx(15.0 / 1.15, rel=1e-4)
    assert 0 < best.undecided < best.searched


@pytest.mark.parametrize("model", some([bs.HessForsbach(), bs.Tabulated()], 1), ids=lambda model: model.name)
def test_an_optimum_is_better_than_every_point_of_a_fine_grid(model):
    best, fine = optimise(model, HIP, RANGES, load=LOAD, limits=SHELL), study_ranges(model, 121)
    least = fine.max_pressure.where(allowed(fine, SHELL)).min().item()
    assert best.value <= least * (1 + 1e-9)
    assert best.value == pytest.approx(least, rel=2e-3)
    assert best.active == ("outer_radius ≤ 26 mm",)
    along_limit = best.slopes["ball_radius"] - best.slopes["liner_thickness"]
    assert along_limit == pytest.approx(0.0, abs=1e-2 * abs(best.slopes["ball_radius"]))
    assert model.press(best.joint, force=3000.0).max_pressure == pytest.approx(best.value, rel=1e-9)


def test_an_optimum_without_limits_lies_at_an_end():
    ranges = {"clearance": (0.05, 0.2)}
    best = optimise(bs.HessForsbach(), HIP, ranges, load=LOAD)
    assert best.point["clearance"] == pytest.approx(0.05)
    assert best.active == ("clearance = 0.05 mm",)
    with pytest.raises(ValueError, match="none of 4096 joints within the ranges is allowed by outer_radius ≤ 1"):
        optimise(bs.HessForsbach(), HIP, ranges, load={"force": 1.0}, limits=[TINY])


def test_slopes_by_differences_are_those_of_scaling():
    """Lengths times a and moduli times b: F a²b, so the elasticities add up."""
    at = {**AT, "liner_young": 1000.0, "ball_young": 2.3e5}
    found = elasticities(bs.Exact(), HIP, ("max_pressure", "indentation"), at)
    for quantity, lengths, moduli in (("max_pressure", 0.0, 1.0), ("indentation", 1.0, 0.0)):
        each = found[quantity]
        size = each["ball_radius"] + each["clearance"] + each["liner_thickness"] + 2 * each["force"]
        assert size == pytest.approx(lengths, abs=1e-4)
        assert each["liner_young"] + each["ball_young"] + each["force"] == pytest.approx(moduli, abs=1e-4)


@pytest.mark.parametrize(
    ("model", "name", "end", "inside"),
    [
        (bs.HessForsbach(), "clearance", 0.0, 1e-6),
        (bs.HessForsbach(), "socket_radius", HIP.ball_radius, HIP.ball_radius + 1e-6),
        (bs.Hertz(), "liner_poisson", 0.5, 0.49999),
    ],
    ids=["perfect fit", "perfect fit by radii", "rubber"],
)
def test_slopes_at_the_end_of_what_is_allowed_are_those_just_inside(model, name, end, inside):
    at = {"ball_radius": HIP.ball_radius, "liner_poisson": 0.4, "force": 2000.0}
    slopes = [finite_differences(model, HIP, ("max_pressure",), {**at, name: one})[1] for one in (end, inside)]
    for each in (*at, name):
        assert slopes[0]["max_pressure"][each] == pytest.approx(slopes[1]["max_pressure"][each], rel=1e-3, abs=1e-3)


def test_a_nominal_value_may_lie_on_the_end_of_its_tolerance():
    """Rounding of an end does not count as outside, in either direction."""
    span = Rectangular(low=0.1, high=0.3)
    for value in (0.1, 0.3, 0.1 - 1e-12, 0.3 + 1e-12):
        check_nominal("clearance", value, span, Unit("mm"))
    for value in (0.1 - 1e-6, 0.3 + 1e-6):
        with pytest.raises(ValueError, match="lies outside its tolerance of 0.1 to 0.3 mm"):
            check_nominal("clearance", value, span, Unit("mm"))
    check_nominal("clearance", 0.1 + 3 * 0.01, Normal(mean=0.1, deviation=0.01), Unit("mm"))  # three deviations
    with pytest.raises(ValueError, match="lies outside"):
        check_nominal("clearance", 0.13, tolerance(0.1, 0.02), Unit("mm"))


def test_tolerances_off_the_axis_have_the_band_of_presses_at_their_ends():
    """Results change in one direction with the force: ends of a band are presses at the ends of the force."""
    joint, force = bs.joints["hip-36"], tolerance(2000.0, 600.0)
    model = bs.Sphere(ring_width=np.radians(6.0), cup=bs.Cup(inclination=0.785, anteversion=0.26))
    effect = off_axis_uncertainty(joint, model, {"force": 2000.0}, {"force": force})
    ends = [float(force.frozen.ppf(share)) for share in (0.025, 0.5, 0.975)]
    pressed = model.press(joint, force=np.array(ends))
    for name in ("max_pressure", "indentation", "area"):
        assert effect.band[name] == pytest.approx(getattr(pressed, name), rel=3e-3)
    assert effect.band["edge_distance"][0] == pytest.approx(pressed.edge_distance[2], abs=0.05)
    assert effect.presses == 3
    assert 0.3 < effect.changes["max_pressure"]["force"] < 0.8


def test_sobol_intervals_are_those_of_the_seed_and_leave_the_global_stream_alone():
    spread = {"clearance": tolerance(0.1, 0.05), "liner_poisson": Rectangular(low=0.38, high=0.46)}
    before = np.random.get_state()[1].tolist()  # noqa: NPY002
    one, other = (sensitivity(bs.HessForsbach(), HIP, spread, count=64, load={"force": 1e3}) for _ in range(2))
    assert one.identical(other)
    assert np.random.get_state()[1].tolist() == before  # noqa: NPY002


@pytest.mark.skipif(find_spec("jax") is None, reason="jax is not installed")
def test_slopes_by_jax_are_those_of_differences():
    model = bs.HessForsbach()
    exact, near = (derive(model, HIP, ("max_pressure", "area"), AT) for derive in (jax_derivatives, finite_differences))
    for quantity in ("max_pressure", "area"):
        assert exact[0][quantity] == pytest.approx(near[0][quantity], rel=1e-12)
        assert exact[1][quantity] == pytest.approx(near[1][quantity], rel=1e-6)
    with pytest.raises(ValueError, match="exact cannot be traced"):
        jax_derivatives(bs.Exact(), HIP, ("area",), AT)
    derivatives = (jax_derivatives, finite_differences)
    values = [optimise(model, HIP, RANGES, load=LOAD, limits=SHELL, derive=derive).value for derive in derivatives]
    assert values[0] == pytest.approx(values[1], rel=1e-6)


@pytest.mark.long
def test_slopes_of_finite_elements_are_near_the_exact_ones():
    at = {"force": 3000.0, "clearance": 0.1}
    models = (bs.FiniteElement(meshes=1), bs.Exact())
    near, true = (elasticities(model, HIP, ("max_pressure", "half_angle"), at) for model in models)
    for quantity, each in true.items():
        for name, value in each.items():
            assert near[quantity][name] == pytest.approx(value, abs=0.02)


def test_sobol_indices_of_a_product_of_powers():
    """Hertz with a rigid ball: d ~ (F²/(E*² R*))^(1/3), whose logarithm is a sum; small spreads make it additive."""
    rigid = HIP.replace(ball=None)
    spread = {"liner_young": Normal(mean=1000.0, deviation=20.0), "force": Normal(mean=1000.0, deviation=30.0)}
    found = sensitivity(bs.Hertz(), rigid, spread, quantities=("indentation",), count=2048)
    shares = np.array([(2 / 3 * 0.02) ** 2, (2 / 3 * 0.03) ** 2])
    np.testing.assert_allclose(found.first_order.values[0], shares / shares.sum(), atol=0.03)
    np.testing.assert_allclose(found.total_order.values[0], shares / shares.sum(), atol=0.03)
    np.testing.assert_allclose(found.elasticity.values[0], [-2 / 3, 2 / 3], rtol=1e-5)
    middle = bs.Hertz().press(rigid, force=1000.0).indentation
    assert found["mean"].item() == pytest.approx(middle, rel=1e-3)
    assert found.deviation.item() == pytest.approx(middle * np.sqrt(shares.sum()), rel=0.03)


@pytest.mark.long
def test_sizes_and_materials_are_chosen_from_lists():
    """The best of all combinations is that of each of them on its own."""
    sizes, liners, ranges = [28.0, 32.0, 36.0], [bs.POM, bs.UHMWPE], {"clearance": (0.05, 0.2)}
    common = {"load": LOAD, "limits": [Limit(name="outer_diameter", high=50.0)]}
    model, hip = bs.HessForsbach(), HIP.replace(liner_thickness=6.0)
    best = optimise(model, hip, ranges, choices={"head_diameter": sizes, "liner": liners}, **common)
    joints = [hip.replace(head_diameter=size, liner=liner) for size in sizes for liner in liners]
    least = min(optimise(model, joint, ranges, **common).value for joint in joints)
    assert best.value == pytest.approx(least, rel=1e-9)
    assert (best.point["head_diameter"], best.materials) == (36.0, {"liner": "UHMWPE"})
    assert (best.joint.head_diameter, best.joint.liner) == (36.0, bs.UHMWPE)
    assert "head_diameter" not in best.slopes


def test_lists_alone_are_searched_in_python_and_the_shell(tmp_path):
    choice, limit = {"head_diameter": [28.0, 32.0, 36.0]}, Limit(name="outer_diameter", high=46.0)
    best = optimise(bs.HessForsbach(), HIP, {}, choices=choice, load=LOAD, limits=[limit])
    assert best.point == {"head_diameter": 32.0}
    with pytest.raises(ValueError, match="head_diameter = 36 is not allowed by outer_diameter ≤ 20"):
        optimise(bs.HessForsbach(), HIP, {}, choices=choice, load=LOAD, limits=[replace(limit, high=20.0)])
    words = ("--vary", "head_diameter=2.8, 3.2, 3.6 cm", "--vary", "liner=pom,UHMWPE", "--force", "3 kN")
    best = answer("optimise", "hip-28", *words, folder=tmp_path)
    assert (best["point"], best["materials"]) == ({"head_diameter": pytest.approx(36.0)}, {"liner": "UHMWPE"})
    front = answer("optimise", "hip-28", *words, "--minimise", "area", "--minimise", "max_pressure", folder=tmp_path)
    assert "POM" in front["points"]["liner"]


def test_a_preset_of_questions_is_varied_and_the_next_command_runs(tmp_path):
    words = ("--liner", "uhmwpe", "--ball", "cocr", "--liner-thickness", "5", "--head-diameter", "28", "--points", "5")
    answers = [answer("map", preset, *words, "--force", "3 kN", folder=tmp_path) for preset in ("hip-36", "hip-28")]
    for step in [each.pop("next")[0]["command"] for each in answers]:
        assert run(*shlex.split(step)[1:], folder=tmp_path).returncode == 0
    assert answers[0] == answers[1]


def test_phrases_of_the_shell():
    assert parse_range("ball_radius = 11..23 mm") == ("ball_radius", 11.0, 23.0)
    assert parse_range("force=1 kN .. 3 kN") == parse_range("force=1..3 kN") == ("force", 1000.0, 3000.0)
    assert parse_distribution("clearance=100+-50 um") == ("clearance", tolerance(0.1, 0.05))
    assert parse_distribution("liner_poisson=0.38..0.46") == ("liner_poisson", Rectangular(low=0.38, high=0.46))
    for phrase, name, end, value in (
        ("outer_radius <= 2.6 cm", "outer_radius", "high", 26.0),
        ("max_pressure>5 MPa", "max_pressure", "low", 5.0),
        ("half_angle<60", "half_angle", "high", pi / 3),
        *((f"area<={size}", "area", "high", 800.0) for size in ("800 mm²", "800 mm2", "8 cm^2")),
        ("stiffness>=60 kN/mm", "stiffness", "low", 60e3),
        ("energy<=50 mJ", "energy", "high", 50.0),
    ):
        limit = parse_limit(phrase)
        assert (limit.name, getattr(limit, end)) == (name, pytest.approx(value, rel=1e-12))
    for phrase in ("ball_radius", "ball_radius=11", "outer_radius=26", "outer_radius==26", "ball_radios=11..23"):
        with pytest.raises(ValueError, match=r"is not a|did you mean|is not known"):
            (parse_limit if "26" in phrase else parse_range)(phrase)


STUDY = """
model = "hess-forsbach"
joint = "hip.toml"
quantities = ["max_pressure", "stiffness"]
store = "out/s.zarr"
[axes]
ball_radius = {from = "14 mm", to = "1.8 cm", count = 5}
force = ["1 kN", "3 kN"]
[samples]
count = 8
seed = 3
clearance = {nominal = "0.1 mm", plus_minus = "50 um"}
liner_poisson = {low = 0.38, high = 0.46}
liner_young = {median = "1 GPa", factor = 1.1}
"""
SIZES = "[joint]\nball_radius = 14\nclearance = 0.1\nliner_thickness = 5\n[liner]\nmaterial = 'UHMWPE'\n"


@pytest.fixture
def write_study(tmp_path):
    """Function that writes the study with a part replaced, next to the file of its joint."""
    (tmp_path / "hip.toml").write_text(SIZES, encoding="utf-8")

    def write(old="", new=""):
        assert old in STUDY
        (tmp_path / "s.toml").write_text(STUDY.replace(old, new, 1), encoding="utf-8")
        return tmp_path / "s.toml"

    return write


def test_a_study_file_has_design_model_joint_and_store(tmp_path, write_study):
    given = read_study(write_study())
    assert given.design.dims == ("sample", "ball_radius", "force")
    assert given.design.shape == (8, 5, 2)
    assert given.store == tmp_path / "out" / "s.zarr"
    found = bs.study(given.model, given.joint, given.design, quantities=given.quantities, store=given.store)
    assert set(found.data_vars) == {"max_pressure", "stiffness", *OUTCOMES}
    assert found.ball_radius.values.tolist() == [14.0, 15.0, 16.0, 17.0, 18.0]
    (tmp_path / "rows.csv").write_text("liner_thickness\n5\n6\n")
    correlated = read_study(write_study("seed = 3", 'correlation = ["clearance, liner_young = 0.5"]'))
    assert correlated.design.axes[0].correlation == ((("clearance", "liner_young"), 0.5),)
    assert read_study(write_study("[axes]", '[table]\npath = "rows.csv"\n[axes]')).design.shape == (2, 8, 5, 2)
    assert read_study(write_study('"hess-forsbach"', '"fem"\nplastic = true')).model.plastic


(REFUSED,) = text_tables(Path(__file__).with_name("refused.txt"))
LONG_SEED = "seed = 3", "seed = 0x" + "f" * 9000, "seed = .{1,60} is not allowed: a whole number from 0 to"


@pytest.mark.parametrize(("old", "new", "message"), [*REFUSED, LONG_SEED], ids=range(len(REFUSED) + 1))
def test_bad_study_files_are_one_sentence_on_the_command_line(tmp_path, write_study, old, new, message):
    write_study(unescaped(old), unescaped(new))
    assert re.search(message, refusal("study", "s.toml", folder=tmp_path))
    assert not (tmp_path / "out").exists()


def test_joints_that_tables_do_not_know_are_solved_unless_a_model_is_named(tmp_path):
    (tmp_path / "backed.toml").write_text(
        SIZES + '[[backing]]\nthickness = 3\nmaterial = "titanium"\n[load]\nforce = 3000\n'
    )
    ranges = ("--x", "ball_radius=12..16 mm", "--y", "liner_thickness=4..6 mm", "--points", "2")
    found = run("map", "backed.toml", *ranges, "--json", folder=tmp_path)
    assert json.loads(found.stdout)["model"] == "exact"
    assert "model exact is used, since tabulated is valid for none of these joints" in found.stderr
    limited = run("map", "backed.toml", *ranges, "--limit", "max_pressure<=1", folder=tmp_path).stderr
    assert "no point of the map is allowed by max_pressure ≤ 1 MPa, according to exact" in limited
    named = run("map", "backed.toml", *ranges, "--model", "tabulated", folder=tmp_path)
    assert "tabulated has no answer for layers behind the liner = 1: outside the tables" in named.stderr
    best = answer("optimise", "backed.toml", "--vary", "liner_thickness=4,6 mm", folder=tmp_path)
    assert best["point"]["liner_thickness"] == pytest.approx(6.0)
    assert answer("map", "hip-28", "--force", "3 kN", *ranges, folder=tmp_path)["model"] == "tabulated"


def test_loads_alone_are_answered_by_a_curve_of_the_joint(tmp_path):
    backed = HIP.replace(backing=(bs.Layer(thickness=3.0, material=bs.TITANIUM),))
    found = bs.study(bs.Tabulated(), backed, clearance=[0.1, 0.2], force=3000.0)
    with pytest.raises(ValueError, match="tabulated has no answer at any point: the model has no formula"):
        pareto(found, ("area", "max_pressure"), [Limit(name="max_pressure", high=15.0)])
    assert default_model(backed.replace(clearance=0.3), {"force": [1.0, 9000.0]}) == bs.Exact()
    assert default_model(backed, {"force": [1.0, 9000.0]}) == bs.ExactCurve()
    assert default_model(backed, {"force": [1.0, 9000.0], "clearance": [0.1, 0.2]}) == bs.Exact()
    assert default_model(HIP, {"force": [1.0, 9000.0]}) == bs.Tabulated()
    assert named_model("exact curve") == bs.ExactCurve()
    forces = np.linspace(10.0, 6000.0, 300)
    kept = bs.study(bs.ExactCurve(), backed, force=forces, store=tmp_path / "kept")
    alone = bs.Exact(tolerance=1e-9).press(backed, force=forces[::60])
    np.testing.assert_allclose(kept.max_pressure[::60], alone.max_pressure, rtol=1e-7)
    assert kept.valid.all()


def test_maps_and_fronts_on_the_command_line(tmp_path):
    common = ("hess-forsbach", "--force", "3 kN", "--limit", "outer_radius<=26 mm", "--limit", "liner_thickness>=4")
    least = answer("map", *common, "--points", "15", "--figure", "map.png", folder=tmp_path)
    assert 10.2 < least["quantities"]["max_pressure"][0]["value"] < 10.9
    assert (tmp_path / "map.png").stat().st_size > 10_000
    ranges = ("--vary", "ball_radius=11..23 mm", "--vary", "liner_thickness=3..15 mm")
    minimised = ("--minimise", "area", "--minimise", "max_pressure")
    front = answer("optimise", *common, *ranges, *minimised, folder=tmp_path)["points"]
    assert np.all(np.diff(front["area"]) > 0)
    assert np.all(np.diff(front["max_pressure"]) < 0)
    loads = ("--x", "force=1..4 kN", "--limit", "area<=500 mm2", "--points", "9")
    assert answer("map", "hess-forsbach", *loads, folder=tmp_path)["limits"] == ["area ≤ 500 mm²"]


def test_sensitivities_in_csv_and_json(tmp_path):
    words = shlex.split(f"sensitivity hip-36 --force '3 kN' {SPREAD} --count 64 --of max_pressure")
    figures = either((), ("--figure", "all.png"))
    found = answer(*words, "--second-order", "--csv", "all.csv", *figures, folder=tmp_path)
    assert found["confidence"] == 0.95
    rows = list(csv.DictReader((tmp_path / "all.csv").read_text(encoding="utf-8").splitlines()))
    (pair,) = [row for row in rows if row["index"] == "second_order"]
    assert (pair["parameter"], pair["other_parameter"]) == ("clearance", "liner_young")
    assert float(pair["low"]) < float(pair["value"]) < float(pair["high"])
    assert {row["quantity"] for row in rows} == {"max_pressure"}
    assert all(row["low"] for row in rows if row["index"] != "elasticity")
    numbers = answer(*words, "--intervals", "none", folder=tmp_path)["quantities"]["max_pressure"]["numbers"]
    assert set(numbers["clearance"]) == {"first_order", "total_order", "elasticity"}
    correlated = answer(*words, "--correlation", "clearance, liner_young = 0.6", *figures, folder=tmp_path)
    assert correlated["correlation"] == "clearance, liner_young = 0.6"
    numbers = correlated["quantities"]["max_pressure"]["numbers"].values()
    assert sum(number["shapley"] for number in numbers) == pytest.approx(1.0)
    assert all(number["shapley_low"] <= number["shapley_high"] for number in numbers)


def test_a_tolerance_in_percent_is_a_share_of_its_nominal_value():
    width = parse_distribution("clearance = 0.1 +- 0.005 mm")
    for text in ("clearance = 0.1 mm +- 5 %", "clearance=100 um ± 5%", "clearance = 0.1 +/- 5 per cent"):
        name, distribution = parse_distribution(text)
        assert (name, distribution.low, distribution.high) == ("clearance", *map(pytest.approx, (0.095, 0.105)))
        assert distribution.deviation == pytest.approx(width[1].deviation)

    def read(name, value):
        return parse(name, value, "length")

    tabled = distribution_of("clearance", {"nominal": "0.1 mm", "plus_minus": "5 %"}, read)
    assert (tabled.low, tabled.high) == pytest.approx((0.095, 0.105))
    assert distribution_of("clearance", {"mean": 0.2, "deviation": "10 %"}, read).deviation == pytest.approx(0.02)
    with pytest.raises(ValueError, match="a tolerance is above 0"):
        parse_distribution("clearance = 0.1 mm +- 0 %")


def test_json_states_angles_in_degrees_with_the_unit_in_the_key():
    """As in a press, in the CSV of a study and in its terminal."""
    joint = bs.joints["hip-28"]
    studied = bs.study(bs.HessForsbach(), joint, force=[1000.0, 2000.0])
    angles = np.degrees(bs.HessForsbach().press(joint, force=[1000.0, 2000.0]).half_angle)
    summary = study_summary(studied)
    assert summary["values"]["half_angle_deg"] == pytest.approx(angles)
    ends = summary["quantities"]["half_angle_deg"]
    assert [ends["least"]["value"], ends["largest"]["value"], ends["median"]] == pytest.approx([*angles, angles.mean()])
    mapped = map_summary(bs.study(bs.HessForsbach(), joint, half_angle=[0.5, 0.6]), [])["quantities"]["force"]
    assert [end["at"]["half_angle_deg"] for end in mapped] == pytest.approx(np.degrees([0.5, 0.6]))
    best = optimise(bs.HessForsbach(), joint, {"clearance": (0.05, 0.2)}, load={"force": 2000.0}, minimise="half_angle")
    written = best.summary()
    assert (written["minimise"], written["value"]) == ("half_angle_deg", pytest.approx(np.degrees(best.value)))
    assert written["slopes"]["clearance"] == pytest.approx(np.degrees(best.slopes["clearance"]))
    assert not any(key in json.dumps([summary, mapped, written]) for key in ('"half_angle"', '"max_pressure_angle"'))


def test_a_limit_that_is_no_number_is_refused_as_such():
    for text in ("edge_distance>=nan", "max_pressure<=nan"):
        with pytest.raises(ValueError, match="= nan is not allowed: a limit is a number"):
            parse_limit(text)
