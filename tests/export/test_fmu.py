"""The element as an FMU: its contents, its use in hosts, and the loads of the element in Python."""

import shutil
import zipfile
from dataclasses import replace
from itertools import groupby, product
from pathlib import Path
from xml.etree.ElementTree import fromstring

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import ballsocket as bs
from ballsocket.dynamics import Bristles, Damping, ForceElement, Friction, Prony, simulate
from ballsocket.export.compiler import shared_library
from ballsocket.export.fmu import Fmu, write_cross_check
from ballsocket.export.fmu.reference_results import reference_loads, states_in_si, trajectory

from ..cli.command import run
from ..extent import some
from ..joints import HIP
from ..places import ROOT
from .library import Host, description, hosted, needs_compiler, packed, table

LOSSES = {"damping": Damping(hysteresis=0.004), "friction": Friction(coefficient=0.05)}
ELEMENT = ForceElement(bs.HessForsbach(), HIP, lubricant=bs.Lubricant(), **LOSSES)
VERSIONS = [2, 3]
STATE = [f"{name}[{axis}]" for name in ("position", "velocity", "spin") for axis in (1, 2, 3)]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("fmu")
    for version in VERSIONS:
        Fmu(element=ELEMENT, name="hip", version=version).write(folder / f"hip{version}.fmu")
        write_cross_check(ELEMENT, folder / f"hip{version}.fmu")
    return folder


def assert_compiles(unit, folder, fmpy):
    """Compile the sources without a warning, with their own declarations of FMI and with those of the standard."""
    for name, text in unit.sources.items():
        (folder / name).write_text(text, encoding="utf-8")
    official = ("-DFMI_HEADERS", "-isystem", str(Path(fmpy.__file__).parent / "c-code"))
    for options in (official, ("-pedantic-errors",)):
        strict = (*options, "-Wall", "-Wextra", "-Werror")
        assert shared_library(unit.c_sources, folder / "hip.so", folder, strict).exists()


def cross_checked(fmpy, unit, csv, kind="ModelExchange"):
    """Outputs of a unit with the input of a cross check, and its reference."""
    given, reference = (table(f"{csv}_{part}.csv") for part in ("in", "ref"))
    return fmpy.simulate_fmu(unit, fmi_type=kind, input=given, stop_time=0.1, output_interval=1e-3), reference


def test_equal_elements_give_equal_archives(folder):
    same = ForceElement(bs.HessForsbach(), HIP, lubricant=bs.Lubricant(), **LOSSES)
    Fmu(element=same, name="hip").write(folder / "again.fmu")
    assert (folder / "again.fmu").read_bytes() == (folder / "hip3.fmu").read_bytes()
    other = Fmu(element=ForceElement(bs.HessForsbach(), HIP), name="hip")
    assert other.guid != Fmu(element=ELEMENT, name="hip").guid


@pytest.mark.parametrize("version", VERSIONS)
def test_files_of_an_archive_are_readable_have_one_date_and_the_order_of_their_names(version, folder):
    with zipfile.ZipFile(folder / f"hip{version}.fmu") as archive:
        entries, names = archive.infolist(), archive.namelist()
        page = archive.read("documentation/index.html").decode()
        licence = archive.read("documentation/licenses/license.txt").decode()
    assert names == sorted(names)
    assert {"modelDescription.xml", "sources/hip.c", "sources/hip.h", f"sources/fmi{version}.c"} <= set(names)
    assert ("sources/buildDescription.xml" in names) == (version == 3)
    assert "an explicit integration is stable below" in page
    assert licence == (ROOT / "LICENSE").read_text("utf-8")
    for entry in entries:
        assert entry.date_time == (1980, 1, 1, 0, 0, 0)
        assert (entry.create_system, entry.external_attr >> 16) == (3, 0o644)  # files of Unix
        assert entry.compress_type == zipfile.ZIP_DEFLATED


