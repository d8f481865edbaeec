"""Results for extreme, empty, integer and single-precision inputs: numbers or a status."""

from dataclasses import replace
from math import isfinite

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.quantities import CONTACT

from ..extent import either
from ..joints import HIP

NUMBERS = ("indentation", "half_angle", "max_pressure", "stiffness", "energy", "pressure_integral")
EVERY = {**bs.catalogue, "fem": bs.FiniteElement(meshes=1)}

SIZES = {"ball_radius": 8.782959259849237, "clearance": 0.006709816621781704, "liner_thickness": 29.473051545391872}
LINER = bs.Material(young=383.97746159934627, poisson=0.20489599454456642)
WIDE = bs.Joint(**SIZES, liner=LINER, ball=bs.Material(young=218012.50235580927, poisson=0.3))


def wide_contacts(count: int, seed: int):
    """Joints with the loads of contacts of 79.5 to 85 degrees, where a ball nearly fills its socket."""
    rng = np.random.default_rng(seed)
    for number in range(count):
        radius = rng.uniform(4.0, 30.0)
        clearance = radius * 10 ** rng.uniform(-3.3, -1.7)
        thickness = (radius + clearance) / 10 ** rng.uniform(-0.7, 0.3)
        liner = bs.Material(young=rng.uniform(200.0, 3500.0), poisson=rng.uniform(0.0, 0.499))
        ball = bs.Material(young=2.1e5, poisson=0.3) if number % 2 else None
        joint = bs.Joint(ball_radius=radius, clearance=clearance, liner_thickness=thickness, liner=liner, ball=ball)
        found = bs.Tabulated().press(joint, half_angle=np.radians(rng.uniform(79.5, 85.0, 16))).force
        yield joint, found[np.isfinite(found)]


def test_tabulated_results_do_not_depend_on_the_other_loads():
    cases = [(WIDE, 1246.1909930719228 * np.linspace(0.9, 1.1, 41)), *wide_contacts(either(quick=20, long=100), 7)]
    for joint, force in cases:
        company = bs.Tabulated().press(joint, force=force)
        alone = [bs.Tabulated().press(joint, force=float(one)) for one in force]
        assert [int(one.status) for one in alone] == company.status.tolist() == [0] * len(force)
        for name in NUMBERS:  # 1e-6 is rounding where the indentation is 1e5 times the clearance
            assert [getattr(one, name) for one in alone] == pytest.approx(getattr(company, name), rel=1e-6)


@pytest.mark.parametrize("model", [bs.Tabulated(), bs.Refined()], ids=lambda model: model.name)
@pytest.mark.parametrize("force", [1e3, 1e-2, 2.4e-4, 1e-6, 1e-10])
def test_single_precision_has_numbers_at_small_loads(model, force):
    single, double = (model.press(HIP, force=np.asarray([force], dtype=kind)) for kind in (np.float32, np.float64))
    assert single.status.tolist() == [0]
    for name in NUMBERS:
        assert getattr(single, name).dtype == np.float32
        assert getattr(single, name) == pytest.approx(getattr(double, name), rel=3e-6)


ELASTIC = {model.name: model for model in (bs.Exact(), bs.Tabulated(), bs.Refined())} | {"curve": bs.ExactCurve()}
BEYOND = {"force": [3000.0, 1e9], "half_angle": np.radians([84.9, 85.1]), "indentation": [0.01, 1e5]}


@pytest.mark.parametrize("model", ELASTIC.values(), ids=ELASTIC)
@pytest.mark.parametrize("kind", BEYOND)
def test_loads_beyond_85_degrees_have_no_result(model, kind):
    contact = model.press(HIP, **{kind: BEYOND[kind]})
    np.testing.assert_array_equal(contact.status, [bs.Status.OK, bs.Status.NOT_REACHED])
    for name in {"force", "half_angle", "max_pressure", "energy", "foundation_modulus"} - {kind}:
        np.testing.assert_array_equal(np.isnan(getattr(contact, name)), [False, True])


ABSURD = [(1e-200, 18.0), (1e-308, 18.0), (1.0, 1e-160), (1e-300, 1e200), (1e300, 1e5), (1.0, 1e150), (1e308, 1e308)]


