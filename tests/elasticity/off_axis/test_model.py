"""`Sphere` against the exact solution, finite elements, another program, closed forms and conservation laws."""

import json
import os
from dataclasses import replace
from math import cos, pi, radians, sin

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis import load_cases
from ballsocket.studies import table

from ...extent import either, some
from ...joints import HIP, lined
from ...places import DATA
from .shapes import COARSE, RIGID, direction

REAL_CUP = json.loads((DATA / "real_cup.json").read_text(encoding="utf-8"))
STEPS = [(case, step) for case in REAL_CUP["cases"] for step in case["steps"]]


# --- other solutions ---


@pytest.mark.parametrize(("case", "step"), STEPS)
def test_three_dimensional_elements_give_the_same_force_and_pressure(case, step):
    contact = bs.Sphere().press(lined(case["poisson"]), indentation=step["indentation"], tilt=radians(case["tilt_deg"]))
    size = np.hypot(step["force_lateral"], step["force_axial"])
    assert contact.force_vector[0] == pytest.approx(step["force_lateral"], abs=1.5e-3 * size)
    assert contact.force_vector[2] == pytest.approx(step["force_axial"], rel=1.5e-3)
    assert contact.force_vector[1] == pytest.approx(0.0, abs=1e-6 * size)
    assert contact.max_pressure == pytest.approx(step["max_pressure"], rel=2.5e-3)


LOOSE = lined(0.3, ball_radius=17.1, clearance=0.9)  # has a circular gap
SHELLS = [lined(0.4), lined(0.49), lined(0.3, ball=bs.STEEL), lined(0.0, ball=bs.STEEL), LOOSE]


@pytest.mark.parametrize("joint", some(SHELLS, 1))
def test_closed_shell_agrees_with_the_exact_solution(joint):
    d = 0.6 * joint.clearance
    contact = bs.Sphere(surface=bs.ClosedShell(), ring_width=radians(1.0)).press(joint, indentation=d, tilt=[0.35, 0.0])
    exact = bs.Exact().press(joint, indentation=d)
    for name in ("force", "max_pressure", "energy"):
        assert getattr(contact, name) == pytest.approx(getattr(exact, name), rel=3e-4)
    assert contact.half_angle == pytest.approx(exact.half_angle, abs=radians(0.2))


TITANIUM_ON_BONE = bs.Layer(thickness=4.0, material=bs.TITANIUM), bs.Layer(thickness=20.0, material=bs.CANCELLOUS_BONE)
CUPS = {
    "hemisphere": (bs.Cup(), ()),
    "160 degrees and a chamfer": (bs.Cup(arc_of_cover=radians(160.0), chamfer=0.5), ()),
    "sliding in titanium on bone": (bs.Cup(interface=bs.Interface.SLIDING), TITANIUM_ON_BONE),
    "200 degrees": (bs.Cup(arc_of_cover=radians(200.0)), ()),
}


@pytest.mark.parametrize("name", some(CUPS, 1))
def test_axial_load_agrees_with_axisymmetric_elements(name):
    """F, pmax and U agree within 0.1 % with a rigid ball; the elements model an elastic one differently."""
    cup, backing = CUPS[name]
    joint = lined(0.45, backing=backing)
    contact = bs.Sphere(cup=cup).press(joint, indentation=0.05)
    elements = bs.FiniteElement(cup=cup, meshes=1).press(joint, indentation=0.05)
    for name in ("force", "max_pressure", "energy"):
        assert getattr(contact, name) == pytest.approx(getattr(elements, name), rel=1e-3)


def test_springs_agree_with_the_closed_form():
    model = bs.Sphere(surface=bs.Springs(), ring_width=radians(0.5))
    contact = model.press(RIGID, indentation=0.04, tilt=[0.0, 0.3, 0.6])
    closed = bs.HessForsbach().press(RIGID, indentation=0.04)
    for name in ("force", "max_pressure", "energy", "pressure_integral"):
        assert getattr(contact, name) == pytest.approx(getattr(closed, name), rel=1e-4)
    assert contact.half_angle == pytest.approx(closed.half_angle, abs=radians(0.05))


