"""Cycles of simulators and patients, mixes of activities, and kinematics of the ball with cross-shear of tracks."""

from dataclasses import replace
from itertools import permutations
from math import acos, cos, degrees, pi, radians, sin

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ballsocket as bs
from ballsocket.core.kinds import Kind
from ballsocket.hip import (
    Activity,
    Mix,
    iso_14242_1_key_points,
    iso_14242_4,
    kinematics,
    logarithmic,
    rocking,
    two_axis,
)
from ballsocket.hip.cycle import Cycle, Frame, Spring, check_step_count
from ballsocket.hip.cycle_registry import CYCLES, named_cycle
from ballsocket.hip.cycle_tables import monotone_periodic
from ballsocket.hip.in_vivo_cycles import check_body_weight, in_vivo
from ballsocket.hip.kinematics import SurfaceSliding, rotation_matrices, sliding_distance
from ballsocket.hip.simulator_cycles import constant_load, flexion, iso_14242_1

from .hips import K, hip, refuses, report_after

UP = np.array([0.0, 0.0, 1.0])
PHASES = np.linspace(0.0, 1.0, 41)


def angles_of(cycle, *phases):
    return np.degrees(cycle.angles(np.array(phases)))


def test_iso_force_and_angles_have_their_key_points_and_half_cosines_between():
    points = {0.0: 300, 0.12: 3000, 0.32: 1500, 0.5: 3000, 0.62: 300, 0.8: 300, 1.0: 300}
    between = {0.06: 1650, 0.22: 2250, 0.41: 2250, 0.03: 1650 - 1350 * cos(pi / 4), 0.09: 1650 + 1350 * cos(pi / 4)}
    for phase, force in (points | between).items():
        assert iso_14242_1().force(np.array([phase]))[0] == pytest.approx(force, rel=1e-12)
    assert iso_14242_1().largest_force == pytest.approx(3000.0, rel=1e-12)
    by_half_cosines = iso_14242_1_key_points(16)
    for cycle in (iso_14242_1(), by_half_cosines):
        assert angles_of(cycle, 0.0, 0.25, 0.5, 0.75)[0] == pytest.approx([25, 3.5, -18, 3.5], abs=1e-12)
        assert angles_of(cycle, 0.21, 0.71)[1] == pytest.approx([7, -4], abs=1e-12)
        assert angles_of(cycle, 0.0, 0.25, 0.5, 0.75)[2] == pytest.approx([-10, -4, 2, -4], abs=1e-12)
    points = angles_of(by_half_cosines, 0.0, 0.105, 0.355, 0.6, 0.855, 1.0)[1]
    assert points == pytest.approx([3.0, 5.0, 1.5, -4.0, -0.5, 3.0], abs=1e-9)
    assert angles_of(iso_14242_1(), 0.0)[1, 0] == pytest.approx(1.5 + 5.5 * cos(2 * pi * 0.21))
    replaced = iso_14242_1(16, angles=by_half_cosines.angles)
    assert replaced.rotation_increments == pytest.approx(by_half_cosines.rotation_increments)


def test_iso_cycles_prescribe_the_tilt_of_the_cup_and_a_second():
    for make in (iso_14242_1, iso_14242_1_key_points, iso_14242_4, flexion):
        cycle = make(16)
        assert degrees(cycle.cup_tilt) == pytest.approx(30.0)
        assert (cycle.n_steps, cycle.duration, cycle.frame) == (16, 1.0, Frame.BODY)
        assert cycle.seconds == pytest.approx(np.full(16, 1 / 16))
        assert "not from the standard itself" in cycle.notes[0]
    for make in (two_axis, rocking, constant_load):
        assert make().cup_tilt is None


