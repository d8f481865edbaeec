"""What is listed, models and presets, as dictionaries for JSON."""

from __future__ import annotations

from math import isfinite
from typing import Any

from ..contact.model_info import ModelInfo
from ..core.sources import Source
from ..core.validity import Range
from ..problem import Joint, Material


def model_summary(model: ModelInfo) -> dict[str, Any]:
    """A model: what it promises, and where; angles of ranges are in rad, an open end is null."""
    promise = model.promise
    return {
        "name": model.name,
        "title": model.title,
        "promise": None if promise is None else {"within": promise.within, "quantities": list(promise.quantities)},
        "validity": list(map(_range, model.validity)),
        "reach": model.reach,
        "sources": list(map(source_summary, model.sources)),
    }


def preset_summary(preset: Material | Joint) -> dict[str, Any]:
    """A material or joint with its source."""
    return {**preset.summary(), "source": preset.source}


def _range(limit: Range) -> dict[str, Any]:
    low, high = (end if isfinite(end) else None for end in (limit.low, limit.high))
    name = limit.quantity if isinstance(limit.quantity, str) else None
    return {"quantity": name, "text": str(limit), "low": low, "high": high, "why": limit.why}


def source_summary(source: Source) -> dict[str, Any]:
    """A publication, and the place in it."""
    return {"key": source.key, "text": str(source), "doi": source.doi or None}
