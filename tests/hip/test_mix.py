"""A mix of activities, a ball on the rim, and loads in other frames."""

from dataclasses import replace
from math import cos, radians, sin

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.off_axis.surfaces import ClosedShell
from ballsocket.hip import (
    Activity,
    Cycle,
    Frame,
    Lubricant,
    Mix,
    flexion,
    in_vivo,
    iso_14242_1,
    iso_14242_4,
    logarithmic,
)

from .test_wear import K, hip

WALK, STAIRS = in_vivo("walking", 750.0, 40), in_vivo("stairs-up", 750.0, 40)


def mixed(*parts):
    return Mix(activities=tuple(Activity(cycle=cycle, per_year=count) for cycle, count in parts))


def test_a_mix_of_one_is_that_one():
    alone, mix = hip(cycle=WALK), hip(cycle=mixed((WALK, 1e6)))
    assert mix.first == alone.first
    assert mix.after(5e5).last.volume == pytest.approx(alone.after(5e5).last.volume, rel=1e-12)
    assert mix.film(Lubricant()).heat == pytest.approx(alone.film(Lubricant()).heat, rel=1e-12)


def test_a_mix_wears_as_its_parts_do_by_their_counts():
    stand = in_vivo("stand-up", 750.0, 40)
    parts = ((WALK, 9e5), (stand, 1e5))
    use = hip(cycle=mixed(*parts))
    shares = 0.9 * hip(cycle=WALK).first.volume + 0.1 * hip(cycle=stand).first.volume
    assert use.first.volume == pytest.approx(shares, rel=1e-9)
    assert use.cycle.per_year == 1e6
    assert use.cycle.duration == pytest.approx(0.9 * 1.0 + 0.1 * 6.0)
    report = use.after(1e6).last
    assert report.volume == pytest.approx(1e-3 * K * report.work, rel=1e-6)
    assert use.slide == pytest.approx(0.9 * hip(cycle=WALK).slide + 0.1 * hip(cycle=stand).slide, rel=1e-9)


def test_a_mix_creeps_under_the_mean_of_time():
    """Half of the cycles are twice as long at twice the load: 5/3 of it in the mean."""
    one = Cycle(name="one", force=lambda t: 500.0 + 0 * t, angles=flexion().angles, n_steps=20)
    two = replace(one, name="two", force=lambda t: 1000.0 + 0 * t, duration=2.0)
    use = hip(cycle=mixed((one, 1.0), (two, 1.0)), creep=logarithmic())
    shares = use.cycle.seconds / use.cycle.duration
    assert shares @ use.cycle.force_magnitudes == pytest.approx(500.0 * 5 / 3)
    assert use.after(1e3).last.creep_depth > hip(cycle=one, creep=logarithmic()).after(1e3).last.creep_depth


def test_the_worst_instant_of_a_mix_has_its_activity():
    stumble = in_vivo("stumbling", 750.0, 40)
    history = hip(cycle=mixed((WALK, 1e6), (stumble, 10.0)), cup=bs.Cup(inclination=radians(40.0))).after(1e4)
    assert history.worst.step_description.endswith("% of stumbling")
    assert history.summary()["history"][-1]["edge"]["at"].endswith("% of stumbling")
    assert any("the contact reaches the rim in" in note and "of stumbling" in note for note in history.notes)
    with pytest.raises(ValueError, match=r"dislocated at 1\.2 % of stairs-up"):
        hip(cycle=mixed((STAIRS, 1.0)), cup=bs.Cup(arc_of_cover=radians(60.0), inclination=radians(45.0)))


def test_a_tilt_that_one_standard_has_is_not_that_of_all():
    use = hip(cycle=mixed((WALK, 1.0), (iso_14242_1(40), 1.0)), cup=bs.Cup())
    assert use.placed == bs.Cup()
    assert any("no tilt of a standard in common" in note for note in use.notes)
    assert hip(cycle=mixed((flexion(40), 1.0), (iso_14242_1(40), 1.0)), cup=bs.Cup()).placed.inclination == radians(
        30.0
    )


def test_what_cannot_be_mixed_is_refused():
    with pytest.raises(ValueError, match="a mix has at least one activity"):
        Mix(activities=())
    with pytest.raises(ValueError, match="iso-14242-4 is in the frame of a cup, or has a spring"):
        mixed((iso_14242_4(40), 1.0))
    with pytest.raises(ValueError, match="per_year = 0 is not allowed"):
        Activity(cycle=WALK, per_year=0.0)


def test_loads_in_the_cups_own_frame():
    """What the body's frame makes of a load straight up is in the cup's frame a load that leans by its tilt."""
    lean = np.array([[sin(radians(30.0))], [0.0], [cos(radians(30.0))]])
    walk = iso_14242_1(72)
    given = replace(walk, force=lambda t: lean * walk.force(t), frame=Frame.CUP)
    assert hip(cycle=given).first.volume == pytest.approx(hip(cycle=walk).first.volume, rel=1e-12)
    left = bs.Cup(inclination=radians(30.0), side=bs.Side.LEFT)
    assert hip(cycle=given, cup=left).first.volume == pytest.approx(hip(cycle=walk).first.volume, rel=1e-9)