def test_mismatch_cycle_has_a_spring_and_a_lower_swing_load():
    cycle = iso_14242_4()
    assert (cycle.spring.mismatch, cycle.spring.stiffness, cycle.spring.force) == (4.0, 100.0, 400.0)
    assert cycle.force(np.array([0.12, 0.32, 0.5, 0.7])) == pytest.approx([3000.0, 1500.0, 3000.0, 70.0])
    assert cycle.rotations == pytest.approx(iso_14242_1().rotations, abs=0)
    assert cycle.forces[:, 0] == pytest.approx(400.0)
    assert iso_14242_4(swing_load=150.0).force(np.array([0.0, 0.8, 1.0])) == pytest.approx(150.0)
    assert iso_14242_4(mismatch=-2.0, stiffness=50.0).spring.force == -100.0


@pytest.mark.parametrize(("radius", "n_steps"), [(11.1125, 8), (18.0, 100)])
def test_flexion_slides_twice_its_range_under_the_force_of_iso(radius, n_steps):
    cycle = flexion(n_steps)
    distance = sliding_distance(radius, cycle.rotation_increments, UP)
    assert distance == pytest.approx(2 * radians(43.0) * radius, rel=1e-12)
    assert cycle.angles(PHASES)[1:] == pytest.approx(0.0, abs=0)
    assert cycle.angles(PHASES)[0] == pytest.approx(iso_14242_1().angles(PHASES)[0], abs=0)
    assert cycle.force(PHASES) == pytest.approx(iso_14242_1().force(PHASES), abs=0)


def test_two_axis_cycle_has_its_ranges_a_quarter_of_a_cycle_apart():
    cycle = two_axis(1000)
    assert np.ptp(angles_of(cycle, *np.linspace(0.0, 1.0, 1001)), axis=1) == pytest.approx([46.0, 12.0, 0.0], abs=1e-9)
    assert angles_of(cycle, 0.0, 0.25)[:2] == pytest.approx(np.array([[23.0, 0.0], [0.0, 6.0]]), abs=1e-12)
    assert (cycle.force_magnitudes.min(), cycle.largest_force) == pytest.approx((400.0, 2000.0), rel=1e-6)
    half_peak = two_axis(peak=1000.0).force(np.array([0.0, 0.12, 0.32]))
    assert half_peak == pytest.approx([200.0, 1000.0, 200 + 800 * 1200 / 2700])


def test_rocking_moves_the_axis_on_a_cone_without_spin_under_a_sine():
    for amplitude in np.radians([23.0, 5.0]):
        cycle = rocking(64, amplitude=amplitude)
        rotations, axis = cycle.rotations, cycle.rotations[:, :, 2]
        assert np.arccos(axis[:, 2]) == pytest.approx(amplitude, rel=1e-9)
        azimuth = np.unwrap(np.arctan2(axis[:, 1], axis[:, 0]))
        assert abs(np.diff(azimuth[:-1])) == pytest.approx(2 * pi / 64, rel=1e-9)
        trace = np.trace(rotations, axis1=1, axis2=2)  # 1 + 2 cos of the angle: only the tilt, about a horizontal axis
        assert trace == pytest.approx(1 + 2 * cos(amplitude), rel=1e-12)
        assert rotations[:, 0, 1] == pytest.approx(rotations[:, 1, 0], abs=1e-12)
        first = [[1, 0, 0], [0, cos(amplitude), -sin(amplitude)], [0, sin(amplitude), cos(amplitude)]]
        assert rotations[0] == pytest.approx(np.array(first), abs=1e-12)
    cycle = rocking(1000)  # its amplitude is 23 degrees
    distance = sliding_distance(14.0, cycle.rotation_increments, UP)
    assert distance == pytest.approx(2 * pi * 14.0 * sin(radians(23.0)), rel=1e-4)
    assert cycle.force(np.array([0.0, 0.25, 0.5, 0.75])) == pytest.approx([200.0, 1100.0, 2000.0, 1100.0])
    assert rocking(peak=500.0).largest_force == pytest.approx(500.0)
    assert rocking(order="zyx").rotations == pytest.approx(rocking().rotations, abs=0)


