"""The drawing of a joint in the explorer."""

from dataclasses import replace
from math import degrees, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.app.pictures.section import petals
from ballsocket.files.joint_file import JointFile

from ..joints import HIP


@pytest.mark.parametrize("arc", [60.0, 180.0])
def test_the_band_of_pressure_ends_with_the_contact_and_at_the_rim(arc):
    file = JointFile(HIP, {"force": 3000.0}, bs.Cup(arc_of_cover=radians(arc)))
    contact = bs.Exact().press(file.joint, force=3000.0)
    _, angles, _ = petals(file, contact)
    widest = degrees(np.abs(angles).max())
    assert widest == pytest.approx(min(arc / 2, degrees(contact.half_angle)), abs=0.01)


def test_a_joint_without_a_load_has_no_band():
    file = JointFile(replace(HIP, name=""), {}, bs.Cup())
    assert petals(file, bs.Exact().press(file.joint, force=0.0))[2].size == 0
