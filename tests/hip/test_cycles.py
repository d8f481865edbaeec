"""Cycles of simulators and patients, their registry, and the functions of phase that they are made of."""

from dataclasses import fields, replace
from math import acos, cos, degrees, pi, radians, sin

import numpy as np
import pytest

from ballsocket.core.kinds import Kind
from ballsocket.hip import (
    Cycle,
    Frame,
    Spring,
    constant_load,
    flexion,
    in_vivo,
    iso_14242_1,
    iso_14242_1_key_points,
    iso_14242_4,
    named_cycle,
    rocking,
    two_axis,
)
from ballsocket.hip.cycle import check_step_count
from ballsocket.hip.cycle_registry import CYCLES
from ballsocket.hip.cycle_tables import monotone_periodic
from ballsocket.hip.in_vivo import check_body_weight
from ballsocket.hip.kinematics import sliding_distance
from ballsocket.hip.simulator_cycles import half_cosines

UP = np.array([0.0, 0.0, 1.0])
PHASES = np.linspace(0.0, 1.0, 41)
IN_VIVO = [name for name, definition in CYCLES.items() if definition.per_body_weight]


def made(name, **words):
    return named_cycle(name, body_weight=800.0 if CYCLES[name].per_body_weight else None, **words)


# simulators


@pytest.mark.parametrize(
    ("phase", "newton"),
    [
        (0.0, 300),
        (0.06, 1650),
        (0.12, 3000),
        (0.22, 2250),
        (0.32, 1500),
        (0.41, 2250),
        (0.5, 3000),
        (0.62, 300),
        (0.8, 300),
        (1.0, 300),
    ],
)
def test_iso_force_has_its_key_points_and_half_cosines_between(phase, newton):
    assert iso_14242_1().force(np.array([phase]))[0] == pytest.approx(newton, rel=1e-12)
    assert iso_14242_1().largest_force == pytest.approx(3000.0, rel=1e-12)


@pytest.mark.parametrize(
    ("phase", "angles"),
    [
        (0.0, (25, None, -10)),
        (0.21, (None, 7, None)),
        (0.25, (3.5, None, -4)),
        (0.5, (-18, None, 2)),
        (0.71, (None, -4, None)),
        (0.75, (3.5, None, -4)),
    ],
)
@pytest.mark.parametrize("make", [iso_14242_1, iso_14242_1_key_points])
def test_iso_angles_have_their_key_points(make, phase, angles):
    for angle, expected in zip(np.degrees(make().angles(np.array([phase])))[:, 0], angles, strict=True):
        assert expected is None or angle == pytest.approx(expected, abs=1e-12)


def test_key_points_of_adduction_are_joined_by_half_cosines():
    cycle = iso_14242_1_key_points()
    assert cycle.name == "iso-14242-1-key-points"
    points = np.degrees(cycle.angles(np.array([0.0, 0.105, 0.355, 0.6, 0.855, 1.0])))[1]
    assert points == pytest.approx([3.0, 5.0, 1.5, -4.0, -0.5, 3.0], abs=1e-9)
    smooth = np.degrees(iso_14242_1().angles(np.array([0.0])))[1, 0]
    assert smooth == pytest.approx(1.5 + 5.5 * cos(2 * pi * 0.21))


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
    cycle, walking = iso_14242_4(), iso_14242_1()
    assert cycle.name == "iso-14242-4"
    assert (cycle.spring.mismatch, cycle.spring.stiffness, cycle.spring.force) == (4.0, 100.0, 400.0)
    assert cycle.force(np.array([0.12, 0.32, 0.5, 0.7])) == pytest.approx([3000.0, 1500.0, 3000.0, 70.0])
    assert cycle.rotations == pytest.approx(walking.rotations, abs=0)
    assert cycle.forces[:, 0] == pytest.approx(400.0)
    assert iso_14242_4(swing_load=150.0).force(np.array([0.0, 0.8, 1.0])) == pytest.approx(150.0)
    for load in (0.0, -1.0, np.inf):
        with pytest.raises(ValueError, match="swing_load = .* is not allowed"):
            iso_14242_4(swing_load=load)
    changed = iso_14242_4(mismatch=-2.0, stiffness=50.0).spring
    assert changed.force == -100.0


@pytest.mark.parametrize("words", [{"stiffness": 0.0}, {"stiffness": np.inf}, {"mismatch": 0.0}, {"mismatch": np.inf}])
def test_springs_need_finite_numbers_that_are_not_zero(words):
    with pytest.raises(ValueError, match=f"{next(iter(words))} = .* is not allowed"):
        Spring(**{"stiffness": 100.0, "mismatch": 4.0} | words)