def test_force_and_amplitude_scale_the_machines():
    usual, scaled = flexion(40), flexion(40, peak=1500.0, amplitude=radians(43.0))
    assert scaled.forces == pytest.approx(usual.forces / 2)
    middle = radians(3.5)
    assert scaled.angles(PHASES)[0] - middle == pytest.approx(2 * (usual.angles(PHASES)[0] - middle))
    assert np.ptp(two_axis(amplitude=radians(30.0)).angles(PHASES), axis=1) == pytest.approx(np.radians([60, 12, 0]))
    for name in ("flexion", "biaxial-rocking", "two-axis", "constant-load"):
        assert {parameter.key for parameter in CYCLES[name].parameters} == {"force", "amplitude"}


def test_constant_load_has_one_force_and_a_cosine_of_flexion():
    cycle = constant_load()
    assert cycle.force_magnitudes == pytest.approx(3000.0, abs=0)
    assert angles_of(cycle, 0.0, 0.25, 0.5) == pytest.approx(np.outer([1, 0, 0], [21.5, 0.0, -21.5]), abs=1e-12)
    assert constant_load(force=100.0).largest_force == 100.0
    # steps of 20 end at the extremes of the cosine, so the increments add up to four amplitudes
    assert abs(constant_load(20, amplitude=0.1).rotation_increments[:, 0]).sum() == pytest.approx(0.4, rel=1e-12)


PEAKS = {
    "walking": (247, "2016", 1.0),
    "one-leg-stance": (261, "2016", 4.0),
    "stand-up": (215, "2016", 6.0),
    "average-walking": (238, "2001", 1.0),
    "stairs-up": (251, "2001", 1.0),
    "stairs-down": (260, "2001", 1.0),
    "jogging": (550, "1993", 0.7),
    "stumbling": (870, "1993", 1.0),
}


def test_loads_of_patients_are_multiples_of_body_weight():
    assert list(PEAKS) == [name for name, definition in CYCLES.items() if definition.per_body_weight]
    for name, (percent, year, duration) in PEAKS.items():
        cycle = named_cycle(name, body_weight=750.0)
        assert cycle.largest_force == pytest.approx(7.5 * percent, rel=1e-6)
        assert cycle.duration == duration
        for words in (f"{name}: a peak of {percent} % of body weight", f"Bergmann {year}", "assumed: "):
            assert words in cycle.notes[0]
        assert in_vivo(name, 1500.0).forces == pytest.approx(2 * cycle.forces, rel=1e-12)
    assert check_body_weight(10_000.0) == 10_000.0


def test_patients_load_and_move_the_hip_as_stated():
    """Peaks rise from a tenth as squares of sines; standing up begins at 80 degrees; walking is that of ISO."""
    shares = {
        "one-leg-stance": {0.0: 0.1, 0.25: 0.55, 0.5: 1.0, 1.0: 0.1},
        "stand-up": {0.0: 0.1, 0.125: 0.55, 0.25: 1.0, 0.5: 0.1, 0.75: 1.0, 0.875: 0.55},
        "jogging": {0.0: 0.1, 0.0875: 0.55, 0.175: 1.0, 0.35: 0.1, 0.7: 0.1},
    }
    for name, points in (shares | {"stumbling": shares["jogging"]}).items():
        expected = 10 * PEAKS[name][0] * np.array(list(points.values()))
        assert in_vivo(name, 1000.0).force(np.array(list(points))) == pytest.approx(expected, rel=1e-9)
    angles = angles_of(in_vivo("stand-up", 800.0), 0.0, 0.25, 0.5, 1.0)
    assert angles == pytest.approx(np.outer([1, 0, 0], [80.0, 40.0, 0.0, 80.0]), abs=1e-9)
    for name in ("one-leg-stance", "stumbling"):
        assert in_vivo(name, 800.0).rotation_increments == pytest.approx(0.0, abs=0)
    for order in ("xyz", "zyx"):
        iso, walking = iso_14242_1(50, order), in_vivo("walking", 1000.0, 50, order)
        assert walking.forces == pytest.approx(iso.forces * 2470 / 3000, rel=1e-12)
        assert walking.rotations == pytest.approx(iso.rotations, abs=0)


