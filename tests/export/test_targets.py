"""Export targets: consistent files, and one bounce in every installed program."""

import ctypes
import re
import sys
from dataclasses import replace
from math import exp, pi, sqrt
from pathlib import Path
from types import ModuleType, SimpleNamespace
from xml.etree.ElementTree import fromstring

import numpy as np
import pytest
from numpy.testing import assert_allclose

import ballsocket as bs
from ballsocket.cli.export import ForceElementInputs, identifier
from ballsocket.dynamics import Bristles, ContactState, Damping, ForceElement, Friction, Prony
from ballsocket.export import TARGETS, CElement, ExportJob
from ballsocket.export.compiler import LIBRARY_ENDING, shared_library
from ballsocket.export.law_fit import expression_fit, fit_depth, power_fit
from ballsocket.files.joint_file import JointFile
from ballsocket.files.tables import read_table

from ..cli.command import printed, run
from ..joints import HIP
from ..places import EXAMPLES
from .library import (
    needs_compiler,
    needs_scripts,
    python_header,
    set_compiler,
    skip_without,
    table,
    tools,
    writes,
    written,
)

PLAIN = ForceElement(bs.HessForsbach(), HIP)
DAMPED = ForceElement(bs.HessForsbach(), HIP, damping=Damping(hysteresis=0.004))
HERTZ = ForceElement(bs.Hertz(), HIP)
TABULATED = ForceElement(bs.Tabulated(), HIP, damping=DAMPED.damping)
LOSSES = {"damping": DAMPED.damping, "friction": Friction(coefficient=0.05)}
LOSSY = ForceElement(bs.HessForsbach(), HIP, lubricant=bs.Lubricant(viscosity=1e-5), **LOSSES)
STATE = (1e-5, 0.0, 1.2e-4), (0.001, 0.0, 0.02), (0.0, 1.0, 2.0)
IN_MM = (0.01, 0.0, 0.12), (1.0, 0.0, 20.0), (0.0, 1.0, 2.0)


def texts(target, element=DAMPED):
    return TARGETS[target].texts(ExportJob(element=element, name="hip", depth=0.05))


def check_loads(force, moment, *contact):
    """Compare loads in SI units with those of the element."""
    wanted = LOSSY(*IN_MM)
    assert_allclose(force, wanted.force, rtol=1e-12, atol=1e-9)
    assert_allclose(moment, 1e-3 * np.array(wanted.moment), rtol=1e-12, atol=1e-12)
    assert_allclose(contact[0], 1e-3 * wanted.energy, rtol=1e-12)
    # Python reads half angle and pressure from curves within 1e-9
    assert_allclose(contact[1:], (wanted.half_angle, 1e6 * wanted.max_pressure), rtol=2e-9)


@pytest.fixture(scope="module")
def fit():
    """The expression of a law that no closed form has."""
    return expression_fit(TABULATED, 0.05)


@needs_compiler
def test_the_python_module_has_the_loads_of_the_element_and_needs_no_package(tmp_path):
    assert written("exudyn", LOSSY, tmp_path)[1] == ""
    assert "import ballsocket" not in (tmp_path / "bouncing.py").read_text()
    with tools.module(tmp_path, "bouncing") as joint:
        check_loads(*joint.load(*STATE), *joint.contact(STATE[0]))
        code, sentence = joint.status((0.0, 0.0, 0.1))
        assert code == ContactState.THROUGH_WALL
        assert "the force has its last stiffness" in sentence
        assert joint.load((0.0, 0.0, 0.1))[0][2] < joint.load((0.0, 0.0, 0.05))[0][2] < 0.0
        with pytest.raises(joint.NoForce, match="not finite"):
            joint.load((0.0, 0.0, 1e200))
        joint.parameters[0] = -1.0
        position = STATE[0]
        for call, given in (
            (joint.load, STATE),
            (joint.slope, (*STATE, (1.0,) * 9)),
            (joint.status, [position]),
            (joint.contact, [position]),
        ):
            with pytest.raises(ValueError, match="hysteresis must be finite and 0 or more"):
                call(*given)


