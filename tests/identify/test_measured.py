"""Sets of measurements: what they hold, and what is refused."""

import sys
from importlib import import_module

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import CustomObservable, Machine, Measured, oscillation

FORCE = [100.0, 200.0, 300.0]
ROW = {"quantity": "indentation", "values": [0.01, 0.02, 0.03], "uncertainty": 1e-3, "force": FORCE}
JOINT = bs.joints["hess-forsbach"]


def measured(**settings):
    return Measured(**{**ROW, **settings})


def test_numbers_become_rows_of_the_values():
    data = measured(load_uncertainty=5.0)
    for row, expected in (
        (data.values, [0.01, 0.02, 0.03]),
        (data.uncertainty, [1e-3] * 3),
        (data.loads, FORCE),
        (data.load_uncertainty, [5.0] * 3),
        (data.order, [0.0, 1.0, 2.0]),
    ):
        np.testing.assert_array_equal(row, expected)
    assert (len(data), data.load, data.described.title) == (3, "force", "indentation")
    assert measured().load_uncertainty.tolist() == [0.0] * 3
    assert data.saturated.tolist() == [False] * 3
    assert measured(values=5.0, force=FORCE[:1]).values.tolist() == [5.0]


def test_a_quantity_of_the_joint_has_no_loads():
    data = Measured(quantity="liner_young", values=[900.0, 950.0], uncertainty=[10.0, 20.0])
    assert (data.load, len(data.loads), len(data)) == ("", 0, 2)


def test_values_at_the_saturation_are_lower_bounds():
    film = Measured(quantity="max_pressure", values=[4.0, 7.0, 8.0], uncertainty=0.1, force=FORCE, saturation=7.0)
    assert film.saturated.tolist() == [False, True, True]


def test_a_machine_with_a_zero_error_may_read_below_zero_and_without_a_load():
    for machine in (Machine(offset=-0.02), Machine(drift=-0.02), Machine(offset=(-0.1, 0.0))):
        data = measured(values=[-0.01, 0.0, 0.02], force=[0.0, 100.0, 200.0], machine=machine)
        assert data.values[0] == -0.01
    with pytest.raises(ValueError, match=r"force\[0\] = 0 is not allowed: at first touch the indentation is 0"):
        measured(force=[0.0, 100.0, 200.0], machine=Machine(compliance=1e-6))
    by_depth = Measured(
        quantity="force", values=FORCE, uncertainty=1.0, indentation=[-0.01, 0.02, 0.03], machine=Machine(offset=-0.02)
    )
    assert by_depth.loads[0] == -0.01


def test_a_zero_value_needs_no_load():
    assert measured(values=[0.0, 0.02, 0.03], force=[0.0, 100.0, 200.0]).values[0] == 0.0


def test_an_area_is_at_most_half_of_the_ball():
    half = 2 * np.pi * JOINT.ball_radius**2
    area = {"quantity": "area", "uncertainty": 1.0, "force": FORCE[:1]}
    Measured(**area, values=0.999 * half).check_area(JOINT)
    with pytest.raises(ValueError, match=r"area\[0\] = .* is not allowed: a contact area is below half of the ball"):
        Measured(**area, values=1.001 * half).check_area(JOINT)
    measured(values=[1e4, 2e4, 3e4]).check_area(JOINT)


def test_a_custom_observable_has_any_name_and_values():
    twice = CustomObservable(oscillation(1.0).described, lambda contact: -2 * contact.force)
    data = measured(quantity="pull", observable=twice, values=[-200.0, -400.0, -600.0])
    assert data.described is twice.described
    assert data.quantity == "pull"


def test_the_frequency_of_a_mass_follows_from_the_stiffness():
    contact = bs.HessForsbach().press(JOINT, force=1000.0)
    frequency = oscillation(2.0).read(contact)
    assert (2 * np.pi * frequency) ** 2 * 2.0 == pytest.approx(1e3 * contact.stiffness)
    for mass in (0.0, -1.0, np.inf):
        with pytest.raises(ValueError, match="a mass .kg. is above 0 and finite"):
            oscillation(mass)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"uncertainty": [1e-3, np.nan, 1e-3]}, "indentation_uncertainty has no number in row 2"),
        ({"order": [np.nan, 1.0, 2.0]}, "order has no number in row 1"),
        ({"order": [0.0, np.inf, 2.0]}, r"order\[1\] = inf is not allowed: numbers of readings must be finite"),
        ({"values": [np.nan, 0.02, np.nan]}, "indentation has no number in row 1, 3: add it, or omit the row"),
        ({"values": [[0.01, 0.02, 0.03]]}, r"indentation of shape \(1, 3\) must be a row of numbers"),
        ({"values": []}, r"indentation of shape \(0,\) must be a row of numbers"),
        ({"values": ["thick", "thin", "flat"]}, "indentation = .* must be numbers"),
        ({"values": [-0.01, 0.02, 0.03]}, r"indentation\[0\] = -0.01 is not allowed: an indentation"),
        ({"force": [100.0, np.nan, 300.0]}, "force has no number in row 2"),
        ({"force": [100.0, 200.0]}, "force must have 1 or 3 numbers, got 2"),
        ({"load_uncertainty": -1.0}, r"load_uncertainty\[0\] = -1 .*the value must be 0 or more and finite"),
        ({"load_uncertainty": np.inf}, "load_uncertainty.* the value must be 0 or more and finite"),
        ({"uncertainty": np.inf}, "indentation_uncertainty.* an uncertainty is above 0 and finite"),
        ({"saturation": 0.0}, "saturation = 0 is not allowed: the largest reading of a film is above 0"),
        ({"quantity": "force"}, "force is both the measured quantity and the load; choose another load"),
        ({"angle": 0.1}, "indentation takes no angle"),
        ({"quantity": "pressure", "angle": [0.1, 0.2]}, "angle must have 1 or 3 numbers, got 2"),
        ({"quantity": "pressure", "angle": 4.0}, "a polar angle lies between -pi and pi"),
        ({"quantity": "area", "machine": Machine()}, "area has a machine, but only indentations are read by one"),
        ({"quantity": "stiffness", "values": [1.0, -2.0, 3.0]}, r"stiffness\[1\] = -2 .*the value must be 0 or more"),
        ({"quantity": "energy", "values": [1.0, np.inf, 3.0]}, r"energy\[1\] = inf .*the value must be 0 or more"),
        ({"name": "film", "uncertainty": 0.0}, r"film: indentation_uncertainty\[0\] = 0 \(and 2 more\)"),
        ({"force": None}, "exactly one of force, indentation, half_angle is needed, got none"),
    ],
)
def test_numbers_that_contradict_a_rule_are_refused(settings, message):
    with pytest.raises(ValueError, match=message):
        measured(**settings)


def test_a_message_names_at_most_eight_rows():
    values = np.full(12, np.nan)
    with pytest.raises(ValueError, match="no number in row 1, 2, 3, 4, 5, 6, 7, 8: add it"):
        Measured(quantity="indentation", values=values, uncertainty=1.0, force=np.ones(12))


def test_earlier_names_warn():
    observable = oscillation(1.0)
    with pytest.warns(DeprecationWarning, match="'own'.*'observable'"):
        data = measured(quantity="frequency", own=observable)
    with pytest.warns(DeprecationWarning, match=r"Measured.own is deprecated: use observable"):
        assert data.own is observable


def test_old_path_of_oscillation_keeps_the_function():
    module = import_module("ballsocket.identify.oscillation")
    assert module.oscillation is oscillation
    assert sys.modules["ballsocket.identify"].oscillation is oscillation
