"""Bands of 95 %: profile likelihood, identifiability over the ranges, scatter, and errors of the machine."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import MACHINE_ERRORS, HeavyTailed, Machine, Measured
from ballsocket.identify.experiment import standard_candidates
from ballsocket.studies import Normal

TRUTH = bs.Joint(ball_radius=15.3, clearance=0.12, liner_thickness=7.4, liner=bs.Material(young=780.0, poisson=0.42))
VALUES = {"clearance": 0.12, "liner_young": 780.0}
FREE = {"clearance": (0.02, 0.4), "liner.young": (300.0, 2500.0)}
NARROW = {"clearance": (0.05, 0.3), "liner.young": (600.0, 1000.0)}
MODEL = bs.HessForsbach()
FORCE, PRESS = np.linspace(500.0, 3000.0, 6), np.linspace(250.0, 3000.0, 12)
CONTACT, DEPTH = MODEL.press(TRUTH, force=FORCE), MODEL.press(TRUTH, force=PRESS).indentation


def identified(*data, free=FREE, **words):
    return bs.identify(MODEL, TRUTH, data, free, **words)


def angles_and_pressures(seed):
    random = np.random.default_rng(seed)
    angles = CONTACT.half_angle + 0.008 * random.standard_normal(6)
    pressures = CONTACT.max_pressure * (1 + 0.02 * random.standard_normal(6))
    return (
        Measured(quantity="half_angle", values=angles, uncertainty=0.008, force=FORCE),
        Measured(quantity="max_pressure", values=pressures, uncertainty=0.02 * CONTACT.max_pressure, force=FORCE),
    )


def indentations(values=DEPTH, **words):
    return Measured(quantity="indentation", values=values, uncertainty=4e-4, force=PRESS, **words)


@pytest.mark.parametrize(
    ("seed", "free"),
    [(1021, FREE), (1057, FREE), (1021, {**FREE, "liner.young": (100.0, 8000.0)}), (1057, NARROW)],
    ids=["1021", "1057", "wide", "narrow"],
)
def test_half_angles_and_pressures_identify_only_the_product(seed, free):
    """The best points of these sets lie near an end of the clearances, where the local information is large."""
    fit = identified(*angles_and_pressures(seed), free=free)
    assert fit.information.unidentifiable == ("clearance", "liner_young")
    assert fit.information.rank == 1
    assert not fit.identifiable
    (product,) = fit.information.products
    assert product.exponents == {"clearance": 1.0, "liner_young": 1.0}
    assert product.low < 93.6 < product.high
    assert fit["liner_young"].low <= 780.0 <= fit["liner_young"].high
    assert "only clearance · liner_young is identifiable" in fit.notes[0]
    assert fit.sensitivity == ()  # no indentations, which a machine would read


def test_an_unknown_is_identifiable_by_its_prior_or_beside_one_that_is_not():
    known = identified(*angles_and_pressures(1021), free={**FREE, "clearance": Normal(mean=0.12, deviation=0.01)})
    assert (known.identifiable, known.information.rank) == (True, 2)
    fit = identified(indentations(), *angles_and_pressures(3), free={**FREE, "liner.poisson": (0.415, 0.425)})
    assert (fit.information.unidentifiable, fit.information.rank) == (("liner_poisson",), 2)


def test_an_end_of_a_profile_is_a_constrained_minimum_at_the_limit_of_the_rise():
    fit = identified(indentations(), *angles_and_pressures(3))
    for index, interval in enumerate(fit.information.intervals):
        for end in (interval.low, interval.high):
            neighbours = end.theta + np.outer(np.linspace(-0.05, 0.05, 201), np.eye(2)[1 - index])
            rises = 2 * (fit.misfit.costs(neighbours) - fit.best.cost)
            assert rises.min() == pytest.approx(1.96**2, rel=0.05)
            assert rises[100] == pytest.approx(rises.min(), abs=0.05)


def test_a_band_that_ends_at_an_end_of_a_range_is_reported():
    fit = identified(*angles_and_pressures(1000), free=NARROW)
    assert (fit["liner_young"].low, fit["liner_young"].high) == (600.0, 1000.0)
    assert fit["liner_young"].limited_by == ("liner_young",)
    assert fit["clearance"].limited_by == ("liner_young",)
    assert "the band of liner_young ends at 600 and 1000, the end of its range" in fit.notes
    assert "the band of clearance ends where the range of liner_young ends" in fit.notes


def test_a_band_may_end_at_a_physical_limit():
    """A very stiff machine is identifiable: its compliance cannot be below 0."""
    machine = Machine(compliance=(0.0, 2e-5))
    fit = identified(indentations(machine=machine), free={"clearance": (0.02, 0.4)})
    compliance = fit["machine.compliance"]
    assert compliance.identifiable
    assert compliance.low == 0.0 <= compliance.value < compliance.high < 1e-6


@pytest.mark.long
@pytest.mark.parametrize("factor", [1.0, 2.0])
@pytest.mark.parametrize("scatter", [None, HeavyTailed()], ids=["normal", "heavy-tailed"])
def test_bands_widen_with_the_scatter(factor, scatter):
    """40 sets: fewer than 33 of 40 would be a chance of one in ten thousand for a coverage of 95 %."""
    held = np.zeros(2)
    for seed in range(40):
        noise = factor * np.random.default_rng(seed).standard_normal(12)
        fit = identified(indentations(DEPTH + 4e-4 * noise), **({"scatter": scatter} if scatter else {}))
        held += [fit[name].low <= value <= fit[name].high for name, value in VALUES.items()]
    assert held.min() >= 33


def test_the_factor_on_the_uncertainties_is_birges_ratio():
    noise = 2.0 * np.random.default_rng(1).standard_normal(12)
    fit = identified(indentations(DEPTH + 4e-4 * noise))
    assert fit.misfit.widening == pytest.approx(fit.spread, rel=1e-4)
    assert fit.spread > 1.25
    assert any(note.startswith("bands are") for note in fit.notes)
    assert identified(indentations()).misfit.widening == 1.0


ERRORS = {"offset": 1.0, "compliance": PRESS, "drift": np.arange(12.0)}


@pytest.mark.parametrize("part", MACHINE_ERRORS)
def test_the_sensitivity_is_the_shift_by_an_error_of_the_machine(part):
    fit = identified(indentations(), *angles_and_pressures(3))
    (error,) = (error for error in fit.sensitivity if error.part == part)
    share = 0.02
    moved = identified(
        indentations(DEPTH + share * MACHINE_ERRORS[part].assumed * ERRORS[part]), *angles_and_pressures(3)
    )
    for name in VALUES:
        shift = moved[name].value - fit[name].value
        assert shift == pytest.approx(share * error.shifts[name], rel=0.05)


@pytest.mark.parametrize("part", MACHINE_ERRORS)
def test_an_error_of_the_machine_that_moves_a_result_beyond_its_band_is_reported(part):
    (note,) = (note for note in identified(indentations()).notes if f"make {part} an unknown" in note)
    assert "times half its band" in note
    free = Machine(**{part: (0.0, 1e-5) if part == "compliance" else (-0.01, 0.01)})
    fit = identified(indentations(machine=free))
    assert f"make {part} an unknown" not in " ".join(fit.notes)
    assert part not in [error.part for error in fit.sensitivity]


def test_forces_at_indentations_of_a_machine_are_sensitive_to_it_too():
    by_depth = Measured(quantity="force", values=PRESS, uncertainty=10.0, indentation=DEPTH)
    fit = identified(by_depth)
    shifts = {error.part: error.shifts["clearance"] for error in fit.sensitivity}
    moved = identified(Measured(quantity="force", values=PRESS, uncertainty=10.0, indentation=DEPTH + 2e-5))
    assert moved["clearance"].value - 0.12 == pytest.approx(0.02 * shifts["offset"], rel=0.05)


@pytest.mark.parametrize("order", [None, [5, 3, 8, 0, 10, 1, 7, 2, 11, 4, 9, 6]], ids=["rows", "stated"])
def test_drift_is_an_unknown_of_the_machine(order):
    readings = np.arange(12.0) if order is None else np.array(order, dtype=float)
    machine = Machine(drift=(-1e-3, 1e-3))
    free = {"machine": machine, "order": order}
    fit = identified(indentations(DEPTH + 2e-4 * readings, **free), *angles_and_pressures(3))
    assert fit["machine.drift"].value == pytest.approx(2e-4, rel=0.1)
    for name, value in VALUES.items():
        assert fit[name].low < value < fit[name].high
    following = next(candidate for candidate in standard_candidates(fit) if candidate.quantity == "indentation")
    assert following.order == 12.0
