"""Published wear of hips, and the predictions of the wear laws for the same tests and patients."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import radians
from types import MappingProxyType

import numpy

from ..core.arrays import Numbers
from ..hip.creep_laws import logarithmic
from ..hip.cycle import Cycle
from ..hip.cycle_registry import named_cycle
from ..hip.microseparation import MEASURED_SEPARATIONS
from ..hip.simulation import HipSimulation
from ..hip.simulator_cycles import iso_14242_1, iso_14242_4, rocking
from ..hip.variability import DEFAULT_LEVEL, RESULT_COLUMNS, PatientVariability
from ..hip.wear_law import WearLaw
from ..hip.wear_laws import Archard, ContactAreaWear
from ..hip.wear_uncertainty import population
from ..problem import Joint, Material
from ..problem.cup import Cup
from ..studies.distributions import Distribution, LogNormal, Normal, Rectangular


@dataclass(frozen=True)
class Published:
    """Published wear or penetration."""

    description: str  # test or patients
    value: float
    unit: str
    source: str
    half_width: float = 0.0  # half the width of the interval of `spread`; 0 without one
    spread: str = ""  # kind of the interval: a confidence level, the deviation or the range
    read: str = "abstract"  # part of the source that was read

    def __str__(self) -> str:
        return f"{self.value:g} ± {self.half_width:g}" if self.half_width else f"{self.value:g}"


_CLARKE = "Clarke et al., ceramic heads of different sizes on polyethylene"
_ALI = "Ali et al., Bone Joint J Orthop Proc"
_COOPER = "Cooper et al. 2023, Orthop Proc 105-B SUPP 9"
_JOGGING = "Bioengineering 2025, 12, 663"
_RSA = "10-year radiostereometry, 10.1080/17453674.2021.1932140"
_MCCALDEN = "McCalden et al. 2009, 10.2106/JBJS.H.00244"
_RATE = "mm3/Mc"

_CALLARY = "Callary et al. 2015, 10.3109/17453674.2014.972890"
_LACHIEWICZ = "Lachiewicz et al. 2009, 10.1007/s11999-009-1038-9"


PUBLISHED: Mapping[str, Published] = MappingProxyType(
    {
        "clarke-22": Published("22 mm, serum, 2 kN", 23, _RATE, _CLARKE),
        "clarke-28": Published("28 mm, serum, 2 kN", 32, _RATE, _CLARKE),
        "ali-45": Published("36 mm, cup at 45°", 12.8, _RATE, _ALI, 3.8, "95 %"),
        "ali-65": Published("36 mm, cup at 65°", 15.4, _RATE, _ALI, 5.0, "95 %"),
        "ali-45-off": Published("36 mm, 45°, centres 4 mm off", 21.5, _RATE, _ALI, 5.5, "95 %"),
        "ali-65-off": Published("36 mm, 65°, centres 4 mm off", 23.0, _RATE, _ALI, 5.7, "95 %"),
        **{
            f"ali-{angle[:-1]}-separation": Published(
                f"medial-lateral separation, 36 mm, {angle}, centres 4 mm off", value, "mm", _ALI, interval, "as stated"
            )
            for angle, (value, interval) in MEASURED_SEPARATIONS.items()
        },
        "cooper": Published("ISO 14242-1", 12.5, _RATE, _COOPER),
        "cooper-off": Published("then ISO 14242-4", 22.3, _RATE, _COOPER),
        "walking": Published("ISO walking", 15.24, _RATE, _JOGGING, 0.55, "deviation"),
        "jogging": Published("a patient's jogging", 28.68, _RATE, _JOGGING, 0.88, "deviation"),
        "saikko": Published("32 mm zirconia, distilled water", 4.1, "mg/Mc", "Saikko 1994, Wear 176, 207"),
        "rsa-bedding": Published("conventional, first 3 months", 0.39, "mm", _RSA),
        "rsa-rate": Published("conventional, 3 months to 10 years", 0.12, "mm/year", _RSA),
        "rsa-bedding-linked": Published("cross-linked, first 3 months", 0.21, "mm", _RSA),
        "rsa-rate-linked": Published("cross-linked, 3 months to 10 years", 0.02, "mm/year", _RSA),
        "mccalden-linked": Published("cross-linked, years 1 to 5", 0.003, "mm/year", _MCCALDEN, 0.027, "95 %"),
        "teeter": Published(
            "conventional 28 mm, after bedding-in", 0.051, "mm/year", "Teeter 2017", read="second hand"
        ),
        "callary": Published("cross-linked, 12 cohorts", 0.03, "mm/year", _CALLARY, 0.03, "range"),
        "lachiewicz": Published("cross-linked, median", 0.028, "mm/year", _LACHIEWICZ),
        "lachiewicz-volume": Published("cross-linked, median", 25.6, "mm3/year", _LACHIEWICZ),
    }
)
"""Published numbers by name. The test conditions are those of the sources."""

CONVENTIONAL, LINKED = 1.066e-6, 2e-7
"""Wear factors k in mm³/(N m); published for cross-linked polyethylene: 1e-7 to 4e-7."""

STEPS, YEAR = 1.5e6, 365.25 * 86400.0  # steps of the mean patient per year, and seconds per year

INPUTS = (
    "E 1 GPa, ν 0.4, clearance 0.1 mm, the paper's springs; liners of 8 mm (28 mm), 10.9 mm (22 mm), 6 mm (36 mm), "
    "7 mm (32 mm)",
    "k = 1.066e-6 mm³/(N m) for conventional polyethylene, 2e-7 for cross-linked, each within a factor of 1.5 (one "
    "standard deviation); clearance 0.05 to 0.2 mm",
    "simulators: the cycle by its name, a cup tilted by 30° from the load in walking, by 0° in rocking; a cup stated "
    "at 45° and 65° by 30° and 50°, since the load of a hip leans by some 15°",
    "patients: ISO 14242-1 for every step, 1.5 million steps a year within a factor of 1.5, a body weight of "
    "780 ± 130 N around the force of the cycle; a tilt of 30 ± 7°, heads of 28 mm; creep by the logarithmic "
    "law, not verified",
)
"""Assumed inputs: the sources state only a few."""

_LINERS = {22.225: 10.9, 28.0: 8.0, 32.0: 7.0, 36.0: 6.0}
_CLEARANCE = Rectangular(low=0.05, high=0.2)
PATIENTS = 64


def make_hip(diameter: float, cycle: Cycle, tilt_deg: float = 30.0, wear: WearLaw | None = None) -> HipSimulation:
    """Create the simulation of a hip with a head diameter in mm and the assumed inputs."""
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
    """Predicted number with its band of 95 %."""

    name: str  # name in `PUBLISHED`
    low: float
    median: float
    high: float


@dataclass(frozen=True, kw_only=True)
class Ratio:
    """Ratio of two measured wear rates, as the laws predict it independently of their coefficients."""

    # names in `PUBLISHED`
    numerator: str
    denominator: str
    archard: float  # ratio by Archard's law
    area: float | None = None  # ratio by the area law


def ratios() -> Iterator[Ratio]:
    """Compute ratios of the wear rates of unworn bores."""
    walk, off = iso_14242_1(), iso_14242_4()
    area = ContactAreaWear(coefficient=1e-6)
    large, small = (make_hip(diameter, rocking(), 0.0) for diameter in (28.0, 22.225))
    yield Ratio(
        numerator="clarke-28",
        denominator="clarke-22",
        archard=large.first.volume / small.first.volume,
        area=replace(large, wear=area).first.volume / replace(small, wear=area).first.volume,
    )
    for numerator, denominator, first, second in (
        ("ali-65", "ali-45", (walk, 50.0), (walk, 30.0)),
        ("ali-45-off", "ali-45", (off, 30.0), (walk, 30.0)),
        ("ali-65-off", "ali-65", (off, 50.0), (walk, 50.0)),
        ("cooper-off", "cooper", (off, 30.0), (walk, 30.0)),
        ("jogging", "walking", (named_cycle("jogging", body_weight=780.0), 30.0), (walk, 30.0)),
    ):
        ratio = make_hip(36.0, *first).first.volume / make_hip(36.0, *second).first.volume
        yield Ratio(numerator=numerator, denominator=denominator, archard=ratio)


def separations() -> Iterator[tuple[str, float, float]]:
    """Compute medial-lateral separation and distance of the centres in mm, with the name of the measured one."""
    for angle, tilt in zip(MEASURED_SEPARATIONS, (30.0, 50.0), strict=True):
        apart = make_hip(36.0, iso_14242_4(), tilt).frame.separation
        assert apart is not None
        yield f"ali-{angle[:-1]}-separation", apart.medial_lateral, apart.centre_distance


def simulators(count: int = PATIENTS) -> Iterator[Predicted]:
    """Predict wear rates between one and three million cycles, with uncertain k and clearance."""
    for name, diameter, cycle, tilt, k in (
        ("clarke-22", 22.225, rocking(), 0.0, CONVENTIONAL),
        ("clarke-28", 28.0, rocking(), 0.0, CONVENTIONAL),
        ("ali-45", 36.0, iso_14242_1(), 30.0, LINKED),
        ("ali-65", 36.0, iso_14242_1(), 50.0, LINKED),
        ("ali-45-off", 36.0, iso_14242_4(), 30.0, LINKED),
        ("ali-65-off", 36.0, iso_14242_4(), 50.0, LINKED),
    ):
        hip = make_hip(diameter, cycle, tilt, Archard(coefficient=k))
        distributions: Mapping[str, Distribution] = {
            "coefficient": LogNormal(median=k, factor=1.5),
            "clearance": _CLEARANCE,
        }
        table = _results(hip, distributions, [1e6, 3e6], count)
        volume = table[:, :, RESULT_COLUMNS["volume"]]
        yield _band(name, (volume[:, 1] - volume[:, 0]) / 2)


def patients(count: int = PATIENTS) -> Iterator[Predicted]:
    """Predict bedding-in, yearly rates and volumes of varied patients."""
    for k, names in (
        (CONVENTIONAL, ("rsa-bedding", "rsa-rate", "teeter")),
        (LINKED, ("rsa-bedding-linked", "rsa-rate-linked", "mccalden-linked", "callary", "lachiewicz")),
    ):
        hip = replace(
            make_hip(28.0, iso_14242_1(), 30.0, Archard(coefficient=k)),
            creep=logarithmic(),
            seconds_per_cycle=YEAR / STEPS,
        )
        distributions: Mapping[str, Distribution] = {
            "coefficient": LogNormal(median=k, factor=1.5),
            "clearance": _CLEARANCE,
            "tilt": Normal(mean=radians(30.0), deviation=radians(7.0), low=0.0, high=radians(60.0)),
            "body_weight": Normal(mean=780.0, deviation=130.0, low=400.0, high=1400.0),
            "cycles_per_year": LogNormal(median=STEPS, factor=1.5),
        }
        table = _results(hip, distributions, [STEPS / 4, STEPS, 5 * STEPS, 10 * STEPS], count)
        penetration = table[:, :, RESULT_COLUMNS["penetration"]]
        rate = dict.fromkeys(names, (penetration[:, 3] - penetration[:, 0]) / 9.75)
        rate |= {names[0]: penetration[:, 0]}
        rate |= {name: (penetration[:, 2] - penetration[:, 1]) / 4 for name in names if name.startswith("mccalden")}
        for name, values in rate.items():
            yield _band(name, values)
        if k == LINKED:
            yield _band("lachiewicz-volume", table[:, 2, RESULT_COLUMNS["volume"]] / 5)


def _results(hip: HipSimulation, distributions: Mapping[str, Distribution], counts: list[float], count: int) -> Numbers:
    """Simulate patients and return their results, shape (patients, cycle counts, quantities)."""
    return population(PatientVariability(use=hip, distributions=distributions), counts, patients=count)[1].cohort.table


def _band(name: str, values: Numbers) -> Predicted:
    tail = (1 - DEFAULT_LEVEL) / 2
    low, median, high = (float(value) for value in numpy.nanquantile(values, [tail, 0.5, 1 - tail]))
    return Predicted(name=name, low=low, median=median, high=high)
