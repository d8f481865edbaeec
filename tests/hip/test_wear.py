"""Wear on springs: another program's runs, identities, orders, and what is refused."""

from dataclasses import replace
from math import inf, radians

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

import ballsocket as bs
from ballsocket.hip import Archard, ContactAreaWear, Cycle, flexion, iso_14242_1
from ballsocket.hip.ball_wear import ball_directions, map_counterface
from ballsocket.reports.hip_report import hip_report

from ..extent import some
from .hips import INDEPENDENT, QUICK, TILTED, K, hip, history, report_after, socket_force, walked


@pytest.mark.parametrize("run", INDEPENDENT["runs"], ids=lambda run: str(run["head_diameter"]))
def test_first_cycle_equals_an_independent_program(run):
    first = hip(run["head_diameter"], run["liner"]).first
    assert first.slide == pytest.approx(run["slide_mm_per_cycle"], rel=3e-3)
    assert first.work == pytest.approx(run["pressure_slide_integral_Nm"], rel=3e-3)
    assert first.volume == pytest.approx(run["unworn_mm3_per_Mc"], rel=5e-3)
    assert first.depth == pytest.approx(run["unworn_depth_mm_per_Mc"], rel=5e-3)
    if "cross_shear_mean" in run:
        assert first.cross_shear == pytest.approx(run["cross_shear_mean"], abs=5e-4)


@pytest.mark.parametrize("run", some(INDEPENDENT["runs"], 2), ids=lambda run: str(run["head_diameter"]))
def test_millions_of_cycles_equal_an_independent_program(run):
    at = [count for count in (1, 2, 5) if f"at_{count}_Mc" in run]
    for count in at:
        report, expected = report_after(hip(run["head_diameter"], run["liner"]), 1e6 * count), run[f"at_{count}_Mc"]
        assert report.volume == pytest.approx(expected["volume"], rel=1e-2)
        assert report.depth == pytest.approx(expected["depth"], rel=2e-2)
        assert report.max_pressure == pytest.approx(expected["p0"], rel=2e-2)


COARSE = {"cycle": iso_14242_1(50), "ring_width": radians(5.0)}
HIPS = [{"liner": inf}, {"diameter": 36.0}, {"clearance": 0.3}, {"cycle": flexion(16)}]
HIPS.append(COARSE | {"surface": bs.ClosedShell()})
HIPS.append(pytest.param(COARSE | {"surface": bs.RealCup()}, marks=pytest.mark.long))


@pytest.mark.parametrize("words", HIPS)
def test_worn_volume_equals_the_work_of_friction_and_a_worn_bore_balances_its_loads(words):
    use = hip(**QUICK | words)
    report = report_after(use, 2e5 if "surface" in words else 1e6)
    assert report.converged
    areas = np.broadcast_to(use.grid.areas, report.wear.shape) * use.joint.socket_radius**2
    assert (report.wear * areas).sum() == pytest.approx(1e-3 * K * report.work, rel=1e-6)
    assert report.volume == pytest.approx((report.wear * areas).sum(), rel=1e-12)
    worn = use.solve_equilibrium(report.wear.ravel())
    errors = socket_force(use.foundation, worn) - use.frame.loads
    assert (np.linalg.norm(errors, axis=1) <= 1e-6 * np.linalg.norm(use.frame.loads, axis=1)).all()
    assert worn.pressure.max() == pytest.approx(report.max_pressure, rel=1e-5)


def test_worn_bore_has_the_contact_of_the_off_axis_model():
    """On rings of other widths, with the depth between the cells by interpolation."""
    use = hip()
    report, grid = report_after(use, 1e6), use.grid
    around = np.concatenate([grid.azimuth[-1:] - 2 * np.pi, grid.azimuth, grid.azimuth[:1] + 2 * np.pi])
    rows = np.hstack([report.wear[:, -1:], report.wear, report.wear[:, :1]])
    between = RegularGridInterpolator((grid.polar, around), rows, bounds_error=False, fill_value=None)

    def depth(n):
        return between((np.arctan2(np.hypot(n[0], n[1]), n[2]), np.arctan2(n[1], n[0]) % (2 * np.pi)))

    sphere = bs.Sphere(cup=TILTED, surface=bs.Springs(), worn=bs.BoreDeviation(of=depth))
    largest = int(use.cycle.force_magnitudes.argmax())
    contact = sphere.press(use.joint, force=use.cycle.force_magnitudes[largest])
    mine = use.solve_equilibrium(report.wear.ravel())
    assert contact.displacement == pytest.approx(mine.displacement[largest], rel=2e-3, abs=2e-4)
    assert contact.max_pressure == pytest.approx(mine.pressure[largest].max(), rel=1e-2)


def test_left_hip_wears_as_a_right_hip():
    cup, walk = bs.Cup(inclination=radians(30.0), anteversion=radians(20.0)), iso_14242_1(72)
    leaning = replace(walk, force=lambda t: np.stack([200 + 0 * t, 100 * t, walk.force(t)]))
    right, left = (hip(cycle=leaning, cup=replace(cup, side=side)) for side in bs.Side)
    assert (left.first.volume, left.frame.slide) == pytest.approx((right.first.volume, right.frame.slide), rel=1e-9)
    assert left.unworn.displacement == pytest.approx(right.unworn.displacement * [1, -1, 1], rel=1e-6, abs=1e-9)


