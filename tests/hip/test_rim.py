"""Distance from the contact to the rim, and microseparation with the ball on the rim."""

from dataclasses import replace
from math import cos, degrees, pi, radians, sin
from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.grid import even_grid
from ballsocket.hip import Spring, iso_14242_1, iso_14242_4
from ballsocket.hip.microseparation import SpringLoadedBall
from ballsocket.hip.rim import RimDistance, rim_distance

from .hips import hip, socket_force

REACH, RADIUS = radians(90.0), 20.0
GRID = even_grid(REACH, radians(3.0))


def cap(half_angle, tilt=0.0, azimuth=0.0):
    """Return the half angle less the distance from a cap's axis at each cell, so that the zero is the cap's edge."""
    axis = np.array([sin(tilt) * cos(azimuth), sin(tilt) * sin(azimuth), cos(tilt)])
    distance = np.arccos(np.clip(np.tensordot(axis, GRID.middles, 1), -1.0, 1.0))
    return (half_angle - distance).reshape(1, -1)


def distance_of(*fields, inset=0.0):
    field = np.vstack(fields)
    return rim_distance(GRID, RADIUS, field, np.maximum(field, 0.0), inset)


def test_the_distance_of_a_cap_is_exact_on_the_axis_along_its_azimuth_when_tilted_and_zero_at_the_rim():
    half_angles = np.radians([20.0, 33.3, 47.0, 80.0])
    result = distance_of(*map(cap, half_angles))
    assert result.distance == pytest.approx(RADIUS * (REACH - half_angles), rel=1e-9)
    assert result.pressure == pytest.approx(0.0, abs=0)
    azimuths = [0.0, 40.0, -90.0, 135.0]
    result = distance_of(*(cap(radians(30.0), radians(40.0), radians(azimuth)) for azimuth in azimuths))
    assert result.distance == pytest.approx(RADIUS * radians(20.0), abs=RADIUS * radians(0.3))
    assert np.degrees(result.azimuth) == pytest.approx(azimuths, abs=3.0)
    result = distance_of(cap(radians(30.0), radians(75.0), radians(60.0)), cap(radians(30.0)))
    assert result.distance == pytest.approx([0.0, RADIUS * radians(60.0)])
    assert degrees(result.azimuth[0]) == pytest.approx(60.0, abs=0.5)
    assert result.pressure == pytest.approx([radians(15.0), 0.0], abs=radians(3.0))
    assert result.pressure[1] == 0.0


def test_a_contact_between_the_last_ring_and_the_rim_is_extrapolated_and_an_inset_moves_the_edge():
    last, width = GRID.polar[-1], GRID.width
    result = distance_of(cap(last + 0.2 * width))
    assert result.distance[0] == pytest.approx(RADIUS * (REACH - last - 0.2 * width), rel=1e-6)
    edge, inner = (distance_of(cap(radians(40.0)), inset=inset).distance for inset in (0.0, 0.25))
    assert inner - edge == pytest.approx(RADIUS * 0.25 * width, rel=1e-6)
    assert distance_of(cap(last + 1e-3), inset=0.25).distance[0] == pytest.approx(0.0, abs=1e-12)


def loading(*forces):
    loads = np.outer(forces, [0.0, 0.0, 1.0])
    return SimpleNamespace(loads=loads, cycle=iso_14242_1(10), loaded=np.arange(len(forces)) + 3)


AZIMUTHS = np.radians([10.0, 20.0, -30.0, 40.0])
RIM = RimDistance(distance=np.array([3.0, 0, 0, 1]), azimuth=AZIMUTHS, pressure=np.array([5.0, 1, 2, 0]))


def test_the_closest_approach_is_that_of_the_largest_load_among_equals():
    assert RIM.closest_index(loading(900.0, 100.0, 200.0, 800.0)) == 2
    assert RIM.closest_index(loading(900.0, 300.0, 200.0, 800.0)) == 1
    closest = RIM.closest_approach(loading(900.0, 100.0, 200.0, 800.0))
    assert closest.location == "55.0 % of the cycle, 30° from the cup's uppermost point"
    step = {"at": "55.0 % of the cycle", "distance_mm": 0.0, "place_deg": pytest.approx(-30.0)}
    cycle = {"instants_at_rim": 2, "pressure_at_rim_MPa": 5.0, "kind": "edge loading", "instants_edge_loaded": 2}
    assert closest.summary() == step | cycle
    empty = RimDistance(distance=np.zeros(0), azimuth=np.zeros(0), pressure=np.zeros(0))
    assert empty.closest_index(loading()) is None
    assert empty.closest_approach(loading()) is None


# microseparation


def spring_ball(mismatch=4.0, stiffness=100.0):
    spring = Spring(stiffness=stiffness, mismatch=mismatch)
    side = np.array([1.0, 0.0, 0.0])
    return SpringLoadedBall(spring=spring, side=side, reach=pi / 2, socket_radius=14.1, ball_radius=14.0)


