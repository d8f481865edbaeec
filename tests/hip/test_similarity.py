"""Similarity of patients on springs: dimensionless numbers, members of a family, and where they do not hold."""

from dataclasses import replace
from math import log, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.hip import FilmLimit, iso_14242_1, iso_14242_4, logarithmic
from ballsocket.hip.similarity import Similarity, find_obstacle
from ballsocket.hip.variability import RESULT_UNITS, result_table
from ballsocket.hip.wear_law import CycleExposure
from ballsocket.hip.wear_laws import WEAR_LAWS, Archard, ContactAreaWear, CrossShear, CustomWearLaw, FrictionEnergyWear
from ballsocket.studies import LogNormal, Normal, Rectangular

from .hips import QUICK, K, hip
from .test_variability import TIGHT, WEIGHT, variability

COUNTS = (3e5, 1e6)
RATE = LogNormal(median=1.5e6, factor=1.5)


def relative_difference(use, values, coefficient=K, **distributions):
    """Largest relative difference between a patient and the family member with the same dimensionless numbers."""
    spread = {"coefficient": LogNormal(median=coefficient, factor=1.5), "clearance": TIGHT, "body_weight": WEIGHT}
    patients = variability(use, **spread, cycles_per_year=RATE, **distributions)
    similarity = Similarity(variability=patients)
    arrays = {name: np.array([value]) for name, value in values.items()}
    numbers = {name: float(column[0]) for name, column in similarity.numbers(arrays).items()}
    exposures = [float(similarity.log_exposure(arrays)[0]) + log(count) for count in COUNTS]
    member = similarity.simulate(numbers, exposures)
    reports = patients.patient(values).simulate(COUNTS)
    units = similarity.units(np.array([values["clearance"]]))
    worn = np.exp(member.worn[:, : len(similarity.results)])
    scaled = worn * np.array([float(units[name][0]) for name in similarity.results])
    columns = [list(RESULT_UNITS).index(name) for name in similarity.results]
    assert_equal_contacts(similarity, values["clearance"], member.worn[:, len(similarity.results) :], reports)
    return abs(scaled / result_table(reports)[:, columns] - 1).max()


def assert_equal_contacts(similarity, clearance, numbers, reports):
    """Compare rim distance, indentation, half angle and largest pressure with those of a patient's reports."""
    pressure_unit = float(similarity.modulus(clearance)) * clearance
    for (rim, _, indentation, half_angle, pressure), report in zip(numbers, reports, strict=True):
        distance = max(rim, 0.0) * float(similarity.socket_radius(clearance))
        assert distance == pytest.approx(report.edge_distance.min(), rel=1e-9, abs=1e-9)
        scaled = np.exp(indentation) * clearance, half_angle, np.exp(pressure) * pressure_unit
        assert scaled == pytest.approx(report.worst_contacts[0, 2:5], rel=1e-9)


@pytest.mark.parametrize(
    ("wear", "coefficient"),
    [
        (Archard(coefficient=K), K),
        (FrictionEnergyWear(coefficient=2e-5, friction=0.05), 2e-5),
        (CrossShear(straight=K, circular=2 * K, exponent=-0.3), K),
        (ContactAreaWear(coefficient=1e-9), 1e-9),
    ],
    ids=lambda value: type(value).__name__,
)
def test_patients_with_the_same_dimensionless_numbers_wear_alike(wear, coefficient):
    values = {"clearance": 0.16, "body_weight": 900.0, "coefficient": coefficient / 2, "cycles_per_year": 2.1e6}
    values |= {"tilt": 0.5}
    tilt = Rectangular(low=0.0, high=1.0)
    assert relative_difference(hip(**QUICK, wear=wear), values, coefficient, tilt=tilt) < 1e-10


def test_creeping_patients_wear_alike_at_the_same_time_per_exposure():
    use = hip(**QUICK, creep=logarithmic(), seconds_per_cycle=20.0)
    values = {"clearance": 0.06, "body_weight": 650.0, "coefficient": 2 * K, "cycles_per_year": 1e6}
    values |= {"inclination": 0.7, "anteversion": 0.2}
    angles = {"inclination": Rectangular(low=0.4, high=1.0), "anteversion": Rectangular(low=0.0, high=0.5)}
    assert relative_difference(use, values, **angles) < 1e-10


@pytest.mark.parametrize("law", WEAR_LAWS.values(), ids=lambda law: law.name)
def test_a_law_has_its_degree_in_the_pressure(law):
    wear = law(**{field.name: field.example for field in law.law_fields()})
    wear = replace(wear, exponent=0.4) if isinstance(wear, CrossShear) else wear
    use = hip(**QUICK, wear=wear)
    exposure = use.exposure(use.unworn)
    trebled = CycleExposure(pressure=3 * exposure.pressure, sliding=exposure.sliding)
    cells = CycleExposure(pressure=exposure.pressure, sliding=exposure.sliding)
    np.testing.assert_allclose(wear.depth(trebled), 3**wear.pressure_degree * wear.depth(cells), rtol=1e-12)


def test_a_family_does_not_depend_on_lengths():
    """The numbers of a bore of twice the size and clearance, under four times the load, are the same."""
    one, two = (
        Similarity(variability=variability(hip(diameter, liner, clearance), clearance=TIGHT, body_weight=WEIGHT))
        for diameter, liner, clearance in ((28.0, 8.0, 0.1), (56.0, 16.0, 0.2))
    )
    small = one.numbers({"clearance": np.array([0.1]), "body_weight": np.array([800.0])})
    large = two.numbers({"clearance": np.array([0.2]), "body_weight": np.array([3200.0])})
    assert large["force"] == pytest.approx(small["force"], abs=1e-12)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"wear": CustomWearLaw(function=lambda cycle: 1e-9 * cycle.work)}, "CustomWearLaw has no known degree"),
        ({"ball_wear": Archard(coefficient=K)}, "the ball wears too"),
        ({"film_limit": FilmLimit(ratio=1.0, lubricant=bs.Lubricant())}, "wear has a limit of the film ratio"),
        ({"cycle": iso_14242_4()}, "the cycle has a lateral spring"),
        ({"cup": bs.Cup(inclination=radians(30.0), chamfer=1.0)}, "the chamfer of the rim has a length"),
    ],
    ids=["law", "ball", "film", "spring", "chamfer"],
)
def test_patients_who_are_not_similar_have_a_reason(words, message):
    use = hip(**(QUICK | words))
    assert message in find_obstacle(variability(use, clearance=TIGHT), COUNTS)


def test_similar_patients_have_no_obstacle():
    chamfered = hip(**QUICK, cup=bs.Cup(inclination=radians(30.0), chamfer=1.0))
    assert find_obstacle(variability(chamfered, body_weight=WEIGHT), COUNTS) == ""
    assert find_obstacle(variability(hip(**QUICK), clearance=TIGHT), COUNTS) == ""
    assert "a report is at 0 cycles" in find_obstacle(variability(hip(**QUICK), clearance=TIGHT), (0.0, 1e6))
    closed = variability(hip(**QUICK), clearance=Normal(mean=-0.1, deviation=0.1))
    assert "the clearance is not positive" in find_obstacle(closed, COUNTS)


def test_loads_that_point_to_the_rim_are_found():
    similarity = Similarity(variability=variability(hip(cycle=iso_14242_1(16)), tilt=Rectangular(low=0.0, high=1.5)))
    inside = [similarity.keeps_loads_inside({"tilt": radians(tilt)}) for tilt in (0.0, 60.0, 84.0, 86.0, 95.0)]
    assert inside == [True, True, True, False, False]
