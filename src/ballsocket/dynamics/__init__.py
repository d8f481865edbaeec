"""Force elements of a joint, damping, friction, viscoelastic liners, and simulated motion."""

from . import restitution as relations
from .bristles import Bristles
from .damping import Damping, Flores, Gonthier, HuntCrossley, LankaraniNikravesh, Restitution, of_restitution
from .element import ForceElement
from .friction import Friction
from .load import ContactState, Load
from .motion import Motion
from .rebound import DampingEstimate, from_bounces, from_restitution
from .simulation import simulate
from .viscoelastic import Prony, Viscoelastic

Identified = DampingEstimate
Touch = ContactState

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
