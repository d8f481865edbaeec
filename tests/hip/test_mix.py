"""Mixes of activities, and loads in other frames."""

from dataclasses import replace
from math import cos, radians, sin

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Activity, Cycle, Frame, Lubricant, Mix, flexion, in_vivo, iso_14242_1, logarithmic

from .hips import QUICK, K, hip, report_after

WALK, STAIRS = in_vivo("walking", 750.0, 40), in_vivo("stairs-up", 750.0, 40)
STAND = in_vivo("stand-up", 750.0, 24)


def mixed(*parts):
    return Mix(activities=tuple(Activity(cycle=cycle, per_year=count) for cycle, count in parts))


@pytest.mark.long
def test_a_mix_of_one_activity_equals_that_activity(short_film):
    coarse = {"ring_width": QUICK["ring_width"]}
    alone, mix = hip(cycle=WALK, **coarse), hip(cycle=mixed((WALK, 1e6)), **coarse)
    assert mix.first == alone.first
    assert report_after(mix, 5e5).volume == pytest.approx(report_after(alone, 5e5).volume, rel=1e-12)
    assert mix.film(Lubricant()).heat == pytest.approx(alone.film(Lubricant()).heat, rel=1e-12)


def test_wear_of_a_mix_is_the_weighted_mean_of_its_activities():
    stand = in_vivo("stand-up", 750.0, 40)
    use = hip(cycle=mixed((WALK, 9e5), (stand, 1e5)))
    mean = 0.9 * hip(cycle=WALK).first.volume + 0.1 * hip(cycle=stand).first.volume
    assert use.first.volume == pytest.approx(mean, rel=1e-9)
    report = report_after(use, 1e6)
    assert report.volume == pytest.approx(1e-3 * K * report.work, rel=1e-6)
    assert use.slide == pytest.approx(0.9 * hip(cycle=WALK).slide + 0.1 * hip(cycle=stand).slide, rel=1e-9)


def test_steps_of_a_mix_are_those_of_its_activities_one_after_the_other():
    mix = mixed((WALK, 9e5), (STAND, 1e5))
    assert (mix.n_steps, mix.name, mix.per_year) == (64, "walking + stand-up", 1e6)
    assert mix.fractions == pytest.approx((0.9, 0.1))
    assert mix.phases == pytest.approx((np.arange(64) + 0.5) / 64)
    assert mix.forces == pytest.approx(np.vstack([WALK.forces, STAND.forces]), abs=0)
    assert mix.force_magnitudes == pytest.approx(np.append(WALK.force_magnitudes, STAND.force_magnitudes), abs=0)
    assert mix.midpoint_rotations[:40] == pytest.approx(WALK.midpoint_rotations, abs=0)
    assert mix.midpoint_rotations[40:] == pytest.approx(STAND.midpoint_rotations, abs=0)
    assert mix.rotation_increments[:40] == pytest.approx(0.9 * WALK.rotation_increments)
    assert mix.rotation_increments[40:] == pytest.approx(0.1 * STAND.rotation_increments)
    assert mix.seconds[[0, -1]] == pytest.approx([0.9 / 40, 0.1 * 6 / 24])
    assert mix.duration == pytest.approx(0.9 * 1.0 + 0.1 * 6.0)
    assert mix.activity_slices == (("walking", slice(0, 40)), ("stand-up", slice(40, 64)))
    assert mix.largest_force == WALK.largest_force
    assert mixed((STAND, 1.0), (WALK, 1.0)).largest_force == WALK.largest_force
    assert mix.rotations is WALK.rotations
    assert mixed((WALK, 1.0), (STAND, 2.0)).rotations is STAND.rotations
    assert (mix.frame, mix.spring) == (Frame.BODY, None)


def test_steps_of_a_mix_are_described_by_their_activity():
    mix = mixed((WALK, 9e5), (STAND, 1e5))
    assert mix.describe_step(0) == "1.2 % of walking"
    assert mix.describe_step(39) == "98.8 % of walking"
    assert mix.describe_step(40) == "2.1 % of stand-up"
    assert mix.describe_step(63) == "97.9 % of stand-up"
    with pytest.raises(IndexError):
        mix.describe_step(64)


def test_transformed_mixes_are_mixes_of_transformed_cycles():
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
    assert hip(cycle=different, cup=bs.Cup()).placed == bs.Cup()
    assert hip(cycle=same, cup=bs.Cup()).placed.inclination == radians(30.0)


def test_creep_of_a_mix_follows_the_mean_force_over_time():
    """Half of the cycles last twice as long at twice the load: the mean is 5/3 of the smaller load."""
    light = Cycle(name="one", force=lambda t: 500.0 + 0 * t, angles=flexion().angles, n_steps=20)
    heavy = replace(light, name="two", force=lambda t: 1000.0 + 0 * t, duration=2.0)
    use = hip(cycle=mixed((light, 1.0), (heavy, 1.0)), creep=logarithmic())
    weights = use.cycle.seconds / use.cycle.duration
    assert weights @ use.cycle.force_magnitudes == pytest.approx(500.0 * 5 / 3)
    assert report_after(use, 1e3).creep_depth > report_after(hip(cycle=light, creep=logarithmic()), 1e3).creep_depth


@pytest.mark.long
def test_the_step_closest_to_the_rim_names_its_activity(short_film):
    stumble = in_vivo("stumbling", 750.0, 40)
    history = hip(cycle=mixed((WALK, 1e6), (stumble, 10.0)), cup=bs.Cup(inclination=radians(40.0))).after(1e4)
    assert history.worst.step_description.endswith("% of stumbling")
    assert history.summary()["history"][-1]["edge"]["at"].endswith("% of stumbling")
    assert any("the contact reaches the rim in" in note and "of stumbling" in note for note in history.notes)


def test_loads_in_the_frame_of_the_cup():
    """A load straight up in the body's frame leans by the cup's tilt in the cup's frame."""
    lean = np.array([[sin(radians(30.0))], [0.0], [cos(radians(30.0))]])
    walk = iso_14242_1(72)
    in_cup = replace(walk, force=lambda t: lean * walk.force(t), frame=Frame.CUP)
    assert hip(cycle=in_cup).first.volume == pytest.approx(hip(cycle=walk).first.volume, rel=1e-12)
    left = bs.Cup(inclination=radians(30.0), side=bs.Side.LEFT)
    assert hip(cycle=in_cup, cup=left).first.volume == pytest.approx(hip(cycle=walk).first.volume, rel=1e-9)
