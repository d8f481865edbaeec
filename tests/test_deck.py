"""The model as an input file for other programs, and what CalculiX makes of it."""

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.fem import ccx
from ballsocket.fem.deck import Deck, deck_of

from .joints import HIP

CCX = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
COARSE = bs.Adapted(elements=24)
SHELL = bs.Layer(thickness=3.0, material=bs.TITANIUM)


def a_deck(joint=HIP, *, steps=2, force=3000.0, **settings):
    settings = {"spacing": COARSE, "meshes": 1, **settings}
    return deck_of(bs.FiniteElement(**settings).press(joint, force=force), steps=steps)


def keywords(deck):
    return [line for line in deck.text().splitlines() if line.startswith("*") and not line.startswith("**")]


def section(deck, head):
    """The lines of numbers after a headline."""
    lines = deck.text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(head)) + 1
    end = next(i for i in range(start, len(lines)) if lines[i].startswith("*"))
    return lines[start:end]


@pytest.mark.parametrize("element", bs.Element)
def test_nodes_and_elements_are_those_of_the_model(element):
    deck = a_deck(element=element)
    sizes = deck.contact.mesh
    liner, ball = (
        section(deck, f"*ELEMENT, TYPE={kind}, ELSET={name}") for name in ("LINER", "BALL") for kind in [_kind(element)]
    )
    assert len(liner) + len(ball) == sizes.elements
    nodes = {int(row.split(",")[0]) for row in section(deck, "*NODE")}
    used = {int(number) for row in (*liner, *ball) for number in row.split(",")[1:]}
    assert nodes == used
    assert len(nodes) == sizes.nodes - (sizes.elements if element is bs.Element.BIQUADRATIC else 0)
    assert {len(row.split(",")) for row in liner} == {9 if element is bs.Element.BIQUADRATIC else 5}


def _kind(element):
    return "CAX8R" if element is bs.Element.BIQUADRATIC else "CAX4"


def test_steps_materials_and_what_is_expected(tmp_path):
    deck = a_deck(replace(HIP, backing=(SHELL,)), steps=3)
    words = keywords(deck)
    assert words.count("*STEP, INC=100") == 3
    assert [word for word in words if word.startswith("*MATERIAL")] == [
        "*MATERIAL, NAME=LINER",
        "*MATERIAL, NAME=BACKING1",
        "*MATERIAL, NAME=BALL",
    ]
    path = deck.write(tmp_path / "new" / "folder")
    assert path.read_text(encoding="ascii") == deck.text()
    assert sorted(file.name for file in path.parent.iterdir()) == ["ballsocket.inp", "expected.json"]
    record = json.loads((path.parent / "expected.json").read_text(encoding="ascii"))
    assert record["steps"][-1]["force"] == pytest.approx(3000.0, rel=1e-6)
    assert record["scale"] == 1e-3


def test_what_slides_and_what_is_free_is_told_in_polar_directions():
    plain, sliding, alone, free = (
        keywords(deck)
        for deck in (
            a_deck(replace(HIP, backing=(SHELL,))),
            a_deck(replace(HIP, backing=(SHELL,)), cup=bs.Cup(interface=bs.Interface.SLIDING)),
            a_deck(cup=bs.Cup(interface=bs.Interface.SLIDING)),
            a_deck(replace(HIP, backing=(SHELL,), support=bs.Support.FREE), cup=bs.Cup(arc_of_cover=np.radians(160.0))),
        )
    )
    assert "*EQUATION" not in plain
    assert not any(word.startswith("*TRANSFORM") for word in plain)
    assert "*EQUATION" in sliding
    for words in (sliding, alone, free):
        assert any(word.startswith("*TRANSFORM") for word in words)
    assert "*NSET, NSET=FIXED" in plain
    assert "*NSET, NSET=FIXED" not in free


def test_the_scale_multiplies_clearance_and_indentation():
    small, real = (replace_scale(a_deck(), scale) for scale in (1e-3, 1.0))
    steps = [
        float(next(row for row in section_after_step(deck) if row.startswith("PUSHED, 2, 2")).split(",")[3])
        for deck in (small, real)
    ]
    assert steps[0] == pytest.approx(1e-3 * steps[1], rel=1e-9)
    assert steps[1] < 0


def replace_scale(deck, scale):
    return Deck(contact=deck.contact, steps=deck.steps, scale=scale)


def section_after_step(deck):
    lines = deck.text().splitlines()
    return lines[lines.index("*STEP, INC=100") :]


@pytest.mark.parametrize(
    ("contact", "words", "message"),
    [
        ({"force": np.array([10.0, 20.0])}, {}, "a deck is for one contact"),
        ({"force": 0.0}, {}, "need a contact under load"),
        ({"force": 3000.0}, {"steps": 0}, "steps = 0 is not allowed"),
        ({"force": 3000.0}, {"scale": 2.0}, "scale = 2 is not allowed"),
    ],
)
def test_a_deck_refuses(contact, words, message):
    pressed = bs.FiniteElement(spacing=COARSE, meshes=1).press(HIP, **contact)
    with pytest.raises(ValueError, match=message):
        deck_of(pressed, **words)


def test_a_deck_has_the_linear_gap_only():
    pressed = bs.FiniteElement(spacing=COARSE, meshes=1, gap=bs.CircularGap).press(HIP, force=3000.0)
    with pytest.raises(ValueError, match="gap=LinearGap"):
        deck_of(pressed)


def test_without_the_program_or_a_deck_there_is_one_clear_sentence(tmp_path, monkeypatch):
    if shutil.which("ccx") is not None:
        with pytest.raises(FileNotFoundError, match=r"there is no ballsocket\.inp in"):
            ccx.run(tmp_path)
    monkeypatch.setenv("PATH", "")
    with pytest.raises(FileNotFoundError, match="CalculiX is not installed"):
        ccx.run(tmp_path)


JOINTS = {
    "steel": (HIP, bs.Cup()),
    "rigid": (replace(HIP, ball=None), bs.Cup()),
    "nearly incompressible": (replace(HIP, liner=bs.Material(young=1000.0, poisson=0.49)), bs.Cup()),
    "metal-backed": (replace(HIP, backing=(SHELL,)), bs.Cup()),
    "sliding in metal": (replace(HIP, backing=(SHELL,)), bs.Cup(interface=bs.Interface.SLIDING)),
    "sliding": (HIP, bs.Cup(interface=bs.Interface.SLIDING)),
    "free, 160 degrees": (
        replace(HIP, backing=(SHELL,), support=bs.Support.FREE),
        bs.Cup(arc_of_cover=np.radians(160.0)),
    ),
    "chamfered": (HIP, bs.Cup(chamfer=2.0)),
}


@CCX
@pytest.mark.parametrize(("joint", "cup"), JOINTS.values(), ids=JOINTS)
def test_calculix_finds_the_same_on_the_same_mesh(joint, cup, tmp_path):
    """Its penalty takes 0.05 % from the force; its nodal pressures zigzag."""
    deck = a_deck(joint, cup=cup)
    deck.write(tmp_path)
    theirs = ccx.run(tmp_path)
    ours = deck.expected
    np.testing.assert_allclose(theirs.indentation, ours["indentation"], rtol=1e-6)
    np.testing.assert_allclose(theirs.force, ours["force"], rtol=3e-3)
    np.testing.assert_allclose(theirs.max_pressure, ours["max_pressure"], rtol=1e-2)
    np.testing.assert_allclose(np.degrees(theirs.half_angle), ours["half_angle_deg"], atol=0.3)