@pytest.mark.long
def test_error_estimates_hold():
    random = np.random.default_rng(7)
    names = ("force", "half_angle", "max_pressure", "stiffness", "energy", "pressure_integral")
    ratios = []
    for _ in range(10):
        joint = lined(random.choice([0.0, 0.3, 0.45]), clearance=10 ** random.uniform(-2, -0.5))
        exact = bs.Exact().press(joint, half_angle=np.radians(random.uniform(14.0, 60.0, 12)))
        model = bs.Sphere(surface=bs.ClosedShell(), ring_width=radians(random.choice([2.0, 4.0])))
        contact = model.press(joint, indentation=exact.indentation, tilt=random.uniform(0.0, 0.4, 12))
        ratios += [abs(getattr(contact, name) / getattr(exact, name) - 1) / contact.error[name] for name in names]
        wide = model.press(joint, half_angle=exact.half_angle[:2], tilt=0.3)
        computed = [name for name in names if name != "half_angle"]
        ratios += [abs(getattr(wide, name) / getattr(exact, name)[:2] - 1) / wide.error[name] for name in computed]
    ratios = np.concatenate(ratios)
    assert (ratios <= 1).mean() >= 0.94
    assert ratios.max() < 3


def test_stiffness_is_that_of_the_exact_solution_and_does_not_jump_as_rings_touch():
    """Between the first load and the last the edge crosses seven rings."""
    force = np.geomspace(800.0, 4000.0, 41)
    contact = bs.Sphere(surface=bs.ClosedShell()).press(RIGID, force=force)
    deviation = contact.stiffness / bs.Exact().press(RIGID, force=force).stiffness - 1
    assert (abs(deviation) <= contact.error["stiffness"]).all()
    assert contact.error["stiffness"].max() < 4e-3
    assert abs(np.diff(deviation)).max() < 3e-3  # an entering ring would add 0.07


# --- conservation laws and symmetry ---


@pytest.mark.parametrize(
    ("tilt", "gap", "asymmetry"),
    some([(0.4, bs.LinearGap, 1e-6), (1.0, bs.LinearGap, 1e-6), (1.0, bs.CircularGap, 0.14 / 18)], 2),
)
def test_force_is_the_slope_of_energy_and_stiffness_that_of_force(tilt, gap, asymmetry):
    """The forces of a circular gap have no potential, but for the ratio of displacement and radius."""
    model, d, h = bs.Sphere(gap=gap), 0.04, 1e-4
    below, middle, above = (model.press(RIGID, indentation=depth, tilt=tilt) for depth in (d - h, d, d + h))
    n = direction(tilt)
    assert (above.energy - below.energy) / (2 * h) == pytest.approx(middle.force_vector @ n, rel=1e-4)
    fine = bs.Sphere(
        ring_width=radians(either(quick=2.0, long=1.0)), gap=gap
    )  # the edge crosses several rings: the quotient does not see them
    force = fine.press(RIGID, indentation=[0.9 * d, 1.1 * d], tilt=tilt).force_vector
    slope = (force[1] - force[0]) / (0.2 * d)  # the edge crosses rings: the quotient does not see a single one
    error = middle.error["stiffness"] + fine.press(RIGID, indentation=d, tilt=tilt).error["stiffness"]
    assert slope == pytest.approx(middle.stiffness_matrix @ n, abs=error * np.linalg.norm(slope))
    assert middle.stiffness_matrix == pytest.approx(
        middle.stiffness_matrix.T, abs=asymmetry * middle.stiffness_matrix.max()
    )
    assert np.linalg.eigvalsh(middle.stiffness_matrix).min() > 0


def test_axial_contact_is_uniform_around_the_pole():
    """Cells are narrow there, and the residual of the iteration must not become pressure."""
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(40.0)), ring_width=radians(either(quick=1.0, long=0.5)))
    contact = model.press(lined(), indentation=0.006)
    assert np.ptp(contact.pressure_map[2][0]) < 1e-4 * contact.max_pressure
    assert contact.max_pressure_angle == 0.0


def test_contact_is_independent_of_the_meridians():
    azimuth = np.array([0.0, 0.013, 0.7, 2.0])
    contact = bs.Sphere().press(RIGID, force=3000.0, tilt=0.9, azimuth=azimuth)
    for name in ("indentation", "max_pressure", "half_angle", "energy"):
        value = getattr(contact, name)
        assert value == pytest.approx(value[0], rel=1e-3)
    assert contact.edge_distance == pytest.approx(contact.edge_distance[0], abs=5e-3)


def test_load_that_rotates_with_the_cup_gives_the_same_contact():
    cup = bs.Cup(inclination=radians(45.0), anteversion=radians(15.0), side=bs.Side.LEFT)
    straight = bs.Sphere().press(RIGID, force=2000.0, tilt=0.5)
    turned = bs.Sphere(cup=cup).press(RIGID, force=2000.0, direction=direction(0.5) @ np.array(cup.frame))
    assert turned.force_vector == pytest.approx(straight.force_vector, rel=1e-6, abs=1e-3)
    assert turned.max_pressure == pytest.approx(straight.max_pressure, rel=1e-6)
    upright = bs.Sphere(cup=cup).press(RIGID, force=2000.0)
    assert upright.tilt == pytest.approx(cup.tilt((0.0, 0.0, 1.0)))


