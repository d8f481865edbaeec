"""Finite-element contact against the exact solution, an independent program, and finer meshes."""

import json
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.arrays import gauss_legendre
from ballsocket.elasticity.finite_elements.mesh import Resolution
from ballsocket.reports.section_plots import section_figure

from ...extent import either, some
from ...joints import HIP
from ...places import DATA

FULL = bs.Cup(arc_of_cover=np.radians(340.0))
"""A socket that is nearly a whole sphere: there the exact solution is the truth."""

WHOLE = bs.FiniteElement(cup=FULL, meshes=1)
"""Model without the coarser mesh of the error estimate, which changes no other result."""

CALCULIX = json.loads((DATA / "calculix.json").read_text(encoding="utf-8"))["cases"]
RIGID = replace(HIP, ball=None)
QUANTITIES = ("force", "indentation", "half_angle", "max_pressure", "stiffness", "energy", "pressure_integral")


def lined(poisson=0.4, thickness=6.75, **more):
    liner = bs.Material(young=1000.0, poisson=poisson)
    return bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=thickness, liner=liner, **more)


@pytest.fixture(scope="module")
def hip():
    """Solved contact with error bars, for tests that only read it."""
    return bs.FiniteElement().press(HIP, force=3000.0)


# --- against the exact answer ---


FORCES = (30.0, 300.0, 3000.0)
LINERS = ((0.3, 6.75), (0.4, 6.75), (0.49, 6.75), (0.4, 2.25), (0.499, 3.0), (0.0, 6.75))
EACH_LINER_ONCE = [(liner, FORCES[number % 3]) for number, liner in enumerate(LINERS)]


@pytest.mark.parametrize(("liner", "force"), either(quick=EACH_LINER_ONCE[1::3], long=list(product(LINERS, FORCES))))
def test_a_full_shell_has_the_exact_solution(liner, force):
    joint = lined(*liner)
    ours, exact = WHOLE.press(joint, force=force), bs.Exact().press(joint, force=force)
    for name in QUANTITIES:
        assert getattr(ours, name) == pytest.approx(getattr(exact, name), rel=5e-4), name
    angle = np.linspace(0.0, 0.9, 10) * exact.half_angle
    np.testing.assert_allclose(ours.pressure(angle), exact.pressure(angle), atol=2e-3 * exact.max_pressure)


@pytest.mark.long
def test_a_rim_at_137_degrees_does_not_change_the_contact():
    cup = bs.Cup(arc_of_cover=np.radians(274.0))
    ours, exact = bs.FiniteElement(cup=cup, meshes=1).press(RIGID, force=3000.0), bs.Exact().press(RIGID, force=3000.0)
    for name in QUANTITIES:
        assert getattr(ours, name) == pytest.approx(getattr(exact, name), rel=5e-4), name


@pytest.mark.parametrize("clearance", some([0.02, 1.0, 0.1], 1))
def test_a_full_shell_with_a_circular_gap_has_the_exact_solution(clearance):
    joint = replace(RIGID, clearance=clearance)
    load = {"force": np.array([200.0, 2000.0])}
    ours, exact = (
        model.press(joint, **load) for model in (replace(WHOLE, gap=bs.CircularGap), bs.Exact(gap=bs.CircularGap))
    )
    for name in QUANTITIES:
        np.testing.assert_allclose(getattr(ours, name), getattr(exact, name), rtol=1e-3, err_msg=name)


@pytest.mark.parametrize(
    "backing",
    [
        (bs.Layer(thickness=4.0, material=bs.TITANIUM),),
        (bs.Layer(thickness=4.0, material=bs.UHMWPE), bs.Layer(thickness=2.0, material=bs.CANCELLOUS_BONE)),
    ],
    ids=["metal", "soft"],
)
def test_a_backed_liner_has_the_exact_solution(backing):
    joint = lined(backing=backing)
    ours, exact = WHOLE.press(joint, force=2000.0), bs.Exact().press(joint, force=2000.0)
    for name in QUANTITIES:
        assert getattr(ours, name) == pytest.approx(getattr(exact, name), rel=1e-3), name