def test_area_wear_is_proportional_to_contact_shares():
    use = hip(wear=ContactAreaWear(coefficient=1e-9))
    done = use.exposure(use.unworn)
    expected = 1e6 * 1e-9 * float((done.contact * done.sliding.distances).sum(axis=0) @ use.foundation.areas)
    assert use.first.volume == pytest.approx(expected, rel=1e-12)
    partly = (done.contact > 0) & (done.contact < 1)
    assert 0 < partly.mean() < 0.1
    assert (done.contact[done.pressure > 0] > 0).all()


def turning(axis, amplitude, force, count):
    angles = lambda t: amplitude * np.outer(axis, np.cos(2 * np.pi * t))  # noqa: E731
    return Cycle(name="turning", force=lambda t: force + 0 * t, angles=angles, n_steps=count)


def cap_slide(half_angle, axis):
    """Mean slide times area over a cap about z on a unit sphere, for one radian of rotation about an axis."""
    polar, around = np.meshgrid((np.arange(400) + 0.5) / 400 * half_angle, (np.arange(180) + 0.5) / 180 * 2 * np.pi)
    points = np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)])
    arm = np.linalg.norm(np.cross(axis, points, axis=0), axis=0)
    return (arm * np.sin(polar)).sum() * half_angle / 400 * 2 * np.pi / 180


@pytest.mark.parametrize(
    ("width", "force", "limit"), some([(4.0, 1000.0, 4e-3), (3.0, 2000.0, 3e-3), (1.5, 2000.0, 3e-3)], 1)
)
@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0)], ids=["spin", "flexion"])
def test_area_wear_of_a_stationary_contact_is_within_the_stated_error(axis, width, force, limit):
    """A constant load along the cup's axis: the edge of the contact passes no cell, and cuts many of them.

    Under 1000 N halved rings of 4° divide the error by 3, and 4/3 of the difference is less than the error.
    """
    cycle = turning(axis, radians(20.0), force, 16)
    use = hip(cycle=cycle, wear=ContactAreaWear(coefficient=1e-9), cup=bs.Cup(), ring_width=radians(width))
    joint, cap = use.joint, bs.HessForsbach().press(use.joint, force=force).half_angle
    slides = joint.ball_radius * joint.socket_radius**2 * cap_slide(cap, np.array(axis)[:, None, None])
    expected = 1e6 * 1e-9 * 4 * radians(20.0) * slides
    assert abs(use.first.volume / expected - 1) < min(use.discretization_error[0], limit)


def test_block_error_bounds_the_difference_to_finer_blocks():
    rough = {"ring_width": radians(4.0), "cycle": iso_14242_1(36)}
    coarse, fine, finest = (hip(tolerance=each, **rough).after(3e5) for each in (1e-2, 1e-3, 1e-5))
    off = [abs(run.last.volume / finest.last.volume - 1) for run in (coarse, fine)]
    assert off[0] < 1e-3
    assert off[1] < off[0] / 2
    assert off[0] < 2 * coarse.error.blocks
    assert finest.steps > 2 * fine.steps > 2 * coarse.steps


@pytest.mark.parametrize(
    ("refined", "limit"),
    [
        ([{"cycle": iso_14242_1(count)} for count in (25, 50, 100, 400)], 3e-3),
        ([{"cycle": iso_14242_1(30), "ring_width": radians(width)} for width in (8.0, 4.0, 2.0, 1.0)], 1e-3),
    ],
)
def test_the_first_cycle_converges_with_second_order(refined, limit):
    *volumes, finest = (hip(**words).first.volume for words in refined)
    first, second, third = (abs(volume / finest - 1) for volume in volumes)
    assert first < limit
    assert min(first / second, second / third) > 3


@pytest.mark.long
def test_finest_steps_have_an_error_estimate():
    """They cannot be halved, and rings of 0.5° neither."""
    assert 0 < hip(cycle=flexion(8), ring_width=radians(0.9)).discretization_error[0] < 0.05


def test_reports_increase_with_wear_and_their_number_does_not_change_the_results():
    often = hip(**QUICK).after(5e6, [3e6, 1e5, 1e6, 1e5])
    assert often.last.volume == pytest.approx(report_after(hip(**QUICK), 5e6).volume, rel=5e-4)
    assert [report.cycles for report in often.reports] == [1e5, 1e6, 3e6, 5e6]
    assert hip(**QUICK).after([5e6, 3e6, 1e5], [1e6]).last.volume == often.last.volume
    for name in ("volume", "penetration"):
        values = [getattr(report, name) for report in often.reports]
        assert values == sorted(values)
    assert 0 < often.last.penetration < often.last.depth
    assert not (often.last.wear.flags.writeable)
    assert not (often.last.edge_distance.flags.writeable)
    assert often.last.displacement[1] == pytest.approx(0.0, abs=0.1 * often.last.penetration)  # across the load's plane


