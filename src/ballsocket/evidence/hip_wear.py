"""Wear of hips as it was measured beside what the laws say of it, with every input told."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import radians

import numpy

from ..core.arrays import Numbers
from ..hip.bands import DEFAULT_LEVEL
from ..hip.creep_laws import logarithmic
from ..hip.cycle import Cycle
from ..hip.cycle_registry import named_cycle
from ..hip.simulation import HipSimulation
from ..hip.simulator_cycles import iso_14242_1, iso_14242_4, rocking
from ..hip.uncertainty import population
from ..hip.variability import RESULT_UNITS, PatientVariability
from ..hip.wear_law import WearLaw
from ..hip.wear_laws import Archard, ContactAreaWear
from ..problem import Joint, Material
from ..problem.cup import Cup
from ..studies.distributions import Distribution, LogNormal, Normal, Rectangular

CONVENTIONAL, LINKED = 1.066e-6, 2e-7
"""k in mm³/(N m); for cross-linked polyethylene 1e-7 to 4e-7 are told."""

STEPS, YEAR = 1.5e6, 365.25 * 86400.0
"""Of the usual patient in a year; seconds in one."""

INPUTS = (
    "E 1 GPa, ν 0.4, clearance 0.1 mm, the paper's springs; liners of 8 mm (28 mm), 10.9 mm (22 mm), 6 mm (36 mm), "
    "7 mm (32 mm)",
    "k = 1.066e-6 mm³/(N m) for conventional polyethylene, 2e-7 for cross-linked, each within a factor of 1.5 (one "
    "standard deviation); clearance 0.05 to 0.2 mm",
    "simulators: the cycle by its name, a cup tilted by 30° from the load in walking, by 0° in rocking; a cup given as "
    "45° and 65° by 30° and 50°, since the load of a hip leans by some 15°",
    "patients: ISO 14242-1 for every step, 1.5 million steps a year within a factor of 1.5, a body weight of "
    "780 ± 130 N around the force of the cycle; a tilt of 30 ± 7°, heads of 28 mm; creep by the logarithmic "
    "law, not verified",
)
"""What was put in where the sources do not tell it: nearly all of it."""

_LINERS = {22.225: 10.9, 28.0: 8.0, 32.0: 7.0, 36.0: 6.0}
_K = LogNormal(median=1.0, factor=1.5)
_CLEARANCE = Rectangular(low=0.05, high=0.2)
PATIENTS = 64


def in_use(diameter: float, cycle: Cycle, tilt_deg: float = 30.0, wear: WearLaw | None = None) -> HipSimulation:
    """A hip of a head of this diameter in mm, with the rest of `INPUTS`."""
    joint = Joint(
        ball_radius=diameter / 2,
        clearance=0.1,
        liner_thickness=_LINERS[diameter],
        liner=Material(young=1000.0, poisson=0.4),
    )
    law = wear or Archard(coefficient=CONVENTIONAL)
    return HipSimulation(joint=joint, cycle=cycle, wear=law, cup=Cup(inclination=radians(tilt_deg)))


@dataclass(frozen=True, kw_only=True)
class Predicted:
    """A prediction with its band.

    Attributes
    ----------
    name : str
        Of what was `PUBLISHED`.
    low, median, high : float
    """

    name: str
    low: float
    median: float
    high: float


@dataclass(frozen=True, kw_only=True)
class Ratio:
    """A measured rate over another, and what the laws say of it, whatever their coefficients are.

    Attributes
    ----------
    one, other : str
        Names of what was `PUBLISHED`.
    archard : float
    area : float, optional
        By the area law.
    """

    one: str
    other: str
    archard: float
    area: float | None = None


def ratios() -> Iterator[Ratio]:
    """The ratios of rates of unworn bores."""
    walk, off = iso_14242_1(), iso_14242_4()
    area = ContactAreaWear(coefficient=1e-6)
    rocked = [in_use(28.0, rocking(), 0.0), in_use(22.225, rocking(), 0.0)]
    yield Ratio(
        one="clarke-28",
        other="clarke-22",
        archard=_rate(rocked[0]) / _rate(rocked[1]),
        area=_rate(replace(rocked[0], wear=area)) / _rate(replace(rocked[1], wear=area)),
    )
    for one, other, cycles, tilts in (
        ("ali-65", "ali-45", (walk, walk), (50.0, 30.0)),
        ("ali-45-off", "ali-45", (off, walk), (30.0, 30.0)),
        ("ali-65-off", "ali-65", (off, walk), (50.0, 50.0)),
        ("cooper-off", "cooper", (off, walk), (30.0, 30.0)),
        ("jogging", "walking", (named_cycle("jogging", body_weight=780.0), walk), (30.0, 30.0)),
    ):
        hips = [in_use(36.0, cycle, tilt) for cycle, tilt in zip(cycles, tilts, strict=True)]
        yield Ratio(one=one, other=other, archard=_rate(hips[0]) / _rate(hips[1]))


def _rate(use: HipSimulation) -> float:
    """The rate of the first cycle, in mm³ a million."""
    return use.first.volume


def simulators(count: int = PATIENTS) -> Iterator[Predicted]:
    """Rates between one and three million cycles, k and the clearance scattering."""
    for name, diameter, cycle, tilt, k in (
        ("clarke-22", 22.225, rocking(), 0.0, CONVENTIONAL),
        ("clarke-28", 28.0, rocking(), 0.0, CONVENTIONAL),
        ("ali-45", 36.0, iso_14242_1(), 30.0, LINKED),
        ("ali-65", 36.0, iso_14242_1(), 50.0, LINKED),
        ("ali-45-off", 36.0, iso_14242_4(), 30.0, LINKED),
        ("ali-65-off", 36.0, iso_14242_4(), 50.0, LINKED),
    ):
        use = in_use(diameter, cycle, tilt, Archard(coefficient=k))
        table = _table(use, {"coefficient": _of(k), "clearance": _CLEARANCE}, [1e6, 3e6], count)
        volume = table[:, :, list(RESULT_UNITS).index("volume")]
        yield _band(name, (volume[:, 1] - volume[:, 0]) / 2)


def patients(count: int = PATIENTS) -> Iterator[Predicted]:
    """Bedding-in, rates and volumes a year of patients who differ."""
    for k, names in (
        (CONVENTIONAL, ("rsa-bedding", "rsa-rate", "teeter")),
        (LINKED, ("rsa-bedding-linked", "rsa-rate-linked", "mccalden-linked", "callary", "lachiewicz")),
    ):
        use = replace(
            in_use(28.0, iso_14242_1(), 30.0, Archard(coefficient=k)),
            creep=logarithmic(),
            seconds_per_cycle=YEAR / STEPS,
        )
        table = _table(use, _patients(k), [STEPS / 4, STEPS, 5 * STEPS, 10 * STEPS], count)
        sunk = table[:, :, list(RESULT_UNITS).index("penetration")]
        rate = dict.fromkeys(names, (sunk[:, 3] - sunk[:, 0]) / 9.75)
        rate |= {names[0]: sunk[:, 0]}
        rate |= {name: (sunk[:, 2] - sunk[:, 1]) / 4 for name in names if name.startswith("mccalden")}
        for name, values in rate.items():
            yield _band(name, values)
        if k == LINKED:
            yield _band("lachiewicz-volume", table[:, 2, list(RESULT_UNITS).index("volume")] / 5)


def _patients(k: float) -> dict[str, Distribution]:
    return {
        "coefficient": _of(k),
        "clearance": _CLEARANCE,
        "tilt": Normal(mean=radians(30.0), deviation=radians(7.0), low=0.0, high=radians(60.0)),
        "body_weight": Normal(mean=780.0, deviation=130.0, low=400.0, high=1400.0),
        "cycles_per_year": LogNormal(median=STEPS, factor=1.5),
    }


def _of(k: float) -> LogNormal:
    return LogNormal(median=k * _K.median, factor=_K.factor)


def _table(use: HipSimulation, distributions: dict[str, Distribution], counts: list[float], count: int) -> Numbers:
    return population(PatientVariability(use=use, distributions=distributions), counts, patients=count)[1].cohort.table


def _band(name: str, values: Numbers) -> Predicted:
    rest = (1 - DEFAULT_LEVEL) / 2
    low, median, high = (float(each) for each in numpy.nanquantile(values, [rest, 0.5, 1 - rest]))
    return Predicted(name=name, low=low, median=median, high=high)
