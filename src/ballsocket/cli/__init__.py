"""The words of the shell become the calls of the package."""

from . import deck, fit, lists, press, reproduce
from .root import main

__all__ = ["deck", "fit", "lists", "main", "press", "reproduce"]