@pytest.mark.parametrize("name", CYCLES)
def test_every_named_cycle_is_periodic_has_a_source_and_its_parameters(name):
    weight = {"body_weight": 800.0} if CYCLES[name].per_body_weight else {}
    cycle = named_cycle(name.upper().replace("-", " "), n_steps=24, **weight)
    assert cycle.name == CYCLES[name].name == name
    assert cycle.n_steps == 24
    assert CYCLES[name].source
    assert cycle.rotations[-1] == pytest.approx(cycle.rotations[0], abs=0)
    assert angles_of(cycle, 0.0) == pytest.approx(angles_of(cycle, 1.0), abs=1e-10)
    start, end = np.asarray(cycle.force(np.array([0.0, 1.0])))
    assert start == pytest.approx(end, rel=1e-9)
    values = {Kind.FORCE: 1234.0, Kind.ANGLE: 0.1, Kind.LENGTH: 2.0, Kind.STIFFNESS: 55.0}
    for number in CYCLES[name].parameters:
        changed = named_cycle(name, n_steps=24, **weight, **{number.argument: values[number.kind]})
        same_force = np.array_equal(changed.forces, cycle.forces)
        assert same_force != np.array_equal(changed.rotations, cycle.rotations), number.key


def test_forces_are_those_at_midpoints_upward_or_vectors():
    cycle = iso_14242_1(10)
    assert cycle.phases == pytest.approx(np.arange(0.05, 1.0, 0.1))
    assert cycle.forces == pytest.approx(np.outer(cycle.force(cycle.phases), UP))
    assert cycle.force_magnitudes == pytest.approx(cycle.force(cycle.phases))
    assert cycle.activity_slices == (("iso-14242-1", slice(0, 10)),)
    assert cycle.describe_step(3) == "35.0 % of the cycle"
    assert [check_step_count(count) for count in (8, 10_000)] == [8, 10_000]
    peaked = Cycle(name="one", force=lambda t: 100 * np.cos(2 * pi * (t - 0.123)), angles=flexion().angles, n_steps=8)
    assert peaked.largest_force == pytest.approx(100.0, rel=1e-6)  # between two midpoints
    assert peaked.force_magnitudes.max() < 99.9

    def pull(phases):
        return 100.0 * np.cos(2 * pi * phases)

    cycle = Cycle(name="pull", force=pull, angles=flexion().angles, n_steps=8)
    assert cycle.forces[:, 2] == pytest.approx(np.maximum(pull(cycle.phases), 0.0))
    vectors = replace(cycle, force=lambda t: np.stack([0 * t, 0 * t, pull(t)]))
    assert vectors.forces[:, 2] == pytest.approx(pull(cycle.phases))
    side = replace(vectors, spring=Spring(stiffness=10.0, mismatch=3.0))
    assert side.forces - vectors.forces == pytest.approx(np.tile([30.0, 0.0, 0.0], (8, 1)))


def test_rotations_are_at_step_ends_and_increments_lead_from_one_to_the_next():
    cycle = iso_14242_1(30, "zyx")
    assert cycle.rotations.shape == (31, 3, 3)
    midpoint = replace(cycle, angles=lambda t: cycle.angles(t + 0.5 / 30)).rotations[:-1]
    assert cycle.midpoint_rotations == pytest.approx(midpoint, abs=1e-12)
    for step, increment in enumerate(cycle.rotation_increments):
        angle = np.linalg.norm(increment)
        turned = cycle.rotations[step + 1] @ cycle.rotations[step].T
        assert turned @ increment == pytest.approx(increment, abs=1e-12)
        assert acos((np.trace(turned) - 1) / 2) == pytest.approx(angle, rel=1e-6)