@pytest.mark.long
def test_a_massive_socket_has_the_exact_solution():
    joint = lined(thickness=np.inf)
    ours, exact = WHOLE.press(joint, force=30.0), bs.Exact().press(joint, force=30.0)
    assert ours.indentation == pytest.approx(exact.indentation, rel=1e-3)
    assert ours.max_pressure == pytest.approx(exact.max_pressure, rel=1e-3)


@pytest.mark.parametrize("force", some([30.0, 300.0, 3000.0], 1))
def test_stresses_are_the_exact_ones(force):
    ours, exact = WHOLE.press(RIGID, force=force), bs.Exact().press(RIGID, force=force)
    assert ours.peak_stress.von_mises == pytest.approx(exact.peak_stress.von_mises, rel=4e-3)
    assert ours.peak_stress.depth == pytest.approx(exact.peak_stress.depth, abs=0.25)
    liner = ours.section["liner"]
    deep = (liner.radius > 19.0) & (liner.angle > 0) & (liner.angle < 1.0) & (liner.radius < 24.0)
    theirs = exact.stress(liner.angle[deep], liner.radius[deep] - 18.0)
    for name in ("radial", "meridional", "hoop", "shear"):
        difference = abs(getattr(liner.stress, name)[deep] - getattr(theirs, name))
        assert difference.max() < 0.01 * exact.max_pressure, name


@pytest.mark.long
def test_the_peak_stress_of_a_massive_socket_lies_under_the_contact():
    pivot = bs.joints["tilting-pad-pivot"]
    ours, exact = (model.press(pivot, force=3000.0) for model in (bs.FiniteElement(meshes=1), bs.Exact()))
    assert ours.peak_stress.von_mises == pytest.approx(exact.peak_stress.von_mises, rel=2e-2)
    assert ours.peak_stress.depth == pytest.approx(exact.peak_stress.depth, abs=0.25)


@pytest.mark.long
def test_displacements_of_the_bore_are_the_exact_ones():
    ours, exact = WHOLE.press(RIGID, force=3000.0), bs.Exact().press(RIGID, force=3000.0)
    liner = ours.section["liner"]
    bore = (liner.radius < 18.0 + 1e-9) & (liner.angle < 1.5)
    across, up = liner.displacement[:, bore]
    angle = liner.angle[bore]
    outwards = across * np.sin(angle) - up * np.cos(angle)
    np.testing.assert_allclose(outwards, exact.displacement(angle), atol=2e-3 * exact.indentation)


# --- against CalculiX ---


@pytest.mark.long
@pytest.mark.parametrize("case", some(CALCULIX), ids=lambda case: case["name"])
def test_calculix_has_the_same_indentation_pressure_and_half_angle(case):
    """Steel half ball pushed by its equator, hemispherical liner, linearised: the same problem by other elements."""
    joint = bs.Joint(
        ball_radius=case["ball_radius"],
        clearance=case["clearance"],
        liner_thickness=case["liner_thickness"],
        liner=bs.Material(young=case["young"], poisson=case["poisson"]),
        ball=bs.Material(young=case["ball_young"], poisson=case["ball_poisson"]),
    )
    theirs = {name: np.array([step[name] for step in case["linearised"]]) for name in case["linearised"][0]}
    ours = bs.FiniteElement().press(joint, force=theirs["force"])
    np.testing.assert_allclose(ours.indentation, theirs["indentation"], rtol=1e-3)
    np.testing.assert_allclose(ours.max_pressure, theirs["max_pressure"], rtol=1e-3)
    np.testing.assert_allclose(np.degrees(ours.half_angle), theirs["half_angle_deg"], atol=0.12)


# --- what the exact solution leaves out ---


@pytest.mark.long
def test_the_rim_softens_wide_contacts_most():
    """A hemisphere is softer near its rim; a complete sphere is not."""
    angle = np.radians([30.0, 50.0, 70.0, 80.0])
    joint = lined(0.49, 15.0)
    open_, closed = (bs.FiniteElement(cup=cup, meshes=1).press(joint, half_angle=angle) for cup in (bs.Cup(), FULL))
    softer = closed.stiffness / open_.stiffness - 1
    assert np.all(np.diff(softer) > 0)
    assert softer[-1] > 0.1


