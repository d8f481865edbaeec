"""Bores that are no spheres, preloaded joints, and paths of displacements."""

from dataclasses import replace
from math import pi, radians

import meshio
import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.grid import even_grid
from ballsocket.elasticity.off_axis.scans import scan_of

from ...joints import HIP

RIGID = replace(HIP, ball=None)
COARSE = bs.Sphere(ring_width=radians(4.0))


def bore(radius=18.0, depth=lambda n: 0.0 * n[2], reach=85.0, count=60, shift=(0.0, 0.0, 0.0)):
    """Points of a bore that faces along -y, as a scan would have them."""
    polar, azimuth = np.meshgrid(np.radians(np.linspace(0.5, reach, count)), np.linspace(0, 2 * pi, 2 * count)[:-1])
    n = np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)])
    points = (radius + depth(n)) * n
    return np.stack([points[0], points[2], -points[1]], axis=-1).reshape(-1, 3) + shift


def test_a_depth_that_shifts_the_bore_shifts_the_ball_and_nothing_else():
    """The pole of the grid lies in the contact, where cells are triangles."""
    shift = np.array([0.02, 0.01, 0.03])
    here, there = (replace(COARSE, worn=each) for each in (None, bs.Worn(of=lambda n: np.tensordot(shift, n, 1))))
    plain, shifted = (model.press(RIGID, force=2000.0, tilt=0.3) for model in (here, there))
    assert shifted.pressure_map[2] == pytest.approx(plain.pressure_map[2], abs=2e-3 * plain.max_pressure)
    assert shifted.displacement == pytest.approx(plain.displacement + shift, abs=1e-5)


def test_noise_of_a_scan_is_no_form():
    random = np.random.default_rng(2)
    noisy = scan_of(bore(depth=lambda n: random.normal(0.0, 0.0005, n.shape[1:])))
    plain, scanned = (replace(COARSE, worn=each).press(RIGID, force=2000.0, tilt=0.3) for each in (None, noisy))
    assert scanned.max_pressure == pytest.approx(plain.max_pressure, rel=0.1)
    with pytest.raises(ValueError, match="finest"):
        scan_of(bore(), finest=4.0)


def test_a_pinched_bore_is_an_oval_that_a_turn_turns():
    oval = bs.Pinched(squeeze=0.1)
    assert oval.depth(np.eye(3)) == pytest.approx([-0.05, 0.05, 0.0])
    turned = bs.Pinched(squeeze=0.1, direction=pi / 2)
    assert turned.depth(np.eye(3)) == pytest.approx([0.05, -0.05, 0.0])
    along, across = (replace(COARSE, worn=each).press(RIGID, force=2000.0, tilt=0.4) for each in (oval, turned))
    assert along.max_pressure != pytest.approx(across.max_pressure, rel=1e-3)


def test_a_table_is_the_function_it_was_made_from():
    polar, azimuth = np.radians(np.arange(0.0, 91.0, 3.0)), np.radians(np.arange(0.0, 360.0, 5.0))
    values = 0.02 * np.sin(polar[:, None]) ** 2 * np.cos(2 * azimuth)
    table = bs.DepthTable(polar=polar, azimuth=azimuth, values=values)
    function = bs.Worn(of=lambda n: 0.02 * (n[0] ** 2 - n[1] ** 2))
    contacts = [replace(COARSE, worn=worn).press(RIGID, force=2000.0, tilt=0.3) for worn in (table, function)]
    assert contacts[0].max_pressure == pytest.approx(contacts[1].max_pressure, rel=2e-3)
    assert contacts[0].indentation == pytest.approx(contacts[1].indentation, rel=2e-3)


def test_a_measured_depth_is_computed_once_for_a_grid_and_anew_where_points_may_change():
    scan, grid = scan_of(bore(depth=lambda n: 0.02 * n[0] ** 2)), even_grid(1.2, 0.2)
    first = scan.depth(grid.centroids)
    assert scan.depth(grid.centroids) is first
    moving = grid.centroids.copy()
    assert scan.depth(moving) == pytest.approx(first)
    moving[:2] *= -1
    assert scan.depth(moving) == pytest.approx(scan.depth(np.array(moving)))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"polar": [0.0, 45.0, 90.0]}, "radians"),
        ({"polar": [0.0, 0.5, 0.2]}, "ascend"),
        ({"values": np.zeros((2, 2))}, "one row a polar angle"),
        ({"values": np.full((3, 4), np.nan)}, "finite"),
    ],
)
def test_tables_that_make_no_sense_are_refused(change, said):
    good = {"polar": [0.0, 0.7, 1.5], "azimuth": [0.0, 1.5, 3.0, 4.5], "values": np.zeros((3, 4))}
    with pytest.raises(ValueError, match=said):
        bs.DepthTable(**good | change)


