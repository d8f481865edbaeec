"""Every input gives a result or a refusal in one sentence, within 5 s and 1 GB."""

from hypothesis import given
from hypothesis import strategies as st

from ballsocket.files.joint_file import joint_of, parse_joint
from ballsocket.files.joint_toml import tables_of

from ..places import EXAMPLES
from . import damage
from .limits import check_command, check_sentence, inputs, within_limits
from .words import values

CLOSED = (["--model", "hess-forsbach"], ["--model", "hertz", "--json"], ["--model", "tabulated", "--json"])
STORED = ([], [], [], [], ["--store", "store"])
MODELS = (*CLOSED * 6, [], ["--all"])
JOINTS = (
    b'name = "a"\n[joint]\nball_radius = 14\nclearance = "0.1 mm"\nliner_thickness = 5.0\n[liner]\nyoung = "1 GPa"\n'
    b"poisson = 0.4\nyield_stress = 21\n[load]\nindentation = 0.04\n[cup]\narc_of_cover = 170\nchamfer = 0.5\n",
    b'[joint]\nhead_diameter = "36 mm"\ndiametral_clearance = 0.3\nouter_diameter = 52\nsupport = "free"\n[liner]\n'
    b'material = "uhmwpe"\n[ball]\nmaterial = "cocr"\n[load]\nhalf_angle = "30 deg"\n[[backing]]\nthickness = 3\n'
    b'material = "titanium"\nyoung = 9e4\n[cup]\ninclination = 45\nside = "left"\ninterface = "sliding"\n',
    *(path.read_bytes() for path in sorted(EXAMPLES.glob("*.toml"))),
)
joints = damage.file_of(*JOINTS)
TABULAR = b'joint = "hip-28"\n[table]\npath = "points.csv"\n[axes]\nforce = 1000\n'
STUDIES = (
    TABULAR,
    b'joint = "hip-28"\nmodel = "hertz"\nquantities = ["max_pressure", "stiffness"]\n[axes]\nforce = ["1 kN", 3000]\n'
    b'clearance = {from = "50 um", to = 0.2, count = 3}\nliner = ["pom", "uhmwpe"]\n[engine]\nkind = "serial"\n',
    b'model = "tabulated"\n[joint]\nball_radius = 14\nclearance = 0.1\nliner_thickness = 5\n[liner]\nmaterial = "pom"\n'
    b'[axes]\nindentation = 0.04\n[samples]\ncount = 4\nseed = 1\nmethod = "latin-hypercube"\n'
    b'liner_young = {median = "1 GPa", factor = 1.1}\nclearance = {nominal = "0.1 mm", plus_minus = "50 um"}\n'
    b'ball_radius = {low = 13, high = 15}\ncorrelation = ["clearance, liner_young = 0.5"]\n',
)
TABLES = (
    b"ball_radius,clearance,half_angle_deg\n16,0.1,40\n14,0.05,50\n",
    b"# made by hand\nliner_young [GPa],clearance_um,liner\n1,100,pom\n0.7,200,uhmwpe\n",
    *(b"clearance\n0.1\n" + b'"' * 999, b"a," * 20_000, b"clearance\n" + b"1" * 200_000, b"clearance\r0.1\r0.2"),
)
rows = damage.table_of(*TABLES) | st.sampled_from((b"PAR1", b"\xff\xfe"))
LINES = """
press | hip-28 | --force=3 kN | --model=tabulated | --all
press | --ball-radius=14 | --clearance=0.1 mm | --liner-thickness=5 | --young=1 GPa | --poisson=0.4 | --force=900 N
press | --head-diameter=28 | --diametral-clearance=0.2 | --outer-diameter=39 | --liner=pom | --half-angle=30
press | hip-36 | --indentation=40 um | --ball=steel | --ball-young=2e5 | --arc-of-cover=170 | --chamfer=1 | --json
press | hip-36 | --force=2 kN | --outer-radius=25 | --ball-poisson=0.3 | --interface=bonded | --model=hertz
map | hip-28 | --force=3 kN | --points=3 | --x=ball_radius=8..20 | --y=clearance=0.02..0.4 mm | --limit=area<=3 cm^2
map | hip-28 | --indentation=0.04 | --points=5 | --limit=outer_radius<=26 mm | --model=hess-forsbach
optimise | hip-28 | --force=1 kN | --vary=clearance=50..200 um | --minimise=area | --points=3 | --limit=half_angle<40
sensitivity | hip-28 | --force=3 kN | --spread=clearance=0.1+-0.05 mm | --spread=liner_young=0.7..1.1 GPa | --count=8
sensitivity | hip-28 | --force=3 kN | --spread=ball_radius=14±0.5 | --count=16 | --of=max_pressure | --intervals=none
sensitivity | hip-28 | --force=1 kN | --spread=clearance=0.1+-0.05 | --correlation=clearance, liner_young = 0.5
deck | hip-28 | --force=3 kN | --out=out | --steps=2 | --scale=1 | --element=bilinear | --element-size=0.9 mm
calibrate | hip-36 | --force=2 kN | --thickness=3 mm | --thickness=5 | --form=corrected-vessel
cite | hertz
models | hertz
presets | --help
pres | --forse | 1
"""
COMMANDS = [line.split(" | ") for line in LINES.strip().splitlines()]
ODD_WORDS = st.sampled_from(("--", "x" * 3000)).map(lambda odd: lambda word: [word, odd])
words = damage.lines_of(COMMANDS, damage.value_after("=", values) | ODD_WORDS)


@inputs(7)
@given(raw=joints, model=st.sampled_from(MODELS))
def test_joint_files(raw, model):
    check_command({"joint.toml": raw}, "press", "joint.toml", *model)


@inputs(10)
@given(words=words)
def test_command_lines(words):
    check_command({}, *words)


@inputs(8)
@given(raw=damage.file_of(*STUDIES) | st.just(TABULAR), csv=rows, store=st.sampled_from(STORED))
def test_study_files(raw, csv, store):
    check_command({"study.toml": raw, "points.csv": csv}, "study", "study.toml", *store)


@inputs(12)
@given(raw=joints)
def test_uploads(raw):
    """An uploaded file is refused, or a joint that is read from its own text as the same."""
    with within_limits():
        try:
            file = parse_joint(raw, "the file")
        except ValueError as error:
            check_sentence(" ".join(str(error).split()))
            return
        again = joint_of(tables_of(file))
        assert again.joint == file.joint
        assert joint_of(tables_of(again)) == again
