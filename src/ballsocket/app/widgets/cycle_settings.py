"""Settings of the cycle that the views Gait and Wear share."""

from ...core.kinds import Kind, Unit
from ...hip.cycle_registry import CYCLES
from ..state.use import CHOICES
from .fields import segments
from .settings import amount, chosen

_FOUNDATIONS = {"springs": "springs", "shell": "closed shell", "cup": "real cup"}

CYCLE_SETTINGS = (
    chosen("use.cycle", "Cycle", CHOICES["cycle"]),
    amount(
        "use.body_weight",
        "Body weight",
        (300.0, 1500.0),
        10.0,
        Unit("N"),
        Kind.FORCE,
        needed=lambda screen: CYCLES[screen.use.cycle].per_body_weight,
    ),
    chosen("use.contact", "Liner model", _FOUNDATIONS, segments, _FOUNDATIONS.__getitem__),
)
"""Cycle, body weight where the cycle was measured in patients, and the model of the liner."""
