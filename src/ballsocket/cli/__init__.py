"""The words of the shell become the calls of the package."""

from . import app, deck, fit, lists, press, questions, reproduce, study
from .root import main

__all__ = ["app", "deck", "fit", "lists", "main", "press", "questions", "reproduce", "study"]
