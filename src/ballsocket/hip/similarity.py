"""Similarity of patients on radial springs: the dimensionless numbers that determine their wear.

Springs of the modulus K press with p on the ball, whose centre moves by e in a bore with the radius R2, the normals n
and the clearance c. In N cycles a law of degree m in the pressure, with the coefficient k, wears the depth h:

    p = K max(e·n - c - h, 0),   ∫ p n dA = F,   (1)
    dh/dN = k p^m f(sliding).   (2)

With lengths over c and pressures over K c, equations (1) and (2) have no other parameters than the orientation of the
cup, the force and the exposure

    F/(K c R2²),   X = k K^m c^(m-1) N.   (3)

Patients who share them have the same h/c. A creeping liner adds the time of a unit of exposure, and K times its
compliance, which depends on c.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import exp, radians

import numpy

from ..core.arrays import Numbers
from .cup_frame import ANGLES
from .cycle import Frame
from .simulation import HipSimulation, make_report
from .variability import PatientVariability
from .wear_integrator import WearIntegrator
from .wear_law import coefficient_field, with_coefficient

_RIM_MARGIN = radians(5.0)  # least angle in rad between a load and the end of the bore in a family member
_RIM_SLOPE = 0.5  # angle in rad beyond the rim per overlap of one clearance there; continues the distance below 0
_CONTACT_COLUMNS = slice(2, 5)  # indentation, half angle and largest pressure in a table of worst contacts

FORCE, CLEARANCE, TIME = "force", "clearance", "time"
"""Names of the numbers of a family besides the angles of the cup, all logarithms."""

UNWORN_NUMBERS = ("wear_rate", "rim_distance")
"""Numbers of the unworn bore besides those of the worst contacts: ln of depth per exposure over c, angle in rad."""

RIM_NUMBERS = ("rim_distance", "rim_excess")
"""Angle in rad between contact and rim, negative for a contact at the rim, and excess of the pressure at the rim.

