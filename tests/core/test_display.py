"""Values in notebooks: tables, and figures that show themselves once."""

import sys
from dataclasses import fields
from types import SimpleNamespace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.display import full_repr
from ballsocket.hip import Archard, HipSimulation, iso_14242_1

from ..joints import HIP


def test_tables_of_notebooks_escape_names():
    assert "<b>&lt;b&gt;</b><table>" in HIP.replace(name="<b>")._repr_html_()
    assert bs.catalogue._repr_html_().count("<tr>") == len(bs.catalogue)
    simulation = HipSimulation(joint=HIP, cycle=iso_14242_1(), wear=Archard(coefficient=1e-6))
    assert "Archard(coefficient=1e-06" in simulation._repr_html_()


def test_digests_take_every_number():
    """The full text has every field, in containers and dataclasses as well."""
    text = full_repr([(HIP,), {"a": HIP.liner}])
    assert text.startswith("[(Joint(ball_radius=")
    assert all(f"{field.name}=" in text for field in (*fields(bs.Joint), *fields(bs.Material)))
    assert full_repr(HIP) != full_repr(HIP.replace(clearance=np.nextafter(HIP.clearance, 1.0), name=HIP.name))
    assert full_repr(bs.Cup()) == repr(bs.Cup())


def test_a_figure_is_shown_in_a_notebook_and_hints_to_savefig_elsewhere(monkeypatch):
    figure = bs.HessForsbach().press(HIP, force=3000.0).plot()
    assert figure._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(RuntimeError, match="in notebooks only; write it with figure.savefig"):
        figure.show()
    displayed = []
    notebook = SimpleNamespace(get_ipython=lambda: SimpleNamespace(kernel=None))
    monkeypatch.setitem(sys.modules, "IPython", notebook)
    monkeypatch.setitem(sys.modules, "IPython.display", SimpleNamespace(display=displayed.append))
    figure.show()
    assert displayed == [figure]