@pytest.mark.long
def test_arcs_of_cover_below_a_hemisphere_are_softer():
    arcs = np.radians(some([120.0, 140.0, 160.0, 180.0]))
    depths = [
        bs.FiniteElement(cup=bs.Cup(arc_of_cover=arc), meshes=1).press(HIP, force=3000.0).indentation for arc in arcs
    ]
    assert np.all(np.diff(depths) < 0)


@pytest.mark.long
def test_a_contact_that_fills_the_socket_has_a_status_and_numbers():
    cup = bs.Cup(arc_of_cover=np.radians(70.0))
    loads = np.array(some([100.0, 2500.0, 3500.0, 4500.0], 2))
    model = bs.FiniteElement(cup=cup, meshes=1)
    contact = model.press(HIP, force=loads)
    assert contact.status.tolist() == [0, *[bs.Status.AT_RIM] * (len(loads) - 1)]
    assert contact.valid.tolist() == [True, *[False] * (len(loads) - 1)]
    note = f"{len(loads) - 1} of {len(loads)}: the contact fills the socket and reaches its rim"
    assert note in contact.notes
    np.testing.assert_allclose(np.degrees(contact.half_angle[1:]), 35.0)
    np.testing.assert_allclose(contact.force, loads, rtol=1e-9)
    assert np.all(np.diff(contact.indentation) > 0)
    again = model.press(HIP, indentation=contact.indentation)
    np.testing.assert_allclose(again.force, loads, rtol=1e-6)


def test_force_and_stiffness_do_not_jump_where_the_contact_reaches_the_rim():
    model = bs.FiniteElement(cup=bs.Cup(arc_of_cover=np.radians(70.0)), meshes=1)
    at = model.press(HIP, half_angle=np.radians(35.0))
    around = at.indentation * np.array([0.999, 1.001])
    below, beyond = model.press(HIP, indentation=around).force
    assert below < at.force < beyond
    assert beyond - below == pytest.approx(at.stiffness * np.diff(around)[0], rel=0.02)


def test_with_hardly_any_clearance_every_load_has_the_same_half_angle():
    contact = bs.FiniteElement(meshes=1).press(replace(HIP, clearance=1e-6), force=np.array([1000.0, 3000.0]))
    assert contact.half_angle[0] == pytest.approx(contact.half_angle[1], rel=1e-3)
    assert contact.indentation[1] == pytest.approx(3 * contact.indentation[0], rel=1e-3)
    with pytest.raises(ValueError, match="fem has no answer for c = 0"):
        bs.FiniteElement().press(replace(HIP, clearance=0.0), force=1000.0)


def test_a_liner_that_slides_is_softer_than_a_bonded_one():
    bonded, sliding = (
        bs.FiniteElement(cup=bs.Cup(interface=interface), meshes=1).press(HIP, force=3000.0)
        for interface in bs.Interface
    )
    assert sliding.indentation > 1.1 * bonded.indentation
    assert sliding.max_pressure < bonded.max_pressure


@pytest.mark.long
def test_a_liner_that_slides_on_a_stiff_shell_slides_as_on_a_rigid_one():
    cup = bs.Cup(interface=bs.Interface.SLIDING)
    shell = bs.Layer(thickness=4.0, material=bs.Material(young=1e9, poisson=0.3))
    rigid, stiff = (
        bs.FiniteElement(cup=cup, meshes=1).press(joint, force=3000.0)
        for joint in (HIP, replace(HIP, backing=(shell,)))
    )
    for name in ("indentation", "half_angle", "max_pressure"):
        assert getattr(stiff, name) == pytest.approx(getattr(rigid, name), rel=3e-4), name


def test_a_free_shell_is_softer_than_a_fixed_one():
    shell = bs.Layer(thickness=4.0, material=bs.UHMWPE)
    fixed, free = (replace(HIP, backing=(shell,), support=support) for support in bs.Support)
    stiff, soft = (bs.FiniteElement(meshes=1).press(joint, force=2000.0) for joint in (fixed, free))
    assert soft.indentation > 1.2 * stiff.indentation


