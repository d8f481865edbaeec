"""The table of checks: demand, capacity, ratio and verdict are those of the contact and its materials."""

import pickle
from dataclasses import replace
from math import radians

import pytest

import ballsocket as bs
from ballsocket.contact.verdict import assess_strength
from ballsocket.reports.check_table import checks_at, checks_html, checks_of, verdict_of, wear_check
from ballsocket.reports.unit_systems import Units

HIP, CUP = bs.joints["hip-28"], bs.Cup()
WRITE = Units.SI.text_of


def liner(**strengths):
    return replace(HIP, liner=bs.Material(young=1000.0, poisson=0.4, **strengths), ball=None)


def by_title(rows):
    return {row.title: row for row in rows}


def test_pressure_and_von_mises_stress_have_rows_of_their_own():
    contact = bs.Exact().press(HIP, force=3000.0)
    rows = by_title(checks_of(contact, CUP, contact.von_mises))
    liner_stress, pressure = rows["von Mises stress in the liner"], rows["pressure on the liner"]
    assert (liner_stress.demand, liner_stress.capacity) == (contact.von_mises, 21.0)
    assert liner_stress.ratio == pytest.approx(contact.utilisation)
    assert liner_stress.source == "UHMWPE, yield: least of ASTM F648 type 1 (unverified)"
    estimate = by_title(checks_of(contact, CUP))["von Mises stress in the liner"]
    assert estimate.source == f"{liner_stress.source}; stress estimated from pressure and half angle"
    assert (pressure.demand, pressure.capacity, pressure.passes) == (contact.max_pressure, None, None)
    assert pressure.source == "no allowable pressure of the liner is known"
    assert rows["von Mises stress in the ball"].capacity == HIP.ball.yield_stress


@pytest.mark.parametrize("force", [300.0, 3000.0, 12000.0, 30e3])
@pytest.mark.parametrize("strengths", [{}, {"allowable_pressure": 20.0}, {"yield_stress": 21.0}])
def test_the_verdict_is_that_of_the_strength_alone_where_the_rim_is_far(strengths, force):
    contact = bs.Exact().press(liner(**strengths), force=force)
    rows = checks_of(contact, bs.Cup(arc_of_cover=radians(340.0)), contact.von_mises)
    assert verdict_of(rows)[0] is assess_strength(contact).bears


def test_a_contact_outside_the_range_of_its_model_has_no_verdict_but_may_fail():
    doubtful = bs.Hertz().press(liner(allowable_pressure=1e3), force=3000.0)
    assert verdict_of(checks_of(doubtful, CUP)) == (None, "No verdict: this result is outside the range of its model")
    overloaded = bs.Hertz().press(liner(allowable_pressure=4.0), force=3000.0)
    passes, sentence = verdict_of(checks_of(overloaded, CUP))
    assert passes is False
    assert sentence.endswith(f"{overloaded.max_pressure / 4:.3g} times the allowable pressure")


@pytest.mark.parametrize("tilt", [0.0, 45.0, 75.0])
def test_the_row_of_the_rim_fails_where_the_contact_is_edge_loaded(tilt):
    contact = bs.Sphere(ring_width=radians(4.0)).press(HIP, force=3000.0, tilt=radians(tilt))
    row = by_title(checks_of(contact, CUP))["reach of the contact"]
    assert row.passes is not contact.edge_loaded
    assert row.capacity - row.demand == pytest.approx(contact.edge_distance)


def test_numbers_of_a_worn_bore_give_the_rows_of_a_contact():
    contact = bs.Exact().press(HIP, force=3000.0)
    distance = HIP.socket_radius * (CUP.rim - contact.half_angle)
    rows = checks_at(HIP, pressure=contact.max_pressure, half_angle=contact.half_angle, edge=(CUP.rim, distance))
    assert rows == checks_of(contact, CUP)
    assert pickle.loads(pickle.dumps(rows)) == rows
    assert [wear_check(HIP, depth).passes for depth in (0.5, 6.0)] == [True, False]


def test_a_preloaded_joint_has_no_row_of_the_rim():
    joint = bs.Joint(ball_radius=14.0, interference=0.05, liner_thickness=5.0, liner=bs.UHMWPE)
    rows = checks_at(joint, pressure=5.0, half_angle=1.2, edge=(1.5, -0.1))
    assert "reach of the contact" not in by_title(rows)


def test_a_failure_stands_first_and_has_a_sign_a_word_and_a_style():
    contact = bs.Exact().press(liner(allowable_pressure=10.0, yield_stress=21.0), force=3000.0)
    html = checks_html(checks_of(contact, CUP), WRITE)
    assert html.index("✗ fails") < html.index("✓ passes")
    pressure = f"<td>{contact.max_pressure:.4g} MPa</td>"
    assert f"<tr class='fails'><th scope='row'>pressure on the liner</th>{pressure}" in html
    assert f"{10 * contact.max_pressure:.0f} %" in html
    assert "psi" in checks_html(checks_of(contact, CUP), Units.IMPERIAL.text_of)
