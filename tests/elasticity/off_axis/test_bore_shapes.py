"""Bores that are not spheres: functions, ovals, tables and scans; bores smaller than the ball: preloaded joints."""

from dataclasses import replace
from math import pi, radians

import meshio
import numpy as np
import pytest

import ballsocket as bs
from ballsocket.contact.strength import MAX_ELASTIC_UTILISATION
from ballsocket.contact.verdict import Verdict
from ballsocket.design_checks import assess_strength
from ballsocket.elasticity.off_axis import bore_shapes
from ballsocket.elasticity.off_axis.directions import unit_vectors
from ballsocket.elasticity.off_axis.scans import scan_from_points

from ...extent import some
from .shapes import COARSE, RIGID, TIGHT, WRAPPED, scanned_points


def test_depth_of_a_shifted_sphere_shifts_the_ball_alone():
    """The pole of the grid lies in the contact, where cells are triangles."""
    shift = np.array([0.02, 0.01, 0.03])
    shifted_bore = bs.BoreDeviation(of=lambda n: np.tensordot(shift, n, 1))
    plain, shifted = (replace(COARSE, worn=worn).press(RIGID, force=2000.0, tilt=0.3) for worn in (None, shifted_bore))
    assert shifted.pressure_map[2] == pytest.approx(plain.pressure_map[2], abs=2e-3 * plain.max_pressure)
    assert shifted.displacement == pytest.approx(plain.displacement + shift, abs=1e-5)


@pytest.mark.parametrize("direction", [0.0, 0.4, -1.3, pi])
def test_oval_bore_is_narrowest_along_its_direction(direction):
    oval = bs.OvalBore(squeeze=0.08, direction=direction)
    azimuth, polar = np.linspace(0.0, 2 * pi, 73), np.linspace(0.0, pi / 2, 9)
    equator = oval.depth(unit_vectors(np.full(azimuth.shape, pi / 2), azimuth))
    assert equator == pytest.approx(-0.04 * np.cos(2 * (azimuth - direction)), abs=1e-15)
    meridian = oval.depth(unit_vectors(polar, np.full(polar.shape, direction)))
    assert meridian == pytest.approx(-0.04 * np.sin(polar) ** 2, abs=1e-15)


@pytest.mark.parametrize(
    "azimuth", [[0.0, 1.5, 3.0, 4.5], [-2.0, 0.0, 1.0, 3.5], [0.0, 2.0, 4.0, 2 * pi], [0.0, 2.0, 4.0, 2 * pi - 0.006]]
)
def test_table_is_linear_between_its_angles_and_periodic(azimuth):
    """A table that ends at its start after a full turn keeps its own last column."""
    azimuth, polar = np.array(azimuth), np.array([0.2, 0.7, 1.5])
    values = np.random.default_rng(3).normal(size=(3, 4))
    table = bs.DepthTable(polar=polar, azimuth=azimuth, values=values)

    def depth(polar, azimuth):
        return table.depth(unit_vectors(np.asarray(polar), np.asarray(azimuth)))

    assert depth(polar[:, None], azimuth[None, :-1]) == pytest.approx(values[:, :-1])
    middles = depth(polar[:, None], (azimuth[:-1] + azimuth[1:])[None] / 2)
    assert middles == pytest.approx((values[:, :-1] + values[:, 1:]) / 2)
    assert depth([[0.45]], azimuth[None, :1]) == pytest.approx((values[:1, :1] + values[1:2, :1]) / 2)
    constant = depth([0.05, 0.1, 1.6, 3.0], np.full(4, azimuth[1]))
    assert constant == pytest.approx(values[[0, 0, 2, 2], 1])
    if azimuth[-1] - azimuth[0] < 2 * pi - 1e-6:
        closing = depth(polar, np.full(3, (azimuth[-1] + azimuth[0] + 2 * pi) / 2))
        assert closing == pytest.approx((values[:, -1] + values[:, 0]) / 2)


