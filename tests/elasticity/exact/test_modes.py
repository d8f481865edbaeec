"""Modal compliance of sockets and balls: textbook limits, equilibrium, and 50-digit references."""

from functools import partial
from math import inf

import mpmath
import numpy as np
import pytest

from ballsocket import Support
from ballsocket.elasticity.exact.modes import ElasticBall, Shell, Socket

from ...refusals import refused_calls

POISSON = [-0.5, 0.0, 0.3, 0.4, 0.49, 0.4999]
RATIOS = [0.05, 0.5, 18 / 6.75, 10.0, 50.0]
DEGREES = [0, 1, 2, 3, 6, 12, 30, 90, 300, 2000, 20_000]
LINER = Shell(thickness=6.75, young=1000.0, poisson=0.4)
LINED = Socket(radius=18.0, shells=(LINER,))
METAL = Shell(thickness=3.0, young=110e3, poisson=0.3)
CEMENT = Shell(thickness=2.0, young=2500.0, poisson=0.35)
BONE = Shell(thickness=inf, young=17e3, poisson=0.28)
CUP = Socket(radius=18.0, shells=(LINER, METAL, CEMENT, BONE))
BOTH_SUPPORTS = pytest.mark.parametrize("support", Support)


def liner(ratio: float, poisson: float) -> Shell:
    return Shell(thickness=18.0 / ratio if ratio else inf, young=1000.0, poisson=poisson)


def single(ratio: float, poisson: float, support: Support = Support.FIXED) -> Socket:
    """R2/L = 0 is an infinite socket."""
    return Socket(radius=18.0, shells=(liner(ratio, poisson),), support=support)


def massive(shell: Shell) -> Socket:
    return Socket(radius=18.0, shells=(Shell(thickness=inf, young=shell.young, poisson=shell.poisson),))


def powers(n: int, nu: mpmath.mpf, shear: mpmath.mpf, r: mpmath.mpf, inner: mpmath.mpf, outer: mpmath.mpf) -> list:
    """u_r, u_φ, r σ_rr, r σ_rφ of the four powers of r, those that grow relative to `outer`, the others to `inner`."""
    if n == 0:  # the two powers without u_φ stand in for it, uncoupled
        two = [[r, r**-2], [2 * shear * (1 + nu) / (1 - 2 * nu) * r, -4 * shear * r**-2]]
        return [[*two[0], 0, 0], [0, 0, r, r**-2], [*two[1], 0, 0], [0, 0, r, -(r**-2)]]
    A = ((n + 1) * (n - 2 + 4 * nu), n + 5 - 4 * nu, (n + 1) * (n * n - n - 2 - 2 * nu), n * n + 2 * n - 1 + 2 * nu)
    B = (n, 1, n * (n - 1), n - 1)
    C = (n * (n + 3 - 4 * nu), 4 - 4 * nu - n, -n * (n * n + 3 * n - 2 * nu), n * n - 2 + 2 * nu)
    D = (-(n + 1), 1, (n + 1) * (n + 2), -(n + 2))
    size = ((r / outer) ** (n + 1), (r / outer) ** (n - 1), (inner / r) ** n, (inner / r) ** (n + 2))
    unit = (1, 1, 2 * shear, 2 * shear)
    return [[part[row] * unit[row] * scale for part, scale in zip((A, B, C, D), size, strict=True)] for row in range(4)]


