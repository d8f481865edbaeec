"""Parts of the finite element model: meshes, harmonics, full contacts, error estimates and CalculiX results."""

from dataclasses import replace
from math import inf, pi, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.elasticity.exact.model import curve_of
from ballsocket.elasticity.exact.modes import Shell, Socket
from ballsocket.elasticity.finite_elements import calculix, load_search, mesh, solver, spacing
from ballsocket.elasticity.finite_elements.bodies import nested_dissection, socket_body
from ballsocket.elasticity.finite_elements.elasticity import shape_functions
from ballsocket.elasticity.finite_elements.harmonics import Harmonics, socket_harmonics
from ballsocket.elasticity.finite_elements.load_search import ContactBracket
from ballsocket.elasticity.finite_elements.mesh import Resolution, SocketShape, ball_corners, socket_shape
from ballsocket.elasticity.finite_elements.pair_contact import FullContact, partial_contact, pressure_at_pole
from ballsocket.elasticity.finite_elements.section import _superconvergent_points as superconvergent_points
from ballsocket.elasticity.finite_elements.solver import Settings, load_curve_of
from ballsocket.elasticity.finite_elements.surfaces import ContactSurface, lagrange
from ballsocket.problem import Support
from ballsocket.problem.cup import Interface
from ballsocket.problem.gaps import CircularGap, LinearGap

from ...joints import HIP

RIGID = replace(HIP, ball=None)
COARSE = bs.Adapted(elements=24)


@pytest.fixture(scope="module")
def curve():
    cup = bs.Cup(arc_of_cover=radians(130.0))
    settings = Settings(cup=cup, spacing=COARSE, ball_spacing=COARSE, order=2, meshes=1, gap=LinearGap)
    return load_curve_of(settings, RIGID)


@pytest.fixture(scope="module")
def pair(curve):
    return curve.pairs(0, solver.COARSE)


def closed_shell(order=0.4, *, support=Support.FIXED, layers=((1.3, 1.0, 0.4),)):
    return SocketShape(layers=layers, rim=radians(176.0), chamfer=0.0, interface=Interface.BONDED, support=support)


LEGENDRE = {
    0: (0, lambda t: 1.0 + 0.0 * t),
    1: (1, np.sin),
    2: (2, lambda t: np.sin(t) ** 2),
    3: (3, lambda t: np.sin(t) ** 3),
}


@pytest.mark.parametrize("layers", [((1.3, 1.0, 0.4),), ((1.2, 1.0, 0.3), (1.35, 8.0, 0.25))], ids=["liner", "shell"])
@pytest.mark.parametrize("m", LEGENDRE)
def test_rings_of_one_harmonic_deform_like_the_mode_of_that_degree(m, layers):
    """In a closed shell the compliance of a spherical harmonic depends on its degree alone."""
    degree, wave = LEGENDRE[m]
    edges = np.linspace(0.0, radians(176.0), 45)
    harmonics = socket_harmonics(closed_shell(layers=layers), edges)
    (matrix,) = harmonics.ring_compliance(edges, [m])
    assert matrix == pytest.approx(matrix.T, abs=1e-14)
    pressure = wave((edges[1:] + edges[:-1]) / 2)
    t = np.linspace(0.0, pi, 4001)
    norm = 2 * pi * np.trapezoid(wave(t) ** 2 * np.sin(t), t)
    inner, shells = 1.0, []
    for outer, young, poisson in layers:
        shells.append(Shell(thickness=outer - inner, young=young, poisson=poisson))
        inner = outer
    exact = float(Socket(radius=1.0, shells=tuple(shells)).compliance([degree])[0])
    assert pressure @ matrix @ pressure == pytest.approx(exact * norm, rel=6e-3)


def test_ring_loads_are_the_areas_of_the_rings():
    edges = np.linspace(0.0, pi / 2, 10)
    harmonics = socket_harmonics(replace(closed_shell(), rim=pi / 2), edges)
    loads = harmonics._ring_loads(edges)
    np.testing.assert_allclose(loads.sum(axis=0), 2 * pi * -np.diff(np.cos(edges)), rtol=1e-9)
    assert loads.min() > -1e-12