@pytest.mark.parametrize("mismatch", [4.0, -4.0])
def test_a_ball_leaves_its_bore_if_it_moves_to_the_rim_against_its_spring(mismatch):
    """On the rim the centre is at R2 sin(reach) - R1 sin(tilt): the spring holds the ball if that is positive."""
    tilts = np.radians([82.0, 83.0, 90.0, 97.0, 98.0, 120.0])
    forces = 400.0 * np.column_stack([np.sign(mismatch) * np.sin(tilts), 0 * tilts, np.cos(tilts)])
    ball = replace(spring_ball(mismatch), reach=radians(80.0))
    leaves = 14.0 * np.sin(tilts) >= 14.1 * sin(radians(80.0))
    assert leaves.tolist() == [False, True, True, True, False, False]
    assert ball.leaves_bore(forces).tolist() == leaves.tolist()
    assert not spring_ball(mismatch).leaves_bore(forces).any()


def test_a_mismatch_moves_the_contact_towards_the_rim_and_onto_it_in_the_swing_phase():
    use = hip(cycle=iso_14242_4(100), cup=bs.Cup(inclination=radians(45.0)), ring_width=radians(8.0))
    apart = use.frame.separation
    assert (use.cycle.phases[apart.steps] > 0.6).sum() > 30
    assert apart.medial_lateral < 4.0  # the mismatch
    assert apart.medial_lateral < apart.centre_distance < 8.0
    assert np.degrees(apart.azimuth) == pytest.approx(0.0, abs=1e-9)
    (note,) = (note for note in use.notes if note.startswith("microseparation from"))
    assert "wear by the contact with the rim is not included" in note
    assert "0.9 mm ± 0.2 mm and 2.1 mm ± 0.5 mm medial-lateral" in note
    assert len(use.frame.loaded) + len(apart.steps) == 100
    summary = use.after(1e4).summary()["cycle"]["microseparation"]
    assert summary["centre_distance_mm"] == apart.centre_distance
    assert (summary["from"], summary["to"]) == ("59.5 % of the cycle", "2.5 % of the cycle")  # of the next
    # the spring's 400 N tilt the load by their share of it
    pulled, straight = (hip(cycle=make(50)) for make in (iso_14242_4, iso_14242_1))
    near, far = (use.edge_distance(use.unworn)[use.frame.largest_load_index[0]] for use in (pulled, straight))
    tilt = np.arctan2(400.0, straight.cycle.force_magnitudes.max())
    assert near == pytest.approx(far - straight.joint.socket_radius * tilt, abs=0.1)


def test_the_load_on_the_rim_points_from_the_centre_to_the_edge():
    use = hip(cycle=iso_14242_4(100, mismatch=3.0), cup=bs.Cup(inclination=radians(50.0), anteversion=radians(10.0)))
    apart, radius = use.frame.separation, use.joint.socket_radius
    edge = radius * np.column_stack([np.cos(apart.azimuth), np.sin(apart.azimuth), 0 * apart.azimuth])
    along = edge - apart.displacement
    assert np.linalg.norm(along, axis=1) == pytest.approx(use.joint.ball_radius, rel=1e-9)
    side = np.array(use.frame.placed.frame)[:, 0]
    displacement = apart.displacement @ side
    loads = use.frame.forces[apart.steps] - 100.0 * displacement[:, None] * side
    assert np.cross(along, loads) == pytest.approx(0.0, abs=1e-4)
    assert ((displacement > 0) & (displacement < 3.0)).all()


def test_wear_is_continuous_in_the_tilt_of_a_cup_with_microseparation():
    use = hip(36.0, 6.0, cycle=iso_14242_4(100), ring_width=radians(6.0))
    tilted = [replace(use, cup=bs.Cup().tilted(radians(tilt))) for tilt in np.arange(40.0, 46.0, 0.2)]
    for turned in tilted:
        assert len(turned.frame.loaded) + len(turned.frame.separation.steps) == 100
        assert turned.unworn.converged
        assert np.linalg.norm(turned.unworn.displacement, axis=1).max() < 0.6
    volumes = np.array([turned.first.volume for turned in tilted])
    assert abs(np.diff(volumes) / volumes[:-1]).max() < 0.01


@pytest.mark.parametrize("surface", [bs.Springs(), bs.ClosedShell()])
def test_the_bore_carries_the_load_less_the_relaxation_of_the_spring(surface):
    cup = bs.Cup(inclination=radians(40.0), anteversion=radians(8.0))
    use = hip(36.0, 6.0, cycle=iso_14242_4(50), cup=cup, ring_width=radians(6.0), surface=surface)
    side = np.array(use.frame.placed.frame)[:, 0]
    expected = use.frame.loads - 100.0 * (use.unworn.displacement @ side)[:, None] * side
    assert np.linalg.norm(expected - use.frame.loads, axis=1).max() > 5.0
    error = 2e-6 * np.linalg.norm(use.frame.loads, axis=1).max()
    assert socket_force(use.foundation, use.unworn) == pytest.approx(expected, rel=2e-6, abs=error)


def test_microseparation_of_a_left_hip_mirrors_that_of_a_right_one():
    cups = (bs.Cup(inclination=radians(45.0), anteversion=radians(10.0), side=side) for side in bs.Side)
    right, left = (hip(cycle=iso_14242_4(50), cup=cup) for cup in cups)
    assert left.frame.separation.displacement == pytest.approx(
        right.frame.separation.displacement * [1, -1, 1], abs=1e-9
    )
    assert left.first.volume == pytest.approx(right.first.volume, rel=1e-9)
