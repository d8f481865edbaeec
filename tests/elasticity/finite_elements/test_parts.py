"""Parts of the finite element model: meshes, harmonics, full contacts, error estimates and elements."""

from dataclasses import replace
from itertools import product
from math import inf, pi, radians
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import bisect

import ballsocket as bs
from ballsocket.elasticity.exact.model import curve_of
from ballsocket.elasticity.exact.modes import Shell, Socket
from ballsocket.elasticity.finite_elements import load_search, solver
from ballsocket.elasticity.finite_elements.bodies import ball_body, socket_body
from ballsocket.elasticity.finite_elements.harmonics import Harmonics, socket_harmonics
from ballsocket.elasticity.finite_elements.load_search import ContactBracket
from ballsocket.elasticity.finite_elements.mesh import Resolution, SocketShape, socket_shape
from ballsocket.elasticity.finite_elements.pair_contact import FullContact, partial_contact
from ballsocket.elasticity.finite_elements.solver import load_curve_of
from ballsocket.evidence.code_checks import polar_components, shell_block, strain_energy_error, thick_sphere_error
from ballsocket.problem import Support
from ballsocket.problem.cup import Interface
from ballsocket.problem.gaps import LinearGap

from ...extent import some
from ...joints import HIP

RIGID = replace(HIP, ball=None)
COARSE = bs.Adapted(elements=24)
THIN = (bs.Layer(thickness=1.0, material=bs.TITANIUM),)
GAP = LinearGap(clearance=0.1, socket_radius=18.0)
LINER, SHELL = ((1.3, 1.0, 0.4),), ((1.2, 1.0, 0.3), (1.35, 8.0, 0.25))  # outer radius, E and ν of each layer


def coarse_curve(joint, arc):
    cup = bs.Cup(arc_of_cover=radians(arc))
    return load_curve_of(joint, cup, (COARSE, COARSE), 2, 1, LinearGap)


@pytest.fixture(scope="module")
def curve():
    return coarse_curve(RIGID, 130.0)


@pytest.fixture(scope="module")
def pair(curve):
    return curve.pairs(0, solver.COARSE)


def socket(layers, *, rim=1.4, chamfer=0.0, interface=Interface.BONDED, support=Support.FIXED):
    return SocketShape(layers=layers, rim=rim, chamfer=chamfer, interface=interface, support=support)


@pytest.mark.parametrize("layers", [LINER, SHELL], ids=["liner", "shell"])
@pytest.mark.parametrize("m", range(4))
def test_rings_of_one_harmonic_deform_like_the_mode_of_that_degree(m, layers):
    """In a closed shell the compliance of a spherical harmonic, here sin^m φ cos mθ, depends on its degree alone."""
    edges = np.linspace(0.0, radians(176.0), 45)
    (matrix,) = socket_harmonics(socket(layers, rim=edges[-1]), edges).ring_compliance(edges, [m])
    assert matrix == pytest.approx(matrix.T, abs=1e-14)
    pressure, t = np.sin((edges[1:] + edges[:-1]) / 2) ** m, np.linspace(0.0, pi, 4001)
    norm = 2 * pi * np.trapezoid(np.sin(t) ** (2 * m + 1), t)
    inner = (1.0, *(outer for outer, *_ in layers))
    shells = (Shell(thickness=b - a, young=E, poisson=nu) for a, (b, E, nu) in zip(inner[:-1], layers, strict=True))
    exact = float(Socket(radius=1.0, shells=tuple(shells)).compliance([m])[0])
    assert pressure @ matrix @ pressure == pytest.approx(exact * norm, rel=6e-3)


