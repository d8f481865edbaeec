"""Modal compliances of a layered spherical socket and of a solid ball.

A frictionless pressure p_n P_n(cos φ) moves the loaded surface by c_n p_n P_n(cos φ) along the radius, away from the
pressure: c_n is the modal compliance, in mm/MPa. For balls and infinite sockets it is rational in n; layers are solved
one by one, see `waves`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, inf, isinf, log, log1p

import numpy
from numpy.typing import ArrayLike

from ...core.arrays import Numbers
from ...core.checks import require
from ...core.quantities import MATERIAL
from ...problem import Joint, Support
from .waves import UNIT, SupportedLayer, free_surface_condition


@dataclass(frozen=True, kw_only=True)
class Shell:
    """Spherical layer of a socket."""

    thickness: float  # in mm, positive; `inf` for the last layer of a massive socket
    young: float  # Young's modulus E in MPa, positive
    poisson: float  # Poisson's ratio, above -1 and at most 0.5

    def __post_init__(self) -> None:
        require("thickness", self.thickness, self.thickness > 0, "the thickness of a layer (mm) is above 0")
        _check_material(self.young, self.poisson)


@dataclass(frozen=True, kw_only=True, eq=False)
class Fields:
    """Displacements and stresses of each mode inside a socket, per unit of p_n: rows are degrees, columns are radii.

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
    """Spherical socket of elastic layers that are bonded to each other.

    Examples
    --------
    >>> liner = Shell(thickness=6.75, young=1000.0, poisson=0.4)
    >>> Socket(radius=18.0, shells=(liner,)).compliance([0, 1, 2]).round(8)
    array([0.00330432, 0.0034047 , 0.00351705])
    """

    radius: float  # R2 of the bore in mm
    shells: tuple[Shell, ...]  # from the bore outwards; only the last may be infinite
    # outermost surface: FIXED (default) or FREE of traction. An infinite last layer is fixed at infinity. The
    # mode n = 1 has a net force, which a free surface does not balance. A traction on the outermost surface with
    # uniform size and direction then carries it. Displacements are counted from the mean translation of that
    # surface.
    support: Support = Support.FIXED

    def __post_init__(self) -> None:
        _check_radius(self.radius)
        require("number of shells", len(self.shells), len(self.shells) > 0, "a socket has at least one layer")
        thickest_inner = max((shell.thickness for shell in self.shells[:-1]), default=0.0)
        require("thickness", thickest_inner, thickest_inner < inf, "only the outermost layer may be infinite")

    @property
    def asymptote(self) -> float:
        """Compliance C in mm/MPa, the limit of c_n (n + ½): 2 (1 - ν²) R2/E of the innermost layer."""
        return 2 * (1 - self.shells[0].poisson ** 2) * self.radius / self.shells[0].young

    def compliance(self, degrees: ArrayLike) -> numpy.ndarray:
        """Compute the modal compliances c_n in mm/MPa: the pressure p_n P_n widens the bore by c_n p_n P_n."""
        n, nu = _check_degrees(degrees), self.shells[0].poisson
        P = 2 * (1 - nu) * n * n + (4 - 5 * nu) * n + (1 - nu)
        Q = (n + 2) * (n * n + n + 1 - nu * (2 * n + 1))
        c = numpy.asarray(self.asymptote / (2 * (1 - nu)) * P / Q)
        layered = n < self.backing_degree(_NEGLIGIBLE)
        if layered.any():
            c[layered] = -self.radius * self._supported_layers(n[layered])[0].compliance[0, 0]
        return c

    def excess(self, degrees: ArrayLike) -> numpy.ndarray:
        """Compute the relative excess of each modal compliance over its limit, ρ_n = c_n (n + ½)/C - 1."""
        n = _check_degrees(degrees)
        rho = homogeneous_excess(n + 0.5, self.shells[0].poisson)
        layered = n < self.backing_degree(_NEGLIGIBLE)
        if layered.any():
            correction = self._supported_layers(n[layered])[0].layer_correction[0, 0]
            rho[layered] -= self.radius * correction * (n[layered] + 0.5) / self.asymptote
        return rho

    def expansion(self, order: int) -> numpy.ndarray:
        """Compute the coefficients a_1, ..., a_order of the asymptotic series ρ_n ~ Σ a_j (n + ½)^-j.

        They are those of an infinite socket of the innermost material, whose series converges for n >= 2. The
        contribution of the layers is exponentially small, see `backing_degree`.
        """
        return homogeneous_expansion(self.shells[0].poisson, order)

    def backing_degree(self, tolerance: float = 1e-12) -> int:
        """Compute the degree n from which the backing of the liner changes ρ_n by less than `tolerance`."""
        require("tolerance", tolerance, 0 < tolerance < 1, "a tolerance must lie between 0 and 1")
        shell = self.shells[0]
        if isinf(shell.thickness):
            return 0
        # The backing is between rigid and absent. A plane layer then departs by up to
        # [(1 + 2x)² + k0²] exp(-2x), x = n ln(1 + L/R2), k0 = 3 - 4ν; curvature takes less than one degree more.
        k0 = 3 - 4 * shell.poisson
        x = 1.0
        for _ in range(20):
            x = max(1.0, log(((1 + 2 * x) ** 2 + k0 * k0) / tolerance) / 2)
        return ceil(x / log1p(shell.thickness / self.radius)) + 2

    def fields(self, degrees: ArrayLike, radii: ArrayLike) -> Fields:
        """Compute displacements and stresses of each mode at radii (mm) of at least R2, per unit of p_n.

        Where two layers meet, the hoop stresses are those of the inner one.
        """
        n, r = numpy.atleast_1d(_check_degrees(degrees)), numpy.atleast_1d(numpy.asarray(radii, dtype=float))
        bounds = self._interface_radii
        inside = (r >= bounds[0] * (1 - _ROUNDING)) & (r <= bounds[-1] * (1 + _ROUNDING))
        require("radii", r, inside, f"the socket reaches from r = {bounds[0]:g} to {bounds[-1]:g} mm")
        r = numpy.clip(r, bounds[0], bounds[-1])
        layer_of = numpy.maximum(numpy.searchsorted(bounds, r) - 1, 0)
        load = numpy.stack([-self.radius + 0 * n, 0 * n])[:, None]
        values = numpy.empty((7, len(n), len(r)))
        for number, layer in enumerate(self._supported_layers(n)):
            columns = layer_of == number
            values[:, :, columns] = layer.fields(load, r[columns])
            load = layer.outer_traction(load)
        return Fields(**dict(zip(Fields.__dataclass_fields__, values, strict=True)))

    @property
    def _interface_radii(self) -> numpy.ndarray:
        """Radii in mm of the bore, of the interfaces and of the outermost surface."""
        return numpy.cumsum([self.radius, *(shell.thickness for shell in self.shells)])

    def _supported_layers(self, n: numpy.ndarray) -> list[SupportedLayer]:
        """Return the layers from the bore outwards, each with the condition that its backing imposes."""
        is_free = self.support is Support.FREE and not isinf(self.shells[-1].thickness)
        condition = free_surface_condition(n) if is_free else (UNIT, 0 * UNIT)  # u = 0
        layers: list[SupportedLayer] = []
        for shell, inner in zip(self.shells[::-1], self._interface_radii[-2::-1], strict=True):
            if layers:
                condition = UNIT, -layers[0].compliance
            layers.insert(0, SupportedLayer(**vars(shell), inner=float(inner), n=n, condition=condition))
        return layers


