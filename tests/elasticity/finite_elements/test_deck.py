"""Input decks for other programs: their contents, and the results of CalculiX."""

import json
import os
import shutil
from functools import cached_property

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.finite_elements import calculix as ccx
from ballsocket.elasticity.finite_elements.deck import deck_of

from ...extent import some
from ..calculix import needs_ccx

LINER = bs.Material(young=1000.0, poisson=0.4)
RIGID = bs.Joint(ball_radius=17.9, clearance=0.1, liner_thickness=6.75, liner=LINER)
STEEL, FREE = RIGID.replace(ball=bs.STEEL), RIGID.replace(support=bs.Support.FREE)
TITANIUM, SOFT = bs.Layer(thickness=3.0, material=bs.TITANIUM), bs.Layer(thickness=4.0, material=bs.BONE_CEMENT)
SLIDING = bs.Interface.SLIDING
COARSE, FINER = bs.Adapted(elements=24), bs.Adapted(elements=36)


def pressed(joint, half_angle=40.0, *, arc=180.0, chamfer=0.0, interface=bs.Interface.BONDED, **settings):
    cup = bs.Cup(arc_of_cover=np.radians(arc), chamfer=chamfer, interface=interface)
    model = bs.FiniteElement(**{"spacing": COARSE, "meshes": 1, **settings}, cup=cup)
    return model.press(joint, half_angle=np.radians(half_angle))


def read(joint, **settings):
    return Read(deck_of(pressed(joint, **settings)).text())


