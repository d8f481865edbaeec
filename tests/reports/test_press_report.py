"""One page to send: its inputs, verdict, checks, answers and tolerances are those of the calls."""

import pickle
import re
import shlex
import zlib
from dataclasses import replace
from datetime import date
from hashlib import sha256
from html import unescape
from math import inf, radians
from xml.etree import ElementTree

import pytest

import ballsocket as bs
from ballsocket.contact.verdict import Bounded, Verdict, error_bar, exact_number
from ballsocket.core.unit_systems import Units
from ballsocket.design_checks import assess_strength, checks_at, checks_of, verdict_of, wear_check
from ballsocket.files.joint_file import JointFile, ReportDetails, parse_joint
from ballsocket.reports.joint_drawing import DrawnLoad, gap_factor, joint_svg, largest_drawn, petals
from ballsocket.reports.pages import checks_html, table, write_page
from ballsocket.reports.press_report import PressedDesign, designs_report, press_lede, press_sections
from ballsocket.studies import tolerance
from ballsocket.studies.derivatives import local_uncertainty

from ..cli.command import answer, printed
from ..extent import some

HIP = bs.joints["hip-36"]
FILE = JointFile(joint=HIP, load={"force": 3000.0}, cup=bs.Cup(arc_of_cover=3.0))
TWO = {"exact": bs.Exact(), "hess-forsbach": bs.HessForsbach()}


@pytest.fixture(scope="module")
def pages():
    comparison = bs.compare(HIP, models=TWO, cup=FILE.cup, force=3000.0)
    near = local_uncertainty(HIP, FILE.cup, FILE.load, {"clearance": tolerance(0.1, 0.03)})
    design = PressedDesign(comparison=comparison, file=FILE, leading="exact", uncertainty=near)
    return {units: designs_report([design], units, date(2026, 1, 2)) for units in Units}, near


def test_the_page_has_the_verdict_the_drawing_and_every_input_in_the_units_that_are_chosen(pages):
    text = unescape(pages[0][Units.SI])
    assert re.search(r"<strong>11\.1\d MPa</strong> largest pressure under 3000 N, by the model exact", text)
    assert re.search(r"Kept: reach of the contact is \d+ % of the arc from pole to rim, the highest ratio", text)
    for cell in ("36 mm", "36.2 mm", "0.2 mm", "5 mm", "171.9°", "Young's modulus 750 MPa", "2026-01-02"):
        assert cell in text, cell
    assert text.count("data:image/svg+xml;base64,") == 2
    assert text.index("<h2 id='checks'>") < text.index("<h2 id='drawing'>")
    assert bs.materials["crosslinked-pe"].source in text
    imperial = unescape(pages[0][Units.IMPERIAL])
    assert re.search(r"<strong>16[12]\d psi</strong> largest pressure under 674.4 lbf", imperial)
    assert "1.417 in" in imperial
    assert not re.search(r"\d (mm|MPa|N)\b", imperial.split("<h2 id='origin'>")[0].split("<h2 id='inputs'>")[1])


def test_one_verdict_is_about_all_checks():
    """A contact far below its strengths that ends at the rim fails, and no green sentence stands beside it."""
    contact = bs.HessForsbach().press(HIP, force=3000.0)
    wide, narrow = (unescape(press_lede(contact, bs.Cup(arc_of_cover=arc))) for arc in (3.0, 1.0))
    share = f"{100 * contact.half_angle / 1.5:.0f} %"
    assert f"<span class='holds'>Kept: reach of the contact is {share} of the arc from pole to rim" in wide
    assert re.search(r"class='fails'>Exceeded: reach of the contact is [\d.]+ times the arc from pole to rim", narrow)
    assert "holds" not in narrow
    results = press_sections(bs.compare(HIP, models=TWO, force=3000.0))["answers"][1]
    estimate = f"{100 * contact.utilisation:.0f} %"
    assert re.search(rf"exact kept, \d+ %; hess-forsbach kept, an estimated {estimate} \(\d+ to \d+ %\)", results)


