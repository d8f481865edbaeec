"""Wear with full elasticity: as the off-axis model, near the springs, smooth, and with creep."""

from dataclasses import replace
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import iso_14242_1, logarithmic, rocking
from ballsocket.hip.elastic_foundation import elastic_foundation

from .hips import QUICK, TILTED, hip, report_after

COARSE = radians(5.0)
SURFACES = {"shell": bs.ClosedShell(), "cup": bs.RealCup()}


def elastic(surface="shell", **words):
    return hip(**({"surface": SURFACES[surface], "ring_width": COARSE, "cycle": iso_14242_1(50)} | words))


@pytest.mark.parametrize("surface", ["shell", pytest.param("cup", marks=pytest.mark.long)])
def test_first_cycle_has_the_contacts_of_the_off_axis_model(surface):
    use = elastic(surface, ring_width=radians(3.0))
    sphere = bs.Sphere(cup=TILTED, surface=SURFACES[surface], ring_width=radians(3.0))
    largest = int(use.cycle.force_magnitudes.argmax())
    contact = sphere.press(use.joint, force=use.cycle.force_magnitudes[largest])
    assert use.unworn.displacement[largest] == pytest.approx(contact.displacement, rel=2e-3, abs=2e-4)
    assert use.first.max_pressure == pytest.approx(contact.max_pressure, rel=1e-2)


def test_elasticity_changes_volume_and_depth_slightly():
    cup, springs = report_after(elastic("cup"), 2e5), report_after(hip(cycle=iso_14242_1(50)), 2e5)
    assert cup.volume == pytest.approx(springs.volume, rel=1e-2)
    assert cup.depth == pytest.approx(springs.depth, rel=3e-2)
    assert cup.volume != springs.volume


@pytest.mark.long
def test_finer_rings_give_the_same_wear_and_worn_depth_has_no_waves_of_the_grid():
    wide, narrow = (report_after(elastic(ring_width=radians(width)), 2e5) for width in (4.0, 2.5))
    assert wide.volume == pytest.approx(narrow.volume, rel=5e-3)
    assert wide.depth == pytest.approx(narrow.depth, rel=2e-2)
    use = elastic()
    wear = report_after(use, 1e6).wear
    rough = np.abs(np.diff(wear, n=4, axis=0))[wear[2:-2] > 0.5 * wear.max()]
    assert rough.max() < 0.02 * wear.max()
    assert use.solve_equilibrium(wear.ravel()).pressure.max() < use.first.max_pressure


def test_few_load_levels_wear_as_all_loads(monkeypatch):
    from ballsocket.hip import elastic_foundation as module

    use = elastic()
    few = use.first
    monkeypatch.setattr(module, "_MAX_LEVELS", 1000)
    every = elastic().first
    assert few.volume == pytest.approx(every.volume, rel=2e-3)
    assert few.depth == pytest.approx(every.depth, rel=5e-3)


def test_max_stiffness_bounds_every_wave():
    bed = elastic_foundation(bs.ClosedShell(), hip().joint, bs.Cup(), COARSE)
    for depth in np.random.default_rng(6).normal(size=(5, len(bed.areas))):
        pressure = bed.smooth(bed.compliance.stiffness(depth.reshape(1, bed.grid.rings, -1)).ravel())
        assert np.linalg.norm(pressure) <= 1.2 * bed.max_stiffness * np.linalg.norm(depth)


@pytest.mark.long
def test_swinging_loads_converge_in_a_worn_bore():
    """Small loads in a bore that is worn to the ball's form, where many cells touch at once."""
    use = elastic(cycle=rocking(20))
    report = report_after(use, 8e5)
    assert report.converged
    assert report.volume == pytest.approx(report_after(hip(cycle=rocking(20)), 8e5).volume, rel=1e-2)


@pytest.mark.long
def test_creep_lowers_the_pressures_of_an_elastic_socket():
    crept = report_after(elastic(creep=logarithmic(), **QUICK), 1e4)
    assert crept.converged
    assert crept.creep_depth == pytest.approx(report_after(hip(creep=logarithmic(), **QUICK), 1e4).creep_depth, rel=0.1)
    assert crept.max_pressure < 0.8 * elastic(**QUICK).first.max_pressure


def test_incompressible_liner_needs_springs():
    joint = replace(hip().joint, liner=bs.Material(young=1000.0, poisson=0.5))
    with pytest.raises(bs.OutsideDomainError, match="full elasticity has no answer for ν = 0.5"):
        replace(elastic(), joint=joint)
    assert replace(hip(), joint=joint).first.volume > 0