@pytest.mark.parametrize("version", some(VERSIONS, 1))
def test_a_missing_compiler_is_reported_and_the_sources_are_written(version, tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    done = run("fmu", "hip-28", "--out", "my-hip.fmu", "--fmi", str(version), folder=tmp_path)
    assert done.returncode == 0
    assert "CC is 'no-such-compiler', which is not installed; the archive contains the sources without" in done.stderr
    with zipfile.ZipFile(tmp_path / "my-hip.fmu") as archive:
        assert "sources/my_hip.c" in archive.namelist()
        assert not any(name.startswith("binaries") for name in archive.namelist())


@pytest.mark.parametrize(("version", "tag", "key"), [(2, "Unknown", "index"), (3, "Output", "valueReference")])
def test_loads_depend_on_the_state_and_the_contact_on_the_position(version, tag, key, folder):
    root = description(folder / f"hip{version}.fmu")
    variables = root.find("ModelVariables")
    names = {each.get("valueReference"): each.get("name") for each in variables}
    if version == 2:  # an index is the place in the list, from 1
        names = {str(place): each.get("name") for place, each in enumerate(variables, 1)}
    outputs = root.find("ModelStructure/Outputs" if version == 2 else "ModelStructure")
    dependencies = {names[each.get(key)]: each.get("dependencies") for each in outputs.iter(tag)}
    state = set(STATE)
    position = {name for name in state if name.startswith("position")}
    loads = {f"{name}[{axis}]" for name in ("force", "moment") for axis in (1, 2, 3)}
    expected = dict.fromkeys(loads, state) | dict.fromkeys(("energy", "half_angle", "max_pressure", "status"), position)
    assert {name: {names[each] for each in numbers.split()} for name, numbers in dependencies.items()} == expected
    assert [int(each.get("valueReference")) for each in variables if each.get("name") != "time"] == list(range(1, 31))


def test_units_are_powers_of_the_base_units_and_starts_are_in_si(folder):
    """1 N = kg m/s², 1 Pa = kg/(m s²), 1 J = kg m²/s²; a hysteresis of 0.004 s/mm is 4 s/m."""
    for version, tag in ((2, "ScalarVariable"), (3, "Float64")):
        variables = {each.get("name"): each for each in description(folder / f"hip{version}.fmu").iter(tag)}
        units = {name: (each.find("Real") if version == 2 else each).get("unit") for name, each in variables.items()}
        expected = {"position[3]": "m", "spin[1]": "rad/s", "moment[2]": "N.m", "max_pressure": "Pa"}
        assert expected.items() <= units.items()
        friction = variables["friction_coefficient"]
        assert (friction.get("causality"), friction.get("variability")) == ("parameter", "tunable")
    root = description(folder / "hip3.fmu")
    units = {each.get("name"): each.find("BaseUnit").attrib for each in root.find("UnitDefinitions")}
    for unit, power in {"N": "1", "Pa": "-1", "J": "2", "N.m": "2"}.items():
        assert units[unit] == {"kg": "1", "m": power, "s": "-2"}
    starts = {each.get("name"): each.get("start") for each in root.find("ModelVariables")}
    for name, value in {"hysteresis": 4.0, "friction_coefficient": 0.05, "transition_speed": 1e-4}.items():
        assert float(starts[name]) == pytest.approx(value)
    assert (starts["position[1]"], starts["force[1]"]) == ("0.0", None)


@pytest.mark.parametrize("clearance", [0.1, 0.01])
def test_the_trajectory_reaches_from_one_hundredth_of_the_clearance_apart_to_three_in_contact(clearance):
    element = ForceElement(bs.HessForsbach(), HIP.replace(clearance=clearance))
    state = trajectory(element, np.linspace(0.0, 0.1, 101))
    depth = np.linalg.norm(state[:, :3], axis=1) - clearance
    assert_allclose((depth.min(), depth.max()), (-0.01 * clearance, 0.03 * clearance), rtol=1e-9)
    assert_allclose(state[0], state[-1], atol=1e-9)  # a period
    assert_allclose(np.arctan2(state[:, 0], state[:, 2]).max(), 0.3, rtol=1e-9)
    assert_allclose(state[:, 8], 1.0)
    assert_allclose(state[25, 6:], (0.0, 2.0, 1.0), atol=1e-12)
    time = np.linspace(0, 0.1, 2001)
    state = trajectory(ELEMENT, time)
    assert_allclose(np.gradient(state[:, :3], time, axis=0)[1:-1], state[1:-1, 3:6], atol=1e-3)


def test_the_cross_check_covers_the_suggested_experiment(folder):
    for version in VERSIONS:
        experiment = description(folder / f"hip{version}.fmu").find("DefaultExperiment")
        time = table(folder / f"hip{version}_in.csv")["time"]
        assert float(experiment.get("stopTime")) == time[-1] == 0.1
        assert_allclose(np.diff(time), float(experiment.get("stepSize")), rtol=1e-9)
        *times, tolerance = (folder / f"hip{version}_ref.opt").read_text().splitlines()
        assert times == ["StartTime, 0", "StopTime, 0.1", "StepSize, 0.001"]
        assert tolerance.startswith("RelTol,")


def test_the_files_of_the_cross_check_have_the_loads_of_the_element(folder):
    given, reference = table(folder / "hip3_in.csv"), table(folder / "hip3_ref.csv")
    assert (folder / "hip3_in.csv").read_text().startswith('"time","position[1]",')
    state = trajectory(ELEMENT, given["time"])
    assert_array_equal(given["velocity[3]"], states_in_si(state)[:, 5])
    assert_array_equal(reference["max_pressure"], reference_loads(ELEMENT, state)[:, 8])
    assert 0 < np.count_nonzero(reference["energy"]) < len(reference)  # it touches and leaves
    state = np.array([[0.0, 0.01, 0.12, 1.0, 0.0, 20.0, 0.0, 1.0, 2.0]])
    load = ELEMENT(*state.reshape(3, 3).tolist())
    wanted = [*load.force, *(part / 1e3 for part in load.moment), load.energy / 1e3, load.half_angle]
    assert_allclose(reference_loads(ELEMENT, state)[0], [*wanted, 1e6 * load.max_pressure, 1.0], rtol=1e-12)
    assert_allclose(states_in_si(state)[0], [0.0, 1e-5, 1.2e-4, 1e-3, 0.0, 0.02, 0.0, 1.0, 2.0])


@needs_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_fmpy_finds_no_problems_and_the_declarations_are_those_of_the_standard(version, folder, fmpy, tmp_path):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(folder / f"hip{version}.fmu")) == []
    assert_compiles(Fmu(element=ELEMENT, name="hip", version=version), tmp_path, fmpy)


