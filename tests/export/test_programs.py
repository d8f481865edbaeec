"""Programs of the page on exports, which run unchanged in their hosts, and the four-bar linkage of the gallery."""

import os
import re
import subprocess
import sys
from runpy import run_path
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ballsocket.export.compiler import compiler

from ..cli.command import printed, run
from ..places import EXAMPLES, ROOT
from ..processes import PATIENCE
from .library import benchmark, needs_compiler, skip_without

PAGE = (ROOT / "docs" / "how-to" / "export.md").read_text(encoding="utf-8")
PROGRAMS = dict(re.findall(r"```\{code-block\} python\n# (\w+)(.*?)```", PAGE, re.DOTALL))
PACKAGES = {"FMU": "fmpy", "Warp": "newton"} | {host: host.lower() for host in ("MuJoCo", "Drake", "Exudyn", "OpenSim")}


@needs_compiler
@pytest.mark.parametrize("host", PACKAGES)
def test_a_program_of_the_page_runs_in_its_host(host, tmp_path):
    assert PAGE.count("{code-block} python") == len(PROGRAMS) == len(PACKAGES)
    skip_without(PACKAGES[host])
    joint, folder = str(EXAMPLES / "hip.toml"), tmp_path
    if host == "FMU":
        printed("fmu", joint, "--out", "hip.fmu", "--friction", "0.05", folder=tmp_path)
    else:
        assert run("export", host.lower(), joint, "--out", "hip", folder=tmp_path).returncode == 0
        folder = tmp_path / "hip"
    program = folder / "program.py"
    program.write_text(f"# {host}{PROGRAMS[host]}", encoding="utf-8")
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    finished = subprocess.run(
        [sys.executable, program.name], cwd=folder, env=environment, capture_output=True, text=True, timeout=PATIENCE
    )
    assert finished.returncode == 0, finished.stderr


@needs_compiler
def test_the_program_in_c_of_the_page_compiles_without_a_warning_and_runs(tmp_path):
    run("export", "c", str(EXAMPLES / "hip.toml"), "--out", "hip", folder=tmp_path)
    (program,) = re.findall(r"```c\n(.*?)```", PAGE, re.DOTALL)
    folder = tmp_path / "hip"
    (folder / "program.c").write_text(program, encoding="utf-8")
    strict = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic-errors")
    subprocess.run([*compiler(), *strict, "program.c", "hip.c", "-o", "program", "-lm"], cwd=folder, check=True)
    finished = subprocess.run([str(folder / "program")], capture_output=True, text=True, check=True, timeout=PATIENCE)
    assert re.fullmatch(r"F -\d+\.\d N, pmax \d+\.\d\d MPa\n", finished.stdout)


@pytest.fixture(scope="module")
def bar():
    return SimpleNamespace(**run_path(str(EXAMPLES / "what_does_clearance_do_to_a_four_bar.py"), run_name="four_bar"))


def test_energy_loss_of_the_mechanism_equals_the_dissipation_of_its_joint(bar):
    """From rest, until the joint has met its socket several times."""
    states = bar.fallen(np.linspace(0.0, 0.05, 11))
    centres = np.array([bar.at_joint(state)[0] for state in states.T.tolist()])
    energy, lost = bar.mechanical(states) + bar.ELEMENT(centres).energy, states[11]
    assert (np.diff(lost) >= 0.0).all()
    assert 0.0 < lost[-1] == pytest.approx(energy[0] - energy[-1], rel=1e-4)


@pytest.mark.long
@needs_compiler
@pytest.mark.parametrize("name", ["law", "sphere"])
def test_exudyn_reproduces_the_stored_motion_and_that_of_the_element(name, bar):
    skip_without("exudyn")
    found = benchmark("four_bar").in_exudyn(name, 0.05, 2e-5, 11)
    kept = np.genfromtxt(EXAMPLES / "four_bar_in_exudyn.csv", delimiter=",", names=True)[:11]
    assert_allclose(found.time, kept["time_s"])
    assert_allclose(found.angle, kept[f"{name}_angle_rad"], atol=3e-5)
    assert_allclose(found.lost, kept[f"{name}_lost_N_mm"], atol=0.02)
    if name == "law":
        own = bar.fallen(found.time)
        assert np.ptp(own[9]) > 1e-3
        assert_allclose(found.angle, own[9], atol=1e-5)
        assert_allclose(found.lost, own[11], atol=5e-3)
