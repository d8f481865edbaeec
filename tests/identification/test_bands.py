"""Bands of 95 %: profile likelihood, identifiability, stated and estimated scatter, and errors of the machine."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binom

import ballsocket as bs
from ballsocket.identification import MACHINE_ERRORS, HeavyTailed, Machine, Measured, NormalScatter

TRUTH = bs.Joint(ball_radius=15.3, clearance=0.12, liner_thickness=7.4, liner=bs.Material(young=780.0, poisson=0.42))
VALUES = {"clearance": 0.12, "liner_young": 780.0}
FREE = {"clearance": (0.02, 0.4), "liner.young": (300.0, 2500.0)}
NARROW = {"clearance": (0.05, 0.3), "liner.young": (600.0, 1000.0)}
CLEARANCE = {"clearance": (0.02, 0.3)}
MODEL = bs.HessForsbach()
FORCE, PRESS = np.linspace(500.0, 3000.0, 6), np.linspace(250.0, 3000.0, 12)
CONTACT, DEPTH = MODEL.press(TRUTH, force=FORCE), MODEL.press(TRUTH, force=PRESS).indentation
AREAS = Measured(quantity="area", values=CONTACT.area, uncertainty=0.04 * CONTACT.area, force=FORCE)


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
    ("data", "free"),
    [
        (angles_and_pressures(1021), FREE),
        (angles_and_pressures(1057), FREE),
        (angles_and_pressures(1021), {**FREE, "liner.young": (100.0, 8000.0)}),
        (angles_and_pressures(1057), NARROW),
        ([AREAS], FREE),
    ],
    ids=["1021", "1057", "wide", "narrow", "area"],
)
def test_areas_angles_and_pressures_identify_only_the_product(data, free):
    """Theory, 3g: of a rigid ball they depend on E c; only the socket's radius, R1 + c, hints at c.

    The best points of the seeds lie near an end of the clearances, where the local information is large.
    """
    fit = identified(*data, free=free)
    assert fit.information.unidentifiable == ("clearance", "liner_young")
    assert fit.information.rank == 1
    assert not fit.identifiable
    (product,) = fit.information.products
    assert product.exponents == {"clearance": 1.0, "liner_young": 1.0}
    assert product.low < 93.6 < product.high < 1.4 * product.low
    assert fit["liner_young"].low <= 780.0 <= fit["liner_young"].high
    assert np.isnan([fit["clearance"].value, fit["liner.young"].value]).all()
    assert (fit.summary()["valid"], fit.summary()["estimates"][0]["value"]) == (False, None)
    assert fit.notes[0] == (
        "only clearance · liner_young is identifiable from these data, clearance and liner_young separately are not: "
        "measure indentation or free play"
    )
    assert fit.sensitivity == ()  # no indentations, which a machine would read


def test_a_band_that_ends_at_an_end_of_a_range_is_reported_but_not_at_a_physical_limit():
    """A very stiff machine is identifiable: its compliance cannot be below 0."""
    fit = identified(*angles_and_pressures(1000), free=NARROW)
    assert (fit["liner_young"].low, fit["liner_young"].high) == (600.0, 1000.0)
    assert fit["liner_young"].limited_by == ("liner_young",)
    assert fit["clearance"].limited_by == ("liner_young",)
    assert "the band of liner_young ends at 600 MPa and 1000 MPa, the end of its range" in fit.notes
    assert "the band of clearance ends where the range of liner_young ends" in fit.notes
    machine = Machine(compliance=(0.0, 2e-5))
    fit = identified(indentations(machine=machine), free={"clearance": (0.02, 0.4)})
    compliance = fit["machine.compliance"]
    assert compliance.identifiable
    assert compliance.low == 0.0 <= compliance.value < compliance.high < 1e-6


SETS = 75
LEAST, MOST = binom.interval(0.999, SETS, 0.95)
"""As many bands of 95 % hold as in 999 of 1000 trials: 64 to 75."""


@pytest.mark.long
@pytest.mark.parametrize("scatter", [NormalScatter(), HeavyTailed()], ids=["normal", "heavy-tailed"])
def test_bands_widen_with_the_scatter(scatter):
    """The noise is twice the stated one."""
    held = np.zeros(2)
    for seed in range(SETS):
        noise = 8e-4 * np.random.default_rng(seed).standard_normal(12)
        fit = identified(indentations(DEPTH + noise), scatter=scatter)
        held += [fit[name].low <= value <= fit[name].high for name, value in VALUES.items()]
    assert LEAST <= held.min() <= held.max() <= MOST


def unstated(seed=3, quantity="indentation"):
    values = DEPTH + np.random.default_rng(seed).normal(0, 4e-4, 12)
    return Measured(quantity=quantity, values=values, force=PRESS, name="press")


def test_an_unknown_noise_is_estimated_and_said_for_each_data_set():
    """Its bands are those of the estimated noise, wider by Student's quantile."""
    data = unstated(quantity="displacement")
    unknown = identified(data, free=CLEARANCE)
    (estimate,) = {float(sigma) for sigma in unknown.uncertainties[0]}
    residuals = data.values - unknown.results[0]
    assert estimate == pytest.approx((residuals @ residuals / 11) ** 0.5, rel=2e-3)
    stated = identified(replace(data, uncertainty=estimate), free=CLEARANCE)
    widths = [result["clearance"].high - result["clearance"].low for result in (unknown, stated)]
    assert widths[0] / widths[1] == pytest.approx(2.201 / 1.960, rel=0.02)  # t(11)
    assert unknown["clearance"].value == pytest.approx(stated["clearance"].value, rel=1e-4)
    assert any("the uncertainty of press was not stated: it is estimated from the scatter" in n for n in unknown.notes)
    entry = unknown.summary()["data"][0]
    assert (entry["quantity"], entry["uncertainty_estimated"]) == ("indentation", True)
    assert entry["uncertainty"] == pytest.approx([estimate] * 12)
    assert not stated.summary()["data"][0]["uncertainty_estimated"]
    next_press = next(gain.candidate for gain in unknown.next.gains if gain.candidate.quantity == "indentation")
    assert next_press.uncertainty == pytest.approx(estimate, rel=1e-6)
    areas = MODEL.press(TRUTH, force=PRESS).area + np.random.default_rng(7).normal(0, 5.0, 12)
    both = identified(unstated(4), Measured(quantity="area", values=areas, force=PRESS), free=CLEARANCE)
    assert [float(sigma[0]) for sigma in both.uncertainties] == pytest.approx([4e-4, 5.0], rel=0.6)
    assert both["clearance"].low < 0.12 < both["clearance"].high
    free_play = Measured(quantity="diametral_clearance", values=0.24, uncertainty=0.002)
    mixed = identified(unstated(4), free_play, free=CLEARANCE)
    assert mixed["clearance"].value == pytest.approx(0.12, rel=0.02)
    assert [data.has_unknown_noise for data in mixed.data] == [True, False]


