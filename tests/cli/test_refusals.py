"""Wrong input at the terminal: one line that names the mistake and the remedy, and exit status 2."""

import shlex
from pathlib import Path

import pytest

from ..places import EXAMPLES
from ..refusals import text_tables
from .command import refusal

ABBREVIATIONS = {
    **{f"{{{path.stem.replace('_', '-')}}}": shlex.quote(str(path)) for path in EXAMPLES.glob("*.toml")},
    "{liner}": f"--liner {shlex.quote(str(EXAMPLES / 'planning' / 'liner.stl'))}",
    "{head}": f"--head {shlex.quote(str(EXAMPLES / 'planning' / 'head.stl'))}",
    "{pelvis}": f"--landmarks {shlex.quote(str(EXAMPLES / 'planning' / 'pelvis.mrk.json'))}",
    "{hip-36}": "hip-36 --force 3kN",
    "{sizes}": "--ball-radius 16 --clearance 0.1 --liner-thickness 6",
    "{export}": "--out a hip-28",
    "{fmu}": "fmu hip-28 --out a.fmu",
    "{rod}": "--ball-radius 13.5 --interference 0.03 --liner-thickness 2.5 --liner pom",
    "{numbers}": "{sizes} --young 1GPa --poisson 0.4 --force 3kN",
    "{spread}": "{hip-36} --spread clearance=0.1+-0.05 --spread liner_young=700..1100",
}


TABLES = text_tables(Path(__file__).parent / "refused.txt")


@pytest.mark.parametrize(("command", "message"), [row for table in TABLES for row in table])
def test_wrong_input_is_refused_in_one_line_with_the_remedy(command, message, tmp_path):
    (tmp_path / "file").touch()
    for short, long in reversed(ABBREVIATIONS.items()):
        command = command.replace(short, long)
    assert message in refusal(*shlex.split(command), folder=tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