# --- scans ---

TO_POLE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]).T
"""Rotation of scanned points onto the cup's axis z."""


def test_noise_of_a_scan_hardly_changes_the_pressure():
    random = np.random.default_rng(2)
    noisy = scan_from_points(scanned_points(depth=lambda n: random.normal(0.0, 0.0005, n.shape[1:])))
    plain, scanned = (replace(COARSE, worn=worn).press(RIGID, force=2000.0, tilt=0.3) for worn in (None, noisy))
    assert scanned.max_pressure == pytest.approx(plain.max_pressure, rel=0.1)


def test_scan_file_gives_sphere_axis_and_wear(tmp_path):
    pit = lambda n: 0.05 * np.exp(-((np.arccos(np.clip(n[2], -1, 1)) / 0.25) ** 2))  # noqa: E731
    points = scanned_points(depth=pit, shift=(5.0, -3.0, 2.0))
    triangles = np.arange(len(points) // 3 * 3).reshape(-1, 3)
    meshio.write_points_cells(tmp_path / "bore.stl", points, [("triangle", triangles)])
    scan = bs.read_scan(tmp_path / "bore.stl")
    assert scan.centre == pytest.approx([5.0, -3.0, 2.0], abs=0.03)
    assert scan.radius == pytest.approx(18.0, abs=0.03)
    assert scan.axis == pytest.approx([0.0, 1.0, 0.0], abs=1e-3)
    fresh, worn = (replace(COARSE, worn=bore).press(RIGID, force=2000.0) for bore in (None, scan))
    assert worn.pole_pressure < fresh.pole_pressure


def test_roughness_is_the_root_mean_square_deviation_and_none_on_an_exact_sphere():
    """Waves of zero mean leave the sphere unchanged."""
    scan = scan_from_points(scanned_points(radius=20.0, reach=70.0, shift=(1.0, -2.0, 3.0)))
    assert scan.centre == pytest.approx([1.0, -2.0, 3.0], abs=1e-9)
    assert scan.radius == pytest.approx(20.0, abs=1e-9)
    assert scan.reach == pytest.approx(radians(70.0), abs=1e-6)
    assert np.linalg.norm(scan.directions, axis=0) == pytest.approx(1.0)
    for depth in (scan.roughness, scan.deviation, scan.depth(scan.directions)):
        assert depth == pytest.approx(0.0, abs=1e-9)
    points = scanned_points(depth=lambda n: 0.03 * np.cos(8 * np.arctan2(n[1], n[0])))
    wavy, averaged = (scan_from_points(points, finest=finest) for finest in (0.02, 0.3))
    assert wavy.radius == pytest.approx(18.0, abs=1e-3)
    assert wavy.roughness == pytest.approx(0.03 / 2**0.5, rel=0.02)
    assert abs(wavy.deviation).max() == pytest.approx(0.03, rel=0.02)
    assert len(averaged.deviation) < len(wavy.deviation) / 10


def test_scan_interpolates_a_linear_depth_exactly_and_stays_in_range():
    """Planes reproduce a linear depth inside the scan; beyond its end the depth is that of the nearest points."""
    scan, slope = scan_from_points(scanned_points(depth=lambda n: 0.02 * n[0] ** 2)), np.array([0.3, -0.1, 0.2])
    linear = replace(scan, deviation=slope @ scan.directions)
    inside = unit_vectors(np.array([0.1, 0.5, 1.0]), np.array([0.3, 2.0, 4.0]))
    assert linear.interpolate(inside) == pytest.approx(slope @ inside, abs=2e-3)
    outside = linear.interpolate(np.array([[0.0], [0.0], [-1.0]]))
    assert linear.deviation.min() <= outside[0] <= linear.deviation.max()


@pytest.mark.parametrize("azimuth", [0.0, pi / 2, 5.1])
def test_depth_of_a_scan_is_that_of_the_rotated_oval(azimuth):
    """The scan's x is the cup's x, rotated by the azimuth, whatever the rounding of its axis."""
    scan = scan_from_points(scanned_points(depth=bs.OvalBore(squeeze=0.1).depth) @ TO_POLE, azimuth=azimuth)
    directions = unit_vectors(np.linspace(0.1, 1.3, 12), np.linspace(0.0, 6.0, 12))
    expected = bs.OvalBore(squeeze=0.1, direction=azimuth).depth(directions)
    assert scan.depth(directions) == pytest.approx(expected, abs=3e-3)


def test_scan_along_x_takes_y_as_its_reference():
    along_x = scanned_points(depth=bs.OvalBore(squeeze=0.1).depth) @ TO_POLE @ np.roll(np.eye(3), 1, axis=1)
    scan = scan_from_points(along_x)
    assert scan.axis == pytest.approx([1.0, 0.0, 0.0], abs=1e-3)
    equator = unit_vectors(np.full(8, 1.3), np.arange(8) * pi / 4)
    assert scan.depth(equator) == pytest.approx(bs.OvalBore(squeeze=0.1).depth(equator), abs=3e-3)


# --- preloaded joints: equilibrium, separation, wear, stiffness, friction and pull-out forces ---

SPRINGS = replace(WRAPPED, surface=bs.Springs())


def held(arc, **options):
    return replace(WRAPPED, cup=bs.Cup(arc_of_cover=radians(arc)), **options)


def test_preloaded_joint_is_in_equilibrium_until_a_displacement_or_wear_opens_it():
    fitted = bs.Preload(model=WRAPPED, joint=TIGHT)
    assert fitted.equilibrium.max_pressure > 50
    assert fitted.equilibrium.force == pytest.approx(0, abs=1.0)
    assert fitted.equilibrium.displacement[2] < 0  # the opening pushes less
    out, side = fitted.separation_displacement((0.0, 0.0, -1.0)), fitted.separation_displacement((1.0, 0.0, 0.0))
    assert 0 < out < side < 2 * 0.05
    assert fitted.wear_depth_to_loosen() == pytest.approx(0.05, rel=0.05)
    start = fitted.equilibrium.displacement
    inside, beyond = (fitted.displace(start + factor * side * np.array([1.0, 0.0, 0.0])) for factor in (0.99, 1.02))
    assert (inside.pressure_map[2] > 0).all()
    assert not (beyond.pressure_map[2] > 0).all()


@pytest.mark.parametrize("interference", some([0.05, 0.002], 1))
def test_springs_separate_at_the_interference(interference):
    """On springs each cell opens alone: the lateral displacement at which the first one does is the interference."""
    fitted = bs.Preload(model=SPRINGS, joint=TIGHT.replace(interference=interference))
    assert fitted.separation_displacement((0.0, 1.0, 0.0)) == pytest.approx(interference, rel=0.03)
    assert fitted.wear_depth_to_loosen() == pytest.approx(interference, rel=1e-3)
    assert fitted.separation_displacement((0.0, 5.0, 0.0)) == fitted.separation_displacement((0.0, 1.0, 0.0))


@pytest.mark.parametrize("rings", some([1.5, 2.0, 3.0, 4.0], 2))
def test_the_ball_is_loose_where_it_fits_through_the_worn_bore(rings):
    """A shifted bore holds the ball as a centred one, and an oval bore as long as its narrow diameter is too small."""
    shifted, oval = (lambda n: 0.02 * n[0]), (lambda n: 0.02 * (n[0] ** 2 - n[1] ** 2) / 2)
    for depth, expected in ((None, 0.05), (shifted, 0.05), (oval, 0.06), (lambda n: 0.01, 0.04), (lambda n: 0.07, 0.0)):
        worn = None if depth is None else bs.BoreDeviation(of=depth)
        fitted = bs.Preload(model=held(240.0, worn=worn, ring_width=radians(rings)), joint=TIGHT)
        assert fitted.wear_depth_to_loosen() == pytest.approx(expected, rel=2e-3, abs=1e-9)


def test_preloaded_joint_resists_push_and_pull_beyond_a_half_socket():
    pressed, pulled = (WRAPPED.press(TIGHT, indentation=indentation) for indentation in (0.06, 0.03))
    unloaded = WRAPPED.press(TIGHT, force=0.0)
    assert pulled.indentation < unloaded.indentation < pressed.indentation
    assert pulled.force < 0 < pressed.force
    assert min(contact.stiffness for contact in (pressed, pulled, unloaded)) > 0
    slope = (pressed.force - pulled.force) / 0.03
    assert slope == pytest.approx(pressed.stiffness, rel=1e-3)  # the contact is closed: linear
    assert WRAPPED.press(TIGHT, force=5000.0).indentation > unloaded.indentation
    assert held(180.0).press(TIGHT, force=0.0).status is bs.Status.DISLOCATED
    contact = held(180.0).press(TIGHT, force=2000.0)
    assert not contact.valid
    assert "a half socket does not hold a preloaded ball: set arc_of_cover above 180 deg" in " ".join(contact.notes)
    assert held(181.0).press(TIGHT, force=2000.0).valid


def test_springs_in_a_closed_preloaded_contact_are_linear():
    """In full contact F = K R2² ∫ n nᵀ dΩ e, without a half angle."""
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(340.0)), surface=bs.Springs(), ring_width=radians(2.0))
    contact = model.press(TIGHT, displacement=(0.01, 0.0, 0.0))
    reach = radians(170.0)
    integral = pi * (2 / 3 - np.cos(reach) + np.cos(reach) ** 3 / 3)  # ∫ sin²θ cos²φ dΩ
    stiffness = bs.hess_forsbach(TIGHT) * TIGHT.socket_radius**2 * integral
    for value in (contact.force_vector[0] / 0.01, contact.stiffness_matrix[0, 0], contact.stiffness):
        assert value == pytest.approx(stiffness, rel=2e-3)


