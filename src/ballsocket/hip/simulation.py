"""Wear simulation of a hip joint, run to the requested cycle counts, with checkpoints from which it resumes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from hashlib import sha256
from math import inf
from pathlib import Path
from typing import Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import require
from ..core.display import counted, plain_number
from ..core.storage.atomic_files import make_folder, read_arrays, write_arrays
from ..core.storage.pieces import hash_inputs
from ..lubrication import Lubricant
from .ball_wear import map_counterface
from .hip_setup import MIN_RING_WIDTH, HipSetup
from .history import History, NumericalError, Report
from .rim import mask_edge_loading
from .socket_foundation import CycleEquilibrium
from .wear_integrator import WearIntegrator

MAX_WORN_LINERS = 10.0  # largest wear by the rate of the first cycle, in liner thicknesses

_VERSION = 7  # version of the file's format
_FILE_NAME = "hip_in_use.npz"
_REPORT_FIELDS = fields(Report)
_CONVERTERS: Mapping[str, Any] = {"float": float, "bool": bool}  # by the type of a report's field; others are arrays

_ERROR_RATIO = 1 / (1 - 2**-1.5)
"""Ratio of the error to the difference from half the step: 1 / (1 - 2^-p) for errors of order p = 1.5.

The order is 2 for a moving load. With wear by contact area and a stationary load it can be 1.6: halved rings divide
the error by 3.
"""


@dataclass(frozen=True, kw_only=True)
class Checkpoint:
    """File on disk that stores the state and the reports of one wear simulation."""

    folder: Path  # folder of the file
    identity: str  # digest of the joint, the cycle, the wear laws and the discretization

    @property
    def path(self) -> Path:
        return self.folder / _FILE_NAME

    def write(self, state: Mapping[str, Any], reports: tuple[Report, ...]) -> None:
        """Write the state of a simulation and its reports so far to the file."""
        make_folder(self.folder)
        report_arrays = {
            f"report_{number}_{field.name}": getattr(report, field.name)
            for number, report in enumerate(reports)
            for field in _REPORT_FIELDS
        }
        write_arrays(self.path, identity=self.identity, count=len(reports), **state, **report_arrays)

    def read(self) -> tuple[dict[str, Numbers], tuple[Report, ...]] | None:
        """Read the stored state and reports; return None if the file does not exist."""
        if not self.path.exists():
            return None
        try:
            arrays = read_arrays(self.path)
            identity, n_reports = str(arrays.pop("identity")), int(arrays.pop("count"))
            if identity == self.identity:
                reports = tuple(
                    Report(
                        **{
                            field.name: _CONVERTERS.get(str(field.type), numpy.asarray)(
                                arrays[f"report_{n}_{field.name}"]
                            )
                            for field in _REPORT_FIELDS
                        }
                    )
                    for n in range(n_reports)
                )
        except (OSError, ValueError, KeyError) as error:
            raise ValueError(f"{self.path} is not a checkpoint of a run; delete it to start again") from error
        if identity != self.identity:
            raise ValueError(
                f"{self.folder} has the checkpoint of another run: another hip, cycle, law or version; "
                "choose another folder"
            )
        return {name: array for name, array in arrays.items() if not name.startswith("report_")}, reports


def make_checkpoint(use: HipSetup, folder: Path) -> Checkpoint:
    """Create the `Checkpoint` of a wear simulation in a folder; its file is not yet written."""
    for law in (use.wear, use.ball_wear):
        if not getattr(law, "storable", True):
            raise ValueError(f"runs with a {type(law).__name__} cannot be stored: its function has no fingerprint")
    frame = use.frame
    arrays = (frame.loads, frame.lateral_stiffness, frame.rotation_increments, frame.loaded)
    loads = sha256(b"".join(array.tobytes() for array in arrays)).hexdigest()
    laws = (use.joint, frame.placed, use.wear, use.ball_wear, use.surface, use.ring_width, use.tolerance, use.creep)
    limit = () if use.film_limit is None else (use.film_limit,)
    return Checkpoint(folder=folder, identity=hash_inputs(_VERSION, loads, (*laws, use.seconds, *limit)))


def check_total_wear(setup: HipSetup, cycles: float) -> None:
    """Check that the cycles wear at most ten liner thicknesses at the initial rate; ValueError otherwise."""
    exposure = setup.wearing_exposure(setup.exposure(setup.unworn))
    thickness = float(min(setup.joint.liner_thickness, setup.joint.socket_radius))
    laws = (law for law in (setup.wear, setup.ball_wear) if law is not None)
    estimated_depth = cycles * max(float(law.depth(exposure).max(initial=0.0)) for law in laws)
    if not estimated_depth <= MAX_WORN_LINERS * thickness:
        raise ValueError(
            f"{counted(cycles, 'cycle')} at the rate of the first one would wear {estimated_depth:.3g} mm away, "
            f"more than {MAX_WORN_LINERS:g} times the {thickness:g} mm of the liner: "
            "reduce the wear coefficient or the cycles"
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
                f"the store has reached {counted(integrator.cycles, 'cycle')} without a report at "
                f"{plain_number(report_count)}; give another folder"
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

    def solve(part: Numbers) -> CycleEquilibrium:
        return setup.solve_equilibrium(part) if part.any() else setup.unworn

    equilibria = contacts, contacts if setup.creep is None else solve(integrator.depth), solve(creep_depth)
    largest_load, unworn_displacement = setup.frame.largest_load_index, setup.unworn.displacement
    displacements = [(state.displacement - unworn_displacement)[largest_load].sum(axis=0) for state in equilibria]
    edge, unworn_edge = setup.edge(contacts, depth), setup.edge(setup.unworn)
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
        edge_loaded=mask_edge_loading(edge, unworn_edge, float(contacts.pressure.max(initial=0.0))),
        crept=creep_depth.reshape(grid_shape),
        creep_depth=float(creep_depth.max()),
        ball_wear=integrator.ball,
        ball_volume=integrator.ball_volume,
        ball_depth=float(integrator.ball.max(initial=0.0)),
        worst_contacts=setup.worst_contacts(contacts, depth),
        converged=integrator.converged and all(state.converged for state in equilibria),
    )


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class HipSimulation(HipSetup):
    """Wear simulation of a hip joint.

    Parameters
    ----------
    joint : Joint
        Joint of single numbers.
    cycle : Cycle or Mix
        Loads and rotations in the body's frame, as the cup's orientation is. On a left cup it is mirrored.
    wear : WearLaw
        `Archard`, `ContactAreaWear`, `CrossShear`, `FrictionEnergyWear` or `CustomWearLaw`.
    cup : Cup
        Arc of cover and orientation. A cup without a given orientation takes the tilt of the cycle's standard.
    surface : Springs, ClosedShell or RealCup
        Foundation of the socket; the paper's springs by default.
    ring_width : float
        Width of the rings of the wear map in rad, 3° by default.
    ball_wear : WearLaw, optional
        Wear law of the ball, for hard surfaces that both wear; no wear of the ball by default.
    creep : CreepLaw, optional
        Creep law of the liner; no creep by default.
    seconds_per_cycle : float, optional
        Time in s that a cycle stands for in the creep of the liner; the duration of the cycle by default.
    tolerance : float
        Allowed error of a block of cycles, relative to the largest depth so far. Default 4e-3.
    film_limit : FilmLimit, optional
        Film ratio λ below which the surfaces wear, with the lubricant of that film; wear at any film by default.
    remarks : tuple of str
        Sentences on the input, the first notes of all results; none by default.

    Raises
    ------
    ValueError
        A load that pushes the ball over the rim, with its instant; a number that is not allowed.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.hip import Archard, HipSimulation, iso_14242_1
    >>> joint = bs.Joint(ball_radius=14.0, clearance=0.1, liner_thickness=8.0, liner=bs.UHMWPE)
    >>> simulation = HipSimulation(joint=joint, cycle=iso_14242_1(), wear=Archard(coefficient=1e-6))
    >>> round(simulation.first.volume, 1)
    30.1
    """

    def after(
        self,
        cycles: float | Sequence[float],
        report_at: Sequence[float] = (),
        progress: Callable[[float], None] = lambda cycles: None,
        lubricant: Lubricant | None = None,
        store: Path | None = None,
    ) -> History:
        """Simulate wear and creep up to a number of cycles.

        Parameters
        ----------
        cycles : float or sequence of float
            The largest of several is the end of the run, and the others are reported.
        report_at : sequence of float
            Cycle counts of the reports; the last report is always at `cycles`.
        progress : function
            Called with the number of cycles so far after each block.
        lubricant : Lubricant, optional
            Lubricant of the film in the summary; no film by default.
        store : Path, optional
            Folder that stores the run after each block: a stopped run resumes from there.

        Raises
        ------
        ValueError
            Numbers of cycles that are not allowed or would wear the liner through many times; a store with another
            run.
        """
        if isinstance(cycles, Sequence):
            report_at, cycles = (*report_at, *cycles), max(cycles, default=0)
        counts = check_cycles(cycles, report_at)
        check_total_wear(self, cycles)
        stored, (volume, depth) = None if store is None else make_checkpoint(self, store), self.discretization_error
        integrator = WearIntegrator(setup=self)
        reports = run_to_report_points(integrator, counts, progress, stored)
        worn = integrator.volume + integrator.ball_volume
        blocks = integrator.volume_error / worn if worn > 0 else 0.0
        error = NumericalError(blocks=blocks, volume=blocks + volume, depth=blocks + depth)
        return History(use=self, reports=reports, error=error, steps=integrator.steps, lubricant=lubricant)

    @cached_property
    def discretization_error(self) -> tuple[float, float]:
        """Estimated relative errors of volume and depth by time steps and rings, in the first cycle.

        The absolute differences are added and multiplied by 1.55, which holds for errors of order 1.5 or more.
        Rings are not narrower than 0.5°.
        """
        finer_steps = replace(self, cycle=self.cycle.finer())
        finer_rings = replace(finer_steps, ring_width=max(self.ring_width / 2, MIN_RING_WIDTH))

        def relative_error(name: str) -> float:
            """Estimate the relative error of a result from halved steps and rings."""
            coarse, fine, finest = (getattr(use.first, name) for use in (self, finer_steps, finer_rings))
            return _ERROR_RATIO * (abs(coarse - fine) + abs(fine - finest)) / abs(finest) if finest else 0.0

        return relative_error("volume"), relative_error("depth")


def check_cycles(cycles: float, report_at: Sequence[float]) -> list[float]:
    """Check the cycle counts of a run, and return those of its reports in ascending order, the last one at its end."""
    require("cycles", cycles, 0 < cycles < inf, "a number of cycles is positive and finite")
    rule = f"it lies between 0 and the {counted(cycles, 'cycle')} of the run"
    for count in report_at:
        require("report_at", count, 0 <= count <= cycles, rule)
    return sorted({float(count) for count in (*report_at, cycles)})
