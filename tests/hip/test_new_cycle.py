"""A new cycle costs one file and two lines of the registry, tried in a copy of the package."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import ballsocket as bs

from ..places import CONTRIBUTING, EXAMPLES

PAGE = (CONTRIBUTING / "cycle.md").read_text("utf-8")
FILE = re.search(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)[1]

PYTHON = """
import json, sys
from ballsocket.app.state.use import CHOICES
from ballsocket.cli import main
from ballsocket.hip import named_cycle
cycle = named_cycle("pendulum", 40, force=1000.0)
listed = {
    "force": cycle.largest_force,
    "swing": float(abs(cycle.rotation_increments[:, 0]).sum()) / 4,
    "explorer": "pendulum" in CHOICES["cycle"],
}
print(json.dumps(listed))
sys.argv = ["ballsocket", "hip", "hip.toml", "--json"]
main()
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """Copy the package into a folder and add the cycle."""
    folder = tmp_path_factory.mktemp("added")
    added = folder / "ballsocket"
    shutil.copytree(Path(bs.__file__).parent, added, ignore=shutil.ignore_patterns("__pycache__"))
    (added / "hip" / "pendulum.py").write_text(FILE, encoding="utf-8")
    registry = (added / "hip" / "cycle_registry.py").read_text("utf-8")
    lines = {"from .simulator_cycles": "from .pendulum import PENDULUM\n", "    *IN_VIVO_CYCLES,\n": "    PENDULUM,\n"}
    for before, line in lines.items():
        assert before in registry
        registry = registry.replace(before, line + before, 1)
    (added / "hip" / "cycle_registry.py").write_text(registry, encoding="utf-8")
    text = (EXAMPLES / "hip_in_use.toml").read_text(encoding="utf-8")
    text = text.replace('name = "iso-14242-1"', 'name = "pendulum"\nforce = "1.5 kN"')
    text = text.replace("instants = 100", "instants = 20").replace("cycles = 5e6", "cycles = 1e5")
    (folder / "hip.toml").write_text(re.sub(r"report_at = .*", "report_at = [1e5]", text), encoding="utf-8")
    return folder


@pytest.mark.long
def test_a_new_cycle_is_known_to_python_files_command_line_json_and_explorer(package):
    assert FILE.count("\n") <= 21
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    done = subprocess.run(
        [sys.executable, "-c", PYTHON],
        cwd=package,
        capture_output=True,
        encoding="utf-8",
        check=False,
        env={**environment, "PYTHONPATH": str(package), "PYTHONIOENCODING": "utf-8"},
    )
    assert done.returncode == 0, done.stderr
    listed, answer = done.stdout.split("\n", 1)
    assert json.loads(listed) == {"force": 1000.0, "swing": pytest.approx(0.4, rel=1e-2), "explorer": True}
    answer = json.loads(answer)
    assert answer["cycle"]["name"] == "pendulum"
    assert answer["cycle"]["peaks"]["force_N"] == pytest.approx(1500.0)
    assert answer["cycle"]["slide_mm"] == pytest.approx(4 * 14.0 * 0.4, rel=1e-3)
