"""Delegation of a wrapped model."""

from dataclasses import dataclass

import pytest

import ballsocket as bs
from ballsocket.contact import Model, ModelInfo, ModelWrapper

from ..joints import HIP

ATTRIBUTES = (
    *("name", "title", "sources", "fits", "domain", "validity", "promise", "remarks", "reach", "parameters"),
    *("planar", "differentiable", "smooth_step", "seconds_a_press", "contact_type", "accepts_floats"),
)


@dataclass(frozen=True, kw_only=True)
class Renamed(ModelWrapper):
    """Wrapper that overrides one attribute."""

    @property
    def name(self) -> str:
        """Name of this wrapper."""
        return "renamed"


@pytest.mark.parametrize("model", [bs.Exact(), bs.Hertz(), bs.LiuReconstruction(), bs.FiniteElement()], ids=type)
def test_a_wrapper_delegates_every_attribute_that_it_does_not_override(model):
    wrapper = Renamed(model=model)
    for name in ATTRIBUTES[1:]:
        assert getattr(wrapper, name) == getattr(model, name), name
    assert wrapper.name == "renamed"
    assert isinstance(wrapper, Model)


def test_all_declared_attributes_are_delegated():
    declared = {name for cls in (Model, ModelInfo) for name in cls.__annotations__}
    properties = {
        name for cls in (Model, ModelInfo) for name, value in vars(cls).items() if isinstance(value, property)
    }
    assert declared | properties == {*ATTRIBUTES, "off_axis"}


def test_a_wrapper_presses_as_the_wrapped_model():
    wrapped, model = Renamed(model=bs.HessForsbach()), bs.HessForsbach()
    for force in (3000.0, 1e-9):
        assert wrapped.press(HIP, force=force).indentation == model.press(HIP, force=force).indentation
    assert wrapped.law(HIP)(0.05) == model.law(HIP)(0.05)
    assert wrapped.press(HIP, force=1.0).model is wrapped


def test_a_model_info_without_a_contact_has_no_laws():
    with pytest.raises(NotImplementedError, match="pin-in-hole has no laws of a contact"):
        bs.PinInHole().numpy_laws(HIP, 0.1)