@pytest.mark.long
def test_a_chamfer_far_from_the_contact_changes_nothing_and_ends_the_bore():
    sharp, cut = (bs.FiniteElement(cup=bs.Cup(chamfer=chamfer)) for chamfer in (0.0, 3.0))
    depths = [model.press(HIP, force=500.0).indentation for model in (sharp, cut)]
    assert depths[1] == pytest.approx(depths[0], rel=1e-4)
    filled = cut.press(HIP, force=2e5)
    assert filled.status is bs.Status.AT_RIM
    assert filled.half_angle == pytest.approx(np.pi / 2 - 3.0 / 18.0)
    assert sharp.press(HIP, force=2e5).status is bs.Status.OK


# --- error bars, convergence ---


@pytest.mark.long
@pytest.mark.parametrize(
    ("element", "name", "order"),
    [
        (bs.Element.BILINEAR, "indentation", 1.6),
        (bs.Element.BILINEAR, "half_angle", 0.9),
        (bs.Element.BIQUADRATIC, "indentation", 1.8),
        (bs.Element.BIQUADRATIC, "half_angle", 0.9),
        (bs.Element.BIQUADRATIC, "max_pressure", 1.8),
    ],
)
def test_the_observed_order_of_convergence(element, name, order):
    """Indentation at given force like the energy, peak pressure like its linear shapes, the edge more slowly.

    In the mean over a few loads, since the edge lies differently in its element each time.
    """
    loads = np.linspace(800.0, 1600.0, 9)
    exact = getattr(bs.Exact(tolerance=1e-9).press(RIGID, force=loads), name)
    errors = []
    for elements in (32, 128):
        model = bs.FiniteElement(cup=FULL, element=element, spacing=bs.Adapted(elements=elements), meshes=1)
        errors.append(np.mean(abs(getattr(model.press(RIGID, force=loads), name) / exact - 1)))
    assert np.log(errors[0] / errors[1]) / np.log(4) > order


@pytest.mark.long
def test_the_true_error_lies_within_the_error_bar():
    """At random contacts of whole spheres: 94 %, each quantity by itself, and none far beyond."""
    rng = np.random.default_rng(3)
    beyond = {name: [] for name in QUANTITIES[1:]}
    for _ in range(60):
        joint = lined(rng.uniform(0.0, 0.495), 17.9 * 10 ** rng.uniform(-1.1, -0.4))
        joint = replace(joint, clearance=17.9 * 10 ** rng.uniform(-3.5, -2.0))
        exact = bs.Exact(tolerance=1e-8).press(joint, half_angle=np.radians(rng.uniform(2.0, 70.0)))
        ours = bs.FiniteElement(cup=FULL).press(joint, force=exact.force)
        for name, misses in beyond.items():
            misses.append(abs(getattr(ours, name) / getattr(exact, name) - 1) / ours.error[name])
    for name, misses in beyond.items():
        assert np.mean(np.array(misses) > 1) <= 0.06, name
        assert max(misses) < 2, name


def test_error_bars_can_be_switched_off(hip):
    one, two = bs.FiniteElement(meshes=1).press(HIP, force=3000.0), hip
    assert one.force == two.force
    assert one.indentation == two.indentation
    assert np.isnan(one.error["indentation"])
    assert 0 < two.error["indentation"] < 1e-3
    assert two.error["force"] < 1e-9
    assert json.dumps(one.summary()["error"]["indentation"]) == "null"


@pytest.mark.long
def test_doubling_the_elements_changes_results_by_less_than_one_percent():
    """Doubling the elements changes force, half angle and peak pressure by less than 1 % (R1 12, L 8 mm)."""
    joint = bs.Joint(ball_radius=12.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE, ball=bs.STEEL)
    depth = bs.Exact().press(joint, force=3000.0).indentation
    halved = [
        bs.FiniteElement(spacing=bs.Uniform(size=size), element=bs.Element.BILINEAR, meshes=1).press(
            joint, indentation=depth
        )
        for size in (0.05 * 2**0.5, 0.05)
    ]
    assert halved[1].mesh.elements == pytest.approx(67_000, rel=0.1)
    assert halved[0].mesh.elements == pytest.approx(halved[1].mesh.elements / 2, rel=0.2)
    for name in ("force", "half_angle", "max_pressure"):
        assert getattr(halved[0], name) == pytest.approx(getattr(halved[1], name), rel=1e-2), name