@dataclass(frozen=True, kw_only=True)
class ElasticBall:
    """Solid elastic ball.

    The mode n = 1 has a net force. Any balancing load of the mode n = 1, such as a uniform body force, moves the
    surface along the radius by a multiple of cos φ, as a translation does. So c_1 = 0 by definition. The position of
    the ball is that of the sphere that fits its deformed surface best.

    Examples
    --------
    >>> ElasticBall(radius=17.9, young=1000.0, poisson=0.4).compliance([0, 1, 2]).round(8)
    array([0.00358 , 0.      , 0.015036])
    """

    radius: float  # R1 in mm
    # E in MPa and ν
    young: float
    poisson: float

    def __post_init__(self) -> None:
        _check_radius(self.radius)
        _check_material(self.young, self.poisson)

    @property
    def asymptote(self) -> float:
        """Compliance C in mm/MPa, the limit of c_n (n + ½): 2 (1 - ν²) R1/E."""
        return 2 * (1 - self.poisson**2) * self.radius / self.young

    def compliance(self, degrees: ArrayLike) -> numpy.ndarray:
        """Compute the modal compliances c_n in mm/MPa: a pressure p_n P_n moves the surface inwards by c_n p_n P_n."""
        n, nu = _check_degrees(degrees), self.poisson
        rigid = n == 1
        P = 2 * (1 - nu) * n * n + nu * n - (1 - 2 * nu)
        Q = (n - 1 + rigid) * (n * n + n + 1 + nu * (2 * n + 1))
        return numpy.where(rigid, 0.0, self.asymptote / (2 * (1 - nu)) * P / Q)

    def excess(self, degrees: ArrayLike) -> numpy.ndarray:
        """Compute the relative excess of each modal compliance over its limit, ρ_n = c_n (n + ½)/C - 1."""
        n = _check_degrees(degrees)
        rigid = n == 1
        return numpy.where(rigid, -1.0, homogeneous_excess(-(n + rigid + 0.5), self.poisson))

    def expansion(self, order: int) -> numpy.ndarray:
        """Compute the coefficients a_1, ..., a_order of ρ_n = Σ a_j (n + ½)^-j, which converges for n >= 2."""
        return homogeneous_expansion(self.poisson, order) * (-1.0) ** numpy.arange(1, order + 1)