@needs_compiler
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(("kind", "late"), [("ModelExchange", 0), ("CoSimulation", 1)])
def test_fmpy_simulates_the_unit_to_the_reference(version, kind, late, folder, fmpy):
    found, reference = cross_checked(fmpy, str(folder / f"hip{version}.fmu"), folder / f"hip{version}", kind)
    for name in reference.dtype.names[1:]:  # a step of a co-simulation returns the loads of the input before it
        wanted = reference[name][: len(reference) - late]
        near = 2e-9 if name in ("half_angle", "max_pressure") else 1e-12  # Python reads these two from curves
        assert_allclose(found[name][late:], wanted, rtol=near, atol=near * abs(wanted).max())


@pytest.mark.long
@needs_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_fmpy_compiles_the_sources_of_the_unit(version, folder, fmpy, tmp_path):
    from fmpy.build import build_platform_binary

    unzipped = str(fmpy.extract(str(folder / f"hip{version}.fmu"), str(tmp_path)))
    shutil.rmtree(f"{unzipped}/binaries")
    (tmp_path / "build").mkdir()
    build_platform_binary(unzipped, tmp_path / "build")
    found, reference = cross_checked(fmpy, unzipped, folder / f"hip{version}")
    assert_allclose(found["energy"], reference["energy"], rtol=1e-12)