def test_heads_that_differ_stand_with_their_design(tmp_path, monkeypatch):
    monkeypatch.setattr("ballsocket.reports.press_report.svg_address", lambda figure: "data:")  # drawn in another test
    comparison = bs.compare(HIP, models=TWO, force=3000.0)

    def page(*heads):
        named = {f"cup {number}": ReportDetails(**head) for number, head in enumerate(heads, 1)}
        files = [replace(FILE, joint=HIP.replace(name=name), report=head) for name, head in named.items()]
        return designs_report([PressedDesign(comparison=comparison, file=file, leading="exact") for file in files])

    differing = page({"customer": "Acme", "author": "A. B."}, {"customer": "Other", "author": "A. B."})
    assert differing.index("id='comparison'") < differing.index("id='design-1'") < differing.index("id='design-2'")
    assert "Acme (cup 1), Other (cup 2)" in differing
    assert all(f"<th>cup {number}</th>" in differing for number in (1, 2))
    assert "A. B. (" not in differing
    assert "<meta name='author' content='A. B.'>" in differing
    logos = [tmp_path / name for name in ("one.svg", "two.svg")]
    for logo in logos:
        logo.write_text(f"<svg xmlns='http://www.w3.org/2000/svg' id='{logo.stem}'></svg>")
    with pytest.raises(ValueError, match="different logos"):
        page(*({"logo": str(logo)} for logo in logos))


def recipe_of(page):
    """Return the joint file on a page, and the options of the command behind it."""
    text = unescape(page)
    command = re.search(r"ballsocket press again.toml ?([^<]*)</code>", text)[1]
    return re.search(r"<pre>(.*)</pre>", text, flags=re.DOTALL)[1], shlex.split(command)


def test_a_page_loads_nothing_and_has_the_joint_file_of_its_checksum(pages):
    for page in pages[0].values():
        assert not re.search(r"(src|href)='(?!data:|#)|localhost|/home", page)
        recipe, _ = recipe_of(page)
        assert sha256(recipe.encode()).hexdigest() in page
        assert parse_joint(recipe.encode(), "again.toml") == FILE


CUP = """
name = "cup <52>"
joint = {head_diameter = "36 mm", diametral_clearance = "0.3 mm", liner_thickness = "6.5 mm"}
liner = {material = "crosslinked-pe", allowable_pressure = "20 MPa"}
ball = {material = "cocr"}
backing = [{material = "titanium", thickness = "1.35 mm"}]
cup = {inclination = "50 deg", anteversion = "20 deg"}
load = {force = "2.5 kN"}
report = {customer = "<b>Bones</b> & Sons", logo = "logo.svg"}
"""
TILTED = ("--ring-width", "6 deg", "--tolerance", "inclination=50+-6 deg")


@pytest.fixture(scope="module")
def tilted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tilted")
    (folder / "cup.toml").write_text(CUP)
    (folder / "logo.svg").write_text("<svg xmlns='http://www.w3.org/2000/svg'></svg>")
    return folder, answer("press", str(folder / "cup.toml"), *TILTED, "--report", str(folder / "cup.html"))


def test_the_joint_file_of_a_report_computes_the_same_numbers(tilted):
    """Of a tilted cup with a shell: the text on the page, pressed with the options beside it."""
    folder, numbers = tilted
    recipe, options = recipe_of((folder / "cup.html").read_text("utf-8"))
    (folder / "again.toml").write_text(recipe, encoding="utf-8")
    assert "--report" in options  # tolerances are for a report
    options[options.index("--report") + 1] = str(folder / "again.html")
    assert answer("press", str(folder / "again.toml"), *options) == numbers
    assert recipe_of((folder / "again.html").read_text("utf-8"))[0] == recipe


def test_the_report_of_a_tilted_cup_has_its_head_the_place_of_the_contact_and_tolerances(tilted):
    folder, numbers = tilted
    text = (folder / "cup.html").read_text("utf-8")
    assert "<dd>&lt;b&gt;Bones&lt;/b&gt; &amp; Sons</dd>" in text
    assert "<h1>cup &lt;52&gt;</h1>" in text
    assert "backing 1</td><td>1.35 mm of titanium" in text
    assert "class='logo' alt='logo' src='data:image/svg+xml;base64," in text
    contact = next(row for row in numbers["results"] if row["model"] == "sphere")
    assert f"{contact['edge_distance']:.1f} mm from the rim (CPER)" in text
    assert f"<td>{contact['rim_distance']:.1f} mm</td><td>arc on the bore from the direction of the load" in text
    assert "in which the ball pushes into the cup, in the body: straight up" in unescape(text)
    assert "From 3 presses by sphere" in text
    assert "largest over allowable pressure pmax/pa" in text
    assert numbers["design_verdict"]["reason"].partition(";")[0] in unescape(text)