def test_uniform_meshes_agree_with_adapted_ones():
    one, other = (
        bs.FiniteElement(spacing=spacing, meshes=1).press(HIP, force=3000.0)
        for spacing in (bs.Adapted(), bs.Uniform(size=0.5))
    )
    for name in QUANTITIES:
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=2e-3), name


@pytest.mark.long
@pytest.mark.parametrize("ball", [bs.Uniform(size=0.7), bs.Adapted(elements=24), bs.Adapted(elements=120)])
def test_the_meshes_of_ball_and_socket_need_not_match(ball):
    joint = replace(HIP, ball=bs.Material(young=2000.0, poisson=0.3))
    one, other = (bs.FiniteElement(ball_spacing=spacing).press(joint, force=3000.0) for spacing in (None, ball))
    assert one.mesh.elements != other.mesh.elements
    for name in QUANTITIES:
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-3), name


@pytest.mark.parametrize("element", some(reversed(bs.Element), 1))
def test_error_bars_hold_for_both_kinds_of_elements(element):
    """Bilinear elements converge more slowly, as their error bars show."""
    loads = np.linspace(300.0, 3500.0, 16)
    ours = bs.FiniteElement(cup=FULL, element=element).press(RIGID, force=loads)
    exact = bs.Exact().press(RIGID, force=loads)
    for name in ("indentation", "half_angle", "max_pressure"):
        misses = abs(getattr(ours, name) / getattr(exact, name) - 1) / ours.error[name]
        assert np.mean(misses > 1) <= 0.2, name
        assert misses.max() < 4, name


@pytest.mark.long
@pytest.mark.parametrize("clearance", [0.1, 3.0])
def test_a_narrow_contact_in_a_massive_socket_is_hertz(clearance):
    """The patch is that of the socket's radius on both bodies, however much smaller the ball is."""
    soft = bs.Material(young=1000.0, poisson=0.4)
    joint = bs.Joint(ball_radius=17.0, clearance=clearance, liner_thickness=np.inf, liner=soft, ball=soft)
    model = bs.FiniteElement(cup=FULL, gap=bs.CircularGap, meshes=1)
    ours, hertz = model.press(joint, force=0.01), bs.Hertz().press(joint, force=0.01)
    assert ours.max_pressure == pytest.approx(hertz.max_pressure, rel=1e-3)
    assert ours.indentation == pytest.approx(hertz.indentation, rel=1e-2)


@pytest.mark.parametrize("clearance", [1e-4, 1e-6])
def test_the_stiffness_near_the_perfect_fit_is_the_slope_of_the_force(clearance):
    contact = bs.FiniteElement(meshes=1).press(
        replace(HIP, clearance=clearance), force=np.array([2990.0, 3000.0, 3010.0])
    )
    slope = 20.0 / (contact.indentation[2] - contact.indentation[0])
    assert contact.stiffness[1] == pytest.approx(slope, rel=1e-4)


# --- the contract of all models, as far as elements keep it ---


@pytest.mark.long
def test_force_indentation_and_half_angle_are_inverse():
    model = bs.FiniteElement(meshes=1)
    forces = np.array(some([1.0, 30.0, 500.0, 1000.0, 3000.0, 4500.0]))
    by_force = model.press(HIP, force=forces)
    np.testing.assert_allclose(model.press(HIP, indentation=by_force.indentation).force, forces, rtol=1e-5)
    np.testing.assert_allclose(model.press(HIP, half_angle=by_force.half_angle).force, forces, rtol=1e-4)


