"""Force elements of a joint, damping, friction, viscoelastic liners, and simulated motion."""

from . import restitution as relations
from .bristles import Bristles
from .damping import (
    Damping,
    DampingEstimate,
    Flores,
    Gonthier,
    HuntCrossley,
    LankaraniNikravesh,
    Restitution,
    damping_from_restitution,
    from_bounces,
    from_restitution,
)
from .element import ForceElement
from .friction import Friction
from .load import ContactState, Load
from .motion import Motion
from .preloaded import PreloadedElement
from .simulation import simulate
from .viscoelastic import Prony, Viscoelastic

__all__ = [
    "Bristles",
    "ContactState",
    "Damping",
    "DampingEstimate",
    "Flores",
    "ForceElement",
    "Friction",
    "Gonthier",
    "HuntCrossley",
    "LankaraniNikravesh",
    "Load",
    "Motion",
    "PreloadedElement",
    "Prony",
    "Restitution",
    "Viscoelastic",
    "damping_from_restitution",
    "from_bounces",
    "from_restitution",
    "relations",
    "simulate",
]
