"""Ball in a bore: forces of pressures, equilibrium under loads, tethers, and cost of the search."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis import bore_contact, equilibrium
from ballsocket.elasticity.off_axis.bore_contact import BoreContact, GapField
from ballsocket.elasticity.off_axis.compliance import make_compliance
from ballsocket.elasticity.off_axis.equilibrium import solve_force
from ballsocket.elasticity.off_axis.grid import even_grid

from ...extent import some
from ...joints import HIP
from .shapes import RIGID

FINE, COARSE = even_grid(pi / 2, radians(3.6)), even_grid(pi / 2, radians(6.0))
LOADS = np.array([[0.0, 0.0, 1000.0], [800.0, 300.0, 1500.0], [-20.0, 10.0, 40.0]])


def bore_of(grid=FINE, surface=bs.ClosedShell(), joint=HIP, clearance=0.1, **others):  # noqa: B008
    gap = GapField(
        grid=grid,
        clearance=clearance,
        socket_radius=18.0,
        depth=np.zeros((grid.rings, grid.meridians)),
        kind=bs.LinearGap,
    )
    return BoreContact(compliance=make_compliance(surface, joint, bs.Cup(), grid), gap=gap, **others)


BORE = bore_of()
START = 0.15 * LOADS / np.linalg.norm(LOADS, axis=1)[:, None]
HELD = np.ones(3, dtype=bool)


def test_uniform_pressure_pushes_on_the_projected_area():
    pressure = np.full((2, FINE.rings, FINE.meridians), 3.0)
    assert BORE.force(pressure) == pytest.approx(np.array(2 * [[0.0, 0.0, 3.0 * pi * 18.0**2]]), abs=1e-9)
    narrow = bore_of(even_grid(0.5, 0.1), bs.Springs(), RIGID)
    pressure = np.full((1, narrow.compliance.grid.rings, narrow.compliance.grid.meridians), 3.0)
    assert narrow.force(pressure)[0, 2] == pytest.approx(3.0 * pi * (18.0 * np.sin(0.5)) ** 2)


def test_forces_are_in_equilibrium_with_the_loads():
    solution = solve_force(BORE, LOADS, START, HELD)
    assert solution.converged.all()
    error = np.linalg.norm(BORE.force(solution.pressure) - LOADS, axis=1)
    assert (error <= 1e-6 * np.linalg.norm(LOADS, axis=1)).all()
    again = BORE.solve_displaced(solution.displacement)
    assert again.pressure == pytest.approx(solution.pressure, abs=1e-3)
    assert again.converged.all()


@pytest.mark.parametrize(("grid", "trials"), [(FINE, 15), (COARSE, 12)], ids=["with coarse start", "without"])
def test_search_needs_few_iterations(grid, trials, monkeypatch):
    """Each iteration evaluates all balls once; tangents are solved only where a step gained little."""
    counts = {"trials": 0, "tangents": 0}
    solve, tangent = equilibrium.solve_pressure, BoreContact.pressure_sensitivity

    def count_trials(*arguments):
        counts["trials"] += 1
        return solve(*arguments)

    def count_tangents(self, *arguments):
        counts["tangents"] += 1
        return tangent(self, *arguments)

    monkeypatch.setattr(equilibrium, "solve_pressure", count_trials)
    monkeypatch.setattr(BoreContact, "pressure_sensitivity", count_tangents)
    solution = solve_force(bore_of(grid), LOADS, START, HELD)
    assert solution.converged.all()
    assert counts["trials"] <= trials
    assert counts["tangents"] <= 7


def test_blocks_of_balls_do_not_change_the_solution(monkeypatch):
    together = solve_force(BORE, LOADS, START, HELD)
    monkeypatch.setattr(bore_contact, "_BATCH_CELLS", 2 * FINE.rings * FINE.meridians)
    assert [len(block) for block in BORE.split_into_blocks(np.arange(5))] == [2, 2, 1]
    separate = solve_force(BORE, LOADS, START, HELD)
    assert separate.displacement == pytest.approx(together.displacement, abs=1e-6)
    monkeypatch.setattr(bore_contact, "_BATCH_CELLS", 1)
    assert [len(block) for block in BORE.split_into_blocks(np.arange(2))] == [1, 1]


def test_balls_excluded_from_the_search_stay_at_their_start():
    held = np.array([True, False, True])
    solution = solve_force(BORE, LOADS, START, held)
    assert solution.converged.tolist() == [True, False, True]
    assert (solution.displacement[1] == START[1]).all()
    assert not solution.pressure[1].any()


def test_start_from_a_solution_gives_it_back():
    solution = solve_force(BORE, LOADS, START, HELD)
    again = solve_force(BORE, LOADS, solution.displacement, HELD, solution.pressure)
    assert again.displacement == pytest.approx(solution.displacement, abs=1e-6)
    assert again.converged.all()


@pytest.mark.parametrize("factor", some([0.2, 0.6, 3.0], 2))
def test_bad_starts_reach_the_same_equilibrium(factor):
    """The ball begins outside the contact, or pressed in too far."""
    expected = solve_force(BORE, LOADS, START, HELD)
    solution = solve_force(BORE, LOADS, factor * START, HELD)
    assert solution.converged.all()
    assert solution.displacement == pytest.approx(expected.displacement, abs=1e-5)


def test_tether_carries_its_part_of_the_load():
    tether = np.diag([500.0, 200.0, 0.0])
    bore = replace(BORE, tether=tether)
    solution = solve_force(bore, LOADS, START, HELD)
    assert solution.converged.all()
    carried = bore.force(solution.pressure) + solution.displacement @ tether
    assert carried == pytest.approx(LOADS, abs=2e-3)
    sensitivity = bore.pressure_sensitivity(solution.displacement, solution.pressure, tolerance=1e-6)
    assert bore.tangent(sensitivity) - BORE.tangent(sensitivity) == pytest.approx(np.array(3 * [tether]))


def test_tangent_is_the_derivative_of_the_force():
    solution, h = solve_force(BORE, LOADS[:2], START[:2], HELD[:2]), 1e-6
    sensitivity = BORE.pressure_sensitivity(solution.displacement, solution.pressure, tolerance=1e-8)
    tangent = BORE.tangent(sensitivity)
    for axis in range(3):
        step = h * np.eye(3)[axis]
        pressures = [
            bore_contact.solve_pressure(
                BORE.compliance, BORE.gap.overlap(solution.displacement + sign * step), None, 1e-10
            )
            for sign in (1, -1)
        ]
        slope = (BORE.force(pressures[0].pressure) - BORE.force(pressures[1].pressure)) / (2 * h)
        assert tangent[:, :, axis] == pytest.approx(slope, rel=2e-3, abs=1e-3 * abs(tangent).max())


def test_preloaded_ball_without_a_load_stays_centred_in_a_symmetric_bore():
    sphere = bore_of(even_grid(pi, radians(6.0)), clearance=-0.05)
    nearly_zero = np.array([[0.0, 0.0, 1e-9]])
    solution = solve_force(sphere, nearly_zero, np.array([[0.01, 0.02, -0.01]]), HELD[:1])
    assert solution.converged.all()
    assert solution.displacement == pytest.approx(0.0, abs=1e-6)
    assert solution.pressure == pytest.approx(0.05 * sphere.compliance.uniform_stiffness, rel=1e-3)


def test_coarser_bore_has_twice_the_width():
    coarse = BORE.coarser_bore
    assert coarse.compliance.grid.meridians == FINE.meridians / 2
    assert coarse.gap.grid is coarse.compliance.grid
    assert coarse.area == BORE.area == 18.0**2
    field = np.ones((1, coarse.compliance.grid.rings, coarse.compliance.grid.meridians))
    assert BORE.force(BORE.refine(field)) == pytest.approx(coarse.force(field), abs=0.2)
    assert bore_of(COARSE).coarser_bore is None
