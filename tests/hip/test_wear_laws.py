"""Wear laws and creep laws on small exposures with depths by hand, their limits, units and JSON."""

import re
from dataclasses import FrozenInstanceError
from types import SimpleNamespace

import numpy as np
import pytest

from ballsocket.hip import (
    Archard,
    ContactAreaWear,
    CrossShear,
    CustomWearLaw,
    FrictionEnergyWear,
    KelvinVoigtChain,
    LogarithmicCreep,
)
from ballsocket.hip.creep_law import confinement_note
from ballsocket.hip.creep_laws import CREEP_LAWS, read_creep_law
from ballsocket.hip.law_fields import law_keys, law_summary
from ballsocket.hip.wear_law import (
    CycleExposure,
    coefficient_field,
    max_wear_sensitivity,
    wear_factor,
    wear_per_energy,
    wear_per_slide,
    with_coefficient,
)
from ballsocket.hip.wear_laws import WEAR_LAWS, read_ball_law, read_wear_law

PRESSURE = np.array([[2.0, 0.0, 4.0], [3.0, 0.0, 0.0]])
SLIDES = np.array([[1.0, 5.0, 2.0], [2.0, 7.0, 3.0]])
SHARES = np.array([[1.0, 0.0, 0.5], [0.25, 0.0, 0.0]])
WORK = np.array([8.0, 0.0, 8.0])
CROSS_SHEAR = np.array([0.0, 0.1, 0.5])


def exposure(pressure=PRESSURE, shares=SHARES):
    sliding = SimpleNamespace(steps=SLIDES, distances=SLIDES, cross_shear=lambda pressure: CROSS_SHEAR)
    return CycleExposure(pressure=pressure, sliding=sliding, contact_shares=None if shares is None else lambda: shares)


def test_depths_are_those_of_the_formulas():
    cycle = exposure()
    assert cycle.work == pytest.approx(WORK, rel=1e-15)
    assert Archard(coefficient=2e-6).depth(cycle) == pytest.approx(2e-9 * WORK, rel=1e-15)
    energy = FrictionEnergyWear(coefficient=4e-5, friction=0.05)
    assert energy.depth(cycle) == pytest.approx(2e-9 * WORK, rel=1e-14)
    assert ContactAreaWear(coefficient=3e-9).depth(cycle) == pytest.approx([4.5e-9, 0.0, 3e-9], rel=1e-15)
    assert CustomWearLaw(function=lambda cycle: 5 * cycle.work).depth(cycle) == pytest.approx(5 * WORK)


def test_cross_shear_interpolates_the_wear_factor_and_scales_it_with_the_mean_pressure():
    law = CrossShear(straight=1e-6, circular=3e-6)
    assert law.depth(exposure()) == pytest.approx([8e-9, 0.0, 24e-9], rel=1e-14)
    mean = np.array([8.0 / 3.0, 1.0, 4.0])  # over the slides in contact: 3 mm and 2 mm
    steep = CrossShear(straight=1e-6, circular=3e-6, exponent=0.5, reference=2.0)
    assert steep.depth(exposure()) == pytest.approx(np.array([8e-9, 0.0, 24e-9]) * (mean / 2) ** 0.5, rel=1e-14)