def test_a_free_shell_moves_rigidly_along_its_axis_only_on_its_rim():
    edges = np.linspace(0.0, pi / 2, 10)
    fixed, free = (
        socket_harmonics(replace(closed_shell(support=support), rim=pi / 2), edges).ring_compliance(edges, [0, 1, 2])
        for support in (Support.FIXED, Support.FREE)
    )
    for tight, loose in zip(fixed, free, strict=True):
        assert np.linalg.eigvalsh(loose - tight).min() > -1e-9
        assert np.linalg.eigvalsh(tight).min() > 0


def test_a_full_contact_obeys_equilibrium_and_superposition(pair):
    gap = LinearGap(clearance=0.1, socket_radius=18.0)
    start = partial_contact(pair, gap, float(pair.angle[-1])).indentation
    contacts = [FullContact(pair=pair, gap=gap, indentation=factor * start) for factor in (1.5, 2.0, 2.5)]
    forces = [contact.force for contact in contacts]
    slope = (forces[2] - forces[0]) / start
    assert forces[1] == pytest.approx((forces[0] + forces[2]) / 2, rel=1e-9)  # linear in the indentation
    for contact in contacts:
        assert contact.stiffness == pytest.approx(slope, rel=1e-6)
        assert contact.half_angle == pair.angle[-1]
        assert contact.overlap == -inf
        assert contact.edge_element == 0
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
    linear = LinearGap(clearance=0.1, socket_radius=18.0)
    start = partial_contact(pair, linear, float(pair.angle[-1])).indentation
    full = FullContact(pair=pair, gap=linear, indentation=1.5 * start)
    energy = load_search._partial_work(partial_contact(pair, linear, full.half_angle)) + load_search._rim_work(full)
    assert energy == pytest.approx(full.strain_energy, rel=2e-3)
    narrow = partial_contact(pair, linear, 0.8)
    assert load_search._partial_work(narrow) == pytest.approx(narrow.strain_energy, rel=2e-3)


def test_a_full_contact_is_solved_for_its_force(pair):
    for gap in (LinearGap(clearance=0.1, socket_radius=18.0), CircularGap(clearance=0.1, socket_radius=18.0)):
        contact = solver._solve_full_contact("force", 9000.0, pair, gap)
        assert contact.force == pytest.approx(9000.0, rel=1e-10)
    assert solver._solve_full_contact("indentation", 0.5, pair, gap).indentation == 0.5


def test_a_bracket_finds_the_contacts_between_its_ends(pair):
    gap = LinearGap(clearance=0.1, socket_radius=18.0)
    bracket = ContactBracket(pair=pair, gap=gap, low=0.3, high=1.0)
    low, high = partial_contact(pair, gap, 0.3), partial_contact(pair, gap, 1.0)
    for kind in ("force", "indentation"):
        first, last = getattr(low, kind), getattr(high, kind)
        assert bracket.solve(kind, 0.99 * first) is None
        assert bracket.estimate_angle(kind, 0.99 * first) is None
        assert bracket.solve(kind, 1.01 * last) is None
        assert bracket.estimate_angle(kind, 1.01 * last) is None
        assert bracket.lies_below(kind, 1.01 * last)
        assert not bracket.lies_below(kind, 0.99 * last)
        for fraction in (0.0, 0.3, 0.9, 1.0):
            load = first ** (1 - fraction) * last**fraction
            load = min(max(load, first * (1 + 1e-12)), last * (1 - 1e-12))
            contact = bracket.solve(kind, load)
            assert getattr(contact, kind) == pytest.approx(load, rel=1e-9)
            assert bracket.estimate_angle(kind, load) == pytest.approx(contact.half_angle, rel=0.02)
            bisected = bracket._solve_by_brent(kind, load, 0.29, 1.0)
            assert bisected.half_angle == pytest.approx(contact.half_angle, rel=1e-8)


def test_the_pressure_at_the_pole_is_extrapolated_by_an_even_polynomial():
    angle = np.linspace(0.0, 1.0, 41)
    pressures = 5.0 - 2.0 * angle**2 + 0.5 * angle**4
    pressures[0] = 99.0
    assert pressure_at_pole(angle, pressures, 1.0) == pytest.approx(5.0, rel=1e-9)
    few = angle[::8]
    assert pressure_at_pole(few, 5.0 - 2.0 * few**2, 1.0) == pytest.approx(5.0, rel=1e-9)


