"""Numbers of the page on the contacts of other programs."""

import re

import pytest
from numpy.testing import assert_allclose

import ballsocket as bs

from ..places import ROOT

PAGE = (ROOT / "docs" / "how-to" / "foundation_modulus.md").read_text(encoding="utf-8")
HIP = bs.joints["hip-28"]
MODULUS = 1e9 * bs.hess_forsbach(HIP)  # N/m³


def test_the_table_has_the_moduli_of_the_joint():
    written = [float(number) for number in re.findall(r"\| ([\d.]+e11) N/m³", PAGE)]
    assert_allclose(written, [MODULUS] * 3, rtol=2e-3)  # three digits
    (slab,) = re.findall(r"\| ([\d.]+e9) Pa \|", PAGE)
    assert_allclose(float(slab), MODULUS * 1e-3 * HIP.liner_thickness, rtol=3e-3)


@pytest.mark.long
def test_a_contact_of_mujoco_has_the_stiffness_of_the_page():
    mujoco = pytest.importorskip("mujoco", reason="mujoco is not installed")
    (numbers,) = re.findall(r"^'(solref=.*)'$", PAGE, re.MULTILINE)
    ball = '<joint type="slide" axis="0 0 1"/><geom size="0.0139" mass="1"/>'
    plane = f'<geom type="plane" size="1 1 1" {numbers} priority="1"/><body pos="0 0 0.0139">{ball}</body>'
    scene = f'<mujoco><option timestep="1e-5" gravity="0 0 0"/><worldbody>{plane}</worldbody></mujoco>'
    model = mujoco.MjModel.from_xml_string(scene)
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = -2000.0
    mujoco.mj_step(model, data, 5000)
    tangent = 1e3 * bs.Tabulated().press(HIP, force=2000.0).stiffness
    assert_allclose(-data.qpos[0], 2000.0 / tangent, rtol=3e-3)