def test_a_terminal_has_the_motion_and_the_load_of_the_ball_in_the_form_of_the_standard(folder):
    text = packed(folder / "hip3.fmu", "terminalsAndIcons/terminalsAndIcons.xml")
    members = [each.get("variableName") for each in fromstring(text).iter("TerminalMemberVariable")]
    variables = [each for each in description(folder / "hip3.fmu").find("ModelVariables") if each.get("name") != "time"]
    assert members == [each.get("name") for each in variables if each.get("causality") in ("input", "output")]
    fmpy, etree = pytest.importorskip("fmpy"), pytest.importorskip("lxml.etree")
    schema = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"
    etree.XMLSchema(etree.parse(str(schema))).assertValid(etree.fromstring(text))


GOOD, DISCARD, ERROR = 0, 2, 3
PRESSED = {"position": (0.0, 1e-5, 1.2e-4), "velocity": (0.001, 0.0, 0.02), "spin": (0.0, 1.0, 2.0)}


@pytest.fixture(params=VERSIONS)
def host(request, folder, tmp_path):
    return Host(folder / f"hip{request.param}.fmu", tmp_path)


@needs_compiler
def test_a_host_receives_the_load_and_its_slopes(host):
    assert host.set(**PRESSED) == GOOD
    load = ELEMENT((0.0, 0.01, 0.12), (1.0, 0.0, 20.0), PRESSED["spin"])
    status, (force, moment, pressure) = host.get("force[3]", "moment[1]", "max_pressure")
    assert status == GOOD
    wanted = (load.force[2], 1e-3 * load.moment[0], 1e6 * load.max_pressure)
    assert_allclose((force, moment), wanted[:2], rtol=1e-12)
    assert_allclose(pressure, wanted[2], rtol=2e-9)  # Python reads it from a curve
    assert host.messages == []  # the contact is valid
    status, slope = host.directional("force[3]", "position[2]")
    assert status == GOOD
    assert_allclose(slope, host.difference("force[3]", "position[2]", {"position[2]": 1e-5}, 1e-8), rtol=1e-5)
    assert host.set(energy=1.0) == ERROR  # an output
    assert "value reference" in host.messages[0][1]


@needs_compiler
def test_a_parameter_is_tuned_during_a_simulation(host):
    host.set(**PRESSED)
    host.set(friction_coefficient=0.0, static_coefficient=0.0)
    _, (film,) = host.get("moment[3]")
    moments = []
    for coefficient in (0.05, 0.1):
        host.set(friction_coefficient=coefficient, static_coefficient=coefficient)
        moments.append(host.get("moment[3]")[1][0] - film)
    assert_allclose(moments[1], 2 * moments[0], rtol=1e-12)
    assert host.set(friction_coefficient=-0.1) == GOOD
    assert host.get("force[1]")[0] == ERROR
    assert host.directional("force[3]", "position[3]")[0] == ERROR
    assert host.messages == [(ERROR, "friction_coefficient must be finite and 0 or more")]


CHANGED = {"ball_radius": 17.0, "clearance": 0.2, "liner_thickness": 6.0}  # mm


