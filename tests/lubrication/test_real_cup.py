"""Reynolds' equation off the axis: contacts of `Sphere` anywhere in a cup with a rim."""

from dataclasses import replace
from math import cos, degrees, pi, radians, sin

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

import ballsocket as bs
from ballsocket.core.validity import Status
from ballsocket.elasticity.off_axis.compliance import cached_compliance
from ballsocket.elasticity.off_axis.grid import Grid
from ballsocket.lubrication.dry_contact import CupCorrection, ElasticSoftness, frame_about
from ballsocket.lubrication.mesh import polar_mesh
from ballsocket.lubrication.newton_system import balance_cells
from ballsocket.problem.cup import Interface

from .. import extent
from ..extent import either
from .rigid_fields import squeeze_pressure
from .test_film import JOINT, SPRINGS, solved_film


def press(tilt):
    """Contact of 1500 N, tilted by an angle in degrees from the axis of the cup."""
    return bs.Sphere().press(JOINT, force=1500.0, tilt=radians(tilt))


def spin_towards_rim(tilt, rate):
    """Rotation in rad/s across a tilted load; the ball moves along the ring of the load."""
    return rate * cos(radians(tilt)), 0.0, -rate * sin(radians(tilt))


@pytest.mark.long
def test_an_axial_load_in_a_hemisphere_has_the_film_of_exact():
    """The closed shell of `exact` and the cup with a rim, on one mesh of the film: 468.0 and 467.8 nm."""
    axial, cup = solved_film("elastic", "reynolds"), bs.film(press(0.0), spin=(10.0, 0.0, 0.0), method="reynolds")
    assert cup.status is Status.OK
    assert cup.central == pytest.approx(axial.central, rel=0.002)
    assert cup.minimum == pytest.approx(axial.minimum, rel=0.005)
    assert cup.displacement == pytest.approx(axial.displacement, abs=1e-5)


@pytest.mark.long
def test_a_tilted_load_in_a_real_cup_confirms_the_wave():
    """The rim lies 10° from the contact. In the limit of small viscosity the pressure is that of `Sphere`."""
    viscosity, rate = either(quick=(1e-2, 30.0), long=(2.5e-4, 1.5))
    contact, words = press(45.0), {"spin": spin_towards_rim(45.0, rate), "lubricant": bs.Lubricant(viscosity=viscosity)}
    judge, wave = (bs.film(contact, method=method, **words) for method in ("reynolds", "wave"))
    assert judge.status is Status.OK
    assert judge.valid
    assert wave.central == pytest.approx(judge.central, rel=wave.error)
    assert (judge.pressure * judge.areas) @ judge.directions == pytest.approx(contact.force_vector, abs=0.01)
    if extent.whole:
        assert judge.pressure.max() == pytest.approx(contact.max_pressure, rel=0.001)
        inner = judge.directions @ judge.dry.axis > cos(0.8 * judge.dry.half_angle)
        dry = contact.pressure_at(judge.directions)[inner]
        assert judge.pressure[inner] == pytest.approx(dry, abs=0.008 * contact.max_pressure)
        assert np.sqrt(np.mean((judge.pressure[inner] - dry) ** 2)) < 0.003 * contact.max_pressure


@pytest.mark.long
@pytest.mark.parametrize(("rate", "film"), [(10.0, 464.0), (-10.0, 422.0)])
def test_a_near_rim_starves_the_inlet_but_not_the_outlet(rate, film):
    """The rim is 0.2 mm from the contact; far from it the film has 467 nm."""
    found = bs.film(press(56.0), spin=(0.0, rate, 0.0), method="reynolds")
    assert found.status is Status.OK
    assert 1e6 * found.central == pytest.approx(film, rel=0.01)


@pytest.mark.long
def test_springs_have_the_film_of_an_axial_load_anywhere():
    """The elastic ball adds its own displacements, here 0.3 % of the film."""
    model = bs.Sphere(surface=bs.Springs(modulus=SPRINGS.modulus))
    contact = model.press(replace(JOINT, ball=bs.STEEL), force=1500.0, tilt=0.5)
    tilted, axial = bs.film(contact, spin=(0.0, 10.0, 0.0), method="reynolds"), solved_film("springs", "reynolds")
    assert tilted.status is Status.OK
    assert (tilted.central, tilted.minimum) == pytest.approx((axial.central, axial.minimum), rel=0.005)


