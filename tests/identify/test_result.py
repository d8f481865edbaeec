"""Notes, summary, curves and sensitivities of a result."""

from dataclasses import replace
from math import nan

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import Estimate, Machine, Measured
from ballsocket.identify.sensitivity import Sensitivity
from ballsocket.studies import Normal

from .rigid import JOINT, MODEL

FORCE = np.array([2000.0, 400.0, 3000.0, 1000.0, 2500.0, 1500.0])
CONTACT = MODEL.press(JOINT, force=FORCE)
FREE = {"clearance": (0.02, 0.4)}


def identified(*data, free=FREE, model=MODEL, **settings):
    return bs.identify(model, JOINT, data, free, **settings)


def measured(quantity="indentation", values=None, uncertainty=2e-4, **settings):
    values = getattr(CONTACT, quantity) if values is None else values
    return Measured(quantity=quantity, values=values, uncertainty=uncertainty, force=FORCE, **settings)


def test_the_curve_is_the_model_over_the_loads_of_the_data():
    result = identified(measured("area", uncertainty=4.0), measured())
    loads, depths = result.curve(1, 7)
    np.testing.assert_allclose(loads, np.linspace(400.0, 3000.0, 7))
    np.testing.assert_allclose(depths, MODEL.press(result.joint, force=loads).indentation, rtol=1e-12)
    assert len(result.curve(0)[0]) == 60
    np.testing.assert_allclose(result.curve(0, 3)[1], MODEL.press(result.joint, force=loads[[0, 3, 6]]).area)


def test_the_curve_interpolates_the_order_of_the_readings():
    machine = Machine(drift=1e-3)
    order = np.array([10.0, 1.0, 14.0, 4.0, 12.0, 7.0])
    values = CONTACT.indentation + 1e-3 * order
    result = identified(measured(values=values, machine=machine, order=order))
    loads, depths = result.curve(0, 2)
    drift = 1e-3 * np.array([1.0, 14.0])
    np.testing.assert_allclose(depths, MODEL.press(result.joint, force=loads).indentation + drift, rtol=1e-9)


def test_residuals_are_values_less_results_in_stated_uncertainties():
    noise = np.array([3.0, -2.0, 1.0, 2.0, -3.0, 1.0])
    result = identified(measured(values=CONTACT.indentation + 2e-4 * noise), measured("area", uncertainty=4.0))
    depth = MODEL.press(result.joint, force=FORCE).indentation
    np.testing.assert_allclose(result.residuals[0], (result.data[0].values - depth) / 2e-4, rtol=1e-9)
    total = np.sum(result.residuals[0] ** 2) + np.sum(result.residuals[1] ** 2)
    assert result.spread == pytest.approx(np.sqrt(total / 11))
    assert result.freedom == 11
    assert [len(row) for row in result.results] == [6, 6]


def test_the_residual_of_a_lower_bound_is_its_shortfall():
    film = measured("max_pressure", np.minimum(CONTACT.max_pressure, 6.0), 0.1, saturation=6.0)
    result = identified(measured(), film)
    assert result.residuals[1][CONTACT.max_pressure > 6.5].max() == 0.0
    assert result.residuals[1].min() >= -1e-6


def test_the_scatter_without_degrees_of_freedom_is_unknown():
    result = identified(Measured(quantity="diametral_clearance", values=0.2, uncertainty=0.01))
    assert result.freedom == 0
    assert np.isnan(result.spread)
    assert result.summary()["spread"] is None


def test_the_text_of_a_result_has_values_bands_and_notes():
    result = identified(measured("area", uncertainty=4.0), free={**FREE, "liner.poisson": (0.39, 0.41)})
    text = repr(result).splitlines()
    assert text[0].startswith("clearance = ")
    assert " mm (" in text[0]
    assert text[1] == "liner_poisson is not identifiable: 0.39 to 0.41"
    assert text[2:] == list(result.notes)


def test_the_text_of_a_product_has_its_unit():
    free = {"clearance": (0.05, 0.2), "liner.young": (500.0, 2000.0)}
    result = identified(measured("area", uncertainty=4.0), free=free)
    (product,) = result.information.products
    line = f"clearance · liner_young = {product.value:.4g} mm MPa ({product.low:.4g} to {product.high:.4g})"
    assert line in repr(result).splitlines()


def test_outliers_are_named_in_descending_order():
    values = CONTACT.indentation + 2e-4 * np.array([0.0, 30.0, 0.0, 60.0, 0.0, 0.0])
    result = identified(measured(values=values, name="press"))
    notes = [note for note in result.notes if note.startswith("value ")]
    sizes = [abs(float(note.split()[5])) for note in notes]
    assert notes[0].startswith("value 4 of press is +")
    assert sizes == sorted(sizes, reverse=True)
    assert all(size > 4.0 for size in sizes)
    assert any("there are outliers (HeavyTailed)" in note for note in result.notes)
    assert any(note.startswith(f"bands are {result.misfit.widening:.3g} times as wide") for note in result.notes)


def test_at_most_five_outliers_are_named():
    values = CONTACT.indentation * (1 + 0.2 * np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0]))
    notes = identified(measured(values=values)).notes
    assert sum(note.startswith("value ") for note in notes) == 5


