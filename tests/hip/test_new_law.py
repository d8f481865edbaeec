"""New wear laws and creep laws, as docs/contributing describes them, in a copy of the package."""

import json
import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import ballsocket as bs

from ..places import CONTRIBUTING

HIP = """
joint = "hip-28"
cycles = 1e4
report_at = []
[cycle]
name = "iso-14242-1"
instants = 12
[wear]
law = "threshold"
coefficient = "1e-6 mm^3/(N m)"
threshold = "0.5 MPa"
ring_width = "8 deg"
[creep]
law = "exponential"
compliance = 1e-3
time = 3600.0
[uncertainty]
coefficient = {median = "1e-6 mm^3/(N m)", factor = 1.5}
count = 4
"""
PYTHON = """
import ballsocket as bs
from ballsocket.hip import InUse, iso_14242_1
from ballsocket.hip.exponential_creep import ExponentialCreep
from ballsocket.hip.file import read_hip
from ballsocket.hip.threshold_wear import ThresholdWear

law, creep = ThresholdWear(coefficient=1e-6, threshold=0.5), ExponentialCreep(compliance=1e-3, time=3600.0)
assert abs(creep.response(3600.0) / 0.632121e-3 - 1) < 1e-5
use = InUse(joint=bs.joints["hip-28"], cycle=iso_14242_1(12), wear=law, creep=creep)
assert 0 < use.first.volume < 40
hip = read_hip("hip.toml")
assert (hip.use.wear, hip.use.creep) == (law, creep)
assert hip.uncertain.scatter.patient({"coefficient": 2e-6}).use.wear == ThresholdWear(coefficient=2e-6, threshold=0.5)
"""
EXPLORER = """
from ballsocket.app.state.use import hip_of, use_of, use_pairs
from ballsocket.app.state.screen import Screen
from ballsocket.app.views.wear.view import Wear
from ballsocket.files.joint_file import JointFile
settings = use_of({"law": "threshold", "threshold": "0.25", "creep": "exponential", "creep_time": "60"})
assert use_of({name.partition(".")[2]: text for name, text in use_pairs(settings)}) == settings
screen = Screen(file=JointFile(joint=bs.joints["hip-28"], load={"force": 1000.0}), use=settings)
worn = hip_of(screen.file, settings)
assert (worn.wear.threshold, worn.creep.time, worn.creep.compliance) == (0.25, 60.0, 1e-3)
hidden = {setting.key: setting.field(screen).get("hidden", False) for setting in Wear.settings}
assert (hidden["threshold"], hidden["creep_time"], hidden["circular"]) == (False, False, True)
"""


def example(page):
    """Return the Python block of a page."""
    text = (CONTRIBUTING / f"{page}.md").read_text("utf-8")
    return re.search(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)[1]


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """Return a folder with a copy of the package that has one more wear law and one more creep law."""
    folder = tmp_path_factory.mktemp("laws")
    copy = folder / "ballsocket"
    shutil.copytree(Path(bs.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))
    for page, module, law, registry, last in (
        ("wear_law", "threshold_wear", "ThresholdWear", "wear_laws", "    CrossShear,\n)"),
        ("creep_law", "exponential_creep", "ExponentialCreep", "creep_laws", "    KelvinVoigtChain,\n)"),
    ):
        code = example(page)
        assert code.count("\n") <= 21
        (copy / "hip" / f"{module}.py").write_text(code, "utf-8")
        text = (copy / "hip" / f"{registry}.py").read_text("utf-8")
        assert last in text
        text = text.replace(last, last.replace(")", f"    {law},\n)")).replace(
            "\nfrom .law_fields", f"\nfrom .{module} import {law}\nfrom .law_fields", 1
        )
        (copy / "hip" / f"{registry}.py").write_text(text, "utf-8")
    return folder


def run(package, folder, *words):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    return subprocess.run(
        [sys.executable, "-W", "error::DeprecationWarning:ballsocket", *words],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        check=False,
        env={**environment, "PYTHONPATH": str(package), "PYTHONIOENCODING": "utf-8"},
    )


@pytest.mark.long
def test_new_laws_work_in_python_files_uncertainty_and_explorer(package, tmp_path):
    (tmp_path / "hip.toml").write_text(HIP, "utf-8")
    explorer = EXPLORER if find_spec("tornado") else ""
    python = run(package, tmp_path, "-c", PYTHON + explorer)
    assert python.returncode == 0, python.stderr


@pytest.mark.long
def test_new_laws_work_on_the_command_line_and_in_json(package, tmp_path):
    (tmp_path / "hip.toml").write_text(HIP[: HIP.index("[uncertainty]")], "utf-8")
    command = run(package, tmp_path, "-m", "ballsocket", "hip", "hip.toml", "--json")
    assert command.returncode == 0, command.stderr
    answer = json.loads(command.stdout)
    assert answer["laws"]["wear"] == {"law": "threshold", "coefficient_mm3_per_Nm": 1e-6, "threshold_MPa": 0.5}
    assert answer["laws"]["creep"] == {"law": "exponential", "compliance_per_MPa": 1e-3, "time_s": 3600.0}
    assert answer["history"][-1]["creep_depth"] > 0
    assert 0 < answer["initial"]["wear_mm3_per_Mc"] < 40
