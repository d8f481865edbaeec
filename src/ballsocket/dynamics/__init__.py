"""The joint in motion: a force element of any model, what it loses, and what becomes of it over time."""

from . import restitution as relations
from .bristles import Bristles
from .damping import Damping, Flores, Gonthier, HuntCrossley, LankaraniNikravesh, Restitution, of_restitution
from .drop_test import Identified, from_bounces, from_restitution
from .element import ForceElement
from .friction import Friction
from .load import Load, Touch
from .motion import Motion, simulate
from .prony import Prony
from .viscoelastic import Viscoelastic

__all__ = [
    "Bristles",
    "Damping",
    "Flores",
    "ForceElement",
    "Friction",
    "Gonthier",
    "HuntCrossley",
    "Identified",
    "LankaraniNikravesh",
    "Load",
    "Motion",
    "Prony",
    "Restitution",
    "Touch",
    "Viscoelastic",
    "from_bounces",
    "from_restitution",
    "of_restitution",
    "relations",
    "simulate",
]
