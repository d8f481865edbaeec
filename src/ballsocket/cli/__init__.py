"""The words of the shell become the calls of the package."""

# in the order in which `--help` lists what they do
from . import press, curve, orient, questions, study, hip, lists, identify, fit, evidence  # noqa: I001
from . import deck, fmu, export, schema, app, serve_mcp, reproduce
from .root import main

__all__ = [
    "app",
    "curve",
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
    "schema",
    "serve_mcp",
    "study",
]
