"""Settings of the cycle that the views Gait and Wear share."""

from ...hip.cycle_registry import CYCLES
from ..state.screen import Screen
from ..state.use import CHOICES
from .fields import Field, segments
from .numbers import BODY_WEIGHT
from .settings import Setting, changed, chosen

_FOUNDATIONS = {"springs": "springs", "shell": "closed shell", "cup": "real cup"}


def _body_weight_field(screen: Screen) -> Field:
    """Describe the input of the body weight, hidden for a cycle that was not measured in patients."""
    field = BODY_WEIGHT.field("body_weight", screen.use.body_weight, screen.reading)
    return {**field, "hidden": not CYCLES[screen.use.cycle].per_body_weight}


CYCLE_SETTINGS = (
    chosen("use.cycle", "Cycle", CHOICES["cycle"]),
    Setting(
        "body_weight",
        _body_weight_field,
        lambda screen, value: changed(screen, "use.body_weight", BODY_WEIGHT.meant(value, screen.reading)),
    ),
    chosen("use.contact", "Liner model", _FOUNDATIONS, segments, _FOUNDATIONS.__getitem__),
)
"""Cycle, body weight where the cycle was measured in patients, and the model of the liner."""
