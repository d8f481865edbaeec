"""Tools for assistants: schemas, refusals, command lines, and limits of a call."""

import asyncio
import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from ballsocket.cli.root import load_commands
from ballsocket.cli.servers import LIMITED_PROGRAM
from ballsocket.core.input_files import restriction_variables
from ballsocket.mcp import call
from ballsocket.mcp.call import run as run_tool
from ballsocket.mcp.tools import TOOLS, schema

from ..cli.command import refusal, run
from ..extent import some
from ..places import EXAMPLES, symlink_or_skip
from ..processes import is_running, wait_until
from ..refusals import text_tables

COMMANDS = load_commands()
PRESS = {"joint": "hip-36", "force": "3 kN"}


def command_line(name, arguments, folder):
    return call.command_line(name, arguments, folder, COMMANDS)


@pytest.mark.parametrize("name", TOOLS)
def test_a_tool_describes_its_arguments_with_units_and_offers_no_file_to_write(name):
    properties = schema(TOOLS[name], COMMANDS)["properties"]
    assert all(each["description"] for each in properties.values())
    assert not {"figure", "out", "store", "section", "view", "vtk", "report", "scheduler"} & set(properties)
    units = {"ball_radius": " in mm", "force": " in N", "young": " in MPa", "half_angle": " in degrees"}
    assert name != "press" or all(unit in properties[number]["description"] for number, unit in units.items())


(CALLS,) = text_tables(Path(__file__).parent / "refused.txt")
CALLS.append(("press", json.dumps({**PRESS, "model": ["exact"] * 51}), "model has 51 values: at most 50"))
CALLS.append(("identify", json.dumps({"content": "x" * 100_001}), "the content is larger than 100000 bytes"))


@pytest.mark.parametrize(("name", "arguments", "message"), CALLS)
def test_a_wrong_call_is_refused_with_the_reason(name, arguments, message, tmp_path):
    with pytest.raises(ValueError, match=message):
        command_line(name, json.loads(arguments), tmp_path)


def test_the_command_line_of_a_call_is_that_of_a_shell(tmp_path):
    words = command_line("press", {**PRESS, "force": 3000.0, "model": ["hertz", "exact"]}, tmp_path)
    assert words == ["press", "hip-36", "--force=3000", "--model=hertz", "--model=exact", "--json"]
    assert command_line("press", {"joint": "--help"}, tmp_path)[1] == "./--help"
    (tmp_path / "--help.toml").write_text("joint = 'hip-28'", encoding="utf-8")
    assert command_line("study", {"file": "--help.toml"}, tmp_path)[1] == "./--help.toml"
    (tmp_path / "--help.toml").unlink()
    question = command_line("evidence", {"content": "question = 'q'"}, tmp_path)
    assert question[1].endswith(".toml")
    assert question[2] == f"--out={question[1].removesuffix('.toml')}-pack"
    assert [path.name for path in tmp_path.iterdir()] == [question[1]]


PADDING = "./" * 110
OUTSIDE = {
    "table": ("study", 'joint = "hip-28"\nmodel = "hertz"\n[table]\npath = "{}/points.csv"\n'),
    "joint": ("study", 'joint = "{}/joint.toml"\n[axes]\nforce = 1000\n'),
    "cycle": ("wear", 'joint = "hip-28"\n[cycle]\nfile = "{}/cycle.csv"\n[wear]\ncoefficient = 1e-6\n'),
    "data": ("identify", 'joint = "hip-28"\n[free]\nclearance = "0.02..0.3 mm"\n[[data]]\nfile = "{}/points.csv"\n'),
}
QUESTION = (EXAMPLES / "evidence.toml").read_text("utf-8").split("[wear]")[0] + '\n[wear]\nfile = "x.txt"\n'
FILE_OF_A_FILE = pytest.param("evidence", QUESTION, marks=pytest.mark.long, id="file of a file")


@pytest.fixture
def secret(tmp_path):
    """Make a folder outside the server's folder, with readable files."""
    folder = tmp_path / "secret"
    folder.mkdir()
    texts = {"points.csv": "clearance_mm,force_N\n0.123,secret cell\n", "cycle.csv": "secret head, x\n" + "1,2\n" * 9}
    texts["joint.toml"] = '[joint]\nball_radius = "secret length"\nclearance = 0.1\n'
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


@pytest.fixture
def room(tmp_path, monkeypatch):
    """Make the folder of a server, and restrict this process to it like the processes of calls."""
    folder = tmp_path / "room"
    folder.mkdir()
    for name, value in restriction_variables((folder, Path(os.environ["BALLSOCKET_CACHE"]))).items():
        monkeypatch.setenv(name, value)
    return folder


def is_refused(refused):
    """Check that the answer of a call has the reason and nothing of the secret files."""
    return "lies outside the folder of this server" in refused and not re.search("secret (cell|head|length)", refused)


