"""Grids of rings and meridians: areas, normals, integrals, and transfer between fine and coarse cells."""

from math import pi, radians

import numpy as np
import pytest

from ballsocket.elasticity.off_axis.compliance import AxisymmetricOperator
from ballsocket.elasticity.off_axis.directions import unit_vectors
from ballsocket.elasticity.off_axis.grid import Grid, even_grid, graded_grid, rim_grid

FINE = Grid(edges=np.linspace(0.0, 1.3, 27), meridians=44)
ODD = Grid(edges=np.linspace(0.0, 1.3, 28), meridians=44)


@pytest.mark.parametrize("reach", [radians(60.0), radians(140.0), pi])
def test_cell_areas_and_normals_integrate_to_the_bore(reach):
    cells = graded_grid(reach, radians(3.0))
    assert cells.areas.sum() * cells.meridians == pytest.approx(2 * pi * (1 - np.cos(reach)))
    assert cells.ring_areas.sum() == pytest.approx(2 * pi * (1 - np.cos(reach)))
    assert (cells.normals * cells.areas).sum(axis=(1, 2)) == pytest.approx([0, 0, pi * np.sin(reach) ** 2], abs=1e-12)


def test_normals_are_means_over_their_cells():
    cells = Grid(edges=np.array([0.0, 0.3, 0.5, 1.1]), meridians=8)
    points, weights = np.polynomial.legendre.leggauss(12)
    for ring in range(3):
        low, high = cells.edges[ring : ring + 2]
        polar = (low + high) / 2 + (high - low) / 2 * points
        azimuth = cells.azimuth[2] + pi / 8 * points
        n = unit_vectors(polar[:, None], azimuth[None])
        measure = (weights * np.sin(polar))[:, None] * weights
        mean = (n * measure).sum(axis=(1, 2)) / measure.sum()
        assert cells.normals[:, ring, 2] == pytest.approx(mean, abs=1e-12)
        assert cells.centroids[:, ring, 2] == pytest.approx(mean / np.linalg.norm(mean), abs=1e-12)
        assert cells.middles[:, ring, 2] == pytest.approx(unit_vectors((low + high) / 2, cells.azimuth[2]))


def test_properties_of_a_small_grid():
    cells = Grid(edges=np.array([0.0, 0.2, 0.6]), meridians=6)
    assert (cells.rings, cells.max_harmonic, cells.reach) == (2, 3, 0.6)
    assert cells.width == pytest.approx(0.4)
    assert cells.polar == pytest.approx([0.1, 0.4])
    assert cells.azimuth == pytest.approx(np.arange(1, 12, 2) * pi / 6)
    assert cells.coarser_grid is None
    with pytest.raises(ValueError, match="read-only"):
        cells.centroids[0, 0, 0] = 1.0


@pytest.mark.parametrize(
    ("make", "fractions"),
    [(graded_grid, [0.5, 0.25, 0.25]), (rim_grid, [0.5, 0.25, 0.125, 0.0625, 0.0625]), (even_grid, [1.0])],
)
def test_last_ring_is_graded_towards_the_rim(make, fractions):
    reach, width = 1.5, 0.1
    cells = make(reach, width)
    ends = cells.edges[-len(fractions) - 1 :]
    assert cells.edges[: -len(fractions)] == pytest.approx(np.arange(15) * 0.1)
    assert np.diff(ends) == pytest.approx(0.1 * np.array(fractions))
    assert cells.reach == reach
    assert cells.meridians == 2 * round(pi / width)


def test_grids_have_a_smallest_number_of_rings_and_meridians():
    assert even_grid(0.3, 2.0).rings == 4
    assert graded_grid(0.3, 2.0).rings == 1 + 3
    assert even_grid(0.3, 2.0).meridians == 8
    assert even_grid(1.0, 1.0 / 6).rings == 6  # rounding adds no ring
    assert even_grid(1.01, 1.0 / 6).rings == 7


