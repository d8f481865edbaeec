"""Options of exports that are not allowed are refused in one line, and nothing is written."""

import pytest

from ..cli.command import run

FMU = ("fmu", "hip-28", "--out", "hip.fmu")
PRELOADED = ("--ball-radius", "13.5", "--interference", "0.03", "--liner-thickness", "2.5", "--liner", "pom")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ("export", "adams", "hip-28", "--out", "hip"),
            "target 'adams' is not known; known: c, opensim, mujoco, drake, exudyn, modelica",
        ),
        (("export", "mujocoo", "hip-28", "--out", "hip"), "did you mean 'mujoco'?"),
        (("export", "table", "hip-28", "--out", "file"), "'file' is a file; a folder is needed"),
        (("export", "table", "hip-28", "--out", "file/new/hip"), "'file' is a file; a folder is needed"),
        (("export", "table", "hip-28", "--out", "hip", "--model", "fem"), "finite elements are too noisy for a law"),
        (("fmu", "hip-28", "--out", "hip.zip"), "out 'hip.zip' must end in .fmu"),
        (("fmu", "hip-28", "--out", "nowhere/hip.fmu"), "cannot write hip.fmu: 'nowhere' is not a folder"),
        ((*FMU, "--fmi", "4"), "FMI version = 4 is not allowed: 2 or 3"),
        ((*FMU, "--model", "fem"), "finite elements are too noisy for a law"),
        ((*FMU, "--hysteresis", "-1"), "hysteresis"),
        ((*FMU, "--restitution", "0.5"), "a restitution and the speed of its impact belong together"),
        ((*FMU, "--friction", "-0.1"), "coefficient"),
        ((*FMU, "--viscosity", "2.5 mm"), "viscosity must be a number of Pa s, or such as '2.5 mPa s'"),
        ((*FMU, "--viscosity", "0 Pa s"), "viscosity = 0 is not allowed"),
        ((*FMU, "--roughness", "1 um"), "add --viscosity"),
        (("export", "c", *PRELOADED, "--arc-of-cover", "180", "--out", "rod"), "above 180 deg"),
        (
            ("fmu", *PRELOADED, "--model", "exact", "--out", "rod.fmu"),
            "the model exact does not solve a preloaded joint: use sphere",
        ),
    ],
)
def test_invalid_options_are_refused_in_one_line(words, message, tmp_path):
    (tmp_path / "file").touch()
    finished = run(*words, folder=tmp_path)
    assert finished.returncode == 2
    assert message in finished.stderr
    assert finished.stderr.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
