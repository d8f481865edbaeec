"""Commands of the shell; the module of a command is imported when the command is used."""

from .root import main

__all__ = ["main"]
