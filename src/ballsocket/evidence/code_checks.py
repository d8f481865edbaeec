"""Code verification, here and now: what the code must reproduce on this machine, each with what was observed."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from importlib.resources import files
from importlib.util import find_spec
from math import cos, inf, log2, sin
from types import MappingProxyType
from typing import Any

import numpy

from ..contact import Model
from ..elasticity.exact.model import Exact
from ..elasticity.off_axis.model import Sphere
from ..elasticity.off_axis.surfaces import ClosedShell
from ..models.foundation import RadialFoundation
from ..models.half_space import Hertz, Steuermann
from ..models.kinematics import exact_kinematics
from ..models.liu import LiuReconstruction
from ..models.modulus import constant
from ..problem import Joint, Material
from ..problem.cup import Cup
from ..problem.gaps import LinearGap
from ..problem.presets import joints


@dataclass(frozen=True, kw_only=True)
class Checked:
    """A check with what was observed and what is allowed.

    Attributes
    ----------
    name, what : str
        Short, and in a sentence.
    observed : float or None
        None where it could not be run; then `why` says so.
    low, high : float
        Between which it may lie.
    """

    name: str
    what: str
    observed: float | None
    low: float = 0.0
    high: float = inf
    why: str = ""

    @property
    def passed(self) -> bool | None:
        """Whether it is as it should be; None where it was not run."""
        return None if self.observed is None else self.low <= self.observed <= self.high

    def summary(self) -> dict[str, Any]:
        """One dictionary for JSON."""
        high = None if self.high == inf else self.high
        return {
            "name": self.name,
            "what": self.what,
            "observed": self.observed,
            "low": self.low,
            "high": high,
            "passed": self.passed,
            "why": self.why,
            "call": f"ballsocket.evidence.code_checks.CHECKS[{self.name!r}]()",
        }


_TABLE = "closed_forms.csv"
_K = constant(276.5)
_MODELS: Mapping[str, Model] = {
    "linear": RadialFoundation(modulus=_K),
    "exact": RadialFoundation(modulus=_K, kinematics=exact_kinematics),
    "hertz": Hertz(),
    "steuermann-3": Steuermann(exponent=3),
    "liu": LiuReconstruction(),
}
_HIP = joints["hip-36"]


def closed_forms() -> Checked:
    """The closed forms against their definitions in 50-digit arithmetic."""
    text = (files("ballsocket") / "data" / _TABLE).read_text(encoding="utf-8")
    table = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    error = max(_off(row) for row in table if row["model"] in _MODELS)
    return Checked(
        name="closed-forms",
        what="Largest relative error of five closed forms against their definitions in 50-digit arithmetic, from d/c = "
        "1e-12 to 1e6 and without clearance",
        observed=error,
        high=1e-13,
    )


def _off(row: Mapping[str, str]) -> float:
    clearance = float(row["clearance"])
    liner = Material(young=1000.0, poisson=0.4)
    joint = Joint(ball_radius=18.0 - clearance, clearance=clearance, liner_thickness=6.75, liner=liner)
    contact = _MODELS[row["model"]].press(joint, indentation=float(row["indentation"]))
    names = ("force", "half_angle", "pole_pressure", "stiffness", "energy")
    return max(abs(float(getattr(contact, name)) / float(row[name]) - 1) for name in names)


def balance() -> Checked:
    """The exact answer's pressures carry its force."""
    contact = Exact().press(_HIP, force=3000.0)
    x, w = numpy.polynomial.legendre.leggauss(60)
    edge = float(contact.half_angle)
    angle, weight = (
        edge * numpy.sin(numpy.pi / 4 * (x + 1)),
        edge * numpy.pi / 4 * numpy.cos(numpy.pi / 4 * (x + 1)) * w,
    )
    rings = [float(contact.pressure(one)) * cos(one) * sin(one) for one in angle]
    carried = 2 * numpy.pi * _HIP.socket_radius**2 * float(numpy.dot(rings, weight))
    return Checked(
        name="balance",
        what="Force of the exact answer against the integral of its pressures, relative",
        observed=abs(carried / 3000.0 - 1),
        high=1e-6,
    )