def test_a_scan_finds_the_sphere_and_what_is_missing_of_it(tmp_path):
    pit = lambda n: 0.05 * np.exp(-((np.arccos(np.clip(n[2], -1, 1)) / 0.25) ** 2))  # noqa: E731
    points = bore(depth=pit, shift=(5.0, -3.0, 2.0))
    meshio.write_points_cells(
        tmp_path / "bore.stl", points, [("triangle", np.arange(len(points) // 3 * 3).reshape(-1, 3))]
    )
    scan = bs.read_scan(tmp_path / "bore.stl")
    assert scan.centre == pytest.approx([5.0, -3.0, 2.0], abs=0.03)
    assert scan.radius == pytest.approx(18.0, abs=0.03)
    assert scan.axis == pytest.approx([0.0, 1.0, 0.0], abs=1e-3)
    fresh, worn = (replace(COARSE, worn=each).press(RIGID, force=2000.0) for each in (None, scan))
    assert worn.pole_pressure < fresh.pole_pressure


def test_a_scan_lies_in_the_cup_as_it_was_turned():
    """Its x is the cup's, turned by the azimuth, whatever the rounding of its axis."""
    oval = bs.Pinched(squeeze=0.1)
    points = bore(depth=oval.depth) @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]).T  # along z
    along, across = (
        replace(COARSE, worn=scan_of(points, azimuth=each)).press(RIGID, force=2000.0, tilt=0.4)
        for each in (0.0, pi / 2)
    )
    for scanned, turned in ((along, 0.0), (across, pi / 2)):
        function = replace(COARSE, worn=bs.Pinched(squeeze=0.1, direction=turned))
        drawn = function.press(RIGID, force=2000.0, tilt=0.4)
        assert scanned.max_pressure == pytest.approx(drawn.max_pressure, rel=8e-3)
        assert scanned.indentation == pytest.approx(drawn.indentation, rel=5e-3)
    with pytest.raises(ValueError, match="90 degrees are 1.571 radians"):
        scan_of(points, azimuth=90.0)
    with pytest.raises(ValueError, match=r"radius of the worn bore = 0\.70.* a scan is in mm"):
        replace(COARSE, worn=scan_of(points / 25.4)).press(RIGID, force=2000.0)


@pytest.mark.parametrize(
    ("points", "said"),
    [
        (np.zeros((10, 3)), "200 points"),
        (np.random.default_rng(1).normal(size=(1000, 3)), "not a bore"),
        (bore(reach=10.0), "covers 10°"),
        (np.random.default_rng(1).uniform(-1, 1, (1000, 3)) * (10.0, 10.0, 0.0), "covers 0°"),
    ],
    ids=["few", "cloud", "narrow", "flat"],
)
def test_scans_that_are_no_bores_are_refused(points, said):
    with pytest.raises(ValueError, match=said):
        scan_of(points)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("bore.stl", b"no mesh"),
        ("bore.stl", b""),
        ("bore.stl", bytes(80) + b"\x05\x00\x00\x00" + bytes(60)),
        ("bore.stl", b"solid bore\nfacet normal 0 0 1\nouter loop\nvertex 1 2"),
        ("bore.ply", b"ply\nformat ascii 1.0\n"),
        ("bore.obj", b""),
        ("bore", b"ply"),
    ],
)
def test_what_is_no_mesh_or_not_all_of_one_is_refused(name, content, tmp_path):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=f"{name} is no mesh that can be read: it is cut short, or"):
        bs.read_scan(tmp_path / name)


# --- preload ---

TIGHT = bs.Joint(ball_radius=13.5, interference=0.05, liner_thickness=2.5, liner=bs.POM)
WRAPPED = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(300.0)), ring_width=radians(5.0))


def test_a_preloaded_joint_presses_at_rest_and_balances_itself():
    fitted = bs.Preload(model=WRAPPED, joint=TIGHT)
    assert fitted.rest.max_pressure > 50
    assert fitted.rest.force == pytest.approx(0, abs=1.0)
    assert fitted.rest.displacement[2] < 0  # it leans out of the opening, where less holds it
    closed = replace(WRAPPED, surface=bs.ClosedShell()).press(TIGHT, displacement=(0.0, 0.0, 0.0))
    uniform = closed.pressure_at((0.0, 0.6, 0.8))
    assert closed.pressure_at((0.0, 0.0, 1.0)) == pytest.approx(uniform, rel=0.02)


