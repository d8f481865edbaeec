"""Registry of unknowns: numbers of a model, errors of a machine, and the cost of a new one."""

import copy
import json
import os
import pickle
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import MACHINE_ERRORS, Machine, Measured
from ballsocket.identify.file import read_identify
from ballsocket.problem.cup import Cup
from ballsocket.studies import Normal

from ..places import CONTRIBUTING
from .rigid import JOINT

FORCE = np.linspace(0.5, 40.0, 12)
MODEL = bs.AdhesiveSocket(work_of_adhesion=2e-4)
CONTACT = MODEL.press(JOINT, force=FORCE)


def indentations(**settings):
    return Measured(quantity="indentation", values=CONTACT.indentation, uncertainty=1e-6, force=FORCE, **settings)


def test_the_work_of_adhesion_is_identified_from_indentations_at_small_forces():
    start = bs.AdhesiveSocket()
    result = bs.identify(start, JOINT, indentations(), {"work_of_adhesion": (1e-5, 1e-3), "clearance": (0.05, 0.2)})
    assert result.point == pytest.approx({"work_of_adhesion": 2e-4, "clearance": 0.1}, rel=1e-3)
    alone = bs.identify(start, JOINT, indentations(), {"work_of_adhesion": (0.0, 1e-3)})
    assert alone.point == pytest.approx({"work_of_adhesion": 2e-4}, rel=1e-4)
    assert alone.joint == JOINT
    prior = Normal(mean=3e-4, deviation=1e-8)  # counts as knowledge
    known = bs.identify(start, JOINT, indentations(), {"work_of_adhesion": prior})
    assert known.point["work_of_adhesion"] == pytest.approx(3e-4, rel=1e-2)
    assert result.identifiable
    assert result["work_of_adhesion"].unit == "N/mm"
    assert result.model.work_of_adhesion == pytest.approx(2e-4, rel=1e-3)
    assert result.joint.clearance == pytest.approx(0.1, rel=1e-3)
    assert result.misfit.forward.model is start


def test_a_number_of_a_model_in_a_cup_is_identified():
    covered = bs.AdhesiveSocket().in_cup(Cup(arc_of_cover=np.radians(150.0)))
    result = bs.identify(covered, JOINT, indentations(), {"work_of_adhesion": (1e-5, 1e-3)})
    assert result.point["work_of_adhesion"] == pytest.approx(2e-4, rel=1e-3)
    assert result.model.cup == covered.cup
    assert result.model.model.work_of_adhesion == pytest.approx(2e-4, rel=1e-3)


def test_a_file_frees_a_number_of_the_model(tmp_path):
    values = ", ".join(f'"{1e3 * value:.9f} um"' for value in CONTACT.indentation)
    (tmp_path / "adhesion.toml").write_text(
        'model = "adhesive"\n[joint]\nball_radius = 16\nclearance = 0.1\nliner_thickness = 6\n'
        '[liner]\nyoung = 1000\npoisson = 0.4\n[free]\nwork_of_adhesion = "0.01..1 J/m^2"\n'
        f'[[data]]\nquantity = "indentation"\nvalues = [{values}]\nforce = {FORCE.tolist()}\nuncertainty = "1 nm"\n',
        "utf-8",
    )
    question = read_identify(tmp_path / "adhesion.toml")
    assert question.free["work_of_adhesion"] == pytest.approx((1e-5, 1e-3))
    assert question.identify_unknowns().point["work_of_adhesion"] == pytest.approx(2e-4, rel=1e-3)


def test_a_machine_has_every_registered_error():
    machine = Machine(**dict.fromkeys(MACHINE_ERRORS, 1e-06), name="press")
    assert machine.known_errors() == {f"press.{name}": 1e-6 for name in MACHINE_ERRORS}
    assert Machine().known_errors() == {f"machine.{name}": 0.0 for name in MACHINE_ERRORS}
    assert Machine(offset=(-1.0, 2.0)).unknown_errors == {"machine.offset": (-1.0, 2.0)}
    assert Machine(offset=0.1) == Machine(offset=0.1)
    assert Machine(offset=0.1) != Machine(drift=0.1)
    assert repr(Machine(offset=0.1)) == "Machine(compliance=0.0, offset=0.1, drift=0.0, name='machine')"
    assert pickle.loads(pickle.dumps(machine)) == copy.deepcopy(machine) == machine
    assert replace(machine, offset=0.3).known_errors()["press.offset"] == 0.3
    with pytest.raises(AttributeError, match="no attribute 'offsett'"):
        _ = Machine().offsett