@needs_compiler
def test_axes_of_a_socket_in_exudyn_may_be_a_list(tmp_path, monkeypatch):
    """Exudyn receives the negative load, turned by the axes; its functions used here are stood in for."""
    exudyn, items = ModuleType("exudyn"), ModuleType("exudyn.itemInterface")
    exudyn.OutputVariableType, exudyn.itemInterface, items.ObjectConnectorRigidBodySpringDamper = None, items, dict
    monkeypatch.setitem(sys.modules, "exudyn", exudyn)
    monkeypatch.setitem(sys.modules, "exudyn.itemInterface", items)
    ground = SimpleNamespace(
        AddObject=lambda made: made,
        GetMarker=lambda marker: {"bodyNumber": 0},
        GetObject=lambda body: {"objectType": "Ground"},
    )
    written("exudyn", LOSSY, tmp_path)
    axes = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    turned = [np.array(axes) @ part for part in STATE]
    with tools.module(tmp_path, "bouncing_exudyn") as made:
        connector = made.add_joint(ground, 0, 1, socket_axes=axes)
        found = connector["springForceTorqueUserFunction"](ground, 0.0, 0, turned[0], None, *turned[1:])
    load = LOSSY(*IN_MM)
    assert_allclose(found, [*(-np.array(axes) @ load.force), *(-1e-3 * np.array(axes) @ load.moment)], rtol=1e-9)


@needs_compiler
def test_the_modelica_function_has_the_loads_of_the_element_and_reports_parameters_that_are_not_allowed(tmp_path):
    written("modelica", LOSSY, tmp_path)
    package = (tmp_path / "bouncing" / "package.mo").read_text()
    assert package.count("end bouncing;") == package.count("package bouncing ") == 1
    assert 'parameter Real friction_coefficient(unit="1", min=0) = 0.05 ' in package
    folder = tmp_path / "bouncing" / "Resources" / "Include"
    (folder / "ModelicaUtilities.h").write_text(  # in place of the header of a Modelica tool
        "const char *reported;\nstatic void ModelicaError(const char *message) { reported = message; }\n"
    )
    library = ctypes.CDLL(str(shared_library(["bouncing_modelica.c"], folder / f"called{LIBRARY_ENDING}", folder)))
    reported = ctypes.c_char_p.in_dll(library, "reported")
    load = (ctypes.c_double * 10)()
    tuned = (ctypes.c_double * 7)(4.0, 0.0, 0.05, 0.05, 1e-4, 1e-2, 0.0)
    state = [(ctypes.c_double * 3)(*part) for part in STATE]
    library.bouncing_modelica(*state, tuned, load)
    check_loads(load[:3], load[3:6], *load[6:9])
    assert load[9] == ContactState.CONTACT
    assert reported.value is None
    tuned[2] = -0.05
    library.bouncing_modelica(*state, tuned, load)
    assert reported.value == b"friction_coefficient must be finite and 0 or more"


def test_a_parser_of_modelica_reads_the_package_and_each_unknown_has_one_equation(tmp_path):
    parse = pytest.importorskip("pymoca.parser").parse
    written("modelica", LOSSY, tmp_path)
    package = parse((tmp_path / "bouncing" / "package.mo").read_text()).classes["bouncing"]
    assert [(each.name, each.type) for each in package.classes.values()] == [("load", "function"), ("Joint", "model")]
    joint = package.classes["Joint"]
    own = [each.name for each in joint.symbols.values() if "parameter" not in each.prefixes]
    flows = ["frame_a.f", "frame_a.t", "frame_b.f", "frame_b.t"]
    own.remove("turn")  # it is bound where it is declared
    assert sorted(str(each.left) for each in joint.equations) == sorted(own + flows)
    assert [each.name for each in package.classes["load"].symbols.values()][-1] == "load"


def value_of(text, **words):
    """Value of an expression of OpenSim: definitions follow what they define."""
    words |= {"max": max, "min": min, "sqrt": sqrt, "exp": exp}
    formula, *definitions = text.replace("^", "**").split(";")
    for definition in reversed(definitions):
        name, _, value = definition.partition("=")
        words[name] = eval(value, words)
    return eval(formula, words)


