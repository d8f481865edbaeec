"""Benchmark problems of spherical joints with clearance: references, and errors of programs."""

from math import radians

import numpy as np
import pytest

from .library import benchmark, needs_compiler

problems = benchmark("clearance_problems")
NUMBERS = {
    0.0: {
        "largest indentation, mm": 0.0184788982741769137,
        "largest force, N": 769.535097335625976,
        "duration of contact, s": 0.000524755742132070099,
        "period, s": 0.0050495114842641402,
    },
    radians(30.0): {
        "largest indentation, mm": 0.0172210352745102283,
        "duration of contact, s": 0.000551533410396703957,
        "angle swept in contact, deg": 13.0136312032043664,
    },
}
"""Integrals of the energy over the indentation with 40 digits."""


@pytest.mark.parametrize("angle", NUMBERS)
def test_numbers_of_an_impact_are_those_of_the_energy_integral(angle):
    found = problems.radial_impact(angle)
    assert {name: found[name] for name in NUMBERS[angle]} == pytest.approx(NUMBERS[angle], rel=1e-8)


@pytest.mark.long
@needs_compiler
@pytest.mark.parametrize("name", ["a_radial_bounce", "b_oblique_bounce"])
def test_two_programs_solve_an_impact_within_a_millionth(name, tmp_path):
    """The positions of the reference have the deepest point and the angle of the integrals."""
    errors = {program: error for (_, program), (error, _) in problems.write(tmp_path, (name,)).items()}
    assert len(errors) >= 2
    assert sorted(errors.values())[1] < 1e-6
    text = (tmp_path / name / "description.md").read_text()
    assert "largest indentation, mm" in text
    assert all(f"| {name} | {program} |" in (tmp_path / "README.md").read_text() for program in errors)
    rows = np.genfromtxt(tmp_path / name / "reference.csv", delimiter=",", names=True)
    problem = problems.PROBLEMS[name]()
    contact = problem.numbers["duration of contact, s"]
    around = problems.replace(problem.bounce, duration=contact, samples=201)
    path = problems.replace(problem, bounce=around).reference
    deepest = np.linalg.norm(path, axis=1).max() - problems.CLEARANCE
    assert deepest == pytest.approx(problem.numbers["largest indentation, mm"], rel=1e-6)
    assert np.linalg.norm(path[-1]) == pytest.approx(problems.CLEARANCE, rel=1e-7)
    swept = np.degrees(np.arctan2(path[-1, 0], path[-1, 2]))
    assert swept == pytest.approx(problem.numbers.get("angle swept in contact, deg", 0.0), abs=1e-6)
    assert len(rows) == 101


@pytest.mark.long
@needs_compiler
@pytest.mark.parametrize("name", ["c_pendulum", "d_four_bar", "e_wheel_in_a_pipe"])
def test_an_exported_joint_solves_a_mechanism_within_a_millionth(name, tmp_path):
    results = problems.write(tmp_path, (name,))
    assert results[name, "c"][0] < 1e-6
