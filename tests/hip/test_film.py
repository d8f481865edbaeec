"""Film, friction and the distance to the rim over a cycle, and wear below a limit of the film ratio."""

import json
import re
from dataclasses import replace
from math import inf, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Cycle, FilmLimit, Lubricant, Stribeck, flexion, iso_14242_1, read_hip
from ballsocket.hip.film import film_thickness
from ballsocket.hip.wear_laws import ContactAreaWear, CrossShear

from ..cli.command import run
from ..extent import some
from .hips import QUICK, SHORT, TEXT, K, hip, history, report_after, write_edited_file


def test_formula_film_of_a_hip_is_that_of_hamrock_and_dowson():
    joint, force, speed, viscosity = hip().joint, np.array([2500.0]), np.array([1.5]), 2.5e-3
    least, central = film_thickness(joint, force, speed, viscosity)
    radius, modulus = 14.0 * 14.1 / 0.1, 2 * 1000.0 / (1 - 0.16)
    u, w = 1e-6 * viscosity * speed * 14.0 / 2 / (modulus * radius), force / (modulus * radius**2)
    assert least == pytest.approx(2.80 * radius * u**0.65 * w**-0.21, rel=1e-12)
    assert central == pytest.approx(3.34 * radius * u**0.64 * w**-0.22, rel=1e-12)
    assert (1e6 * least, 1e6 * central) == (pytest.approx(72, abs=0.5), pytest.approx(139, abs=0.5))  # as published
    soft_ball = replace(joint, ball=joint.liner)
    assert film_thickness(soft_ball, force, speed, viscosity)[0] > least
    assert np.isnan(film_thickness(replace(joint, clearance=0.0), force, speed, viscosity)).all()


def test_film_of_a_cycle_has_consistent_ratio_moment_power_and_heat():
    use = hip(**QUICK)
    film = use.film(Lubricant(ball_roughness=3e-5, cup_roughness=4e-5, friction=0.1), method="hamrock-dowson")
    assert film.ratio == pytest.approx(film.least / 5e-5, rel=1e-12)
    assert 1e-3 * np.einsum("tk,tk->", film.moment, use.frame.rotation_increments) == pytest.approx(
        film.heat, rel=1e-12
    )
    assert film.heat == pytest.approx(0.1 * use.first.work, rel=1e-9)
    assert film.heat == pytest.approx((film.power * use.cycle.seconds).sum(), rel=1e-12)
    moment = np.linalg.norm(film.moment, axis=1)  # less than μ R ∫ p dA, and about μ R F
    assert (moment < 0.1 * 14.0 * (use.unworn.pressure @ use.foundation.areas)).all()
    assert (moment > 0.5 * 0.1 * 14.0 * use.cycle.force_magnitudes).all()
    double = use.film(Lubricant(friction=0.2), method="hamrock-dowson")
    assert double.moment == pytest.approx(2 * film.moment, rel=1e-12)
    for ratio, regime in {0.99: "boundary", 1.0: "mixed", 2.99: "mixed", 3.0: "full"}.items():
        assert replace(film, ratio=np.array([0.1, ratio])).regime == regime


def test_json_has_the_largest_moment_vector():
    """Flexion turns about the side: so does its moment, in the cup's frame across the tilt."""
    use = hip(cycle=flexion(32), ring_width=radians(5.0))
    summary = use.film(Lubricant(), cycles=1).summary()
    vector = np.array(summary["moment_on_cup_Nmm"])
    assert np.linalg.norm(vector) == pytest.approx(summary["moment_Nmm"], rel=1e-12)
    aside = np.array(use.frame.placed.frame) @ [1.0, 0.0, 0.0]
    assert abs(vector @ aside) == pytest.approx(summary["moment_Nmm"], rel=0.02)