@pytest.mark.long
def test_designs_are_compared_on_one_page_in_inches_and_pounds(tilted):
    folder, _ = tilted
    words = ("--force", "2 kN", "--units", "imperial", "--ring-width", "6 deg", "--report", str(folder / "both.html"))
    both = printed("press", str(folder / "cup.toml"), str(folder / "cup.toml"), *words)
    text = (folder / "both.html").read_text("utf-8")
    assert text.count("<td>449.6 lbf</td>") >= 2
    quoted = re.sub(r"<pre>.*?</pre>|" + re.escape(bs.TITANIUM.source), "", unescape(text), flags=re.DOTALL)
    for part in (both, quoted):
        assert re.findall(r"\d (?:mm|µm|MPa|N)\b", part) == []


@pytest.mark.parametrize(("paper", "width"), some([("letter", 612), ("A4", 595)], 1))
def test_a_page_is_printed_as_pdf(tmp_path, paper, width):
    try:
        import weasyprint  # noqa: F401
    except (ImportError, OSError):  # without the library Pango
        pytest.skip("WeasyPrint cannot be imported")
    write_page(table(["head"], [["cell"]]), path := tmp_path / "a.pdf", paper)
    streams = re.findall(rb"stream\r?\n(.*?)endstream", path.read_bytes(), flags=re.DOTALL)
    text = b"".join([path.read_bytes(), *(zlib.decompressobj().decompress(part) for part in streams)])
    assert round(float(re.search(rb"/MediaBox ?\[ ?0 0 ([\d.]+)", text)[1])) == width  # in points


def test_what_a_percent_does_is_the_slope_and_the_band_of_a_tolerance_holds_the_ends_of_the_clearance(pages):
    more, less = (bs.Tabulated().press(HIP, force=force).max_pressure for force in (3000.0 * 1.01, 3000.0 / 1.01))
    assert pages[1].changes["max_pressure"]["force"] == pytest.approx((more / less - 1) / 0.02, rel=2e-2)
    # one number that scatters normally ends at 1.96 deviations, a third of 0.03 mm each
    ends = [bs.Tabulated().press(replace(HIP, clearance=c), force=3e3).max_pressure for c in (0.0804, 0.1, 0.1196)]
    assert list(pages[1].band["max_pressure"]) == pytest.approx(ends, rel=2e-3)


def test_a_clearance_is_drawn_so_wide_that_it_can_be_seen():
    assert gap_factor(HIP) == 10.0
    assert gap_factor(bs.Joint(ball_radius=10.0, clearance=1.0, liner_thickness=5.0, liner=bs.POM)) == 1.0
    assert {"head", "⌀ 36 mm", "bore", "⌀ 36.2 mm", "outside", "⌀ 46.2 mm"} <= drawn_texts(joint_svg(FILE))
    gap = {"clearance", "⌀ 0.2 mm", "drawn × 10"}
    assert {"liner", "5 mm", "cross-linked UHMWPE", *gap} <= drawn_texts(joint_svg(FILE))
    contact = bs.HessForsbach().press(HIP, force=3000.0)
    loaded = joint_svg(FILE, contact, float(contact.half_angle), DrawnLoad(text="674.4 lbf"), Units.IMPERIAL)
    assert {"⌀ 1.417 in", "674.4 lbf"} <= drawn_texts(loaded)


def test_the_pressure_under_a_sharp_rim_is_drawn_up_to_the_largest_beside_it():
    cup = bs.Cup(chamfer=1.0)
    contact = bs.Sphere(cup=cup, ring_width=radians(5)).press(HIP, force=3000.0, tilt=1.1)
    assert contact.max_pressure == inf
    radii, _, pressures = petals(JointFile(HIP, {}, cup), contact)
    highest = 0.45 * float(HIP.liner_thickness)  # of the drawing
    assert radii.max() - float(HIP.socket_radius) == pytest.approx(highest)
    assert 0 < largest_drawn(contact) <= pressures.max() < inf