def test_a_full_contact_obeys_equilibrium_and_superposition(pair):
    start = partial_contact(pair, GAP, float(pair.angle[-1])).indentation
    contacts = [FullContact(pair=pair, gap=GAP, indentation=factor * start) for factor in (1.5, 2.0, 2.5)]
    forces = [contact.force for contact in contacts]
    slope = (forces[2] - forces[0]) / start
    assert forces[1] == pytest.approx((forces[0] + forces[2]) / 2, rel=1e-9)  # linear in the indentation
    for contact in contacts:
        assert contact.stiffness == pytest.approx(slope, rel=1e-6)
        assert (contact.half_angle, contact.overlap, contact.edge_element) == (pair.angle[-1], -inf, 0)
        assert contact.tension < 0
        x, w = np.polynomial.legendre.leggauss(200)
        angle = contact.half_angle * (1 + x) / 2
        ring = 2 * pi * 18.0**2 * contact.pressure(angle) * np.sin(angle) * w * contact.half_angle / 2
        assert ring.sum() == pytest.approx(contact.pressure_integral, rel=2e-3)
        assert (ring * np.cos(angle)).sum() == pytest.approx(contact.force, rel=2e-3)
        assert contact.forces(0).sum() == pytest.approx(contact.pressure_integral, rel=1e-6)
    np.testing.assert_array_equal(contacts[0].pressure(np.array([1.0001, 1.5]) * contacts[0].half_angle), 0.0)
    assert contacts[0].pressure(0.0) == contacts[0].pole_pressure
    work = (forces[1] + forces[0]) / 2 * 0.5 * start
    assert contacts[1].strain_energy - contacts[0].strain_energy == pytest.approx(work, rel=1e-6)
    assert load_search.work(contacts[0]) == contacts[0].strain_energy
    assert load_search.stiffness(contacts[0]) == contacts[0].stiffness


def test_work_of_a_full_contact_is_the_strain_energy(pair):
    """The circular gap has no potential: its work is integrated, here for a gap that is nearly the linear one."""
    start = partial_contact(pair, GAP, float(pair.angle[-1])).indentation
    full = FullContact(pair=pair, gap=GAP, indentation=1.5 * start)
    energy = load_search._partial_work(partial_contact(pair, GAP, full.half_angle)) + load_search._rim_work(full)
    assert energy == pytest.approx(full.strain_energy, rel=2e-3)
    narrow = partial_contact(pair, GAP, 0.8)
    assert load_search._partial_work(narrow) == pytest.approx(narrow.strain_energy, rel=2e-3)


def test_a_bracket_finds_the_contacts_between_its_ends(pair):
    bracket = ContactBracket(pair=pair, gap=GAP, low=0.3, high=1.0)
    low, high = partial_contact(pair, GAP, 0.3), partial_contact(pair, GAP, 1.0)
    for kind in ("force", "indentation"):
        first, last = getattr(low, kind), getattr(high, kind)
        for outside in (0.99 * first, 1.01 * last):
            assert bracket.solve(kind, outside) is bracket.estimate_angle(kind, outside) is None
        assert bracket.lies_below(kind, 1.01 * last)
        assert not bracket.lies_below(kind, 0.99 * last)
        for fraction in (0.0, 0.3, 0.9, 1.0):
            load = np.clip(first ** (1 - fraction) * last**fraction, first * (1 + 1e-12), last * (1 - 1e-12))
            contact = bracket.solve(kind, load)
            assert getattr(contact, kind) == pytest.approx(load, rel=1e-9)
            assert bracket.estimate_angle(kind, load) == pytest.approx(contact.half_angle, rel=0.02)
            bisected = bracket._solve_by_brent(kind, load, 0.29, 1.0)
            assert bisected.half_angle == pytest.approx(contact.half_angle, rel=1e-8)


@pytest.mark.parametrize("elements", [5.5, 6.5])
def test_a_contact_of_few_elements_has_a_pole_pressure(pair, elements):
    half_angle = elements * pair.resolution.size
    contact = partial_contact(pair, GAP, half_angle)
    assert contact.last <= 3
    exact = bs.Exact().press(RIGID, half_angle=half_angle)
    assert contact.pole_pressure == pytest.approx(exact.pole_pressure, rel=0.02)