def test_film_is_carried_over_the_cycle_and_compared_with_the_formula():
    use = hip(**QUICK)
    wave, formula = use.film(cycles=8), use.film(method="hamrock-dowson")
    assert wave.method == "wave"
    assert wave.thickness.shape == wave.core.shape == use.unworn.pressure.shape
    assert np.isnan(wave.thickness[use.unworn.pressure == 0]).mean() > 0.9
    assert wave.comparison == pytest.approx(formula.least, rel=1e-12)
    assert formula.note.startswith("Hamrock and Dowson")
    assert formula.thickness is None
    assert use.film(Lubricant(ball_roughness=1e-6, cup_roughness=1e-6), cycles=8).regime == "full"
    assert wave.regime == "boundary"


def test_walking_refreshes_a_part_of_the_contact_and_its_core_settles():
    """The film turns by 1.6° in a cycle while the ball returns, which refills the core but where it turns about."""
    film = hip().film()
    assert film.valid
    assert film.summary()["drift_deg_per_cycle"] == pytest.approx(1.61, abs=0.03)
    assert film.refreshed_share.min() == pytest.approx(0.39, abs=0.015)
    assert 1e6 * film.least.min() == pytest.approx(12.4, rel=0.02)
    assert not film.smallest_settled
    assert film.summary()["smallest_settled"] is False
    assert "drifts by 1.6° in a cycle and is settled, but its smallest film still falls" in film.note


@pytest.mark.long
def test_films_on_cells_of_two_widths_agree_within_their_stated_errors():
    film, finest = (hip(ring_width=radians(width)).film() for width in (4.0, 2.0))
    errors = film.error + finest.error
    for name in ("central", "least"):
        assert (np.abs(getattr(film, name) / getattr(finest, name) - 1) < errors).all()
    error = film.refreshed_mean_error + finest.refreshed_mean_error
    assert film.refreshed_mean.mean() == pytest.approx(finest.refreshed_mean.mean(), rel=error)
    # cells add but a small part to the error of the wave: their own error is tested here
    assert film.central.mean() == pytest.approx(finest.central.mean(), rel=0.02)
    assert film.core_mean.mean() == pytest.approx(finest.core_mean.mean(), rel=0.03)


def test_uniform_wear_has_the_film_of_a_larger_clearance():
    worn = hip(clearance=0.1, **QUICK)
    depth = np.full(worn.foundation.areas.shape, 0.03)
    film, wider = worn.film(depth=depth, cycles=3), hip(clearance=0.13, **QUICK).film(cycles=3)
    assert film.central == pytest.approx(wider.central, rel=0.01)
    assert film.error == pytest.approx(wider.error, rel=0.05)


def test_friction_falls_from_boundary_to_full_film_and_lies_below_that_of_touching_surfaces():
    law = Stribeck(boundary=0.1)
    share = law.asperity_share(np.array([0.0, 0.5, 1.0, 2.0, 3.0, 20.0]))
    assert share[0] == pytest.approx(1.0, rel=1e-12)
    assert (np.diff(share) < 0).all()
    heights = np.linspace(1.0, 12.0, 20001)
    tail = np.exp(-(heights**2) / 2)
    one, two = (np.trapezoid(np.maximum(heights - start, 0) ** 2.5 * tail, heights) for start in (1.0, 2.0))
    assert share[3] / share[2] == pytest.approx(two / one, rel=1e-5)
    rough, smooth = (Lubricant(ball_roughness=0.0, cup_roughness=ra, friction=law) for ra in (1.0, 1e-9))
    stress = [each.shear_stress(np.array(5.0), np.array(1e-4), np.array(30.0)) for each in (rough, smooth)]
    assert stress[0] == pytest.approx(0.1 * 5.0, rel=1e-3)
    assert stress[1] == pytest.approx(2.5e-9 * 30.0 / 1e-4, rel=1e-12)
    use = hip(**QUICK)
    touching = use.film(Lubricant(friction=0.1), cycles=30)
    mixed = use.film(Lubricant(friction=Stribeck(boundary=0.1), cup_roughness=1e-4), cycles=30)
    assert 0.2 < mixed.heat / touching.heat < 0.98