def test_mirroring_reflects_forces_rotations_and_spring_and_scaling_and_refining_change_nothing_else():
    lean, walking = np.array([[0.1], [0.2], [0.97]]), iso_14242_1(20)
    cycle = replace(walking, force=lambda t: lean * walking.force(t), spring=Spring(stiffness=10.0, mismatch=2.0))
    mirror, mirrored = np.diag([-1.0, 1.0, 1.0]), cycle.mirrored()
    assert mirrored.forces == pytest.approx(cycle.forces @ mirror)
    assert mirrored.rotations == pytest.approx(mirror @ cycle.rotations @ mirror, abs=1e-12)
    assert mirrored.spring.mismatch == -2.0
    assert mirrored.mirrored().forces == pytest.approx(cycle.forces, abs=0)
    assert mirrored.mirrored().rotations == pytest.approx(cycle.rotations, abs=0)
    assert walking.mirrored().forces == pytest.approx(walking.forces, abs=0)
    in_cup = replace(cycle, frame=Frame.CUP).mirrored()
    assert in_cup.forces == pytest.approx(cycle.forces, abs=0)
    assert in_cup.spring.mismatch == 2.0
    assert in_cup.rotations == pytest.approx(mirrored.rotations, abs=0)
    cycle = iso_14242_1(30)
    assert cycle.finer().n_steps == 60
    assert replace(flexion(8), n_steps=6000).finer().n_steps == 10_000
    assert cycle.scaled(1.7).forces == pytest.approx(1.7 * cycle.forces)
    assert cycle.scaled(1.7).rotations == pytest.approx(cycle.rotations, abs=0)


def test_periodic_interpolation_passes_its_rows_closes_and_does_not_overshoot():
    phase = np.linspace(0.0, 1.0, 21)
    values = np.sin(2 * pi * phase)
    function = monotone_periodic(phase, values)
    assert function(phase) == pytest.approx(values, abs=1e-12)
    step = 1e-6
    ends = np.array([step, 1 - step])
    slopes = np.array([function(ends[:1]) - function(np.zeros(1)), function(np.ones(1)) - function(ends[1:])]) / step
    assert slopes[0] == pytest.approx(slopes[1], rel=1e-4)  # smooth over the end of the cycle
    assert slopes[0] == pytest.approx(2 * pi, rel=0.02)
    uneven = np.array([0.0, 0.1, 0.3, 0.6, 0.8, 1.0])
    ramps = monotone_periodic(uneven, np.array([[0.0, 1.0, 5.0, 2.0, 1.0, 0.0]]))
    fine = ramps(np.linspace(0.0, 1.0, 1001))[0]
    assert (fine.min(), fine.max()) == pytest.approx((0.0, 5.0), abs=1e-9)
    drifting = monotone_periodic(phase, 3.0 * phase)  # the difference of the ends is distributed
    assert drifting(phase) == pytest.approx(1.5, abs=1e-12)


# mixes of activities, and loads in the cup's frame

WALK, STAND = in_vivo("walking", 750.0, 40), in_vivo("stand-up", 750.0, 24)


def mixed(*parts):
    return Mix(activities=tuple(Activity(cycle=cycle, per_year=count) for cycle, count in parts))


def test_wear_of_a_mix_is_the_weighted_mean_of_its_activities():
    stand = in_vivo("stand-up", 750.0, 40)
    use = hip(cycle=mixed((WALK, 9e5), (stand, 1e5)))
    mean = 0.9 * hip(cycle=WALK).first.volume + 0.1 * hip(cycle=stand).first.volume
    assert use.first.volume == pytest.approx(mean, rel=1e-9)
    report = report_after(use, 1e6)
    assert report.volume == pytest.approx(1e-3 * K * report.work, rel=1e-6)
    assert use.frame.slide == pytest.approx(
        0.9 * hip(cycle=WALK).frame.slide + 0.1 * hip(cycle=stand).frame.slide, rel=1e-9
    )