class Read:
    """Parsed deck: data lines by keyword line, in order."""

    def __init__(self, text: str) -> None:
        assert text.isascii()
        self.title, self.blocks = [], []
        for line in text.splitlines():
            if line.startswith("**"):
                self.title.append(line)
            elif line.startswith("*"):
                self.blocks.append((line, []))
            else:
                self.blocks[-1][1].append([word.strip() for word in line.split(",")])

    def of(self, start: str) -> list[list[str]]:
        return [row for head, rows in self.blocks if head.startswith(start) for row in rows]

    def heads(self, start: str) -> list[str]:
        return [head for head, _ in self.blocks if head.startswith(start)]

    @cached_property
    def nodes(self) -> dict[int, np.ndarray]:
        return {int(row[0]): np.array(row[1:], dtype=float) for row in self.of("*NODE, ")}

    @cached_property
    def elements(self) -> dict[int, list[int]]:
        return {int(row[0]): [int(node) for node in row[1:]] for row in self.of("*ELEMENT")}

    def set(self, name: str) -> list[int]:
        return [int(word) for row in self.of(f"*NSET, NSET={name}") for word in row]

    def side(self, surface: str) -> np.ndarray:
        """Places of the corners at both ends of each side (sides, 2, xy)."""
        sides, rows = {"S2": [1, 2], "S4": [3, 0]}, self.of(f"*SURFACE, NAME={surface},")
        return np.array([[self.nodes[self.elements[int(number)][i]] for i in sides[side]] for number, side in rows])

    def polar(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Radii and angles of a set of nodes about the socket's centre."""
        x, y = np.array([self.nodes[node] for node in self.set(name)]).T
        return np.hypot(x, y), np.arctan2(x, -y)


@pytest.mark.parametrize("element", list(bs.Element))
def test_the_deck_has_the_mesh_of_the_solution(element):
    contact = pressed(STEEL.replace(backing=(TITANIUM,)), element=element)
    deck = Read(deck_of(contact, steps=3).text())
    middles = contact.mesh.elements if element is bs.Element.BIQUADRATIC else 0
    assert len(deck.elements) == contact.mesh.elements
    assert sorted(deck.nodes) == list(range(1, contact.mesh.nodes - middles + 1))
    assert {node for nodes in deck.elements.values() for node in nodes} == set(deck.nodes)
    kind = "CAX8R" if middles else "CAX4"
    assert deck.heads("*ELEMENT") == [f"*ELEMENT, TYPE={kind}, ELSET={name}" for name in ("LINER", "BACKING1", "BALL")]
    places = np.array([[deck.nodes[node] for node in nodes] for nodes in deck.elements.values()])
    corners, ends = places[:, :4], np.roll(places[:, :4], -1, axis=1)
    assert np.all(np.linalg.det(np.stack([corners, ends], axis=-2)).sum(axis=1) > 0)  # counterclockwise
    if middles:
        apart = np.linalg.norm(places[:, 4:] - (corners + ends) / 2, axis=-1)
        assert np.all(apart < 0.2 * np.linalg.norm(corners - ends, axis=-1))
    part = contact.section["liner"]
    outline = {(round(a, 8), round(b, 8)) for a, b in part.position.T}
    liner = [row for head, rows in deck.blocks if head.endswith("ELSET=LINER") for row in rows]
    places = {tuple(np.round(deck.nodes[int(node)], 8) + 0.0) for row in liner for node in row[1:]}
    assert places <= outline
    assert len(outline) - len(places) == (len(liner) if middles else 0)


def test_each_part_has_a_section_and_its_elastic_constants():
    deck = read(STEEL.replace(backing=(TITANIUM, SOFT)))
    names = ["LINER", "BACKING1", "BACKING2", "BALL"]
    assert deck.heads("*MATERIAL") == [f"*MATERIAL, NAME={name}" for name in names]
    assert deck.heads("*SOLID SECTION") == [f"*SOLID SECTION, ELSET={name}, MATERIAL={name}" for name in names]
    moduli = np.array(deck.of("*ELASTIC"), dtype=float)
    materials = (LINER, bs.TITANIUM, bs.BONE_CEMENT, bs.STEEL)
    np.testing.assert_allclose(moduli[:3], [(m.young, m.poisson) for m in materials[:3]])
    assert moduli[3] == pytest.approx((bs.STEEL.young * 18.0 / (18.0 - 1e-4), bs.STEEL.poisson))


@pytest.mark.parametrize("like", [RIGID, STEEL], ids=["rigid", "steel"])
@pytest.mark.parametrize("scale", [1e-3, 0.1])
def test_the_bodies_first_touch_at_the_pole(like, scale):
    contact = pressed(like)
    deck = Read(deck_of(contact, scale=scale).text())
    lined, ball = deck.side("LINED"), deck.side("PRESSED")
    radius, c = 18.0, scale * 0.1
    np.testing.assert_allclose(np.hypot(*lined.transpose(2, 0, 1)), radius, rtol=1e-12)
    angle = np.arctan2(ball[..., 0], -(ball[..., 1] + c))  # about the ball's own centre
    np.testing.assert_allclose(np.hypot(ball[..., 0], ball[..., 1] + c), radius - c, rtol=1e-12)
    gap = radius - np.hypot(ball[..., 0], ball[..., 1])
    np.testing.assert_allclose(gap, c * (1 - np.cos(angle)), atol=1e-3 * c)
    assert np.min(abs(gap)) < 1e-6 * c
    assert contact.half_angle < np.arctan2(lined[..., 0], -lined[..., 1]).max() < angle.max()


def test_steps_have_their_displacements_and_expected_results():
    contact = pressed(STEEL.replace(name="ø 36\n*STEP"))
    made = deck_of(contact, steps=5, scale=0.01)
    deck = Read(made.text())
    assert len(deck.heads("*STEP")) == len(deck.heads("*END STEP")) == 5
    heights = [float(row[3]) for row in deck.of("*BOUNDARY") if row[:3] == ["PUSHED", "2", "2"]]
    depths = contact.indentation * np.arange(1, 6) / 5
    np.testing.assert_allclose(heights, -0.01 * depths, rtol=1e-12)
    again = contact.model.press(STEEL, indentation=depths)
    for name in ("indentation", "force", "max_pressure", "pole_pressure"):
        np.testing.assert_allclose(made.expected[name], getattr(again, name))
    assert made.expected["force"][-1] == pytest.approx(contact.force, rel=1e-6)
    assert made.expected["half_angle_deg"][-1] == pytest.approx(40.0, abs=1e-4)


def test_an_elastic_ball_is_pushed_at_its_equator_and_a_rigid_one_at_all_nodes():
    elastic, rigid = read(STEEL), read(RIGID)
    radius, angle = elastic.polar("PUSHED")
    np.testing.assert_allclose(angle, np.pi / 2, atol=1e-2)  # its centre lies a little below
    assert np.ptp(radius) > 17.0
    assert min(elastic.set("ROUND")) in elastic.set("UPRIGHT")  # the pole
    assert set(elastic.set("PUSHED")).isdisjoint(elastic.set("UPRIGHT"))
    ball = {int(node) for head, rows in rigid.blocks if head.endswith("ELSET=BALL") for row in rows for node in row[1:]}
    assert set(rigid.set("PUSHED")) == ball <= set(rigid.set("UPRIGHT"))


def test_a_fixed_liner_has_a_fixed_outer_surface():
    deck = read(RIGID.replace(backing=(TITANIUM,)))
    radius, angle = deck.polar("FIXED")
    np.testing.assert_allclose(radius, 18.0 + 6.75 + 3.0)
    assert (angle.min(), angle.max()) == (0, pytest.approx(np.pi / 2))
    assert np.count_nonzero(deck.polar("UPRIGHT")[1] == 0) > 10
    assert not deck.heads("*TRANSFORM") + deck.heads("*EQUATION")


@pytest.mark.parametrize("arc", some([140.0, 180.0], 1))
def test_a_free_liner_is_supported_at_its_rim(arc):
    deck = read(FREE.replace(backing=(TITANIUM,)), arc=arc)
    radius, angle = deck.polar("SEATED")
    np.testing.assert_allclose(angle, np.radians(arc / 2), rtol=1e-9)
    assert (radius.min(), radius.max()) == pytest.approx((18.0 + 6.75, 18.0 + 6.75 + 3.0))
    assert ["SEATED", "2", "2"] in deck.of("*BOUNDARY")
    assert deck.set("POLAR") == deck.set("SEATED")
    assert deck.heads("*TRANSFORM") == ["*TRANSFORM, NSET=POLAR, TYPE=C"]
    assert not deck.heads("*NSET, NSET=FIXED")


def test_a_sliding_liner_in_a_rigid_socket_has_a_radial_support():
    deck = read(RIGID, interface=SLIDING)
    radius, angle = deck.polar("ROLLING")
    np.testing.assert_allclose(radius, 18.0 + 6.75)
    assert angle.min() > 0
    assert ["ROLLING", "1", "1"] in deck.of("*BOUNDARY")
    assert deck.set("POLAR") == deck.set("ROLLING")
    assert len(deck.set("FIXED")) == 1  # on the axis
    assert not deck.heads("*EQUATION")


def test_a_chamfer_is_excluded_from_the_contact_surface():
    deck = read(RIGID, half_angle=60.0, arc=150.0, chamfer=2.0)
    (_, angle), (x, y) = deck.polar("BORE"), deck.side("LINED").T
    assert angle.max() == pytest.approx(np.radians(75.0) - 2.0 / 18.0)
    assert np.arctan2(x, -y).max() <= angle.max() + 1e-9
    inner = np.min([np.hypot(*place) for place in deck.nodes.values() if np.arctan2(place[0], -place[1]) > 1.308])
    assert inner == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("joint", "settings", "wrong", "words"),
    [
        (RIGID, {"half_angle": [40.0, 50.0]}, {}, "a deck needs one contact"),
        (RIGID, {"half_angle": 0.0}, {}, "under load"),
        (RIGID, {"gap": bs.CircularGap}, {}, "linear gap"),
        (STEEL, {"ball_spacing": FINER, "element": bs.Element.BILINEAR}, {}, "do not match"),
        *((RIGID, {}, {"steps": steps}, f"steps = {steps:.7g} is not allowed") for steps in (0, 10**6, 2.5)),
        *((RIGID, {}, {"scale": scale}, f"scale = {scale:g} is not allowed") for scale in (0.0, 2.0, np.nan)),
    ],
)
def test_what_no_deck_can_represent_is_refused(joint, settings, wrong, words):
    contact = pressed(joint, **settings)
    with pytest.raises(ValueError, match=words):
        deck_of(contact, **wrong)


