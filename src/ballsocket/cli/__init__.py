"""The words of the shell become the calls of the package."""

from . import fit, lists, press
from .root import main

__all__ = ["fit", "lists", "main", "press"]