PAGE = (CONTRIBUTING / "unknown.md").read_text("utf-8")
FILES = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
PATHS = re.findall(r"`src/ballsocket/identify/(\w+)\.py`", PAGE)[:2]

SCRIPT = """
import json, sys
import numpy as np
import ballsocket as bs
from ballsocket.cli.root import main
from ballsocket.identify import Machine, Measured
from ballsocket.identify.file import read_identify

hip, force = bs.joints["hess-forsbach"], np.linspace(50.0, 3000.0, 15)
model = bs.RadialFoundation(modulus=bs.constant(300.0))
depth = np.asarray(model.press(hip, force=force).indentation) + 0.005 * force / (force + 100.0)
depths = {"quantity": "indentation", "values": depth, "uncertainty": 1e-5, "force": force}
machine = Machine(seating=(0.0, 0.02))
press = Measured(**depths, machine=machine)
by_depth = Measured(quantity="force", values=force, uncertainty=0.1, indentation=depth, machine=machine)
free = {"foundation_modulus": (100.0, 800.0)}
points = [bs.identify(bs.HessForsbach(), hip, data, free).point for data in (press, by_depth)]
known = bs.identify(bs.HessForsbach(), hip, Measured(**{**depths, "uncertainty": 1e-4}), free)
rows = "\\n".join(f"{load!r},{value!r}" for load, value in zip(force.tolist(), depth.tolist()))
open("press.csv", "w").write("force_N,indentation_mm\\n" + rows + "\\n")
open("data.toml", "w").write(
    'model = "hess-forsbach"\\njoint = "hess-forsbach"\\n[free]\\nfoundation_modulus = "100..800 MPa/mm"\\n'
    '[machine.frame]\\nseating = "0..20 um"\\n'
    '[[data]]\\nfile = "press.csv"\\nuncertainty = "0.01 um"\\nmachine = "frame"\\n'
)
points.append(read_identify("data.toml").identify_unknowns().point)
print(json.dumps({"points": points, "notes": known.notes}))
sys.stdout.flush()
sys.argv = ["ballsocket", "identify", "data.toml", "--json"]
main()
"""


@pytest.mark.long
def test_a_new_unknown_costs_one_file_and_one_line_of_the_registry(tmp_path):
    """In a copy of the package with the two files of the page it is used from Python, by loads of both kinds, from a
    file, and by the command.
    """
    room = tmp_path / "ballsocket" / "identify"
    shutil.copytree(Path(bs.__file__).parent, room.parent, ignore=shutil.ignore_patterns("__pycache__"))
    registry = (room / "registry.py").read_text("utf-8")
    for name, text, tuple_name in zip(PATHS, FILES, ("_MODEL_NUMBERS", "_MACHINE_ERRORS"), strict=True):
        (room / f"{name}.py").write_text(text, "utf-8")
        start = f"{tuple_name} = (\n"
        assert start in registry
        registry = registry.replace(start, f"from .{name} import {name.upper()}\n\n{start}    {name.upper()},\n")
    (room / "registry.py").write_text(registry, "utf-8")
    (tmp_path / "script.py").write_text(SCRIPT, "utf-8")
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    completed = subprocess.run(
        [sys.executable, "script.py"],
        cwd=tmp_path,
        capture_output=True,
        encoding="utf-8",
        check=False,
        env={**environment, "PYTHONPATH": str(tmp_path), "PYTHONIOENCODING": "utf-8"},
    )
    assert completed.returncode == 0, completed.stderr
    python, command = (json.loads(text) for text in completed.stdout.split("\n", 1))
    by_force, by_depth, from_file = python["points"]
    truth = {"foundation_modulus": 300.0, "machine.seating": 0.005}
    assert by_force == pytest.approx(truth, rel=1e-3)
    assert by_depth == pytest.approx(truth, rel=1e-3)
    assert from_file == pytest.approx({"foundation_modulus": 300.0, "frame.seating": 0.005}, rel=1e-3)
    assert any(note.startswith("a seating of 1 µm would move foundation_modulus by") for note in python["notes"])
    estimates = {row["name"]: row for row in command["estimates"]}
    assert estimates["foundation_modulus"]["unit"] == "MPa/mm"
    assert estimates["foundation_modulus"]["value"] == pytest.approx(300.0, rel=1e-3)
    assert estimates["frame.seating"]["value"] == pytest.approx(0.005, rel=1e-3)