def test_the_position_in_the_cup_is_that_of_the_contact_of_the_design():
    models = {name: bs.Sphere(ring_width=radians(width)) for name, width in (("fine", 4), ("coarse", 6))}
    comparison = bs.compare(HIP, models=models, force=3000.0, tilt=0.5)
    position = {
        name: press_sections(comparison, leading=contact)["position"][1]
        for name, contact in comparison.contacts.items()
    }
    page = {name: designs_report([PressedDesign(comparison=comparison, file=FILE, leading=name)]) for name in models}
    for name, other in (("fine", "coarse"), ("coarse", "fine")):
        assert position[name] in page[name]
        assert position[name] not in page[other]


def drawn_texts(drawing):
    return {text.text for text in ElementTree.fromstring(drawing).iter("{http://www.w3.org/2000/svg}text")}


ABOVE = "--ball-radius 10 --interference 0.01 --liner-thickness 3 --liner pom"
"""An interference lifts the ball out of a hemisphere: its indentation is below 0."""


@pytest.mark.long
@pytest.mark.parametrize(("joint", "sentence"), [("hip-36 --tilt 30deg", "<td>30°</td>"), (ABOVE, "500 N")])
def test_a_tilted_load_and_a_ball_above_its_first_touch_are_drawn_in_the_cup(tmp_path, joint, sentence):
    words = ("--ring-width", "5 deg", "--figure", str(tmp_path / "a.png"), "--report", str(tmp_path / "a.html"))
    printed("press", *joint.split(), "--force", "500 N", *words)
    assert (tmp_path / "a.png").stat().st_size > 1000
    text = unescape((tmp_path / "a.html").read_text("utf-8"))
    assert "under 500 N, by the model sphere" in text
    assert sentence in text


HIP_28, DEFAULT, UNDECIDED = bs.joints["hip-28"], bs.Cup(), Verdict.UNDECIDED
WRITE = Units.SI.text_of


def liner(**strengths):
    return replace(HIP_28, liner=bs.Material(young=1000.0, poisson=0.4, **strengths), ball=None)


def by_title(rows):
    return {row.title: row for row in rows}


def test_pressure_and_von_mises_stress_have_rows_of_their_own():
    contact = bs.Exact().press(HIP_28, force=3000.0)
    rows = by_title(checks_of(contact, DEFAULT, contact.von_mises))
    liner_stress, pressure = rows["von Mises stress in the liner"], rows["pressure on the liner"]
    assert (liner_stress.demand.value, liner_stress.capacity) == (contact.von_mises, 21.0)
    assert liner_stress.ratio.value == pytest.approx(contact.utilisation)
    assert liner_stress.source == "UHMWPE, yield: least of ASTM F648 type 1 (unverified)"
    assert (pressure.demand.value, pressure.capacity, pressure.verdict) == (contact.max_pressure, None, UNDECIDED)
    assert pressure.source == "no allowable pressure of the liner is known"
    assert rows["von Mises stress in the ball"].capacity == HIP_28.ball.yield_stress


@pytest.mark.parametrize("force", [300.0, 3000.0, 12000.0, 30e3])
@pytest.mark.parametrize("strengths", [{}, {"allowable_pressure": 20.0}, {"yield_stress": 21.0}])
def test_the_verdict_is_that_of_the_strength_alone_where_the_rim_is_far(strengths, force):
    contact = bs.Exact().press(liner(**strengths), force=force)
    rows = checks_of(contact, bs.Cup(arc_of_cover=radians(340.0)), contact.von_mises)
    assert verdict_of(rows)[0] is assess_strength(contact).verdict


@pytest.mark.parametrize(("share", "is_near"), [(0.95, True), (0.85, False)])
def test_a_limit_that_is_kept_above_ninety_percent_is_near_in_its_row_in_words_and_in_style(share, is_near):
    pressure = float(bs.Exact().press(liner(), force=3000.0).max_pressure)
    rows = checks_of(bs.Exact().press(liner(allowable_pressure=pressure / share), force=3000.0), DEFAULT)
    verdict, sentence = verdict_of(rows)
    assert verdict is Verdict.KEPT
    assert sentence.startswith("Kept, near the limit: ") is is_near
    assert rows[0].result == ("✓ kept, near the limit" if is_near else "✓ kept")
    assert ("class='near'" in checks_html(rows, WRITE)) is is_near


