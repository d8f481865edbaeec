"""What is recomputed, piece by piece: each piece is kept in a file, so that a killed run goes on where it stopped."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ..accuracy import accuracies, paper_joints
from ..all_models import catalogue
from ..calibrate import refit_table_3
from ..elastic.axisymmetric import Exact
from ..fem.model import FiniteElement
from ..fem.spacing import Element, Uniform
from ..models.base import Model
from ..version import __version__
from .claims import ledger
from .curves import figure_2, figure_3_or_4, figure_5, figure_6

Piece = Callable[[], Any]
"""Computes something that JSON can hold."""

_COMPARED = ("hess-forsbach", "bartel", "bonded-layer", "hertz", "refined", "exact")


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Pieces by name, and a name for all of them that says with what they are computed."""

    name: str
    pieces: Mapping[str, Piece]

    def run(self, folder: Path) -> Iterator[tuple[str, Any]]:
        """The pieces, one after the other, with their results; those that lie in the folder already are read from it.

        Raises
        ------
        OSError
            A folder that cannot be written to.
        """
        folder.mkdir(parents=True, exist_ok=True)
        for name, piece in self.pieces.items():
            path = folder / f"{name}.json"
            kept = _kept(path, self._key)
            if kept is None:
                kept = piece()
                _keep(path, {"key": self._key, "result": kept})
            yield name, kept

    @property
    def _key(self) -> str:
        return f"ballsocket {__version__}, {self.name}"


def _kept(path: Path, key: str) -> Any:
    """What a file holds; None where it is another run's, or broken."""
    try:
        record = json.loads(path.read_text(encoding="utf-8"))
        return record["result"] if record["key"] == key else None
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _keep(path: Path, record: Any) -> None:
    """Write a file at once: an interruption leaves none."""
    with TemporaryDirectory(dir=path.parent) as folder:
        whole = Path(folder) / path.name
        whole.write_text(json.dumps(record, allow_nan=False), encoding="utf-8")
        os.replace(whole, path)


def quick_plan() -> Plan:
    """The exact solution plays the part of the paper's finite elements: seconds."""
    exact = Exact(tolerance=1e-4)
    models = {name: catalogue[name] for name in _COMPARED}
    return Plan(name="quick", pieces=_pieces({"exact": exact}, models, exact, joints=32))


def full_plan() -> Plan:
    """With finite elements: those of the paper's density beside the models, adapted ones for the moduli. Minutes."""
    fem = FiniteElement(meshes=1)
    dense = FiniteElement(spacing=Uniform(size=0.05), element=Element.BILINEAR, meshes=1)
    exact = catalogue["exact"]
    models = {**{name: catalogue[name] for name in _COMPARED}, "finite elements": dense}
    return Plan(name="full", pieces=_pieces({"exact": exact, "finite elements": fem}, models, fem, joints=256))


def _pieces(
    references: Mapping[str, Model], models: Mapping[str, Model], judge: Model, joints: int
) -> dict[str, Piece]:
    last = list(models)[-1]
    pair = {"hess-forsbach": models["hess-forsbach"], last: models[last]}
    return {
        "figure_2": lambda: figure_2(references).summary(),
        "figure_3": lambda: figure_3_or_4(3, models).summary(),
        "figure_4": lambda: figure_3_or_4(4, models).summary(),
        "figure_5": lambda: figure_5(pair).summary(),
        "figure_6": lambda: figure_6(models["hess-forsbach"]).summary(),
        "figure_6_exact": lambda: figure_6(references["exact"], points=19).summary(),
        **{f"table_3_{_plain(name)}": _table_3(model) for name, model in references.items()},
        "claims": lambda: [finding.summary() for finding in ledger(judge)],
        "accuracy": lambda: [row.summary() for row in accuracies(joints=paper_joints(joints))],
    }


def _plain(name: str) -> str:
    return name.replace(" ", "_")


def _table_3(model: Model) -> Piece:
    return lambda: [column.summary() for column in refit_table_3(model)]