@pytest.mark.parametrize(("order", "richardson", "factor"), [(1, 1.0, 3.0), (2, 3.0, 1.0)])
def test_errors_are_extrapolated_and_bounded_from_below(order, richardson, factor):
    fine, coarse = (
        SimpleNamespace(edge_element=np.array([0.1]), **dict.fromkeys(solver.QUANTITIES, np.array([value])))
        for value in (1.0, 1.6)
    )
    errors = solver.estimate_errors("force", fine, coarse, order)
    assert errors["force"] == 0
    assert errors["energy"] == pytest.approx(2.0 * 0.6 / richardson)
    bounded = solver.estimate_errors("force", fine, fine, order)
    shares = {"stiffness": 1.0, "half_angle": 0.7, "indentation": 0.03, "energy": 0.07, "pressure_integral": 0.02}
    shares |= {"force": 0.0, "max_pressure": 0.2, "pole_pressure": 0.2}
    assert bounded == pytest.approx({name: share * factor * 0.01 for name, share in shares.items()})


def test_the_stress_near_a_rim_is_solved_for():
    cut = bs.FiniteElement(spacing=COARSE, meshes=1, cup=bs.Cup(arc_of_cover=radians(170.0))).press(RIGID, force=1000.0)
    assert cut.quick_von_mises.value == cut.von_mises


def test_halvings_divide_every_element_in_four():
    once = Resolution(size=0.2, reach=0.8, growth=1.3, widest=0.3, deepest=0.5, order=2)
    shape = socket_shape(HIP, bs.Cup())
    angle, radii = shape.corners(once)
    for number in (1, 2):
        fine_angle, fine_radii = shape.corners(replace(once, halvings=number))
        assert fine_angle[:: 2**number] == pytest.approx(angle)
        assert fine_radii[0][:: 2**number] == pytest.approx(radii[0])


def check_chamfer(chamfer, thickness=6.75, arc=180.0):
    cup = bs.Cup(arc_of_cover=radians(arc), chamfer=chamfer)
    solver.check_cup(cup, replace(RIGID, liner_thickness=thickness))


def check_bore(size, backing=()):
    solver._check_element_size(size, replace(RIGID, backing=backing), 28.0)


@pytest.mark.parametrize(
    ("check", "allowed", "refused", "message"),
    [
        (check_chamfer, [(0.0,), (6.0,), (0.007,)], [(6.1,), (0.006,)], "chamfer = .* is not allowed"),
        (check_chamfer, [(14.0, 30.0), (7.0, 30.0, 90.0)], [(14.3, 30.0), (7.2, 30.0, 90.0)], "chamfer = .* is not"),
        (check_bore, [(0.5, THIN)], [(0.51, THIN)], r"backing\[0\].thickness = 1 is not .* two elements of 0.51 mm"),
        (check_bore, [(28 / 24.1,), (2.9e-4,)], [(28 / 23.9,), (2.7e-4,)], "bore of 28 mm allows 24 to 100000 elem"),
        (lambda n: bs.Adapted(elements=n), [(24,), (26,)], [(22,), (25,), (27,)], "must be even and at least 24"),
        (lambda q: bs.Adapted(growth=q), [(1.0,), (2.0,)], [(0.99,), (2.01,)], "growth must lie between 1 and 2"),
        (lambda q: bs.Uniform(size=0.5, growth=q), [(1.0,), (2.0,)], [(0.99,), (2.01,)], "growth must lie between"),
    ],
)
def test_chamfers_and_elements_have_limits(check, allowed, refused, message):
    for arguments in allowed:
        check(*arguments)
    for arguments in refused:
        with pytest.raises(ValueError, match=message):
            check(*arguments)


