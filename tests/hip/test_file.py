"""Hip file and command: results, and inputs that are refused."""

import json
from math import acos, degrees

import pytest

from ballsocket.hip import constrained_share
from ballsocket.hip.config import read_hip
from ballsocket.hip.wear_law import wear_factor, wear_per_slide

from ..cli.command import run
from ..places import EXAMPLES
from .test_cycle_file import write_table

TEXT = (EXAMPLES / "hip_in_use.toml").read_text(encoding="utf-8")


def write_edited_file(path, *changes, text=TEXT):
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file = path / "hip.toml"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_file_without_counts_runs_five_million_cycles_with_ten_equal_reports(tmp_path):
    counts = "cycles = 5e6\nreport_at = [1e6, 2e6, 5e6]\n"
    file = read_hip(write_edited_file(tmp_path, (counts, "")))
    assert file.cycles == 5e6
    assert file.report_at == pytest.approx([5e5 * number for number in range(1, 11)])
    short = read_hip(write_edited_file(tmp_path, (counts, "cycles = 1e4\n")))
    assert short.report_at == pytest.approx([1e3 * number for number in range(1, 11)])


@pytest.mark.parametrize(
    ("tilt", "allowed"), [("0 deg", True), ("89 deg", True), ("90.1 deg", False), ("-1 deg", False)]
)
def test_a_cup_is_tilted_from_the_load_by_up_to_90_degrees(tilt, allowed, tmp_path):
    file = write_edited_file(tmp_path, ('tilt = "30 deg"', f'tilt = "{tilt}"'))
    if allowed:
        dome = read_hip(file).use.placed.dome
        assert degrees(acos(dome[2])) == pytest.approx(float(tilt.split()[0]), abs=1e-5)
    else:
        with pytest.raises(ValueError, match="a cup's tilt from the load is 0 to 90 degrees"):
            read_hip(file)


def test_command_prints_json(tmp_path):
    done = run("hip", str(write_edited_file(tmp_path, ("5e6\n", "2e5\n"), ("[1e6, 2e6, 5e6]", "[1e5, 2e5]"))), "--json")
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    assert answer["cycle"]["slide_mm"] == pytest.approx(22.31, rel=3e-3)
    assert answer["cycle"]["pressure_slide_integral_Nm"] == pytest.approx(30.09, rel=3e-3)
    assert answer["cycle"]["cross_shear_mean"] == pytest.approx(0.107, abs=1e-3)
    assert answer["cycle"]["peaks"]["force_N"] == pytest.approx(3000.0, rel=1e-6)
    assert 0 < answer["cycle"]["crossing_angle_mean_deg"] < 45
    assert answer["cycle"]["peaks"]["speed_mm_s"] == pytest.approx(14.0 * 2 * 3.1416 * 0.375, rel=0.1)  # R ω of flexion
    assert answer["initial"]["wear_mm3_per_Mc"] == pytest.approx(32.1, rel=5e-3)
    assert answer["initial"]["depth_mm_per_Mc"] == pytest.approx(0.192, rel=5e-3)
    seen = {report["cycles"]: report for report in answer["history"]}
    assert list(seen) == [1e5, 2e5]
    assert set(seen[1e5]) >= {"volume", "depth", "penetration", "max_pressure", "creep_depth"}
    assert 0 < answer["error"]["volume"] < 5e-3
    assert isinstance(answer["notes"], list)


@pytest.mark.long
def test_command_runs_five_million_cycles():
    answer = json.loads(run("hip", str(EXAMPLES / "hip_in_use.toml"), "--json").stdout)
    seen = {report["cycles"]: report for report in answer["history"]}
    assert list(seen) == [1e6, 2e6, 5e6]
    assert seen[5e6]["volume"] == pytest.approx(181.6, rel=1e-2)
    assert seen[5e6]["depth"] == pytest.approx(0.392, rel=2e-2)
    assert 0 < answer["error"]["volume"] < 5e-3


def test_command_prints_a_table(tmp_path):
    done = run("hip", str(write_edited_file(tmp_path, ("5e6\n", "1e6\n"), ("[1e6, 2e6, 5e6]", "[1e6]"))))
    assert done.returncode == 0
    assert "33.7" in done.stdout
    assert "cross-shear 0.107" in done.stdout


def test_file_reads_a_cycle_table_next_to_it(tmp_path):
    write_table(tmp_path / "walk.csv")
    given = read_hip(write_edited_file(tmp_path, ('name = "iso-14242-1"', 'file = "walk.csv"')))
    assert given.use.first.volume == pytest.approx(32.1, rel=5e-3)