@pytest.mark.parametrize("gap", some([bs.LinearGap, bs.CircularGap], 1))
def test_force_is_the_slope_of_the_energy_and_stiffness_that_of_the_force(gap):
    d = np.array(some([0.005, 0.02, 0.06], 2))
    above, here, below = (
        bs.FiniteElement(gap=gap, meshes=1).press(HIP, indentation=x) for x in (1.02 * d, d, 0.98 * d)
    )
    np.testing.assert_allclose((above.energy - below.energy) / (0.04 * d), here.force, rtol=2e-3)
    np.testing.assert_allclose((above.force - below.force) / (0.04 * d), here.stiffness, rtol=2e-3)


def test_vertical_pressure_integrates_to_the_force():
    contact = bs.FiniteElement(meshes=1).press(HIP, force=np.array([300.0, 3000.0]))
    nodes, weights = (np.array(part)[:, None] for part in gauss_legendre(200))
    angle = contact.half_angle * np.sin(np.pi / 2 * nodes)
    width = weights * contact.half_angle * np.pi / 2 * np.cos(np.pi / 2 * nodes)
    total = np.sum(contact.pressure(angle) * np.sin(angle) * np.cos(angle) * width, axis=0)
    np.testing.assert_allclose(2 * np.pi * HIP.socket_radius**2 * total, contact.force, rtol=1e-4)
    assert contact.pressure(np.zeros(2)) == pytest.approx(contact.max_pressure, rel=1e-12)
    assert np.all(contact.pressure(contact.half_angle * 1.000001) == 0)


def test_results_scale_with_lengths_and_moduli():
    a, b = 3.0, 0.2
    larger = bs.Joint(
        ball_radius=a * HIP.ball_radius,
        clearance=a * HIP.clearance,
        liner_thickness=a * HIP.liner_thickness,
        liner=bs.Material(young=b * 1000.0, poisson=0.4),
        ball=bs.Material(young=b * 230000.0, poisson=0.3),
    )
    model = bs.FiniteElement(meshes=1)
    one, other = model.press(HIP, force=3000.0), model.press(larger, force=3000.0 * a * a * b)
    assert other.indentation == pytest.approx(a * one.indentation, rel=1e-9)
    assert other.half_angle == pytest.approx(one.half_angle, rel=1e-9)
    assert other.max_pressure == pytest.approx(b * one.max_pressure, rel=1e-9)
    assert other.stiffness == pytest.approx(a * b * one.stiffness, rel=1e-6)


def test_arrays_of_joints_and_loads_give_the_results_of_single_ones():
    joint = replace(HIP, clearance=np.array([0.05, 0.1]))
    forces = np.array([0.0, 500.0, 3000.0])[:, None]
    contact = bs.FiniteElement().press(joint, force=forces)
    assert contact.indentation.shape == (3, 2)
    np.testing.assert_array_equal(contact.indentation[0], 0.0)
    single = bs.FiniteElement().press(replace(HIP, clearance=0.05), force=3000.0)
    assert contact.indentation[2, 0] == single.indentation
    assert contact.error["max_pressure"][2, 0] == single.error["max_pressure"]


@pytest.mark.long
def test_results_do_not_depend_on_the_other_loads():
    model = bs.FiniteElement(meshes=1)
    alone = model.press(HIP, force=700.0).indentation
    among = model.press(HIP, force=np.array([0.01, 700.0, 4000.0])).indentation[1]
    assert alone == among


# --- refusals ---


@pytest.mark.long
@pytest.mark.parametrize(("chamfer", "force"), some(product([0.1, 1.0, 2.7], [3.0, 30.0, 300.0, 3000.0]), 4))
def test_chamfers_can_be_meshed_at_every_load(chamfer, force):
    assert bs.FiniteElement(cup=bs.Cup(chamfer=chamfer), meshes=1).press(HIP, force=force).status is bs.Status.OK


@pytest.mark.long
def test_a_contact_that_leaves_the_pole_has_no_result_and_changes_no_other():
    """A soft free shell closes around the ball: beyond some load the contact is no cap."""
    shell = bs.Layer(thickness=3.0, material=bs.Material(young=1000.0, poisson=0.3))
    joint = replace(HIP, liner_thickness=2.0, backing=(shell,), support=bs.Support.FREE)
    contact = bs.FiniteElement(meshes=1).press(joint, force=np.array([10.0, 300.0, 3000.0]))
    assert contact.status.tolist() == [0, 0, bs.Status.NOT_REACHED]
    assert "leaves the pole" in contact.notes[0]