def test_a_still_ball_has_no_film_and_flexion_alone_does_not_refill_the_core():
    still = Cycle(name="still", force=lambda t: 1000.0 + 0 * t, angles=lambda t: np.zeros((3, *t.shape)))
    assert hip(cycle=still, ring_width=radians(8.0)).film(cycles=3).least == pytest.approx(0.0)
    film = hip(cycle=flexion(24), ring_width=radians(6.0)).film()
    assert not film.settled
    assert not film.valid
    assert "its film falls" in film.note


def test_edge_distance_equals_the_closed_form_and_its_azimuth_follows_the_load():
    use = hip()
    contact = bs.HessForsbach().press(use.joint, force=use.cycle.force_magnitudes)
    expected = use.cup.edge_distance(use.joint.socket_radius, contact.half_angle)
    assert use.edge_distance(use.unworn) == pytest.approx(expected, abs=0.05)
    lean = np.array([np.cos(radians(40.0)), np.sin(radians(40.0)), 1.0])
    cycle = Cycle(name="leaning", force=lambda t: np.outer(lean, 800 + 600 * t), angles=flexion().angles)
    use = hip(cycle=cycle, cup=bs.Cup())
    edge = use.edge(use.unworn)
    assert np.degrees(edge.azimuth) == pytest.approx(40.0, abs=2.0)
    assert edge.closest_approach(use.frame).step_description == "99.5 % of the cycle"


def test_contact_at_the_rim_is_noted_with_its_instant():
    history = hip(cycle=iso_14242_1(36), ring_width=radians(4.0), cup=bs.Cup(inclination=radians(60.0))).after(1e5)
    assert history.last.edge_distance.min() == 0
    assert history.worst.kind == "edge loading"
    note = next(note for note in history.notes if note.startswith("edge loading: in the first cycle"))
    assert "of 36 instants, most at 12.5 % of the cycle, 0° from the cup's uppermost point" in note
    edge = history.summary()["history"][-1]["edge"]
    assert (edge["distance_mm"], edge["place_deg"]) == (0.0, pytest.approx(0.0, abs=0.1))
    assert 0 < edge["pressure_at_rim_MPa"] < history.last.max_pressure
    assert edge["instants_edge_loaded"] > 0
    first = history.summary()["cycle"]["edge"]["pressure_at_rim_MPa"]
    highest = max(first, edge["pressure_at_rim_MPa"])
    assert f"the pressure in the outermost ring is at most {highest:.3g} MPa" in note


@pytest.mark.parametrize("surface", [bs.Springs(), bs.ClosedShell()], ids=["springs", "shell"])
def test_edge_distance_decreases_continuously_to_zero(surface):
    """One load at tilts by 0.5°: each moves the edge by at most 0.26 mm, and a shell's as `Sphere` has it."""
    tilts = np.radians(np.arange(36.0, 56.0, 0.5))
    loads = 1500.0 * np.stack([np.sin(tilts), 0 * tilts, np.cos(tilts)])
    cycle = Cycle(name="tilting", force=lambda t: loads, angles=flexion().angles, n_steps=len(tilts))
    use = hip(cycle=cycle, cup=bs.Cup(), surface=surface)
    distance = use.edge_distance(use.unworn)
    steps = np.diff(distance[distance > 0])
    assert len(steps) > 10
    assert steps.max() < 0
    assert abs(steps).max() < 0.26
    assert distance[distance > 0].min() < 0.26
    model = bs.Sphere(cup=bs.Cup(), surface=surface)
    expected = model.press(use.joint, force=1500.0, tilt=tilts[:10:3]).edge_distance
    assert distance[:10:3] == pytest.approx(expected, abs=0.1)


