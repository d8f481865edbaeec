"""What a contributor adds as docs/contributing describes it, in a copy of the package: each costs a file and a line."""

import json
import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs

from .places import CONTRIBUTING, ROOT, fenced

pytestmark = pytest.mark.long


def page_code(page):
    """List the blocks of Python of a page of docs/contributing."""
    return fenced(CONTRIBUTING / f"{page}.md", "python")


def extend_package(folder, files, changes):
    """Copy the package into a folder with new files, and replace texts of others, all by their path in the package."""
    package = folder / "ballsocket"
    shutil.copytree(Path(bs.__file__).parent, package, ignore=shutil.ignore_patterns("__pycache__"))
    for name, text in files.items():
        (package / name).parent.mkdir(exist_ok=True)
        (package / name).write_text(text, "utf-8")
    for name, replacements in changes.items():
        text = (package / name).read_text("utf-8")
        for old, new in replacements.items():
            assert old in text, (name, old)
            text = text.replace(old, new, 1)
        (package / name).write_text(text, "utf-8")


def run_python(package_folder, *words, folder=None):
    """Run Python, which imports the copy in a folder, and return the finished process."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    environment |= {"PYTHONPATH": str(package_folder), "PYTHONIOENCODING": "utf-8", "COLUMNS": "120"}
    options = {"capture_output": True, "encoding": "utf-8", "check": False}
    return subprocess.run([sys.executable, *words], cwd=folder or package_folder, env=environment, **options)


def checked_run(*words):
    done = run_python(*words)
    assert done.returncode == 0, done.stderr
    return done.stdout


MODEL_PAGE = (CONTRIBUTING / "model.md").read_text("utf-8")
MODEL_TESTS = re.search(r"^pytest --long -k mattress (.*) && lint-imports$", MODEL_PAGE, re.MULTILINE)[1].split()


@pytest.mark.parametrize(
    ("promise", "failed", "tests"), [("0.15", 0, MODEL_TESTS), ("0.02", 1, ["tests/evidence/test_validity.py"])]
)
def test_the_check_of_the_page_fails_for_a_model_that_breaks_its_promise(promise, failed, tests, tmp_path):
    """The model of the page is added to a copy of the package; springs on a plane are not within 2 %."""
    code = page_code("model")[0]
    assert code.count("\n") <= 48
    line = '    "mattress": "models.mattress:Mattress",\n'
    changes = {"model_catalogue.py": {'    "hertz":': line + '    "hertz":'}}
    extend_package(tmp_path, {"models/mattress.py": code.replace("within=0.15", f"within={promise}")}, changes)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    options = ("-n", "0", "--long", "-o", "pythonpath=", "-p", "no:cacheprovider", "-k", "mattress")
    done = run_python(tmp_path, "-m", "pytest", "-v", *options, *tests, folder=ROOT)
    assert done.returncode == failed, done.stdout
    failures = re.findall("^FAILED (.*?)(?: - |$)", done.stdout, re.MULTILINE)
    assert failures == ["tests/evidence/test_validity.py::test_valid_results_are_within_the_promise[mattress]"][:failed]
    assert failed or int(re.search(r"(\d+) passed", done.stdout)[1]) >= 30


LAST = '    "evidence": "evidence.Evidence",\n'
OPENED = """
from ballsocket.app.server import page_files
from ballsocket.app.session import Page
from ballsocket.app.view import make_file
page = Page("view=volume&preset=hip-28&load.force=3000")
assert page.screen.view == "volume"
assert page.channel.shown_value("#volume-numbers")[0]["rows"][0][1] == "volume of the liner"
assert 'data-view="volume">Volume</button>' in page_files()["page.html"][1]
assert make_file(page.seen(), "CSV")[1].startswith(b"volume_mm3\\n8722.42")
assert b"Volume: hip-28" in make_file(page.seen(), "HTML")[1]
"""


@pytest.mark.skipif(find_spec("tornado") is None, reason="the explorer's extra is not installed")
def test_a_new_view_is_a_file_and_a_line(tmp_path):
    code = page_code("view")[0]
    assert code.count("\n") <= 32
    files = {"app/views/volume.py": code}
    extend_package(tmp_path, files, {"app/views/registry.py": {LAST: f'{LAST}    "volume": "volume.Volume",\n'}})
    checked_run(tmp_path, "-c", OPENED)


IMPORTS, FIRST = "from .warp import warp_texts\n", '        Target(\n            name="table"'


def test_the_command_lists_and_writes_a_new_target(tmp_path):
    code, entry = page_code("export_target")
    assert code.count("\n") + entry.count("\n") <= 25
    changes = {IMPORTS: f"from .octave import octave_texts\n{IMPORTS}", FIRST: entry + FIRST}
    extend_package(tmp_path, {"export/octave.py": code}, {"export/targets.py": changes})

    def run(*words):
        return run_python(tmp_path, "-m", "ballsocket", "export", *words)

    assert "octave" in run("--help").stdout
    finished = run("octave", "hip-28", "--out", "hip", "--friction", "0.1", "--model", "hess-forsbach")
    assert (finished.returncode, finished.stderr) == (0, "ballsocket: octave cannot represent friction: omitted\n")
    text = (tmp_path / "hip" / "hip_force.m").read_text("utf-8")
    depths, forces = (np.array(json.loads(row)) for row in re.findall(r"\[.*?\]", text))
    expected = bs.HessForsbach().press(bs.joints["hip-28"], indentation=depths[1:]).force
    np.testing.assert_allclose(forces[1:], expected, rtol=1e-8)
    unknown = run("octavo", "hip-28", "--out", "hip")
    assert unknown.stderr == "ballsocket: target 'octavo' is not known; did you mean 'octave'?\n"


HIP = """
joint = "hip-28"
cycles = 1e4
report_at = []
[cycle]
name = "pendulum"
force = "1.5 kN"
instants = 20
[cup]
tilt = "30 deg"
[wear]
law = "threshold"
coefficient = "1e-6 mm^3/(N m)"
threshold = "0.5 MPa"
ring_width = "8 deg"
[creep]
law = "exponential"
compliance = 1e-3
time = 3600.0
"""
UNCERTAINTY = '[uncertainty]\ncoefficient = {median = "1e-6 mm^3/(N m)", factor = 1.5}\ncount = 4\n'
PYTHON = """
import ballsocket as bs
from ballsocket.hip import HipSimulation, iso_14242_1, named_cycle
from ballsocket.hip.exponential_creep import ExponentialCreep
from ballsocket.hip.config import read_hip
from ballsocket.hip.threshold_wear import ThresholdWear