def test_contact_has_its_prescribed_half_angle_or_a_status():
    contact = bs.Sphere().press(RIGID, half_angle=0.7, tilt=0.3)
    assert contact.half_angle == pytest.approx(0.7, rel=1e-3)
    angle, tilt = np.meshgrid([0.2, 0.5, 0.8, 1.1, 1.5], np.linspace(0.0, 1.4, 7))
    wide = bs.Sphere(ring_width=radians(6.0)).press(RIGID, half_angle=angle, tilt=tilt)
    solved = wide.status == 0
    assert abs(wide.half_angle - angle)[solved].max() < 0.5 * radians(6.0)
    assert solved[angle + tilt < radians(80.0)].all()
    assert (wide.status[angle == 1.5] == int(bs.Status.NOT_REACHED)).all()  # wider than a hemisphere


# --- rim, worn bores and paths of displacements ---


def test_contact_at_the_rim_moves_towards_it_is_reported_and_unbounded_at_a_sharp_rim():
    inside, cut = (bs.Sphere().press(RIGID, force=3000.0, tilt=tilt) for tilt in (0.5, 1.1))
    assert not inside.edge_loaded
    assert inside.edge_distance == pytest.approx(18.0 * (pi / 2 - 0.5 - inside.half_angle), abs=0.15)
    assert inside.rim_distance == pytest.approx(18.0 * (pi / 2 - 0.5))
    assert cut.edge_loaded
    assert cut.force_vector == pytest.approx(3000.0 * direction(1.1), abs=1e-2)
    assert np.arctan2(cut.displacement[0], cut.displacement[2]) > 1.1  # the rim is softer
    assert any("edge loading" in note for note in cut.notes)
    assert np.isfinite(cut.max_pressure)
    sharp = bs.Sphere(cup=bs.Cup(chamfer=1.0)).press(RIGID, force=3000.0, tilt=1.1)
    assert sharp.max_pressure == np.inf
    assert any("unbounded" in note for note in sharp.notes)
    assert sharp.force == pytest.approx(3000.0)


def test_bore_worn_to_the_shape_of_the_ball_has_no_clearance():
    """A bore worn to the displaced sphere of the ball has the pressure of a joint without clearance."""
    fitted = bs.BoreDeviation(of=lambda n: 0.1 * n[2] - 0.1)  # the surface of the ball at first touch, offset inwards
    worn = bs.Sphere(worn=fitted, surface=bs.Springs()).press(RIGID, indentation=0.01)
    angle = np.linspace(0.0, 1.2, 5)
    assert worn.pressure(angle) == pytest.approx(bs.hess_forsbach(RIGID) * 0.01 * np.cos(angle), rel=2e-3)


def test_ball_displaced_sideways_meets_the_rim():
    """Microseparation: half a millimetre sideways and back into the bore, with a circular gap."""
    path = np.stack([np.linspace(0.1, 0.55, 5), np.zeros(5), np.linspace(-0.5, 0.0, 5)], axis=-1)
    contact = replace(COARSE, gap=bs.CircularGap).press(RIGID, displacement=path)
    assert (np.diff(contact.force) > 0)[1:].all()
    assert contact.edge_loaded[-1]
    assert contact.displacement[contact.force > 0] == pytest.approx(path[contact.force > 0])
    assert COARSE.press(RIGID, displacement=(0.05, 0.0, 0.02)).force == 0  # within the clearance


def test_summaries_have_the_numbers_of_contacts_with_fields(monkeypatch):
    monkeypatch.setattr(load_cases, "_BLOCK_LOADS", 2)
    force, tilt = np.array([300.0, 3000.0, 1000.0]), np.array([0.1, 1.2, 0.6])
    contact, summary = (COARSE.press(HIP, force=force, tilt=tilt, keep=keep) for keep in ("fields", "summary"))
    for name in ("indentation", "half_angle", "max_pressure", "energy", "edge_margin", "max_error"):
        of_contact, of_summary = (getattr(each, name, getattr(each.laws, name, None)) for each in (contact, summary))
        assert of_summary == pytest.approx(of_contact, rel=1e-6)
    assert summary.stiffness_matrix == pytest.approx(contact.stiffness_matrix, rel=1e-4, abs=1.0)
    assert summary.notes == contact.notes
    with pytest.raises(ValueError, match='a summary has no pressure: profiles, .* press with keep="fields"'):
        summary.pressure(0.1)