def test_incompressible_balls_and_backings_are_refused():
    rubber = bs.Material(young=1000.0, poisson=0.5)
    for joint in (replace(HIP, ball=rubber), replace(HIP, backing=(bs.Layer(thickness=4.0, material=rubber),))):
        with pytest.raises(ValueError, match="fem has no answer for ν = 0.5"):
            bs.FiniteElement().press(joint, force=1.0)


@pytest.mark.long
def test_the_largest_stress_excludes_the_sharp_corner():
    cup = bs.Cup(arc_of_cover=np.radians(80.0))
    peaks = [
        bs.FiniteElement(cup=cup, spacing=bs.Adapted(elements=elements), meshes=1).press(HIP, force=2e4).peak_stress
        for elements in either(quick=(44, 88), long=(60, 120))
    ]
    assert peaks[0].von_mises == pytest.approx(peaks[1].von_mises, rel=1e-2)


def test_a_contact_without_a_result_has_a_summary():
    summary = bs.FiniteElement(cup=FULL, meshes=1).press(HIP, indentation=1e6).summary()
    assert summary["force"] is None
    assert "mesh" not in summary


def test_progress_is_reported_only_within_its_context():
    from ballsocket.elasticity.finite_elements.progress import progress_to

    joint, told = replace(HIP, ball_radius=10.0), []
    with progress_to(told.append):
        bs.FiniteElement(meshes=1).press(joint, force=10.0)
    heard = len(told)
    assert heard > 0
    assert all("elements" in text for text in told)
    bs.FiniteElement(meshes=1).press(joint, force=3000.0)
    assert len(told) == heard


def test_a_sliding_liner_needs_a_backing_or_a_fixed_surface():
    with pytest.raises(ValueError, match="needs a backing or a fixed outer surface behind the liner"):
        bs.FiniteElement(cup=bs.Cup(interface=bs.Interface.SLIDING)).press(
            replace(HIP, support=bs.Support.FREE), force=1.0
        )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"arc_of_cover": 0.1}, "arc_of_cover = 0.1 is not allowed: an arc of cover is 40 to 340 degrees"),
        ({"chamfer": -1.0}, "chamfer = -1 is not allowed"),
        ({"chamfer": np.inf}, "chamfer = inf is not allowed"),
    ],
)
def test_invalid_numbers_of_a_cup_are_refused(words, message):
    with pytest.raises(ValueError, match=message):
        bs.Cup(**words)


def test_joints_that_cannot_be_meshed_are_refused():
    with pytest.raises(ValueError, match="liner_thickness = 6.75 is not allowed: a layer must have at least two"):
        bs.FiniteElement(spacing=bs.Uniform(size=5.0)).press(HIP, force=1.0)
    with pytest.raises(ValueError, match="chamfer = 6.5 is not allowed: a chamfer must leave a tenth of the liner"):
        bs.FiniteElement(cup=bs.Cup(chamfer=6.5)).press(HIP, force=1.0)
    with pytest.raises(ValueError, match="fem has no answer for ν = 0.5"):
        bs.FiniteElement().press(lined(0.5), force=1.0)
    with pytest.raises(ValueError, match="elements = 7 is not allowed"):
        bs.Adapted(elements=7)
    with pytest.raises(ValueError, match="size = 0 is not allowed"):
        bs.Uniform(size=0.0)
    with pytest.raises(ValueError, match="meshes = 3 is not allowed"):
        bs.FiniteElement(meshes=3)
    with pytest.raises(TypeError, match="cup must be"):
        bs.FiniteElement(cup=180.0)


def test_a_mesh_larger_than_the_memory_is_refused_before_it_is_built():
    with pytest.raises(ValueError, match=r"a mesh of \d+ elements needs about .* GiB of memory, and .* GiB are free"):
        bs.FiniteElement(spacing=bs.Uniform(size=0.0005)).press(HIP, force=1000.0)


