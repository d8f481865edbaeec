"""The door: units and joint files."""

import math
import re
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.kinds import Kind
from ballsocket.files.joint_file import Direction, JointFile, joint_of, parse_joint
from ballsocket.files.joint_toml import tables_of, toml_of
from ballsocket.files.schema import Angle
from ballsocket.files.units import parse
from ballsocket.studies.file import read_study

from ..places import EXAMPLES
from ..refusals import edited, text_tables

HIP = """
[joint]
ball_radius = 17.9
clearance = "100 um"
liner_thickness = "6.75 mm"
[liner]
material = "UHMWPE"
"""


QUANTITIES = {
    "length": {"16 mm": 16.0, "1.6 cm": 16.0, "100 µm": 0.1, "1e-1mm": 0.1, "inf": math.inf, 16: 16.0},
    "force": {"3 kN": 3000.0},
    "modulus": {"1 GPa": 1000.0, "1000 N/mm**2": 1000.0, "1000 N/mm^2": 1000.0},
    "angle": {"45 deg": math.pi / 4, "45°": math.pi / 4, 45: math.pi / 4, "0.5 rad": 0.5},
    "number": {"0.4": 0.4, "1/4": 0.25},
    "area": {"8 cm^2": 800.0, "800 mm²": 800.0, "800 mm2": 800.0},
    "stiffness": {"60 kN/mm": 60e3},
    "energy": {"50 N mm": 50.0, "50 mJ": 50.0},
    "foundation modulus": {"0.28 GPa/mm": 280.0},
}
FRACTIONS = {"3/8 in": 0.375 * 25.4, "1 1/8in": 1.125 * 25.4, "1-1/8 in": 1.125 * 25.4, "-1 1/2": -1.5}


@pytest.mark.parametrize("kind", QUANTITIES)
def test_quantities_have_units_and_fractions(kind):
    for text, value in {**QUANTITIES[kind], **(FRACTIONS if kind == "length" else {})}.items():
        assert parse("it", text, kind) == pytest.approx(value), text


NO_QUANTITIES = {
    "length": ["16 kg", "16 mmm", "__import__('os')", "", True, None, [1], "1 " + "m" * 10_000],
    "force": ["((", "1 N**9", "3 kN + 2 kN", "1 N**0", "1 dBm*m", "1 N*m" + "/m*m" * 400 + "/m", "1" * 400],
    "modulus": ["9**9**9**9", "1 " + "N*" * 3000 + "N"],
    "number": ["0.4 mm", "1 9/8", "1/2.5"],
    "fraction": ["1 9/8 in", "1/0 in", "1/2/4 in", "1 -1/8 in"],
}


@pytest.mark.parametrize("kind", NO_QUANTITIES)
def test_what_is_no_quantity_is_named(kind):
    for text in NO_QUANTITIES[kind]:
        with pytest.raises(ValueError, match=r"^it = .* is not a") as refused:
            parse("it", text, kind.replace("fraction", "length"))
        assert len(str(refused.value)) < 120


@pytest.mark.parametrize(
    "value",
    [10**400, 16**9000, -(10**400), "1e999", "-1e999", "1e999 kN", "1e308 GN"],
    ids=lambda value: f"{value!s:.9}" if isinstance(value, str) else "integer",
)
def test_a_number_is_infinite_only_where_that_is_said(value):
    with pytest.raises(ValueError, match=r"^it = .{1,60} is too large a number$"):
        parse("it", value, "force")
    assert parse("it", " -Infinity ", "force") == -math.inf


def refused_at_once(do):
    """Check that input is refused in little processor time, however long it is."""
    start = time.process_time()
    with pytest.raises(ValueError) as refused:  # noqa: PT011 (any message)
        do()
    assert time.process_time() - start < 10.0  # far above the time that any machine needs, far below an endless parse
    assert len(str(refused.value)) < 400


@pytest.mark.parametrize(
    "text", ["1" * 20_000 + "!", "1 " + "m " * 20_000 + "!", "1." + "0" * 20_000 + "e", "1 " + "m*" * 99]
)
def test_long_text_is_refused_at_once(text):
    refused_at_once(lambda: parse("it", text, "length"))


LONG_FILES = {
    "dots": b"joint." + b"a." * 15_000 + b"b = 1",
    "header": b"[" + b"a." * 15_000 + b"b]",
    "quoted": b"joint." + b'"a" . ' * 15_000 + b"b = 1",
    "escapes": b'"' + b'\\"' * 49_000,
    "name": b"a" * 99_000 + b" = 1",
    "tables": b"joint = {" + b"a = {" * 15_000,
    "hexadecimal": b"[joint]\nball_radius = 0x" + b"f" * 90_000,
    "digits": b"[joint]\nball_radius = 1" + b"0" * 90_000,
    "exponent": b"[joint]\nball_radius = 1e" + b"9" * 90_000,
    "lists": b"joint = " + b"[" * 400 + b"]" * 400,
    "text": b"joint = '" + b"a" * 90_000 + b"'",
    "layers": b"[[backing]]\nthickness = 1\nmaterial = 'pom'\n" * 2000,
}


