"""Contact of `Sphere`: vectors, notes, status, dictionary for JSON, error estimates, loads of each kind, VTK."""

from dataclasses import replace
from math import degrees, pi, radians
from types import SimpleNamespace

import meshio
import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.directions import unit_vectors
from ballsocket.elasticity.off_axis.vtk import BORE, write_vtk

from .shapes import COARSE, RIGID, TIGHT, WRAPPED, direction

SPRINGS = replace(COARSE, surface=bs.Springs(), ring_width=radians(2.0))


@pytest.fixture(scope="module")
def tilted():
    return COARSE.press(RIGID, force=2500.0, tilt=0.6, azimuth=0.4)


def test_summary_has_the_values_of_the_contact_and_the_load_as_the_force_in_the_body(tilted):
    summary = tilted.summary()
    assert summary["edge_margin_deg"] == pytest.approx(degrees(tilted.edge_margin))
    assert summary["edge_distance"] == pytest.approx(tilted.edge_margin * RIGID.socket_radius)
    assert summary["rim_distance"] == pytest.approx((pi / 2 - 0.6) * RIGID.socket_radius)
    assert tilted.max_pressure_at == pytest.approx(unit_vectors(*np.radians(summary["max_pressure_at_deg"])))
    assert summary["status"] == "OK"
    assert summary["moment"] == pytest.approx(np.cross(summary["displacement"], summary["force_vector"]))
    assert np.shape(summary["stiffness_matrix"]) == (3, 3)
    assert "force_vector_in_body" not in summary
    many = COARSE.press(RIGID, force=[100.0, 2500.0], tilt=[0.1, 1.2]).summary()
    assert many["edge_loaded"] == [False, True]
    assert len(many["status"]) == 2
    for array in (tilted.force_vector, tilted.stiffness_matrix, tilted.max_pressure_at, tilted.moment):
        assert not array.flags.writeable
    cup = bs.Cup(inclination=0.7, anteversion=0.2)
    direction = np.array([-0.3, 0.1, 1.0])
    summary = replace(COARSE, cup=cup).press(RIGID, force=1500.0, direction=direction).summary()
    assert summary["force_vector_in_body"] == pytest.approx(1500.0 * direction / np.linalg.norm(direction), abs=0.01)


def test_contact_lies_around_its_load(tilted):
    n = direction(0.6, 0.4)
    assert tilted.force_vector == pytest.approx(2500.0 * n, abs=0.01)
    assert tilted.tilt == pytest.approx(0.6)
    assert tilted.pole_pressure == pytest.approx(tilted.pressure_at(2.0 * n))
    assert tilted.pressure(0.2) == pytest.approx(tilted.pressure_at(direction(0.8, 0.4)))
    assert np.cos(tilted.max_pressure_angle) == pytest.approx(tilted.max_pressure_at @ n)
    assert tilted.max_pressure >= tilted.pressure_map[2].max()
    assert tilted.pressure_integral > tilted.force


@pytest.mark.parametrize(
    ("poisson", "ratio", "cover", "half_angle", "tilt", "excess"),
    [(0.46, 5.49, 170, 24.7, 59.5, 0.04), (0.49, 2.62, 180, 50.6, 36.9, 0.056)],
)
def test_the_stress_near_a_rim_is_in_its_bar(poisson, ratio, cover, half_angle, tilt, excess):
    """Excess over the axial stress by finite elements of the meridian, loaded by the pressure in harmonics."""
    joint = RIGID.replace(liner=bs.Material(young=1e3, poisson=poisson), liner_thickness=RIGID.socket_radius / ratio)
    model = replace(COARSE, cup=bs.Cup(arc_of_cover=radians(cover)))
    contact = model.press(joint, half_angle=radians(half_angle), tilt=np.radians([tilt, cover / 2 - 10.0]))
    stress, low, high = contact.quick_von_mises
    assert low[0] < stress[0] * (1 + excess) < high[0] < 1.35 * stress[0]
    assert (contact.edge_loaded[1], high[1]) == (True, np.inf)


@pytest.mark.parametrize(("name", "load"), [("force", 100.0), ("indentation", 0.03), ("half_angle", 0.4)])
def test_zero_load_has_no_contact(name, load):
    both = COARSE.press(RIGID, tilt=0.2, **{name: [0.0, load]})
    alone = COARSE.press(RIGID, tilt=0.2, **{name: load})
    for quantity in ("force", "indentation", "half_angle", "max_pressure", "energy", "edge_margin"):
        assert getattr(both, quantity)[0] == 0.0
        assert getattr(both, quantity)[1] == pytest.approx(getattr(alone, quantity), rel=1e-5)
    assert both.status.tolist() == [0, 0]
    assert both.force_vector.shape == (2, 3)


