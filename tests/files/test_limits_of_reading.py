"""Smallest and largest inputs of the readers: one digit, a short direction, an angle between two degrees."""

from math import pi, radians

import pytest

from ballsocket.files.joint_file import Direction
from ballsocket.files.schema import Angle


def test_an_angle_is_written_with_the_digits_that_were_typed_and_read_back_to_the_last_bit():
    """The nearest degrees of some angles give another angle; a neighbour gives the same."""
    for degrees in (30.0, 84.8, 0.1, 33.3, 35.668, 22.123456789, 120.000000001):
        assert Angle(radians(degrees)).write(with_unit=False) == degrees
    for angle in (1.8906655686558533, -3.058855722527143, 2.590331057056523, pi / 3):
        assert radians(Angle(angle).write(with_unit=False)) == angle


def test_a_load_may_have_a_short_direction():
    assert Direction.read("direction", [0, 0.3, 0.4]) == (0.0, 0.3, 0.4)
    with pytest.raises(ValueError, match="length of direction"):
        Direction.read("direction", [0, 0, 0])
