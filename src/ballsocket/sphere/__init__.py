"""Contact on the sphere: the ball anywhere in a socket, in rings and meridians about the socket's own axis."""

from .model import Sphere
from .surfaces import ClosedShell, RealCup, Springs
from .worn import Worn

__all__ = ["ClosedShell", "RealCup", "Sphere", "Springs", "Worn"]