def test_displacements_on_the_mesh_of_the_film_are_those_of_the_cup():
    """A liner that slides in its shell: a fifth of the displacement is not that of a closed shell."""
    cup = bs.Cup(interface=Interface.SLIDING)
    model, tilt = bs.Sphere(cup=cup, ring_width=radians(3.0)), radians(40.0)
    frame = frame_about(np.array([sin(tilt), 0.0, cos(tilt)]))
    grid = Grid(edges=np.radians(np.arange(0.0, 51.0, 2.0)), meridians=40)
    shell = ElasticSoftness.of(model.surface.isotropic, JOINT, grid)
    softness = replace(shell, correction=CupCorrection.of(model, JOINT, grid, frame))

    def pressure(height):
        return np.maximum(1.2 * height - 1.0, 0.0) ** 2 * 250.0

    compliance = cached_compliance(model.surface, JOINT, cup, model.ring_width)
    on_cup = pressure(np.tensordot(frame[2], compliance.grid.middles, 1))
    expected = compliance.softness(on_cup[None]).ravel()
    directions = grid.middles.reshape(3, -1).T
    inside = directions @ frame[:, 2] > cos(radians(80.0))  # away from the strip at the rim
    at_film = compliance.grid.interpolation_matrix(directions @ frame) @ expected
    found = softness(pressure(directions[:, 2]))
    assert found[inside] == pytest.approx(at_film[inside], abs=0.01 * expected.max())
    assert np.abs(found - shell(pressure(directions[:, 2]))).max() > 0.15 * expected.max()


def test_interpolation_between_meshes_is_of_second_order_and_passes_the_pole():
    def error(rings):
        grid = Grid(edges=np.linspace(0.0, 1.2, rings + 1), meridians=4 * rings)
        points = np.random.default_rng(2).normal(size=(500, 3)) * (0.3, 0.3, 0.2) + (0.0, 0.0, 1.0)
        points /= np.linalg.norm(points, axis=1)[:, None]
        points = points[points[:, 2] > cos(1.1)]
        field = np.exp(grid.middles[0] + 0.5 * grid.middles[1]).ravel()
        return np.abs(grid.interpolation_matrix(points) @ field - np.exp(points[:, 0] + 0.5 * points[:, 1])).max()

    assert np.log2(error(12) / error(24)) > 1.7
    grid = Grid(edges=np.linspace(0.0, 1.2, 9), meridians=16)
    outside = np.array([[sin(1.3), 0.0, cos(1.3)], [0.0, 0.0, 1.0]])
    assert grid.interpolation_matrix(outside) @ np.ones(128) == pytest.approx([0.0, 1.0])


def test_a_mesh_that_the_rim_cuts_has_the_squeeze_pressure_of_a_hemisphere():
    """A rigid cavity on cells about an axis at 25° from that of the cup: the cells at the rim make steps."""

    def error(rings):
        frame = frame_about(np.array([sin(0.44), 0.0, cos(0.44)]))
        mesh = polar_mesh(18.0, np.linspace(0.0, 0.7 * pi, rings + 1), 4 * rings).in_frame(frame)
        mesh = mesh.within(mesh.direction[:, 2] > 0)
        height, empty = mesh.direction[:, 2], np.zeros(mesh.cells)
        film = 0.1 - 0.08 * height
        balance = balance_cells(mesh, np.zeros(3), 2.5e-9, film, empty, empty, np.zeros(len(mesh.rim_cell)))
        pressure = spsolve(balance.by_pressure.tocsc(), 2.0 * height * mesh.area)
        cavity = {"radius": 18.0, "clearance": 0.1, "eccentricity": 0.08, "viscosity": 2.5e-9}
        exact = squeeze_pressure(np.arccos(height), speed=2.0, rim=pi / 2, **cavity)
        return np.abs(pressure - exact).max() / exact.max()

    assert error(24) < 0.02
    assert error(48) < 0.6 * error(24)


def test_a_contact_that_the_rim_cuts_is_refused_by_reynolds_and_noted_by_the_wave():
    contact = press(65.0)
    assert contact.edge_loaded
    # the kernels of BLAS differ by 0.007 deg
    assert degrees(float(contact.edge_margin)) == pytest.approx(-7.885, abs=0.02)
    with pytest.raises(ValueError, match=r"not possible for an edge margin of [-0-9.]+ deg: the rim cuts the contact"):
        bs.film(contact, method="reynolds")
    film = bs.film(contact)
    assert not film.valid
    assert any("rim cuts the contact" in note for note in film.notes)


def test_a_contact_far_from_round_is_refused():
    contact = bs.Sphere(worn=bs.OvalBore(squeeze=0.05)).press(JOINT, force=1500.0)
    angle = np.arccos(contact.outline[:, 2] / np.linalg.norm(contact.outline, axis=1))
    assert np.degrees([angle.min(), angle.max()]) == pytest.approx([29.6, 44.1], abs=0.1)  # rings are 2 deg wide
    with pytest.raises(ValueError, match=r"edge lies [0-9.]+ to [0-9.]+ deg from its load: it needs a rounder one"):
        bs.film(contact, method="reynolds")
