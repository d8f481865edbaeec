"""The inputs of a cycle, which the views of gait and wear share."""

from __future__ import annotations

from ..core.kinds import Unit
from ..hip.cycle_registry import CYCLES
from .fields import Field, choice, number, segments
from .in_use import CHOICES, Use

_BEDS = (("springs", "springs"), ("shell", "closed shell"), ("cup", "real cup"))


def cycle_fields(view: str, use: Use) -> list[Field]:
    """Cycle, body weight where the cycle was measured in patients, and what the bore is taken for."""
    weight = number(f"{view}.body_weight", "Body weight", Unit("N"), (300.0, 1500.0), 10.0, use.body_weight)
    return [
        choice(f"{view}.cycle", "Cycle", [(name, name) for name in CHOICES["cycle"]], use.cycle),
        {**weight, "hidden": not CYCLES[use.cycle].per_body_weight},
        segments(f"{view}.contact", "The bore gives way as", _BEDS, use.contact),
    ]
