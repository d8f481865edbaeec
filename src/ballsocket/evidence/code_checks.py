"""Code verification: checks of known solutions that run on the present machine."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from importlib.resources import files
from importlib.util import find_spec
from math import cos, inf, log2, sin
from types import MappingProxyType
from typing import Any

import numpy

from ..contact import Model
from ..core.arrays import Numbers
from ..elasticity.exact.model import Exact
from ..elasticity.finite_elements.elasticity import ElasticBlock
from ..elasticity.finite_elements.mesh import Block, mesh_block
from ..elasticity.off_axis.model import Sphere
from ..elasticity.off_axis.surfaces import ClosedShell
from ..models.foundation import RadialFoundation
from ..models.half_space import Hertz, LiuReconstruction, Steuermann
from ..models.kinematics import exact_kinematics
from ..models.modulus import constant
from ..problem import Joint, Material
from ..problem.cup import Cup
from ..problem.gaps import LinearGap
from ..problem.presets import joints


@dataclass(frozen=True, kw_only=True)
class CheckResult:
    """Result of a check.

    Attributes
    ----------
    name, description : str
        Short name, and the observed quantity in words.
    observed : float or None
        Observed value; None for a check that did not run.
    low, high : float
        Allowed values.
    why : str
        Reason for a check that did not run.
    """

    name: str
    description: str
    observed: float | None
    low: float = 0.0
    high: float = inf
    why: str = ""

    @property
    def passed(self) -> bool | None:
        """True for an allowed value; None for a check that did not run."""
        return None if self.observed is None else self.low <= self.observed <= self.high

    def summary(self) -> dict[str, Any]:
        """Return one dictionary for JSON."""
        values = asdict(self) | {"high": None if self.high == inf else self.high, "passed": self.passed}
        call = f"ballsocket.evidence.code_checks.CHECKS[{self.name!r}]()"
        return {"what": values.pop("description"), **values, "call": call}


OWN_TOLERANCE, ORDER_OF_ELEMENTS = "own-tolerance", "order-of-elements"
"""Names of checks that decide a credibility level."""

_K = constant(276.5)
_MODELS: Mapping[str, Model] = {
    "linear": RadialFoundation(modulus=_K),
    "exact": RadialFoundation(modulus=_K, kinematics=exact_kinematics),
    "hertz": Hertz(),
    "steuermann-3": Steuermann(exponent=3),
    "liu": LiuReconstruction(),
}
_HIP = joints["hip-36"]


def check_closed_forms() -> CheckResult:
    """Compare the closed forms with their definitions in 50-digit arithmetic."""
    text = (files("ballsocket") / "data" / "closed_forms.csv").read_text(encoding="utf-8")
    errors = []
    for row in csv.DictReader(line for line in text.splitlines() if not line.startswith("#")):
        if row["model"] in _MODELS:
            clearance = float(row["clearance"])
            liner = Material(young=1000.0, poisson=0.4)
            joint = Joint(ball_radius=18.0 - clearance, clearance=clearance, liner_thickness=6.75, liner=liner)
            contact = _MODELS[row["model"]].press(joint, indentation=float(row["indentation"]))
            for name in ("force", "half_angle", "pole_pressure", "stiffness", "energy"):
                errors.append(abs(float(getattr(contact, name)) / float(row[name]) - 1))
    return CheckResult(
        name="closed-forms",
        description="Largest relative error of five closed forms against their definitions in 50-digit arithmetic, "
        "from d/c = 1e-12 to 1e6 and without clearance",
        observed=float(numpy.max(errors)),
        high=1e-13,
    )


def check_balance() -> CheckResult:
    """Compare the force of the exact solution with the integral of its pressure."""
    contact = Exact().press(_HIP, force=3000.0)
    x, w = numpy.polynomial.legendre.leggauss(60)
    edge = float(contact.half_angle)
    angles = edge * numpy.sin(numpy.pi / 4 * (x + 1))
    weight = edge * numpy.pi / 4 * numpy.cos(numpy.pi / 4 * (x + 1)) * w
    rings = [float(contact.pressure(angle)) * cos(angle) * sin(angle) for angle in angles]
    integral = 2 * numpy.pi * _HIP.socket_radius**2 * float(numpy.dot(rings, weight))
    return CheckResult(
        name="balance",
        description="Force of the exact solution against the integral of its pressures, relative",
        observed=abs(integral / 3000.0 - 1),
        high=1e-6,
    )


def check_slope_of_energy() -> CheckResult:
    """Compare the force of the exact solution with the slope of its energy."""
    d, step = 0.05, 1e-4
    low, middle, high = (Exact().press(_HIP, indentation=d + change) for change in (-step, 0.0, step))
    slope = (float(high.energy) - float(low.energy)) / (2 * step)
    return CheckResult(
        name="slope-of-energy",
        description="Force of the exact solution against the central difference of its energy, relative",
        observed=abs(slope / float(middle.force) - 1),
        high=1e-5,
    )


def check_hertz_limit() -> CheckResult:
    """Compare a narrow contact in a massive socket with Hertz."""
    liner = Material(young=1000.0, poisson=0.3)
    joint = Joint(ball_radius=20.0, clearance=0.05, liner_thickness=inf, liner=liner)
    exact, hertz = (model.press(joint, force=0.001) for model in (Exact(), Hertz()))
    return CheckResult(
        name="hertz-limit",
        description="Largest pressure of a narrow contact in a massive socket against Hertz, relative",
        observed=abs(float(exact.max_pressure) / float(hertz.max_pressure) - 1),
        high=5e-3,
    )


def check_own_tolerance() -> CheckResult:
    """Compare the error of the exact solution with its tolerance."""
    best = Exact(tolerance=1e-9).press(_HIP, force=3000.0)
    ratios = []
    for tolerance in (1e-3, 1e-5):
        contact = Exact(tolerance=tolerance).press(_HIP, force=3000.0)
        error = max(abs(getattr(contact, name) / getattr(best, name) - 1) for name in ("indentation", "max_pressure"))
        ratios.append(float(error) / tolerance)
    return CheckResult(
        name=OWN_TOLERANCE,
        description="Largest error of the exact solution over its required tolerance, at 1e-3 and 1e-5",
        observed=max(ratios),
        high=1.0,
    )


def check_along_the_axis() -> CheckResult:
    """Compare the off-axis solver in a closed shell with the exact solution, for a load along the axis."""
    closed = Sphere(surface=ClosedShell(), gap=LinearGap, cup=Cup())
    sphere, exact = (model.press(_HIP, indentation=0.05) for model in (closed, Exact()))
    return CheckResult(
        name="along-the-axis",
        description="Force of the off-axis solver in a closed shell against the exact solution, along the axis, "
        "relative",
        observed=abs(float(sphere.force) / float(exact.force) - 1),
        high=2e-3,
    )


def _check_elements(name: str, description: str, compute: Callable[[], float], **ends: Any) -> CheckResult:
    """Run a check of the finite elements; state the reason if the extra is not installed."""
    if find_spec("skfem") is None:
        why = "the extra 'fem' is not installed"
        return CheckResult(name=name, description=description, observed=None, why=why, **ends)
    return CheckResult(name=name, description=description, observed=compute(), **ends)


def check_patch_test() -> CheckResult:
    """Compute the error of biquadratic elements in the energy of a uniform strain."""
    description = "Energy of a uniform strain in biquadratic elements, relative error (the patch test)"
    return _check_elements("patch-test", description, lambda: strain_energy_error(2), high=1e-4)


def check_order_of_elements(poisson: float = 0.4) -> CheckResult:
    """Compute the order of convergence of biquadratic elements in displacement, from 8 and 16: 4 in theory."""
    description = f"Observed order of convergence of biquadratic elements: thick sphere under pressure, nu {poisson:g}"
    return _check_elements(
        ORDER_OF_ELEMENTS,
        description,
        lambda: log2(thick_sphere_error(2, 8, poisson) / thick_sphere_error(2, 16, poisson)),
        low=3.8,
    )


# Known solutions for the finite elements

INNER, OUTER = 1.0, 1.4  # inner and outer radius of the sphere of the element checks


def shell_block(order: int, elements: int = 6, poisson: float = 0.3, end: float = numpy.pi / 2) -> ElasticBlock:
    """Create a thick shell with Young's modulus 1 from the axis to a polar angle, with `elements` over the wall."""
    angle, radius = numpy.linspace(0.0, end, 2 * elements + 1), numpy.linspace(INNER, OUTER, elements + 1)
    return ElasticBlock(block=mesh_block(angle, [radius], order), young=numpy.ones(1), poisson=numpy.array([poisson]))