def test_tilt_and_inclination_orient_the_cup(tmp_path):
    tilted = read_hip(write_edited_file(tmp_path)).use
    inclined = read_hip(write_edited_file(tmp_path, ('tilt = "30 deg"', 'inclination = "30 deg"'))).use
    assert tilted.placed == inclined.placed
    with pytest.raises(ValueError, match="tilt and inclination exclude each other"):
        read_hip(write_edited_file(tmp_path, ('tilt = "30 deg"', 'tilt = "30 deg"\ninclination = "30 deg"')))


def test_file_selects_the_springs_of_a_model(tmp_path):
    given = read_hip(write_edited_file(tmp_path, ('contact = "springs"', 'contact = "springs"\nmodel = "vessel"')))
    assert given.use.first.max_pressure > 1.01 * read_hip(write_edited_file(tmp_path)).use.first.max_pressure
    with pytest.raises(ValueError, match="the model 'hertz' has no radial springs; models with springs: hess-forsbach"):
        read_hip(write_edited_file(tmp_path, ('contact = "springs"', 'model = "hertz"')))


def test_file_accepts_the_name_of_a_joint(tmp_path):
    head, tail = TEXT.split("[joint]")[0], TEXT[TEXT.index("[cup]") :]
    given = read_hip(write_edited_file(tmp_path, text=f'{head}joint = "hip-28"\n{tail}'))
    assert given.use.joint.ball_radius == 14.0
    with pytest.raises(ValueError, match=r"joint = 'hip-28' is a whole joint: \[liner\] belongs to a table \[joint\]"):
        read_hip(write_edited_file(tmp_path, text=f'{head}joint = "hip-28"\n[liner]\nyoung = 3\n{tail}'))


@pytest.mark.parametrize(
    ("old", "new", "refused"),
    [
        ("mm^3/(N m)", "mm^3/(N mm)", r"1 mm\^3/\(N mm\) is 1000 mm\^3/\(N m\), so that this is 0.001066 mm"),
        ("mm^3/(N m)", "mm^3/N", r"has the wrong unit; expected mm\^3/\(N m\)"),
        (
            'coefficient = "1.066e-6 mm^3/(N m)" #',
            "#",
            "the law 'archard' needs coefficient .*such as coefficient = '1e-06",
        ),
        ('law = "archard"', 'law = "archart"', "law 'archart' is not known; did you mean 'archard'"),
        ('law = "archard"', 'law = "area"', "has the wrong unit; expected mm/mm, a depth over a length of sliding"),
        (
            'law = "archard"',
            'law = "cross-shear"',
            r"the law 'cross-shear' needs circular \(wear factor on a",
        ),
        ('law = "archard"', 'law = "energy"', "the law 'energy' needs friction"),
        ('law = "archard"', 'law = "archard"\nfriction = 0.1', "friction belongs to the law 'energy'"),
        ('law = "archard"', 'law = "archard"\nball_coefficient = "1 mm^3/(N mm)"', "ball_coefficient = .* is 1000"),
        ('law = "archard"', 'law = "archard"\nexponent = 1', "exponent belongs to the law 'cross-shear'"),
        ('contact = "springs"', 'contact = "spring"', "contact = 'spring' is not known; did you mean 'springs'"),
        ('name = "iso-14242-1"', 'name = "iso-14242"', "cycle 'iso-14242' is not known"),
        ('name = "iso-14242-1"', 'name = "iso-14242-1"\nfile = "x.csv"', "needs either a name or a file"),
        ("instants = 100", "instants = 3", "instants = 3 is not allowed"),
        (
            "instants = 100",
            'instants = 100\nforce = "2 kN"',
            "'force' with the name 'iso-14242-1' in .cycle. is not known",
        ),
        ("flexion, adduction", "flexion, flexion", "rotation_order = 'flexion, flexion, rotation' is not allowed"),
        (
            'tilt = "30 deg"',
            'tilt = "95 deg"',
            "tilt = 95 is not allowed: a cup's tilt from the load is 0 to 90",
        ),
        ('tilt = "30 deg"', 'tilt = "30 deg"\narc = 3', "'arc' in .cup. is not known; did you mean 'arc_of_cover'"),
        ("180 deg", "55 deg", r"dislocated at 0\.5 % of the cycle: .*30\.0° from the dome's pole.* ends at 27\.5°"),
        ("cycles = 5e6", "cycles = 1e6", "report_at = 2e.06 is not allowed: it lies between 0 and"),
        ("cycles = 5e6", 'cycles = "many"', "cycles = 'many' must be a number, such as 5e6"),
        ("report_at = [1e6, 2e6, 5e6]", "report_at = 1e6", "report_at = 1000000.0 must be a list"),
        ("[wear]", "[waer]", "'waer' at the top is not known; did you mean 'wear'"),
        ("clearance = ", "clearence = ", "'clearence' in .joint. is not known; did you mean 'clearance'"),
    ],
)
def test_wrong_files_are_refused_in_one_line(tmp_path, old, new, refused):
    file = write_edited_file(tmp_path, (old, new))
    with pytest.raises(ValueError, match=f"hip.toml: .*{refused}"):
        read_hip(file)
    done = run("hip", str(file))
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1