@pytest.mark.long
def test_meshes_that_do_not_match_need_a_large_scale():
    contact = pressed(STEEL, ball_spacing=FINER)
    assert Read(deck_of(contact).text()).heads("*STEP")
    with pytest.raises(ValueError, match="larger scale"):
        deck_of(contact, scale=1e-4)


def test_a_written_deck_has_its_expected_results_beside_it(tmp_path):
    made = deck_of(pressed(RIGID), steps=2)
    path = made.write(tmp_path / "new")
    assert sorted(os.listdir(path.parent)) == ["ballsocket.inp", "expected.json"]
    assert path.read_text() == made.text()
    told = json.loads((path.parent / "expected.json").read_text())
    assert [step["force"] for step in told["steps"]] == pytest.approx(made.expected["force"].tolist())
    assert told["bore"]["node"] == Read(made.text()).set("BORE")


def test_the_end_of_each_step_is_read_and_contact_pressures_are_separated_from_other_results(tmp_path):
    path = tmp_path / "a.dat"
    rows = (
        *(("PUSHED", 0.5, "0.1 -0.5 0.0"), ("PUSHED", 1.0, "0.1 -1.0 0.0")),
        ("BORE", 1.0, "7 1.0E-06 -2.0E-06 0.0\n        12 3.0E-06 -4.0E-06 0.0"),
        *(("PUSHED", 1.999999, "0.1 -3.0 0.0"), ("PUSHED", 2.0, "0.1 -2.0 0.0"), ("PUSHED", 2.7, "0.1 -7.0 0.0")),
    )
    head = " total force (fx,fy,fz) for set {} and time  {:.7E}\n\n        {}\n\n"
    path.write_text("\n" + "".join(head.format(*row) for row in rows))
    forces = ccx.read_printed(path, "PUSHED")
    assert {step: rows[0, 1] for step, rows in forces.items()} == {0: -1.0, 1: -2.0}
    np.testing.assert_array_equal(ccx.read_printed(path, "BORE")[0][:, 0], [7, 12])
    assert ccx.read_printed(tmp_path / "none.dat", "PUSHED") == {}
    numbers = "".join(f"{value:12.5E}" for value in (-1.0, 2.0, 3.0, 4.5, -0.5, 0.0))
    block = "  100CL  101 {}           9                     0    1           1\n -4  {}       6    1\n"
    block += f" -5  ONE         1    4    1    1\n -1{7:10d}{numbers}\n -3\n"
    path, heads = tmp_path / "a.frd", ((1.0, "DISP   "), (1.0, "CONTACT"), (2.0, "DISP   "))
    path.write_text("".join(block.format(*head) for head in heads))
    assert ccx.read_contact_pressures(path) == {0: {7: 4.5}}


