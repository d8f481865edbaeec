"""Finite volumes of Reynolds' equation: rigid fields, Fowell's slider, and a ball on springs."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from ballsocket.lubrication.mesh import FilmMesh, polar_mesh
from ballsocket.lubrication.newton_system import add_storage, balance_cells
from ballsocket.lubrication.reynolds import FilmProblem, FilmState, advance, solve_steady

from ..extent import either
from .rigid_fields import squeeze_pressure, wedge_pressure

RADIUS, CLEARANCE, ECCENTRICITY, VISCOSITY = 18.0, 0.1, 0.08, 2.5e-9
CAVITY = {"radius": RADIUS, "clearance": CLEARANCE, "eccentricity": ECCENTRICITY, "viscosity": VISCOSITY}


def rigid_error(rings, kind, meridians):
    """Largest relative error of the pressure in a full rigid cavity."""
    mesh = polar_mesh(RADIUS, np.linspace(0.0, np.pi / 2, rings + 1), meridians)
    theta, phi = np.arccos(mesh.direction[:, 2]), np.arctan2(mesh.direction[:, 1], mesh.direction[:, 0])
    film, empty = CLEARANCE - ECCENTRICITY * mesh.direction[:, 2], np.zeros(mesh.cells)
    if kind == "squeeze":
        exact = squeeze_pressure(theta, speed=2.0, rim=np.pi / 2, **CAVITY)
        spin, source, rim = np.zeros(3), 2.0 * mesh.direction[:, 2] * mesh.area, np.zeros(meridians)
    else:
        exact = wedge_pressure(theta, phi, spin=10.0, **CAVITY)
        at_rim = np.arctan2(mesh.rim_axis[:, 1], mesh.rim_axis[:, 0]) - np.pi / 2
        spin, source, rim = np.array([0.0, 10.0, 0.0]), 0.0, wedge_pressure(np.pi / 2, at_rim, spin=10.0, **CAVITY)
    balance = balance_cells(mesh, spin, VISCOSITY, film, empty, empty, rim)
    pressure = spsolve(balance.by_pressure.tocsc(), source - balance.outflow)
    return np.abs(pressure - exact).max() / np.abs(exact).max()


@pytest.mark.parametrize("kind", ["squeeze", "wedge"])
def test_pressures_of_rigid_bodies_converge_with_order_two(kind):
    coarse, fine = (rigid_error(rings, kind, 4 * rings) for rings in (23, 46))
    assert np.log2(coarse / fine) > 1.9
    assert rigid_error(91, kind, 91) < 1e-3


def test_spin_about_the_eccentricity_makes_no_pressure():
    mesh = polar_mesh(RADIUS, np.linspace(0.0, np.pi / 2, 13), 24)
    film, empty = CLEARANCE - ECCENTRICITY * mesh.direction[:, 2], np.zeros(mesh.cells)
    balance = balance_cells(mesh, np.array([0.0, 0.0, 10.0]), VISCOSITY, film, empty, empty, np.zeros(24))
    assert np.abs(balance.outflow).max() < 1e-12 * 10.0 * RADIUS * CLEARANCE * mesh.width.max()


def test_the_matrices_of_a_balance_are_its_derivatives_by_differences():
    mesh, random = polar_mesh(RADIUS, np.linspace(0.0, np.pi / 2, 6), 8), np.random.default_rng(1)
    spin, rim, volume = np.array([3.0, -5.0, 2.0]), random.uniform(0.0, 2.0, 8), np.full(mesh.cells, 1e-3)
    fields = {name: random.uniform(0.2, 0.8, mesh.cells) for name in ("thickness", "pressure", "void")}
    fields["thickness"] *= 2e-3

    def balance(**changed):
        now = fields | changed
        flows = balance_cells(mesh, spin, VISCOSITY, *now.values(), rim, central=0.3)
        return add_storage(flows, mesh.area, now["thickness"], now["void"], volume, 0.05)

    for name, values in fields.items():
        change = 1e-4 * values * random.uniform(-1.0, 1.0, mesh.cells)
        difference = balance(**{name: values + change}).outflow - balance(**{name: values - change}).outflow
        derivative = 2.0 * getattr(balance(), f"by_{name}") @ change
        assert derivative == pytest.approx(difference, rel=1e-6, abs=1e-6 * np.abs(difference).max())


def strip_mesh(edges):
    """Divide a strip of unit width along x into cells between `edges` (mm); `spin` is then the sliding velocity."""
    half, inner, along = np.diff(edges) / 2, np.arange(len(edges) - 2), np.array([1.0, 0.0, 0.0])
    cells = {"area": 2 * half, "direction": np.zeros((len(half), 3)), "first": inner, "second": inner + 1}
    faces = {"width": np.ones(len(inner)), "first_distance": half[:-1], "second_distance": half[1:]}
    rim = {"rim_cell": np.array([0, len(inner)]), "rim_width": np.ones(2), "rim_distance": half[[0, -1]]}
    return FilmMesh(**cells, **faces, axis=np.tile(along, (len(inner), 1)), **rim, rim_axis=np.stack([-along, along]))


def pocketed_slider(cells, speed):
    """Solve Fowell's slider: (J. Tribol. 129 (2007) 336); return problem, state and points in mm."""
    points = np.linspace(0.0, 10.0, cells + 1)
    middle = (points[1:] + points[:-1]) / 2
    gap = 1.05e-3 - 0.05e-3 * middle / 10 + np.where((middle > 2) & (middle < 5), 1e-3, 0.0)
    words = {"spin": np.array([speed, 0.0, 0.0]), "compliance": np.zeros(cells), "rim_pressure": np.array([0.1, 0.1])}
    problem = FilmProblem(mesh=strip_mesh(points), viscosity=1e-8, gap=gap, **words)
    start = FilmState(pressure=np.full(cells, 0.1), void=np.zeros(cells), eccentricity=np.zeros(3))
    return problem, solve_steady(problem, start, tolerance=1e-10), points


