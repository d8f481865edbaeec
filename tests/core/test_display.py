"""Values in terminals and notebooks: one line, tables, and figures that show themselves once."""

import inspect
import re
import sys
from dataclasses import fields
from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.display import full_repr
from ballsocket.dynamics import Flores
from ballsocket.hip import Archard, HipSimulation, iso_14242_1

from ..joints import HIP
from ..places import ROOT

ELEMENT = bs.ForceElement(bs.HessForsbach(), HIP, damping=Flores(restitution=0.8, impact_speed=100.0))
SIMULATION = HipSimulation(joint=bs.joints["hip-28"], cycle=iso_14242_1(), wear=Archard(coefficient=1e-6))
SHOWN = [
    (bs.joints["hip-28"], "<Joint hip-28: R1 14 mm, clearance 0.1 mm, liner 5 mm of UHMWPE"),
    (bs.UHMWPE, "<Material UHMWPE (E 1000 MPa, nu 0.4)>"),
    (bs.Layer(thickness=2.0, material=bs.TITANIUM), "<Layer 2 mm of titanium"),
    (ELEMENT, "<ForceElement hess-forsbach on "),
    (ELEMENT((0.0, 0.0, 0.12)), "<Load force (0, 0, -"),
    (ELEMENT(np.zeros((3, 3))), "<Load of states of shape (3,)>"),
    (SIMULATION, "<HipSimulation of hip-28 under iso-14242-1: Archard, Springs>"),
    (bs.joints, "<9 joints: "),
    (bs.catalogue, "<14 models: "),
]


@pytest.mark.parametrize(("value", "text"), SHOWN, ids=[text[:8] for _, text in SHOWN])
def test_values_are_one_line(value, text):
    assert repr(value).startswith(text)
    assert "\n" not in repr(value) and len(repr(value)) < 300  # noqa: PT018


def test_results_of_a_wear_run_are_one_line_and_a_table():
    history = SIMULATION.after(1e5)
    assert repr(history).startswith("<History of hip-28, 1 report, last after 100000 cycles: 2.9")
    assert repr(history.last).startswith("<Report after 100000 cycles: 2.9")
    assert "\n" not in repr(history) + repr(history.last)
    assert f"<td>{history.last.volume:.4g}</td>" in history._repr_html_()


def test_tables_of_notebooks_escape_names_and_list_numbers():
    hip = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=5.0, liner=bs.UHMWPE, name="<b>")
    assert "<b>&lt;b&gt;</b><table>" in hip._repr_html_()
    assert "<td style='text-align:left'>14 mm</td>" in hip._repr_html_()
    assert "<td style='text-align:left'>0.4</td>" in bs.UHMWPE._repr_html_()
    assert bs.catalogue._repr_html_().count("<tr>") == len(bs.catalogue)
    assert "Archard(coefficient=1e-06" in SIMULATION._repr_html_()


def test_digests_take_every_number():
    """The full text has every field, in containers and dataclasses as well."""
    (text,) = {full_repr([(HIP,), {"a": HIP.liner}])}
    assert text.startswith("[(Joint(ball_radius=")
    assert all(f"{field.name}=" in text for field in (*fields(bs.Joint), *fields(bs.Material)))
    assert full_repr(HIP) != full_repr(HIP.replace(clearance=np.nextafter(HIP.clearance, 1.0), name=HIP.name))
    assert full_repr(bs.Cup()) == repr(bs.Cup())


@pytest.mark.parametrize("magic", [False, True])
def test_a_figure_shows_itself_once(magic):
    """With `%matplotlib inline` the formatter of IPython draws; it goes by the class of matplotlib."""
    figure = bs.HessForsbach().press(HIP, force=3000.0).plot()
    assert figure._repr_png_().startswith(b"\x89PNG")
    formatters = pytest.importorskip("IPython.core.formatters", reason="IPython is not installed")
    from matplotlib.figure import Figure

    formatter = formatters.PNGFormatter()
    if magic:
        formatter.for_type(Figure, lambda figure: b"by the magic")
    assert formatter(figure) == b"by the magic" if magic else formatter(figure).startswith(b"\x89PNG")


def test_a_figure_is_shown_in_a_notebook_and_hints_to_savefig_elsewhere(monkeypatch):
    figure = bs.HessForsbach().press(HIP, force=3000.0).plot()
    with pytest.raises(RuntimeError, match="in notebooks only; write it with figure.savefig"):
        figure.show()
    displayed = []
    notebook = SimpleNamespace(get_ipython=lambda: SimpleNamespace(kernel=None))
    monkeypatch.setitem(sys.modules, "IPython", notebook)
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=displayed.append))
    figure.show()
    assert displayed == [figure]


def test_dir_lists_what_users_call():
    assert set(bs.__all__) <= set(dir(bs))
    assert {"dynamics", "evidence", "export", "hip"} <= set(dir(bs))
    assert not {"Any", "core", "files", "import_module", "models", "problem", "register_plots"} & set(dir(bs))
    assert bs.hip.HipSimulation is HipSimulation
    assert bs.core.display.full_repr is full_repr


@pytest.mark.parametrize("name", sorted({type(model).__name__ for model in bs.catalogue.values()}))
def test_help_of_a_model_shows_how_to_press(name):
    assert f"bs.{name}().press(bs.joints" in inspect.getdoc(getattr(bs, name))


@pytest.mark.parametrize("name", ["HessForsbach", "Vessel", "Bartel", "BondedLayer", "BondedLayerExact", "CosineLimit"])
def test_help_of_a_function_that_makes_a_model_lists_its_methods(name):
    text = inspect.getdoc(getattr(bs, name))
    assert "Notes\n-----\n``press(joint, force=..." in text
    assert f"bs.{name}().press(bs.joints" in text


def test_all_figures_of_reports_show_themselves():
    for path in sorted((ROOT / "src" / "ballsocket" / "reports").glob("*.py")):
        assert not re.search(r"(?<!Notebook)Figure\(figsize", path.read_text("utf-8")), path.name