def test_the_edge_is_extrapolated_from_five_nodes_behind_the_smeared_ones():
    """Pressures are smeared over the two nodes beyond the edge, and far nodes do not follow the power law."""
    angle = np.linspace(0.0, 1.0, 101)
    gap = np.where(angle < 0.5, 0.0, 3.0 * np.clip(angle - 0.482, 0.0, None) ** 1.5)
    gap[50:52] *= 3.0
    gap[57:] *= 2.0
    assert ccx.edge_angle(angle, gap) == pytest.approx(0.482, abs=1e-9)
    assert ccx.edge_angle(angle, 0.0 * angle) == angle[-1]
    last_two = np.append(np.zeros(99), [0.01, 0.02])
    assert 0.9 < ccx.edge_angle(angle, last_two) <= 1.0


@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_gap_between_the_displaced_surfaces_is_computed_in_both_directions(scale):
    """The ball moves down by d, the bore follows it radially where they touch and shrinks sideways elsewhere."""
    angle, clearance, d = np.array([0.0, 0.4, 0.9, 1.5]), 0.1, 0.05
    imposed = d * np.cos(angle) - clearance * (1 - np.cos(angle))
    moved = np.array([imposed[0], imposed[1], -0.02, -0.03])  # outwards along the radius
    nodes = [3, 5, 8, 9]
    bore = np.column_stack([nodes, scale * moved * np.sin(angle), -scale * moved * np.cos(angle)])
    ball = np.column_stack([[11, 12], [0.0, 0.0], [-scale * d, -scale * d]])
    deck = {"bore": {"node": nodes, "angle": angle.tolist()}, "round": {"node": [11, 12], "angle": [0.0, 1.6]}}
    deck |= {"joint": {"clearance": clearance}, "scale": scale}
    indentation, gap = ccx.indentation_and_gap(deck, bore[::-1], ball)
    assert indentation == pytest.approx(d)
    assert gap == pytest.approx(moved - imposed, abs=1e-12)


def test_the_pole_pressure_excludes_the_neighbouring_nodes():
    angle = np.linspace(0.0, 1.0, 60)
    pressures = 10.0 - 4.0 * angle**2 + angle**4
    pressures[:6] = (0.0, 0.0, 24.0, 15.0, 9.0, 11.0)
    pressures[angle > 0.8] = 77.0
    assert ccx.pressure_at_pole(angle, pressures, 1.0) == pytest.approx(10.0, rel=1e-6)
    coarse = np.linspace(0.0, 1.0, 9)
    assert ccx.pressure_at_pole(coarse, 7.0 - 3.0 * coarse**2, 1.0) == pytest.approx(7.0, rel=1e-9)


def test_a_missing_calculix_is_reported(tmp_path, monkeypatch):
    deck_of(pressed(RIGID)).write(tmp_path)
    monkeypatch.setattr(shutil, "which", lambda _: None)
    with pytest.raises(FileNotFoundError, match="CalculiX is not installed"):
        ccx.run(tmp_path)