def reference(socket: Socket, n: int | mpmath.mpf) -> mpmath.mpf:
    """c_n from one linear system for the constants of all layers, with 50 digits; n may lie between integers."""
    with mpmath.workdps(50):
        radii = [mpmath.mpf(socket.radius)]
        for shell in socket.shells:
            radii.append(radii[-1] + mpmath.mpf(min(shell.thickness, 1e20 * socket.radius)))

        def layer(number: int, r: mpmath.mpf) -> list:
            young, nu = (mpmath.mpf(value) for value in (socket.shells[number].young, socket.shells[number].poisson))
            return powers(n, nu, young / (2 * (1 + nu)), r, radii[number], radii[number + 1])

        count = len(socket.shells)
        rows = [row + [0] * (4 * count - 4) for row in layer(0, radii[0])[2:]]
        for number in range(count - 1):
            here, there = layer(number, radii[number + 1]), layer(number + 1, radii[number + 1])
            pad = [0] * (4 * number), [0] * (4 * (count - number - 2))
            rows += [[*pad[0], *a, *(-x for x in b), *pad[1]] for a, b in zip(here, there, strict=True)]
        last = layer(count - 1, radii[-1])
        if socket.support is Support.FIXED or socket.shells[-1].thickness == inf:
            ends = last[:2]
        elif n == 1:
            u_r, u_phi, s_rr, s_rphi = last
            ends = [[a + 2 * b for a, b in zip(u_r, u_phi, strict=True)]]
            ends += [[a - b for a, b in zip(s_rr, s_rphi, strict=True)]]
        else:
            ends = last[2:]
        rows += [[0] * (4 * count - 4) + row for row in ends]
        load = [-radii[0]] + [0] * (4 * count - 1)
        scales = [max(abs(x) for x in row) for row in rows]
        matrix = mpmath.matrix([[x / scale for x in row] for row, scale in zip(rows, scales, strict=True)])
        sides = mpmath.matrix([x / scale for x, scale in zip(load, scales, strict=True)])
        constants = mpmath.lu_solve(matrix, sides)
        return sum(a * b for a, b in zip(layer(0, radii[0])[0], constants[:4], strict=True))


@BOTH_SUPPORTS
@pytest.mark.parametrize("poisson", POISSON)
@pytest.mark.parametrize("ratio", [0.0, *RATIOS])
def test_compliances_of_a_single_layer_have_twelve_digits(ratio, poisson, support):
    socket, n = single(ratio, poisson, support), np.array(DEGREES[::2])
    expected = np.array([float(reference(socket, degree)) for degree in n.tolist()])
    np.testing.assert_allclose(socket.compliance(n), expected, rtol=5e-13)
    assert socket.asymptote == pytest.approx(2 * (1 - poisson**2) * 18.0 / 1000.0)
    np.testing.assert_allclose(socket.excess(n), expected * (n + 0.5) / socket.asymptote - 1, rtol=5e-13, atol=1e-14)


