"""Smallest and largest inputs of the readers: one row, one digit, a short direction, an angle between two degrees."""

from math import pi, radians

import pytest

from ballsocket.files.columns import read_text_table, split_head
from ballsocket.files.joint_file import Direction
from ballsocket.files.schema import Angle


def test_an_angle_is_written_with_the_digits_that_were_typed_and_read_back_to_the_last_bit():
    """The nearest degrees of some angles give another angle; a neighbour gives the same."""
    for degrees in (30.0, 35.668, 22.123456789, 120.000000001):
        assert Angle(radians(degrees)).write(with_unit=False) == degrees
    for angle in (1.8906655686558533, -3.058855722527143, 2.590331057056523, pi / 3):
        assert radians(Angle(angle).write(with_unit=False)) == angle


def test_a_head_may_be_a_unit_alone():
    assert split_head("[N]") == ("", "N")
    assert split_head("Force [N]") == ("Force", "N")
    assert split_head("Force") == ("Force", "")


def test_the_rows_of_an_opensim_file_are_counted(tmp_path):
    path = tmp_path / "gait.mot"
    path.write_text("gait\nendheader\ntime flexion\n0 1\n\n1 2\n")
    counts = []
    table = read_text_table(path, ["time"], counts.append)
    assert counts == [2]
    assert [column.numbers.tolist() for column in table.columns] == [[0.0, 1.0], [1.0, 2.0]]
    path.write_text("gait\nnRows=3\nendheader\ntime flexion\n0 1\n1 2\n")
    with pytest.raises(ValueError, match="states '3' rows, but the file has 2"):
        read_text_table(path, ["time"], counts.append)


def test_a_head_line_that_ends_with_a_digit_is_a_row(tmp_path):
    path = tmp_path / "gait.csv"
    path.write_text("time, run 7\ntime, flexion\n0, 1\n1, 2\n")
    table = read_text_table(path, ["time"], [].append)
    assert [head.strip() for head in table.heads] == ["time", "flexion"]


def test_a_load_may_have_a_short_direction():
    assert Direction.read("direction", [0, 0.3, 0.4]) == (0.0, 0.3, 0.4)
    with pytest.raises(ValueError, match="length of direction"):
        Direction.read("direction", [0, 0, 0])
