"""A new cycle and new laws, as docs/contributing describes them, in a copy of the package."""

import json
from importlib.util import find_spec

import pytest

from ..extended_package import extend_package, page_code, run_python

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
from ballsocket.app.views.wear import Wear
from ballsocket.files.joint_file import JointFile
assert "pendulum" in CHOICES["cycle"]
settings = use_of({"law": "threshold", "threshold": "0.25", "creep": "exponential", "creep_time": "60"})
assert use_of({name.partition(".")[2]: text for name, text in use_pairs(settings)}) == settings
screen = Screen(file=JointFile(joint=bs.joints["hip-28"], load={"force": 1000.0}), use=settings)
worn = hip_of(screen.file, settings)
assert (worn.wear.threshold, worn.creep.time, worn.creep.compliance) == (0.25, 60.0, 1e-3)
hidden = {setting.key: setting.field(screen).get("hidden", False) for setting in Wear.settings}
assert (hidden["threshold"], hidden["creep_time"], hidden["circular"]) == (False, False, True)
"""
ADDED = {
    "cycle": ("pendulum", "cycle_registry", "PENDULUM", "from .simulator_cycles", "    *IN_VIVO_CYCLES,\n"),
    "wear_law": ("threshold_wear", "wear_laws", "ThresholdWear", "from .law_fields", "    CrossShear,\n"),
    "creep_law": ("exponential_creep", "creep_laws", "ExponentialCreep", "from .law_fields", "    KelvinVoigtChain,\n"),
}
"""Page, new module, registry, new name, and the lines of the registry before which it is imported and listed."""


def checked_run(*words):
    done = run_python(*words)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.long
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
