"""Force elements of a joint, damping, friction, viscoelastic liners, and simulated motion."""

from ..core.deprecation import renamed_names
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

Identified = DampingEstimate
Touch = ContactState

__getattr__ = renamed_names(__name__, {"of_restitution": "damping_from_restitution"})

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
    "PreloadedElement",
    "Prony",
    "Restitution",
    "Touch",
    "Viscoelastic",
    "damping_from_restitution",
    "from_bounces",
    "from_restitution",
    "relations",
    "simulate",
]