def test_a_contact_outside_the_range_of_its_model_has_no_verdict_but_may_fail():
    doubtful = bs.Hertz().press(liner(allowable_pressure=1e3), force=3000.0)
    reason = "Undecided: this result is outside the range of its model"
    assert verdict_of(checks_of(doubtful, DEFAULT)) == (UNDECIDED, reason)
    overloaded = bs.Hertz().press(liner(allowable_pressure=4.0), force=3000.0)
    verdict, sentence = verdict_of(checks_of(overloaded, DEFAULT))
    assert verdict is Verdict.EXCEEDED
    assert "the allowable pressure" in sentence


@pytest.mark.parametrize("tilt", [0.0, 45.0, 75.0])
def test_the_row_of_the_rim_fails_where_the_contact_is_edge_loaded(tilt):
    contact = bs.Sphere(ring_width=radians(4.0)).press(HIP_28, force=3000.0, tilt=radians(tilt))
    row = by_title(checks_of(contact, DEFAULT))["reach of the contact"]
    assert row.verdict is (Verdict.EXCEEDED if contact.edge_loaded else Verdict.KEPT)
    assert row.capacity - row.demand.value == pytest.approx(contact.edge_distance)


def test_numbers_of_a_worn_bore_give_the_rows_of_a_contact_but_for_that_of_the_rim_in_a_preloaded_joint():
    contact = bs.Exact().press(HIP_28, force=3000.0)
    distance = HIP_28.socket_radius * (DEFAULT.rim - contact.half_angle)
    pressure, von_mises = (error_bar(contact, name) for name in ("max_pressure", "von_mises"))
    rows = checks_at(HIP_28, pressure=pressure, von_mises=von_mises, edge=(DEFAULT.rim, exact_number(distance)))
    same = checks_of(contact, DEFAULT, contact.von_mises)
    assert [(row.title, row.verdict) for row in rows] == [(row.title, row.verdict) for row in same]
    assert pickle.loads(pickle.dumps(rows)) == rows
    depths = Bounded(0.5, 0.4, 0.6), Bounded(5.0, 4.9, 5.1), Bounded(6.0, 5.9, 6.1)
    assert [wear_check(HIP_28, depth).verdict.word for depth in depths] == ["kept", "undecided", "exceeded"]
    joint = bs.Joint(ball_radius=14.0, interference=0.05, liner_thickness=5.0, liner=bs.UHMWPE)
    rows = checks_at(joint, pressure=exact_number(5.0), von_mises=exact_number(3.0), edge=(1.5, exact_number(-0.1)))
    assert "reach of the contact" not in by_title(rows)


def test_a_failure_stands_first_and_has_a_sign_a_word_and_a_style():
    contact = bs.Exact().press(liner(allowable_pressure=10.0, yield_stress=21.0), force=3000.0)
    html = checks_html(checks_of(contact, DEFAULT), WRITE)
    assert html.index("✗ exceeded") < html.index("✓ kept")
    pressure = f"<td>{contact.max_pressure:.4g} MPa</td>"
    assert f"<tr class='exceeded'><th scope='row'>pressure on the liner</th>{pressure}" in html
    assert f"{10 * contact.max_pressure:.0f} %" in html
    assert "psi" in checks_html(checks_of(contact, DEFAULT), Units.IMPERIAL.text_of)


@pytest.mark.long
def test_a_force_beyond_the_collapse_load_is_exceeded_as_in_the_terminal():
    hip = bs.joints["hip-28"]
    soft = hip.replace(liner=replace(hip.liner, hardening=bs.Hardening(stress=(12.0,))))
    collapsed = bs.FiniteElement(plastic=True, meshes=1).press(soft, force=4e4)
    assert collapsed.status.failed
    assert "Exceeded: normal force is 1.6" in press_lede(collapsed, bs.Cup())