def test_a_positive_pressure_is_complete_contact_without_contact_shares():
    assert exposure(shares=None).contact.tolist() == [[1.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    assert exposure().contact.tolist() == SHARES.tolist()


def test_wear_sensitivity_is_the_derivative_by_the_pressure():
    cycle = exposure()
    slide_in_contact = 3.0
    assert max_wear_sensitivity(Archard(coefficient=1e-6), cycle) == pytest.approx(1e-9 * slide_in_contact, rel=1e-6)
    assert max_wear_sensitivity(ContactAreaWear(coefficient=1e-6), cycle) == 0.0
    assert max_wear_sensitivity(Archard(coefficient=1e-6), exposure(pressure=0 * PRESSURE)) == 0.0


def test_limits_themselves_are_allowed_where_stated():
    assert Archard(coefficient=0.0).depth(exposure()).max() == 0
    CrossShear(straight=0.0, circular=0.0, exponent=-0.999, reference=1e-9)
    FrictionEnergyWear(coefficient=0.0, friction=0.0)
    KelvinVoigtChain(compliances=[0.0], times=np.array([1.0]), confinement=0.0)


def test_laws_are_frozen():
    with pytest.raises(FrozenInstanceError):
        Archard(coefficient=1e-6).coefficient = 2e-6


def test_notes_name_wear_factors_outside_the_usual_range():
    assert Archard(coefficient=1e-6).notes == Archard(coefficient=0.0).notes == ()
    for value in (1e-9, 1e-4):
        assert Archard(coefficient=value).notes == ()
    for value in (0.9e-9, 1.1e-4):
        assert Archard(coefficient=value).notes[0].startswith(f"a wear factor of {value:g} mm^3/(N m)")
    assert CrossShear(straight=1e-6, circular=1e-3).notes[0].startswith("a wear factor of 0.001")
    assert FrictionEnergyWear(coefficient=1e-3, friction=1e-2).notes == ()
    assert ContactAreaWear(coefficient=1.0).notes == ()


def test_another_coefficient_keeps_the_other_numbers():
    assert with_coefficient(Archard(coefficient=1e-6), 2e-6) == Archard(coefficient=2e-6)
    energy = FrictionEnergyWear(coefficient=1e-5, friction=0.1)
    assert with_coefficient(energy, 2e-5) == FrictionEnergyWear(coefficient=2e-5, friction=0.1)
    scaled = with_coefficient(CrossShear(straight=2e-6, circular=6e-6, exponent=0.5), 1e-6)
    assert (scaled.straight, scaled.circular, scaled.exponent) == pytest.approx((1e-6, 3e-6, 0.5))


def test_registered_laws_state_names_units_and_examples():
    for registry in (WEAR_LAWS, CREEP_LAWS):
        for name, law in registry.items():
            assert law.name == name
            assert law.title
            made = law(**{field.name: field.example for field in law.law_fields()})
            assert made.summary()["law"] == name
            assert made.storable
    assert [coefficient_field(WEAR_LAWS[name](**words)).unit.text for name, words in EXAMPLES.items()] == [
        "mm³/(N m)",
        "mm³/J",
        "mm/mm",
        "mm³/(N m)",
    ]
    assert set(law_keys(WEAR_LAWS)) == {"coefficient", "friction", "circular", "exponent", "reference"}


EXAMPLES = {
    "archard": {"coefficient": 1e-6},
    "energy": {"coefficient": 1e-5, "friction": 0.1},
    "area": {"coefficient": 1e-9},
    "cross-shear": {"straight": 1e-6, "circular": 2e-6},
}


def test_summaries_have_units_in_their_keys():
    assert law_summary(None) is None
    assert law_summary(CrossShear(straight=1e-6, circular=2e-6)) == {
        "law": "cross-shear",
        "straight_mm3_per_Nm": 1e-6,
        "circular_mm3_per_Nm": 2e-6,
        "exponent": 0.0,
        "reference_MPa": 1.0,
    }
    chain = KelvinVoigtChain(compliances=(1e-3,), times=(60.0,))
    assert law_summary(chain) == {"law": "kelvin-voigt", "compliances_per_MPa": [1e-3], "times_s": [60.0]}
    assert law_summary(SimpleNamespace(depth=None)) == {"law": "SimpleNamespace"}


def test_laws_are_read_with_their_units():
    archard = read_wear_law({"coefficient": "2e-15 m^3/(N m)"})
    assert (archard.name, archard.coefficient) == ("archard", pytest.approx(2e-6))
    law = read_wear_law({"law": "cross-shear", "coefficient": 1e-6, "circular": 2e-6, "reference": "500 kPa"})
    assert (law.reference, law.exponent) == (pytest.approx(0.5), 0.0)
    table = {"law": "energy", "coefficient": 1e-6, "friction": 0.1}
    assert read_ball_law(table) is None
    ball = read_ball_law({**table, "ball_coefficient": "3 mm^3/MJ"})
    assert (ball.name, ball.coefficient, ball.friction) == ("energy", pytest.approx(3e-6), 0.1)
    assert (wear_factor("k", 1), wear_per_energy("e", 2), wear_per_slide("C", "3 mm/m")) == (1, 2, pytest.approx(3e-3))


def test_the_creep_law_follows_from_its_keys():
    assert read_creep_law({}, 0.4) == LogarithmicCreep()
    chain = read_creep_law({"compliances": [1e-3], "times": [60], "confinement": "constrained"}, 0.4)
    assert (chain.compliances, chain.times, chain.confinement) == ((1e-3,), (60.0,), pytest.approx(7 / 15))
    note = re.fullmatch(
        "creep strain is ([0-9.]+) of that of a free bar: the liner is laterally constrained",
        confinement_note(chain, 0.4),
    )
    assert float(note[1]) == pytest.approx(7 / 15, abs=1e-3)
    assert "is 0.47 of that" in confinement_note(LogarithmicCreep(), 0.4)
    assert confinement_note(LogarithmicCreep(), 0.0) == confinement_note(LogarithmicCreep(), -0.2) == ""
    assert "is 0 of that" in confinement_note(LogarithmicCreep(), 0.5)
