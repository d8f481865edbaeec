"""A new export target costs one function and one entry of the registry, tried in a copy of the package."""

import json
import re

import numpy as np
import pytest

import ballsocket as bs

from ..extended_package import extend_package, page_code, run_python

REGISTRY, FIRST = "TARGETS: Mapping[str, Target] = {", '        Target(\n            name="table"'


@pytest.mark.long
def test_the_command_lists_and_writes_a_new_target(tmp_path):
    function, entry = page_code("export_target")
    assert function.count("\n") + entry.count("\n") <= 20
    changes = {REGISTRY: f"{function}\n\n{REGISTRY}", FIRST: entry + FIRST}
    extend_package(tmp_path, {}, {"export/targets.py": changes})

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