def face_pressure(problem, state, index, speed):
    """Pressure in MPa at the face behind a cell, where the film may have a step."""
    first, second = problem.gap[index] ** 3, problem.gap[index + 1] ** 3
    length = 2 * problem.mesh.first_distance[index]
    drag = 12 * problem.viscosity * 0.5 * speed * (problem.gap[index] - problem.gap[index + 1]) * length / 2
    return (first * state.pressure[index] + second * state.pressure[index + 1] + drag) / (first + second)


def test_fowells_slider_with_and_without_cavitation():
    cells = either(quick=2000, long=20_000)
    problem, state, points = pocketed_slider(cells, 1000.0)
    assert state.converged
    width = 10.0 / cells
    assert points[np.flatnonzero(state.void > 1e-9)[-1] + 1] == pytest.approx(3.611263, abs=width)
    assert face_pressure(problem, state, cells // 2 - 1, 1000.0) == pytest.approx(9.808819, rel=width)
    load = 1e3 * ((state.pressure - 0.1) * problem.mesh.area).sum()  # N/m over the ambient pressure
    assert load == pytest.approx(34165.70, rel=width)
    problem, state, _ = pocketed_slider(1000, 20.0)
    assert not state.void.any()
    assert 1e6 * face_pressure(problem, state, 199, 20.0) == pytest.approx(4.062188e4, rel=1e-6)
    assert 1e6 * face_pressure(problem, state, 499, 20.0) == pytest.approx(4.519239e5, rel=1e-6)
    assert 1e3 * ((state.pressure - 0.1) * problem.mesh.area).sum() == pytest.approx(1333.452, rel=1e-5)


def test_lubricant_is_conserved_while_a_film_cavitates():
    """A time step moves the volume that enters less the volume that leaves."""
    problem, state, _ = pocketed_slider(200, 1000.0)
    volume = problem.thickness(state) * (1 - 0.5 * state.void)
    later = advance(problem, replace(state, void=0.5 * state.void), volume=volume, step=1e-4, tolerance=1e-10)
    film = problem.gap, later.pressure, later.void, problem.rim_pressure
    balance = balance_cells(problem.mesh, problem.spin, problem.viscosity, *film)
    growth = (problem.gap * (1 - later.void) - volume) @ problem.mesh.area / 1e-4
    assert growth == pytest.approx(-balance.outflow.sum(), rel=1e-6)
