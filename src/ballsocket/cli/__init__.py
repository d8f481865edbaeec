"""The words of the shell become the calls of the package."""

# in the order in which `--help` lists what they do
from . import press, questions, study, hip, lists, fit, deck, app, reproduce  # noqa: I001
from .root import main

__all__ = ["app", "deck", "fit", "hip", "lists", "main", "press", "questions", "reproduce", "study"]
