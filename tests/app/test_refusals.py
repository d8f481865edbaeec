"""Values that no input takes: each is refused in a sentence, and the screen stays."""

import pytest

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
pytest.importorskip("tomli_w")
from ballsocket.app import session
from ballsocket.app.jobs import Job
from ballsocket.app.session import Page

from .asking import does, edits, refuses, trouble

MAP = "view=map&preset=hip-28&load.force=3000&across=ball_radius=11..23"
HUGE = 10**400
WALK = "phase [%], force [N], flexion [deg]\n0, 300, 20\n25, 2000, 0\n100, 300, 20\n"


@pytest.mark.parametrize(
    ("link", "name", "value", "sentence"),
    [
        ("", "load", "3,000", "Normal force '3,000' could be two numbers: write 3000 or 3.000"),
        ("", "load", "much", "Normal force must be a number in N, or a force such as '3 kN', got 'much'"),
        ("", "load", HUGE, "the integer is too large"),
        ("", "tilt", -HUGE, "the integer is too large"),
        ("", "liner_poisson", "0,7", "Liner Poisson's ratio must be -0.999 to 0.5 (the limits of an isotropic solid)"),
        ("", "clearance", None, "Diametral clearance must be a number in mm, or a length such as '16 mm', got None"),
        ("", "clearence", "1", "'clearence' among the inputs is not known"),
        ("", "liner", 3, "liner = 3 is not a material"),
        ("", "preset", "hip-29", "'hip-29' as preset is not known"),
        ("", "preset", {}, "as preset is not known"),
        ("", "kind", ["force"], "as load is not known"),
        ("", "massive", "yes", "must be true or false"),
        ("", "layer" + "9" * 5000, 1, "among the inputs is not known"),
        ("", "behind.add", ["uhmwpe"], "as material is not known"),
        ("", "behind.add", "cheese", "'cheese' as material is not known"),
        ("", "behind.0", "titanium", "'0' among the layers is not known"),
        ("", "behind.support", "loose", "'loose' as support is not known"),
        ("", "designs.compare", [""] * 9, "at most 6 designs"),
        ("view=compare", "compare.x", 1, "among the inputs of Compare is not known"),
        (MAP, "map.pick", [HUGE, 1], "the integer is too large"),
        (f"{MAP}&limit=max_pressure<=12&up=outer_radius=15..30", "map.drag", [0, 22.0, 16.0], "<p"),
        (f"{MAP}&limit=max_pressure<=12", "map.drag", [0, 1], "<p"),
        (f"{MAP}&limit=max_pressure<=12", "map.drag", "elsewhere", "<p"),
        (f"{MAP}&limit=max_pressure<=12", "map.drag", [7, 20.0, 8.0], "<p"),
        (MAP, "map.limits", "outer_radius<=26", "<p"),
        (MAP, "map.limits", [["outer_radius", "<="]], "<p"),
        (MAP, "map.limits", [["frob", "<=", "3"]], "<p"),
        (MAP, "map.limits", [["force", "=", "3"]], "<p"),
        ("view=wear", "wear.coefficient", "much", "coefficient = 'much'"),
        ("view=wear", "wear.coefficient", "-1", "Coefficient [mm³/(N m)] -1 is not allowed"),
        ("view=wear", "wear.millions", "0", "Million cycles 0"),
        ("view=wear", "wear.spread", "0.5", "Patient-to-patient factor 0.5"),
        ("view=wear", "wear.law", "magic", "'magic' as law is not known"),
        ("view=wear", "wear.creep", True, "creep = True is not a choice"),
        ("view=wear", "wear.beside", "my hip", "'my hip' as design is not known"),
        ("view=wear", "wear.colour", "red", "'colour' among the inputs of Wear"),
        (
            "view=cup",
            "cup.inclination",
            "91",
            "Inclination must be 0 to 90° (from an upright axis to a level one), got",
        ),
        (
            "view=cup",
            "cup.arc_of_cover",
            "0",
            "Arc of cover must be 40 to 340° (the ball must stay in its socket), got",
        ),
        ("view=cup", "cup.inwards", "85", "Load direction, medial must be -80 to 80° (the load must press into the"),
        ("view=cup", "cup.chamfer", "wide", "Chamfer must be a number in mm, or a length such as '16 mm', got 'wide'"),
        ("view=cup", "cup.side", "middle", "side = 'middle' is not allowed"),
        ("view=cup", "cup.aim", "up", "'up' as aim is not known"),
        ("view=cup", "cup.pick", [1.0], "is not a point of the map"),
        ("view=cup", "cup.pick", [1, HUGE], "the integer is too large"),
        ("view=cup", "cup.show", "area", "'area' as standing is not known"),
        ("view=cup", "cup.colour", "red", "'colour' among the inputs of a cup"),
        ("view=gait", "gait.cycle", "dancing", "'dancing' as cycle is not known"),
        ("view=gait", "gait.body_weight", "0", "Body weight must be positive, got 0 N"),
        ("view=gait", "gait.contact", "steel", "'steel' as contact is not known"),
        ("view=gait", "gait.instant", "seven", "an instant of a cycle is a whole number"),
        ("view=gait", "gait.instant", -1, "instant = -1"),
        ("view=gait", "gait.own", {"name": "walk.exe", "text": WALK}, "'walk.exe' is not a table of a cycle"),
        ("view=gait", "gait.own", {"name": "a.csv", "text": "", "size": 10**9}, "longer than 100000 characters"),
        ("view=gait", "gait.own", "walk.csv", "has a name and a text"),
        ("view=gait", "gait.colour", "red", "'colour' among the inputs of Gait"),
        ("view=evidence", "evidence.influence", "huge", "influence"),
        ("view=evidence", "evidence.elements", True, "elements"),
        ("view=evidence", "evidence.colour", "red", "colour"),
    ],
    ids=lambda value: str(value)[-20:],
)
def test_a_value_that_no_input_takes_gets_one_sentence_and_stays_in_its_box(monkeypatch, link, name, value, sentence):
    monkeypatch.setattr(Job, "ask", lambda *words: None)
    page = Page(link)
    link = page.screen.link
    assert refuses(page, name, value, sentence)
    assert page.screen.link == link
    edits(page, name, (page.channel.shown_value(f"={name}") or {}).get("text"))  # the box as it was
    edits(page, "load", 2900)
    assert page.screen.file.load["force"] == 2900


