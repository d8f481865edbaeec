"""A run on disk: after each block as far as it is, so that a process that is killed loses no more than one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.storage.npz import read_arrays, write_arrays
from .hip_setup import HipSetup
from .history import Report

_VERSION = 6
_NAME = "hip_in_use.npz"


@dataclass(frozen=True, kw_only=True)
class Checkpoint:
    """The folder in which one run is kept.

    Attributes
    ----------
    folder : Path
    identity : str
        Of the hip, its cycle, its law, and how they are cut up.
    """

    folder: Path
    identity: str

    @property
    def path(self) -> Path:
        return self.folder / _NAME

    def write(self, state: Mapping[str, Any], reports: tuple[Report, ...]) -> None:
        """Keep the state of a run and what was seen so far."""
        self.folder.mkdir(parents=True, exist_ok=True)
        seen = {f"report_{i}_{each.name}": getattr(one, each.name) for i, one in enumerate(reports) for each in _FIELDS}
        write_arrays(self.path, identity=self.identity, count=len(reports), **state, **seen)

    def read(self) -> tuple[dict[str, Numbers], tuple[Report, ...]] | None:
        """What was kept, or None where nothing is.

        Raises
        ------
        ValueError
            Another run is kept there, or a file that is none.
        """
        if not self.path.exists():
            return None
        try:
            found = read_arrays(self.path)
            identity, count = str(found.pop("identity")), int(found.pop("count"))
            if identity == self.identity:
                reports = tuple(_report(found, f"report_{i}_") for i in range(count))
        except (OSError, ValueError, KeyError) as error:
            raise ValueError(f"{self.path} is not a run that was kept; remove it to begin anew") from error
        if identity != self.identity:
            raise ValueError(f"{self.folder} keeps another run: another hip, cycle or law; give another folder")
        return {name: each for name, each in found.items() if not name.startswith("report_")}, reports


_FIELDS = fields(Report)
_NUMBERS = {"float": float, "bool": bool}


def _report(found: Mapping[str, Numbers], prefix: str) -> Report:
    values: dict[str, Any] = {}
    for each in _FIELDS:
        as_it_was: Any = _NUMBERS.get(str(each.type), numpy.asarray)
        values[each.name] = as_it_was(found[prefix + each.name])
    return Report(**values)


def checkpoint(use: HipSetup, folder: Path) -> Checkpoint:
    """Where the run of a hip is kept.

    Raises
    ------
    ValueError
        A wear law by a function, which cannot be identified.
    """
    for law in (use.wear, use.ball_wear):
        if not getattr(law, "storable", True):
            raise ValueError(f"runs with a {type(law).__name__} cannot be stored: its function cannot be identified")
    cycle = sha256(
        b"".join(each.tobytes() for each in (use.loads, use.lateral_stiffness, use.rotation_increments, use.loaded))
    ).hexdigest()
    parts = (
        use.joint,
        use.placed,
        use.wear,
        use.ball_wear,
        use.surface,
        use.ring_width,
        use.tolerance,
        use.creep,
        use.seconds,
    )
    return Checkpoint(folder=folder, identity=sha256(f"{_VERSION} {cycle} {parts!r}".encode()).hexdigest())