def test_a_preloaded_joint_loses_its_contact_where_it_is_pulled_from_and_by_wear():
    fitted = bs.Preload(model=WRAPPED, joint=TIGHT)
    out, side = fitted.lost_at((0.0, 0.0, -1.0)), fitted.lost_at((1.0, 0.0, 0.0))
    assert 0 < out < side < 2 * 0.05
    assert fitted.worn_out_at() == pytest.approx(0.05, rel=0.05)
    start = fitted.rest.displacement
    within, beyond = (fitted.displaced(start + far * np.array([1.0, 0.0, 0.0])) for far in (0.99 * side, 1.02 * side))
    assert (within.pressure_map[2] > 0).all()
    assert not (beyond.pressure_map[2] > 0).all()


def test_a_preloaded_joint_is_stiff_whichever_way_it_is_pressed():
    pressed, pulled = (WRAPPED.press(TIGHT, indentation=each) for each in (0.06, 0.03))
    rest = WRAPPED.press(TIGHT, force=0.0)
    assert pulled.indentation < rest.indentation < pressed.indentation
    assert pulled.force < 0 < pressed.force
    for contact in (pressed, pulled, rest):
        assert contact.stiffness > 0
    slope = (pressed.force - pulled.force) / 0.03
    assert slope == pytest.approx(pressed.stiffness, rel=1e-3)  # all of the bore touches: nothing but linear
    assert WRAPPED.press(TIGHT, force=5000.0).indentation > rest.indentation


def test_a_hemisphere_pushes_a_ball_out_that_is_too_large():
    contact = replace(WRAPPED, cup=bs.Cup()).press(TIGHT, force=0.0)
    assert contact.status is bs.Status.DISLOCATED


def test_springs_in_a_preloaded_shell_are_the_linear_law():
    """All in contact: F = K R2² ∫ n nᵀ dΩ e, with no half angle in it."""
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(340.0)), surface=bs.Springs(), ring_width=radians(2.0))
    contact = model.press(TIGHT, displacement=(0.01, 0.0, 0.0))
    reach = radians(170.0)
    share = pi * (2 / 3 - np.cos(reach) + np.cos(reach) ** 3 / 3)  # ∫ sin²θ cos²φ dΩ
    expected = bs.hess_forsbach(TIGHT) * TIGHT.socket_radius**2 * share * 0.01
    assert contact.force_vector[0] == pytest.approx(expected, rel=2e-3)


def test_only_sphere_knows_preload():
    for model in (bs.Exact(), bs.HessForsbach(), bs.Tabulated()):
        with pytest.raises(bs.OutsideDomainError, match="use sphere"):
            model.press(TIGHT, force=100.0)
    with pytest.raises(ValueError, match="beyond the equator"):
        bs.Preload(model=bs.Sphere(), joint=TIGHT)
    with pytest.raises(ValueError, match="interference"):
        bs.Preload(model=WRAPPED, joint=RIGID)
    with pytest.raises(ValueError, match="one too many"):
        bs.Joint(ball_radius=13.5, interference=0.05, clearance=0.1, liner_thickness=2.5, liner=bs.POM)
    with pytest.raises(ValueError, match="a tenth of the ball"):
        bs.Joint(ball_radius=13.5, interference=5.0, liner_thickness=2.5, liner=bs.POM)
    assert TIGHT.replace(liner_thickness=3.0).interference == pytest.approx(0.05)


# --- paths ---


def test_a_ball_that_is_pulled_aside_and_reseated_meets_the_rim():
    """Microseparation: half a millimetre aside and pressed back, on the circle that the ball is."""
    model = replace(COARSE, gap=bs.CircularGap)
    path = np.stack([np.linspace(0.1, 0.55, 5), np.zeros(5), np.linspace(-0.5, 0.0, 5)], axis=-1)
    contact = model.press(RIGID, displacement=path)
    assert (np.diff(contact.force) > 0)[1:].all()
    assert contact.edge_loaded[-1]
    assert contact.displacement[contact.force > 0] == pytest.approx(path[contact.force > 0])


def test_a_displacement_within_the_clearance_touches_nothing():
    contact = COARSE.press(RIGID, displacement=(0.05, 0.0, 0.02))
    assert contact.force == 0
    with pytest.raises(ValueError, match="neither direction nor tilt"):
        COARSE.press(RIGID, displacement=(0.0, 0.0, 0.2), tilt=0.1)
    with pytest.raises(ValueError, match="exactly one"):
        COARSE.press(RIGID, displacement=(0.0, 0.0, 0.2), force=1.0)