def socket_of(joint: Joint) -> Socket:
    """Make the socket of a joint of plain numbers from its liner, backing and support.

    Examples
    --------
    >>> import ballsocket as bs
    >>> socket_of(bs.joints["hip-28"]).shells
    (Shell(thickness=5.0, young=1000.0, poisson=0.4),)
    """
    layers = [(joint.liner_thickness, joint.liner), *((layer.thickness, layer.material) for layer in joint.backing)]
    shells = (
        Shell(thickness=float(thickness), young=float(material.young), poisson=float(material.poisson))
        for thickness, material in layers
    )
    return Socket(radius=float(joint.socket_radius), shells=tuple(shells), support=joint.support)


def ball_of(joint: Joint) -> ElasticBall | None:
    """Make the elastic ball of a joint of plain numbers; None if the ball is rigid."""
    if joint.ball is None:
        return None
    return ElasticBall(
        radius=float(joint.ball_radius), young=float(joint.ball.young), poisson=float(joint.ball.poisson)
    )


_NEGLIGIBLE = 1e-17  # contribution of the layers to ρ_n
_ROUNDING = 1e-12  # relative rounding error of a radius


def _check_radius(radius: float) -> None:
    require("radius", radius, 0 < radius < inf, "a radius (mm) is above 0 and finite")


def _check_material(young: float, poisson: float) -> None:
    MATERIAL["young"].check(young)
    MATERIAL["poisson"].check(poisson)


def _check_degrees(degrees: ArrayLike) -> numpy.ndarray:
    n = numpy.asarray(degrees)
    if n.dtype.kind not in "iu":
        raise TypeError(f"degrees must be integers, got an array of {n.dtype}")
    require("degrees", n, n >= 0, "a degree must be 0 or more")
    return n.astype(float)


def _excess_polynomials(nu: float) -> tuple[list[float], list[float]]:
    """Compute numerator and denominator of ρ_n in an infinite socket, in falling powers of q = n + ½.

    The numerator begins with q², the denominator with q³. A ball has -q in place of q.
    """
    numerator = [-((1 - 2 * nu) ** 2) / (2 * (1 - nu)), -(4 - 17 * nu + 12 * nu**2) / (4 * (1 - nu)), -9 / 8]
    denominator = [1.0, 3 / 2 - 2 * nu, 3 / 4 - 3 * nu, 9 / 8]  # (q + 3/2)(q² - 2νq + 3/4)
    return numerator, denominator


def homogeneous_excess(q: Numbers, nu: float) -> Numbers:
    """Compute ρ_n = c_n (n + ½)/C - 1 of an infinite socket at q = n + ½, or of a ball at q = -(n + ½)."""
    numerator, _ = _excess_polynomials(nu)
    return numpy.asarray(numpy.polyval(numerator, q) / ((q + 1.5) * (q * (q - 2 * nu) + 0.75)))


def homogeneous_expansion(nu: float, order: int) -> Numbers:
    """Compute the coefficients a_1, ..., a_order of ρ_n in powers of 1/q, for an infinite socket."""
    numerator, denominator = _excess_polynomials(nu)
    a = [0.0, 0.0, 0.0]
    for j in range(order):
        earlier = denominator[1] * a[-1] + denominator[2] * a[-2] + denominator[3] * a[-3]
        a.append((numerator[j] if j < 3 else 0.0) - earlier)
    return numpy.array(a[3:])
