"""Hips, histories and files that the tests of this folder share; equal ones are made and solved once."""

import json
from dataclasses import replace
from functools import cache
from math import radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import Archard, HipSimulation, iso_14242_1
from ballsocket.hip.simulation import make_report
from ballsocket.hip.wear_integrator import WearIntegrator

from ..places import DATA, EXAMPLES

INDEPENDENT = json.loads((DATA / "wear.json").read_text(encoding="utf-8"))
"""Results of another program."""

K = INDEPENDENT["inputs"]["wear_factor"]
TILTED = bs.Cup(inclination=radians(30.0))
WALK = iso_14242_1(72)
QUICK = {"cycle": iso_14242_1(16), "ring_width": radians(8.0)}
"""Few steps and wide rings, for facts that hold on any grid."""

TEXT = (EXAMPLES / "hip_in_use.toml").read_text(encoding="utf-8")
CYCLE = TEXT[TEXT.index("[cycle]") : TEXT.index("[wear]")]
COUNTS = "cycles = 5e6\nreport_at = [1e6, 2e6, 5e6]\n"
SHORT = (
    ("cycles = 5e6\nreport_at = [1e6, 2e6, 5e6]", "cycles = 1e4\nreport_at = [5e3]"),
    ("instants = 100", "instants = 16"),
    ('contact = "springs"', 'ring_width = "8 deg"'),
)
"""Changes of the example to few cycles, instants and rings."""

UNCERTAINTY = """[uncertainty]
coefficient = { median = "1.066e-6 mm^3/(N m)", factor = 1.5 }
clearance = { low = "0.05 mm", high = "0.2 mm" }
"""
WEAR_DATA = '[[data]]\nquantity = "volume"\nvalues = "38 mm^3/Mc"\nrate = "mean"\nto = 2e5\nuncertainty = "10 %"\n'


def hip(diameter=28.0, liner=8.0, clearance=0.1, **words):
    """Return a hip of another program's material; equal arguments give the same object."""
    oriented = getattr(words.get("cup"), "oriented", None)  # equal cups differ where only one has stated angles
    try:
        return _cached_hip(oriented, diameter, liner, clearance, *words.items())
    except TypeError:  # an argument without a hash
        return _make_hip(diameter, liner, clearance, *words.items())


def _make_hip(diameter, liner, clearance, *words):
    material = bs.Material(young=INDEPENDENT["inputs"]["young"], poisson=INDEPENDENT["inputs"]["poisson"])
    joint = bs.Joint(ball_radius=diameter / 2, clearance=clearance, liner_thickness=liner, liner=material)
    usual = {"cycle": WALK, "wear": Archard(coefficient=K), "cup": TILTED}
    return HipSimulation(joint=joint, **(usual | dict(words)))


@cache
def _cached_hip(oriented, *arguments):
    return _make_hip(*arguments)


@cache
def history(use, cycles, *report_at):
    return use.after(cycles, report_at)


@cache
def report_after(use, cycles):
    """Return the last report of a run, without the solutions on finer grids that estimate its error."""
    return make_report(WearIntegrator(setup=use).run_until(cycles, lambda count: None))


def walked(first, later):
    """ISO's cycle with another force: `first` in its first half, `later` in its second."""
    walk = iso_14242_1()
    return replace(walk, force=lambda t: np.where(t < 0.5, first, later), cup_tilt=None)


def socket_force(foundation, equilibrium):
    return np.einsum("tp,kp,p->tk", equilibrium.pressure, foundation.normals, foundation.areas)


def write_edited_file(path, *changes, text=TEXT):
    """Write the example of a hip in use, or another text, with some of its text replaced."""
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file = path / "hip.toml"
    file.write_text(text, encoding="utf-8")
    return file


def refuses(message, function, *arguments, **words):
    """Check that a call raises ValueError with a message."""
    with pytest.raises(ValueError, match=message):
        function(*arguments, **words)
