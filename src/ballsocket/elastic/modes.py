"""How far the surfaces of a layered spherical socket and of a solid ball give way to each mode of pressure.

A frictionless pressure p_n P_n(cos φ) moves the loaded surface by c_n p_n P_n(cos φ) along the radius, away from the
pressure: c_n is the modal compliance, in mm/MPa. For balls and infinite sockets it is rational in n. In a layer, the
displacements (u_r times P_n and u_φ times dP_n/dφ) and the tractions (r σ_rr and r σ_rφ) are sums of four powers of
r. The two that grow with r make up one wave, the two that decay another. Either wave is known from its two
displacements u at one radius: with κ < 1 the ratio to another radius and h = (1 - κ²)/2,

    r^(n+1), r^(n-1):       κ^(n-1) (1 - h N+) u  is left of u further inwards,    r σ = K+ u,
    r^-n, r^-(n+2):         κ^n (1 - h N-) u      is left of u further outwards,   r σ = K- u,

where the 2×2 matrices N and K are rational in n. No power ever grows, and K+ and K- stay well apart at any degree and
thickness. Each layer, from the outermost inwards, turns the condition on its outer surface into u = S r σ on its
inner one.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from math import ceil, expm1, inf, isinf, log, log1p

import numpy
from numpy.typing import ArrayLike

from ..checks import require

Matrix = numpy.ndarray
"""2×2 for each degree, shape (2, 2, degrees); a pair of displacements or tractions is (2, 1, degrees)."""


class Support(Enum):
    """What holds the outermost surface of a socket."""

    FIXED = "fixed"
    FREE = "free"


@dataclass(frozen=True, kw_only=True)
class Shell:
    """One layer of a socket.

    Parameters
    ----------
    thickness : float
        In mm, positive; `inf` for the last layer of a massive socket.
    young : float
        Young's modulus E in MPa, positive.
    poisson : float
        Poisson's ratio, above -1 and at most 0.5.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.
    """

    thickness: float
    young: float
    poisson: float

    def __post_init__(self) -> None:
        require("thickness", self.thickness, self.thickness > 0, "the thickness of a layer (mm) is above 0")
        _check_material(self.young, self.poisson)


@dataclass(frozen=True, kw_only=True, eq=False)
class Fields:
    """What each mode does inside a socket, per unit of p_n: rows are degrees, columns are radii.

    With P = P_n(cos φ) and P' = dP/dφ, the sums over n of p_n times

        u_r P,   u_phi P',   sigma_rr P,   sigma_rphi P',
        sigma_phiphi P - sigma_cot cot φ P',   sigma_thetatheta P + sigma_cot cot φ P'

    are u_r, u_φ in mm and σ_rr, σ_rφ, σ_φφ, σ_θθ in MPa, tension positive. At φ = 0, cot φ P' is -n (n + 1)/2.
    """

    u_r: numpy.ndarray
    u_phi: numpy.ndarray
    sigma_rr: numpy.ndarray
    sigma_rphi: numpy.ndarray
    sigma_phiphi: numpy.ndarray
    sigma_thetatheta: numpy.ndarray
    sigma_cot: numpy.ndarray


@dataclass(frozen=True, kw_only=True)
class Socket:
    """A spherical bore in layers that are bonded to each other.

    Parameters
    ----------
    radius : float
        R2 of the bore in mm.
    shells : tuple of Shell
        From the bore outwards; only the last may be infinite.
    support : Support
        The outermost surface: FIXED (default) or FREE of traction. An infinite last layer is at rest at infinity.

        The mode n = 1 has a net force, which a free surface does not balance. It is then carried by a traction on the
        outermost surface that has the same size and direction everywhere, and displacements are counted from the
        mean translation of that surface.

    Raises
    ------
    ValueError
        No layer, an infinite one inside, or a radius that is not positive.

    Examples
    --------
    >>> liner = Shell(thickness=6.75, young=1000.0, poisson=0.4)
    >>> Socket(radius=18.0, shells=(liner,)).compliance([0, 1, 2]).round(8)
    array([0.00330432, 0.0034047 , 0.00351705])
    """

    radius: float
    shells: tuple[Shell, ...]
    support: Support = Support.FIXED

    def __post_init__(self) -> None:
        _check_radius(self.radius)
        require("number of shells", len(self.shells), len(self.shells) > 0, "a socket has at least one layer")
        inside = max((shell.thickness for shell in self.shells[:-1]), default=0.0)
        require("thickness", inside, inside < inf, "only the outermost layer may be infinite")

    @property
    def asymptote(self) -> float:
        """C, the limit of c_n (n + ½): 2 (1 - ν²) R2/E of the innermost layer."""
        return _asymptote(self.radius, self.shells[0].young, self.shells[0].poisson)

    def compliance(self, degrees: ArrayLike) -> numpy.ndarray:
        """c_n in mm/MPa: the pressure p_n P_n widens the bore by c_n p_n P_n."""
        n, nu = _checked(degrees), self.shells[0].poisson
        P = 2 * (1 - nu) * n * n + (4 - 5 * nu) * n + (1 - nu)
        Q = (n + 2) * (n * n + n + 1 - nu * (2 * n + 1))
        c = numpy.asarray(self.asymptote / (2 * (1 - nu)) * P / Q)
        near = n < self.reach(_NOTHING)
        if near.any():
            c[near] = -self.radius * self._layers(n[near])[0].compliance[0, 0]
        return c

    def excess(self, degrees: ArrayLike) -> numpy.ndarray:
        """ρ_n = c_n (n + ½)/C - 1."""
        n = _checked(degrees)
        rho = _massive_excess(n + 0.5, self.shells[0].poisson)
        near = n < self.reach(_NOTHING)
        if near.any():
            share = self._layers(n[near])[0].share[0, 0]
            rho[near] -= self.radius * share * (n[near] + 0.5) / self.asymptote
        return rho

    def expansion(self, order: int) -> numpy.ndarray:
        """a_1, ..., a_order of ρ_n ~ Σ a_j (n + ½)^-j: the series of the infinite socket of the innermost material.

        That series converges for n >= 2; what the layers add to it is exponentially small, see `reach`.
        """
        return _series(self.shells[0].poisson, order)

    def reach(self, tolerance: float = 1e-12) -> int:
        """The degree from which ρ_n is, within `tolerance`, that of the infinite socket of the innermost material."""
        require("tolerance", tolerance, 0 < tolerance < 1, "a tolerance lies between 0 and 1")
        shell = self.shells[0]
        if isinf(shell.thickness):
            return 0
        # What lies behind the layer is between rigid and absent. A plane layer then departs by up to
        # [(1 + 2x)² + k0²] exp(-2x), x = n ln(1 + L/R2), k0 = 3 - 4ν; curvature takes less than one degree more.
        k0 = 3 - 4 * shell.poisson
        x = 1.0
        for _ in range(20):
            x = max(1.0, log(((1 + 2 * x) ** 2 + k0 * k0) / tolerance) / 2)
        return ceil(x / log1p(shell.thickness / self.radius)) + 2

    def fields(self, degrees: ArrayLike, radii: ArrayLike) -> Fields:
        """Displacements and stresses of each mode at radii >= R2, per unit of p_n.

        Where two layers meet, the hoop stresses are those of the inner one.

        Raises
        ------
        ValueError
            A radius in the bore or beyond the outermost surface.
        """
        n, r = numpy.atleast_1d(_checked(degrees)), numpy.atleast_1d(numpy.asarray(radii, dtype=float))
        bounds = self._bounds
        good = (r >= bounds[0] * (1 - _ROUNDING)) & (r <= bounds[-1] * (1 + _ROUNDING))
        require("radii", r, good, f"the socket reaches from r = {bounds[0]:g} to {bounds[-1]:g} mm")
        r = numpy.clip(r, bounds[0], bounds[-1])
        layer_of = numpy.maximum(numpy.searchsorted(bounds, r) - 1, 0)
        load = numpy.stack([-self.radius + 0 * n, 0 * n])[:, None]
        whole = numpy.empty((7, len(n), len(r)))
        for number, layer in enumerate(self._layers(n)):
            here = layer_of == number
            whole[:, :, here] = layer.fields(load, r[here])
            load = layer.passed_on(load)
        return Fields(**dict(zip(Fields.__dataclass_fields__, whole, strict=True)))

    @property
    def _bounds(self) -> numpy.ndarray:
        """The radii of the bore, of the interfaces and of the outermost surface."""
        return numpy.cumsum([self.radius, *(shell.thickness for shell in self.shells)])

    def _layers(self, n: numpy.ndarray) -> list[_Layer]:
        """From the bore outwards, each on what is behind it."""
        free = self.support is Support.FREE and not isinf(self.shells[-1].thickness)
        ground = _free(n) if free else _fixed()
        layers: list[_Layer] = []
        for shell, inner in zip(self.shells[::-1], self._bounds[-2::-1], strict=True):
            layers.insert(0, _Layer(shell=shell, inner=float(inner), n=n, ground=ground))
            ground = _UNIT, -layers[0].compliance
        return layers


@dataclass(frozen=True, kw_only=True)
class Ball:
    """A solid elastic ball.

    The mode n = 1 has a net force. Whatever balances it, as long as it is of the mode n = 1 too (a uniform body force,
    say), moves the surface along the radius by a multiple of cos φ, as a translation does. So c_1 = 0 by definition,
    and the position of the ball is that of the sphere that fits its deformed surface best.

    Parameters
    ----------
    radius : float
        R1 in mm.
    young, poisson : float
        E in MPa and ν.

    Raises
    ------
    ValueError
        A number that is not allowed, named with its value.

    Examples
    --------
    >>> Ball(radius=17.9, young=1000.0, poisson=0.4).compliance([0, 1, 2]).round(8)
    array([0.00358 , 0.      , 0.015036])
    """

    radius: float
    young: float
    poisson: float

    def __post_init__(self) -> None:
        _check_radius(self.radius)
        _check_material(self.young, self.poisson)

    @property
    def asymptote(self) -> float:
        """C, the limit of c_n (n + ½): 2 (1 - ν²) R1/E."""
        return _asymptote(self.radius, self.young, self.poisson)

    def compliance(self, degrees: ArrayLike) -> numpy.ndarray:
        """c_n in mm/MPa: the pressure p_n P_n makes the surface retreat by c_n p_n P_n."""
        n, nu = _checked(degrees), self.poisson
        rigid = n == 1
        P = 2 * (1 - nu) * n * n + nu * n - (1 - 2 * nu)
        Q = (n - 1 + rigid) * (n * n + n + 1 + nu * (2 * n + 1))
        return numpy.where(rigid, 0.0, self.asymptote / (2 * (1 - nu)) * P / Q)

    def excess(self, degrees: ArrayLike) -> numpy.ndarray:
        """ρ_n = c_n (n + ½)/C - 1."""
        n = _checked(degrees)
        rigid = n == 1
        return numpy.where(rigid, -1.0, _massive_excess(-(n + rigid + 0.5), self.poisson))

    def expansion(self, order: int) -> numpy.ndarray:
        """a_1, ..., a_order of ρ_n = Σ a_j (n + ½)^-j, which converges for n >= 2."""
        return _series(self.poisson, order) * (-1.0) ** numpy.arange(1, order + 1)


_NOTHING = 1e-17  # of the layers' share in ρ_n
_ROUNDING = 1e-12  # of a radius
_ENDLESS = 100.0  # ln(b/R2) of a layer that counts as infinite
_TINY = 1e-17  # for an incompressible layer at n = 0, which does not give way


def _check_radius(radius: float) -> None:
    require("radius", radius, 0 < radius < inf, "a radius (mm) is above 0 and finite")


def _check_material(young: float, poisson: float) -> None:
    require("young", young, 0 < young < inf, "Young's modulus (MPa) is above 0 and finite")
    require("poisson", poisson, -1 < poisson <= 0.5, "Poisson's ratio lies above -1, up to 0.5")


def _checked(degrees: ArrayLike) -> numpy.ndarray:
    n = numpy.asarray(degrees)
    if n.dtype.kind not in "iu":
        raise TypeError(f"degrees must be integers, got an array of {n.dtype}")
    require("degrees", n, n >= 0, "a degree is 0 or more")
    return n.astype(float)


def _asymptote(radius: float, young: float, poisson: float) -> float:
    return 2 * (1 - poisson**2) * radius / young


def _polynomials(nu: float) -> tuple[list[float], list[float]]:
    """Of ρ in an infinite socket, in falling powers of q = n + ½: the numerator from q², the denominator from q³.

    A ball has -q in place of q.
    """
    above = [-((1 - 2 * nu) ** 2) / (2 * (1 - nu)), -(4 - 17 * nu + 12 * nu**2) / (4 * (1 - nu)), -9 / 8]
    below = [1.0, 3 / 2 - 2 * nu, 3 / 4 - 3 * nu, 9 / 8]  # (q + 3/2)(q² - 2νq + 3/4)
    return above, below


def _massive_excess(q: numpy.ndarray, nu: float) -> numpy.ndarray:
    above, _ = _polynomials(nu)
    return numpy.asarray(numpy.polyval(above, q) / ((q + 1.5) * (q * (q - 2 * nu) + 0.75)))


def _series(nu: float, order: int) -> numpy.ndarray:
    """The quotient of the polynomials in powers of 1/q."""
    above, below = _polynomials(nu)
    a = [0.0, 0.0, 0.0]
    for j in range(order):
        earlier = below[1] * a[-1] + below[2] * a[-2] + below[3] * a[-3]
        a.append((above[j] if j < 3 else 0.0) - earlier)
    return numpy.array(a[3:])


_UNIT: Matrix = numpy.eye(2)[:, :, None]


def _times(a: Matrix, b: Matrix) -> Matrix:
    return a[:, :1] * b[:1] + a[:, 1:] * b[1:]


def _inverse(a: Matrix) -> Matrix:
    return numpy.array([[a[1, 1], -a[0, 1]], [-a[1, 0], a[0, 0]]]) / (a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0])


def _outer(column: tuple[numpy.ndarray, ...], row: tuple[numpy.ndarray, ...]) -> Matrix:
    return numpy.array(column)[:, None] * numpy.array(row)


def _fixed() -> tuple[Matrix, Matrix]:
    """The condition u = 0 as A and B of A u + B r σ = 0."""
    return _UNIT, 0 * _UNIT


def _free(n: numpy.ndarray) -> tuple[Matrix, Matrix]:
    """The same of σ = 0; at n = 1 u_r + 2 u_φ = 0 (no mean translation) and σ_rr = σ_rφ (uniform traction)."""
    A = numpy.zeros((2, 2, len(n)))
    B = A + _UNIT
    first = n == 1
    A[0, :, first], B[0, :, first], B[1, :, first] = (1.0, 2.0), (0.0, 0.0), (1.0, -1.0)
    return A, B


@dataclass(frozen=True, kw_only=True, eq=False)
class _Wave:
    """Displacements that grow, or that decay, with r: N and K of the head of this file, power n - 1 or n."""

    N: Matrix
    K: Matrix
    power: numpy.ndarray

    @classmethod
    def of(cls, n: numpy.ndarray, N: Matrix, K: Matrix, power: numpy.ndarray, alone: int) -> _Wave:
        # n = 0 has one power of r, ±`alone`, and no u_φ: what keeps its place must not mix with u_r, nor be singular
        zero = n == 0
        N[:, :, zero], K[1, 0, zero], K[1, 1, zero] = 0.0, 0.0, K[0, 0, zero]
        return cls(N=N, K=K, power=numpy.where(zero, alone, power))

    def left(self, x: float | numpy.ndarray, u: Matrix) -> Matrix:
        """What is left of u a way x = -ln κ down the wave."""
        return numpy.exp(-self.power * x) * (u + numpy.expm1(-2 * x) / 2 * _times(self.N, u))

    def lost(self, x: float) -> Matrix:
        """The unit matrix less what is left of it, without cancellation."""
        decay = self.power * x
        return -numpy.expm1(-decay) * _UNIT - expm1(-2 * x) / 2 * numpy.exp(-decay) * self.N

    def along(self, x: numpy.ndarray, u: Matrix) -> tuple[Matrix, Matrix]:
        """Displacements and r σ at many places, which are one more axis."""
        wide = _Wave(N=self.N[..., None], K=self.K[..., None], power=self.power[:, None])
        there = wide.left(x, u[..., None])
        return there, _times(wide.K, there)


def _growing_wave(n: numpy.ndarray, shell: Shell) -> _Wave:
    """From r^(n-1), where u = (n, 1), and r^(n+1)."""
    nu, slack = shell.poisson, 1 - 2 * shell.poisson
    below = numpy.maximum(n + slack * (2 * n + 1), _TINY)
    weight = (2 - nu - slack * n) / below
    N = _outer(((n + 1) * (n - 2 + 4 * nu), n + 5 - 4 * nu), (-1 / below, n / below))
    K = (n - 1) * _UNIT + _outer((n + 1, -1 + 0 * n), (weight, -n * weight))
    return _Wave.of(n, N, K * _twice_shear(shell), power=n - 1, alone=1)


def _decaying_wave(n: numpy.ndarray, shell: Shell) -> _Wave:
    """From r^-(n+2), where u = (-n - 1, 1), and r^-n."""
    nu, slack = shell.poisson, 1 - 2 * shell.poisson
    below = n + 1 + slack * (2 * n + 1)
    weight = (3 * (1 - nu) + slack * n) / below
    N = _outer((-n - 1, 1 + 0 * n), ((n - 4 + 4 * nu) / below, n * (n + 3 - 4 * nu) / below))
    K = -(n + 2) * _UNIT + _outer((n, 1 + 0 * n), (weight, (n + 1) * weight))
    return _Wave.of(n, N, K * _twice_shear(shell), power=n, alone=2)


def _twice_shear(shell: Shell) -> float:
    return shell.young / (1 + shell.poisson)


@dataclass(frozen=True, kw_only=True, eq=False)
class _Layer:
    """One layer on its ground, A u + B r σ = 0 on its outer surface, for all degrees at once."""

    shell: Shell
    inner: float
    n: numpy.ndarray
    ground: tuple[Matrix, Matrix]

    @cached_property
    def _growing(self) -> _Wave:
        return _growing_wave(self.n, self.shell)

    @cached_property
    def _decaying(self) -> _Wave:
        return _decaying_wave(self.n, self.shell)

    @cached_property
    def _thickness(self) -> float:
        """ln(b/a) of its two radii."""
        return min(log1p(self.shell.thickness / self.inner), _ENDLESS)

    @cached_property
    def _outwards(self) -> Matrix:
        """What is left of the decaying wave at the outer surface."""
        return self._decaying.left(self._thickness, _UNIT)

    @cached_property
    def _solved_ground(self) -> Matrix:
        A, B = self.ground
        return _inverse(A + _times(B, self._growing.K))

    @cached_property
    def _reflected(self) -> Matrix:
        """The growing wave at the outer surface that answers a unit of the decaying one."""
        A, B = self.ground
        return -_times(self._solved_ground, A + _times(B, self._decaying.K))

    @cached_property
    def _echo(self) -> Matrix:
        """The growing wave at the inner surface that answers a unit of the decaying one there."""
        return self._growing.left(self._thickness, _times(self._reflected, self._outwards))

    @cached_property
    def _sent(self) -> Matrix:
        """The decaying wave at the inner surface, per r σ there."""
        return _inverse(self._decaying.K + _times(self._growing.K, self._echo))

    @cached_property
    def compliance(self) -> Matrix:
        """S, u per r σ on the inner surface."""
        # 1 + echo, which nearly cancels in a thin layer on firm ground: first as if the ground were fixed
        x, yielding = self._thickness, _times(self.ground[1], self._growing.K - self._decaying.K)
        fixed = self._growing.lost(x) + self._growing.left(x, self._decaying.lost(x))
        more = self._growing.left(x, _times(_times(self._solved_ground, yielding), self._outwards))
        return _times(fixed + more, self._sent)

    @cached_property
    def share(self) -> Matrix:
        """S less that of an infinite layer, which is 1/K-."""
        departure = _UNIT - _times(_inverse(self._decaying.K), self._growing.K)
        return _times(departure, _times(self._echo, self._sent))

    def _waves(self, load: Matrix) -> tuple[Matrix, Matrix]:
        """The growing wave at the outer surface and the decaying one at the inner, under r σ on the inner surface."""
        decaying = _times(self._sent, load)
        return _times(self._reflected, _times(self._outwards, decaying)), decaying

    def passed_on(self, load: Matrix) -> Matrix:
        """r σ on the outer surface."""
        growing, decaying = self._waves(load)
        return _times(self._growing.K, growing) + _times(self._decaying.K, _times(self._outwards, decaying))

    def fields(self, load: Matrix, r: numpy.ndarray) -> numpy.ndarray:
        """The seven parts of `Fields` at the radii r, under r σ on the inner surface."""
        growing, decaying = self._waves(load)
        x = numpy.log(r / self.inner)
        grown = self._growing.along(numpy.maximum(self._thickness - x, 0.0), growing)
        decayed = self._decaying.along(x, decaying)
        (u_r, u_phi), (s_rr, s_rphi) = (a[:, 0] + b[:, 0] for a, b in zip(grown, decayed, strict=True))
        # Hooke: hoop strains (u_r P + u_φ P'')/r and (u_r P + u_φ cot φ P')/r, P'' = -n (n + 1) P - cot φ P'
        nu, bent = self.shell.poisson, (self.n * (self.n + 1))[:, None] * u_phi
        stiff = self.shell.young / (1 - nu**2)
        s_phiphi = nu / (1 - nu) * s_rr + stiff * ((1 + nu) * u_r - bent)
        s_thetatheta = nu / (1 - nu) * s_rr + stiff * ((1 + nu) * u_r - nu * bent)
        stresses = (s_rr, s_rphi, s_phiphi, s_thetatheta, _twice_shear(self.shell) * u_phi)
        return numpy.stack([u_r, u_phi, *(s / r for s in stresses)])
