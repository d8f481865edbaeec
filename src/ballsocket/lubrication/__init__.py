"""Lubricating film between ball and socket: closed form, kinematic wave, and Reynolds' equation."""

from .lubricant import Lubricant

__all__ = ["Lubricant"]