def check_text(text, element, near):
    """The text of a law in m and m/s has the damped force of an element, and none apart."""
    force = -element((0.0, 0.0, 0.13), (0.0, 0.0, 20.0)).force[2]
    assert_allclose(value_of(text, d=1.3e-4, ddot=0.02), force, rtol=near)
    assert value_of(text, d=5e-5, ddot=0.02) == 0.0


def test_the_expression_of_a_closed_form_is_the_closed_form_also_without_clearance():
    """Without clearance the length of the fit is a thousandth of the socket radius."""
    exact = expression_fit(PLAIN, 0.05)
    assert (exact.coefficients, exact.range_note) == ((), "")
    assert_allclose(exact.scale, 1e3 * pi / 3 * bs.hess_forsbach(HIP) * HIP.socket_radius**2, rtol=1e-12)
    assert exact.error < 1e-12
    element = ForceElement(bs.Bartel(), HIP.replace(clearance=0.0))
    fit = expression_fit(element, 0.05)
    assert (fit.clearance, fit.length) == (0.0, pytest.approx(1e-6 * element.joint.socket_radius))
    assert fit.error < 1e-6
    depths = np.array([1e-3, 0.05]) * 1e3 * fit.depth
    assert_allclose(fit(1e-3 * depths), element.potential(depths)[1], rtol=2 * fit.error + 1e-9)


def test_one_expression_fits_any_law_within_the_validity_of_its_model(fit):
    assert fit.error < 1e-5
    assert_allclose(fit.depth, 1e-3 * TABULATED.valid_depth)
    assert_allclose(expression_fit(TABULATED, 0.3).depth, 3e-4)  # a load that is deeper than the model is valid
    depths = np.array([2e-4, 0.011, 0.049, 0.99e3 * fit.depth])
    forces = fit(1e-3 * (HIP.clearance + depths))
    assert_allclose(forces, TABULATED.potential(depths)[1], rtol=2 * fit.error)
    check_text(fit.text("d", "ddot", 4.0), TABULATED, 1e-5)


def test_beyond_its_fit_an_expression_continues_with_its_slope_and_notes_its_error_and_depth(fit):
    deepest = 1e3 * fit.depth
    before, at, after, twice = fit(1e-3 * (HIP.clearance + deepest * np.array([0.9999, 1.0, 1.0001, 2.0])))
    assert_allclose(after - at, at - before, rtol=1e-3)
    law = TABULATED.potential(np.array([2.0 * deepest]))[1][0]
    assert_allclose(abs(twice / law - 1), fit.error_beyond, rtol=1e-6)
    assert 0.01 < fit.error_beyond < 0.1
    assert "deeper it continues as a power law" in fit.range_note
    noted = re.search(r"within (\S+) % .* up to (\S+) um .* law, (\S+) % off", fit.range_note).groups()
    error, depth, beyond = map(float, noted)
    assert (error, beyond) == pytest.approx((100 * fit.error, 100 * fit.error_beyond), rel=0.5)
    assert depth == pytest.approx(1e6 * fit.depth, rel=1e-3)


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Tabulated()], ids=lambda model: model.name)
def test_a_smoothed_expression_is_the_smoothed_element_and_can_be_differentiated_twice(model):
    """At the corners of touch, of full contact and of separation, second differences over 2 nm have no jump."""
    element = ForceElement(model, HIP, DAMPED.damping, smoothing=0.005)
    fit = expression_fit(element, 0.05)
    text = fit.text("d", "ddot", 4.0)
    for depth in (-0.0049, -0.001, 0.002, 0.0049, 0.02):
        for speed in (-280.0, -245.0, 30.0):
            force = -element((0.0, 0.0, HIP.clearance + depth), (0.0, 0.0, speed)).force[2]
            found = value_of(text, d=1e-3 * (HIP.clearance + depth), ddot=1e-3 * speed)
            assert_allclose(found, force, rtol=2e-5, atol=1e-4)  # the fit is of indentations from 0.1 um on

    def bends(at):
        forces = [value_of(text, d=1e-3 * (HIP.clearance + at) + step * 2e-9, ddot=0.0) for step in range(-2, 3)]
        return np.diff(forces[:3], n=2)[0], np.diff(forces[2:], n=2)[0]

    for corner in (-0.005, 0.005):
        before, after = bends(corner)
        assert abs(before - after) < 0.01 * abs(bends(0.0)[0])
    assert fit.differentiability(damped=True).startswith("twice continuously differentiable")
    assert expression_fit(PLAIN, 0.05).differentiability(damped=False).startswith("once continuously differentiable")
    assert expression_fit(PLAIN, 0.05).differentiability(damped=True).startswith("continuous, not differentiable")


