"""Layers behind the liner, and joints compared with one that is chosen, without a browser."""

from html import unescape

import pytest

import ballsocket as bs
from ballsocket.files.joint_file import JointFile
from ballsocket.problem import Support

from .asking import edits, trouble

pytest.importorskip("panel", reason="the explorer's extra is not installed")
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
    assert (joint.support, joint.name) == (Support.FREE, "")
    assert Page(page.channel.shown_value("link")).screen == page.screen
    expected = bs.Exact().press(joint, force=3000.0).max_pressure
    assert f"{float(expected):.4g}" in page.channel.shown_value("#press-numbers")
    edits(page, "behind.0", "away")
    edits(page, "behind.0", "away")
    joint = page.screen.file.joint
    assert (joint.backing, joint.support) == ((), Support.FIXED)  # nothing is left to be free
    assert "behind.0" not in page.channel.shown_value("order")


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("0", "titanium", "'0' among the layers is not known"),
        ("add", "cheese", "'cheese' as material is not known"),
        ("support", "loose", "'loose' as support is not known"),
    ],
)
def test_what_is_no_layer_is_told(name, value, sentence):
    page = Page(HIP)
    before = page.screen
    edits(page, f"behind.{name}", value)
    assert sentence in unescape(trouble(page))
    assert page.screen == before


def test_a_wall_of_layers_ends():
    file = JointFile(bs.joints["hip-28"], {"force": 3000.0})
    for _ in range(20):
        file = layers_edited(file, "add", "titanium")
    assert len(file.joint.backing) == 20
    with pytest.raises(ValueError, match="'titanium' is one layer too many: at most 20"):
        layers_edited(file, "add", "titanium")


def test_joints_are_compared_with_the_one_that_is_chosen():
    page = Page(f"view=compare&{HIP}&beside1.preset=hip-36&beside2.preset=hip-32")
    page._refresh()
    assert "than hip-36" in page.view._told.object
    base = page.view._base
    assert list(base.options) == ["this joint", "hip-36", "hip-32"]
    base.value = "0"
    assert "than this joint" in page.view._told.object
    assert "this joint: the base" in page.view._table.object
    mine, other = (bs.Exact().press(bs.joints[name], force=3000.0).max_pressure for name in ("hip-28", "hip-36"))
    assert f"{float(other):.4g} ({100 * (other / mine - 1):+.0f} %)" in page.view._table.object
    assert "base=0" in page.channel.shown_value("link")
    alone = Page(f"view=compare&{HIP}")
    alone._refresh()
    assert alone.screen.base == "1"  # nothing has been chosen by looking
