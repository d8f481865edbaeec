"""Film at the inlet edge of a dry contact in closed form.

The ball draws lubricant under the edge of the dry contact. The film depends on the rise of the dry pressure there:
p = G s on springs, p = A sqrt(s) in elastic bodies, with the arc s from the edge.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy

from ..core.arrays import Numbers

INLET_COEFFICIENT = 1.5006
"""C in h = C (η U)^(3/5) E*^(1/5) A^(-4/5), from the inlet problem of a half-space; error below 1e-4.

The problem is solved in `tests/lubrication/inlet_problem.py`.
"""

OUTLET_RATIO = 0.7962
"""Film at the constriction of an elastic outlet over the film of its streamline.

A separate program, which is not among the tests, solved the same problem with the motion reversed and cavitation at the
edge: 0.79610, 0.79620 and 0.79620 on 243, 485 and 964 points. `tests/lubrication/line_contact.py` confirms it to 0.2 %.
"""


@dataclass(frozen=True, kw_only=True)
class SpringEdge:
    """Edge of a contact on radial springs."""

    slope: float  # slope G of the dry pressure at the edge in MPa/mm
    modulus: float  # foundation modulus K in MPa/mm

    prescribed: ClassVar[bool] = False  # the inlet film follows from the pressure within the contact
    outlet_ratio: ClassVar[float] = 1.0  # film at the constriction of the outlet over the film of its streamline
    leakage: ClassVar[float] = 0.4  # relative loss of film on the way to its thinnest point, which the inlet neglects
    cell_error: ClassVar[float] = 0.4  # of the wave, times the rings of cells, where the pressure ends at the edge

    def inlet_film(self, viscosity: float, speed: Numbers) -> Numbers:
        """Compute the film in mm at surface speeds U across the edge in mm/s; viscosity in MPa s."""
        # (4/3) sqrt(η u/G), u = U/2: the flow ½ U h - h³ G/(12 η) has its largest value, ⅓ U h, at h² = 2 η U/G, and
        # further in, where the pressure is flat, ½ U h carries it
        return 4 / 3 * numpy.sqrt(viscosity * numpy.maximum(speed, 0.0) / (2 * self.slope))

    def inlet_length(self, viscosity: float, speed: Numbers) -> Numbers:
        """Compute the length K h/G in mm over which the inlet changes the dry pressure."""
        return self.modulus * self.inlet_film(viscosity, speed) / self.slope

    def distance(self, pressure: Numbers) -> Numbers:
        """Estimate the distance from the edge in mm, p/G, at dry pressures in MPa."""
        return pressure / self.slope

    def side_speed(self, viscosity: float, speed: float, radius: float) -> float:
        """Return the speed of the surface in mm/s: on springs the wave itself has the film at the sides."""
        return speed

    def wave_error(self, viscosity: float, speed: float, radius: float) -> float:
        """Estimate the relative error of a thin film on a contact of a radius in mm: 1.4 (ℓ/a)^(2/3)."""
        return float(1.4 * (self.inlet_length(viscosity, numpy.asarray(speed)) / radius) ** (2 / 3))


@dataclass(frozen=True, kw_only=True)
class ElasticEdge:
    """Edge of a contact of elastic bodies."""

    coefficient: float  # coefficient A of the dry pressure at the edge, p = A sqrt(s), in MPa/mm^½
    modulus: float  # effective modulus E* of both bodies in MPa

    prescribed: ClassVar[bool] = True  # for these constants see `SpringEdge`
    outlet_ratio: ClassVar[float] = OUTLET_RATIO
    leakage: ClassVar[float] = 0.1
    cell_error: ClassVar[float] = 0.0

    def inlet_film(self, viscosity: float, speed: Numbers) -> Numbers:
        """Compute the film in mm at surface speeds U across the edge in mm/s; viscosity in MPa s."""
        drag = viscosity * numpy.maximum(speed, 0.0)
        return INLET_COEFFICIENT * drag**0.6 * self.modulus**0.2 * self.coefficient**-0.8

    def inlet_length(self, viscosity: float, speed: Numbers) -> Numbers:
        """Compute the length (η U E*²/A³)^(2/5) in mm over which the inlet changes the dry pressure."""
        return (viscosity * numpy.maximum(speed, 0.0) * self.modulus**2 / self.coefficient**3) ** 0.4

    def distance(self, pressure: Numbers) -> Numbers:
        """Estimate the distance from the edge in mm, (p/A)², at dry pressures in MPa."""
        return (pressure / self.coefficient) ** 2

    def side_speed(self, viscosity: float, speed: float, radius: float) -> float:
        """Compute the speed in mm/s into the contact at its sides, where the ball moves along the edge.

        At an angle ψ from a side the inward speed is U ψ, and the chord of the edge is a ψ²/2 deep. The inlet is as
        long as that at ψ = (2 ℓ/a)^(5/8), with the inlet length ℓ of the speed U. Nearer to the side no thinner film
        enters. The factor 2 is fitted to two values of Reynolds' equation. Its smallest films in a hip are 70 and
        285 nm at 1.5 and 10 rad/s, those of the formula 70 and 292 nm.
        """
        length = float(self.inlet_length(viscosity, numpy.asarray(speed)))
        return speed * min(2 * (2 * length / radius) ** 0.625, 1.0)

    def wave_error(self, viscosity: float, speed: float, radius: float) -> float:
        """Estimate the relative error of a thin film on a contact of a radius in mm: (ℓ/a)^(2/3)."""
        return float((self.inlet_length(viscosity, numpy.asarray(speed)) / radius) ** (2 / 3))


Edge = SpringEdge | ElasticEdge  # edge of a dry contact, which sets the film