def test_the_terminal_and_the_file_state_the_range_of_an_expression(tmp_path):
    finished = run("export", "opensim", "hip-28", "--out", "hip", folder=tmp_path)
    note = expression_fit(ForceElement(bs.Tabulated(), bs.joints["hip-28"]), 0.0).range_note
    assert note in finished.stderr.replace("\n", " ")
    assert note in (tmp_path / "hip" / "hip.osim").read_text()


def test_the_best_power_law_is_balanced_and_found_for_any_stiffness():
    """The search for k is relative to the force: it holds for newtons and for micronewtons."""
    fit = power_fit(PLAIN, 0.05)
    depths = np.linspace(0.0025, 0.05, 500)
    forces = PLAIN.potential(depths)[1]

    def worst(k, n):
        return max(abs(k * depths**n - forces)) / forces[-1]

    assert_allclose(worst(fit.stiffness, fit.exponent), fit.error, rtol=1e-2)
    assert 1.0 < fit.exponent < 2.0  # between the limits of a deep contact and of a light one
    for k, n in ((1.001, 0.0), (0.999, 0.0), (0.05**-0.003, 0.003), (0.05**0.003, -0.003)):
        assert worst(fit.stiffness * k, fit.exponent + n) > fit.error
    for young in (1e-6, 1.0):
        element = ForceElement(bs.Hertz(), HIP.replace(liner=bs.Material(young=young, poisson=0.4)))
        law = power_fit(element, 0.02)
        assert law.exponent == pytest.approx(1.5, abs=1e-6)
        assert law.error < 1e-6
        assert_allclose(law.stiffness * 0.02**law.exponent, element.potential(np.array([0.02]))[1][0], rtol=1e-6)


def test_a_table_goes_to_the_load_of_the_file(tmp_path):
    text = printed("export", "table", str(EXAMPLES / "hip.toml"), "--out", "new/parts/hip", folder=tmp_path)
    assert ": hip_axes.csv, hip_law.csv, hip_power.txt, hip_readme.txt\n" in text
    rows = table(tmp_path / "new" / "parts" / "hip" / "hip_law.csv")
    assert_allclose(rows["force_N"][-1], 3000.0, rtol=1e-6)


def test_a_cup_in_a_file_has_a_rim_and_a_file_without_a_cup_has_none():
    cup = bs.Cup(arc_of_cover=2.6)
    tables = {"friction": 0.1, "restitution": 0.8, "impact_speed": "0.1 m/s"}
    inputs = read_table(tables, ForceElementInputs)
    element = inputs.element(JointFile(HIP, {}, cup), None, None)
    assert (element.cup, element.constants.rim) == (cup, 1.3)
    assert element.constants.sliding == 0.1
    assert_allclose(element.damping.restitution(100.0), 0.8, rtol=1e-6)
    assert inputs.element(JointFile(HIP, {}), None, None).constants.rim == 0.0


@pytest.mark.long
@pytest.mark.parametrize("target", TARGETS)
def test_the_files_of_a_target_follow_the_stiffness_of_the_joint(target):
    stiffer = ForceElement(bs.HessForsbach(), HIP.replace(liner=replace(HIP.liner, young=2 * HIP.liner.young)))
    assert texts(target, PLAIN) == texts(target, ForceElement(bs.HessForsbach(), HIP))
    assert texts(target, stiffer) != texts(target, PLAIN)