@pytest.mark.parametrize("radius", [11.1125, 14.0, 18.0])
@pytest.mark.parametrize("n_steps", [8, 72, 100])
def test_flexion_slides_twice_its_range(radius, n_steps):
    cycle = flexion(n_steps)
    distance = sliding_distance(radius, cycle.rotation_increments, UP)
    assert distance == pytest.approx(2 * radians(43.0) * radius, rel=1e-12)
    assert cycle.angles(PHASES)[1:] == pytest.approx(0.0, abs=0)
    assert cycle.angles(PHASES)[0] == pytest.approx(iso_14242_1().angles(PHASES)[0], abs=0)
    assert cycle.force(PHASES) == pytest.approx(iso_14242_1().force(PHASES), abs=0)


def test_two_axis_cycle_has_its_ranges_a_quarter_of_a_cycle_apart():
    cycle = two_axis(1000)
    angles = np.degrees(cycle.angles(np.linspace(0.0, 1.0, 1001)))
    assert np.ptp(angles, axis=1) == pytest.approx([46.0, 12.0, 0.0], abs=1e-9)
    assert np.degrees(cycle.angles(np.array([0.0, 0.25])))[:2] == pytest.approx(
        np.array([[23.0, 0.0], [0.0, 6.0]]), abs=1e-12
    )
    assert (cycle.force_magnitudes.min(), cycle.largest_force) == pytest.approx((400.0, 2000.0), rel=1e-6)
    half_peak = two_axis(peak=1000.0).force(np.array([0.0, 0.12, 0.32]))
    assert half_peak == pytest.approx([200.0, 1000.0, 200 + 800 * 1200 / 2700])


@pytest.mark.parametrize("amplitude", [radians(23.0), radians(5.0)])
def test_rocking_moves_the_axis_on_a_cone_without_spin(amplitude):
    cycle = rocking(64, amplitude=amplitude)
    axis = cycle.rotations[:, :, 2]
    assert np.arccos(axis[:, 2]) == pytest.approx(amplitude, rel=1e-9)
    azimuth = np.unwrap(np.arctan2(axis[:, 1], axis[:, 0]))
    assert abs(np.diff(azimuth[:-1])) == pytest.approx(2 * pi / 64, rel=1e-9)
    trace = np.trace(
        cycle.rotations, axis1=1, axis2=2
    )  # 1 + 2 cos of the angle: only the tilt, about a horizontal axis
    assert trace == pytest.approx(1 + 2 * cos(amplitude), rel=1e-12)
    assert cycle.rotations[:, 0, 1] == pytest.approx(cycle.rotations[:, 1, 0], abs=1e-12)
    assert cycle.rotations[0] == pytest.approx(
        np.array([[1, 0, 0], [0, cos(amplitude), -sin(amplitude)], [0, sin(amplitude), cos(amplitude)]]), abs=1e-12
    )


def test_rocking_slides_the_circle_of_its_cone_under_a_sine():
    cycle = rocking(1000)
    distance = sliding_distance(14.0, cycle.rotation_increments, UP)
    assert distance == pytest.approx(2 * pi * 14.0 * sin(radians(23.0)), rel=1e-4)
    assert cycle.force(np.array([0.0, 0.25, 0.5, 0.75])) == pytest.approx([200.0, 1100.0, 2000.0, 1100.0])
    assert rocking(peak=500.0).largest_force == pytest.approx(500.0)
    assert rocking(order="zyx").rotations == pytest.approx(rocking().rotations, abs=0)
    with pytest.raises(ValueError, match="rotation_order = 'xx' is not allowed"):
        rocking(order="xx")


def test_force_and_amplitude_scale_the_machines():
    usual, scaled = flexion(40), flexion(40, peak=1500.0, amplitude=radians(43.0))
    assert scaled.forces == pytest.approx(usual.forces / 2)
    middle = radians(3.5)
    phases = np.linspace(0.0, 1.0, 9)
    assert scaled.angles(phases)[0] - middle == pytest.approx(2 * (usual.angles(phases)[0] - middle))
    assert np.ptp(two_axis(amplitude=radians(30.0)).angles(PHASES), axis=1) == pytest.approx(np.radians([60, 12, 0]))
    machines = ("flexion", "biaxial-rocking", "two-axis", "constant-load")
    for name in machines:
        assert {parameter.key for parameter in CYCLES[name].parameters} == {"force", "amplitude"}