def test_contacts_that_exceed_the_memory_are_refused_before_the_work():
    with pytest.raises(ValueError, match='2 000 000 contacts .none with keep="summary". take about .* of memory'):
        COARSE.press(HIP, force=np.linspace(1.0, 2.0, 2_000_000))
    many = np.broadcast_to(1000.0, (10**6, 10**6))  # one number in memory, and more contacts than fit
    with pytest.raises(ValueError, match="1 000 000 000 000 contacts take about .* of memory"):
        COARSE.press(HIP, force=many, tilt=0.1, keep="summary")


# --- studies ---


@pytest.mark.long
def test_study_has_orientations_as_axes():
    cup = bs.Cup(inclination=radians(45.0))
    model = bs.Sphere(cup=cup, ring_width=radians(4.0))
    axes = {"inclination": np.radians([30.0, 45.0, 60.0]), "anteversion": np.radians([0.0, 20.0])}
    study = bs.study(model, RIGID, **axes, force=2000.0, quantities=["max_pressure", "edge_distance"])
    assert study.sizes == {"inclination": 3, "anteversion": 2}
    single = replace(model, cup=replace(cup, inclination=radians(60.0), anteversion=radians(20.0)))
    point = study.sel(inclination=radians(60.0), anteversion=radians(20.0), method="nearest")
    assert float(point.max_pressure) == pytest.approx(single.press(RIGID, force=2000.0).max_pressure, rel=2e-3)
    assert (np.diff(study.edge_distance, axis=0) < 0).all()
    assert bs.study(model, RIGID, tilt=[0.0, 0.7], force=2000.0, quantities=["max_pressure"]).sizes == {"tilt": 2}


OVAL = bs.Sphere(ring_width=radians(6.0), worn=bs.OvalBore(squeeze=0.1))
AXES = {"tilt": [0.2, 0.7], "azimuth": [0.0, pi / 2], "force": [500.0, 2000.0]}


def test_study_has_directions_and_steps_as_axes(tmp_path):
    """All loads of a step are one call; the contact in an oval bore depends on the azimuth."""
    study = bs.study(OVAL, RIGID, quantities=["max_pressure", "edge_distance"], **AXES)
    assert study.max_pressure.dims == ("tilt", "azimuth", "force")
    assert study.edge_distance.attrs["units"] == "mm"
    single = OVAL.press(RIGID, force=2000.0, direction=(0.0, sin(0.7), cos(0.7)))
    point = study.sel(tilt=0.7, azimuth=pi / 2, force=2000.0)
    assert float(point.max_pressure) == pytest.approx(single.max_pressure, rel=1e-4)
    assert float(abs(study.max_pressure.diff("azimuth")).max()) > 0.05
    step_file = tmp_path / "step.csv"
    step_file.write_text("tilt_deg,azimuth_deg,force_N\n10,0,500\n30,17,900\n40,337,700\n", encoding="utf-8")
    step = bs.study(OVAL, RIGID, table(step_file))
    assert step.max_pressure.dims == ("row",)
    assert np.isfinite(step.max_pressure).all()


# --- random cups: each contact obeys the laws of contact or has a status ---

LOADS = 5
COUNT = int(os.environ.get("BALLSOCKET_CUPS", "0")) or either(quick=6, long=20)
SIZES = ("force", "indentation", "half_angle", "pole_pressure", "stiffness", "energy", "pressure_integral")
PLACES = ("edge_distance", "edge_margin", "rim_distance", "tilt", "max_pressure_angle", "max_pressure_at")
VECTORS = ("displacement", "moment", "force_vector", "stiffness_matrix")
"""Quantities that are finite in every solution; the largest pressure may be unbounded."""


def draw_joint(random):
    radius = 10 ** random.uniform(0.5, 2.0)
    thickness, material = radius * random.uniform(0.1, 0.5), random.choice([bs.TITANIUM, bs.CANCELLOUS_BONE])
    return bs.Joint(
        ball_radius=radius,
        clearance=radius * 10 ** random.uniform(-4.0, -1.3),
        liner_thickness=radius * 10 ** random.uniform(-1.0, 0.5),
        liner=bs.Material(young=10 ** random.uniform(0.0, 5.5), poisson=random.choice([0.0, 0.3, 0.45, 0.49, 0.4999])),
        ball=random.choice([None, bs.STEEL, bs.UHMWPE]),
        backing=(bs.Layer(thickness=thickness, material=material),) if random.random() < 0.3 else (),
    )


