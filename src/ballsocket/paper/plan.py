"""What is recomputed, piece by piece: each piece is kept in a file, so that a killed run goes on where it stopped."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, product
from pathlib import Path
from typing import Any

from ..catalogue import catalogue
from ..contact import Model
from ..core.executors.processes import Engine, Serial
from ..core.storage.atomic_files import write_text
from ..core.storage.fingerprint import fingerprint
from ..core.storage.pieces import PieceRun, PieceStore
from ..elasticity.exact.model import Exact
from ..elasticity.finite_elements.model import FiniteElement
from . import cases, curves
from .accuracy import accuracies
from .claims import CLAIMS, ELSEWHERE, MESHED_CLAIMS, MESHED_ELSEWHERE, judged
from .claims.agreement import dense_elements
from .claims.finding import Claim
from .table_3 import refit_column

Piece = Callable[[], Any]
"""Computes something that JSON can hold."""

Results = dict[str, list[Any]]
"""The results of the pieces of each part."""

ELEMENTS = "finite elements"

_HERE = Serial()


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Parts by name, each of them pieces by name, and a name for all that says with what they are computed."""

    name: str
    parts: Mapping[str, Mapping[str, Piece]]

    def __len__(self) -> int:
        return sum(map(len, self.parts.values()))

    def run(self, folder: Path, engine: Engine = _HERE) -> Iterator[tuple[str, str, Any]]:
        """Yield part, name and result of each piece: stored results first, then the others as they are computed.

        Results are stored in a subfolder with the plan's name.

        Raises
        ------
        OSError
            The folder is not writable or the disk is full.
        """
        folder = folder / self.name
        folder.mkdir(parents=True, exist_ok=True)
        pieces = [(part, name) for part, pieces in self.parts.items() for name in pieces]
        store = _ResultFiles(
            paths=tuple(folder / f"{part}{_plain(name)}.json" for part, name in pieces),
            keys=tuple(f"ballsocket {fingerprint()}, {self.name}, {part} {name}" for part, name in pieces),
        )
        work = _PlanWork(tuple(self.parts[part][name] for part, name in pieces))
        run = PieceRun(work, range(len(pieces)), store)
        for number, result in chain(run.stored.items(), run.compute_missing(engine)):
            yield *pieces[number], result

    def results(
        self, folder: Path, listen: Callable[[str], None] = lambda name: None, engine: Engine = _HERE
    ) -> Results:
        """All results by part, in the order of the pieces; `listen` is told the name of each when it is there."""
        found: dict[tuple[str, str], Any] = {}
        for part, name, result in self.run(folder, engine):
            found[part, name] = result
            listen(f"{part} {name}".strip())
        return {part: [found[part, name] for name in pieces] for part, pieces in self.parts.items()}


@dataclass(frozen=True)
class _PlanWork:
    """Work of a plan; a call with a number computes that piece."""

    pieces: tuple[Piece, ...]

    def __call__(self, number: int) -> Any:
        return self.pieces[number]()


@dataclass(frozen=True)
class _ResultFiles(PieceStore):
    """Results of a plan in JSON files, one file a piece, each with a key that names the piece and the code."""

    paths: tuple[Path, ...]
    keys: tuple[str, ...]

    def load(self, numbers: Sequence[int]) -> dict[int, Any]:
        """Load the results of the pieces whose files are undamaged and have their key."""
        results = {number: self._read(number) for number in numbers}
        return {number: result for number, result in results.items() if result is not None}

    def save(self, number: int, result: Any) -> Any:
        """Write the result of a piece, and return it.

        Raises
        ------
        ValueError
            The result has a number that is NaN or infinite.
        """
        try:
            record = json.dumps({"key": self.keys[number], "result": result}, allow_nan=False)
        except ValueError as error:
            raise ValueError(f"{self.paths[number].stem} has a number that is missing or infinite") from error
        write_text(self.paths[number], record)
        return result

    def _read(self, number: int) -> Any:
        """Read the result of a piece; return None if it is missing, damaged or of another run."""
        try:
            record = json.loads(self.paths[number].read_text(encoding="utf-8"))
            return record["result"] if record["key"] == self.keys[number] else None
        except (OSError, ValueError, KeyError, TypeError):
            return None


def _plain(name: str) -> str:
    """A piece's name as part of a file's."""
    return "".join(f"_{word}" for word in re.findall(r"\w+", name))


_COMPARED = ("hertz", "bartel", "bonded-layer", "hess-forsbach", "refined", "exact")


_QUICK = (
    "In this quick run the exact elastic solution of the lined socket plays the part of the paper's finite elements; "
    "the full run has finite elements beside it in every figure and lets them judge the claims."
)
_FULL = (
    "Claims are judged by finite elements with the half ball, the free rim and the fixed outside of the paper's, on "
    "meshes that adapt themselves to the contact. Figures 3 and 4, and Figure 5 where it is drawn as in the paper, "
    "show elements of 0.05 mm, as many as the paper's; the other figures show adapted ones. Beside them is the exact "
    "elastic solution."
)