@pytest.mark.parametrize("target", TARGETS)
def test_every_target_writes_a_joint_without_a_load_and_reports_a_missing_compiler(target, tmp_path, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    done = run("export", target, "hip-28", "--out", "hip", "--model", "hess-forsbach", folder=tmp_path)
    assert done.returncode == 0
    files, time_steps = done.stdout.splitlines()
    names = files.removeprefix("hip: ").split(", ")
    assert "stable below" in time_steps
    assert all((tmp_path / "hip" / name).stat().st_size > 100 for name in names)
    compiled = target in ("mujoco", "drake", "exudyn")
    assert ("the sources are written" in done.stderr) == compiled
    for path in (tmp_path / "hip").glob("*.py"):
        compile(path.read_text(), path.name, "exec")
    for path in (tmp_path / "hip").glob("*.[ox][sm][il]*"):
        fromstring(path.read_bytes())


def test_the_command_exports_a_lubricated_hemisphere(tmp_path):
    """A lubricated cup has a rim, because the pressure of its film is 0 there."""
    words = ("hip-28", "--model", "hess-forsbach", "--viscosity", "2.5 mPa s", "--roughness", "2 um")
    printed("export", "c", *words, "--out", "hip", folder=tmp_path)
    lubricant = bs.Lubricant(viscosity=2.5e-3, ball_roughness=0.0, cup_roughness=2e-3)
    element = ForceElement(bs.HessForsbach(), bs.joints["hip-28"], cup=bs.Cup(), lubricant=lubricant)
    wanted = CElement(element=element, name="hip").source
    assert (tmp_path / "hip" / "hip.c").read_text("utf-8") == wanted


@pytest.fixture
def recording_compiler(tmp_path, monkeypatch):
    """A compiler that writes the header of this Python as a library, and a file with its arguments."""
    log = tmp_path / "arguments.txt"
    note = f"open({str(log)!r}, 'a').write(' '.join(sys.argv[1:]) + '\\n')"
    set_compiler(monkeypatch, tmp_path, [note, writes(python_header())])
    return log


@needs_scripts
@pytest.mark.parametrize("library", [f"libmujoco{LIBRARY_ENDING}.9", None])
def test_the_plugin_is_compiled_with_the_headers_and_the_library_of_mujoco(
    library, recording_compiler, tmp_path, monkeypatch
):
    package = tmp_path / "site" / "mujoco"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    if library:
        (package / library).touch()
    monkeypatch.syspath_prepend(str(tmp_path / "site"))
    monkeypatch.delitem(sys.modules, "mujoco", raising=False)  # of an earlier test
    paths, missing = written("mujoco", PLAIN, tmp_path / "hip", name="hip")
    assert missing == ""
    assert all(path.exists() for path in paths)
    plain, plugin = recording_compiler.read_text().splitlines()
    assert plain.split("-o ")[0].endswith(" hip.c ")
    sources = f"hip.c hip_mujoco.c {package / library}" if library else "hip.c hip_mujoco.c"
    assert f"-isystem {package / 'include'} -Wl,-rpath,{package} {sources} -o _hip_plugin{LIBRARY_ENDING} -lm" in plugin


@needs_scripts
def test_a_plugin_without_mujoco_is_a_note_and_its_source_is_written(recording_compiler, tmp_path, monkeypatch):
    monkeypatch.setattr("ballsocket.export.targets.find_spec", lambda name: None)
    missing = written("mujoco", PLAIN, tmp_path / "hip", name="hip")[1]
    assert missing == "the plug-in is not compiled: mujoco, whose headers it needs, is not installed"
    assert (tmp_path / "hip" / "hip_mujoco.c").exists()


def test_features_that_a_target_cannot_represent_are_reported(tmp_path):
    element = ForceElement(bs.HessForsbach(), HIP, damping=Damping(time=1e-4), friction=LOSSY.friction, cup=bs.Cup())
    lost = "cannot represent friction and the retardation time of the liner"
    order = f"the expression is {expression_fit(element, 0.05).differentiability(damped=False)}"
    opensim = f"opensim {lost} and the rim of the cup: omitted; lost_opensim.cpp has every feature; {order}"
    notes = {"c": "", "modelica": "", "opensim": opensim}
    notes["table"] = f"table {lost}: omitted; the rim of the cup is in lost_axes.csv only"
    assert {target: written(target, element, tmp_path, name="lost")[1] for target in notes} == notes
    assert written("opensim", DAMPED, tmp_path)[1].startswith("the expression is continuous, not differentiable")
    assert written("table", PLAIN, tmp_path)[1] == ""


def test_files_of_other_programs_have_the_law_and_the_radii_in_metres_and_the_inertia_of_a_solid_ball():
    """A ball of 17.9 mm and 1 kg has 0.4 m R² = 1.28e-4 kg m²."""
    scene, text = fromstring(texts("mujoco")["hip.xml"]), texts("opensim")["hip.osim"]
    assert float(scene.find(".//geom").get("size")) == pytest.approx(0.0179)
    model = fromstring(text)
    check_text(model.find(".//expression").text, DAMPED, 1e-12)
    assert float(re.search(r"Accuracy: within (\S+) % of the law", text)[1]) <= 1e-10
    assert "ddot" not in texts("opensim", PLAIN)["hip.osim"]
    inertia = [float(number) for number in model.find(".//inertia").text.split()]
    assert inertia == pytest.approx([0.4 * 0.0179**2] * 3 + [0.0] * 3)
    assert float(model.find(".//mass").text) == 1.0
    ball, socket = re.search(r"BALL_RADIUS, SOCKET_RADIUS = (\S+), (\S+)", texts("exudyn")["hip_exudyn.py"]).groups()
    assert (float(ball), float(socket)) == pytest.approx((0.0179, 0.018))


def test_a_power_law_is_in_newtons_and_metres_for_exudyn_and_in_millimetres_for_others():
    law = ExportJob(element=DAMPED, name="hip", depth=0.05).fitted_power_law
    program, text = texts("exudyn")["hip_exudyn.py"], texts("table")["hip_power.txt"]
    stiffness, exponent = map(float, re.search(r"STIFFNESS, EXPONENT = (\S+), (\S+)", program).groups())
    forces = DAMPED.potential(np.array([0.01, 0.05]))[1]
    assert_allclose(stiffness * np.array([1e-5, 5e-5]) ** exponent, forces, atol=1.01 * law.error * forces[1])
    numbers = {name: float(value) for name, value in re.findall(r"^(\w+) = (\S+)$", text, re.MULTILINE)}
    assert numbers == {"k": law.stiffness, "n": law.exponent, "clearance": pytest.approx(0.1)}
    for stated, depth in (
        (re.search(r"indentation of (\S+) m: at most (\S+) % of the force", program), 5e-5),
        (re.search(r"error up to (\S+) mm at most (\S+) % of the force", text), 0.05),
    ):
        assert tuple(map(float, stated.groups())) == (depth, pytest.approx(100 * law.error, rel=0.05))
    adams, simpack = [line for line in text.splitlines() if line.startswith("-")]
    words = {"MAX": max, "DM": lambda ball, socket: 0.13, "ball": 0, "socket": 0, "x": 0.13}
    expected = -numbers["k"] * 0.03 ** numbers["n"]
    assert eval(adams, words) == eval(simpack.replace("^", "**"), words) == pytest.approx(expected)


def test_a_table_of_the_law_begins_without_contact_and_ends_at_its_depth():
    rows = table(texts("table", PLAIN)["hip_law.csv"].splitlines())
    assert len(rows) == 201
    assert_allclose((rows["indentation_mm"][0], rows["indentation_mm"][-1]), (0.0, 0.05))
    contact = PLAIN.model.press(HIP, indentation=rows["indentation_mm"][1:])
    columns = {"force_N": contact.force, "stiffness_N/mm": contact.stiffness, "energy_N_mm": contact.energy}
    columns |= {"half_angle_deg": np.degrees(contact.half_angle), "max_pressure_MPa": contact.max_pressure}
    for column, values in columns.items():
        assert rows[column][0] == 0.0
        assert_allclose(rows[column][1:], values, rtol=1e-8)


def test_the_depth_of_a_fit_is_that_of_a_load_or_the_largest_valid_one():
    force = HERTZ.model.press(HIP, indentation=0.03).force
    assert fit_depth(HERTZ, {"force": float(force)}) == pytest.approx(0.03)
    assert fit_depth(PLAIN, {}) == PLAIN.valid_depth > 0
    never = ForceElement(bs.Hertz(), HIP.replace(liner_thickness=1e-3))
    assert never.valid_depth == 0.0
    assert fit_depth(never, {}) == never.wall == 1e-3


@pytest.mark.parametrize("model", [bs.HessForsbach(), bs.Tabulated()], ids=lambda model: model.name)
def test_a_model_is_valid_up_to_the_valid_depth_and_not_much_deeper(model):
    """The depths of a search are 5.5 % apart: 128 steps for a factor of a thousand."""
    element = ForceElement(model, HIP)
    depth = element.valid_depth
    assert model.press(HIP, indentation=depth).valid
    assert not model.press(HIP, indentation=1.056 * depth).valid


@pytest.mark.parametrize("name", ["class", "end", "mujoco", "1 hip", "while", "model", "1" * 60])
def test_identifiers_avoid_keywords_of_the_target_languages_and_have_at_most_40_characters(name):
    assert identifier(Path(f"{name}.fmu")) == f"joint_{name}".replace(" ", "_")[:40]
    assert identifier(Path("left-hip.fmu")) == "left_hip"
    assert identifier(Path("a" * 60)) == "a" * 40


@pytest.mark.parametrize(("variable", "value"), [("CC", "'"), ("CFLAGS", "'")])
def test_an_invalid_compiler_command_is_reported_and_the_sources_are_written(variable, value, tmp_path, monkeypatch):
    monkeypatch.setenv(variable, value)
    paths, missing = written("drake", PLAIN, tmp_path)
    assert f'{variable} is "\'", which is not a valid command; the sources are written' in missing
    assert all(path.exists() for path in paths)


def test_elements_with_a_state_are_refused_by_programs_that_cannot_represent_it():
    adhesive = ForceElement(bs.AdhesiveSocket(work_of_adhesion=2e-3), HIP)
    with pytest.raises(ValueError, match="an adhesive ball has a state; "):
        CElement(element=adhesive)
    bristles = ForceElement(bs.HessForsbach(), HIP, friction=Bristles(coefficient=0.05))
    relaxing = ForceElement(bs.HessForsbach(), HIP, relaxation=Prony(terms=((0.3, 0.1),)))
    for element, note in ((bristles, "bristles have a state"), (relaxing, "a relaxing liner has a state")):
        job = ExportJob(element=element, name="hip", depth=0.1)
        assert "hip.c" in TARGETS["c"].file_texts(job)
        for name in TARGETS.keys() - {"c"}:
            with pytest.raises(ValueError, match=f"{note}, which {name} cannot represent"):
                TARGETS[name].file_texts(job)
    compiled = pytest.importorskip("ballsocket.dynamics.compiled")
    for element in (adhesive, bristles, relaxing):
        with pytest.raises(ValueError, match="ha(s|ve) a state; "):
            compiled.CompiledElement(element)


@pytest.mark.long
@needs_compiler
@pytest.mark.parametrize("program", ["mujoco", "mujoco_callback", "drake", "exudyn", "opensim", "warp"])
def test_a_ball_bounces_in_each_program_as_in_python(program, tmp_path):
    target = program.removesuffix("_callback")
    skip_without(target)
    element = DAMPED if target == "opensim" else LOSSY
    bounce = tools.Bounce(element=element, duration=0.005, samples=51)
    assert (written(target, element, tmp_path)[1] == "") == (target != "opensim")

    def load(r, v, w):
        answer = element(1e3 * r, 1e3 * v, 1.0 * w)
        return answer.force, 1e-3 * answer.moment

    wanted = tools.by_load(bounce, load)
    fall = replace(bounce, position=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), duration=0.02, samples=2)
    assert_allclose(getattr(tools, program)(fall, tmp_path), tools.by_load(fall, load), atol=1e-5)  # 10 nm
    assert np.linalg.norm(wanted, axis=1).max() > HIP.clearance + 0.01
    assert_allclose(getattr(tools, program)(bounce, tmp_path), wanted, atol=1e-5)


