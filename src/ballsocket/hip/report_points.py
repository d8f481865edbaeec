"""Run of a wear simulation to its report points, with checkpoints on disk: a stop loses at most one block of cycles."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.storage.atomic_files import read_arrays, write_arrays
from ..core.storage.pieces import hash_inputs
from .ball_wear import map_counterface
from .hip_setup import HipSetup
from .history import Report
from .socket_foundation import CycleEquilibrium
from .wear_integrator import WearIntegrator

_MAX_WORN_LINERS = 10.0
"""Largest wear by the rate of the first cycle, in liner thicknesses."""

_VERSION = 6
"""Version of the file's format."""

_FILE_NAME = "hip_in_use.npz"

_REPORT_FIELDS = fields(Report)

_CONVERTERS = {"float": float, "bool": bool}
"""Converters of a stored array to a field of a report, by the field's type; other fields are arrays."""


@dataclass(frozen=True, kw_only=True)
class Checkpoint:
    """File on disk that stores the state and the reports of one wear simulation.

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
        """Path of the checkpoint file."""
        return self.folder / _FILE_NAME

    def write(self, state: Mapping[str, Any], reports: tuple[Report, ...]) -> None:
        """Write the state of a simulation and its reports so far to the file.

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
        """Read the stored state and reports; return None if the file does not exist.

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
    """Build a report from stored arrays, whose names begin with a prefix."""
    values: dict[str, Any] = {}
    for field in _REPORT_FIELDS:
        convert_value: Any = _CONVERTERS.get(str(field.type), numpy.asarray)
        values[field.name] = convert_value(arrays[prefix + field.name])
    return Report(**values)


def make_checkpoint(use: HipSetup, folder: Path) -> Checkpoint:
    """Create the `Checkpoint` of a wear simulation in a folder; its file is not yet written.

    Raises
    ------
    ValueError
        A wear law by a function, which has no fingerprint.
    """
    for law in (use.wear, use.ball_wear):
        if not getattr(law, "storable", True):
            raise ValueError(f"runs with a {type(law).__name__} cannot be stored: its function has no fingerprint")
    frame = use.frame
    arrays = (frame.loads, frame.lateral_stiffness, frame.rotation_increments, frame.loaded)
    loads = sha256(b"".join(array.tobytes() for array in arrays)).hexdigest()
    inputs = (
        use.joint,
        frame.placed,
        use.wear,
        use.ball_wear,
        use.surface,
        use.ring_width,
        use.tolerance,
        use.creep,
        use.seconds,
    )
    return Checkpoint(folder=folder, identity=hash_inputs(_VERSION, loads, inputs))


def check_total_wear(setup: HipSetup, cycles: float) -> None:
    """Check that the cycles wear at most ten liner thicknesses at the initial rate; ValueError otherwise.

    Raises
    ------
    ValueError
        The extrapolated wear of the first cycle exceeds ten liner thicknesses.
    """
    exposure = setup.exposure(setup.unworn)
    thickness = float(min(setup.joint.liner_thickness, setup.joint.socket_radius))
    laws = (law for law in (setup.wear, setup.ball_wear) if law is not None)
    estimated_depth = cycles * max(float(law.depth(exposure).max(initial=0.0)) for law in laws)
    if not estimated_depth <= _MAX_WORN_LINERS * thickness:
        raise ValueError(
            f"{cycles:g} cycles at the rate of the first one would wear {estimated_depth:.3g} mm away, more than "
            f"{_MAX_WORN_LINERS:g} times the {thickness:g} mm of the liner: reduce the wear coefficient or the cycles"
        )


def run_to_report_points(
    integrator: WearIntegrator, counts: Sequence[float], progress: Callable[[float], None], stored: Checkpoint | None
) -> tuple[Report, ...]:
    """Run a wear simulation to the requested cycle counts, resuming from a checkpoint."""
    reports: tuple[Report, ...] = ()
    checkpointed = stored.read() if stored else None
    if checkpointed is not None:
        state, reports = checkpointed
        integrator.resume(state)
        reports = tuple(report for report in reports if report.cycles in counts)
    reported = {report.cycles for report in reports}
    for report_count in counts:
        if report_count in reported:
            continue
        if report_count < integrator.cycles:
            raise ValueError(
                f"the store has reached {integrator.cycles:g} cycles without a report at {report_count:g}; "
                "give another folder"
            )

        def store_block(cycles: float) -> None:
            """Store the state after a block of cycles, and report the progress."""
            if stored is not None and cycles < report_count:  # noqa: B023 (called before the next)
                stored.write(integrator.state, reports)  # noqa: B023
            progress(cycles)

        reports = (*reports, make_report(integrator.run_until(report_count, store_block)))
        if stored is not None:
            stored.write(integrator.state, reports)
    return reports


def make_report(integrator: WearIntegrator) -> Report:
    """Create a report of the present state of a wear simulation."""
    setup, creep_depth, grid_shape = integrator.setup, integrator.creep_depth, (integrator.setup.grid.rings, -1)
    depth = integrator.depth + creep_depth
    if setup.ball_wear is not None:
        counterface = map_counterface(setup, numpy.arange(len(depth)))
        depth = depth + counterface.on_socket.interpolate(integrator.ball[None])
    contacts = setup.solve_equilibrium(depth, integrator.equilibrium)
    contacts_by_wear = contacts if setup.creep is None else _solve_contacts(setup, integrator.depth)
    equilibria = (contacts, contacts_by_wear, _solve_contacts(setup, creep_depth))
    largest_load, unworn_displacement = setup.frame.largest_load_index, setup.unworn.displacement
    displacements = [(state.displacement - unworn_displacement)[largest_load].sum(axis=0) for state in equilibria]
    edge = setup.edge(contacts, depth)
    return Report(
        cycles=integrator.cycles,
        wear=integrator.depth.reshape(grid_shape),
        volume=integrator.volume,
        depth=float(integrator.depth.max()),
        work=integrator.work,
        displacement=displacements[0],
        wear_displacement=displacements[1],
        creep_displacement=displacements[2],
        max_pressure=float(contacts.pressure.max(initial=0.0)),
        edge_distance=edge.distance,
        edge_place=edge.azimuth,
        edge_pressure=edge.pressure,
        crept=creep_depth.reshape(grid_shape),
        creep_depth=float(creep_depth.max()),
        ball_wear=integrator.ball,
        ball_volume=integrator.ball_volume,
        ball_depth=float(integrator.ball.max(initial=0.0)),
        worst_contacts=setup.worst_contacts(contacts, depth),
        converged=integrator.converged and all(state.converged for state in equilibria),
    )


def _solve_contacts(setup: HipSetup, depth: Numbers) -> CycleEquilibrium:
    """Solve the contacts on a worn bore; for zero depth, return those of the unworn bore."""
    return setup.solve_equilibrium(depth) if depth.any() else setup.unworn
