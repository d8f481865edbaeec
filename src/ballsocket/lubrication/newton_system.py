"""Step of Newton's method for a film: balance of the lubricant in the cells, its derivatives, and the linear system."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING

import numpy
import scipy.sparse
import scipy.sparse.linalg

from ..core.arrays import Numbers
from .mesh import FilmMesh

if TYPE_CHECKING:
    from .dry_contact import ElasticSoftness


@dataclass(frozen=True, kw_only=True, eq=False)
class Balance:
    """Outflow of each cell in mm³/s, and its derivatives."""

    outflow: Numbers  # (cells,)
    # (cells, cells), its derivatives by pressure (MPa), void fraction and film thickness (mm)
    by_pressure: scipy.sparse.csr_matrix
    by_void: scipy.sparse.csr_matrix
    by_thickness: scipy.sparse.csr_matrix


def balance_cells(
    mesh: FilmMesh,
    spin: Numbers,
    viscosity: float,
    thickness: Numbers,
    pressure: Numbers,
    void: Numbers,
    rim_pressure: Numbers,
    central: Numbers | float = 1.0,
) -> Balance:
    """Compute the volume that leaves each cell: Couette and Poiseuille flow (Reynolds' equation).

    Through a face of width b, between films h of the filled fraction 1 - θ, flows Q = b (v h (1 - θ)/2 - h³ p'/(12 η)).
    Between two cells the film is taken as constant on each side and the pressure as continuous at the face, so that
    a step of the film is exact and a smooth film is of second order. `central` is the share of central differences in
    the carried film at each face; the rest is the film upstream. Units are rad/s, MPa s, mm and MPa.
    """
    velocity, rim_velocity = mesh.face_velocity(spin)
    first, second = mesh.first, mesh.second
    first_film, second_film = thickness[first], thickness[second]
    # h³/s on both sides of a face, with the distance s from the centre. In series they carry the flow g1 g2/(g1 + g2).
    first_side = first_film**3 / mesh.first_distance
    second_side = second_film**3 / mesh.second_distance
    both = first_side + second_side
    conductance = mesh.width / (12 * viscosity) * first_side * second_side / both
    # The pressure at the face follows from equal flows on both sides; the film that is carried is h1 g2 + h2 g1 over
    # g1 + g2, exact for a step of the film.
    film = (first_film * second_side + second_film * first_side) / both
    first_slope = 3 * first_side / first_film
    second_slope = 3 * second_side / second_film
    conductance_by_first = mesh.width / (12 * viscosity) * (second_side / both) ** 2 * first_slope
    conductance_by_second = mesh.width / (12 * viscosity) * (first_side / both) ** 2 * second_slope
    film_by_first = second_side / both + (second_film - first_film) * second_side / both**2 * first_slope
    film_by_second = first_side / both + (first_film - second_film) * first_side / both**2 * second_slope
    # Couette flow: the vapour comes from upstream, the film from the face or, with less central differences, upstream.
    carried = 0.5 * velocity * mesh.width
    upstream = numpy.where(velocity > 0, first, second)
    film = central * film + (1 - central) * thickness[upstream]
    film_by_first = central * film_by_first + (1 - central) * (velocity > 0)
    film_by_second = central * film_by_second + (1 - central) * (velocity <= 0)
    full = 1 - void[upstream]
    fall = pressure[first] - pressure[second]
    flow = conductance * fall + carried * film * full
    by_pressure = _face_matrix(mesh, (first, conductance), (second, -conductance))
    by_void = _face_matrix(mesh, (upstream, -carried * film))
    by_thickness = _face_matrix(
        mesh,
        (first, conductance_by_first * fall + carried * full * film_by_first),
        (second, conductance_by_second * fall + carried * full * film_by_second),
    )
    outflow = numpy.bincount(first, flow, mesh.cells) - numpy.bincount(second, flow, mesh.cells)
    # The rim: the film of the last cell, and lubricant without vapour outside.
    cell = mesh.rim_cell
    rim_film = thickness[cell]
    rim_conductance = mesh.rim_width * rim_film**3 / (12 * viscosity * mesh.rim_distance)
    rim_carried = 0.5 * rim_velocity * mesh.rim_width
    leaving = rim_velocity > 0
    rim_full = numpy.where(leaving, 1 - void[cell], 1.0)
    rim_fall = pressure[cell] - rim_pressure
    outflow += numpy.bincount(cell, rim_conductance * rim_fall + rim_carried * rim_film * rim_full, mesh.cells)
    rim_by_void = numpy.where(leaving, -rim_carried * rim_film, 0.0)
    rim_by_thickness = 3 * rim_conductance / rim_film * rim_fall + rim_carried * rim_full
    return Balance(
        outflow=outflow,
        by_pressure=by_pressure + _rim_matrix(mesh, rim_conductance),
        by_void=by_void + _rim_matrix(mesh, rim_by_void),
        by_thickness=by_thickness + _rim_matrix(mesh, rim_by_thickness),
    )


def _face_matrix(mesh: FilmMesh, *terms: tuple[Numbers, Numbers]) -> scipy.sparse.csr_matrix:
    """Add (column, flow from first to second) of each face to the rows of its two cells."""
    rows = numpy.concatenate([side for _ in terms for side in (mesh.first, mesh.second)])
    columns = numpy.concatenate([column for column, _ in terms for _ in range(2)])
    values = numpy.concatenate([part for _, flow in terms for part in (flow, -flow)])
    return scipy.sparse.csr_matrix((values, (rows, columns)), (mesh.cells, mesh.cells))


def _rim_matrix(mesh: FilmMesh, values: Numbers) -> scipy.sparse.csr_matrix:
    return scipy.sparse.csr_matrix((values, (mesh.rim_cell, mesh.rim_cell)), (mesh.cells, mesh.cells))


def add_storage(
    balance: Balance, area: Numbers, thickness: Numbers, void: Numbers, volume: Numbers, step: float
) -> Balance:
    """Add the growth of the lubricant in each cell over a time step to the outflow."""
    return Balance(
        outflow=balance.outflow + area * (thickness * (1 - void) - volume) / step,
        by_pressure=balance.by_pressure,
        by_void=balance.by_void - scipy.sparse.diags_array(area * thickness / step),
        by_thickness=balance.by_thickness + scipy.sparse.diags_array(area * (1 - void) / step),
    )


_RESIDUAL = 1e-5  # residual of GMRES relative to the right side; Newton's next step removes it
_MAX_KRYLOV, _MAX_RESTARTS = 60, 3  # number of directions of GMRES, and largest number of times that it restarts


@dataclass(frozen=True)
class CellUnknown:
    """Unknown of each cell, its pressure where the film is full and its void elsewhere.

    Change of pressure and of void are linear in the unknown: `at + by * unknown`. They solve the linear form of the
    Fischer-Burmeister function a + b - sqrt(a² + b²) = 0 of a = p/scale and b = void.
    """

    pressure_at: Numbers
    pressure_by: Numbers
    void_at: Numbers
    void_by: Numbers

    @classmethod
    def of(cls, pressure: Numbers, void: Numbers) -> CellUnknown:
        """Choose the unknowns at a state."""
        scale = max(float(pressure.max()), 1e-6)
        share = pressure / scale
        length = numpy.hypot(share, void)
        safe = numpy.where(length > 0, length, 1.0)
        at_zero = 1 - sqrt(0.5)
        by_pressure = numpy.where(length > 0, 1 - share / safe, at_zero) / scale
        by_void = numpy.where(length > 0, 1 - void / safe, at_zero)
        complement = share + void - length
        full = by_void >= by_pressure * scale
        with numpy.errstate(divide="ignore", invalid="ignore"):
            return cls(
                pressure_at=numpy.where(full, 0.0, -complement / by_pressure),
                pressure_by=numpy.where(full, 1.0, -by_void / by_pressure),
                void_at=numpy.where(full, -complement / by_void, 0.0),
                void_by=numpy.where(full, -by_pressure / by_void, 1.0),
            )


@dataclass(frozen=True, kw_only=True, eq=False)
class NewtonSystem:
    """Linear balance of a Newton step for the unknowns of the cells and the shift of the ball."""

    balance: Balance
    unknown: CellUnknown
    compliance: Numbers  # (cells,), displacement of the surface per pressure on springs in mm/MPa
    softness: ElasticSoftness | None  # further displacements, of elastic bodies
    direction: Numbers  # (cells, 3), normals of the cells; the film falls by `direction @ shift`
    weight: Numbers  # (3, cells), force of a unit pressure on each cell in mm²
    missing_force: Numbers | None  # (3,), load less the integral of the pressure in N; None holds the ball where it is

    def solve(self) -> tuple[Numbers, Numbers]:
        """Solve for the unknown of each cell and the shift of the ball in mm."""
        right_side = -self.balance.outflow - self._flow(self.unknown.pressure_at, self.unknown.void_at)
        load_error = None
        if self.missing_force is not None:
            load_error = self.missing_force - self.weight @ self.unknown.pressure_at
        factor = self._factorise()
        if self.softness is None:
            return factor.solve(right_side, load_error)
        return self._solve_elastic(factor, right_side, load_error)

    def _flow(self, pressure: Numbers, void: Numbers) -> Numbers:
        """Compute the change of the outflow by changes of pressure and void at a fixed ball."""
        film = self.compliance * pressure
        if self.softness is not None:
            film = film + self.softness(pressure)
        balance = self.balance
        return numpy.asarray(balance.by_pressure @ pressure + balance.by_thickness @ film + balance.by_void @ void)

    def _factorise(self) -> _SpringsFactor:
        """Factorise the system in which each elastic cell yields under its own pressure alone."""
        diagonal = self.compliance if self.softness is None else self.compliance + self.softness.diagonal
        balance, unknown = self.balance, self.unknown
        by_pressure = balance.by_pressure + balance.by_thickness @ scipy.sparse.diags_array(diagonal)
        matrix = by_pressure @ scipy.sparse.diags_array(unknown.pressure_by)
        matrix = matrix + balance.by_void @ scipy.sparse.diags_array(unknown.void_by)
        scale = 1 / numpy.maximum(abs(matrix).max(axis=1).toarray().ravel(), 1e-300)
        return _SpringsFactor(
            factor=scipy.sparse.linalg.splu((scipy.sparse.diags_array(scale) @ matrix).tocsc()),
            scale=scale,
            by_shift=-balance.by_thickness @ self.direction,
            load=self.weight * unknown.pressure_by,
        )

    def _solve_elastic(
        self, factor: _SpringsFactor, right_side: Numbers, load_error: Numbers | None
    ) -> tuple[Numbers, Numbers]:
        """Solve with the elastic operator by GMRES; the factor of the springs is the preconditioner."""
        cells, unknown = len(right_side), self.unknown
        free = load_error is not None
        scale = numpy.append(factor.scale, numpy.full(3 if free else 0, 1 / self.weight.max() / cells))

        def precondition(values: Numbers) -> tuple[Numbers, Numbers]:
            return factor.solve(values[:cells] / factor.scale, values[cells:] / scale[cells:] if free else None)

        def apply(values: Numbers) -> Numbers:
            change, shift = precondition(values)
            flow = self._flow(unknown.pressure_by * change, unknown.void_by * change) + factor.by_shift @ shift
            return scale * (numpy.append(flow, factor.load @ change) if free else flow)

        target = scale * (right_side if load_error is None else numpy.append(right_side, load_error))
        operator = scipy.sparse.linalg.LinearOperator((len(target), len(target)), matvec=apply, dtype=float)
        values, _ = scipy.sparse.linalg.gmres(
            operator, target, rtol=_RESIDUAL, restart=_MAX_KRYLOV, maxiter=_MAX_RESTARTS
        )
        return precondition(values)


@dataclass(frozen=True, kw_only=True, eq=False)
class _SpringsFactor:
    """Sparse factor of the balance of the cells, bordered by the three displacements of the ball."""

    factor: scipy.sparse.linalg.SuperLU
    scale: Numbers  # (cells,), factors of the rows before the factorisation
    by_shift: Numbers  # (cells, 3), derivative of the outflow by the shift of the ball
    load: Numbers  # (3, cells), derivative of the force on the ball by the unknowns

    @cached_property
    def _response(self) -> Numbers:
        """Change of the unknowns (cells, 3) by shifts of the ball."""
        return -self._solve_cells(self.by_shift)

    def _solve_cells(self, right_side: Numbers) -> Numbers:
        """Solve for the unknowns at a fixed ball."""
        return numpy.asarray(self.factor.solve((self.scale * right_side.T).T))

    def solve(self, right_side: Numbers, load_error: Numbers | None) -> tuple[Numbers, Numbers]:
        """Solve for unknowns and shift; without a load the ball stays where it is."""
        unknown = self._solve_cells(right_side)
        if load_error is None:
            return unknown, numpy.zeros(3)
        shift = numpy.linalg.solve(self.load @ self._response, load_error - self.load @ unknown)
        return unknown + self._response @ shift, shift
