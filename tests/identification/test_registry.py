"""Registry of unknowns: work of adhesion, friction, and errors of a machine."""

import copy
import pickle
import re
from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identification import MACHINE_ERRORS, MODEL_NUMBERS, Machine, Measured, sliding_torque
from ballsocket.identification.file import read_identify
from ballsocket.problem.cup import Cup
from ballsocket.studies import Normal

from ..extent import some

HIP = bs.joints["hess-forsbach"]
FORCE = np.linspace(0.5, 40.0, 12)
MODEL = bs.AdhesiveSocket(work_of_adhesion=2e-4)
CONTACT = MODEL.press(HIP, force=FORCE)


def indentations(**settings):
    return Measured(quantity="indentation", values=CONTACT.indentation, uncertainty=1e-6, force=FORCE, **settings)


def test_the_work_of_adhesion_is_identified_from_indentations_at_small_forces():
    start = bs.AdhesiveSocket()
    result = bs.identify(start, HIP, indentations(), {"work_of_adhesion": (1e-5, 1e-3), "clearance": (0.05, 0.2)})
    assert result.point == pytest.approx({"work_of_adhesion": 2e-4, "clearance": HIP.clearance}, rel=1e-3)
    assert result.identifiable
    assert result["work_of_adhesion"].unit == "N/mm"
    assert result.model.work_of_adhesion == pytest.approx(2e-4, rel=1e-3)
    assert result.joint.clearance == pytest.approx(HIP.clearance, rel=1e-3)
    assert result.misfit.forward.model is start
    alone = bs.identify(start, HIP, indentations(), {"work_of_adhesion": (0.0, 1e-3)})
    assert alone.point == pytest.approx({"work_of_adhesion": 2e-4}, rel=1e-4)
    assert alone.joint == HIP
    known = bs.identify(start, HIP, indentations(), {"work_of_adhesion": Normal(mean=3e-4, deviation=1e-8)})
    assert known.point["work_of_adhesion"] == pytest.approx(3e-4, rel=1e-2)
    covered = start.in_cup(Cup(arc_of_cover=np.radians(150.0)))
    inside = bs.identify(covered, HIP, indentations(), {"work_of_adhesion": (1e-5, 1e-3)}).model
    assert inside.model.work_of_adhesion == pytest.approx(2e-4, rel=1e-3)
    assert inside.cup == covered.cup


@pytest.mark.parametrize("name", MODEL_NUMBERS)
def test_a_number_of_a_model_is_identified_from_presses_with_it(name):
    number = MODEL_NUMBERS[name]
    model = next(filter(number.belongs_to, bs.catalogue.values()))
    usual = getattr(model.press(HIP, force=20.0), name, None) or getattr(model, name)
    low, truth = number.insert_into(model, np.array([[0.5], [1.3]]) * usual).press(HIP, force=FORCE).indentation
    alone = number.insert_into(model, 1.3 * usual).press(HIP, force=FORCE).indentation
    assert truth == pytest.approx(alone, rel=1e-9)
    assert np.abs(low - truth).max() > 1e-5
    reading = Measured(quantity="indentation", values=truth, uncertainty=1e-6, force=FORCE)
    result = bs.identify(model, HIP, reading, {name: (0.5 * usual, 3.0 * usual)})
    assert result.point == pytest.approx({name: 1.3 * usual}, rel=1e-3)
    with pytest.raises(ValueError, match=re.escape(number.quantity.allowed.partition(" ")[0])):
        bs.identify(model, HIP, reading, {name: (-2.0, -1.0)})


def identified_file(folder, model, free, data):
    text = f'model = "{model}"\njoint = "hess-forsbach"\n[free]\n{free}\n[[data]]\n{data}\n'
    (folder / "data.toml").write_text(text, "utf-8")
    return read_identify(folder / "data.toml").identify_unknowns().point


LOADS = np.linspace(300.0, 3000.0, 5)
SLIDING = bs.HessForsbach().press(HIP, force=LOADS)
FRICTION = {"friction_coefficient": (0.0, 0.3)}


def torques(values=None, axis_angle=pi / 2):
    """Make friction torques of μ = 0.06, or of stated values."""
    values = SLIDING.friction_torque(0.06, axis_angle) if values is None else values
    data = {"quantity": "friction_torque", "values": values, "uncertainty": 20.0, "force": LOADS}
    return Measured(**data, observable=sliding_torque(axis_angle))


def identified(data, free=FRICTION):
    return bs.identify(bs.HessForsbach(), HIP, data, free)


def test_estimate_and_band_of_friction_are_those_of_weighted_linear_regression():
    """The torque is μ f(F), so that μ = Σ f T/Σ f² with the standard uncertainty σ/sqrt(Σ f²)."""
    lever = np.asarray(SLIDING.friction_torque(1.0))
    values = 0.06 * lever + 20.0 * np.array([0.5, -1.0, 1.2, 0.3, -0.8])
    estimate = identified(torques(values))["friction_coefficient"]
    assert estimate.value == pytest.approx(lever @ values / (lever @ lever), rel=1e-6)
    half = 1.959964 * 20.0 / sqrt(lever @ lever)
    assert (estimate.high - estimate.low) / 2 == pytest.approx(half, rel=1e-3)


@pytest.mark.parametrize(("axis", "angle"), some([('axis_angle = "0 deg"', 0.0), ("", pi / 2)], 1))
def test_a_file_frees_the_coefficient_of_friction(tmp_path, axis, angle):
    text = ", ".join(f'"{value / 1e3:.9f} N m"' for value in SLIDING.friction_torque(0.06, angle))
    data = f'quantity = "friction_torque"\nvalues = [{text}]\nforce = {LOADS.tolist()}\nuncertainty = "2 %"\n{axis}'
    point = identified_file(tmp_path, "hess-forsbach", 'friction_coefficient = "0..0.3"', data)
    assert point == pytest.approx({"friction_coefficient": 0.06}, rel=1e-6)


def test_a_machine_has_every_registered_error():
    machine = Machine(**dict.fromkeys(MACHINE_ERRORS, 1e-06), name="press")
    assert machine.known_errors() == {f"press.{name}": 1e-6 for name in MACHINE_ERRORS}
    assert Machine().known_errors() == {f"machine.{name}": 0.0 for name in MACHINE_ERRORS}
    assert Machine(offset=(-1.0, 2.0)).unknown_errors == {"machine.offset": (-1.0, 2.0)}
    assert Machine(offset=0.1) == Machine(offset=0.1)
    assert Machine(offset=0.1) != Machine(drift=0.1)
    assert pickle.loads(pickle.dumps(machine)) == copy.deepcopy(machine) == machine
    assert replace(machine, offset=0.3).known_errors()["press.offset"] == 0.3
    with pytest.raises(AttributeError, match="no attribute 'offsett'"):
        _ = Machine().offsett
