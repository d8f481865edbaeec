"""The joint in motion: a force element of any model, what it loses, and what becomes of it over time."""

from . import restitution as relations
from .damping import Damping, Flores, Gonthier, HuntCrossley, LankaraniNikravesh, Restitution, of_restitution
from .element import ForceElement
from .friction import Friction
from .load import Load
from .motion import Motion, simulate
from .touch import Touch

__all__ = [
    "Damping",
    "Flores",
    "ForceElement",
    "Friction",
    "Gonthier",
    "HuntCrossley",
    "LankaraniNikravesh",
    "Load",
    "Motion",
    "Restitution",
    "Touch",
    "of_restitution",
    "relations",
    "simulate",
]