def test_a_contact_under_tension_or_overlap_is_not_round(monkeypatch):
    model, force = bs.FiniteElement(spacing=COARSE, meshes=1), 250.0
    assert model.press(RIGID, force=force).status is bs.Status.OK
    monkeypatch.setattr(solver, "_MAX_TENSION", -2.0)
    assert model.press(RIGID, force=force).status is bs.Status.NOT_ROUND
    monkeypatch.undo()
    monkeypatch.setattr(solver, "_MAX_OVERLAP", -inf)
    assert model.press(RIGID, force=[0.0, force]).status.tolist() == [bs.Status.OK, bs.Status.NOT_ROUND]


@pytest.fixture(scope="module")
def soft_pair():
    return coarse_curve(replace(RIGID, liner_thickness=inf), 340.0).pairs(0, solver.COARSE)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_a_bracket_ends_before_the_perfect_fit(soft_pair, count):
    """In a massive socket that is nearly a whole sphere the fit is the exact one; a single sample is no bracket."""
    last = float(soft_pair.angle[-1])
    fit = bisect(lambda angle: (partial_contact(soft_pair, GAP, angle).indentation > 0) - 0.5, 0.5, last, xtol=2e-9)
    widest = curve_of(bs.Exact(), replace(RIGID, liner_thickness=inf)).widest_angle
    assert fit == pytest.approx(widest, abs=radians(0.3))
    low = fit / 1.001 ** (count - 0.5)
    bracket = ContactBracket(pair=soft_pair, gap=GAP, low=low, high=low * 1.001**9)
    assert len(bracket.samples) == count
    assert not bracket.lies_below("force", 1e12)
    if count == 1:
        larger = bracket.samples[0].force * 1.001
        assert bracket.solve("force", larger) is bracket.estimate_angle("force", larger) is None
        return
    for kind in ("force", "indentation"):
        first, last = (getattr(bracket.samples[i], kind) for i in (0, -1))
        for load in (first * 1.0001, (first + last) / 2, 3.0 * last):
            contact = bracket.solve(kind, load)
            assert getattr(contact, kind) == pytest.approx(load, rel=1e-8)
            assert bracket.estimate_angle(kind, load) == pytest.approx(contact.half_angle, rel=2e-3)


SLIDING_ON_NOTHING = (LINER, Interface.SLIDING, Support.FREE)
SOCKETS = [case for case in product((LINER, SHELL), Interface, Support) if case != SLIDING_ON_NOTHING]


@pytest.mark.parametrize(("layers", "interface", "support"), SOCKETS)
def test_harmonic_zero_is_the_axisymmetric_body(layers, interface, support):
    shape = socket(layers, chamfer=0.1, interface=interface, support=support)
    body = socket_body(shape, Resolution(size=0.13, reach=inf, growth=1.4, widest=0.13, deepest=0.5, order=2))
    harmonics = Harmonics(elastic=body.elastic, shape=shape)
    np.testing.assert_array_equal(harmonics.bore, body.contact)
    edges = body.elastic.block.angle[: len(body.contact) : 2]
    loads = harmonics._ring_loads(edges)
    expected = loads.T @ body.surface_compliance()[1] @ loads
    (matrix,) = harmonics.ring_compliance(edges, [0])
    np.testing.assert_allclose(matrix, expected, rtol=1e-7, atol=1e-9 * abs(expected).max())


@pytest.mark.parametrize(
    ("layers", "stiff", "soft"),
    [
        (SHELL, {"support": Support.FIXED}, {"support": Support.FIXED, "interface": Interface.SLIDING}),
        (SHELL, {"support": Support.FREE}, {"support": Support.FREE, "interface": Interface.SLIDING}),
        (LINER, {"support": Support.FIXED}, {"support": Support.FREE}),
    ],
)
def test_sliding_liners_and_free_shells_are_softer_for_every_load_of_each_harmonic(layers, stiff, soft):
    """Harmonic 1 includes the sideways translation of the load."""
    edges = np.linspace(0.0, 1.4, 9)
    pair = (socket_harmonics(socket(layers, **ends), edges).ring_compliance(edges, [0, 1, 2]) for ends in (stiff, soft))
    for tight, loose in zip(*pair, strict=True):
        assert np.linalg.eigvalsh(tight).min() > 0
        assert np.linalg.eigvalsh(loose - tight).min() > -1e-9
        assert np.trace(loose) > 1.005 * np.trace(tight)


