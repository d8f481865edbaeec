"""Film over steps of load and motion by Reynolds' equation: implicit Euler, in parts of a step where it is needed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy

from ..contact import Contact, Model
from ..core.arrays import Array, Numbers
from ..core.checks import check_numeric, check_vectors, require
from ..core.validity import Status
from ..problem import Joint
from .dry_contact import check_single_contact, dry_contact
from .film_problem import ContactFilm, check_reynolds, make_contact_film, shortest_inlet
from .lubricant import Lubricant
from .reynolds import FilmProblem, FilmState, advance

_TOLERANCE, _MAX_ITERATIONS = 1e-4, 25  # of a time step: largest change of its last Newton step, and most Newton steps

_ATTEMPTS: tuple[tuple[float | None, int], ...] = ((None, 1), (0.0, 1), (0.0, 4), (0.0, 16))
"""Central share of the carried film and number of parts of a time step, in the order of the attempts."""

_MAX_EDGE_TRAVEL = 1.0
"""Largest movement of the edge in a time step, in inlet lengths, that implicit Euler resolves to about 3 %."""

_DRY_CELL = numpy.radians(4.0)  # width in rad of the cells of the dry contacts, of which only axis and edge are used


@dataclass(frozen=True, kw_only=True, eq=False)
class LoadStep:
    """Load and motion of one step of time."""

    force: Numbers  # (3,), load on the ball in N
    spin: Numbers  # (3,), rotation rate of the ball in rad/s
    duration: float  # duration in s


@dataclass(frozen=True, kw_only=True, eq=False)
class TransientFilm:
    """Films at the end of each step of load and motion."""

    # pressure, vapour and position of the ball; a state that is not converged is the last one that was
    states: tuple[FilmState, ...]
    thickness: Numbers  # (steps, cells), film thickness in mm
    # (steps,), `NOT_CONVERGED` marks steps without a solution: they have the film before them, which is the best so far
    status: Numbers

    @property
    def converged(self) -> bool:
        """True if all steps converged."""
        return bool((self.status == Status.OK).all())

    @property
    def iterations(self) -> int:
        """Number of Newton steps."""
        return sum(state.iterations for state in self.states)


def solve_cycle(
    problem: FilmProblem, start: FilmState, steps: Sequence[LoadStep], cycles: int = 1, parts: int = 1
) -> TransientFilm:
    """Solve Reynolds' equation over cycles of load and motion by implicit Euler; return the films of the last cycle.

    The error in time is of first order. Where Newton's method fails, the step is repeated with the film upstream, and
    then in parts in which load and motion change bit by bit. Force and spin of the problem are replaced by those of the
    steps. Each step has `parts` time steps, in which both change linearly from the step before.
    """
    state, before = start, steps[-1]
    states: list[FilmState] = []
    for _ in range(cycles):
        states = []
        for step in steps:
            for piece in _divide(before, step, parts):
                state = _solve_step(problem, state, before, piece)
                before = piece
            states.append(state)
    status = numpy.array([Status.OK if state.converged else Status.NOT_CONVERGED for state in states])
    thickness = numpy.stack([problem.thickness(state) for state in states])
    return TransientFilm(states=tuple(states), thickness=thickness, status=status)


def _solve_step(problem: FilmProblem, start: FilmState, before: LoadStep, step: LoadStep) -> FilmState:
    """Solve one time step; return the film at its start, not converged, if all attempts fail."""
    iterations = 0
    for central_share, parts in _ATTEMPTS:
        state = start
        for piece in _divide(before, step, parts):
            current = replace(problem, force=piece.force, spin=piece.spin, central_share=central_share)
            volume = problem.thickness(state) * (1 - state.void)
            state = advance(
                current, state, volume=volume, step=piece.duration, tolerance=_TOLERANCE, max_steps=_MAX_ITERATIONS
            )
            iterations += state.iterations
            if not state.converged:
                break
        if state.converged:
            return replace(state, iterations=iterations)
    return replace(start, converged=False, iterations=iterations)


def _divide(before: LoadStep, step: LoadStep, parts: int) -> Iterator[LoadStep]:
    """Divide a step into parts, in which load and motion change linearly from those before."""
    for part in range(1, parts + 1):
        share = part / parts
        yield LoadStep(
            force=(1 - share) * before.force + share * step.force,
            spin=(1 - share) * before.spin + share * step.spin,
            duration=step.duration / parts,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmSteps:
    """Films at the end of each step of load and motion."""

    case: ContactFilm  # Reynolds' equation with its mesh
    film: TransientFilm  # states, thickness (steps, cells) in mm, and status of each step
    edge_travel: Numbers  # (steps,), movement of the edge of the dry contact in one time step, in inlet lengths

    @property
    def resolved(self) -> Numbers:
        """Mask of the steps (steps,) in whose time steps the edge moves by at most an inlet length.

        Elsewhere the film that enters has an error in time: 9 % at 5 inlet lengths, 5 % at 2. More `parts` resolve it.
        """
        return self.edge_travel <= _MAX_EDGE_TRAVEL

    @property
    def central(self) -> Numbers:
        """Film thickness in mm at the load (steps,)."""
        return self.case.central(self.film.thickness)

    @property
    def minimum(self) -> Numbers:
        """Smallest film in mm within the edge of the largest contact (steps,)."""
        return self.case.minimum(self.film.thickness)

    @property
    def pressure(self) -> Numbers:
        """Pressure in MPa (steps, cells)."""
        return numpy.stack([state.pressure for state in self.film.states])

    @property
    def status(self) -> Numbers:
        """Status of each step (steps,); a step that is not solved has the film before it."""
        return self.film.status


def film_over_steps(
    model: Model,
    joint: Joint,
    *,
    forces: Array,
    spins: Array,
    durations: Array,
    lubricant: Lubricant = Lubricant(),  # noqa: B008 (frozen)
    cycles: int = 1,
    parts: int = 1,
) -> FilmSteps:
    """Solve Reynolds' equation over steps of load and motion, by implicit Euler.

    The first film is that of the smallest load, with the ball lifted by the inlet film of the fastest motion. A cycle
    is repeated until it forgets that film.

    Parameters
    ----------
    model : Model
        Springs, `Exact`, `Tabulated`, or `Sphere` with one direction of the load.
    joint : Joint
        One joint.
    forces : array (steps,)
        Loads in N at the end of each step.
    spins : array (steps, 3)
        Rotation rates of the ball in rad/s, in the frame of the contact.
    durations : float or array (steps,)
        Durations of the steps in s.
    lubricant : Lubricant
    cycles : int
        Number of times that the steps are repeated; the result has the last one.
    parts : int
        Number of time steps in each step of load and motion, in which both change linearly from the step before. The
        edge of the contact should move by less than an inlet length in each; `resolved` states it.

    Raises
    ------
    ValueError
        A load or duration that is not positive; arrays of different lengths; a motion without any speed across the
        load; a contact that `bs.film` refuses for Reynolds' equation; an edge that moves too far for its short inlet.
    TypeError
        Texts in place of numbers.

    Examples
    --------
    >>> import ballsocket as bs
    >>> from ballsocket.lubrication.transient import film_over_steps
    >>> motion = [(5.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
    >>> hip = bs.joints["hip-36"]
    >>> film = film_over_steps(bs.Exact(), hip, forces=[1500.0, 1500.0], spins=motion, durations=0.05)
    >>> film.status.tolist()
    [0, 0]
    """
    loads = numpy.atleast_1d(_finite("forces", forces))
    require("forces", loads, loads > 0, "a film needs a load (N)")
    rates = numpy.atleast_2d(numpy.asarray(check_vectors("spins", spins, "x, y, z (rad/s)"), dtype=float))
    times = _finite("durations", durations)
    require("durations", times, times > 0, "a step (s) takes time")
    if rates.shape != (len(loads), 3) or times.shape not in ((), (1,), (len(loads),)):
        raise ValueError(
            f"spins of shape {rates.shape} and durations of shape {times.shape} are not allowed for {len(loads)} "
            "forces: give one rotation rate and one duration per force"
        )
    contacts = [_press(model, joint, force) for force in sorted({loads.min(), loads.max()})]
    dry_contacts = [dry_contact(contact, _DRY_CELL) for contact in contacts]
    for contact, dry in zip(contacts, dry_contacts, strict=True):
        check_reynolds(contact, dry)
    axis, viscosity = dry_contacts[0].axis, lubricant.viscosity_mpa
    fastest = rates[numpy.linalg.norm(numpy.cross(rates, axis), axis=1).argmax()]
    if not dry_contacts[0].speed(fastest) > 0:
        raise ValueError("the ball does not move across the load in any step: no lubricant enters")
    case = make_contact_film(contacts, dry_contacts, fastest, viscosity)
    steps = [
        LoadStep(force=force * axis, spin=spin, duration=float(duration))
        for force, spin, duration in zip(loads, rates, numpy.broadcast_to(times, loads.shape), strict=True)
    ]
    forces, numbers = numpy.unique(loads, return_inverse=True)
    angles = numpy.array([float(_press(model, joint, force).half_angle) for force in forces])[numbers]
    shifts = float(joint.socket_radius) * numpy.abs(angles - numpy.roll(angles, 1))  # of the edge in mm, at each load
    return FilmSteps(
        case=case,
        film=solve_cycle(case.problem, case.start, steps, cycles, parts),
        edge_travel=shifts / parts / shortest_inlet(dry_contacts, fastest, viscosity),
    )


def _finite(name: str, values: Array) -> Numbers:
    array = numpy.asarray(check_numeric(name, values), dtype=float)
    require(name, array, numpy.isfinite(array), "a number is finite")
    return array


def _press(model: Model, joint: Joint, force: float) -> Contact:
    return check_single_contact(model.press(joint, force=float(force)))