@pytest.mark.parametrize(("young", "radius"), ABSURD)
@pytest.mark.parametrize("load", [{"half_angle": 0.5}, {"force": 1.0}, {"indentation": 1e-3}])
def test_extreme_joints_have_a_status_or_numbers(young, radius, load):
    liner = bs.Material(young=young, poisson=0.4)
    joint = bs.Joint(ball_radius=radius, clearance=1e-3 * radius, liner_thickness=radius / 2, liner=liner)
    contact = bs.Exact().press(joint, **load)
    known = [isfinite(getattr(contact, name)) for name in NUMBERS]
    assert all(known) or (contact.status.failed and contact.notes)


@pytest.mark.parametrize("model", EVERY.values(), ids=EVERY)
def test_empty_arrays_give_empty_contacts(model):
    none = np.zeros(0)
    for joint, force, shape in (
        (HIP, none, (0,)),
        (replace(HIP, clearance=none), 3.0, (0,)),
        (replace(HIP, clearance=np.full((3, 1), 0.1)), np.zeros((1, 0)), (3, 0)),
        (replace(HIP, liner=replace(bs.UHMWPE, yield_stress=none)), 3.0, (0,)),
    ):
        contact = model.press(joint, force=force)
        for name in (*CONTACT, "pressure_integral", "utilisation", "valid", "status"):
            assert getattr(contact, name).shape == shape, name
        assert contact.notes == ()
        assert contact.pressure(0.1).shape == shape


def test_integers_of_all_types_are_numbers():
    sizes = {"ball_radius": 250, "clearance": 10, "liner_thickness": 100}
    lengths = {name: np.array([size], dtype=np.uint8) for name, size in sizes.items()}
    lengths["liner_thickness"] = np.uint8(100)
    small = bs.Joint(**lengths, liner=bs.Material(young=np.int8(100), poisson=0.3))
    assert small.socket_radius.tolist() == [260.0]
    assert small.thickness_ratio.tolist() == [2.6]
    twin = bs.Joint(**sizes, liner=bs.Material(young=100.0, poisson=0.3))
    force = bs.HessForsbach().press(small, indentation=np.uint8(200)).force
    assert force == pytest.approx(bs.HessForsbach().press(twin, indentation=200.0).force, rel=1e-12)


BASE = {"ball_radius": 14.0, "clearance": 0.1, "liner": bs.UHMWPE, "ball": bs.COCR}
SHELL, CEMENT = bs.Layer(thickness=3.0, material=bs.TITANIUM), bs.Layer(thickness=3.0, material=bs.BONE_CEMENT)
BONE = bs.Layer(thickness=np.inf, material=bs.CANCELLOUS_BONE)
ENDLESS = {
    "bone": bs.Joint(**BASE, liner_thickness=5.0, backing=(SHELL, CEMENT, BONE)),
    "massive": bs.Joint(**BASE, liner_thickness=np.inf),
    "pivot": bs.joints["tilting-pad-pivot"],
}
MODELS = (bs.Exact(), bs.FiniteElement(meshes=1))


@pytest.mark.long
@pytest.mark.parametrize("name", ENDLESS)
def test_models_of_different_bodies_state_their_bodies(name):
    joint = ENDLESS[name]
    exact, fem = (model.press(joint, force=3000.0) for model in MODELS)
    assert fem.indentation > 1.05 * exact.indentation
    assert fem.max_pressure == pytest.approx(exact.max_pressure, rel=0.04)
    covered = bs.Exact().in_cup(bs.Cup(arc_of_cover=3.0)).press(joint, force=3000.0)
    assert set(exact.notes) <= set(covered.notes)
    assert exact.valid == (fem.indentation < 1.15 * exact.indentation)
    assert any(note.startswith("closed sphere: ") and " d +" in note for note in exact.notes)
    assert fem.valid
    assert any("is cut off at the plane of" in note and "d differs by more than 2 %" in note for note in fem.notes)


def test_models_of_soft_balls_state_a_full_or_half_ball():
    joint = bs.Joint(**{**BASE, "ball": bs.UHMWPE}, liner_thickness=5.0)
    exact, fem = (model.press(joint, force=1000.0) for model in MODELS)
    assert fem.indentation > 1.1 * exact.indentation
    assert any(note.startswith("closed sphere: ") and " d +" in note for note in exact.notes)
    assert any("the ball is half a one on its equator;" in note for note in fem.notes)


@pytest.mark.parametrize("backing", [(), (SHELL,)])
def test_models_that_agree_have_no_notes(backing):
    exact, fem = (model.press(bs.Joint(**BASE, liner_thickness=5.0, backing=backing), force=1000.0) for model in MODELS)
    assert fem.indentation == pytest.approx(exact.indentation, rel=0.02)
    assert exact.notes == fem.notes == ()