law, creep = ThresholdWear(coefficient=1e-6, threshold=0.5), ExponentialCreep(compliance=1e-3, time=3600.0)
assert abs(creep.response(3600.0) / 0.632121e-3 - 1) < 1e-5
use = HipSimulation(joint=bs.joints["hip-28"], cycle=iso_14242_1(12), wear=law, creep=creep)
assert 0 < use.first.volume < 40
hip = read_hip("uncertain.toml")
assert (hip.use.wear, hip.use.creep) == (law, creep)
patient = hip.uncertain.variability.patient({"coefficient": 2e-6})
assert patient.use.wear == ThresholdWear(coefficient=2e-6, threshold=0.5)
cycle = named_cycle("pendulum", 40, force=1000.0)
assert cycle.largest_force == 1000.0
assert abs(abs(cycle.rotation_increments[:, 0]).sum() / 4 / 0.4 - 1) < 1e-2
"""
EXPLORER = """
from ballsocket.app.state.use import CHOICES, hip_of, use_of, use_pairs
from ballsocket.app.state.screen import Screen
from ballsocket.app.session import Page
from ballsocket.files.joint_file import JointFile
assert "pendulum" in CHOICES["cycle"]
settings = use_of({"law": "threshold", "threshold": "0.25", "creep": "exponential", "creep_time": "60"})
assert use_of({name.partition(".")[2]: text for name, text in use_pairs(settings)}) == settings
screen = Screen(file=JointFile(joint=bs.joints["hip-28"], load={"force": 1000.0}), use=settings)
worn = hip_of(screen.file, settings)
assert (worn.wear.threshold, worn.creep.time, worn.creep.compliance) == (0.25, 60.0, 1e-3)
fields = [control.field for control in Page("view=wear").view.controls(screen)]
names = {field["name"] for field in fields if not field.get("hidden")}
assert {"threshold", "creep_time"} <= names and "circular" not in names
"""
ADDED = {
    "cycle": ("pendulum", "cycle_registry", "PENDULUM", "from .simulator_cycles", "    *IN_VIVO_CYCLES,\n"),
    "wear_law": ("threshold_wear", "wear_laws", "ThresholdWear", "from .law_fields", "    CrossShear,\n"),
    "creep_law": ("exponential_creep", "creep_laws", "ExponentialCreep", "from .law_fields", "    KelvinVoigtChain,\n"),
}
"""Page, new module, registry, new name, and the lines of the registry before which it is imported and listed."""


def test_a_new_cycle_and_new_laws_work_in_python_files_uncertainty_explorer_and_on_the_command_line(tmp_path):
    files, changes = {}, {}
    for page, (module, registry, name, before_import, entry) in ADDED.items():
        files[f"hip/{module}.py"] = page_code(page)[0]
        assert files[f"hip/{module}.py"].count("\n") <= 21
        lines = {before_import: f"from .{module} import {name}\n{before_import}", entry: f"{entry}    {name},\n"}
        changes[f"hip/{registry}.py"] = lines
    extend_package(tmp_path, files, changes)
    (tmp_path / "hip.toml").write_text(HIP, "utf-8")
    (tmp_path / "uncertain.toml").write_text(HIP + UNCERTAINTY, "utf-8")
    checked_run(tmp_path, "-c", PYTHON + (EXPLORER if find_spec("tornado") else ""))
    answer = json.loads(checked_run(tmp_path, "-m", "ballsocket", "hip", "hip.toml", "--json"))
    assert answer["laws"]["wear"] == {"law": "threshold", "coefficient_mm3_per_Nm": 1e-6, "threshold_MPa": 0.5}
    assert answer["laws"]["creep"] == {"law": "exponential", "compliance_per_MPa": 1e-3, "time_s": 3600.0}
    assert answer["history"][-1]["creep_depth"] > 0
    assert 0 < answer["initial"]["wear_mm3_per_Mc"] < 40
    assert answer["cycle"]["name"] == "pendulum"
    assert answer["cycle"]["peaks"]["force_N"] == pytest.approx(1500.0)
    assert answer["cycle"]["slide_mm"] == pytest.approx(4 * 14.0 * 0.4, rel=1e-3)


IDENTIFY = """
import json
import numpy as np
import ballsocket as bs
from ballsocket.identification import Machine, Measured
from ballsocket.identification.file import read_identify

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
open("data.toml", "w").write(
    'model = "hess-forsbach"\\njoint = "hess-forsbach"\\n[free]\\nfoundation_modulus = "100..800 MPa/mm"\\n'
    '[machine.frame]\\nseating = "0..20 um"\\n'
    f'[[data]]\\nquantity = "indentation"\\nvalues = {depth.tolist()}\\nforce = {force.tolist()}\\n'
    'uncertainty = "0.01 um"\\nmachine = "frame"\\n'
)
from_file = read_identify("data.toml").identify_unknowns()
summary = [from_file.point, from_file["foundation_modulus"].unit]
print(json.dumps([*points, *summary, known.notes]))
"""


def test_a_new_unknown_is_identified_by_loads_of_both_kinds_and_from_a_file(tmp_path):
    text = (CONTRIBUTING / "unknown.md").read_text("utf-8")
    names = re.findall(r"`src/ballsocket/identification/(\w+)\.py`", text)[:2]
    files = {f"identification/{name}.py": code for name, code in zip(names, page_code("unknown"), strict=True)}
    starts = ("_MODEL_NUMBERS = (\n", "_MACHINE_ERRORS = (\n")
    lines = {
        start: f"from .{name} import {name.upper()}\n\n{start}    {name.upper()},\n"
        for start, name in zip(starts, names, strict=True)
    }
    extend_package(tmp_path, files, {"identification/registry.py": lines})
    by_force, by_depth, from_file, unit, notes = json.loads(checked_run(tmp_path, "-c", IDENTIFY))
    truth = {"foundation_modulus": 300.0, "machine.seating": 0.005}
    assert by_force == pytest.approx(truth, rel=1e-3)
    assert by_depth == pytest.approx(truth, rel=1e-3)
    assert from_file == pytest.approx({"foundation_modulus": 300.0, "frame.seating": 0.005}, rel=1e-3)
    assert unit == "MPa/mm"
    assert any(note.startswith("a seating of 1 µm would move foundation_modulus by") for note in notes)