def test_unloaded_instants_do_not_wear_and_limits_of_a_run_are_noted():
    half = hip(cycle=walked(2000.0, -100.0))
    whole = hip(cycle=walked(2000.0, 1e-9))
    assert half.first.volume == pytest.approx(whole.first.volume, rel=1e-9)
    assert len(half.frame.loaded) == 50
    told = "the ball lifts off, first at 50.5 % of the cycle: 50 of 100 instants have no contact"
    assert any(note.startswith(told) for note in half.notes)
    assert report_after(half, 1e6).volume > 0
    thin = hip(liner=2.0, wear=Archard(coefficient=1e-5), **QUICK)
    assert any(note.startswith("worn through: after 5000000 cycles") for note in thin.after(5e6, [1e5]).notes)
    assert any("its stiffness is still that of the unworn liner" in note for note in thin.after(1e6).notes)
    assert not any("worn" in note for note in history(hip(**QUICK), 1e4).notes)
    untilted = hip(cup=bs.Cup(), **QUICK)
    assert untilted.frame.placed == TILTED
    assert any("tilted by 30° from the load" in note for note in untilted.notes)


# a ball that wears too

BOTH = {"wear": Archard(coefficient=K / 2), "ball_wear": Archard(coefficient=K / 2)}


def test_ball_volume_equals_the_work_of_friction_which_is_that_of_the_socket_in_each_instant():
    report = report_after(hip(**QUICK, wear=Archard(coefficient=K), ball_wear=Archard(coefficient=3e-7)), 5e5)
    assert report.volume == pytest.approx(1e-3 * K * report.work, rel=1e-6)
    assert report.ball_volume == pytest.approx(1e-3 * 3e-7 * report.work, rel=1e-6)
    use = hip(cycle=iso_14242_1(40), ring_width=radians(4.0), **BOTH)
    ball = map_counterface(use, np.arange(len(use.foundation.areas)))
    work = (use.unworn.pressure * use.sliding.distances) @ use.foundation.areas
    exposure = ball.ball_exposure(use.exposure(use.unworn))
    assert (exposure.pressure * exposure.sliding.distances) @ ball.areas == pytest.approx(work, rel=1e-9)
    smaller = (use.joint.socket_radius / use.joint.ball_radius) ** 2  # is the ball, under the same force
    assert exposure.pressure.max() == pytest.approx(smaller * use.unworn.pressure.max(), rel=2e-3)


def test_ball_spinning_about_its_load_wears_as_the_socket():
    """And both together leave the contact as twice the wear of the socket alone does."""
    spin = {"cycle": turning((0.0, 0.0, 1.0), radians(30.0), 2000.0, 24), "cup": bs.Cup(), "ring_width": radians(4.0)}
    pair, alone = (report_after(hip(**spin, **words), 2e6) for words in (BOTH, {}))
    assert pair.volume == pytest.approx(pair.ball_volume, rel=1e-9)
    assert pair.ball_depth == pytest.approx(pair.depth, rel=0.02)
    assert pair.volume + pair.ball_volume == pytest.approx(alone.volume, rel=2e-3)
    assert pair.penetration == pytest.approx(alone.penetration, rel=1e-2)
    assert pair.max_pressure == pytest.approx(alone.max_pressure, rel=5e-2)  # a spike where nothing slides


def test_flexion_spreads_the_wear_of_the_ball_over_its_track():
    """The load stands still on the socket, and goes to and fro on the ball."""
    use = hip(cycle=flexion(40), ring_width=radians(4.0), **BOTH)
    report = report_after(use, 1e6)
    assert report.ball_volume == pytest.approx(report.volume, rel=1e-9)
    assert report.ball_depth < 0.95 * report.depth
    on_ball = (report.ball_wear * use.ball_areas) @ ball_directions(use.ball_grid)[1] ** 2 / report.ball_volume
    on_socket = (report.wear.ravel() * use.foundation.areas) @ use.foundation.directions[1] ** 2 / report.volume
    assert np.sqrt(on_ball) > 1.08 * np.sqrt(on_socket)


@pytest.mark.long
def test_report_page_has_a_map_of_the_ball_wear():
    page = hip_report(hip(**QUICK, **BOTH).after(1e4))
    assert "Wear of the ball" in page
    assert page.count("data:image/png;base64") == 6


def test_contact_shares_add_up_to_the_contact_area():
    """The solid angle of a round contact beside the pole, within 0.4 %."""
    load = 2000.0 * np.array([np.sin(0.3), 0.0, np.cos(0.3)])
    cycle = replace(flexion(8), force=lambda t: np.outer(load, 1 + 0 * t), cup_tilt=None)
    use = hip(cycle=cycle, cup=bs.Cup(), surface=bs.ClosedShell())
    cap = 2 * np.pi * (1 - np.cos(bs.Exact().press(use.joint, force=2000.0).half_angle))
    share = use.exposure(use.unworn).contact[0] @ use.foundation.areas / use.joint.socket_radius**2
    assert share == pytest.approx(cap, rel=4e-3)