@pytest.mark.parametrize("cells", [FINE, ODD], ids=["even", "odd"])
def test_coarsening_preserves_integrals_and_inverts_refinement(cells):
    coarse = cells.coarser_grid
    assert coarse.rings == (cells.rings + 1) // 2
    assert coarse.meridians == cells.meridians // 2
    assert coarse.reach == cells.reach
    random = np.random.default_rng(1)
    fine_field = random.normal(size=(2, cells.rings, cells.meridians))
    coarse_field = random.normal(size=(2, coarse.rings, coarse.meridians))
    assert cells.coarsen(cells.refine(coarse_field)) == pytest.approx(coarse_field)
    unit, coarse_unit = np.ones(cells.refine(coarse_field).shape), np.ones(coarse_field.shape)
    integral = cells.integrate_product(fine_field, unit)
    assert coarse.integrate_product(cells.coarsen(fine_field), coarse_unit) == pytest.approx(integral)


@pytest.mark.parametrize("cells", [FINE, ODD], ids=["even", "odd"])
def test_coarse_matrices_are_means_of_the_fine_operator(cells):
    """For low harmonics: refine the pressures, apply the fine operator, and average the displacements."""
    coarse, random = cells.coarser_grid, np.random.default_rng(4)
    matrices = random.normal(size=(cells.max_harmonic + 1, cells.rings, cells.rings))
    low = cells.meridians // 4
    matrices[low:] = 0.0
    coarse_matrices = cells.coarsen_matrices(matrices)
    assert coarse_matrices.shape == (coarse.max_harmonic + 1, coarse.rings, coarse.rings)
    for m in (0, 1, 3, low - 1):
        field = random.normal(size=(1, coarse.rings, 1)) * np.cos(m * coarse.azimuth)
        expected = cells.coarsen(AxisymmetricOperator(matrices=matrices)(cells.refine(field)))
        assert AxisymmetricOperator(matrices=coarse_matrices)(field) == pytest.approx(expected, abs=1e-9)


def test_few_rings_or_unpaired_meridians_are_not_coarsened():
    assert Grid(edges=np.linspace(0.0, 1.3, 24), meridians=44).coarser_grid is None
    assert Grid(edges=np.linspace(0.0, 1.3, 25), meridians=44).coarser_grid is not None
    assert Grid(edges=FINE.edges, meridians=34).coarser_grid is None
    assert Grid(edges=FINE.edges, meridians=36).coarser_grid is not None


def test_integral_of_a_product_is_exact_for_uniform_fields():
    field = np.full((3, FINE.rings, FINE.meridians), 2.0)
    assert FINE.integrate_product(field, 3 * field) == pytest.approx(12.0 * 2 * pi * (1 - np.cos(1.3)))


def test_cell_averages_attenuate_each_harmonic():
    """The mean of cos mφ over a cell is sinc(m / meridians) of its middle; it acts on pressure and displacement."""
    cells = even_grid(1.5, 0.15)
    matrices = np.repeat(np.diag(cells.ring_areas)[None], cells.max_harmonic + 1, axis=0)
    averaged = cells.average_over_cells(matrices.copy())
    resolved = np.sinc(np.arange(3) / cells.meridians) ** 2
    assert np.einsum("mii->mi", averaged[:3]) == pytest.approx(np.repeat(resolved[:, None], cells.rings, axis=1))
    shortest = np.ceil(pi * np.sin(cells.polar) / cells.width).clip(2, cells.max_harmonic).astype(int)
    diagonal = np.einsum("mii->mi", averaged)
    for ring, m in enumerate(shortest):
        expected = np.sinc(np.minimum(np.arange(cells.max_harmonic + 1), m) / cells.meridians) ** 2
        assert diagonal[:, ring] == pytest.approx(expected)
    assert not averaged[:, ~np.eye(cells.rings, dtype=bool)].any()
