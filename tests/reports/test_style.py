"""One model has one line, wherever it is drawn; the report of the paper stands alone, its numbers beside it."""

import csv
import json
from importlib.util import find_spec
from itertools import combinations

import pytest
from matplotlib.colors import to_hex, to_rgb

import ballsocket as bs
from ballsocket.comparison import force_curves
from ballsocket.model_catalogue import JUDGE
from ballsocket.paper import claims, curves
from ballsocket.paper.curves import figure_3_or_4
from ballsocket.paper.plan import ELEMENTS, quick_plan
from ballsocket.reports import accuracy_results, paper_report, style
from ballsocket.reports.paper_report import draw, write_report
from ballsocket.reports.press_plots import press_figure
from ballsocket.reports.style import INK, LineStyle, line_of
from ballsocket.reports.terminal import print_answer

from ..joints import HIP
from ..places import DATA

MODELS = [*bs.catalogue, JUDGE]
PAPERS = [*quick_plan().parts["figure_3"], JUDGE]
"""Those that the paper's figures compare."""


def as_drawn(curve):
    """Colour, and dashes in widths of the line, of a curve of Matplotlib."""
    dashes = curve._unscaled_dash_pattern[1]
    return LineStyle(INK if curve.get_color() == INK else to_hex(curve.get_color()).upper(), tuple(dashes or ()))


def lightness(line):
    """Of a colour in grey: CIE 1931 luminance Y."""
    linear = [share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4 for share in to_rgb(line.colour)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_every_model_has_a_line_of_its_own_that_is_told_apart_in_grey_and_the_exact_one_is_drawn_in_ink():
    assert [name for name in MODELS if line_of(name).colour == INK] == ["exact"]
    lines = [line_of(name) for name in PAPERS]
    assert len({line.colour for line in lines}) == len({line.dash for line in lines}) == len(PAPERS)
    for one, other in combinations(map(line_of, MODELS), 2):
        assert one.dash != other.dash or abs(lightness(one) - lightness(other)) > 0.05, (one, other)


def test_a_model_of_ones_own_keeps_a_line_that_no_other_has():
    assert line_of("our liner") == LineStyle("#009E73", (4.0, 4.0))
    given = {line_of(name) for name in MODELS if name in style._MODELS}
    assert given.isdisjoint(line_of(f"own {number}") for number in range(200))


@pytest.fixture(scope="module")
def contacts():
    return bs.compare(HIP, models={name: bs.catalogue[name] for name in PAPERS[:-1]}, force=3000.0)


@pytest.fixture(scope="module")
def pressed(contacts):
    left, _ = press_figure(contacts, force_curves(contacts, bs.catalogue)).axes
    return {curve.get_label(): as_drawn(curve) for curve in left.lines}


def test_a_curve_of_a_thin_liner_is_short():
    """A hundred loads of one would take minutes: a dozen half angles reach a little beyond the contact."""
    joint = HIP.replace(liner_thickness=HIP.socket_radius / 40)
    own = {name: bs.catalogue[name] for name in ("exact", "hertz")}
    found = bs.compare(joint, models=own, force=3000.0)
    curves = force_curves(found, own)
    assert len(curves["exact"].force) == 12
    assert curves["exact"].force[-1] > 3000.0
    assert len(curves["hertz"].force) > 100


def test_the_papers_figures_draw_a_model_as_the_press_does(contacts, pressed):
    panel = draw(figure_3_or_4(3, {name: bs.catalogue[name] for name in contacts})).axes[1]
    assert [as_drawn(curve) for curve in panel.lines] == list(pressed.values())
    # the exact model stands for the finite elements, whose figure is made in no time
    (curve,) = draw(figure_3_or_4(3, {ELEMENTS: bs.Exact()})).axes[0].lines
    assert (as_drawn(curve).colour, curve.get_marker()) == (line_of(JUDGE).colour, "o")


@pytest.mark.skipif(find_spec("tornado") is None, reason="the explorer's extra is not installed")
def test_the_explorer_draws_a_model_as_the_press_does(pressed):
    from ballsocket.app.session import Page

    page = Page(f"preset=hess-forsbach&shown={','.join(pressed)}")
    page.view.show(page.screen)
    (drawn,) = page.channel.shown_value("#press-charts")
    curves = [curve for chart in drawn["charts"] for curve in chart["curves"]]
    assert {curve["name"] for curve in curves} == set(pressed)
    for curve in curves:
        line = pressed[curve["name"]]
        colour = "var(--text)" if line.colour == INK else line.colour
        assert curve["line"] == [colour, " ".join(f"{2 * length:g}" for length in line.dash)]


ACCURACY = json.loads((DATA / "accuracy.json").read_text(encoding="utf-8"))
EXACT = bs.Exact(tolerance=1e-4)
FEW = {name: bs.catalogue[name] for name in ("hess-forsbach", "exact")}
CLAIMS = [claims.judge(claim, EXACT).summary() for claim in claims.CLAIMS[:6]]
JUDGED = {"about": ["By the solution."], "claims": CLAIMS, "elsewhere": [], "table_3": [], "accuracy": [ACCURACY]}


def read_table(path):
    with path.open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def check_page(path, *texts):
    page = path.read_text(encoding="utf-8")
    assert all(text in page for text in ("src='data:image/png;base64,", *texts))
    assert not any(text in page for text in ("<script", "src='http"))


def test_the_report_stands_alone_and_beside_it_lie_its_numbers(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(paper_report, "_write_picture", lambda *words: b"picture")  # drawn in the long form
    name = "peak pressure, worst, %"
    number = f"{name}: {CLAIMS[0]['numbers'][name]:.3g}<br>"
    check_page(write_report(JUDGED, tmp_path), "does not hold", "holds", "Table 1", claims.SCALE, number)
    print_answer(paper_report.describe_verdicts(JUDGED))
    assert f"{CLAIMS[0]['name']} " in capsys.readouterr().out
    worst = max(read_table(tmp_path / "accuracy.csv"), key=lambda row: float(row["worst"]))
    assert worst["model"] == "cosine-limit"
    assert json.loads((tmp_path / "accuracy.json").read_text(encoding="utf-8")) == ACCURACY
    assert (tmp_path / "accuracy.md").read_text(encoding="utf-8") == accuracy_results.markdown(ACCURACY)


@pytest.mark.long
def test_the_figures_and_tables_of_the_paper_are_in_the_report(tmp_path):
    pieces = quick_plan().parts
    computed = {
        "elsewhere": [pieces["elsewhere"]["half_angles_of_jin"]()],
        "table_3": [pieces["table_3"]["exact 0.4"]()],
        "figure_3": [curves.figure_3_or_4(3, {name: model}).summary() for name, model in FEW.items()],
        "figure_6": [curves.figure_6("hess-forsbach", bs.HessForsbach(), points=7).summary()],
    }
    check_page(write_report({**JUDGED, **computed}, tmp_path), "Figure 3", "Table 3", "hess-forsbach", "Jin")
    assert {row["model"] for row in read_table(tmp_path / "figure_3.csv")} == set(FEW)
    assert (tmp_path / "figure_6.svg").stat().st_size > 5000