def test_constant_load_has_one_force_and_a_cosine_of_flexion():
    cycle = constant_load()
    assert cycle.force_magnitudes == pytest.approx(3000.0, abs=0)
    assert np.degrees(cycle.angles(np.array([0.0, 0.25, 0.5]))) == pytest.approx(
        np.array([[21.5, 0.0, -21.5], [0, 0, 0], [0, 0, 0]]), abs=1e-12
    )
    changed = constant_load(force=100.0, amplitude=0.1)
    assert changed.largest_force == 100.0
    assert changed.angles(np.array([0.0]))[0, 0] == 0.1
    # steps of 20 end at the extremes of the cosine, so the increments add up to four amplitudes
    assert abs(constant_load(20, amplitude=0.1).rotation_increments[:, 0]).sum() == pytest.approx(0.4, rel=1e-12)


# patients

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


@pytest.mark.parametrize("name", IN_VIVO)
def test_loads_of_patients_are_multiples_of_body_weight(name):
    percent, year, duration = PEAKS[name]
    cycle = named_cycle(name, body_weight=750.0)
    assert cycle.largest_force == pytest.approx(7.5 * percent, rel=1e-6)
    assert cycle.duration == duration
    assert f"{name}: a peak of {percent} % of body weight" in cycle.notes[0]
    assert f"Bergmann {year}" in cycle.notes[0]
    assert "assumed: " in cycle.notes[0]
    assert in_vivo(name, 1500.0).forces == pytest.approx(2 * cycle.forces, rel=1e-12)


def test_walking_has_the_waveform_and_motion_of_iso():
    iso, walking = iso_14242_1(50), in_vivo("walking", 1000.0, 50)
    assert walking.forces == pytest.approx(iso.forces * 2470 / 3000, rel=1e-12)
    assert walking.rotations == pytest.approx(iso.rotations, abs=0)
    assert in_vivo("walking", 1000.0, 50, "zyx").rotations == pytest.approx(iso_14242_1(50, "zyx").rotations, abs=0)


@pytest.mark.parametrize(
    ("name", "phases", "shares"),
    [
        ("one-leg-stance", [0.0, 0.25, 0.5, 1.0], [0.1, 0.55, 1.0, 0.1]),
        ("stand-up", [0.0, 0.125, 0.25, 0.5, 0.75, 0.875], [0.1, 0.55, 1.0, 0.1, 1.0, 0.55]),
        ("jogging", [0.0, 0.0875, 0.175, 0.35, 0.7], [0.1, 0.55, 1.0, 0.1, 0.1]),
        ("stumbling", [0.0, 0.0875, 0.175, 0.35, 0.7], [0.1, 0.55, 1.0, 0.1, 0.1]),
    ],
)
def test_peaks_rise_from_a_tenth_as_squares_of_sines(name, phases, shares):
    cycle = in_vivo(name, 1000.0)
    peak = 10 * PEAKS[name][0]
    assert cycle.force(np.array(phases)) == pytest.approx(peak * np.array(shares), rel=1e-9)


def test_standing_up_straightens_the_hip_from_80_degrees():
    angles = np.degrees(in_vivo("stand-up", 800.0).angles(np.array([0.0, 0.25, 0.5, 1.0])))
    assert angles[0] == pytest.approx([80.0, 40.0, 0.0, 80.0], abs=1e-9)
    assert angles[1:] == pytest.approx(0.0, abs=0)
    for name in ("one-leg-stance", "stumbling"):
        assert in_vivo(name, 800.0).rotation_increments == pytest.approx(0.0, abs=0)


@pytest.mark.parametrize("weight", [0.0, -1.0, 10_001.0, np.nan])
def test_body_weights_out_of_range_are_rejected(weight):
    with pytest.raises(
        ValueError, match="body_weight = .* is not allowed: a body weight is above 0 and at most 10000 N"
    ):
        check_body_weight(weight)
    assert check_body_weight(10_000.0) == 10_000.0


def test_body_weight_belongs_to_loads_of_patients():
    with pytest.raises(ValueError, match="'jogging' has loads in multiples of body weight: set body_weight"):
        named_cycle("jogging")
    with pytest.raises(ValueError, match="'two-axis' has loads in N: it does not take a body_weight"):
        named_cycle("two-axis", body_weight=750.0)
    with pytest.raises(ValueError, match="body_weight = -1 is not allowed"):
        named_cycle("walking", body_weight=-1.0)


# registry


@pytest.mark.parametrize("name", CYCLES)
def test_every_named_cycle_is_periodic_and_has_a_source(name):
    cycle = made(name, n_steps=24)
    assert cycle.name == CYCLES[name].name == name
    assert cycle.n_steps == 24
    assert CYCLES[name].source
    assert cycle.rotations[-1] == pytest.approx(cycle.rotations[0], abs=0)
    ends = np.array([0.0, 1.0])
    assert cycle.angles(ends)[:, 0] == pytest.approx(cycle.angles(ends)[:, 1], abs=1e-12)
    force = np.asarray(cycle.force(ends))
    assert force[0] == pytest.approx(force[1], rel=1e-9)


