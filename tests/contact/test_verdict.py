"""Verdicts on the strength of the materials."""

from dataclasses import replace

import pytest

import ballsocket as bs
from ballsocket.contact.verdict import assess_strength, strength_uses

HIP = bs.joints["hip-36"]


def test_use_of_a_strength_is_stress_over_strength():
    liner = replace(HIP.liner, allowable_pressure=20.0)
    contact = bs.Exact().press(replace(HIP, liner=liner), force=3000.0)
    by_name = {share.strength: share for share in strength_uses(contact)}
    assert by_name["allowable_pressure"].ratio == pytest.approx(contact.max_pressure / 20.0)
    assert by_name["yield_stress"].ratio == pytest.approx(contact.utilisation)
    assert str(strength_uses(contact)[0]) == "56 % of the allowable pressure of the liner"


@pytest.mark.parametrize(
    ("contact", "bears", "words"),
    [
        (bs.Exact().press(HIP, force=3000.0), True, "within its strength: 33 % of the yield stress of the liner"),
        (bs.Exact().press(HIP, force=30e3), False, "overloaded: 1.61 times the yield stress of the liner"),
        (bs.Hertz().press(HIP, force=3000.0), None, "result not valid: outside ε ≤ 7°"),
        (bs.Exact().press(HIP, half_angle=1.55), None, "no answer"),
    ],
)
def test_verdicts_state_their_reason(contact, bears, words):
    said = assess_strength(contact)
    assert said.bears is bears
    assert said.words.startswith(words)


def test_without_a_strength_there_is_no_verdict():
    joint = replace(HIP, liner=HIP.liner.without_strengths(), ball=None)
    said = assess_strength(bs.HessForsbach().press(joint, force=3000.0))
    assert (said.bears, said.words) == (None, "strength not checked: the liner has no yield stress")


def test_a_strong_ball_gives_no_verdict_on_a_liner_of_unknown_strength():
    joint = replace(HIP, liner=HIP.liner.without_strengths(), ball=bs.COCR)
    assert assess_strength(bs.HessForsbach().press(joint, force=3000.0)).bears is None