@pytest.mark.parametrize("name", LONG_FILES)
@pytest.mark.parametrize("read", [bs.read_joint, read_study])
def test_long_files_are_refused_at_once(read, name, tmp_path):
    path = tmp_path / "it.toml"
    path.write_bytes(LONG_FILES[name])
    refused_at_once(lambda: read(path))


@pytest.mark.parametrize("read", [bs.read_joint, read_study])
def test_a_file_that_never_ends_is_refused(read):
    device = Path("/dev/zero")
    if not device.exists():
        pytest.skip("there is no such device here")
    refused_at_once(lambda: read(device))


def test_a_source_may_have_tabs_and_line_ends():
    assert parse_joint(f"source = 'Hall,\tJ.\\nTribology'\n{HIP}".encode(), "hip").joint.source


LOADED = [path for path in sorted(EXAMPLES.glob("*.toml")) if "[load]" in path.read_text(encoding="utf-8")]


@pytest.mark.parametrize("path", LOADED, ids=lambda path: path.stem)
def test_every_example_presses(path):
    file = bs.read_joint(path)
    if preloaded := file.joint.clearance < 0:
        pytest.importorskip("skfem")
    model = bs.Sphere(cup=file.cup, ring_width=np.radians(4.0)) if preloaded else bs.HessForsbach()
    contact = model.press(file.joint, **file.load)
    assert contact.valid, contact.notes


BACKED = HIP.replace("[joint]", '[joint]\nsupport = "free"')
BACKED += """
[[backing]]
thickness = "0.4 cm"
material = "Titanium"
[[backing]]
thickness = 2
young = "2 GPa"
poisson = 0.35
[[backing]]
thickness = "inf"
material = "cortical bone"
young = "16 GPa"
"""


def test_a_backing_is_listed_from_the_liner_outwards_and_goes_through_a_summary():
    joint = parse_joint(BACKED.encode(), "hip").joint
    shell, cement, bone = joint.backing
    assert shell == bs.Layer(thickness=4.0, material=bs.TITANIUM)
    assert cement == bs.Layer(thickness=2.0, material=bs.Material(young=2000.0, poisson=0.35))
    assert (bone.thickness, bone.material.young, bone.material.poisson) == (math.inf, 16000.0, 0.3)
    assert joint.support is bs.Support.FREE
    told = joint.summary()
    layers = [{name: value for name, value in layer.items() if name != "name"} for layer in told["backing"]]
    table = {
        "joint": {name: told[name] for name in ("ball_radius", "clearance", "liner_thickness", "support")},
        "liner": {"material": told["liner"]["name"]},
        "backing": layers,
    }
    again = joint_of(table).joint
    assert again.numbers() == joint.numbers()
    assert again.summary() | {"backing": layers} == told | {"backing": layers}


def test_two_radii_fix_a_third_and_numbers_win_over_a_named_material():
    file = parse_joint(HIP.encode(), "hip")
    assert file.joint.socket_radius == 18.0
    assert (file.joint.liner, file.joint.ball, file.load) == (bs.UHMWPE, None, {})
    other = parse_joint(HIP.replace('clearance = "100 um"', "socket_radius = 18").encode(), "hip")
    assert other.joint.clearance == 0.1
    lengths = 'head_diameter = "35.8 mm"\ndiametral_clearance = "200 um"\nouter_diameter = "4.95 cm"\n'
    assert parse_joint(f"[joint]\n{lengths}[liner]\nmaterial = 'UHMWPE'".encode(), "hip") == file
    shell = "[[backing]]\nthickness = 3\nmaterial = 'titanium'\n"
    bone = "[[backing]]\nthickness = inf\nmaterial = 'cortical-bone'"
    text = HIP.replace('liner_thickness = "6.75 mm"', "outer_diameter = 55.5")
    assert parse_joint(f"{text}{shell}{bone}".encode(), "hip").joint.liner_thickness == 6.75
    liner = parse_joint(HIP.replace('"UHMWPE"', '"uhmwpe"\npoisson = 0.45').encode(), "hip").joint.liner
    assert (liner.young, liner.poisson) == (1000.0, 0.45)


JOINTS, BACKINGS, _ = text_tables(Path(__file__).parent / "refused.txt")
LAYERS = "[[backing]]\nthickness = 1\nmaterial = 'pom'\n"
JOINTS.append(("[joint]", 99 * LAYERS + "[joint]", "99 layers are behind the liner"))
JOINTS.append(("[joint]", f"name = '{'a' * 2000}'\n[joint]", "name = 'a+[.]{3} must be at most 1000 characters"))


@pytest.mark.parametrize(("text", "edit"), [*((HIP, row) for row in JOINTS), *((BACKED, row) for row in BACKINGS)])
def test_a_file_that_is_wrong_is_refused_with_the_reason(text, edit):
    *change, message = edit
    with pytest.raises(ValueError, match=f"^hip.*{message}"):
        parse_joint(edited(text, *change).encode(), "hip")


