"""The catalogue: every model that answers to `press`, by name."""

from __future__ import annotations

from .elastic.axisymmetric import Exact
from .elastic.table import Tabulated
from .fem.model import FiniteElement
from .models import every
from .models.base import Model

catalogue: dict[str, Model] = {model.name: model for model in (Exact(), Tabulated(), *every)}
"""Name -> model: what `--model` and files call them, all of them answering in milliseconds or less."""

judge: Model = FiniteElement()
"""The finite elements: asked by name, not along with the others."""
