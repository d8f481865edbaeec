"""Compliance of bore and ball: operators, inverse, uniform stiffness, coarse cells, edges and cache."""

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.exact.modes import ball_of, socket_of
from ballsocket.elasticity.off_axis.compliance import AxisymmetricOperator, cached_compliance, make_compliance
from ballsocket.elasticity.off_axis.grid import even_grid, graded_grid
from ballsocket.elasticity.off_axis.surfaces import elastic_edges, spring_edges

from ...joints import HIP
from .shapes import RIGID, lined

SPHERE = graded_grid(pi, radians(6.0))
BORE = even_grid(pi / 2, radians(3.6))
CUP = bs.Cup()


def random_field(grid, batch=2):
    return np.random.default_rng(5).normal(size=(batch, grid.rings, grid.meridians))


def test_operator_multiplies_each_harmonic_by_its_matrix():
    random = np.random.default_rng(2)
    matrices = random.normal(size=(BORE.max_harmonic + 1, BORE.rings, BORE.rings))
    operator = AxisymmetricOperator(matrices=matrices)
    for m in (0, 1, 7):
        rings = random.normal(size=BORE.rings)
        for function in (np.cos, np.sin)[: 2 if m else 1]:
            wave = function(m * BORE.azimuth)
            result = operator((rings[:, None] * wave)[None])[0]
            assert result == pytest.approx((matrices[m] @ rings)[:, None] * wave, abs=1e-12)
    field = random_field(BORE)
    single = operator.in_single_precision()(field)
    assert single.dtype == np.float32
    assert single == pytest.approx(operator(field), abs=1e-4 * abs(operator(field)).max())


@pytest.mark.parametrize("surface", [bs.ClosedShell(), bs.RealCup(), bs.Springs()])
@pytest.mark.parametrize("joint", [RIGID, HIP], ids=["rigid", "elastic"])
def test_stiffness_is_the_inverse_of_the_softness(surface, joint):
    compliance = make_compliance(surface, joint, CUP, BORE)
    pressure = random_field(BORE)
    assert compliance.pressure(compliance.displacement(pressure)) == pytest.approx(pressure, abs=1e-3)
    single = compliance.displacement_in_single_precision(pressure)
    assert single == pytest.approx(compliance.displacement(pressure), rel=1e-4, abs=1e-9)


def test_uniform_stiffness_of_a_sphere_is_that_of_its_first_modes():
    rigid, elastic = (make_compliance(bs.ClosedShell(), joint, CUP, SPHERE) for joint in (RIGID, HIP))
    shell, ball = float(socket_of(HIP).compliance([0])[0]), float(ball_of(HIP).compliance([0])[0])
    assert rigid.uniform_stiffness == pytest.approx(1 / shell, rel=1e-4)
    assert elastic.uniform_stiffness == pytest.approx(1 / (shell + ball), rel=1e-4)


def test_springs_have_their_modulus_with_and_without_a_ball():
    modulus, field = bs.hess_forsbach(RIGID), random_field(BORE)
    rigid = make_compliance(bs.Springs(), RIGID, CUP, BORE)
    assert rigid.uniform_stiffness == pytest.approx(modulus)
    assert rigid.displacement(field) == pytest.approx(field / modulus)
    matrices = bs.Springs().rings(RIGID, CUP, BORE)
    assert AxisymmetricOperator(matrices=matrices)(field) == pytest.approx(field / modulus)
    elastic = make_compliance(bs.Springs(), HIP, CUP, SPHERE)
    ball = float(ball_of(HIP).compliance([0])[0])
    assert elastic.uniform_stiffness == pytest.approx(1 / (1 / bs.hess_forsbach(HIP) + ball), rel=1e-4)


@pytest.mark.parametrize("surface", [bs.ClosedShell(), bs.Springs()])
def test_coarse_compliance_has_nearly_the_uniform_stiffness(surface):
    compliance = make_compliance(surface, RIGID, CUP, BORE)
    coarse = compliance.coarser_compliance
    assert coarse.grid.rings == (BORE.rings + 1) // 2
    assert coarse.uniform_stiffness == pytest.approx(compliance.uniform_stiffness, rel=0.02)
    pressure = np.ones((1, coarse.grid.rings, coarse.grid.meridians))
    fine = compliance.displacement(BORE.refine(pressure))
    assert coarse.displacement(pressure) == pytest.approx(BORE.coarsen(fine), rel=1e-6)


def test_softness_is_inverse_to_youngs_modulus():
    stiff, soft = (make_compliance(bs.RealCup(), lined(young=young, ball=None), CUP, BORE) for young in (1e4, 1e3))
    assert soft.softness.matrices == pytest.approx(10 * stiff.softness.matrices)


def test_last_eight_compliances_are_cached():
    widths = [radians(6.0 - 0.01 * i) for i in range(9)]

    def cached(width, cup=CUP):
        return cached_compliance(bs.Springs(), RIGID, cup, width)

    first = cached(widths[0])
    assert cached(widths[0], replace(CUP, inclination=0.5)) is first
    for width in widths[1:8]:
        cached(width)
    assert cached(widths[0]) is first
    cached(widths[8])
    assert cached(widths[0]) is first  # the second was the oldest
    for width in widths[1:]:
        cached(width)
    assert cached(widths[0]) is not first


def test_edge_relation_of_elastic_bodies_uses_the_combined_modulus():
    relation = elastic_edges(HIP, BORE, bounded=True)
    softness = sum((1 - body.poisson**2) / body.young for body in (HIP.liner, HIP.ball))
    width = radians(90.0) / BORE.rings * HIP.socket_radius
    assert relation.compliance == pytest.approx(np.full((BORE.rings, 1), 1.5 * width * softness))
    rigid = elastic_edges(RIGID, BORE, bounded=False)
    assert rigid.compliance == pytest.approx(1.5 * width * (1 - HIP.liner.poisson**2) / HIP.liner.young)
    assert relation.inset == rigid.inset == pytest.approx(0.113)
    assert (relation.bounded, rigid.bounded) == (True, False)
    assert bs.Springs().edges(RIGID, CUP, BORE).compliance == pytest.approx(1 / bs.hess_forsbach(RIGID))


def test_levels_are_positive_in_the_contact_and_minus_the_gap_outside():
    relation = spring_edges(50.0, BORE)
    pressure, gap = np.zeros((1, BORE.rings, BORE.meridians)), np.full((1, BORE.rings, BORE.meridians), 0.3)
    pressure[0, 0], gap[0, 1] = 10.0, -0.1
    levels = relation.levels(pressure, gap)[0]
    assert levels[0] == pytest.approx(0.2)
    assert levels[1] == pytest.approx(0.0)
    assert levels[2] == pytest.approx(-0.3)
    assert (relation.inset, relation.bounded) == (0.0, True)


@pytest.mark.parametrize(
    ("surface", "chamfer", "bounded"),
    [(bs.RealCup(), 0.0, True), (bs.RealCup(), 1.0, False), (bs.ClosedShell(), 0.0, False), (bs.Springs(), 1.0, True)],
)
def test_pressure_at_the_rim_is_bounded_on_springs_and_at_a_real_rim_without_a_chamfer(surface, chamfer, bounded):
    assert surface.edges(RIGID, bs.Cup(chamfer=chamfer), BORE).bounded is bounded
