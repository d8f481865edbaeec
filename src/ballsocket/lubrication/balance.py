"""Balance of the lubricant in the cells of a film: Couette and Poiseuille flow, storage, and their derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy
import scipy.sparse

from ..core.arrays import Numbers
from .mesh import FilmMesh


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
