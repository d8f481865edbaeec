"""The words of the shell become the calls of the package."""

# in the order in which `--help` lists what they do
from . import press, orient, questions, study, hip, lists, identify, fit, evidence, deck, fmu, export, app, reproduce  # noqa
from .root import main

__all__ = [
    "app",
    "deck",
    "evidence",
    "export",
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
