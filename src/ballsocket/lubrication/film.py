"""Film of a single contact and its description: inlet formula, wave and Reynolds' equation behind one function."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import degrees, inf, pi, radians
from typing import Any

import numpy

from ..contact import Contact
from ..core.answers import Answer, Column, Row, Table
from ..core.arrays import Array, Numbers
from ..core.checks import check_number, check_vectors, known_name, require
from ..core.display import finite_or_none, load_plot
from ..core.kinds import NANOMETRES, PERCENT, Unit
from ..core.records import Record
from ..core.unit_systems import Amount, Sentence
from ..core.validity import Status
from .dry_contact import DryContact, check_single_contact, dry_contact
from .film_problem import check_reynolds, make_contact_film
from .lubricant import Lubricant
from .wave import FilmWave

CELL_WIDTH = radians(2.0)  # default width of the cells of the wave in rad
MAX_ERROR = 0.1  # largest estimated error of a valid film

_MAX_RATE = 1e6  # largest rotation rate about an axis in rad/s
_THINNEST = 1e-6  # film in mm, 1 nm, below which a lubricant is a few molecules and not a fluid
_WATER_DENSITY = 1e-9  # density of water in t/mm³, which is about that of joint fluid and oil

_MAX_REYNOLDS_NUMBER = 1440.0
"""Reynolds number U h/ν of a laminar film.