def test_the_pressure_at_the_pole_of_few_nodes_is_a_parabola_through_three():
    """Scatter that is orthogonal to a parabola has no effect; the fourth node lies outside the pole region."""
    angle = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 1.0])
    square = angle[1:4] ** 2
    scatter = np.cross(np.ones(3), square)
    pressures = np.append(99.0, np.append(5.0 - 2.0 * square + 0.3 * scatter / abs(scatter).max(), [77.0, 0.0]))
    assert pressure_at_pole(angle, pressures, 0.5) == pytest.approx(5.0, rel=1e-9)


@pytest.mark.parametrize("elements", [5.5, 6.5])
def test_a_contact_of_few_elements_has_a_pole_pressure(pair, elements):
    half_angle = elements * pair.resolution.size
    contact = partial_contact(pair, LinearGap(clearance=0.1, socket_radius=18.0), half_angle)
    assert contact.last <= 3
    exact = bs.Exact().press(RIGID, half_angle=half_angle)
    assert contact.pole_pressure == pytest.approx(exact.pole_pressure, rel=0.02)


def test_stresses_are_extrapolated_bilinearly_to_the_nodes():
    corners = np.array([[0.0, 1.0, 1.0, 0.0, 0.5, 1.0, 0.5, 0.0, 0.5], [0.0, 0.0, 1.0, 1.0, 0.0, 0.5, 1.0, 0.5, 0.5]])
    assert shape_functions(2, corners)[0] == pytest.approx(np.eye(9), abs=1e-14)
    points, extrapolation = superconvergent_points(2)
    for function in (lambda x, y: 1.0 + 0 * x, lambda x, y: x, lambda x, y: y, lambda x, y: x * y):
        assert function(*points) @ extrapolation == pytest.approx(function(*corners), abs=1e-14)
    points, extrapolation = superconvergent_points(1)
    assert points.ravel().tolist() == [0.5, 0.5]
    assert (np.array([3.0]) @ extrapolation).tolist() == [3.0] * 4


def test_lagrange_polynomials_interpolate():
    corners = np.array([0.0, 0.1, 0.3, 0.6])
    for order in (1, 2):
        nodes = mesh.add_midpoints(corners, order)
        angle = np.array([0.0, 0.05, 0.1, 0.23, 0.6])
        shapes = lagrange(corners, order, angle).toarray()
        assert shapes.shape == (5, len(nodes))
        np.testing.assert_allclose(shapes.sum(axis=1), 1.0, rtol=1e-14)
        np.testing.assert_allclose(shapes @ nodes**order, angle**order, atol=1e-14)
        surface = ContactSurface(angle=nodes, order=order, compliance=np.eye(len(nodes)))
        np.testing.assert_array_equal(surface.corners, corners)
        np.testing.assert_allclose(surface.nodal_sums(angle, np.arange(5.0)), shapes.T @ np.arange(5.0), atol=1e-14)


def test_points_are_bisected_and_joined():
    np.testing.assert_allclose(mesh.bisect_intervals(np.array([0.0, 1.0, 3.0])), [0.0, 0.5, 1.0, 2.0, 3.0])
    np.testing.assert_allclose(mesh.join_points([np.array([0.0, 1.0]), np.array([1.0, 2.0, 4.0])]), [0, 1, 2, 4])


@pytest.mark.parametrize("order", [1, 2])
def test_a_block_numbers_its_nodes_elements_and_layers(order):
    layers = [np.array([1.0, 1.1, 1.3]), np.array([1.3, 1.5])]
    bonded, sliding = (mesh.mesh_block(np.linspace(0.0, 1.0, 4), layers, order, cut) for cut in ((), (1,)))
    assert bonded.radius.shape == (3 * order + 1, 3 * order + 1)
    assert sliding.radius.shape == (3 * order + 1, 3 * order + 2)
    assert bonded.elements.shape == ((order + 1) ** 2, 9)
    np.testing.assert_array_equal(bonded.layers, [0, 0, 1] * 3)
    assert len(bonded.sliding) == 0
    np.testing.assert_array_equal(sliding.sliding, [2 * order])
    np.testing.assert_array_equal(np.diff(sliding.level)[sliding.sliding], 0)
    corners = bonded.nodes[:, bonded.elements[:4]]
    area = 0.5 * sum(
        corners[0, i] * corners[1, (i + 1) % 4] - corners[0, (i + 1) % 4] * corners[1, i] for i in range(4)
    )
    assert (area < 0).all() or (area > 0).all()
    assert abs(area).sum() == pytest.approx((1.5**2 - 1) / 2, rel=0.02)


