"""Equilibria of many patients in JAX: the same as those of NumPy, patient by patient."""

from dataclasses import replace

import numpy as np
import pytest

from ballsocket.hip.jax_springs import join_contacts, solve_patients
from ballsocket.hip.socket_foundation import NO_LATERAL_SPRING
from ballsocket.hip.spring_equilibrium import solve_in_blocks

from .test_foundations import SPRINGS, TILTED

pytest.importorskip("jax")

RNG = np.random.default_rng(2)
LATERAL = np.diag([500.0, 0.0, 0.0])
WORN = RNG.uniform(0.0, 0.02, (3, len(SPRINGS.areas)))


def contacts(depths, lateral=NO_LATERAL_SPRING):
    """Contacts of three patients: another clearance, modulus, load and worn depth each."""
    patients = zip((0.05, 0.1, 0.2), (80.0, 100.0, 300.0), (0.5, 1.0, 2.0), depths, strict=True)
    return [
        replace(SPRINGS, clearance=clearance, modulus=modulus).contact(factor * TILTED, depth, lateral)
        for clearance, modulus, factor, depth in patients
    ]


@pytest.mark.parametrize(
    ("depths", "lateral"),
    [(WORN, NO_LATERAL_SPRING), (WORN, LATERAL), (WORN[:, None] * np.array([[0.5], [1.0], [2.0]]), LATERAL)],
)
def test_every_patient_has_the_equilibrium_of_numpy(depths, lateral):
    patients = contacts(depths, lateral)
    start = np.stack([factor * TILTED / 1000.0 for factor in (0.3, 0.2, -0.2)])
    solved = solve_patients(join_contacts(patients), start)
    assert solved.displacement.dtype == np.float64
    assert np.asarray(solved.converged).all()
    for patient, contact in enumerate(patients):
        displacement, pressure = start[patient].copy(), np.empty((3, len(SPRINGS.areas)))
        assert solve_in_blocks(contact, displacement, pressure)
        np.testing.assert_allclose(solved.displacement[patient], displacement, rtol=0, atol=1e-12)
        np.testing.assert_allclose(solved.pressure[patient], pressure, rtol=0, atol=1e-11 * pressure.max())


def test_a_patient_that_does_not_converge_leaves_the_others_converged():
    patients = contacts(np.stack([WORN[0], np.full_like(WORN[0], np.nan), WORN[2]]))
    solved = solve_patients(join_contacts(patients), np.broadcast_to(0.2 * TILTED / 1000.0, (3, 3, 3)))
    assert np.asarray(solved.converged).tolist() == [True, False, True]


def test_contacts_that_do_not_fit_are_refused():
    one, two, _ = contacts(WORN)
    start = np.broadcast_to(0.2 * TILTED / 1000.0, (2, 3, 3))
    few = SPRINGS.contact(TILTED[:2], WORN[0], NO_LATERAL_SPRING)
    many = SPRINGS.contact(TILTED, np.tile(WORN[0], (3, 1)), NO_LATERAL_SPRING)
    for join, error, message in [
        (lambda: join_contacts([]), ValueError, "at least one patient"),
        (lambda: join_contacts([one, few]), ValueError, "got 2 loads on .* cells, 3 loads on .* cells"),
        (lambda: join_contacts([one, many]), ValueError, "a depth under each load, or one depth"),
        (
            lambda: solve_patients(join_contacts([one, two]), start[:1]),
            ValueError,
            r"start of shape \(1, 3, 3\) is not",
        ),
        (lambda: join_contacts(one), TypeError, "contacts must be a list of SpringContact, got"),
        (lambda: solve_patients(one, start), TypeError, "contacts must be those of join_contacts"),
    ]:
        with pytest.raises(error, match=message):
            join()