@pytest.mark.parametrize("name", [name for name in CYCLES if CYCLES[name].parameters])
def test_parameters_in_files_are_arguments_of_the_function(name):
    values = {Kind.FORCE: 1234.0, Kind.ANGLE: 0.1, Kind.LENGTH: 2.0, Kind.STIFFNESS: 55.0}
    for number in CYCLES[name].parameters:
        changed = made(name, **{number.argument: values[number.kind]})
        usual = made(name)
        same_force = np.array_equal(changed.forces, usual.forces)
        same_motion = np.array_equal(changed.rotations, usual.rotations)
        assert same_force != same_motion, number.key


@pytest.mark.parametrize("name", ["iso-14242-1", "ISO 14242-1", "iso_14242_1"])
def test_names_may_have_blanks_and_capitals(name):
    assert named_cycle(name).name == "iso-14242-1"


def test_unknown_names_suggest_the_closest():
    with pytest.raises(ValueError, match="cycle 'iso-14242' is not known; did you mean 'iso-14242-[14]'"):
        named_cycle("iso-14242")
    with pytest.raises(ValueError, match="load 'waking' is not known; did you mean 'walking'"):
        in_vivo("waking", 800.0)


# cycles as values


def test_numbers_that_are_not_finite_are_rejected():
    with pytest.raises(ValueError, match="force.* = nan .*is not allowed: the numbers of a cycle are finite"):
        Cycle(name="own", force=lambda t: np.where(t > 0.5, np.nan, 1.0), angles=lambda t: np.zeros((3, len(t))))
    with pytest.raises(ValueError, match="angle.* is not allowed"):
        Cycle(name="own", force=lambda t: 1 + 0 * t, angles=lambda t: np.full((3, len(t)), np.nan))


@pytest.mark.parametrize("count", [7, 10_001, 72.0, True, "8", None])
def test_step_counts_out_of_range_are_rejected(count):
    with pytest.raises(ValueError, match="n_steps = .* is not allowed: a whole number from 8 to 10000"):
        check_step_count(count)
    with pytest.raises(ValueError, match="n_steps = 7 is not allowed"):
        iso_14242_1(7)


def test_step_counts_in_range_are_returned():
    assert [check_step_count(count) for count in (8, 100, 10_000)] == [8, 100, 10_000]


def test_phases_are_midpoints_at_which_forces_are_evaluated():
    cycle = iso_14242_1(10)
    assert cycle.phases == pytest.approx(np.arange(0.05, 1.0, 0.1))
    assert cycle.forces == pytest.approx(np.outer(cycle.force(cycle.phases), UP))
    assert cycle.force_magnitudes == pytest.approx(cycle.force(cycle.phases))
    assert cycle.activity_slices == (("iso-14242-1", slice(0, 10)),)
    assert cycle.describe_step(3) == "35.0 % of the cycle"


def test_upward_forces_below_zero_are_no_contact_and_vectors_pass():
    def pull(phases):
        return 100.0 * np.cos(2 * pi * phases)

    cycle = Cycle(name="pull", force=pull, angles=flexion().angles, n_steps=8)
    assert cycle.forces[:, 2] == pytest.approx(np.maximum(pull(cycle.phases), 0.0))
    vectors = replace(cycle, force=lambda t: np.stack([0 * t, 0 * t, pull(t)]))
    assert vectors.forces[:, 2] == pytest.approx(pull(cycle.phases))
    side = replace(vectors, spring=Spring(stiffness=10.0, mismatch=3.0))
    assert side.forces - vectors.forces == pytest.approx(np.tile([30.0, 0.0, 0.0], (8, 1)))


def test_largest_force_is_located_between_midpoints():
    cycle = Cycle(name="one", force=lambda t: 100 * np.cos(2 * pi * (t - 0.123)), angles=flexion().angles, n_steps=8)
    assert cycle.largest_force == pytest.approx(100.0, rel=1e-6)
    assert cycle.force_magnitudes.max() < 99.9