def polar_components(elastic: ElasticBlock, across: Numbers, along: Numbers) -> Numbers:
    """Convert a displacement in ρ and z at the nodes to the unknowns u_φ and u_r."""
    phi = numpy.repeat(elastic.block.angle, elastic.block.radius.shape[1])
    sides = across * numpy.cos(phi) - along * numpy.sin(phi), across * numpy.sin(phi) + along * numpy.cos(phi)
    return numpy.stack(sides, -1).ravel()


def strain_energy_error(order: int) -> float:
    """Compute the relative error of the energy of u_ρ = a ρ, u_z = b z in the meshed volume (patch test)."""
    end, a, b, nu = 1.1, 0.3, -0.2, 0.3
    elastic = shell_block(order, end=end, poisson=nu)
    rho, z = elastic.block.nodes
    displacement = polar_components(elastic, a * rho, b * z)
    G, K = 1 / (2 * (1 + nu)), 1 / (3 * (1 - 2 * nu))
    trace = 2 * a + b
    density = G * (2 * a * a + b * b - trace**2 / 3) + K * trace**2 / 2
    volume = 2 * numpy.pi / 3 * (OUTER**3 - INNER**3) * (1 - numpy.cos(end))
    return float(abs(displacement @ (elastic.stiffness_matrix() @ displacement) / 2 / (density * volume) - 1))


