"""Layers behind the liner, and joints compared with one that is chosen, without a browser."""

import re

import pytest

import ballsocket as bs
from ballsocket.files.joint_file import JointFile
from ballsocket.problem import Support
from ballsocket.problem.cup import Cup
from ballsocket.reports.check_table import checks_of

from .asking import does, edits, trouble

pytest.importorskip("tornado", reason="the explorer's extra is not installed")
from ballsocket.app.session import Page
from ballsocket.app.widgets.joint_fields import layers_edited

HIP = "preset=hip-28&load.force=3000"


def test_a_backing_is_built_from_bone_to_shell():
    page = Page(HIP)
    page._refresh()
    edits(page, "behind.add", "titanium")
    edits(page, "behind.add", "bone-cement")
    shell, cement = page.screen.file.joint.backing
    assert (shell.material, cement.material) == (bs.TITANIUM, bs.BONE_CEMENT)
    assert shell.thickness == cement.thickness == 3.0
    edits(page, "behind.1", "cancellous-bone")
    edits(page, "layer1", "8")
    edits(page, "behind.support", "free")
    joint = page.screen.file.joint
    assert joint.backing[1] == bs.Layer(thickness=8.0, material=bs.CANCELLOUS_BONE)
    assert (joint.support, joint.name, joint.source) == (Support.FREE, "hip-28 (changed)", "")
    assert Page(page.channel.shown_value("link")).screen == page.screen
    expected = bs.Exact().press(joint, force=3000.0).max_pressure
    assert f"{float(expected):.4g}" in page.channel.shown_value("#press-numbers")
    edits(page, "behind.0", "away")
    edits(page, "behind.0", "away")
    joint = page.screen.file.joint
    assert joint == bs.joints["hip-28"]  # nothing is left to be free, or to be changed
    assert "behind.0" not in page.channel.shown_value("order")


def test_a_wall_of_layers_ends():
    file = JointFile(bs.joints["hip-28"], {"force": 3000.0})
    for _ in range(20):
        file = layers_edited(file, "add", "titanium")
    assert len(file.joint.backing) == 20
    with pytest.raises(ValueError, match="'titanium' is one layer too many: at most 20"):
        layers_edited(file, "add", "titanium")


def test_joints_are_compared_with_the_one_that_is_chosen():
    page = Page(f"view=compare&{HIP}&beside1.preset=hip-36&beside2.preset=hip-32")
    assert "the difference from hip-36" in page.channel.shown_value("#compare-note")
    options = page.channel.shown_value("=compare.base")["options"]
    assert options == [["0", "this design"], ["1", "hip-36"], ["2", "hip-32"]]
    edits(page, "compare.base", "0")
    assert "the difference from this design" in page.channel.shown_value("#compare-note")
    mine, other = (bs.Exact().press(bs.joints[name], force=3000.0).max_pressure for name in ("hip-28", "hip-36"))
    table = page.channel.shown_value("#compare-table")
    assert f"{float(other):.4g}" in table
    assert f"{100 * (other / mine - 1):+.0f} %" in table
    assert "base=0" in page.channel.shown_value("link")
    assert Page(f"view=compare&{HIP}").screen.base == "1"  # nothing has been chosen by looking


def test_a_base_remains_the_same_design_when_another_is_removed():
    page = Page(f"view=compare&{HIP}&beside1.preset=hip-36&beside2.preset=hip-32&base=2")
    edits(page, "compare.remove", "hip-36")
    assert "the difference from hip-32" in page.channel.shown_value("#compare-note")
    edits(page, "compare.remove", "hip-32")
    assert page.screen.beside == ()
    assert "the difference from hip-36" in page.channel.shown_value("#compare-note")  # the example


def test_six_designs_are_compared_by_the_checks_of_contact():
    """The von Mises stress of the checks is that of the model itself, as in Contact."""
    names = [name for name in bs.joints if name not in ("hip-28", "hess-forsbach")][:6]
    beside = "&".join(f"beside{number}.preset={name}" for number, name in enumerate(names, start=1))
    page = Page(f"view=compare&{HIP}&{beside}")
    assert page.channel.shown_value("=compare.base")["options"][-1][0] == "6"
    table = page.channel.shown_value("#compare-table")
    contact = bs.Exact().press(page.screen.file.joint, force=3000.0)
    (check,) = [
        row for row in checks_of(contact, Cup(), float(contact.von_mises)) if "stress in the liner" in row.title
    ]
    row = re.search(rf"<th scope='row'>{check.title} / {check.limit}</th><td class='\w*'>(.*?)</td>", table)
    assert row[1] == f"✓ {100 * check.ratio:.0f} %"
    does(page, "choose", name="view", value="press")
    assert f"{100 * check.ratio:.0f} %" in page.channel.shown_value("#press-numbers")
    does(page, "choose", name="view", value="compare")
    edits(page, "compare.keep", True)
    assert "6 designs are compared with this one already" in trouble(page)