The excess is the largest overlap at the rim minus the largest elsewhere, over c.
"""


def find_obstacle(variability: PatientVariability, counts: Sequence[float]) -> str:
    """State why patients with reports at given cycle counts are not similar, in one clause; empty if they are."""
    use = variability.coarse_simulation
    scattered, degree = set(variability.distributions), getattr(use.wear, "pressure_degree", None)
    obstacles = {
        "the foundation is elastic, not springs": not use.uses_springs,
        f"the wear law {type(use.wear).__name__} has no known degree in the pressure": degree is None,
        "the ball wears too": use.ball_wear is not None,
        "wear has a limit of the film ratio": use.film_limit is not None,
        "the cycle has a lateral spring": any(cycle.spring is not None for cycle in use.cycle.activity_cycles),
        "the chamfer of the rim has a length": use.cup.chamfer > 0 and CLEARANCE in scattered,
        "the clearance is not positive": not Similarity(variability=variability).clearance > 0,
        "a report is at 0 cycles": not min(counts) > 0,
        "nothing is pressed": not len(use.frame.loaded),
    }
    return next((clause for clause, holds in obstacles.items() if holds), "")


@dataclass(frozen=True, kw_only=True, eq=False)
class Similarity:
    """Dimensionless numbers of patients, and the simulation of a family member with given numbers."""

    variability: PatientVariability  # distributions of the patients. `find_obstacle` states whether they are similar.

    @cached_property
    def setup(self) -> HipSimulation:
        """Coarse simulation of the nominal patient, with the median wear coefficient if it is sampled."""
        use, distributions = self.variability.coarse_simulation, self.variability.distributions
        if "coefficient" not in distributions or coefficient_field(use.wear) is None:
            return use
        return replace(use, wear=with_coefficient(use.wear, self._median("coefficient")))

    @property
    def degree(self) -> float:
        """Degree of the wear law in the pressure."""
        return float(getattr(self.setup.wear, "pressure_degree", None) or 0.0)

    def _median(self, name: str) -> float:
        return float(self.variability.distributions[name].frozen.median())

    @cached_property
    def clearance(self) -> float:
        """Clearance in mm of the family members without creep: the median."""
        sampled = CLEARANCE in self.variability.distributions
        return self._median(CLEARANCE) if sampled else float(self.setup.joint.clearance)

    @property
    def results(self) -> tuple[str, ...]:
        """Names of the results whose logarithms belong to a family."""
        creep = () if self.setup.creep is None else ("creep_depth",)
        return ("volume", "depth", "penetration", "max_pressure", *creep)

    @property
    def angles(self) -> tuple[str, ...]:
        """Names of the sampled angles of the cup."""
        return tuple(name for name in ANGLES if name in self.variability.distributions)

    def modulus(self, clearance: Numbers | float) -> Numbers:
        """Compute the foundation modulus K in MPa/mm for clearances in mm."""
        joint = replace(self.setup.joint, clearance=clearance)
        return numpy.broadcast_to(self.setup.surface.modulus(joint), numpy.shape(clearance))  # type: ignore[union-attr]

    def socket_radius(self, clearance: Numbers | float) -> Numbers:
        """Compute the radius R2 of the bore in mm for clearances in mm."""
        return float(self.setup.joint.ball_radius) + numpy.asarray(clearance, dtype=float)

    def clearances(self, values: Mapping[str, Numbers]) -> Numbers:
        """Return the clearances of patients in mm: (patients,)."""
        return numpy.asarray(values.get(CLEARANCE, numpy.full(_count(values), self.clearance)), dtype=float)

    def largest_forces(self, values: Mapping[str, Numbers]) -> Numbers:
        """Compute the largest force in N of each activity: (activities, patients)."""
        frame = self.setup.frame
        magnitudes = numpy.linalg.norm(frame.loads, axis=1)
        nominal = numpy.array([magnitudes[loads].max() for _, loads in frame.activities])
        return nominal[:, None] * self._ratios(values, "body_weight")

    def _ratios(self, values: Mapping[str, Numbers], name: str) -> Numbers:
        """Return the ratios of a quantity of patients to that of the nominal patient: (patients,)."""
        if name not in values:
            return numpy.ones(_count(values))
        return values[name] / self.variability.nominal_value(name)

    def exposure_per_cycle(self, values: Mapping[str, Numbers]) -> Numbers:
        """Compute the exposure (3) per cycle, with k over its median: (patients,)."""
        clearance, degree = self.clearances(values), self.degree
        ratio = values["coefficient"] / self._median("coefficient") if "coefficient" in values else 1.0
        return ratio * self.modulus(clearance) ** degree * clearance ** (degree - 1)

    def log_exposure(self, values: Mapping[str, Numbers]) -> Numbers:
        """Compute the logarithm of patients' exposure per cycle of the nominal patient: (patients,)."""
        with numpy.errstate(divide="ignore", invalid="ignore"):
            return numpy.log(self.exposure_per_cycle(values) * self._ratios(values, "cycles_per_year"))

    def numbers(self, values: Mapping[str, Numbers]) -> dict[str, Numbers]:
        """Compute the numbers of patients besides the exposure by name: (patients,), NaN where not allowed."""
        clearance, forces = self.clearances(values), self._ratios(values, "body_weight")
        force_unit = self.modulus(clearance) * clearance * self.socket_radius(clearance) ** 2
        stated = self.setup.seconds_per_cycle is not None
        cycle_ratios = self._ratios(values, "cycles_per_year") if stated else numpy.ones(len(clearance))
        seconds = self.setup.seconds / cycle_ratios
        with numpy.errstate(divide="ignore", invalid="ignore"):
            numbers = {FORCE: numpy.log(forces / force_unit), **{name: values[name] for name in self.angles}}
            if self.setup.creep is not None:
                numbers |= {CLEARANCE: numpy.log(clearance), TIME: numpy.log(seconds / self.exposure_per_cycle(values))}
        return numbers

    def keeps_loads_inside(self, angles: Mapping[str, float]) -> bool:
        """Check if the loads of a cycle point into the bore, away from the rim, for angles of the cup in rad."""
        frame = self.setup.frame
        try:
            cup = self.variability.orient_cup(angles)
        except ValueError:
            return False
        forces = frame.side_cycle.forces[frame.loaded]
        if self.setup.cycle.frame is Frame.CUP:
            load_angles = numpy.arctan2(numpy.hypot(forces[:, 0], forces[:, 1]), forces[:, 2])
        else:
            load_angles = numpy.asarray(cup.tilt(forces))
        return bool((load_angles < frame.reach - _RIM_MARGIN).all())

    def units(self, clearance: Numbers) -> dict[str, Numbers]:
        """Compute the units of the results for clearances in mm: those of `RESULT_UNITS`."""
        radius = self.socket_radius(clearance)
        lengths = dict.fromkeys(("depth", "penetration", "creep_depth"), clearance)
        pressure = self.modulus(clearance) * clearance
        return {"volume": clearance * radius**2, **lengths, "max_pressure": pressure, "edge_distance": radius}

    def simulate(self, numbers: Mapping[str, float], log_exposures: Sequence[float]) -> tuple[Numbers, Numbers]:
        """Simulate the family member with given numbers up to each of several logarithms of exposures.

        Returns
        -------
        array (numbers,)
            Of the unworn bore: `UNWORN_NUMBERS`, then ln indentation/c, half angle in rad and ln pressure/(K c) of the
            worst contact of each activity.
        array (exposures, numbers)
            Logarithms of `results` over their units, `RIM_NUMBERS`, then the same three numbers of each activity.
        """
        use, per_cycle = self.make_member(numbers)
        integrator = WearIntegrator(setup=use)
        clearance, worn, converged = float(use.joint.clearance), [], True
        units = self.units(numpy.asarray(clearance))
        for log_exposure in log_exposures:
            report = make_report(integrator.run_until(exp(log_exposure) / per_cycle, lambda cycles: None))
            depth = integrator.depth + integrator.creep_depth
            with numpy.errstate(divide="ignore"):
                logarithms = [float(numpy.log(getattr(report, name) / units[name])) for name in self.results]
            displacement = use.solve_equilibrium(depth, integrator.equilibrium).displacement
            rim_numbers = self._rim_numbers(use, depth, displacement, float(report.edge_distance.min()))
            worn.append([*logarithms, *rim_numbers, *self._contact_numbers(use, report.worst_contacts)])
            converged = converged and report.converged
        if not converged:
            raise ValueError("a contact did not balance its load")
        with numpy.errstate(divide="ignore"):
            wear_rate = numpy.log(use.first.depth / 1e6 / per_cycle / clearance)
        rim = self._rim_numbers(use, numpy.zeros_like(integrator.depth), use.unworn.displacement, None)[0]
        contacts = self._contact_numbers(use, use.unworn_worst_contacts)
        return numpy.array([wear_rate, rim, *contacts]), numpy.array(worn)

    def make_member(self, numbers: Mapping[str, float]) -> tuple[HipSimulation, float]:
        """Return the simulation of a family member with given numbers, and its exposure per cycle."""
        clearance = exp(numbers[CLEARANCE]) if CLEARANCE in numbers else self.clearance
        modulus, degree = float(self.modulus(clearance)), self.degree
        force_ratio = exp(numbers[FORCE]) * modulus * clearance * float(self.socket_radius(clearance)) ** 2
        per_cycle = modulus**degree * clearance ** (degree - 1)
        member = replace(
            self.setup,
            joint=replace(self.setup.joint, clearance=clearance),
            cup=self.variability.orient_cup({name: numbers[name] for name in self.angles}),
            cycle=self.setup.cycle.scaled(force_ratio),
            seconds_per_cycle=exp(numbers[TIME]) * per_cycle if TIME in numbers else self.setup.seconds_per_cycle,
        )
        return member, per_cycle

    def _rim_numbers(
        self, use: HipSimulation, depth: Numbers, displacement: Numbers, distance: float | None
    ) -> tuple[float, float]:
        """Compute the signed angle in rad between contact and rim, and the excess of the pressure at the rim."""
        grid, clearance = use.grid, float(use.joint.clearance)
        overlap = displacement @ use.foundation.normals - clearance - depth
        rings = overlap.reshape(-1, grid.rings, grid.meridians) / clearance
        extension = (grid.reach - grid.polar[-1]) / (grid.polar[-1] - grid.polar[-2])
        at_rim = float((rings[:, -1] + extension * (rings[:, -1] - rings[:, -2])).max())
        excess = float(rings[:, -1].max() - rings[:, :-1].max())
        distance = float(use.edge(use.unworn).distance.min()) if distance is None else distance
        angle = distance / float(self.socket_radius(clearance)) if distance > 0 else -_RIM_SLOPE * max(at_rim, 0.0)
        return angle, excess

    def _contact_numbers(self, use: HipSimulation, worst_contacts: Numbers) -> list[float]:
        clearance = float(use.joint.clearance)
        indentation, half_angle, pressure = worst_contacts[:, _CONTACT_COLUMNS].T
        with numpy.errstate(divide="ignore"):
            indentation = numpy.log(indentation / clearance)
            pressure = numpy.log(pressure / float(self.modulus(clearance)) / clearance)
        return [float(number) for number in numpy.stack([indentation, half_angle, pressure], axis=1).ravel()]


def _count(values: Mapping[str, Numbers]) -> int:
    return len(next(iter(values.values())))
