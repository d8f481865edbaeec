"""What a model says beside force and energy, as curves over the indentation: half angle and largest pressure."""

from __future__ import annotations

from ..contact import Model
from ..contact.law import CurveLaw, curve_law
from ..core.arrays import Array, where
from ..problem import Joint
from .potential import slopes_of_array


def curve_of(model: Model, joint: Joint, quantity: str) -> CurveLaw:
    """A quantity of a contact over the indentation, up to the socket's radius."""
    whole = joint.with_floats()
    shallowest = 1e-6 * (whole.clearance or whole.socket_radius)
    return curve_law(
        lambda depths: getattr(model.press(whole, indentation=depths), quantity), shallowest, whole.socket_radius
    )


def read(curve: CurveLaw, indentation: Array) -> Array:
    """The curve at indentations of any sign: 0 where nothing touches, NaN beyond its end."""
    if type(indentation) is float:
        return curve(indentation)[0]
    ends = curve.shallowest, curve.deepest, curve.first, curve.density
    return where(indentation > 0.0, slopes_of_array(indentation, *ends, curve.pieces)[0], 0.0)