def test_file_reads_the_energy_law_and_ball_wear(tmp_path):
    energy = 'law = "energy"\nfriction = 0.05\nball_coefficient = "1e-6 mm^3/J"'
    use = read_hip(
        write_edited_file(tmp_path, ('law = "archard"', energy), ("1.066e-6 mm^3/(N m)", "2e-2 mm^3/kJ"))
    ).use
    assert (use.wear.coefficient, use.wear.friction) == (pytest.approx(2e-5), 0.05)
    assert use.ball_wear.coefficient == pytest.approx(1e-6)


@pytest.mark.parametrize(
    "text", ["1e-6 mm^3/(N m)", "1e-6 mm³/(N·m)", "1e-6 mm3/Nm", "1e-6 mm^3/N/m", "1e-15 m^3/(N m)", "1e-6", 1e-6]
)
def test_wear_factors_are_read_in_many_spellings(text):
    assert wear_factor("coefficient", text) == pytest.approx(1e-6, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "refused"),
    [
        ("1e-9 mm3/Nmm", r"is for mm of sliding: .* is 1000 mm\^3/\(N m\), so that this is 1e-06"),
        ("1e-9 mm^2/N", r"1 mm\^2/N is 1000 mm\^3/\(N m\)"),
        ("1e-9 mm^3/(kN m)", r"for another length of sliding|is 0.001 mm\^3/\(N m\)"),
        ("1 kg", "has the wrong unit"),
        ("1e-6 __import__", "is not a coefficient, such as"),
        ("much", "is not a coefficient, such as"),
        (True, "is not a coefficient, such as"),
        ("-1e-6 mm^3/(N m)", "coefficient = -1e-06 is not allowed"),
        (float("nan"), "coefficient = nan is not allowed"),
    ],
)
def test_invalid_wear_factors_are_refused(text, refused):
    with pytest.raises(ValueError, match=refused):
        wear_factor("coefficient", text)


def test_area_coefficients_are_read_in_many_spellings():
    for text in ("1e-6 mm/m", "1e-6 mm^3/(mm^2 m)", "1e-9", 1e-9):
        assert wear_per_slide("coefficient", text) == pytest.approx(1e-9, rel=1e-12)


def test_file_reads_creep_and_film(tmp_path):
    film = '[film]\nviscosity = 1e-3\ncup_roughness = "0.5 um"\nfriction = 0.04\n'
    given = read_hip(write_edited_file(tmp_path, text=f"{TEXT}\n[creep]\n{film}"))
    assert len(given.use.creep.times) == 9
    assert given.use.creep.confinement == 1.0
    walls = read_hip(write_edited_file(tmp_path, text=f'{TEXT}\n[creep]\nconfinement = "constrained"\n'))
    assert walls.use.creep.confinement == constrained_share(0.4)
    assert given.lubricant.cup_roughness == pytest.approx(5e-4)
    own = "[creep]\ncompliances = [1e-3, 2e-3]\ntimes = [60, 3600]\nseconds_per_cycle = 3\n"
    given = read_hip(write_edited_file(tmp_path, text=f"{TEXT}\n{own}"))
    assert given.use.creep.times == (60.0, 3600.0)
    assert given.use.seconds == 3.0


@pytest.mark.parametrize(
    ("table", "refused"),
    [
        ('[creep]\nlaw = "log"', "creep law 'log' is not known; did you mean 'logarithmic'"),
        ('[creep]\nlaw = "logarithmic"\ntimes = [1]', "times belongs to the law 'kelvin-voigt'"),
        ("[creep]\ntimes = [1]", "the law 'kelvin-voigt' needs compliances .*, such as compliances = .0.001, 0.002."),
        ("[creep]\ntimes = [1]\ncompliances = [1, 2]", "as many compliances as times"),
        ('[creep]\nconfinement = "walls"', "confinement = 'walls' is not known"),
        ("[creep]\nseconds_per_cycle = 0", "seconds_per_cycle = 0 is not allowed"),
        ("[film]\nviscosity = -1", "viscosity = -1 is not allowed"),
        ("[film]\nviscosities = 1", "'viscosities' in .film. is not known; did you mean 'viscosity'"),
    ],
)
def test_invalid_creep_and_film_tables_are_refused(tmp_path, table, refused):
    with pytest.raises(ValueError, match=refused):
        read_hip(write_edited_file(tmp_path, text=f"{TEXT}\n{table}\n"))
