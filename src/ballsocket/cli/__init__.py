"""The words of the shell become the calls of the package."""

# in the order in which `--help` lists what they do
from . import press, orient, questions, study, hip, lists, identify, fit, evidence, deck, fmu, app, reproduce  # noqa: I001
from .root import main

__all__ = [
    "app",
    "deck",
    "evidence",
    "fit",
    "fmu",
    "hip",
    "identify",
    "lists",
    "main",
    "orient",
    "press",
    "questions",
    "reproduce",
    "study",
]
