"""Programs of the page on exports: each runs unchanged in its host, if installed."""

import os
import re
import subprocess
import sys

import pytest

from ballsocket.export.compiler import compiler

from ..cli.command import run
from ..places import EXAMPLES, ROOT
from .library import needs_compiler, skip_without

PAGE = (ROOT / "docs" / "how-to" / "export.md").read_text(encoding="utf-8")
PROGRAMS = dict(re.findall(r"```\{code-block\} python\n# (\w+)(.*?)```", PAGE, re.DOTALL))
PACKAGES = {"FMU": "fmpy", "MuJoCo": "mujoco", "Drake": "pydrake", "Exudyn": "exudyn", "OpenSim": "opensim"}
SECONDS = 120


@needs_compiler
@pytest.mark.parametrize("host", PACKAGES)
def test_a_program_of_the_page_runs_in_its_host(host, tmp_path):
    assert PAGE.count("{code-block} python") == len(PROGRAMS) == len(PACKAGES)
    skip_without(PACKAGES[host])
    joint, folder = str(EXAMPLES / "hip.toml"), tmp_path
    if host == "FMU":
        exported = run("fmu", joint, "--out", "hip.fmu", "--friction", "0.05", folder=tmp_path)
    else:
        exported = run("export", host.lower(), joint, "--out", "hip", folder=tmp_path)
        folder = tmp_path / "hip"
    assert exported.returncode == 0
    program = folder / "program.py"
    program.write_text(f"# {host}{PROGRAMS[host]}", encoding="utf-8")
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    finished = subprocess.run(
        [sys.executable, program.name], cwd=folder, env=environment, capture_output=True, text=True, timeout=SECONDS
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
    finished = subprocess.run([str(folder / "program")], capture_output=True, text=True, check=True, timeout=SECONDS)
    assert re.fullmatch(r"F -\d+\.\d N, pmax \d+\.\d\d MPa\n", finished.stdout)