def slope_of_energy() -> Checked:
    """The exact answer's force is the slope of its energy."""
    d, step = 0.05, 1e-4
    low, here, high = (Exact().press(_HIP, indentation=d + by) for by in (-step, 0.0, step))
    slope = (float(high.energy) - float(low.energy)) / (2 * step)
    return Checked(
        name="slope-of-energy",
        what="Force of the exact answer against the central difference of its energy, relative",
        observed=abs(slope / float(here.force) - 1),
        high=1e-5,
    )


def hertz_limit() -> Checked:
    """A narrow contact in a massive socket is Hertz's."""
    liner = Material(young=1000.0, poisson=0.3)
    joint = Joint(ball_radius=20.0, clearance=0.05, liner_thickness=inf, liner=liner)
    exact, hertz = (model.press(joint, force=0.001) for model in (Exact(), Hertz()))
    return Checked(
        name="hertz-limit",
        what="Largest pressure of a narrow contact in a massive socket against Hertz, relative",
        observed=abs(float(exact.max_pressure) / float(hertz.max_pressure) - 1),
        high=5e-3,
    )


def own_tolerance() -> Checked:
    """The exact answer keeps the tolerance it is asked for."""
    best = Exact(tolerance=1e-9).press(_HIP, force=3000.0)
    shares = []
    for tolerance in (1e-3, 1e-5):
        found = Exact(tolerance=tolerance).press(_HIP, force=3000.0)
        off = max(abs(getattr(found, name) / getattr(best, name) - 1) for name in ("indentation", "max_pressure"))
        shares.append(float(off) / tolerance)
    return Checked(
        name="own-tolerance",
        what="Error of the exact answer over the tolerance it was asked for, at 1e-3 and 1e-5, the larger",
        observed=max(shares),
        high=1.0,
    )


def along_the_axis() -> Checked:
    """Rings about the cup's axis answer a load along it as the exact answer does."""
    whole = Sphere(surface=ClosedShell(), gap=LinearGap, cup=Cup())
    sphere, exact = (model.press(_HIP, indentation=0.05) for model in (whole, Exact()))
    return Checked(
        name="along-the-axis",
        what="Force of the off-axis solver in a closed shell against the exact answer, along the axis, relative",
        observed=abs(float(sphere.force) / float(exact.force) - 1),
        high=2e-3,
    )


def _needs_elements(check: Callable[[], Checked], name: str, what: str) -> Checked:
    if find_spec("skfem") is None:
        return Checked(name=name, what=what, observed=None, why="the extra 'fem' is not installed")
    return check()


def patch_test() -> Checked:
    """Biquadratic elements hold the energy of a uniform strain."""
    what = "Energy of a uniform strain in biquadratic elements, relative error (the patch test)"

    def run() -> Checked:
        from .element_checks import strain_energy_error

        return Checked(name="patch-test", what=what, observed=strain_energy_error(2), high=1e-4)

    return _needs_elements(run, "patch-test", what)


def order_of_elements(poisson: float = 0.4) -> Checked:
    """Biquadratic elements converge with the fourth order in displacement."""
    what = f"Observed order of convergence of biquadratic elements: thick sphere under pressure, nu {poisson:g}"

    def run() -> Checked:
        from .element_checks import thick_sphere_error

        coarse, fine = (thick_sphere_error(2, count, poisson) for count in (8, 16))
        return Checked(name="order-of-elements", what=what, observed=log2(coarse / fine), low=3.8)

    return _needs_elements(run, "order-of-elements", what)


CHECKS: Mapping[str, Callable[[], Checked]] = MappingProxyType(
    {
        "closed-forms": closed_forms,
        "balance": balance,
        "slope-of-energy": slope_of_energy,
        "hertz-limit": hertz_limit,
        "own-tolerance": own_tolerance,
        "along-the-axis": along_the_axis,
        "patch-test": patch_test,
        "order-of-elements": partial(order_of_elements, 0.4),
    }
)
"""By name."""