def test_the_size_of_a_mesh_counts_both_bodies():
    shape, cup = socket_shape(HIP, bs.Cup()), bs.Cup()
    resolution = Resolution(size=0.1, reach=0.8, growth=1.3, widest=0.3, deepest=0.5, order=2)
    size = spacing.mesh_size(HIP, cup, resolution, resolution)
    angle, radii = shape.corners(resolution)
    ball = ball_corners(resolution)
    along, deep = len(angle) - 1, len(radii[0]) - 1
    ball_along, ball_deep = (len(corners) - 1 for corners in ball)
    assert size.elements == along * deep + ball_along * ball_deep
    assert size.largest == max((2 * along + 1) * (2 * deep + 1), (2 * ball_along + 1) * (2 * ball_deep + 1))
    assert size.nodes == (2 * along + 1) * (2 * deep + 1) + (2 * ball_along + 1) * (2 * ball_deep + 1)
    assert size.element_size == pytest.approx(angle[1] * 18.0)
    assert spacing.mesh_size(RIGID, cup, resolution, resolution).elements == along * deep
    assert spacing.bytes_needed(2048, 2) == 2 * 12 * 8 * 2 * 2048 * 11 + 1000 * 2048 * 2


def test_resolutions_of_adapted_and_uniform_elements():
    classes = COARSE.classes(1.5, 18.0)
    assert len(classes) == 25
    np.testing.assert_allclose(np.divide(classes[1:], classes[:-1]), np.sqrt(0.5))
    coarse = bs.Adapted(elements=60).coarse(0.9, 18.0, 6.75, 2)
    assert coarse.size == pytest.approx(2 * 0.9 / 60)
    assert coarse.reach == pytest.approx(1.2 * 0.9)
    assert (coarse.growth, coarse.order, coarse.halvings) == (1.3, 2, 0)
    assert coarse.widest == pytest.approx(pi / 12)
    assert coarse.deepest == pytest.approx(1 / 3)
    thin = bs.Adapted(elements=60).coarse(0.9, 18.0, 0.36, 2)
    assert thin.size == pytest.approx(0.36 / 36)
    fine = bs.Adapted(elements=120).coarse(0.9, 18.0, 6.75, 1)
    assert fine.size == pytest.approx(2 * 0.9 / 120)
    assert fine.growth == pytest.approx(np.sqrt(1.3))
    assert fine.widest == pytest.approx(pi / 24)
    assert COARSE.coarse(0.9, 18.0, 6.75, 1).deepest == 0.5
    uniform = bs.Uniform(size=0.09)
    assert uniform.classes(1.5, 18.0) == (1.5, pytest.approx(12 * 0.09 / 18.0))
    assert uniform.classes(0.01, 18.0)[1] == pytest.approx(0.005)
    mesh_of_uniform = uniform.coarse(0.9, 18.0, 6.75, 1)
    assert mesh_of_uniform.size == mesh_of_uniform.widest == pytest.approx(0.01)
    assert mesh_of_uniform.deepest == pytest.approx(1 / 3)
    assert mesh_of_uniform.reach == inf


class Quantities:
    """Stand-in for states with one value for every quantity."""

    def __init__(self, value, edge=0.1):
        self.edge_element = np.array([edge])
        self._value = np.array([value])

    def __getattr__(self, name):
        return self._value


@pytest.mark.parametrize(("order", "richardson", "factor"), [(1, 1.0, 3.0), (2, 3.0, 1.0)])
def test_errors_are_extrapolated_and_bounded_from_below(order, richardson, factor):
    errors = solver.estimate_errors("force", Quantities(1.0), Quantities(1.6), order)
    assert errors["force"] == 0
    assert errors["energy"] == pytest.approx(2.0 * 0.6 / richardson)
    bounded = solver.estimate_errors("force", Quantities(1.0), Quantities(1.0), order)
    assert bounded["stiffness"] == pytest.approx(1.0 * factor * 0.01)
    assert bounded["half_angle"] == pytest.approx(0.7 * factor * 0.01)
    assert bounded["indentation"] == pytest.approx(0.03 * factor * 0.01)
    assert bounded["energy"] == pytest.approx(0.07 * factor * 0.01)
    assert bounded["pressure_integral"] == pytest.approx(0.02 * factor * 0.01)
    assert bounded["max_pressure"] == bounded["pole_pressure"] == pytest.approx(0.2 * factor * 0.01)