def thick_sphere_error(order: int, elements: int, poisson: float) -> float:
    """Compute the mean relative error of the radial displacement of a pressurised bore with a fixed outside.

    The reference is Bartel's modulus K_B = E/R2 (2(1-2ν) + (1+ν)k³)/((1+ν)(1-2ν)(1-k³)), k = R2/b.
    """
    from scipy.sparse.linalg import spsolve

    elastic = shell_block(order, elements, poisson)
    mesh = elastic.block
    fixed = numpy.zeros(2 * mesh.number.size, dtype=bool)
    fixed[2 * mesh.number[[0, -1]]] = True  # the axis, and the plane of symmetry
    fixed[2 * mesh.number[:, -1]] = fixed[2 * mesh.number[:, -1] + 1] = True
    displacement = numpy.zeros(len(fixed))
    displacement[~fixed] = spsolve(elastic.stiffness_matrix()[~fixed][:, ~fixed], pressure_forces(mesh)[~fixed])
    k = INNER / OUTER
    modulus = (2 * (1 - 2 * poisson) + (1 + poisson) * k**3) / ((1 + poisson) * (1 - 2 * poisson) * (1 - k**3))
    error = displacement[2 * mesh.number[:, 0] + 1] * modulus - 1
    return float(numpy.sqrt(numpy.average(error**2, weights=numpy.sin(mesh.angle))))


def pressure_forces(mesh: Block) -> Numbers:
    """Compute the nodal forces of a unit pressure on the bore, as unknowns u_φ and u_r."""
    x, w = numpy.polynomial.legendre.leggauss(4)
    if mesh.order == 1:
        N, slope = numpy.stack([1 - x, 1 + x]) / 2, numpy.stack([-0.5 + 0 * x, 0.5 + 0 * x])
    else:
        N = numpy.stack([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2])
        slope = numpy.stack([x - 0.5, -2 * x, x + 0.5])
    across, along = numpy.zeros(mesh.number.size), numpy.zeros(mesh.number.size)
    for first in range(0, len(mesh.angle) - 1, mesh.order):
        nodes = mesh.number[first : first + mesh.order + 1, 0]
        rho, z = mesh.nodes[:, nodes]
        ring = 2 * numpy.pi * (rho @ N) * w
        across[nodes] += N @ (ring * -(z @ slope))
        along[nodes] += N @ (ring * (rho @ slope))
    return polar_components(ElasticBlock(block=mesh, young=numpy.ones(1), poisson=numpy.zeros(1)), across, along)


CHECKS: Mapping[str, Callable[[], CheckResult]] = MappingProxyType(
    {
        "closed-forms": check_closed_forms,
        "balance": check_balance,
        "slope-of-energy": check_slope_of_energy,
        "hertz-limit": check_hertz_limit,
        OWN_TOLERANCE: check_own_tolerance,
        "along-the-axis": check_along_the_axis,
        "patch-test": check_patch_test,
        ORDER_OF_ELEMENTS: check_order_of_elements,
    }
)
"""Checks by name."""