def spring_force(joint, arc, displacement, friction):
    """Integrate K (penetration of the displaced ball) along the normals of the ball, over the bore."""
    R1, R2, K = joint.ball_radius, joint.socket_radius, bs.hess_forsbach(joint)
    polar = np.linspace(0.0, radians(arc / 2), 4001)
    along = -displacement * np.cos(polar)
    overlap = along + np.sqrt(R1**2 - displacement**2 + along**2) - R2
    outward, across = -R2 * np.cos(polar) - displacement, R2 * np.sin(polar)
    normal = (outward + friction * across) / np.hypot(outward, across)
    return np.trapezoid(K * np.maximum(overlap, 0.0) * normal * 2 * np.pi * R2**2 * np.sin(polar), polar)


@pytest.mark.parametrize(("fit", "friction"), some([({"interference": 0.02}, 0.2), ({"clearance": 0.05}, 0.0)], 1))
def test_the_pull_out_force_on_springs_is_the_largest_integral(fit, friction):
    joint = TIGHT.replace(**fit)
    pulled = bs.pull_out(held(200.0, surface=bs.Springs(), ring_width=radians(1.0)), joint, friction)
    displacements = np.linspace(max(joint.clearance, 0.0), pulled.displacements[-1], 400)
    forces = [spring_force(joint, 200.0, displacement, friction) for displacement in displacements]
    assert pulled.force == pytest.approx(max(forces), rel=0.02)
    assert pulled.displacement == pytest.approx(displacements[np.argmax(forces)], abs=0.1)