@pytest.mark.parametrize(
    ("pairs", "sentence"),
    [
        ("use.cycle=dance", "'dance' as cycle"),
        ("use.body_weight=-1", "body_weight = -1"),
        ("use.coefficient=-1", "coefficient = -1"),
        ("use.millions=1000", "millions = 1000"),
        ("use.speed=1", "'speed' of a hip in use in the link"),
        *((f"use.instant={number}", "instant = ") for number in ("inf", "nan", "1e400", "2.5", "-1")),
        ("joint.ball_radiuss=3", "'ball_radiuss' in [joint] is not known; did you mean 'ball_radius'?"),
    ],
)
def test_a_link_that_cannot_be_read_says_so_and_the_page_goes_on(pairs, sentence, caplog):
    page = Page(f"view=gait&{pairs}")
    assert "This link cannot be read: " in trouble(page)
    assert sentence.replace("'", "&#x27;") in trouble(page).replace("&#39;", "&#x27;")
    assert not caplog.records
    edits(page, "load", 2900)
    assert page.screen.file.load == {"force": 2900}


def test_a_word_that_no_page_of_ours_knows_is_refused():
    page = Page("")
    for words in ({"what": "leave"}, {"what": "choose", "name": "theme", "value": "dark"}):
        does(page, words.pop("what"), **words)
        assert "is not known" in trouble(page)
    does(page, "choose", name="shown", value="exact")
    assert "shown takes words" in trouble(page)
    assert page.screen == Page("").screen


def test_designs_are_counted_before_they_are_read(monkeypatch):
    """Seventy thousand links took the time of all users for seconds."""
    page, reads = Page(""), []
    monkeypatch.setattr(session, "read_link", reads.append)
    edits(page, "designs.compare", [""] * 70_000)
    assert not reads
    assert "at most 6 designs" in trouble(page)