def test_the_edge_is_extrapolated_from_the_opening_of_the_gap():
    angle, edge = np.linspace(0.0, 1.0, 81), 0.613
    gap = np.where(angle > edge, 0.4 * np.maximum(angle - edge, 0.0) ** 1.5, 0.0)
    assert calculix.edge_angle(angle, gap) == pytest.approx(edge, abs=1e-9)
    curved = np.where(angle > edge, (0.4 * (angle - edge).clip(0) + 0.05 * (angle - edge) ** 2) ** 1.5, 0.0)
    assert calculix.edge_angle(angle, curved) == pytest.approx(edge, abs=1e-4)
    assert calculix.edge_angle(angle, 0.0 * angle) == 1.0
    few = np.append(np.zeros(79), [0.01, 0.02])
    assert 0.9 < calculix.edge_angle(angle, few) <= 1.0


def test_the_pole_pressure_ignores_the_nodes_next_to_the_pole():
    angle = np.linspace(0.0, 1.0, 101)
    pressures = 7.0 - 3.0 * angle**2 + angle**4
    wrong = pressures.copy()
    wrong[:10] *= 3.0
    wrong[67:] = 0.0
    assert calculix.pressure_at_pole(angle, wrong, 1.0) == pytest.approx(7.0, rel=1e-9)
    coarse = np.linspace(0.0, 1.0, 9)
    assert calculix.pressure_at_pole(coarse, 7.0 - 3.0 * coarse**2, 1.0) == pytest.approx(7.0, rel=1e-9)


def test_printed_rows_are_read_by_step(tmp_path):
    path = tmp_path / "a.dat"
    path.write_text(
        "\n".join(
            [
                " displacements (vx,vy,vz) for set BORE and time  0.5000000E+00",
                "",
                "  1  9.0 9.0 9.0",
                " displacements (vx,vy,vz) for set BORE and time  0.1000000E+01",
                "",
                "  1  1.0 2.0 3.0",
                "  2  4.0 5.0 6.0",
                " displacements (vx,vy,vz) for set ROUND and time  0.1000000E+01",
                "",
                "  7  7.0 7.0 7.0",
                " displacements (vx,vy,vz) for set BORE and time  0.2000000E+01",
                "",
                "  1  0.5 0.5 0.5",
                "",
            ]
        ),
        encoding="ascii",
    )
    rows = calculix.read_printed(path, "BORE")
    assert sorted(rows) == [0, 1]
    np.testing.assert_array_equal(rows[0], [[1, 1, 2, 3], [2, 4, 5, 6]])
    np.testing.assert_array_equal(rows[1], [[1, 0.5, 0.5, 0.5]])
    assert calculix.read_printed(tmp_path / "missing.dat", "BORE") == {}


def test_bounds_of_the_stress_are_open_near_a_rim():
    full = bs.FiniteElement(spacing=COARSE, meshes=1).press(RIGID, force=1000.0)
    cut = bs.FiniteElement(spacing=COARSE, meshes=1, cup=bs.Cup(arc_of_cover=radians(170.0))).press(RIGID, force=1000.0)
    low, high = cut.von_mises_bounds
    assert not low > 0
    assert high == inf
    assert full.max_pressure > 0


def test_elements_of_the_contact_have_the_size_of_the_mesh(pair):
    contact = partial_contact(pair, LinearGap(clearance=0.1, socket_radius=18.0), 0.7)
    assert contact.edge_element == pytest.approx(pair.resolution.size, rel=0.03)
    assert 0.7 - 4.1 * pair.resolution.size < pair.angle[contact.last] < 0.7 - 2.9 * pair.resolution.size