def test_a_missing_extra_is_reported_with_its_install_command(monkeypatch):
    monkeypatch.setattr("ballsocket.core.checks.find_spec", lambda module: None)
    with pytest.raises(ImportError, match=r'skfem is not installed: pip install "ballsocket\[fem\]"'):
        bs.FiniteElement().press(HIP, force=1000.0)


def test_contacts_wider_than_88_degrees_have_no_result():
    contact = bs.FiniteElement(cup=FULL).press(HIP, half_angle=np.radians(89.0))
    assert contact.status is bs.Status.NOT_REACHED
    assert np.isnan(contact.force)
    assert "at most 88" in contact.notes[0]


@pytest.mark.long
def test_displacements_and_stresses_need_one_contact_under_load():
    contact = bs.FiniteElement(meshes=1).press(HIP, force=np.array([10.0, 20.0]))
    with pytest.raises(ValueError, match="displacements and stresses are for one contact"):
        _ = contact.section
    with pytest.raises(ValueError, match="need a contact under load"):
        _ = bs.FiniteElement().press(HIP, force=0.0).peak_stress
    with pytest.raises(KeyError, match="part 'cement' is not known; known parts: liner, ball"):
        _ = bs.FiniteElement().press(HIP, force=100.0).section["cement"]


def test_the_stated_mesh_size_equals_that_of_the_mesh(hip):
    parts = hip.section.parts
    assert hip.mesh.elements == sum(part.elements.shape[1] for part in parts)
    assert hip.mesh.nodes == sum(part.position.shape[1] for part in parts)
    assert isinstance(hip.laws.pieces[0][1].state.solved[0].pair.resolution, Resolution)


def test_a_section_names_its_parts_and_has_a_scale_for_each_kind():
    joint = bs.joints["hip-28"].replace(backing=(bs.Layer(thickness=3.0, material=bs.TITANIUM),))
    figure = section_figure(bs.FiniteElement(spacing=bs.Adapted(elements=24), meshes=1).press(joint, force=3000.0))
    section, _, *bars = figure.axes
    assert {text.get_text() for text in section.texts} == {"liner: UHMWPE", "backing 1: titanium", "ball: CoCr"}
    labels = [f"von Mises stress in the {kind} [MPa]" for kind in ("backing", "liner", "ball")]
    assert [bar.get_ylabel() for bar in bars] == labels
    assert len({bar.get_ylim()[1] for bar in bars}) == 3
    assert section.get_title() == "arc of cover 180°, outside fixed"


def test_a_vtk_file_has_the_mesh_and_its_stresses(hip, tmp_path):
    import meshio

    from ballsocket.elasticity.finite_elements.section import write_vtk

    write_vtk(hip.section, tmp_path / "hip.vtu")
    assert [path.name for path in tmp_path.iterdir()] == ["hip.vtu"]
    mesh = meshio.read(tmp_path / "hip.vtu")
    assert len(mesh.points) == hip.mesh.nodes
    elements, part = (numpy_of(blocks) for blocks in ([cells.data for cells in mesh.cells], mesh.cell_data["part"]))
    assert len(elements) == hip.mesh.elements
    liner, ball = elements[part == 0], elements[part == 1]
    stress = mesh.point_data["von_mises"]
    assert stress[np.unique(liner)].max() == pytest.approx(hip.peak_stress.von_mises)
    assert mesh.point_data["displacement"][np.unique(ball), 1].max() < 0  # it goes down
    with pytest.raises(ValueError, match="must end in"):
        write_vtk(hip.section, tmp_path / "hip.txt")


def numpy_of(blocks):
    return np.concatenate(list(blocks))


def test_an_interrupted_write_leaves_no_file(hip, tmp_path, monkeypatch):
    import meshio

    from ballsocket.elasticity.finite_elements.section import write_vtk

    def interrupted(self, path):
        path.write_text("half of")
        raise KeyboardInterrupt

    monkeypatch.setattr(meshio.Mesh, "write", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_vtk(hip.section, tmp_path / "hip.vtu")
    assert list(tmp_path.iterdir()) == []