def test_steps_of_a_mix_are_those_of_its_activities_one_after_the_other():
    mix = mixed((WALK, 9e5), (STAND, 1e5))
    assert (mix.n_steps, mix.name, mix.per_year) == (64, "walking + stand-up", 1e6)
    assert mix.fractions == pytest.approx((0.9, 0.1))
    assert mix.phases == pytest.approx((np.arange(64) + 0.5) / 64)
    assert mix.forces == pytest.approx(np.vstack([WALK.forces, STAND.forces]), abs=0)
    assert mix.force_magnitudes == pytest.approx(np.append(WALK.force_magnitudes, STAND.force_magnitudes), abs=0)
    midpoints = np.vstack([WALK.midpoint_rotations, STAND.midpoint_rotations])
    assert mix.midpoint_rotations == pytest.approx(midpoints, abs=0)
    increments = np.vstack([0.9 * WALK.rotation_increments, 0.1 * STAND.rotation_increments])
    assert mix.rotation_increments == pytest.approx(increments)
    assert mix.seconds[[0, -1]] == pytest.approx([0.9 / 40, 0.1 * 6 / 24])
    assert mix.duration == pytest.approx(0.9 * 1.0 + 0.1 * 6.0)
    assert mix.activity_slices == (("walking", slice(0, 40)), ("stand-up", slice(40, 64)))
    assert mix.largest_force == mixed((STAND, 1.0), (WALK, 1.0)).largest_force == WALK.largest_force
    assert mix.rotations is WALK.rotations
    assert mixed((WALK, 1.0), (STAND, 2.0)).rotations is STAND.rotations
    assert (mix.frame, mix.spring) == (Frame.BODY, None)
    for step, place in {0: "1.2 % of walking", 39: "98.8 % of walking", 40: "2.1 % of stand-up"}.items():
        assert mix.describe_step(step) == place
    with pytest.raises(IndexError):
        mix.describe_step(64)
    mix = mixed((WALK, 9e5), (STAND, 1e5))
    assert mix.scaled(2.0).forces == pytest.approx(2 * mix.forces)
    assert mix.finer().n_steps == 128
    mirrored = mix.mirrored()
    assert mirrored.rotation_increments == pytest.approx(mix.rotation_increments * [1, -1, -1], abs=1e-12)
    for changed in (mix.scaled(2.0), mix.finer(), mirrored):
        assert changed.fractions == mix.fractions
        assert changed.name == mix.name


def test_notes_and_tilt_of_a_mix_are_the_common_ones():
    same = mixed((flexion(8), 1.0), (iso_14242_1(8), 1.0))
    assert same.cup_tilt == pytest.approx(radians(30.0))
    assert same.notes == iso_14242_1().notes
    assert mixed((WALK, 1.0), (STAND, 1.0)).notes == (*WALK.notes, *STAND.notes)
    different = mixed((WALK, 1.0), (iso_14242_1(40), 1.0))
    assert different.cup_tilt is None
    assert different.notes[-1].startswith("no standard tilt of the cup is applied")
    assert hip(cycle=different, cup=bs.Cup()).frame.placed == bs.Cup()
    assert hip(cycle=same, cup=bs.Cup()).frame.placed.inclination == radians(30.0)


def test_creep_of_a_mix_follows_the_mean_force_over_time():
    """Half of the cycles last twice as long at twice the load: the mean is 5/3 of the smaller load."""
    light = Cycle(name="one", force=lambda t: 500.0 + 0 * t, angles=flexion().angles, n_steps=20)
    heavy = replace(light, name="two", force=lambda t: 1000.0 + 0 * t, duration=2.0)
    use = hip(cycle=mixed((light, 1.0), (heavy, 1.0)), creep=logarithmic())
    assert (use.cycle.seconds / use.cycle.duration) @ use.cycle.force_magnitudes == pytest.approx(500.0 * 5 / 3)
    assert report_after(use, 1e3).creep_depth > report_after(hip(cycle=light, creep=logarithmic()), 1e3).creep_depth