def test_small_elements_end_at_the_reach_and_never_leave_a_sliver():
    resolution = Resolution(size=0.1, reach=0.6, growth=1.3, widest=0.3, deepest=0.5, order=1)
    for end in (0.5, 0.6, 0.64):
        assert resolution.angles(end) == pytest.approx(np.linspace(0.0, end, round(min(end, 0.6) / 0.1) + 1))
    for end in (0.66, 0.75, 1.5):
        angles = resolution.angles(end)
        assert angles[:7] == pytest.approx(np.arange(7) * 0.1)
        assert angles[-1] == end
        assert np.diff(angles).max() <= 0.3 + 1e-12
    assert Resolution(size=0.1, reach=inf, growth=1.3, widest=0.1, deepest=0.5, order=1).angles(0.02).tolist() == [
        0.0,
        0.02,
    ]


def test_halvings_divide_every_element_in_four():
    once = Resolution(size=0.2, reach=0.8, growth=1.3, widest=0.3, deepest=0.5, order=2)
    shape = socket_shape(HIP, bs.Cup())
    angle, radii = shape.corners(once)
    for number in (1, 2):
        fine_angle, fine_radii = shape.corners(replace(once, halvings=number))
        assert fine_angle[:: 2**number] == pytest.approx(angle)
        assert fine_radii[0][:: 2**number] == pytest.approx(radii[0])


@pytest.mark.parametrize(
    ("chamfer", "thickness", "arc", "allowed"),
    [
        (0.0, 6.75, 180.0, True),
        (6.0, 6.75, 180.0, True),
        (6.1, 6.75, 180.0, False),
        (0.007, 6.75, 180.0, True),
        (0.006, 6.75, 180.0, False),
        (14.0, 30.0, 180.0, True),
        (14.3, 30.0, 180.0, False),
        (7.0, 30.0, 90.0, True),
        (7.2, 30.0, 90.0, False),
    ],
)
def test_chamfers_leave_a_tenth_of_the_liner_and_half_of_the_bore(chamfer, thickness, arc, allowed):
    cup, joint = bs.Cup(arc_of_cover=radians(arc), chamfer=chamfer), replace(RIGID, liner_thickness=thickness)
    if allowed:
        solver.check_cup(cup, joint)
    else:
        with pytest.raises(ValueError, match="chamfer = .* is not allowed"):
            solver.check_cup(cup, joint)


def test_elements_of_one_size_fit_the_layers_and_the_bore():
    backed = replace(RIGID, backing=(bs.Layer(thickness=1.0, material=bs.TITANIUM),))
    solver._check_element_size(0.5, backed, 28.0)
    with pytest.raises(ValueError, match=r"backing\[0\].thickness = 1 is not allowed: .* two elements of 0.51 mm"):
        solver._check_element_size(0.51, backed, 28.0)
    for size, allowed in ((28.0 / 23.9, False), (28.0 / 24.1, True), (2.9e-4, True), (2.7e-4, False)):
        if allowed:
            solver._check_element_size(size, RIGID, 28.0)
        else:
            with pytest.raises(ValueError, match="the bore of 28 mm allows 24 to 100000 elements"):
                solver._check_element_size(size, RIGID, 28.0)


@pytest.mark.parametrize(("elements", "allowed"), [(22, False), (24, True), (25, False), (26, True), (27, False)])
def test_adapted_elements_are_even_and_at_least_24(elements, allowed):
    if allowed:
        assert bs.Adapted(elements=elements).elements == elements
    else:
        with pytest.raises(ValueError, match="must be even and at least 24"):
            bs.Adapted(elements=elements)


@pytest.mark.parametrize("growth", [0.99, 2.01])
def test_elements_grow_by_a_factor_of_one_to_two(growth):
    for make_spacing in (bs.Adapted, lambda growth: bs.Uniform(size=0.5, growth=growth)):
        with pytest.raises(ValueError, match="growth must lie between 1 and 2"):
            make_spacing(growth=growth)
        assert make_spacing(growth=1.0).growth == 1.0
        assert make_spacing(growth=2.0).growth == 2.0


