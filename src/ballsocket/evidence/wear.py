"""Wear in the evidence: the hip file that the question names, worn, with the bands of what scatters there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..hip.file import read_hip
from ..hip.uncertainty import uncertainty


def worn(path: Path) -> dict[str, Any]:
    """What becomes of the hip of a file, with bands of 95 % where the file says what scatters."""
    given = read_hip(path)
    history = given.use.after(given.cycles, given.report_at, lubricant=given.lubricant)
    answer: dict[str, Any] = {**history.summary(), "file": path.name, "call": f"ballsocket hip {path.name} --json"}
    if given.uncertain is not None:
        said = given.uncertain
        answer |= uncertainty(said.scatter, history, count=said.count, seed=said.seed).summary()
    return answer
