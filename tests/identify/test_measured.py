"""Sets of measurements: what they hold, and what is refused."""

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
        (measured().load_uncertainty, [0.0] * 3),
        (data.saturated, [False] * 3),
        (measured(values=5.0, force=FORCE[:1]).values, [5.0]),
        (measured(values=[0.0, 0.02, 0.03], force=[0.0, 100.0, 200.0]).values, [0.0, 0.02, 0.03]),  # no load, no value
        (measured(quantity="max_pressure", values=[4.0, 7.0, 8.0], saturation=7.0).saturated, [False, True, True]),
    ):
        np.testing.assert_array_equal(row, expected)
    assert (len(data), data.load, data.described.title) == (3, "force", "indentation")
    of_joint = Measured(quantity="liner_young", values=[900.0, 950.0], uncertainty=[10.0, 20.0])
    assert (of_joint.load, len(of_joint.loads), len(of_joint)) == ("", 0, 2)


def test_a_machine_with_a_zero_error_may_read_below_zero_and_without_a_load():
    for machine in (Machine(offset=-0.02), Machine(drift=-0.02), Machine(offset=(-0.1, 0.0))):
        data = measured(values=[-0.01, 0.0, 0.02], force=[0.0, 100.0, 200.0], machine=machine)
        assert data.values[0] == -0.01
    by_depth = Measured(
        quantity="force", values=FORCE, uncertainty=1.0, indentation=[-0.01, 0.02, 0.03], machine=Machine(offset=-0.02)
    )
    assert by_depth.loads[0] == -0.01


def test_an_area_is_at_most_half_of_the_ball():
    half = 2 * np.pi * JOINT.ball_radius**2
    area = {"quantity": "area", "uncertainty": 1.0, "force": FORCE[:1]}
    Measured(**area, values=0.999 * half).check_area(JOINT)
    with pytest.raises(ValueError, match=r"area\[0\] = .* is not allowed: a contact area is below half of the ball"):
        Measured(**area, values=1.001 * half).check_area(JOINT)
    measured(values=[1e4, 2e4, 3e4]).check_area(JOINT)


def test_a_custom_observable_is_read_from_contacts_with_any_name_and_values():
    contact = bs.HessForsbach().press(JOINT, force=1000.0)
    frequency = oscillation(2.0).read(contact)
    assert (2 * np.pi * frequency) ** 2 * 2.0 == pytest.approx(1e3 * contact.stiffness)
    twice = CustomObservable(oscillation(1.0).described, lambda contact: -2 * contact.force)
    data = measured(quantity="pull", observable=twice, values=[-200.0, -400.0, -600.0])
    assert (data.described, data.quantity) == (twice.described, "pull")