def test_loads_in_the_frame_of_the_cup():
    """A load straight up in the body's frame leans by the cup's tilt in the cup's frame."""
    lean = np.array([[sin(radians(30.0))], [0.0], [cos(radians(30.0))]])
    walk = iso_14242_1(72)
    in_cup = replace(walk, force=lambda t: lean * walk.force(t), frame=Frame.CUP)
    assert hip(cycle=in_cup).first.volume == pytest.approx(hip(cycle=walk).first.volume, rel=1e-12)
    left = bs.Cup(inclination=radians(30.0), side=bs.Side.LEFT)
    assert hip(cycle=in_cup, cup=left).first.volume == pytest.approx(hip(cycle=walk).first.volume, rel=1e-9)


# rotations of the ball, cross-shear of tracks of known value, and the tracks themselves

POLE = np.array([[0.0], [0.0], [1.0]])


def random_directions(count, seed):
    directions = np.random.default_rng(seed).normal(size=(3, count))
    return directions / np.linalg.norm(directions, axis=0)


def test_rotations_are_right_handed_and_their_order_is_the_product_from_the_left():
    quarter = pi / 2
    for axis, (start, end) in enumerate([((0, 1, 0), (0, 0, 1)), ((0, 0, 1), (1, 0, 0)), ((1, 0, 0), (0, 1, 0))]):
        angles = quarter * (np.arange(3) == axis)
        assert rotation_matrices(angles) @ start == pytest.approx(np.array(end), abs=1e-15)
    angles = np.radians([20.0, 10.0, -30.0])
    single = {name: rotation_matrices(angles * (np.arange(3) == axis)) for axis, name in enumerate("xyz")}
    for order in map("".join, permutations("xyz")):
        first, second, third = (single[name] for name in order)
        assert rotation_matrices(angles, order) == pytest.approx(first @ second @ third, abs=1e-15)


def test_rotation_vectors_are_those_of_another_program():
    angles = np.random.default_rng(3).uniform(1e-9, 3.0, 50)
    vectors = (random_directions(50, 3) * angles).T
    matrices = Rotation.from_rotvec(vectors).as_matrix()
    assert kinematics.rotation_vectors(matrices) == pytest.approx(vectors, rel=1e-7, abs=1e-15)
    assert kinematics.rotation_vectors(np.eye(3)) == pytest.approx(np.zeros(3), abs=0)


def test_words_for_a_rotation_order():
    words = {
        "xyz": ("flexion, adduction, rotation", "FE-AA-IER"),
        "xzy": ("flexion; rotation, abduction", "f r a", "fra"),
        "zxy": ("inward rotation, flexion-extension, abduction-adduction", ["rotation", "flexion", "adduction"]),
        "zyx": (" ZYX ",),
        "yxz": (("aa", "fe", "ie"),),
    }
    for axes, texts in words.items():
        assert {kinematics.parse_rotation_order(text) for text in texts} == {axes}
    for text in ("ie r", "flexion, flexion, rotation", "flexion, adduction", "xyzx", "", 123, None):
        refuses("rotation_order = .* is not allowed: .* in any order", kinematics.parse_rotation_order, text)


def test_sliding_over_the_pole_has_the_length_of_its_track():
    cycle, radius = iso_14242_1(200), 14.0
    sliding = SurfaceSliding(radius=radius, rotation_increments=cycle.rotation_increments, directions=POLE)
    steps = radius * np.cross(cycle.rotation_increments, UP)
    assert sliding.distances[:, 0] == pytest.approx(np.linalg.norm(steps, axis=1), rel=1e-9)