def test_a_contact_has_the_size_of_its_mesh_in_its_summary():
    contact = bs.FiniteElement(spacing=COARSE, meshes=1).press(RIGID, force=300.0)
    summary = contact.summary()
    assert summary["mesh"] == {
        "elements": contact.mesh.elements,
        "nodes": contact.mesh.nodes,
        "largest": contact.mesh.nodes,
        "element_size": contact.mesh.element_size,
    }
    assert "mesh" not in bs.FiniteElement(spacing=COARSE, meshes=1).press(RIGID, force=0.0).summary()
    assert "mesh" not in bs.FiniteElement(spacing=COARSE, meshes=1).press(RIGID, force=[1.0, 300.0]).summary()


def test_a_contact_under_tension_or_overlap_is_not_round(monkeypatch):
    model, force = bs.FiniteElement(spacing=COARSE, meshes=1), 250.0
    assert model.press(RIGID, force=force).status is bs.Status.OK
    monkeypatch.setattr(solver, "_MAX_TENSION", -2.0)
    assert model.press(RIGID, force=force).status is bs.Status.NOT_ROUND
    monkeypatch.undo()
    monkeypatch.setattr(solver, "_MAX_OVERLAP", -inf)
    assert model.press(RIGID, force=[0.0, force]).status.tolist() == [bs.Status.OK, bs.Status.NOT_ROUND]


def test_the_gap_of_a_solved_contact_is_open_and_its_pressure_positive(pair):
    contact = partial_contact(pair, LinearGap(clearance=0.1, socket_radius=18.0), 0.7)
    assert -1.0 < contact.tension < 0.0
    assert contact.overlap < 0.0
    squeezed = replace(contact)
    object.__setattr__(squeezed, "indentation", 1.2 * contact.indentation)
    assert squeezed.overlap > 1e-3


def test_a_bracket_spans_its_class_and_the_next_four(curve):
    for number in (0, 3):
        bracket = curve._contact_bracket(number, solver.COARSE)
        assert curve.classes[number + 5] < bracket.low < curve.classes[number + 4]
        assert curve.classes[number] <= bracket.high <= 1.12 * curve.classes[number]
    assert curve._contact_bracket(0, solver.COARSE).high == curve.classes[0]
    assert curve._contact_bracket(3, solver.COARSE) is curve._contact_bracket(3, solver.COARSE)


def test_loads_are_solved_on_the_mesh_of_their_class(curve):
    angles = [contact_class * 0.99 for contact_class in curve.classes[1:6]]
    assert [curve._mesh_class("half_angle", angle) for angle in angles] == [1, 2, 3, 4, 5]
    assert curve._mesh_class("half_angle", curve.classes[0]) == 0
    assert curve._mesh_class("half_angle", 1e-9) == len(curve.classes) - 2
    for angle in angles[:3]:
        contact = partial_contact(curve.pairs(0, solver.COARSE), curve.gap, 0.93 * angle)
        for kind in ("force", "indentation"):
            assert curve._mesh_class(kind, getattr(contact, kind)) == curve._mesh_class("half_angle", 0.93 * angle)
    assert curve._mesh_class("force", 1e9) == 0


def perfect_fit(pair, gap):
    """Bisect for the half angle at which the indentation becomes infinite."""
    low, high = 0.5, float(pair.angle[-1])
    for _ in range(30):
        middle = (low + high) / 2
        low, high = (middle, high) if partial_contact(pair, gap, middle).indentation > 0 else (low, middle)
    return low


@pytest.fixture(scope="module")
def soft_pair():
    cup = bs.Cup(arc_of_cover=radians(340.0))
    settings = Settings(cup=cup, spacing=COARSE, ball_spacing=COARSE, order=2, meshes=1, gap=LinearGap)
    return load_curve_of(settings, replace(RIGID, liner_thickness=inf)).pairs(0, solver.COARSE)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_a_bracket_ends_before_the_perfect_fit(soft_pair, count):
    """Samples end there, and larger loads are solved between the last sample and the fit; one sample is no bracket.

    In a massive socket that is nearly a whole sphere the fit is that of the exact solution.
    """
    gap = LinearGap(clearance=0.1, socket_radius=18.0)
    fit = perfect_fit(soft_pair, gap)
    assert fit == pytest.approx(
        curve_of(bs.Exact(), replace(RIGID, liner_thickness=inf)).widest_angle, abs=radians(0.3)
    )
    ratio = 1.001
    low = fit / ratio ** (count - 0.5)
    bracket = ContactBracket(pair=soft_pair, gap=gap, low=low, high=low * ratio**9)
    assert len(bracket._samples) == count
    assert not bracket.lies_below("force", 1e12)
    if count == 1:
        assert bracket.solve("force", bracket._samples[0].force * 1.001) is None
        assert bracket.estimate_angle("force", bracket._samples[0].force * 1.001) is None
        return
    for kind in ("force", "indentation"):
        first, last = (getattr(bracket._samples[i], kind) for i in (0, -1))
        for load in (first * 1.0001, (first + last) / 2, 3.0 * last):
            contact = bracket.solve(kind, load)
            assert getattr(contact, kind) == pytest.approx(load, rel=1e-8)
            assert bracket.estimate_angle(kind, load) == pytest.approx(contact.half_angle, rel=2e-3)