def test_empty_load_gives_an_empty_contact():
    for load in ({"force": []}, {"force": 1.0, "tilt": []}, {"indentation": 0.1, "direction": np.zeros((0, 3))}):
        contact = COARSE.press(RIGID, **load)
        assert contact.notes == ()
        assert contact.force_vector.shape == (0, 3)


def test_error_of_a_prescribed_half_angle_grows_with_the_slope_of_each_quantity():
    """On springs the closed form has the slopes d ln(quantity) / d ln(half angle)."""
    angle, h = 0.7, 1e-4
    contact = SPRINGS.press(RIGID, half_angle=angle)
    same = SPRINGS.press(RIGID, indentation=contact.indentation)
    below, middle, above = (bs.HessForsbach().press(RIGID, half_angle=a) for a in (angle - h, angle, angle + h))
    bases = same.error | {"indentation": 3e-4 + 0.2 * (same.error["max_pressure"] - 3e-4) / 0.3}
    for name in ("force", "indentation", "max_pressure", "pole_pressure", "energy", "pressure_integral"):
        slope = angle * (getattr(above, name) - getattr(below, name)) / (2 * h * getattr(middle, name))
        exponent = (contact.error[name] - bases[name]) / same.error["half_angle"]
        assert exponent == pytest.approx(slope, rel=0.02), name
    assert contact.error["half_angle"] == pytest.approx(same.error["half_angle"], rel=1e-3)


# --- limits of the bore ---


@pytest.mark.parametrize(
    ("load", "note"),
    [
        ({"indentation": 9.5, "tilt": pi}, "the load points 180.0° from the dome's pole, and the bore ends at 90.0°"),
        ({"indentation": 18.2}, "the ball's centre moved 18.3 mm from the bore's, 0.0° from the dome's pole"),
        ({"indentation": 50.0, "tilt": 0.5}, "50.1 mm from the bore's, 28.6° from the dome's pole"),
        ({"force": 10.0, "tilt": radians(91.0)}, "the load points 91.0° from the dome's pole"),
    ],
)
def test_ball_beyond_its_bore_is_dislocated_with_its_position(load, note):
    contact = SPRINGS.press(RIGID, **load)
    assert contact.status is bs.Status.DISLOCATED
    assert not contact.valid
    assert np.isnan([contact.max_pressure, *contact.error.values()]).all()  # numbers that are not there have no error
    assert any(note in line for line in contact.notes)


def test_ball_is_held_up_to_half_a_radius_apart_one_radius_in_contact_and_the_rim():
    for load in ({"indentation": 8.0, "tilt": pi}, {"indentation": 17.7}, {"force": 10.0, "tilt": radians(89.0)}):
        assert SPRINGS.press(RIGID, **load).status is not bs.Status.DISLOCATED
    apart = COARSE.press(RIGID, tilt=pi, indentation=0.5)
    assert (apart.force, apart.max_pressure, apart.area) == (0, 0, 0)
    assert COARSE.press(RIGID, force=1e12).status is bs.Status.DISLOCATED
    cup = bs.Cup(arc_of_cover=radians(220.0))
    held = replace(COARSE, cup=cup).press(RIGID, force=50.0, tilt=radians(105.0))
    assert held.status is not bs.Status.DISLOCATED
    assert held.force_vector[2] < 0


def test_preloaded_force_and_indentation_are_components_along_the_load():
    contact = WRAPPED.press(TIGHT, force=500.0, tilt=0.4)
    n = np.array([np.sin(0.4), 0.0, np.cos(0.4)])
    assert contact.force == pytest.approx(contact.force_vector @ n)
    assert contact.indentation == pytest.approx(contact.displacement @ n + 0.05)
    assert contact.stiffness == pytest.approx(n @ contact.stiffness_matrix @ n)
    assert contact.half_angle > pi / 2  # of the cells of a full contact


@pytest.mark.parametrize(("radius", "valid"), [(9.1, True), (26.9, True), (8.9, False), (27.1, False)])
def test_scan_of_another_radius_is_limited_to_half_the_socket(radius, valid):
    worn = SimpleNamespace(radius=radius, depth=lambda directions: 0.0 * directions[2])
    if valid:
        assert replace(COARSE, worn=worn).press(RIGID, force=10.0).force == pytest.approx(10.0)
    else:
        with pytest.raises(ValueError, match="the socket's is 18 mm"):
            replace(COARSE, worn=worn).press(RIGID, force=10.0)