# a ball on the rim


def test_a_socket_set_off_lets_its_ball_onto_the_rim_in_the_swing_phase():
    use = hip(cycle=iso_14242_4(100), cup=bs.Cup(inclination=radians(45.0)))
    apart = use.separation
    assert (use.cycle.phases[apart.steps] > 0.6).sum() > 30
    assert apart.largest < 8.0
    assert np.degrees(apart.azimuth) == pytest.approx(0.0, abs=1e-9)
    note = next(note for note in use.notes if note.startswith("microseparation from"))
    assert "what it wears there is not counted" in note
    assert len(use.loaded) + len(apart.steps) == 100
    told = use.after(1e4).summary()["cycle"]["microseparation"]
    assert told["largest_mm"] == apart.largest
    assert (told["from"], told["to"]) == ("59.5 % of the cycle", "2.5 % of the cycle")  # of the next


def test_on_the_rim_the_loads_meet_the_edge():
    """The ball touches the edge, and its spring, shorter by what it has followed, and the load point to it."""
    use = hip(cycle=iso_14242_4(100, mismatch=3.0), cup=bs.Cup(inclination=radians(50.0), anteversion=radians(10.0)))
    apart, radius = use.separation, use.joint.socket_radius
    edge = radius * np.column_stack([np.cos(apart.azimuth), np.sin(apart.azimuth), 0 * apart.azimuth])
    along = edge - apart.displacement
    assert np.linalg.norm(along, axis=1) == pytest.approx(use.joint.ball_radius, rel=1e-9)
    side = np.array(use.placed.frame)[:, 0]
    followed = apart.displacement @ side
    loads = use.forces[apart.steps] - 100.0 * followed[:, None] * side
    assert np.cross(along, loads) == pytest.approx(0.0, abs=1e-4)
    assert ((followed > 0) & (followed < 3.0)).all()


def test_whichever_way_the_cup_faces_a_ball_is_in_its_bore_or_on_the_rim():
    """Between the two nothing jumps: near the rim the ball follows its spring, which pulls the less."""
    use = hip(36.0, 6.0, cycle=iso_14242_4(100), ring_width=radians(6.0))
    seen = [replace(use, cup=bs.Cup().tilted(radians(tilt))) for tilt in np.arange(40.0, 46.0, 0.2)]
    for one in seen:
        assert len(one.loaded) + len(one.separation.steps) == 100
        assert one.unworn.settled
        assert np.linalg.norm(one.unworn.displacement, axis=1).max() < 0.6  # it had been metres
    volumes = np.array([one.first.volume for one in seen])
    assert abs(np.diff(volumes) / volumes[:-1]).max() < 0.01


@pytest.mark.parametrize("surface", [bs.Springs(), ClosedShell()])
def test_a_bore_carries_what_the_spring_leaves(surface):
    """The load less the spring's stiffness by the way that the ball has followed it."""
    cup = bs.Cup(inclination=radians(40.0), anteversion=radians(8.0))
    use = hip(36.0, 6.0, cycle=iso_14242_4(50), cup=cup, ring_width=radians(6.0), surface=surface)
    rest, side = use.unworn, np.array(use.placed.frame)[:, 0]
    carried = np.einsum("tp,kp,p->tk", rest.pressure, use.bed.normals, use.bed.areas)
    expected = use.loads - 100.0 * (rest.displacement @ side)[:, None] * side
    assert np.linalg.norm(expected - use.loads, axis=1).max() > 5.0
    assert carried == pytest.approx(expected, rel=2e-6, abs=2e-6 * np.linalg.norm(use.loads, axis=1).max())


def test_a_left_ball_is_pulled_to_the_left():
    right, left = (
        hip(cycle=iso_14242_4(50), cup=bs.Cup(inclination=radians(45.0), anteversion=radians(10.0), side=side))
        for side in bs.Side
    )
    assert left.separation.displacement == pytest.approx(right.separation.displacement * [1, -1, 1], abs=1e-9)
    assert left.first.volume == pytest.approx(right.first.volume, rel=1e-9)


def test_without_a_swing_load_nothing_holds_the_ball():
    steep = bs.Cup(inclination=radians(80.0), arc_of_cover=radians(150.0))
    with pytest.raises(ValueError, match=r"dislocated at .* % of the cycle"):
        hip(cycle=iso_14242_4(50, mismatch=8.0), cup=steep)


def test_a_ball_set_off_presses_nearer_to_the_rim():
    """By the angle that the spring's 400 N turn the load."""
    set_off, usual = (hip(cycle=make(50)) for make in (iso_14242_4, iso_14242_1))
    near, far = (use.edge_distance(use.unworn)[use.largest[0]] for use in (set_off, usual))
    turned = np.arctan2(400.0, usual.cycle.force_magnitudes.max())
    assert near == pytest.approx(far - usual.joint.socket_radius * turned, abs=0.1)