@pytest.mark.long
def test_the_pull_out_force_grows_with_cover_and_friction_and_does_not_need_fine_rings():
    narrow, wide = (bs.pull_out(held(arc), TIGHT) for arc in (195.0, 205.0))
    assert 0 < narrow.force < wide.force < bs.pull_out(held(205.0), TIGHT, 0.1).force
    assert narrow.strain < wide.strain < 0.1
    assert wide.force == pytest.approx(bs.pull_out(held(205.0, ring_width=radians(2.0)), TIGHT).force, rel=0.05)
    assert wide.displacements[-1] == pytest.approx(TIGHT.socket_radius * np.sin(radians(12.5)))
    assert wide.forces[-1] < 0  # beyond the widest section the rim expels the ball


def test_a_pull_out_force_beyond_linear_elasticity_is_not_reported():
    pulled, upper = (bs.pull_out(held(arc), TIGHT) for arc in (240.0, 205.0))
    assert np.isnan(pulled.force)
    assert pulled.summary()["force"] is None
    assert pulled.notes[0].startswith("pull-out: not computed, the rim would compress the liner by ")
    assert upper.utilisation > MAX_ELASTIC_UTILISATION
    assert upper.notes[0].startswith("pull-out: an upper bound, ")
    assert not any(force.valid for force in (pulled, upper))