@pytest.mark.parametrize(("order", "shape"), [(1, (20, 33)), (2, (41, 21)), (2, (39, 65))])
def test_separators_of_nested_dissection_are_lines_between_elements(order, shape):
    """A separator halves its part: no element has nodes on both sides."""
    grid = np.arange(shape[0] * shape[1]).reshape(shape)

    def check(ordered, rows, columns):
        height, width = len(rows), len(columns)
        assert sorted(ordered) == sorted(grid[np.ix_(rows, columns)].ravel())
        if height * width <= 24 or min(height, width) <= 2:
            return
        along = 0 if height >= width else 1
        lines = (rows, columns)[along]
        separator = ordered[-(width if along == 0 else height) :]
        (line,) = {(int(node) // shape[1], int(node) % shape[1])[along] for node in separator}
        assert line % order == 0
        cut = int(np.searchsorted(lines, line))
        assert abs(2 * cut - len(lines)) <= 2 * order
        count = cut * (width if along == 0 else height)
        parts = [(lines[:cut], ordered[:count]), (lines[cut + 1 :], ordered[count : -len(separator)])]
        for part, nodes in parts:
            check(nodes, *((part, columns) if along == 0 else (rows, part)))

    check(nested_dissection(grid, order), np.arange(shape[0]), np.arange(shape[1]))


@pytest.mark.parametrize("support", Support)
@pytest.mark.parametrize("interface", Interface)
@pytest.mark.parametrize("layers", [((1.3, 1.0, 0.4),), ((1.2, 1.0, 0.3), (1.35, 8.0, 0.25))], ids=["liner", "shell"])
def test_harmonic_zero_is_the_axisymmetric_body(layers, interface, support):
    if interface is Interface.SLIDING and support is Support.FREE and len(layers) == 1:
        pytest.skip("a liner without backing does not slide on nothing")
    shape = SocketShape(layers=layers, rim=1.4, chamfer=0.1, interface=interface, support=support)
    body = socket_body(shape, Resolution(size=0.13, reach=inf, growth=1.4, widest=0.13, deepest=0.5, order=2))
    harmonics = Harmonics(elastic=body.elastic, shape=shape)
    np.testing.assert_array_equal(harmonics.bore, body.contact)
    edges = body.elastic.block.angle[: len(body.contact) : 2]
    loads = harmonics._ring_loads(edges)
    expected = loads.T @ body.compliance() @ loads
    (matrix,) = harmonics.ring_compliance(edges, [0])
    np.testing.assert_allclose(matrix, expected, rtol=1e-7, atol=1e-9 * abs(expected).max())


@pytest.mark.parametrize("support", Support)
def test_harmonic_one_includes_the_sideways_translation_of_the_load(support):
    """A sliding liner is softer than a bonded one for every load, and both harmonics 1 and 2 are positive definite."""
    edges, layers = np.linspace(0.0, 1.4, 9), ((1.2, 1.0, 0.3), (1.35, 8.0, 0.25))
    bonded, sliding = (
        socket_harmonics(
            SocketShape(layers=layers, rim=1.4, chamfer=0.0, interface=interface, support=support), edges
        ).ring_compliance(edges, [1, 2])
        for interface in (Interface.BONDED, Interface.SLIDING)
    )
    for tight, loose in zip(bonded, sliding, strict=True):
        assert np.linalg.eigvalsh(tight).min() > 0
        assert np.linalg.eigvalsh(loose - tight).min() > -1e-9
        assert np.trace(loose) > 1.005 * np.trace(tight)