def test_good_data_have_no_notes_on_the_fit():
    machine = Machine(offset=(-0.01, 0.01), compliance=(0.0, 1e-5), drift=(-1e-3, 1e-3))
    result = identified(measured(machine=machine), measured("area", uncertainty=0.1))
    assert not [note for note in result.notes if "uncertaint" in note or "search" in note or "would move" in note]


def test_the_best_value_at_the_end_of_a_range_is_noted():
    for free, end in (((0.11, 0.4), "0.11"), ((0.02, 0.09), "0.09")):
        result = identified(measured(uncertainty=2e-3), free={"clearance": free})
        note = f"the best clearance is {end}, the end of its range: widen the range, or check the data"
        assert note in result.notes


def test_the_best_value_at_a_physical_limit_is_not_noted():
    machine = Machine(compliance=(0.0, 1e-5))
    result = identified(measured(machine=machine, values=0.99 * CONTACT.indentation), free={})
    assert result.point == pytest.approx({"machine.compliance": 0.0}, abs=1e-12)
    assert not any(note.startswith("the best machine.compliance") for note in result.notes)


def test_a_search_without_convergence_is_noted():
    result = identified(measured())
    stopped = replace(result, best=replace(result.best, converged=False, rivals=(result.best.theta,)))
    assert "the search did not converge: the numbers are those of its last step" in stopped.notes
    assert "another point fits the data about as well: sample the posterior" in stopped.notes
    assert stopped.summary()["valid"] is False
    assert result.summary()["valid"] is True


def test_notes_of_the_model_are_those_at_the_loads_of_the_data():
    thick = JOINT.replace(liner_thickness=100.0)
    contact = MODEL.press(thick, force=FORCE)
    data = Measured(quantity="indentation", values=contact.indentation, uncertainty=1e-4, force=FORCE)
    notes = bs.identify(MODEL, thick, data, FREE).notes
    assert set(contact.notes) - {contact.utilisation_note} <= set(notes)


def test_unknown_errors_of_a_machine_alone_have_a_result():
    """Only the machine is unknown: no note compares it with the other errors of the machine."""
    machine = Machine(offset=(-0.01, 0.01))
    result = identified(measured(values=CONTACT.indentation + 0.004, machine=machine), free={})
    assert result.point == pytest.approx({"machine.offset": 0.004}, rel=1e-6)
    assert not any("would move" in note for note in result.notes)
    assert result.joint == JOINT


def test_a_narrow_prior_is_an_estimate_without_a_range():
    result = identified(measured("area", uncertainty=4.0), free={"liner.young": Normal(mean=1000.0, deviation=5.0)})
    estimate = result["liner.young"]
    assert estimate.identifiable
    assert estimate.limited_by == ()
    assert estimate.width_ratio < 1.0


def test_the_summary_of_an_estimate_keeps_the_earlier_key():
    summary = Estimate("clearance", "mm", nan, 0.1, 0.3, 0.9, ("clearance",)).summary()
    assert summary == {
        "name": "clearance",
        "unit": "mm",
        "value": None,
        "low": 0.1,
        "high": 0.3,
        "identifiable": False,
        "told": False,
        "limited_by": ["clearance"],
    }


def test_a_sensitivity_is_described_with_its_unit_and_machine():
    titles = [
        Sensitivity("", "offset", 1e-3, {}).title,
        Sensitivity("frame", "compliance", 2e-6, {}).title,
        Sensitivity("", "drift", 1e-4, {}).title,
    ]
    assert titles == [
        "a zero offset of 1 µm",
        "a compliance of 2 µm/kN in frame",
        "a drift of 0.1 µm per reading",
    ]
    summary = Sensitivity("frame", "drift", 1e-4, {"clearance": nan, "liner_young": 2.0}).summary()
    assert summary == {
        "machine": "frame",
        "error": "drift",
        "size": 1e-4,
        "shifts": {"clearance": None, "liner_young": 2.0},
    }


def test_the_shift_ratio_is_the_shift_over_half_the_band():
    result = identified(measured())
    estimate = result["clearance"]
    for error in result.sensitivity:
        ratio = 2 * abs(error.shifts["clearance"]) / (estimate.high - estimate.low)
        assert result.shift_ratio(error, "clearance") == pytest.approx(ratio)
    assert [error.size for error in result.sensitivity] == [1e-3, 1e-6, 1e-4]


def test_an_unidentifiable_unknown_has_no_shift():
    free = {"clearance": (0.05, 0.2), "liner.young": (500.0, 2000.0)}
    area = measured("area", uncertainty=4.0)
    result = identified(area, measured(uncertainty=0.1), free=free)
    error = result.sensitivity[0]
    assert np.isnan(error.shifts["clearance"])
    assert result.shift_ratio(error, "clearance") == 0.0


def test_each_machine_has_its_own_sensitivities():
    first, second = Machine(name="a"), Machine(name="b", offset=(-0.01, 0.01))
    result = identified(measured(machine=first), measured(machine=second), measured("area", uncertainty=4.0))
    cases = [(error.machine, error.part) for error in result.sensitivity]
    assert cases == [("a", "offset"), ("a", "compliance"), ("a", "drift"), ("b", "compliance"), ("b", "drift")]