def test_a_path_with_the_ending_of_a_file_is_that_file_in_ascii(tmp_path):
    printed("export", "c", str(EXAMPLES / "hip.toml"), "--out", "x.c", folder=tmp_path)
    printed("deck", "hip-28", "--force", "500", "--out", "y.inp", folder=tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {"x.c", "x.h", "x_readme.txt", "y.inp", "y_expected.json"}
    assert "Joint(" not in (tmp_path / "x.h").read_text("ascii")
    refused = run("export", "warp", "hip-28", "--out", "x.c", folder=tmp_path)
    assert "warp writes x_warp.py; give one of them, or a folder" in refused.stderr


def test_the_advised_time_step_keeps_the_energy_of_a_bounce_and_an_unstable_one_does_not():
    """Semi-implicit Euler of one ball, from the speed that reaches the depth of the export."""
    advice = ExportJob(element=PLAIN, name="hip", depth=0.05, mass=2.0).time_steps
    energy, _, stiffness = PLAIN.potential(0.05)
    assert_allclose(advice.stable, 2.0 * sqrt(2e-3 / stiffness), rtol=1e-12)
    relaxing = replace(PLAIN, relaxation=Prony(terms=((0.3, 1.0), (0.2, 1e-6))))
    assert ExportJob(element=relaxing, name="hip", depth=0.05).time_steps.stable == 1e-6  # the shortest time

    def energy_change(step, start):
        depth, speed = start * step, sqrt(2.0 * energy / 2e-3)
        while depth > 0.0 or speed > 0.0:
            speed -= step * PLAIN.potential(max(depth, 0.0))[1] / 2e-3
            depth += step * speed
        return abs(speed * speed * 1e-3 / energy - 1.0)

    starts = -np.linspace(0.0, 1.0, 7) * sqrt(2.0 * energy / 2e-3)
    assert max(energy_change(advice.accurate, start) for start in starts) < 0.011
    assert max(energy_change(1.2 * advice.stable, start) for start in starts) > 0.05
    advised = TARGETS["c"].file_texts(ExportJob(element=PLAIN, name="hip", depth=0.05, mass=2.0))["hip_readme.txt"]
    assert f"{advice.stable:.2g} s" in advised


@pytest.mark.parametrize(
    "loss", [{"damping": Damping(time=2e-4)}, {"relaxation": Prony(terms=((0.4, 2e-4), (0.3, 1e-2)))}]
)
def test_a_vibration_dies_out_below_the_stable_step_and_grows_above_it(loss):
    """Semi-implicit Euler of a ball about its rest under a force, as a host with an element in C does."""
    element, mass, depth = replace(PLAIN, **loss), 2e-3, 0.05
    stable = ExportJob(element=element, name="hip", depth=depth, mass=1e3 * mass).time_steps.stable
    assert stable < 1.9 * sqrt(mass / PLAIN.potential(depth)[2])

    def speed_after(step):
        held = PLAIN.potential(depth)[1]
        states = {name: (held,) * count for name, count in element.internal_states.items()}
        height, speed = HIP.clearance + depth, 1e-6
        pull = -element((0.0, 0.0, height), **states).force[2]
        for _ in range(400):
            load = element((0.0, 0.0, height), (0.0, 0.0, speed), **states)
            speed += step * (load.force[2] + pull) / mass
            height += step * speed
            for name, values in states.items():
                rates = getattr(load, f"{name}_rate")
                states[name] = tuple(value + step * rate for value, rate in zip(values, rates, strict=True))
        return abs(speed)

    assert speed_after(0.95 * stable) < 1e-6 < speed_after(1.05 * stable)