@pytest.mark.parametrize(("name", "content"), [*OUTSIDE.values(), FILE_OF_A_FILE])
@pytest.mark.parametrize("absolute", [False, True])
def test_files_named_by_files_stay_inside_the_folder(name, content, absolute, room, secret):
    root = Path(secret.anchor)
    path = f"{root.as_posix()}{PADDING}{secret.relative_to(root).as_posix()}" if absolute else f"{PADDING}../secret"
    (room / "x.txt").write_text(OUTSIDE["cycle"][1].format(path), encoding="utf-8")
    assert is_refused(refusal(*command_line(name, {"content": content.replace("{}", path)}, room), folder=room))


def test_a_link_to_a_file_outside_the_folder_is_refused(room, secret):
    symlink_or_skip(room / "link", secret)
    name, content = OUTSIDE["table"]
    assert is_refused(run(*command_line(name, {"content": content.format("link")}, room), folder=room).stderr)
    with pytest.raises(ValueError, match="lies outside the folder"):
        command_line("press", {"joint": "link/joint.toml", "force": 1}, room)


@pytest.mark.usefixtures("secret")
def test_a_process_of_a_call_is_restricted_and_stopped_at_its_time_limit(tmp_path):
    name, content = OUTSIDE["table"]
    (tmp_path / "room").mkdir()
    words = command_line(name, {"content": content.format(f"{PADDING}../secret")}, tmp_path / "room")
    result = asyncio.run(run_tool([*LIMITED_PROGRAM, *words], tmp_path / "room", 600.0))
    assert (result.answer, is_refused(result.refusal)) == (None, True)
    result = asyncio.run(run_tool(["-c", "import time; time.sleep(3600)"], tmp_path, 0.5))
    assert (result.answer, result.refusal[:19]) == (None, "stopped after 0.5 s")


BUSY = """
import os
from ballsocket.core.executors.processes import exit_with_parent
exit_with_parent()
print(os.getpid(), file=open("child", "w"), flush=True)
9**9**9
"""
SERVER = f"""
import asyncio, pathlib
from ballsocket.mcp.call import run
asyncio.run(run(["-c", {BUSY!r}], pathlib.Path(), 600.0))
"""


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="no processes in /proc")
def test_a_busy_process_ends_with_its_parent(tmp_path):
    """The child is inside one instruction of Python, which lets no thread run, for hours."""
    note = tmp_path / "child"
    with subprocess.Popen([sys.executable, "-c", SERVER], cwd=tmp_path) as server:
        wait_until(lambda: server.poll() is not None or (note.exists() and note.read_text("ascii").endswith("\n")))
        child = int(note.read_text(encoding="ascii"))
        assert is_running(child)
        server.kill()
    wait_until(lambda: not is_running(child))


def test_a_tool_returns_what_the_command_prints(tmp_path):
    mcp = pytest.importorskip("mcp", reason="the extra for assistants is not installed")
    from ballsocket.mcp import make_server

    async def asked():
        async with mcp.Client(make_server(tmp_path, 600.0, COMMANDS, LIMITED_PROGRAM)) as client:
            listed = await client.list_tools()
            half = await client.call_tool("press", {"joint": "hip-36", "force": 1e12, "model": ["bartel"]})
            refusal = await client.call_tool("press", {"forces": 1})
            return {each.name for each in listed.tools}, half, refusal

    names, half, refusal = asyncio.run(asked())
    assert names == set(TOOLS)
    shell = run("press", "hip-36", "--force=1000000000000", "--model=bartel", "--json")
    assert half.structured_content == json.loads(half.content[1].text) == json.loads(shell.stdout)
    assert (half.is_error, f"ballsocket: {half.content[0].text}\n") == (True, shell.stderr)
    assert refusal.is_error
    assert refusal.content[0].text.startswith("'forces' in a call of press is not known; did you mean 'force'")


def test_content_may_be_an_object_that_follows_the_schema_of_the_file(tmp_path):
    validator = pytest.importorskip("jsonschema").Draft202012Validator
    for tool in some(TOOLS.values(), 1):
        validator.check_schema(schema(tool, COMMANDS))
    content = {"joint": "hip-28", "axes": {"force": ["1 kN", 2000], "liner": "uhmwpe"}}
    study = validator(schema(TOOLS["study"], COMMANDS))
    assert study.is_valid({"content": content})
    assert study.is_valid({"content": 'joint = "hip-28"'})
    assert not study.is_valid({"content": {**content, "axis": {"force": 1}}})
    assert not study.is_valid({"content": {**content, "store": "x"}})
    line = command_line("study", {"content": content}, tmp_path)
    assert tomllib.loads((tmp_path / line[1]).read_text("utf-8")) == content
    assert line[1:] == command_line("study", {"content": (tmp_path / line[1]).read_text("utf-8")}, tmp_path)[1:]


def test_a_missing_extra_is_reported_with_the_install_command(tmp_path, monkeypatch):
    monkeypatch.setattr("ballsocket.core.checks.find_spec", lambda name: None)
    done = run("serve-mcp", folder=tmp_path)
    assert (done.returncode, done.stderr) == (2, 'ballsocket: mcp is not installed: pip install "ballsocket[mcp]"\n')