@pytest.mark.parametrize(
    "shells",
    [
        CUP.shells,
        (METAL, LINER, CEMENT),
        (LINER, METAL, Shell(thickness=8.0, young=500.0, poisson=0.4)),
        (Shell(thickness=0.2, young=1000.0, poisson=0.4999), CEMENT, BONE),
        (METAL, Shell(thickness=0.1, young=1.0, poisson=0.4999), METAL),
    ],
)
@BOTH_SUPPORTS
def test_compliances_of_several_layers_have_twelve_digits(shells, support):
    socket, n = Socket(radius=18.0, shells=shells, support=support), np.array(DEGREES)
    expected = np.array([float(reference(socket, degree)) for degree in DEGREES])
    np.testing.assert_allclose(socket.compliance(n), expected, rtol=1e-12)
    excess = expected * (n + 0.5) / socket.asymptote - 1
    np.testing.assert_allclose(socket.excess(n), excess, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("back", [Support.FIXED, Support.FREE, BONE, Shell(thickness=inf, young=1.0, poisson=0.2)])
@pytest.mark.parametrize("ratio", [0.05, 1.0, 10.0])
def test_a_socket_is_massive_beyond_its_reach(ratio, back):
    shell = liner(ratio, 0.4)
    socket = single(ratio, 0.4, back) if isinstance(back, Support) else Socket(radius=18.0, shells=(shell, back))
    for tolerance in (1e-3, 1e-6, 1e-12):
        n = np.arange(socket.backing_degree(tolerance), socket.backing_degree(1e-17) + 5)
        assert abs(socket.excess(n) - massive(shell).excess(n)).max() <= tolerance
    n = np.arange(socket.backing_degree(1e-17), 3000)
    np.testing.assert_array_equal(socket.compliance(n), massive(shell).compliance(n))
    assert massive(shell).backing_degree() == 0


@pytest.mark.parametrize("body", [massive(LINER), LINED, ElasticBall(radius=18.0, young=1000.0, poisson=0.4)], ids=repr)
def test_the_remainder_of_an_expansion_has_the_next_order(body):
    n = np.array([100, 200]) if body is LINED else np.array([40, 80])
    for order in (1, 2, 3, 4):
        series = ((n[:, None] + 0.5) ** -np.arange(1.0, order + 1)) @ body.expansion(order)
        left = abs(body.excess(n) - series)
        assert np.log(left[0] / left[1]) / np.log((n[1] + 0.5) / (n[0] + 0.5)) == pytest.approx(order + 1, abs=0.1)
    full = ((n[:, None] + 0.5) ** -np.arange(1.0, 31)) @ body.expansion(30)
    np.testing.assert_allclose(body.excess(n), full, rtol=1e-13)


LAYERED = [
    Socket(radius=18.0, shells=(LINER, METAL, CEMENT)),
    Socket(radius=18.0, shells=(LINER, CEMENT), support=Support.FREE),
    CUP,
]
SOME = np.array([0, 2, 5, 40, 300, 1])


@pytest.mark.parametrize("socket", LAYERED, ids=["fixed", "free", "infinite"])
def test_fields_balance_the_load_in_the_bore_and_pass_through_the_interfaces(socket):
    bore = socket.fields(SOME, 18.0)
    np.testing.assert_allclose(bore.u_r[:, 0], socket.compliance(SOME), rtol=1e-11)
    np.testing.assert_allclose(bore.sigma_rr, -1.0, rtol=1e-12)
    np.testing.assert_allclose(bore.sigma_rphi, 0.0, atol=1e-12)
    interfaces = np.cumsum([18.0, *(shell.thickness for shell in socket.shells)])[1:-1]
    before, behind = socket.fields(SOME, interfaces), socket.fields(SOME, interfaces * (1 + 1e-11))
    for name in ("u_r", "u_phi", "sigma_rr", "sigma_rphi"):
        one, other = getattr(before, name), getattr(behind, name)
        np.testing.assert_allclose(one, other, rtol=1e-7, atol=1e-9 * abs(one).max(), err_msg=name)
    assert (abs(before.sigma_phiphi / behind.sigma_phiphi - 1) > 0.1).all()


def test_fields_satisfy_the_conditions_of_the_support():
    """At n = 1 a free socket is held by (4π/3) R2² of net force on 4π b² of surface, which as a whole does not move."""
    fixed, free, infinite = (socket.fields(SOME, r) for socket, r in zip(LAYERED, (29.75, 26.75, 1e9), strict=True))
    for displacement in (fixed.u_r, fixed.u_phi, infinite.u_r, infinite.u_phi):
        np.testing.assert_allclose(displacement, 0.0, atol=1e-10)
    for stress in (free.sigma_rr, free.sigma_rphi):
        np.testing.assert_allclose(stress[:-1], 0.0, atol=1e-13)  # all but n = 1
    for name in ("sigma_rr", "sigma_rphi", "sigma_phiphi", "sigma_thetatheta", "sigma_cot"):
        np.testing.assert_allclose(getattr(infinite, name), 0.0, atol=1e-13)
    end = Socket(radius=18.0, shells=(LINER, METAL), support=Support.FREE).fields([1], 27.75)
    traction = -(18.0**2) / (3 * 27.75**2)
    assert end.sigma_rr == pytest.approx(traction, rel=1e-12)
    assert end.sigma_rphi == pytest.approx(traction, rel=1e-12)
    assert end.u_r + 2 * end.u_phi == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("poisson", [-0.3, 0.3, 0.4999])
@BOTH_SUPPORTS
def test_fields_are_in_equilibrium_and_obey_hookes_law(support, poisson):
    socket, n = single(2.0, poisson, support), np.array([0, 1, 2, 7, 30])
    r, step = np.linspace(18.5, 26.5, 9), 1e-3

    def slope(name: str) -> np.ndarray:
        near, far = (
            (getattr(socket.fields(n, r + h), name) - getattr(socket.fields(n, r - h), name)) / (2 * h)
            for h in (step, 2 * step)
        )
        return (4 * near - far) / 3

    f, N = socket.fields(n, r), (n * (n + 1))[:, None]
    hoop = f.sigma_phiphi + f.sigma_thetatheta
    same = partial(np.testing.assert_allclose, rtol=1e-8)
    same(slope("sigma_rr"), (hoop - 2 * f.sigma_rr + N * f.sigma_rphi) / r, atol=1e-8)
    same(slope("u_r"), (f.sigma_rr - poisson * hoop) / 1000.0, atol=1e-11)
    # slopes of σ_rφ and u_φ have no meaning at n = 0
    same(slope("sigma_rphi")[1:], -((3 * f.sigma_rphi + f.sigma_phiphi + f.sigma_cot) / r)[1:], atol=1e-8)
    twist = 2 * (1 + poisson) / 1000.0 * f.sigma_rphi + (f.u_phi - f.u_r) / r
    same(slope("u_phi")[1:], twist[1:], atol=1e-11)
    strain = (f.sigma_thetatheta - poisson * (f.sigma_rr + f.sigma_phiphi)) / 1000.0  # times P; the cotangents apart
    same(strain, f.u_r / r, rtol=1e-9, atol=1e-12)
    same(f.sigma_cot, 1000.0 / (1 + poisson) * f.u_phi / r, rtol=1e-12)


@pytest.mark.parametrize("poisson", [*POISSON, 0.5])
def test_compliances_of_a_ball_have_the_reference_values(poisson):
    ball = ElasticBall(radius=17.9, young=1000.0, poisson=poisson)
    c = ball.compliance(np.arange(20_001))
    assert c[0] == pytest.approx((1 - 2 * poisson) * 17.9 / 1000.0, rel=1e-14)
    assert c[1] == 0.0
    assert (c[2:] > 0).all()
    assert ball.asymptote == pytest.approx(2 * (1 - poisson**2) * 17.9 / 1000.0)
    n = np.array([0, 1, 2, 50])
    np.testing.assert_allclose(ball.excess(n), c[n] * (n + 0.5) / ball.asymptote - 1, rtol=1e-11, atol=1e-15)
    for n in (2, 3, 10, 400):
        nu, one = mpmath.mpf(poisson), mpmath.mpf(1)
        u_r, _, s_rr, s_rphi = powers(n, nu, 1000 / (2 * (1 + nu)), one, one, one)
        share = -s_rphi[0] / s_rphi[1]
        expected = 17.9 * (u_r[0] + u_r[1] * share) / (s_rr[0] + s_rr[1] * share)
        assert c[n] == pytest.approx(float(expected), rel=1e-12)


test_messages_state_the_allowed_values = refused_calls(
    (lambda: Shell(thickness=0.0, young=1.0, poisson=0.3), "thickness = 0 is not allowed"),
    (lambda: Shell(thickness=1.0, young=inf, poisson=0.3), "young = inf is not allowed"),
    (lambda: ElasticBall(radius=1.0, young=1.0, poisson=0.51), "poisson = 0.51 is not allowed"),
    (lambda: ElasticBall(radius=0.0, young=1.0, poisson=0.3), "radius = 0 is not allowed"),
    (lambda: Socket(radius=18.0, shells=()), "at least one layer"),
    (lambda: Socket(radius=18.0, shells=(BONE, LINER)), "only the outermost layer may be infinite"),
    (lambda: LINED.compliance([2, -1]), r"degrees\[1\] = -1 is not allowed"),
    (lambda: LINED.fields([2], [17.9, 18.0]), r"radii\[0\] = 17.9 is not allowed: .* r = 18 to 24.75 mm"),
    (lambda: LINED.backing_degree(0.0), "tolerance = 0 is not allowed"),
    (lambda: LINED.compliance([0.5]), "degrees must be integers, got an array of float64"),
    error=(ValueError, TypeError),
)