def draw_model(random, joint):
    radius = float(joint.ball_radius)
    cup = bs.Cup(
        arc_of_cover=radians(random.uniform(60.0, 340.0)),
        chamfer=random.choice([0.0, 0.0, 0.02 * radius]),
        interface=random.choice(list(bs.Interface)),
        inclination=radians(random.uniform(0.0, 90.0)),
        anteversion=radians(random.uniform(-60.0, 60.0)),
        side=random.choice(list(bs.Side)),
    )
    worn = bs.BoreDeviation(of=lambda n: 0.5 * joint.clearance * n[0] ** 2)
    shapes = [None, None, bs.OvalBore(squeeze=float(joint.clearance)), worn]
    surface = [bs.RealCup(), bs.RealCup(), bs.RealCup(), bs.ClosedShell(), bs.Springs()]
    return bs.Sphere(
        cup=cup,
        surface=surface[random.integers(5)],
        ring_width=radians(random.uniform(5.0, 6.0)),
        gap=random.choice([bs.LinearGap, bs.CircularGap]),
        worn=shapes[random.integers(4)],
    )


def draw(seed):
    random = np.random.default_rng(seed)
    joint = draw_joint(random)
    model = draw_model(random, joint)
    spread = random.choice([0.3, 1.0, 10.0])  # from about the dome to anywhere
    direction = random.normal(size=(LOADS, 3)) * spread + np.array(model.cup.dome)
    kind = random.choice(["force", "force", "indentation", "half_angle"])
    loads = {  # from far below to far above those that make a contact of this joint
        "force": joint.liner.young * joint.ball_radius**2 * 10 ** random.uniform(-8.0, -0.5, LOADS),
        "indentation": joint.clearance * 10 ** random.uniform(-2.0, 1.2, LOADS),
        "half_angle": random.uniform(0.05, 1.5, LOADS),
    }
    return model, joint, kind, loads[kind], direction


@pytest.mark.parametrize("tenth", range(min(COUNT, 10)))
def test_random_contacts_obey_the_laws_of_contact_or_have_a_status(tenth):
    for seed in range(tenth, COUNT, 10):
        model, joint, kind, load, direction = draw(seed)
        contact = model.press(joint, direction=direction, **{kind: load})
        in_cup = direction @ np.array(model.cup.frame).T
        in_cup /= np.linalg.norm(in_cup, axis=-1, keepdims=True)
        check_numbers(contact, kind, seed)
        check_laws(contact, in_cup, seed)
        if kind == "force":
            residual = np.linalg.norm(contact.force_vector - load[:, None] * in_cup, axis=-1)
            assert (residual <= 1e-5 * load)[contact.status == 0].all(), seed


def check_numbers(contact, kind, seed):
    solved = contact.status == 0
    for name in SIZES + PLACES + VECTORS:
        value = getattr(contact, name)
        assert np.isfinite(value[solved]).all(), (seed, name)
        assert name == kind or name in ("tilt", "rim_distance") or np.isnan(value[~solved]).all(), (seed, name)
    largest = contact.max_pressure
    assert (largest[solved] >= 0).all(), seed
    assert (np.isfinite(largest) | contact.edge_loaded)[solved].all(), seed


def check_laws(contact, direction, seed):
    """Check that no pressure pulls or lies outside the bore, and that pressures carry the load."""
    solved, reach = contact.status == 0, float(contact.model.reach_of(contact.joint))
    size = np.linalg.norm(contact.force_vector, axis=-1)
    along = (contact.force_vector * direction).sum(axis=-1)
    assert (along >= -1e-9 * size)[solved].all(), seed
    loaded = solved & (size > 0)
    assert (contact.edge_loaded == (contact.edge_margin <= 0))[loaded].all(), seed
    polar = np.arccos(np.clip(contact.max_pressure_at[..., 2], -1, 1))
    assert (polar <= reach + 1e-6)[loaded].all(), seed
    for state in (piece.state for _, piece in contact.laws.pieces):
        assert (state.equilibrium.pressure >= 0).all(), seed
        converged = state.equilibrium.converged & ~state.dislocated
        carried = state.bore.force(state.equilibrium.pressure)[converged]
        assert carried == pytest.approx(state.force_vector.T[converged])
        touch = converged & (state.equilibrium.pressure > 0).any(axis=(1, 2))
        for patch in (patch for patch, touches in zip(state.patches, touch, strict=True) if touches):
            assert (patch.outline[:, 2] >= np.cos(reach) - 1e-6).all(), seed