Plane Couette flow stays turbulent above 360 with half the speed and half the gap: N. Tillmark, P. H. Alfredsson,
J. Fluid Mech. 235 (1992) 89 (unverified).
"""

_NO_ENTRAINMENT = "the ball does not turn across the load: no lubricant enters, and the film is squeezed out"
_CIRCLING_NOTE = (
    "the axis of the rotation passes through the contact: lubricant circles about it without an inlet, "
    "and the film there is thinner than computed"
)
_RIM_NOTE = "the rim cuts the contact: no lubricant enters there, and the film behind it is thinner than computed"
_MOLECULES_NOTE = Sentence("the smallest film is below {}: a few molecules are not a fluid", Amount(1e-6, NANOMETRES))


@dataclass(frozen=True, kw_only=True, eq=False)
class FilmResult(Record):
    """Lubricating film of a single contact.

    Attributes
    ----------
    contact : Contact
        Dry contact that the film separates.
    method : str
        "inlet", "wave" or "reynolds".
    lubricant : Lubricant
    spin : array (3,)
        Rotation rate of the ball in rad/s, in the frame of the contact.
    directions : array (cells, 3)
        Unit vectors from the centre of the bore to the cells.
    areas : array (cells,)
        Areas of the cells in mm².
    thickness : array (cells,)
        Film thickness in mm; NaN outside the contact, where the wave floods it.
    pressure : array (cells,)
        Pressure in MPa: dry for the inlet and the wave.
    central, minimum : float
        Film thickness in mm at the pole of the load, and the smallest in the contact.
    error : float
        Estimated relative error of central and minimum film.
    status : Status
        `NOT_CONVERGED` marks the best film so far.
    displacement : array (3,)
        Displacement of the ball in mm; NaN where the method does not solve for it.
    """

    contact: Contact
    method: str
    lubricant: Lubricant
    spin: Numbers
    directions: Numbers
    areas: Numbers
    thickness: Numbers
    pressure: Numbers
    central: float
    minimum: float
    error: float
    status: Status
    displacement: Numbers
    dry: DryContact

    @property
    def ratio(self) -> float:
        """Film ratio λ: smallest film over the combined roughness; infinite for smooth surfaces."""
        roughness = self.lubricant.roughness
        return self.minimum / roughness if roughness > 0 else inf

    @property
    def speed(self) -> float:
        """Speed in mm/s of the ball's surface at the pole of the load."""
        return self.dry.speed(self.spin)

    @property
    def reynolds_number(self) -> float:
        """Reynolds number U h/ν of the central film, with the density of water."""
        return self.speed * self.central * _WATER_DENSITY / self.lubricant.viscosity_mpa

    @property
    def valid(self) -> bool:
        """True if the contact is valid, lubricant enters all of it, and the estimated error is at most 10 %.

        The film must also be a fluid in laminar flow.
        """
        return bool(self.contact.valid and not self._reasons)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on the contact, and on all reasons for which the film is not valid."""
        return (*self.contact.notes, *self._reasons)

    @property
    def _reasons(self) -> tuple[str, ...]:
        """Sentences on missing entrainment, the axis, the rim, the error, the iteration and the fluid."""
        reasons = {
            _NO_ENTRAINMENT: self.central == 0,
            _CIRCLING_NOTE: self.central > 0 and self.dry.contains_axis(self.spin),
            _RIM_NOTE: self.dry.cut,
            f"estimated error {100 * self.error:.3g} % is above {100 * MAX_ERROR:.0f} %": self.error > MAX_ERROR,
            f"{self.status.sentence}: this is the best film so far": self.status is not Status.OK,
            _MOLECULES_NOTE: 0 < self.minimum < _THINNEST,
            f"the Reynolds number {self.reynolds_number:.3g} of the film is above {_MAX_REYNOLDS_NUMBER:.4g}: the flow "
            "is turbulent": self.reynolds_number > _MAX_REYNOLDS_NUMBER,
        }
        return tuple(note for note, holds in reasons.items() if holds)

    def summary(self) -> dict[str, Any]:
        """Return the film as a dictionary for JSON, with thicknesses in nm; missing numbers are None."""
        return {
            "model": self.contact.model.name,
            "method": self.method,
            "central_nm": finite_or_none(1e6 * self.central),
            "minimum_nm": finite_or_none(1e6 * self.minimum),
            "lambda": finite_or_none(self.ratio),
            "error": finite_or_none(self.error),
            "valid": self.valid,
            "status": self.status.name,
            "notes": list(self.notes),
            "spin_rad_per_s": self.spin.tolist(),
            "viscosity_Pa_s": self.lubricant.viscosity,
            "half_angle_deg": degrees(self.dry.half_angle),
        }

    def plot(self) -> Any:
        """Plot a map of the film, and film and pressure along the motion; return the matplotlib figure."""
        return load_plot("film")(self)

    def __repr__(self) -> str:
        central, least = 1e6 * self.central, 1e6 * self.minimum
        return (
            f"film by {self.method} on {self.contact.model.name}: central {central:.4g} nm, minimum {least:.4g} nm, "
            f"λ = {self.ratio:.3g}, estimated error {100 * self.error:.1f} %{'' if self.valid else ', not valid'}"
        )


def film(
    contact: Contact,
    *,
    spin: Array = (1.5, 0.0, 0.0),
    lubricant: Lubricant = Lubricant(),  # noqa: B008 (frozen)
    method: str = "wave",
    cell_width: float = CELL_WIDTH,
) -> FilmResult:
    """Compute the steady lubricating film of a pressed contact.

    Parameters
    ----------
    contact : Contact
        A single contact of any model that has a pressure: on springs, elastic, or off the axis of a cup.
    spin : array (3,)
        Rotation rate of the ball in rad/s. z is the axis of the load; a contact of `Sphere` has the frame of the cup.
    lubricant : Lubricant
    method : str
        "inlet" is the closed form at the edge. "wave" (default) carries the film over the dry contact. "reynolds"
        solves Reynolds' equation with the deformation and the balance of the load. It takes contacts on springs, of
        `exact`, of `tabulated`, and of `Sphere` where the rim does not cut them.
    cell_width : float
        Width of the cells of the wave in rad; 2° by default.

    Raises
    ------
    TypeError
        Another object than a contact or a lubricant.
    ValueError
        More than one contact; a contact without a result, load or clearance; a spin that is not finite or above
        1e6 rad/s; cells that are not 0.2° to 10° wide; an unknown method; Reynolds' equation for a contact of another
        model, for one that the rim cuts, and for one whose edge is far from round.

    Examples
    --------
    >>> import ballsocket as bs
    >>> contact = bs.HessForsbach().press(bs.joints["hip-36"], force=1500.0)
    >>> bs.film(contact, spin=(1.5, 0.0, 0.0), lubricant=bs.Lubricant(viscosity=2.5e-3))
    film by wave on hess-forsbach: central 191.7 nm, minimum 162.2 nm, λ = 0.162, estimated error 4.4 %
    """
    method = known_name("method", method, METHODS)
    check_single_contact(contact)
    if not isinstance(lubricant, Lubricant):
        raise TypeError(f"lubricant must be a Lubricant, got {type(lubricant).__name__}")
    rate = numpy.asarray(check_vectors("spin", spin, "x, y, z (rad/s)"), dtype=float)
    require("spin", rate, numpy.abs(rate) <= _MAX_RATE, f"a rotation rate (rad/s) is at most {_MAX_RATE:g} in size")
    if rate.shape != (3,):
        raise ValueError(f"spin of shape {rate.shape} is not allowed: give one rotation rate x, y, z (rad/s)")
    width = check_number("cell_width", cell_width)
    allowed = "a cell is 0.0035 to 0.175 rad wide, which is 0.2 to 10 degrees"
    require("cell_width", width, radians(0.2) <= width <= radians(10.0), allowed)
    dry = dry_contact(contact, width)
    none = numpy.where(dry.inside, 0.0, numpy.nan)  # without entrainment
    fields = {**_on_dry(dry), "thickness": none, "central": 0.0, "minimum": 0.0, "error": 0.0}
    if dry.speed(rate) > 1e-9 * dry.radius * numpy.linalg.norm(rate):
        fields = METHODS[method](contact, dry, rate, lubricant.viscosity_mpa)
    common = {"status": Status.OK, "displacement": numpy.full(3, numpy.nan), "dry": dry}
    return FilmResult(contact=contact, method=method, lubricant=lubricant, spin=rate, **{**common, **fields})


def _on_dry(dry: DryContact) -> dict[str, Any]:
    return {"directions": dry.mesh.direction, "areas": dry.mesh.area, "pressure": dry.pressure}


def _solve_inlet(contact: Contact, dry: DryContact, spin: Numbers, viscosity: float) -> dict[str, Any]:
    """Compute the film at the inlet edge, and carry it across the contact without change."""
    speed = dry.speed(spin)
    central = float(dry.edge.inlet_film(viscosity, numpy.asarray(speed)))
    entry = dry.inward_speed(spin, _entry_points(dry, spin))
    film = dry.edge.inlet_film(viscosity, entry)
    return {
        **_on_dry(dry),
        "thickness": numpy.where(dry.inside, film, numpy.nan),
        "central": central,
        "minimum": central * dry.edge.outlet_ratio,
        "error": dry.edge.leakage + dry.edge.wave_error(viscosity, speed, dry.contact_radius),
    }


def _entry_points(dry: DryContact, spin: Numbers) -> Numbers:
    """Compute the points (cells, 3) at the edge where the circles of motion through the cells enter the contact.

    Circles that stay within the contact have the point where they come nearest to the edge.
    """
    axis = spin / numpy.linalg.norm(spin)
    along = (dry.mesh.direction @ axis)[:, None] * axis
    first = dry.mesh.direction - along
    second = numpy.cross(axis, first)
    # n(t)·load = a + b cos t + c sin t; upstream t < 0
    level, cosine, sine = along @ dry.axis, first @ dry.axis, second @ dry.axis
    size, phase = numpy.hypot(cosine, sine), numpy.arctan2(sine, cosine)
    share = numpy.clip((numpy.cos(dry.half_angle) - level) / numpy.where(size > 0, size, 1.0), -1.0, 1.0)
    rotation = (phase - numpy.arccos(share) + pi) % (2 * pi) - pi
    return along + first * numpy.cos(rotation)[:, None] + second * numpy.sin(rotation)[:, None]


def _solve_wave(contact: Contact, dry: DryContact, spin: Numbers, viscosity: float) -> dict[str, Any]:
    """Carry the inlet film over the dry contact by the kinematic wave."""
    wave = FilmWave(contact=dry, viscosity=viscosity, spin=spin)
    film, steady = wave.solve_steady()
    height = dry.mesh.direction @ dry.axis
    central = float(film[height > height.max() - 1e-9].mean())  # of the cells next to the load
    return {
        **_on_dry(dry),
        "thickness": numpy.where(dry.inside, film, numpy.nan),
        "central": central,
        "minimum": wave.smallest_film(film, central),
        "error": dry.cell_error / dry.rings + dry.edge.wave_error(viscosity, dry.speed(spin), dry.contact_radius),
        "status": Status.OK if steady else Status.NOT_CONVERGED,
    }


def _solve_reynolds(contact: Contact, dry: DryContact, spin: Numbers, viscosity: float) -> dict[str, Any]:
    """Solve Reynolds' equation with the deformation, the balance of the load and cavitation."""
    check_reynolds(contact, dry)
    case = make_contact_film([contact], [dry], spin, viscosity)
    state = case.solve_steady()
    film = case.problem.thickness(state)
    return {
        "directions": case.problem.mesh.direction,
        "areas": case.problem.mesh.area,
        "pressure": state.pressure,
        "thickness": film,
        "central": float(case.central(film)),
        "minimum": float(case.minimum(film)),
        "error": case.settings.error,
        "status": Status.OK if state.converged else Status.NOT_CONVERGED,
        "displacement": state.eccentricity,
    }