def test_a_point_on_the_axis_does_not_slide_and_flexion_has_no_cross_shear():
    increments = 0.1 * np.tile([0.0, 0.0, 1.0], (4, 1))
    directions = np.array([[0.0, 1.0, sin(0.3)], [0.0, 0.0, 0.0], [1.0, 0.0, cos(0.3)]])
    sliding = SurfaceSliding(radius=10.0, rotation_increments=increments, directions=directions)
    assert sliding.distances == pytest.approx(np.tile([0.0, 1.0, sin(0.3)], (4, 1)), abs=1e-12)
    assert sliding.cross_shear(np.ones((4, 3))) == pytest.approx(np.zeros(3), abs=1e-12)
    assert sliding.crossing_angle(np.ones((4, 3)))[1:] == pytest.approx(0.0, abs=1e-7)
    assert sliding.crossing_angle(np.zeros((4, 3))) == pytest.approx(np.zeros(3), abs=0)
    increments, directions = flexion().rotation_increments, random_directions(40, 1)
    sliding = SurfaceSliding(radius=14.0, rotation_increments=increments, directions=directions)
    assert sliding.cross_shear(np.ones((len(increments), 40))) == pytest.approx(0.0, abs=1e-12)


def rectangle(a, b, angle=0.0):
    """Rotations of a ball whose pole follows a rectangle of a by b, turned by an angle."""
    x, y = np.array([[cos(angle), sin(angle), 0.0], [-sin(angle), cos(angle), 0.0]])
    return np.array([a * x, b * y, -a * x, -b * y])


AROUND = 2 * pi * (np.arange(400) + 0.5) / 400
TRACKS = {
    "a line": (flexion(40).rotation_increments, 0.0),
    "a circle": (1e-3 * np.column_stack([np.cos(AROUND), np.sin(AROUND), 0 * AROUND]), 0.5),
    "no track": (np.zeros((4, 3)), 0.0),
    "a square": (rectangle(1.0, 1.0, 0.7), 0.5),
    "a rectangle": (rectangle(3.0, 1.0), 0.25),
    "a long rectangle": (rectangle(20.0, 0.5, 0.7), 0.5 / 20.5),
    "a sliver": (rectangle(1.0, 1e-7, 0.7), 1e-7),
}


@pytest.mark.parametrize("name", TRACKS)
def test_cross_shear_and_crossing_angle_of_known_tracks(name):
    """The shorter side over both sides of a rectangle, and 1/2 on a circle; the angle is π/2 times as large."""
    increments, share = TRACKS[name]
    sliding, pressed = SurfaceSliding(radius=1.0, rotation_increments=increments, directions=POLE), np.ones((400, 1))
    pressed = pressed[: len(increments)]
    assert sliding.cross_shear(pressed)[0] == pytest.approx(share, rel=1e-6, abs=1e-12)
    assert sliding.crossing_angle(pressed)[0] == pytest.approx(pi / 2 * share, abs=1e-7)


def test_cross_shear_weighs_a_track_by_its_pressure():
    sliding = SurfaceSliding(radius=1.0, rotation_increments=rectangle(3.0, 1.0), directions=POLE)
    pressed = np.array([[1.0], [3.0], [1.0], [0.0]])  # 6 mm along the long side, 3 mm along the short one
    assert sliding.crossing_angle(pressed)[0] == pytest.approx(pi / 2 / 3, abs=1e-7)
    assert sliding.cross_shear(pressed)[0] == pytest.approx(1 / 3)


def test_sliding_distance_follows_a_moving_point_along_its_track():
    increments = constant_load(40, amplitude=0.2).rotation_increments
    assert sliding_distance(10.0, increments, UP) == pytest.approx(10.0 * 4 * 0.2, rel=1e-12)
    assert sliding_distance(10.0, increments, np.array([1.0, 0.0, 0.0])) == pytest.approx(0.0, abs=1e-12)
    moving = np.where(np.arange(40)[:, None] < 20, UP, np.array([1.0, 0.0, 0.0]))
    assert sliding_distance(10.0, increments, moving) == pytest.approx(10.0 * 2 * 0.2, rel=1e-12)
    cycle, point = flexion(1000), np.array([[0.0], [np.sin(0.4)], [np.cos(0.4)]])
    track = kinematics.tracks(cycle.rotations, point, radius=14.0)[0]
    assert np.linalg.norm(np.diff(track, axis=0), axis=1).sum() == pytest.approx(2 * radians(43.0) * 14.0, rel=1e-4)
    assert np.linalg.norm(track, axis=1) == pytest.approx(14.0)