def test_domain_and_validity_limits():
    with pytest.raises(bs.OutsideDomainError, match="not meshed in rings"):
        COARSE.press(RIGID.replace(liner_thickness=18.0 / 251.0), force=10.0)
    for angle, few in ((19.0, True), (24.0, False)):
        notes = COARSE.press(RIGID, half_angle=radians(angle)).notes
        assert any("the contact spans few rings" in note for note in notes) is few


def test_a_sheet_under_a_tilted_load_has_a_plane_law_away_from_its_edge():
    """p = n·P with F = R² P ∫ n n dΩ: the bearing of a bridge under a force along and across its axis (EN 1337-7)."""
    sheet = bs.Joint(ball_radius=500.0, clearance=0.001, liner_thickness=5.0, liner=bs.PTFE)
    edge, tilt = radians(23.578), radians(3.0)
    cup = bs.Cup(arc_of_cover=2 * edge)
    contact = bs.Sphere(cup=cup).press(sheet, force=3e6, tilt=tilt)
    angles = np.linspace(0.0, edge - 10 * 5.0 / 500.0, 6)[:, None], np.linspace(0.0, pi, 5)
    n = np.moveaxis(unit_vectors(*angles), 0, -1)
    cap = np.array([2 - 3 * np.cos(edge) + np.cos(edge) ** 3, np.inf, 2 - 2 * np.cos(edge) ** 3])  # 3/π ∫ n n dΩ
    P = 3 / pi * 3e6 / 500.0**2 * np.array([np.sin(tilt), 0.0, np.cos(tilt)]) / cap
    pressure, law = contact.pressure_at(n), n @ contact.displacement
    # the edge is free to bulge and bears less over some five thicknesses, so that the rest bears more
    assert np.all((pressure > n @ P) & (pressure < 1.1 * (n @ P)))
    assert pressure == pytest.approx(law * pressure[0, 0] / law[0, 0], rel=0.03)
    axial = bs.Sphere(cup=cup).press(sheet, force=3e6).pressure(angles[0][:, 0])
    meshed = bs.FiniteElement(cup=cup, meshes=1).press(sheet, force=3e6)
    assert axial == pytest.approx(meshed.pressure(angles[0][:, 0]), rel=3e-3)


# --- VTK files ---


def test_the_edge_is_a_closed_line_around_the_contact_and_a_far_gap_is_that_of_rigid_bodies(tilted, tmp_path):
    """`tests/reports/test_press_plots.py` has the pressures, and the place of bore and ball."""
    write_vtk(tilted, tmp_path / "contact.vtu")
    mesh = meshio.read(tmp_path / "contact.vtu")
    links = mesh.cells_dict["line"]
    assert (links[:, 1] == np.roll(links[:, 0], -1)).all()
    assert mesh.points[links[:, 0]] == pytest.approx(RIGID.socket_radius * tilted.outline)
    polar, azimuth, _ = tilted.pressure_map
    part, gap = (mesh.cell_data_dict[name]["quad"] for name in ("part", "gap"))
    far = gap[part == BORE].reshape(len(polar), len(azimuth))[-1, len(azimuth) // 2]
    n = np.array([-np.sin(polar[-1]), 0.0, np.cos(polar[-1])])
    assert far == pytest.approx(RIGID.clearance - tilted.displacement @ n, abs=5e-3)


@pytest.mark.parametrize("load", [{"force": [1.0, 2.0]}, {"force": 0.0}, {"force": 10.0, "tilt": radians(120.0)}])
def test_contacts_without_a_solution_or_in_batches_raise(load, tmp_path):
    with pytest.raises(ValueError, match="pressure maps"):
        write_vtk(COARSE.press(RIGID, **load), tmp_path / "contact.vtu")


@pytest.mark.parametrize(("inclination", "count"), [(radians(0.7), 1), (0.0, 0), (0.7, 0)])
def test_inclination_in_radians_for_degrees_has_a_note(inclination, count):
    contact = replace(SPRINGS, cup=bs.Cup(inclination=inclination)).press(RIGID, force=100.0, tilt=0.2)
    assert sum("0.7 rad are 40.1°" in note for note in contact.notes) == count


def test_a_load_out_of_the_cup_asks_if_it_is_the_force_on_the_ball():
    model = bs.Sphere(cup=bs.Cup(), direction=(0.0, 0.0, -1.0), ring_width=radians(6.0))
    contact = model.press(bs.joints["hip-28"], force=1000.0)
    assert not contact.valid
    assert any("if it is the force on the ball" in note and "opposite direction" in note for note in contact.notes)