def test_rotations_are_at_step_ends_and_increments_lead_from_one_to_the_next():
    cycle = iso_14242_1(30, "zyx")
    assert cycle.rotations.shape == (31, 3, 3)
    midpoint = replace(cycle, angles=lambda t: cycle.angles(t + 0.5 / 30)).rotations[:-1]
    assert cycle.midpoint_rotations == pytest.approx(midpoint, abs=1e-12)
    for step, increment in enumerate(cycle.rotation_increments):
        angle = np.linalg.norm(increment)
        axis = increment / angle
        turned = cycle.rotations[step + 1] @ cycle.rotations[step].T
        assert turned @ axis == pytest.approx(axis, abs=1e-12)
        assert acos((np.trace(turned) - 1) / 2) == pytest.approx(angle, rel=1e-6)


def test_finer_cycles_have_twice_the_steps_up_to_the_limit():
    assert iso_14242_1(30).finer().n_steps == 60
    assert replace(flexion(8), n_steps=6000).finer().n_steps == 10_000


def test_a_scaled_cycle_has_scaled_forces_and_the_same_motion():
    cycle = iso_14242_1(20)
    assert cycle.scaled(1.7).forces == pytest.approx(1.7 * cycle.forces)
    assert cycle.scaled(1.7).rotations == pytest.approx(cycle.rotations, abs=0)


def test_mirroring_reflects_forces_rotations_and_spring_and_is_its_own_inverse():
    lean = np.array([[0.1], [0.2], [0.97]])
    walking = iso_14242_1(20)
    cycle = replace(walking, force=lambda t: lean * walking.force(t), spring=Spring(stiffness=10.0, mismatch=2.0))
    mirror = np.diag([-1.0, 1.0, 1.0])
    mirrored = cycle.mirrored()
    assert mirrored.forces == pytest.approx(cycle.forces @ mirror)
    assert mirrored.rotations == pytest.approx(mirror @ cycle.rotations @ mirror, abs=1e-12)
    assert mirrored.spring.mismatch == -2.0
    assert mirrored.mirrored().forces == pytest.approx(cycle.forces, abs=0)
    assert mirrored.mirrored().rotations == pytest.approx(cycle.rotations, abs=0)
    upward = walking.mirrored()
    assert upward.forces == pytest.approx(walking.forces, abs=0)
    in_cup = replace(cycle, frame=Frame.CUP).mirrored()
    assert in_cup.forces == pytest.approx(cycle.forces, abs=0)
    assert in_cup.spring.mismatch == 2.0
    assert in_cup.rotations == pytest.approx(mirrored.rotations, abs=0)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("instants", "n_steps"),
        ("sizes", "force_magnitudes"),
        ("middles", "midpoint_rotations"),
        ("turns", "rotation_increments"),
    ],
)
def test_names_of_version_1_still_work(old, new):
    cycle = iso_14242_1(20)
    with pytest.warns(DeprecationWarning, match=f"^Cycle.{old} is deprecated: use {new}"):
        assert np.array_equal(getattr(cycle, old), getattr(cycle, new))
    with pytest.warns(DeprecationWarning, match=r"^argument 'instants' of iso_14242_1\(\) is deprecated"):
        assert iso_14242_1(instants=20).n_steps == 20
    assert old not in {field.name for field in fields(Cycle)}


# functions of phase


def test_half_cosines_pass_their_knots_level():
    knots, values = np.array([0.0, 0.2, 0.5, 1.0]), np.array([1.0, 4.0, -2.0, 1.0])
    assert half_cosines(knots, knots, values) == pytest.approx(values)
    assert half_cosines(np.array([0.1, 0.35, 0.75]), knots, values) == pytest.approx([2.5, 1.0, -0.5])
    quarter = half_cosines(np.array([0.05, 0.15]), knots, values)
    assert quarter == pytest.approx([2.5 - 1.5 * cos(pi / 4), 2.5 + 1.5 * cos(pi / 4)])
    step = 1e-6
    slopes = (half_cosines(knots[1:3] + step, knots, values) - half_cosines(knots[1:3] - step, knots, values)) / step
    assert slopes == pytest.approx(0.0, abs=1e-3)


def test_periodic_interpolation_passes_its_rows_and_closes():
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
    assert (fine.min(), fine.max()) == pytest.approx((0.0, 5.0), abs=1e-9)  # no overshoot


def test_periodic_interpolation_distributes_the_difference_of_the_ends():
    phase = np.linspace(0.0, 1.0, 11)
    function = monotone_periodic(phase, 3.0 * phase)
    assert function(phase) == pytest.approx(1.5, abs=1e-12)


def test_angles_of_the_iso_cycle_can_be_replaced():
    key_points = iso_14242_1_key_points(16)
    assert iso_14242_1(16, angles=key_points.angles).rotation_increments == pytest.approx(
        key_points.rotation_increments
    )
    with pytest.warns(DeprecationWarning, match="^argument 'key_points' of iso_14242_1"):
        iso_14242_1(16, key_points=key_points.angles)