@pytest.mark.parametrize("kind", Kind)
def test_every_kind_is_read_and_refused_in_its_own_words(kind):
    example = kind.example.split("such as ")[1].strip("'")
    assert parse("it", example, kind) > 0
    assert parse("it", f"2 {kind.assumed_unit}".strip(), kind) == parse("it", 2, kind)
    assert str(parse("it", f"-0 {kind.assumed_unit}".strip(), kind)) == "0.0"
    with pytest.raises(ValueError, match=f"it = '2 A' is not {re.escape(kind.example)}"):
        parse("it", "2 A", kind)


@pytest.mark.parametrize(("read", "kind"), [(bs.read_joint, "joint"), (read_study, "study")], ids=["joint", "study"])
@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"#" * 200_000, "it.toml is larger than 100000 bytes; a {kind} file is a few lines"),
        (b'name = "a"\n\xff\xfe\x00', "it.toml is not text in UTF-8: invalid start byte at byte 11"),
        (b"a=" + b"[" * 30_000, "it.toml is no {kind} file: its brackets are nested too deeply"),
        (b"[joint\n", "it.toml is not TOML: .* line 1"),
        (b"a" + b".a" * 20 + b" = 1", "it.toml is not TOML: a name of more than 16 parts"),
        (b"joints = 3\n", "it.toml: 'joints' at the top is not known; did you mean 'joint'?"),
    ],
)
def test_files_are_refused_alike_whatever_they_should_hold(read, kind, content, message, tmp_path):
    path = tmp_path / "it.toml"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=message.format(kind=kind)):
        read(path)
    with pytest.raises(FileNotFoundError):
        read(tmp_path / "none.toml")


STRONG = f"""{HIP}
young = "0.9 GPa"
yield_stress = "23 MPa"
allowable_pressure = 15
[ball]
young = 2e5
poisson = 0.3
fatigue_limit = "0.4 GPa"
"""


def test_strengths_are_read_with_units_and_written_again_and_so_is_one_that_is_not_known():
    pytest.importorskip("tomli_w")
    file = parse_joint(STRONG.encode(), "file")
    liner, ball = file.joint.liner, file.joint.ball
    assert (liner.young, liner.yield_stress, liner.fatigue_limit, liner.allowable_pressure) == (900.0, 23.0, None, 15.0)
    assert (ball.yield_stress, ball.fatigue_limit) == (None, 400.0)
    again = parse_joint(toml_of(file).encode(), "file").joint
    assert (again.liner.strengths, again.ball) == (liner.strengths, ball)
    with pytest.raises(ValueError, match="liner.yield_stress = '0 MPa' is not allowed: a yield stress"):
        parse_joint(STRONG.replace("23 MPa", "0 MPa").encode(), "file")
    bare = replace(bs.joints["hip-28"], liner=replace(bs.UHMWPE, yield_stress=None))
    again = joint_of(tables_of(JointFile(bare, {}))).joint
    assert again.liner.yield_stress is None


def test_a_hardening_is_read_with_units_and_written_again():
    pytest.importorskip("tomli_w")
    text = STRONG.replace("23 MPa", '23 MPa"\nhardening = "0.02 GPa:0, 24:0.01; E 1.2 GPa')
    file = parse_joint(text.encode(), "file")
    assert file.joint.liner.hardening == bs.Hardening(stress=(20.0, 24.0), plastic_strain=(0.0, 0.01), young=1200.0)
    assert parse_joint(toml_of(file).encode(), "file").joint.liner == file.joint.liner
    hip = bs.joints["hip-28"]
    assert "hardening" not in tables_of(JointFile(hip, {}))["liner"]
    without, named = replace(bs.UHMWPE, hardening=None), replace(bs.UHMWPE, name="mine")
    others = hip.replace(liner=without, ball=named, backing=(bs.Layer(thickness=3.0, material=named),))
    again = parse_joint(toml_of(JointFile(others, {"force": 3e3})).encode(), "file").joint
    assert (again.liner.hardening, again.liner.yield_stress) == (None, bs.UHMWPE.yield_stress)
    assert again.ball.yield_stress == again.backing[0].material.yield_stress == named.yield_stress
    with pytest.raises(ValueError, match=r"hardening = '0.02 GPa, 24:0.01; E.* must be points 'stress:plastic strain'"):
        parse_joint(text.replace("GPa:0", "GPa").encode(), "file")


def test_an_angle_is_written_with_the_digits_that_were_typed_and_read_back_to_the_last_bit():
    """The nearest degrees of some angles give another angle; a neighbour gives the same."""
    for degrees in (30.0, 84.8, 0.1, 33.3, 35.668, 22.123456789, 120.000000001):
        assert Angle(math.radians(degrees)).write(with_unit=False) == degrees
    for angle in (1.8906655686558533, -3.058855722527143, 2.590331057056523, math.pi / 3):
        assert math.radians(Angle(angle).write(with_unit=False)) == angle


def test_a_load_may_have_a_short_direction():
    assert Direction.read("direction", [0, 0.3, 0.4]) == (0.0, 0.3, 0.4)
    with pytest.raises(ValueError, match="length of direction"):
        Direction.read("direction", [0, 0, 0])