def test_missing_films_are_null_in_json(short_film):
    roughless = Lubricant(ball_roughness=0.0, cup_roughness=0.0)
    closed = hip(**QUICK, clearance=0.0).after(1e4, lubricant=Lubricant())
    smooth = hip(**QUICK).after(1e4, lubricant=roughless)
    for worn, missing in ((closed, "least_nm"), (smooth, "lambda_largest")):
        summary = worn.summary()
        assert summary["film"][missing] is None
        assert summary["film"]["heat_J_per_cycle"] > 0
        json.dumps(summary, allow_nan=False)


# wear only where the film ratio is below a limit

SMOOTH = Lubricant(cup_roughness=1e-4)
"""Lubricant of a smooth cup, whose film ratios are below and above 1."""


def limited(ratio, cycles=5, **words):
    return hip(**QUICK, film_limit=FilmLimit(ratio=ratio, lubricant=SMOOTH, cycles=cycles), **words)


AREA = ContactAreaWear(coefficient=1e-9)
LAWS = [{}, {"wear": AREA}, {"wear": CrossShear(straight=K, circular=2 * K, exponent=-0.3)}, {"ball_wear": AREA}]


@pytest.mark.parametrize("words", some(LAWS, 2))
def test_an_infinite_limit_wears_as_none_and_a_limit_of_zero_wears_nothing(words):
    uses = hip(**QUICK, **words), limited(inf, **words), limited(0.0, **words)
    free, unlimited, nothing = (report_after(use, 2e5) for use in uses)
    assert np.array_equal(free.wear, unlimited.wear)
    assert np.array_equal(free.ball_wear, unlimited.ball_wear)
    assert free.work == unlimited.work
    assert nothing.volume == nothing.ball_volume == limited(inf, **words).excluded_work_share == 0
    assert limited(0.0, **words).excluded_work_share == 1
    assert nothing.work == pytest.approx(2e5 * 1e3 * hip(**QUICK).first.work, rel=1e-9)


def test_archard_wears_by_the_work_below_the_limit_which_json_and_notes_state():
    use, free = limited(1.0), hip(**QUICK)
    assert 0.1 < use.excluded_work_share < 0.9
    assert use.first.volume == pytest.approx((1 - use.excluded_work_share) * free.first.volume, rel=1e-12)
    assert use.first.work == free.first.work
    thickness = use.film(SMOOTH, cycles=5).thickness
    wears = use.wearing_exposure(use.exposure(use.unworn)).pressure > 0
    assert np.array_equal(wears, (thickness < SMOOTH.roughness) & (use.unworn.pressure > 0))
    run, share = use.after(1e5), f"{100 * use.excluded_work_share:.3g} %"
    limit = json.loads(json.dumps(run.summary(), allow_nan=False))["laws"]["film_limit"]
    assert limit == {"lambda": 1.0, "excluded_work_share": use.excluded_work_share}
    assert any(note.startswith("wear counts only where λ is below 1") and share in note for note in run.notes)
    assert history(hip(**QUICK), 1e4).summary()["laws"]["film_limit"] is None


def test_a_file_has_its_limit_and_prints_its_film_with_its_lubricant(tmp_path, short_film):
    limit = ("[wear]", "[wear]\nfilm_limit = 1.5")
    file = write_edited_file(tmp_path, *SHORT, limit, text=f"{TEXT}\n[film]\nviscosity = '1 mPa s'\n")
    assert read_hip(file).use.film_limit == FilmLimit(ratio=1.5, lubricant=Lubricant(viscosity=1e-3))
    file = write_edited_file(tmp_path, *SHORT, text=f'{TEXT}\n[film]\ncup_roughness = "0.5 um"\n')
    text = " ".join(run("hip", str(file)).stdout.split())
    assert "film with viscosity 2.5 mPa s, roughness Ra 0.02 µm (ball) and 0.5 µm (cup); by default: visc" in text
    film = read_hip(file).use.film(Lubricant(cup_roughness=5e-4))
    least = re.search(r"smallest ([0-9.]+) nm", text)
    assert float(least[1]) == pytest.approx(1e6 * film.least.min(), rel=5e-3)  # printed with three digits