# --- elements ---

ORDERS = pytest.mark.parametrize("order", [1, 2], ids=["bilinear", "biquadratic"])
BACKED = ((1.3, 1.0, 0.4), (1.5, 20.0, 0.3))


def resolution(size=0.1, *, reach=0.8, growth=1.3, deepest=0.5, order=2, halvings=0):
    sizes = {"size": size, "reach": reach, "growth": growth, "widest": 0.3, "deepest": deepest}
    return Resolution(**sizes, order=order, halvings=halvings)


def solve_sliding(support):
    """Return mesh and displacements of a sliding liner under unit forces, and the last grid line of the liner."""
    body = socket_body(socket(BACKED, rim=1.5, interface=Interface.SLIDING, support=support), resolution())
    return body.elastic.block, body.displacements(np.ones(len(body.contact))), *body.elastic.block.sliding


@ORDERS
def test_a_translation_along_the_axis_has_no_energy_and_a_uniform_strain_its_own(order):
    """u_ρ = a ρ, u_z = b z: the patch test. The meshed volume is that of the elements, chords or parabolas."""
    elastic = shell_block(order, end=1.1)
    K = elastic.stiffness_matrix()
    moved = polar_components(elastic, np.zeros(elastic.block.number.size), np.ones(elastic.block.number.size))
    assert abs(K @ moved).max() < 1e-12 * abs(K).max()
    assert abs(K - K.T).max() < 1e-12 * abs(K).max()
    assert strain_energy_error(order) < (5e-3 if order == 1 else 1e-4)


@pytest.mark.parametrize("poisson", some([0.4999, 0.49, 0.3, 0.0], 1))
@pytest.mark.parametrize(("order", "elements", "least"), [(1, 32, 1.9), (2, 8, 3.9)], ids=["bilinear", "biquadratic"])
def test_a_thick_sphere_under_pressure_converges_and_does_not_lock(order, elements, least, poisson):
    """Displacement by Bartel's modulus K_B = E/R2 (2(1-2ν) + (1+ν)k³)/((1+ν)(1-2ν)(1-k³)), k = R2/b."""
    coarse, fine = (thick_sphere_error(order, elements, poisson) for elements in (elements, 2 * elements))
    assert np.log2(coarse / fine) > least
    assert fine < (2e-5 if order == 1 else 1e-7)


def test_sliding_layers_move_together_across_the_interface_and_freely_along_it_and_at_the_rim():
    """A free shell sits on its rim; the liner in it does not."""
    mesh, moved, inner = solve_sliding(Support.FIXED)
    one, other = moved[mesh.number[:, inner]], moved[mesh.number[:, inner + 1]]
    np.testing.assert_array_equal(one[:, 1], other[:, 1])
    assert abs(one[1:, 0] - other[1:, 0]).max() > 1e-3 * abs(one[:, 1]).max()
    mesh, moved, inner = solve_sliding(Support.FREE)
    along = moved[mesh.number[-1], 0]
    assert np.all(along[: inner + 1] != 0)
    np.testing.assert_array_equal(along[inner + 1 :], 0.0)


def test_the_equator_of_the_ball_is_fixed_axially_and_free_radially():
    body = ball_body(0.3, resolution())
    mesh = body.elastic.block
    moved = body.displacements(np.ones(len(body.contact)))
    np.testing.assert_array_equal(moved[mesh.number[-1], 0], 0.0)  # u_φ is the axial displacement there
    assert abs(moved[mesh.number[-1, 1:], 1]).min() > 0
