"""The catalogue: every model that answers to `press`, by name."""

from __future__ import annotations

from .elastic.axisymmetric import Exact
from .elastic.table import Tabulated
from .models import every
from .models.base import Model

catalogue: dict[str, Model] = {model.name: model for model in (Exact(), Tabulated(), *every)}
"""Name -> model: what `--model` and files call them."""