METHODS: dict[str, Callable[[Contact, DryContact, Numbers, float], dict[str, Any]]] = {
    "inlet": _solve_inlet,
    "wave": _solve_wave,
    "reynolds": _solve_reynolds,
}
"""Methods by name, each the judge of the one before."""


_COLUMNS = (
    Column.of_words("model"),
    Column.of_words("method"),
    Column(key="central_nm", name="central_nm", head="central", unit=NANOMETRES, written=NANOMETRES),
    Column(key="minimum_nm", name="minimum_nm", head="minimum", unit=NANOMETRES, written=NANOMETRES),
    Column.of_number("lambda", "λ", digits=3),
    Column.of_number("error", unit=PERCENT, digits=2),
    Column.of_words("valid"),
)


def describe_films(films: Sequence[FilmResult]) -> Answer:
    """Describe the films of one joint, one for each model."""
    first = films[0]
    motion = (Amount(float(numpy.linalg.norm(first.spin)), Unit("rad/s")), Amount(first.speed, Unit("mm/s"), 3))
    viscosity = Amount(first.lubricant.viscosity, Unit("mPa s", 1e3))
    rows = [
        Row([one.contact.model.name, one.method, one.central, one.minimum, one.ratio, one.error, one.valid])
        for one in films
    ]
    return Answer(
        title=str(first.contact.joint),
        lines=[Sentence("film at {}, {}, viscosity {}", *motion, viscosity)],
        tables=[Table("film", "Film", _COLUMNS, rows, ["λ minimum film over the combined roughness of both surfaces"])],
        notes=[Sentence("{}: {}", one.contact.model.name, note) for one in films for note in one.notes],
    )