@needs_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_fmpy_changes_the_joint_of_a_unit(version, folder, fmpy):
    Fmu(element=ForceElement(bs.HessForsbach(), HIP), name="dry", version=version).write(folder / "dry.fmu")
    young = 1.5 * HIP.liner.young
    changed = ForceElement(bs.HessForsbach(), HIP.replace(**CHANGED, liner=replace(HIP.liner, young=young)))
    values = {name: 1e-3 * value for name, value in CHANGED.items()} | {"liner_modulus": 1e6 * young}
    time = np.linspace(0.0, 0.1, 21)
    state = trajectory(changed, time)
    given = np.rec.fromarrays([time, *states_in_si(state).T], names=["time", *STATE])
    options = {"fmi_type": "ModelExchange", "stop_time": 0.1, "output_interval": 0.005}
    found = fmpy.simulate_fmu(str(folder / "dry.fmu"), input=given, start_values=values, **options)
    wanted = reference_loads(changed, state)
    for index, name in enumerate(found.dtype.names[1:]):  # Python reads half angle and pressure from curves
        assert_allclose(found[name], wanted[:, index], rtol=2e-9, atol=2e-9 * abs(wanted[:, index]).max())


def test_a_unit_says_which_numbers_of_the_joint_are_fixed_and_why(folder):
    fixed = {
        each.get("name"): each for each in description(folder / "hip3.fmu").iter() if each.get("causality") == "local"
    }
    assert list(fixed) == ["ball_radius", "clearance", "liner_thickness", "liner_modulus"]
    assert all(each.get("variability") == "constant" for each in fixed.values())
    assert float(fixed["clearance"].get("start")) == pytest.approx(1e-3 * HIP.clearance, rel=1e-15)
    assert "fixed: the film of the lubricant" in fixed["clearance"].get("description")


@needs_compiler
def test_a_fixed_number_of_the_joint_can_be_read_but_not_set(host):
    assert host.get("clearance") == (GOOD, [pytest.approx(1e-3 * HIP.clearance, rel=1e-15)])
    assert host.set(clearance=1e-3) == ERROR


@needs_compiler
def test_a_state_of_nan_has_a_status_and_one_message(host):
    host.set(position=(np.nan, 0.0, 0.0))
    for _ in range(3):
        status, (force,) = host.get("force[3]")
        assert status == ERROR
        assert np.isnan(force)
        host.set(position=(np.nan, 0.0, 0.1))
    assert len(host.messages) == 1
    assert "the state is not finite, or too large; position (nan, 0, 0) mm" in host.messages[0][1]
    host.set(**PRESSED)
    assert host.get("force[3]")[0] == GOOD  # the host may continue


@needs_compiler
def test_a_force_beyond_its_validity_or_its_range_is_reported_once(host):
    for depth, code in ((5e-5, 0), (1e-3, 1), (2e-3, 1), (8e-3, 4)):
        host.set(position=(0.0, 0.0, depth))
        status, (force, contact) = host.get("force[3]", "status")
        assert (status, np.isfinite(force), contact) == (GOOD, True, code)
    assert host.directional("status", "position[3]")[1] == 0.0
    assert [text.partition(" beyond")[0] for _, text in host.messages] == ["hess-forsbach is not valid"]


@pytest.mark.long
@needs_compiler
def test_a_unit_that_stops_discards_a_step_through_the_wall(tmp_path):
    host = hosted(tmp_path, element=ForceElement(bs.HessForsbach(), HIP), name="stops", beyond="stop")
    host.set(position=(0.0, 0.0, 8e-3))
    assert host.get("energy")[0] == DISCARD


BALLS = {
    "friction": ForceElement(bs.HessForsbach(), HIP, **LOSSES),
    "bristles": ForceElement(bs.HessForsbach(), HIP, LOSSES["damping"], Bristles(coefficient=0.05)),
    "relaxing": ForceElement(bs.HessForsbach(), HIP, relaxation=Prony(terms=((0.3, 1e-3), (0.2, 0.01)))),
    "table": ForceElement(bs.Tabulated(), HIP),
}
BALLS["bristles, relaxing"] = replace(BALLS["bristles"], relaxation=BALLS["relaxing"].relaxation)
THROWN = {"mass": 1.0, "velocity": (10.0, 0.0, 0.0), "spin": (0.0, 1.0, 0.0), "pull": (3.0, 0.0, 10.0)}  # kg, mm/s, N


