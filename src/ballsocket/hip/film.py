"""Lubricant film between ball and socket over a cycle, and friction: moment, power, heat.

Method "wave" carries the film over the dry contacts from instant to instant. Method "hamrock-dowson" has a formula for
each instant alone; it is fitted to bodies of low conformity.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, inf
from typing import TYPE_CHECKING, Any

import numpy

from ..core.arrays import Numbers
from ..core.checks import known_name, require
from ..core.display import counted, finite_or_none, load_plot
from ..core.records import Record
from ..elasticity.off_axis.grid import Grid
from ..lubrication import Lubricant
from ..problem import Joint
from .cup_frame import CupFrame
from .film_limit import CYCLES
from .kinematics import SurfaceSliding
from .socket_foundation import CycleEquilibrium, SocketFoundation

if TYPE_CHECKING:
    from .film_cycle import CarriedFilm

WAVE_NOTE = "Film carried over the dry contacts from instant to instant, from a flooded bore"
"""Note on the film thickness by the kinematic wave."""

CONFORMITY_NOTE = (
    "Hamrock and Dowson's formulas hold for bodies of low conformity: here they give a regime, not a thickness"
)
"""Note on the film thickness of a conforming joint."""

METHODS = ("wave", "hamrock-dowson")  # names of the methods; the first is the default

_SMALL_SHARE = 0.01  # share of a contact without fresh lubricant up to which it is not noted
_MAX_ERROR = 0.1  # largest estimated error of a valid film
_MIXED_RATIO, _FULL_RATIO = 1.0, 3.0  # film ratios at which mixed and full-film lubrication begin


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Film(Record):
    """Lubricant film and friction in the loaded instants of a cycle.

    Attributes
    ----------
    phases : array (instants,)
        Phases of the cycle, 0 to 1.
    least, central : array (instants,)
        Smallest thickness in the contact, and that at the load, in mm.
    ratio : array (instants,)
        Film ratio λ: smallest thickness over the combined roughness.
    moment : array (instants, 3)
        Friction moment on the cup about its centre in N mm, in the cup's frame; the moment on the ball is opposite.
    power : array (instants,)
        Friction power in W.
    heat : float
        Friction heat of a cycle in J.
    duration : float
        Duration of a cycle in s.
    lubricant : Lubricant
    method : str
        "wave" or "hamrock-dowson".
    comparison : array (instants,)
        Smallest thickness in mm by Hamrock and Dowson's formula.
    carried : CarriedFilm, optional
        Film by the wave on the cells of the bore.
    """

    phases: Numbers
    least: Numbers
    central: Numbers
    ratio: Numbers
    moment: Numbers
    power: Numbers
    heat: float
    duration: float
    lubricant: Lubricant
    method: str
    comparison: Numbers
    carried: CarriedFilm | None = None

    @property
    def thickness(self) -> Numbers | None:
        """Film thickness in mm on the cells of the bore (instants, cells), NaN outside the contacts; of the wave."""
        return None if self.carried is None else self.carried.mapped("thickness")

    @property
    def core(self) -> Numbers | None:
        """Mask (instants, cells) of the film that fresh lubricant does not reach within a cycle; of the wave."""
        return None if self.carried is None else self.carried.mapped("core")

    def __repr__(self) -> str:
        smallest = 1e6 * numpy.min(self.least, initial=numpy.inf)
        return f"<film by {self.method} in {counted(len(self.phases), 'instant')}: smallest {smallest:.3g} nm>"

    @property
    def error(self) -> Numbers | None:
        """Estimated relative error (instants,) of central and smallest film by the wave, with that of its cells."""
        return None if self.carried is None else self.carried.joined("error")

    @property
    def refreshed_share(self) -> Numbers | None:
        """Share (instants,) of the contact that fresh lubricant reaches within a cycle; of the wave."""
        return None if self.carried is None else self.carried.joined("refreshed_share")

    @property
    def refreshed_mean(self) -> Numbers | None:
        """Mean film (instants,) in mm where fresh lubricant comes in every cycle; of the wave."""
        return None if self.carried is None else self.carried.joined("refreshed_mean")

    @property
    def refreshed_mean_error(self) -> float | None:
        """Estimated relative error of the mean of `refreshed_mean` over the cycle; of the wave."""
        return None if self.carried is None else max(film.refreshed_mean_error for film in self.carried.films)

    @property
    def core_mean(self) -> Numbers | None:
        """Mean film (instants,) in mm of the core; NaN without one; of the wave."""
        return None if self.carried is None else self.carried.joined("core_mean")

    @property
    def unreached(self) -> float:
        """Largest share of a contact that fresh lubricant does not reach within a cycle."""
        return 0.0 if self.refreshed_share is None else 1 - float(self.refreshed_share.min(initial=1.0))

    @property
    def converged(self) -> bool:
        """True if the film at the end of a cycle equals that at its start to 1 %."""
        return self.carried is None or all(film.converged for film in self.carried.films)

    @property
    def settled(self) -> bool:
        """True if more cycles would hardly change the mean film of the core."""
        return self.carried is None or all(film.settled for film in self.carried.films)

    @property
    def smallest_settled(self) -> bool:
        """True if more cycles would hardly change the smallest film of the core.

        It falls, h ~ N^(-1/2), where the film turns about a point of the core.
        """
        return self.carried is None or all(film.smallest_settled for film in self.carried.films)

    @property
    def valid(self) -> bool:
        """True if the film of the wave repeats, its core is settled, and its estimated error is at most 10 %.

        A formula for other bodies is not valid.
        """
        return self.error is not None and self.converged and self.settled and bool((self.error <= _MAX_ERROR).all())

    @property
    def note(self) -> str:
        """Sentence on the method of the film thickness."""
        if self.carried is None or self.error is None:
            return CONFORMITY_NOTE
        films = self.carried.films
        error = f"{WAVE_NOTE}, {films[0].cycles} cycles ago; estimated error {100 * self.error.max(initial=0.0):.0f} %"
        repeat = "" if self.converged else "; the film does not repeat to 1 % yet"
        if self.unreached < _SMALL_SHARE:
            return error + repeat
        drift = max(degrees(film.drift) for film in films)
        state = (
            f"its film drifts by {drift:.2g}° in a cycle and is settled"
            + ("" if self.smallest_settled else ", but its smallest film still falls")
            if self.settled
            else "its film falls, at last with the root of the number of cycles"
        )
        core = f"fresh lubricant does not reach a core, up to {100 * self.unreached:.0f} % of the contact"
        return f"{error}{repeat}; {core}: {state}"

    @property
    def regime(self) -> str:
        """Lubrication regime at the thickest film: "boundary", "mixed" or "full"; "unknown" without clearance."""
        largest = float(self.ratio.max(initial=0.0))
        if numpy.isnan(largest):
            return "unknown"
        return "boundary" if largest < _MIXED_RATIO else "mixed" if largest < _FULL_RATIO else "full"

    def summary(self) -> dict[str, Any]:
        """Return film and friction as a dictionary for JSON, with thicknesses in nm."""
        if not len(self.phases):
            return {}
        moment_magnitudes = numpy.linalg.norm(self.moment, axis=1)
        values = {
            "least_nm": 1e6 * self.least.min(),
            "largest_nm": 1e6 * self.least.max(),
            "lambda_least": self.ratio.min(),
            "lambda_largest": self.ratio.max(),
            "moment_Nmm": moment_magnitudes.max(),
            "power_W": self.heat / self.duration,
            "heat_J_per_cycle": self.heat,
        }
        largest_moment = [float(component) for component in self.moment[moment_magnitudes.argmax()]]
        carried = self.carried
        summary: dict[str, Any] = {
            **{name: finite_or_none(value) for name, value in values.items()},
            "moment_on_cup_Nmm": largest_moment,
            "central_nm": _mean_nm(self.central),
            "regime": self.regime,
            "note": self.note,
            "method": self.method,
            "valid": self.valid,
            "error": None if self.error is None else float(self.error.max(initial=0.0)),
        }
        if carried is not None:
            summary |= {
                "refreshed_share_least": 1 - self.unreached,
                "refreshed_mean_nm": _mean_nm(carried.joined("refreshed_mean")),
                "core_mean_nm": _mean_nm(carried.joined("core_mean")),
                "drift_deg_per_cycle": max(degrees(film.drift) for film in carried.films),
                "cycles": carried.films[0].cycles,
                "change_per_cycle": max(film.change for film in carried.films),
                "settled": self.settled,
                "smallest_settled": self.smallest_settled,
                "refreshed_mean_error": self.refreshed_mean_error,
            }
        return summary

    def plot(self) -> Any:
        """Plot the film over the cycle, and maps of it over the bore; return the matplotlib figure."""
        return load_plot("cycle_film")(self)


def _mean_nm(thickness: Numbers) -> float | None:
    """Compute the mean over the cycle in nm of a thickness (instants,) in mm, where it exists."""
    known = thickness[numpy.isfinite(thickness)]
    return 1e6 * float(known.mean()) if len(known) else None


def film(
    frame: CupFrame,
    foundation: SocketFoundation,
    sliding: SurfaceSliding,
    equilibrium: CycleEquilibrium,
    depth: Numbers,
    lubricant: Lubricant,
    grid: Grid,
    method: str = METHODS[0],
    cycles: int = CYCLES,
) -> Film:
    """Compute film thickness, friction moment, power and heat of a cycle from its contacts and sliding.

    `depth` (cells,) is the worn depth in mm.

    Raises ValueError: an unknown method; a number of cycles below 1.
    """
    name = known_name("method", method, METHODS)
    require("cycles", cycles, cycles >= 1 and cycles == int(cycles), "a number of cycles is a whole number from 1")
    durations = frame.cycle.seconds[frame.loaded]
    forces = frame.socket_forces(equilibrium.displacement)
    magnitudes = numpy.linalg.norm(forces, axis=1)
    spin = numpy.linalg.norm(numpy.cross(frame.rotation_increments, forces), axis=1) / numpy.where(
        magnitudes > 0, magnitudes, 1.0
    )
    formula = film_thickness(frame.joint, magnitudes, spin / durations, lubricant.viscosity)
    carried = None
    if name == "wave" and foundation.clearance > 0 and len(forces):
        from .film_cycle import carry_film

        carried = carry_film(frame, foundation, equilibrium, depth, lubricant.viscosity_mpa, grid, int(cycles))
    least, central = (carried.joined("minimum"), carried.joined("central")) if carried else formula
    local = carried.mapped("thickness") if carried else numpy.broadcast_to(central[:, None], equilibrium.pressure.shape)
    speed = sliding.distances / durations[:, None]
    shear = lubricant.shear_stress(equilibrium.pressure, local, speed)
    work = numpy.einsum("tp,tp,p->t", shear, sliding.distances, foundation.areas)
    roughness = lubricant.roughness
    return Film(
        phases=frame.cycle.phases[frame.loaded],
        least=least,
        central=central,
        ratio=least / roughness if roughness > 0 else numpy.full_like(least, inf),
        moment=_moment(foundation, sliding, shear),
        power=1e-3 * work / durations,
        heat=1e-3 * float(work.sum()),
        duration=frame.cycle.duration,
        lubricant=lubricant,
        method=name,
        comparison=formula[0],
        carried=carried,
    )


def _moment(foundation: SocketFoundation, sliding: SurfaceSliding, shear: Numbers) -> Numbers:
    """Compute the friction moment on the cup in N mm of shear stresses in MPa: (instants, 3).

    It is ∫ R n × v/abs(v) τ dA with v = R ω × n, and n × (ω × n) = ω - (ω·n) n.
    """
    directions, rotations, distances = foundation.directions, sliding.rotation_increments, sliding.distances
    weight = numpy.divide(
        shear * foundation.areas * sliding.radius**2, distances, out=numpy.zeros_like(distances), where=distances > 0
    )
    normal_part = weight * (rotations @ directions)
    return rotations * weight.sum(axis=1)[:, None] - normal_part @ directions.T


def film_thickness(joint: Joint, force: Numbers, spin: Numbers, viscosity: float) -> tuple[Numbers, Numbers]:
    """Compute the minimum and central film thickness in mm by the formulas of Hamrock and Dowson.

    Parameters
    ----------
    joint : Joint
    force : array
        Load in N.
    spin : array
        Rotation rate of the ball perpendicular to the load, in rad/s.
    viscosity : float
        Viscosity in Pa s.

    Returns
    -------
    pair of arrays
        Thicknesses; NaN without clearance, where no equivalent sphere exists.
    """
    if float(joint.clearance) == 0:
        return numpy.full_like(force, numpy.nan), numpy.full_like(force, numpy.nan)
    # h_min = 2.80 R* U^.65 W^-.21, h_cen = 3.34 R* U^.64 W^-.22, U = ηu/(E'R*), W = F/(E'R*²), u = ωR1/2
    effective_radius = float(joint.ball_radius * joint.socket_radius / joint.clearance)
    ball_compliance = 0.0 if joint.ball is None else float((1 - joint.ball.poisson**2) / joint.ball.young)
    liner_compliance = float((1 - joint.liner.poisson**2) / joint.liner.young)
    modulus = 2 / (liner_compliance + ball_compliance)
    speed_parameter = 1e-6 * viscosity * spin * float(joint.ball_radius) / 2 / (modulus * effective_radius)
    load_parameter = force / (modulus * effective_radius**2)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        minimum = 2.80 * effective_radius * speed_parameter**0.65 * load_parameter**-0.21
        central = 3.34 * effective_radius * speed_parameter**0.64 * load_parameter**-0.22
    return minimum, central