def quick_plan() -> Plan:
    """The exact solution plays the part of the paper's finite elements: seconds."""
    exact = Exact(tolerance=1e-4)
    models = {**{name: catalogue[name] for name in _COMPARED}, "exact": exact}
    return Plan(
        name="quick",
        parts={
            "accuracy": {"": _accuracy},  # the longest piece first: the other process does the rest meanwhile
            "about": {"": partial(str, _QUICK)},
            **_ledgers(exact, CLAIMS, ELSEWHERE),
            **_parts(references={"exact": exact}, models=models, dense=models),
        },
    )


def full_plan() -> Plan:
    """With finite elements: those of the paper's density in Figures 3 to 5, adapted ones elsewhere. Minutes."""
    adapted = FiniteElement(meshes=1)
    models = {name: catalogue[name] for name in _COMPARED}
    return Plan(
        name="full",
        parts={
            "accuracy": {"": _accuracy},
            "about": {"": partial(str, _FULL)},
            **_ledgers(adapted, CLAIMS + MESHED_CLAIMS, ELSEWHERE + MESHED_ELSEWHERE),
            **_parts(
                references={"exact": models["exact"], ELEMENTS: adapted},
                models={**models, ELEMENTS: adapted},
                dense={**models, ELEMENTS: dense_elements()},
            ),
        },
    )


def _ledgers(judge: Model, claims: tuple[Claim, ...], elsewhere: tuple[Claim, ...]) -> dict[str, Mapping[str, Piece]]:
    """What the paper says and what others found."""
    return {
        part: {claim.__name__: Summary(partial(judged, claim, judge)) for claim in group}
        for part, group in (("claims", claims), ("elsewhere", elsewhere))
    }


def _parts(
    *,
    references: Mapping[str, Model],
    models: Mapping[str, Model],
    dense: Mapping[str, Model],
) -> dict[str, Mapping[str, Piece]]:
    """`references` for the moduli, `dense` in the curves that the paper draws, `models` in all others."""
    judged_as_drawn = {"hess-forsbach": dense["hess-forsbach"], list(dense)[-1]: list(dense.values())[-1]}
    joints = {f"{series} {case}": (series, case) for series, group in curves.SERIES.items() for case in group}
    ratios = {f"{poisson:g}": poisson for poisson in cases.POISSON}
    fields = {name: model for name, model in models.items() if name != "exact"}
    return {
        "table_3": {
            f"{name} {ratio}": partial(_column, name, model, ratios[ratio])
            for (name, model), ratio in product(references.items(), ratios)
        },
        "figure_2": {ratio: Summary(partial(curves.figure_2, value, references)) for ratio, value in ratios.items()},
        "figure_2_models": {
            ratio: Summary(partial(curves.figure_2_models, value, models)) for ratio, value in ratios.items()
        },
        **{
            f"figure_{number}": {
                name: Summary(partial(curves.figure_3_or_4, number, {name: model})) for name, model in dense.items()
            }
            for number in (3, 4)
        },
        "figure_5": {
            name: Summary(partial(curves.figure_5, *joint, judged_as_drawn)) for name, joint in joints.items()
        },
        "figure_5_forces": {
            name: Summary(partial(curves.figure_5_forces, *joint, models)) for name, joint in joints.items()
        },
        "figure_5_pressures": {
            name: Summary(partial(curves.figure_5_pressures, *joint, models)) for name, joint in joints.items()
        },
        "figure_6": {"": Summary(partial(curves.figure_6, "hess-forsbach", models["hess-forsbach"]))},
        "figure_6_exact": {"": Summary(partial(curves.figure_6, "exact", models["exact"], _COARSE))},
        "figure_6_pressures": {
            name: Summary(partial(curves.figure_6_pressures, name, model, models["exact"], _COARSE))
            for name, model in fields.items()
        },
        "figure_6_areas": {
            name: Summary(partial(curves.figure_6_areas, name, model, models["exact"], _COARSE))
            for name, model in fields.items()
        },
    }


_COARSE = 13
"""Head radii and thicknesses in maps that are solved joint by joint."""


@dataclass(frozen=True)
class Summary:
    """The summary of what is computed; a value, so that it can go to another process."""

    compute: Callable[[], Any]

    def __call__(self) -> Any:
        return self.compute().summary()


def _column(name: str, model: Model, poisson: float) -> dict[str, Any]:
    """A column of Table 3 with the reference that it was fitted to."""
    return {"reference": name, **refit_column(poisson, model).summary()}


def _accuracy() -> list[dict[str, Any]]:
    return [row.summary() for row in accuracies()]