def test_friction_of_a_preloaded_ball_is_that_of_its_pressures():
    """A uniform pressure p on a closed bore has the torque μ p R1 R2² π² about every axis: the mean sine is π/4."""
    contact = held(340.0, surface=bs.ClosedShell()).press(TIGHT, displacement=(0.0, 0.0, 0.0))
    assert contact.pressure_at((0.0, 0.0, 1.0)) == pytest.approx(contact.pressure_at((0.0, 0.6, 0.8)), rel=0.02)
    uniform = pi**2 * TIGHT.ball_radius * TIGHT.socket_radius**2 * contact.pressure_at((0.0, 0.6, 0.8))
    for axis_angle, lost in ((pi / 2, 1.01), (0.0, 1.0)):  # the opening of 20 degrees takes part of the bore
        assert lost * contact.friction_torque(0.1, axis_angle) == pytest.approx(0.1 * uniform, rel=0.02)
    ring = held(200.0).press(TIGHT, force=0.0)  # pushed out until the rim alone holds the ball
    assert ring.pole_pressure == 0
    assert ring.friction_torque(0.1, 0.0) > ring.friction_torque(0.1) > 1e3


def test_the_stress_in_a_worn_bore_has_a_wide_bar_and_a_reason():
    """Finite elements have -82 to +37 %: a strength near the stress stays undecided."""
    joint = bs.joints["hip-28"]
    model = bs.Sphere(worn=bore_shapes.OvalBore(squeeze=0.02), ring_width=0.1)
    contact = model.press(joint, force=2000.0)
    bar = contact.quick_von_mises
    assert (bar.low / bar.value, bar.high / bar.value) == (pytest.approx(0.15), pytest.approx(1.5, abs=0.02))
    weak = joint.replace(liner=replace(joint.liner, yield_stress=float(bar.value) / 1.2))
    worn = model.press(weak, force=2000.0)
    assert assess_strength(worn).verdict is Verdict.UNDECIDED
    assert any(note.startswith("stress in a worn bore: up to 50% above") for note in worn.notes)
    assert assess_strength(replace(model, worn=None).press(weak, force=2000.0)).verdict is Verdict.EXCEEDED


@pytest.mark.parametrize("arc", some([200.0, 240.0], 1))
def test_uniform_wear_loosens_a_socket_with_an_open_dome_at_the_interference(arc):
    """Pressures are proportional to the interference that is left, even where the opening pushes the ball outwards."""
    worn = bs.BoreDeviation(of=lambda n: 0.01)
    fitted, looser = (bs.Preload(model=held(arc, worn=depth), joint=TIGHT) for depth in (None, worn))
    assert fitted.equilibrium.pressure_map[2].min() == 0.0
    assert fitted.separation_displacement((1.0, 0.0, 0.0)) == 0.0
    assert fitted.wear_depth_to_loosen() == pytest.approx(0.05, rel=1e-3)
    assert looser.wear_depth_to_loosen() == pytest.approx(0.04, rel=1e-3)