def thrown(element):
    """Last position in mm of the ball in Python, extrapolated to a vanishing step; three bounces in 20 ms."""
    steps = (2e-5,) if element.internal_state else (8e-6, 4e-6)  # LSODA controls its own error
    ends = [simulate(element, position=(0,) * 3, duration=0.02, step=step, **THROWN).position[-1] for step in steps]
    return ends[-1] + (ends[-1] - ends[0]) / 3


@needs_compiler
@pytest.mark.parametrize("version", some(VERSIONS, 1))
@pytest.mark.parametrize("name", some(BALLS, 3))
def test_a_ball_inside_moves_as_in_python(name, version, fmpy, tmp_path):
    from fmpy.validation import validate_fmu

    made = Fmu(element=BALLS[name], name="ball", version=version, ball_mass=THROWN["mass"])
    path = str(made.write(tmp_path / "ball.fmu").path)
    assert validate_fmu(path) == []
    fields = ["time", *(f"applied_{each}[{axis}]" for each in ("force", "torque") for axis in (1, 2, 3))]
    given = np.array([(0.0, *THROWN["pull"], 0.0, 0.0, 0.0)], dtype=[(field, float) for field in fields])
    start = {"velocity[1]": 1e-3 * THROWN["velocity"][0], "spin[2]": THROWN["spin"][1]}
    options = {"stop_time": 0.02, "output_interval": 1e-3, "relative_tolerance": 1e-10}
    wanted = thrown(BALLS[name])
    for kind in ("CoSimulation", "ModelExchange"):
        found = fmpy.simulate_fmu(path, fmi_type=kind, input=given, start_values=start, **options)[-1]
        end = [1e3 * found[f"position[{axis}]"] for axis in (1, 2, 3)]
        assert_allclose(end, wanted, rtol=0, atol=1e-5)  # 10 nm


@pytest.mark.long
@needs_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_sources_with_states_are_compiled_without_warnings(version, fmpy, tmp_path):
    for name, mass in (("bristles", None), ("bristles, relaxing", 1.0), ("friction", 1.0)):
        assert_compiles(Fmu(element=BALLS[name], name="hip", version=version, ball_mass=mass), tmp_path, fmpy)


@needs_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_derivatives_of_the_rates_of_states_equal_differences(version, tmp_path):
    host = hosted(tmp_path, element=BALLS["bristles, relaxing"], name="ball", version=version, ball_mass=0.7)
    start = {"position[3]": 1.2e-4, "position[2]": 1e-5, "velocity[1]": 1e-3, "spin[2]": 2.0, "deflection[1]": 1e-7}
    start["relaxed_force[2]"] = 200.0
    host.set(**start)
    states = ("position[1]", "velocity[1]", "spin[2]", "deflection[1]", "relaxed_force[1]", "relaxed_force[2]")
    rates = [f"der({name})" for name in states]
    steps = {
        "position[3]": 1e-9,
        "velocity[1]": 1e-6,
        "spin[2]": 1e-4,
        "deflection[1]": 1e-10,
        "relaxed_force[2]": 1e-2,
    }
    for unknown, (known, step) in product((*rates, "force[1]", "spin[2]"), steps.items()):
        status, slope = host.directional(unknown, known)
        assert status == GOOD
        size = abs(host.get(unknown)[1][0]) * 1e-15 / step
        assert_allclose(slope, host.difference(unknown, known, start, step), rtol=1e-4, atol=1e3 * size)
    assert host.directional("der(velocity[3])", "applied_force[3]")[1] == pytest.approx(1 / 0.7)
    for name in ("mass", "inertia"):
        good = host.get(name)[1][0]
        for bad in (-1.0, 1e-320):  # the reciprocal of the second is infinite
            host.set(**{name: bad})
            assert host.get("der(velocity[1])")[0] == host.directional("force[1]", "position[3]")[0] == ERROR
        host.set(**{name: good})


