"""A new export target costs one function and one entry of the registry, tried in a copy of the package."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs

from ..places import CONTRIBUTING

PAGE = (CONTRIBUTING / "export_target.md").read_text("utf-8")
FUNCTION, LINE = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.mark.long
def test_the_command_lists_and_writes_a_new_target(tmp_path):
    assert FUNCTION.count("\n") + LINE.count("\n") <= 20
    copy = tmp_path / "ballsocket"
    shutil.copytree(Path(bs.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))
    registry = (copy / "export" / "targets.py").read_text("utf-8")
    for before, addition in {
        "TARGETS: Mapping[str, Target] = {": FUNCTION + "\n\n",
        '        Target(\n            name="table"': LINE,
    }.items():
        assert registry.count(before) == 1
        registry = registry.replace(before, addition + before)
    (copy / "export" / "targets.py").write_text(registry, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "COLUMNS": "120"}

    def run(*words):
        command = [sys.executable, "-m", "ballsocket", "export", *words]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, encoding="utf-8")

    assert "octave" in run("--help").stdout
    finished = run("octave", "hip-28", "--out", "hip", "--friction", "0.1", "--model", "hess-forsbach")
    assert (finished.returncode, finished.stderr) == (0, "ballsocket: octave cannot represent friction: omitted\n")
    text = (tmp_path / "hip" / "hip_force.m").read_text("utf-8")
    depths, forces = (np.array(json.loads(row)) for row in re.findall(r"\[.*?\]", text))
    expected = bs.HessForsbach().press(bs.joints["hip-28"], indentation=depths[1:]).force
    np.testing.assert_allclose(forces[1:], expected, rtol=1e-8)
    unknown = run("octavo", "hip-28", "--out", "hip")
    assert unknown.stderr == "ballsocket: target 'octavo' is not known; did you mean 'octave'?\n"