@needs_ccx
def test_a_missing_and_an_invalid_deck_are_reported(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"no ballsocket\.inp"):
        ccx.run(tmp_path)
    path = deck_of(pressed(RIGID), steps=1).write(tmp_path)
    path.write_text(path.read_text().replace("INTERACTION=TOUCH", "INTERACTION=UNKNOWN"))
    with pytest.raises(RuntimeError, match="before the first step.*ERROR"):
        ccx.run(tmp_path)


@pytest.mark.long
@needs_ccx
def test_results_of_an_earlier_run_are_not_read(tmp_path, monkeypatch):
    deck_of(pressed(RIGID), steps=1).write(tmp_path)
    assert ccx.run(tmp_path).force[0] > 0
    nothing = shutil.which("false")
    monkeypatch.setattr(shutil, "which", lambda _: nothing)
    with pytest.raises(RuntimeError, match="ended with 1"):
        ccx.run(tmp_path)


@pytest.mark.long
@needs_ccx
def test_steps_that_were_not_reached_are_nan(tmp_path):
    made = deck_of(pressed(RIGID), steps=2)
    path = made.write(tmp_path)
    first, last = path.read_text().rsplit("*STATIC\n1., 1.\n", 1)
    path.write_text(f"{first}*STATIC\n1., 1., 1., 1.\n{last.replace('PUSHED, 2, 2, -', 'PUSHED, 2, 2, -1e9')}")
    answer = ccx.run(tmp_path)
    assert answer.force[0] == pytest.approx(made.expected["force"][0], rel=3e-3)
    for name in ("indentation", "force", "pole_pressure", "half_angle"):
        np.testing.assert_array_equal(np.isnan(getattr(answer, name)), [False, True])


@pytest.mark.long
@needs_ccx
@pytest.mark.parametrize(
    ("like", "settings", "tolerance"),
    [
        (RIGID.replace(liner=bs.Material(young=1000.0, poisson=0.49)), {}, 5e-3),
        (STEEL.replace(backing=(TITANIUM,)), {}, 5e-3),
        (RIGID, {"interface": SLIDING}, 5e-3),
        (RIGID.replace(backing=(SOFT,)), {"interface": SLIDING}, 5e-3),
        (RIGID, {"arc": 150.0, "chamfer": 2.0}, 5e-3),
        (FREE, {"arc": 140.0}, 1e-2),  # its pressure is nearly flat
    ],
    ids=["nearly incompressible", "metal-backed", "sliding", "sliding on a backing", "chamfered", "free"],
)
def test_calculix_has_the_expected_results(like, settings, tolerance, tmp_path):
    """Both are on the same coarse mesh; measured: force 0.05 to 0.13 %, half angle 0.07 degrees."""
    made = deck_of(pressed(like, **settings), steps=1)
    made.write(tmp_path)
    answer, expected = ccx.run(tmp_path), made.expected
    np.testing.assert_allclose(answer.indentation, expected["indentation"], rtol=1e-5)
    np.testing.assert_allclose(answer.force, expected["force"], rtol=2e-3)
    np.testing.assert_allclose(answer.pole_pressure, expected["pole_pressure"], rtol=tolerance)
    np.testing.assert_allclose(np.degrees(answer.half_angle), expected["half_angle_deg"], atol=0.15)


@pytest.mark.long
@needs_ccx
def test_the_penalty_reduces_the_force_by_less_than_a_thousandth(tmp_path):
    made = deck_of(pressed(RIGID), steps=1)
    forces = []
    for name, factor in (("own", 1.0), ("stiff", 20.0)):
        path, penalty = made.write(tmp_path / name), made.contact_penalty
        path.write_text(path.read_text().replace(f"\n{penalty:.6g}\n", f"\n{factor * penalty:.6g}\n"))
        forces.append(ccx.run(path.parent).force[0])
    assert 1e-4 < forces[1] / forces[0] - 1 < 1e-3


@needs_ccx
def test_bilinear_facets_give_a_force_only(tmp_path):
    made = deck_of(pressed(RIGID, element=bs.Element.BILINEAR), steps=1)
    made.write(tmp_path)
    answer = ccx.run(tmp_path)
    assert 1.03 < answer.force[0] / made.expected["force"][0] < 1.09  # says the docstring of deck.py
    assert np.isnan([answer.pole_pressure[0], answer.half_angle[0]]).all()
