"""Numbers as people type them: fractions, inches for reading, bounds, and refusals in the words of the field."""

import pytest

pytest.importorskip("tomli_w")
from ballsocket.app.state.screen import START
from ballsocket.app.widgets.cup_fields import cup_edited, cup_fields
from ballsocket.app.widgets.fields import in_words_of
from ballsocket.app.widgets.joint_fields import joint_inputs
from ballsocket.app.widgets.numbers import NUMBERS
from ballsocket.app.widgets.reading import box_text, number_text

from .test_screen import screen_with

INCHES = screen_with(units="imperial")


def typed(name, value, screen=START):
    return joint_inputs(screen)[name].edit(value)


def fields_of(screen):
    return {name: entry.field for name, entry in joint_inputs(screen).items()}


@pytest.mark.parametrize(
    ("text", "diameter"),
    [("1 1/8", 28.575), ("1-1/8", 28.575), ("1,125", None), ("9/8 in", 28.575), ("1.125", 28.575), ("30 mm", 30.0)],
)
def test_a_diameter_in_inches_may_be_a_fraction(text, diameter):
    if diameter is None:
        with pytest.raises(ValueError, match="Head diameter '1,125' could be two numbers: write 1125 or 1.125"):
            typed("ball_radius", text, INCHES)
    else:
        assert 2 * typed("ball_radius", text, INCHES).joint.ball_radius == pytest.approx(diameter, rel=1e-12)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (32 / 25.4, "in", "1.26"),
        (0.2 / 25.4, "in", "0.0079"),
        (0.001 / 25.4, "in", "3.9e-05"),
        (1.0625, "in", "1.0625"),
        (674.427, "lbf", "674"),
        (33.35868, "Mpsi", "33.4"),
        (22.225, "mm", "22.225"),
        (26.1234567, "mm", "26.123"),
        (1234567.0, "N", "1234600"),
    ],
)
def test_a_box_shows_a_number_that_can_be_read(value, unit, text):
    assert box_text(value, unit) == text


def test_answers_in_inches_have_tenths_of_a_thousandth():
    assert [number_text(value, "in") for value in (32 / 25.4, 0.2 / 25.4, 8.0)] == ["1.26", "0.0079", "8"]
    assert number_text(0.2 / 25.4) == "0.007874"


def test_moduli_have_the_units_of_engineers():
    fields = fields_of(INCHES)
    assert (fields["liner_young"]["unit"], fields["ball_young"]["unit"]) == ("ksi", "Mpsi")
    assert 25 < float(fields["ball_young"]["text"]) < 40  # a metal
    assert typed("liner_young", "109", INCHES).joint.liner.young == pytest.approx(109 * 6.894757293168)


@pytest.mark.parametrize("name", [*NUMBERS, "load", "tilt", "allowable"])
def test_no_box_takes_what_no_joint_has(name):
    for value in ("1e12", "-1e12", "inf", "nan", "x" * 5000, ""):
        if (name, value) == ("allowable", ""):
            continue
        with pytest.raises(ValueError, match=" must be ") as refused:
            typed(name, value)
        assert str(refused.value).startswith(fields_of(START)[name]["label"])
        assert len(str(refused.value)) < 200


@pytest.mark.parametrize(
    "name", ["inclination", "anteversion", "arc_of_cover", "chamfer", "inwards", "forwards", "tilt"]
)
def test_no_box_of_a_cup_takes_what_no_cup_has(name):
    with pytest.raises(ValueError, match=" must be ") as refused:
        cup_edited(START, name, 1e9)
    assert str(refused.value).startswith(cup_fields(START)[f"cup.{name}"]["label"])


@pytest.mark.parametrize(
    ("screen", "name", "text", "sentence"),
    [
        (START, "ball_radius", "-5", "Head diameter must be positive, got -5 mm"),
        (screen_with(size="radius"), "ball_radius", "-5", "Ball radius must be positive, got -5 mm"),
        (INCHES, "ball_radius", "4000", "Head diameter must be 7.9e-05 to 787.4 in .*, got 4000 in"),
        (START, "clearance", "-0.1", "Diametral clearance must be zero or positive, got -0.1 mm"),
    ],
)
def test_a_refusal_speaks_of_the_field_and_its_unit(screen, name, text, sentence):
    with pytest.raises(ValueError, match=f"^{sentence}$"):
        typed(name, text, screen)


def test_a_refusal_of_the_mechanics_has_the_words_of_the_field_too():
    field = fields_of(START)["outer_radius"]
    with pytest.raises(ValueError, match="outer_radius = 5.0 is not allowed") as refused:
        typed("outer_radius", "10")
    worded = in_words_of(field, str(refused.value), "10 mm")
    assert worded.startswith("Outer diameter 10 mm is not allowed: it must leave a liner")
    assert worded.endswith(f"; {field['text']} mm stays in use")


def test_symbols_are_in_the_hints_and_labels_are_words():
    fields = fields_of(START)
    assert fields["ball_radius"]["hint"] == "2 R1: Twice the radius of the ball."
    labels = [field["label"] for field in fields.values() if field["kind"] == "number"]
    assert len(set(labels)) == len(labels)
    assert all(label.split()[-1] not in ("R1", "c", "L", "E", "F", "γ") for label in labels)


def test_a_changed_preset_keeps_its_name_but_not_its_source():
    changed = typed("ball_radius", "30")
    assert (changed.joint.name, changed.joint.source) == ("hip-28 (changed)", "")
    assert START.file.joint.source
    back = typed("ball_radius", "28", screen_with(file=changed))
    assert back.joint == START.file.joint
    named = typed("name", " Anna  Meier ")
    assert (named.joint.name, named.joint.source) == ("Anna Meier", START.file.joint.source)
    assert typed("clearance", "0.3", screen_with(file=named)).joint.name == "Anna Meier"


@pytest.mark.parametrize("name", ["x" * 81, "a\x1bb", "\ud800", 3, None])
def test_a_name_is_short_text(name):
    with pytest.raises(ValueError, match="the name"):
        typed("name", name)
