"""Checkpoints of a wear simulation on disk: a killed process loses at most one block of cycles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.storage.array_files import read_arrays, write_arrays
from ..core.storage.fingerprint import hash_inputs
from .hip_setup import HipSetup
from .history import Report

_VERSION = 6
"""Version of the file's format."""

_FILE_NAME = "hip_in_use.npz"

_REPORT_FIELDS = fields(Report)

_CONVERTERS = {"float": float, "bool": bool}
"""Converters of a stored array to a field of a report, by the field's type; other fields are arrays."""


@dataclass(frozen=True, kw_only=True)
class Checkpoint:
    """File with the state and the reports of one run.

    Attributes
    ----------
    folder : Path
        Folder of the file.
    identity : str
        Digest of the joint, the cycle, the wear laws and the discretization.
    """

    folder: Path
    identity: str

    @property
    def path(self) -> Path:
        """Path of the file."""
        return self.folder / _FILE_NAME

    def write(self, state: Mapping[str, Any], reports: tuple[Report, ...]) -> None:
        """Store the state of a run and its reports so far.

        Raises
        ------
        OSError
            The folder is not writable or the disk is full.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        report_arrays = {
            f"report_{number}_{field.name}": getattr(report, field.name)
            for number, report in enumerate(reports)
            for field in _REPORT_FIELDS
        }
        write_arrays(self.path, identity=self.identity, count=len(reports), **state, **report_arrays)

    def read(self) -> tuple[dict[str, Numbers], tuple[Report, ...]] | None:
        """Read the stored state and reports; return None if nothing is stored.

        Raises
        ------
        ValueError
            The file belongs to another run, or is damaged.
        """
        if not self.path.exists():
            return None
        try:
            arrays = read_arrays(self.path)
            identity, n_reports = str(arrays.pop("identity")), int(arrays.pop("count"))
            if identity == self.identity:
                reports = tuple(_read_report(arrays, f"report_{number}_") for number in range(n_reports))
        except (OSError, ValueError, KeyError) as error:
            raise ValueError(f"{self.path} is not a checkpoint of a run; delete it to start again") from error
        if identity != self.identity:
            raise ValueError(
                f"{self.folder} has the checkpoint of another run: another hip, cycle, law or version; "
                "choose another folder"
            )
        return {name: array for name, array in arrays.items() if not name.startswith("report_")}, reports


def _read_report(arrays: Mapping[str, Numbers], prefix: str) -> Report:
    """Build a report from the arrays whose names begin with a prefix."""
    values: dict[str, Any] = {}
    for field in _REPORT_FIELDS:
        convert: Any = _CONVERTERS.get(str(field.type), numpy.asarray)
        values[field.name] = convert(arrays[prefix + field.name])
    return Report(**values)


def checkpoint(use: HipSetup, folder: Path) -> Checkpoint:
    """Make the checkpoint of a wear simulation, stored in a folder.

    Raises
    ------
    ValueError
        A wear law by a function, which has no fingerprint.
    """
    for law in (use.wear, use.ball_wear):
        if not getattr(law, "storable", True):
            raise ValueError(f"runs with a {type(law).__name__} cannot be stored: its function has no fingerprint")
    loads = sha256(
        b"".join(array.tobytes() for array in (use.loads, use.lateral_stiffness, use.rotation_increments, use.loaded))
    ).hexdigest()
    inputs = (
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
    return Checkpoint(folder=folder, identity=hash_inputs(_VERSION, loads, inputs))