REFERENCES = "extra/org.fmi-standard.fmi-ls-ref/"


def experiments(path):
    """Stimuli and references of the experiments in an archive, by the manifest of FMI-LS-REF."""
    manifest = fromstring(packed(path, f"{REFERENCES}fmi-ls-manifest.xml"))
    (related,) = [each for each in manifest.iter("Related") if each.get("role").startswith("experiment")]
    for experiment in fromstring(packed(path, REFERENCES + related.get("source"))).iter("Experiment"):
        files = [REFERENCES + experiment.find(tag).get("source") for tag in ("Stimuli", "References")]
        yield (
            experiment.find("TransientSimulation"),
            *(table(packed(path, file).decode().splitlines()) for file in files),
        )


@needs_compiler
@pytest.mark.parametrize(
    ("name", "mass"), some([("bristles, relaxing", None), ("friction", None), ("bristles, relaxing", 1.0)], 2)
)
def test_an_archive_has_its_reference_results(name, mass, fmpy, tmp_path):
    path = Fmu(element=BALLS[name], name="hip", ball_mass=mass).write(tmp_path / "hip.fmu").path
    ((times, given, reference),) = experiments(path)
    options = {"stop_time": float(times.get("stopTime")), "output_interval": float(times.get("stepSize"))}
    kind = "CoSimulation" if "bristles" in name else "ModelExchange"  # of which the other is in the test above
    found = fmpy.simulate_fmu(str(path), fmi_type=kind, input=given, relative_tolerance=1e-10, **options)
    assert list(found["time"]) == pytest.approx(list(reference["time"]))
    for _, group in groupby(reference.dtype.names[1:], key=lambda output: output.partition("[")[0]):
        outputs = list(group)
        wanted = np.array([reference[output] for output in outputs])
        near = 1e-5 * abs(wanted).max()  # both integrate with a tolerance of 1e-10, and small loads depend on 1e-12 m
        assert_allclose([found[output] for output in outputs], wanted, rtol=0, atol=near)


def test_the_manifest_of_reference_results_has_the_form_of_the_layered_standard(folder):
    manifest = fromstring(packed(folder / "hip3.fmu", f"{REFERENCES}fmi-ls-manifest.xml"))
    names = "{http://fmi-standard.org/fmi-ls-manifest}fmi-ls-"
    assert manifest.tag == "fmiReferences"
    assert manifest.get(f"{names}name") == "org.fmi-standard.fmi-ls-ref"
    assert {f"{names}version", f"{names}description"} <= set(manifest.keys())
    (experiment,) = manifest
    assert (
        experiment.attrib.items()
        >= {"role": "experiment/smoke-test", "type": "application/x-ma-hs-experiments"}.items()
    )


@pytest.mark.parametrize("mass", [0.0, 1e-320, np.inf])
def test_a_mass_without_a_motion_is_refused(mass):
    with pytest.raises(ValueError, match="ball_mass = "):
        Fmu(element=ELEMENT, ball_mass=mass)


def test_the_command_writes_a_unit_with_a_ball_bristles_and_a_relaxing_liner(tmp_path):
    options = ("--ball-mass", "2", "--friction", "0.05", "--bristle-stiffness", "200", "--relaxation", "0.3: 1 ms")
    done = run("fmu", "hip-28", "--out", "ball.fmu", *options, folder=tmp_path)
    assert done.stdout.splitlines()[:4] == ["ball.fmu", "ball_in.csv", "ball_ref.csv", "ball_ref.opt"]
    listed = {each.get("name"): each for each in description(tmp_path / "ball.fmu").find("ModelVariables")}
    assert listed["mass"].get("start") == "2.0"
    assert listed["deflection[4]"].get("causality") == listed["relaxed_force[1]"].get("causality") == "local"
    assert "StopTime, 0.0282" in (tmp_path / "ball_ref.opt").read_text()  # 20 ms times the root of the mass in kg