@pytest.mark.long
def test_bands_of_estimated_noise_hold_the_truth():
    estimates = [identified(unstated(seed), free=CLEARANCE)["clearance"] for seed in range(SETS)]
    assert LEAST <= sum(estimate.low < 0.12 < estimate.high for estimate in estimates) <= MOST


def by_depth(depths):
    return Measured(quantity="force", values=PRESS, uncertainty=10.0, indentation=depths)


@pytest.mark.parametrize("part", MACHINE_ERRORS)
@pytest.mark.parametrize("read", [indentations, by_depth], ids=["readings", "loads"])
def test_the_sensitivity_is_the_shift_by_an_error_of_the_machine(part, read):
    fit = identified(read(DEPTH), *angles_and_pressures(3))
    (error,) = (error for error in fit.sensitivity if error.part == part)
    moved_depths = DEPTH + 0.02 * MACHINE_ERRORS[part].assumed * MACHINE_ERRORS[part].effect(PRESS, np.arange(12.0))
    moved = identified(read(moved_depths), *angles_and_pressures(3))
    for name in VALUES:
        assert moved[name].value - fit[name].value == pytest.approx(0.02 * error.shifts[name], rel=0.05)


@pytest.mark.parametrize("part", MACHINE_ERRORS)
def test_the_slope_of_an_error_is_its_derivative_by_the_force(part):
    error, order, step = MACHINE_ERRORS[part], np.arange(12.0), 1e-3 * PRESS
    change = (error.effect(PRESS + step, order) - error.effect(PRESS - step, order)) / (2 * step)
    slope = 0.0 if error.slope is None else error.slope(PRESS, order)
    assert slope + 0 * PRESS == pytest.approx(change + 0 * PRESS, rel=1e-5, abs=1e-12)


@pytest.mark.parametrize("part", MACHINE_ERRORS)
def test_an_error_of_the_machine_that_moves_a_result_beyond_its_band_is_reported(part):
    (note,) = (note for note in identified(indentations()).notes if f"make {part} an unknown" in note)
    assert "times half its band" in note
    free = Machine(**{part: (0.0, 1e-5) if part == "compliance" else (-0.01, 0.01)})
    fit = identified(indentations(machine=free))
    assert f"make {part} an unknown" not in " ".join(fit.notes)
    assert part not in [error.part for error in fit.sensitivity]


def test_drift_is_an_unknown_of_the_machine():
    order = [5, 3, 8, 0, 10, 1, 7, 2, 11, 4, 9, 6]
    reading = indentations(DEPTH + 2e-4 * np.array(order), machine=Machine(drift=(-1e-3, 1e-3)), order=order)
    fit = identified(reading, *angles_and_pressures(3))
    assert fit["machine.drift"].value == pytest.approx(2e-4, rel=0.1)
    for name, value in VALUES.items():
        assert fit[name].low < value < fit[name].high
