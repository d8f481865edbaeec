"""Notes, summary, curves and sensitivities of a result."""

from dataclasses import replace
from math import nan

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import Estimate, Machine, Measured, NormalScatter, oscillation
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
    np.testing.assert_allclose(result.curve(0, 3)[1], MODEL.press(result.joint, force=loads[[0, 3, 6]]).area)
    order = np.array([10.0, 1.0, 14.0, 4.0, 12.0, 7.0])
    result = identified(measured(values=CONTACT.indentation + 1e-3 * order, machine=Machine(drift=1e-3), order=order))
    loads, depths = result.curve(0, 2)
    expected = MODEL.press(result.joint, force=loads).indentation + 1e-3 * np.array([1.0, 14.0])
    np.testing.assert_allclose(depths, expected, rtol=1e-9)


def test_residuals_are_values_less_results_in_stated_uncertainties():
    noise = np.array([3.0, -2.0, 1.0, 2.0, -3.0, 1.0])
    result = identified(measured(values=CONTACT.indentation + 2e-4 * noise), measured("area", uncertainty=4.0))
    depth = MODEL.press(result.joint, force=FORCE).indentation
    np.testing.assert_allclose(result.residuals[0], (result.data[0].values - depth) / 2e-4, rtol=1e-9)
    total = np.sum(result.residuals[0] ** 2) + np.sum(result.residuals[1] ** 2)
    assert result.spread == pytest.approx(np.sqrt(total / 11))
    assert (result.freedom, [len(row) for row in result.results]) == (11, [6, 6])
    film = measured("max_pressure", np.minimum(CONTACT.max_pressure, 6.0), 0.1, saturation=6.0)
    shortfall = identified(measured(), film).residuals[1]  # of lower bounds
    assert shortfall[CONTACT.max_pressure > 6.5].max() == 0.0
    assert shortfall.min() >= -1e-6
    one = identified(Measured(quantity="diametral_clearance", values=0.2, uncertainty=0.01))
    assert (one.freedom, np.isnan(one.spread), one.summary()["spread"]) == (0, True, None)


def test_at_most_five_outliers_are_named_in_descending_order():
    values = CONTACT.indentation + 2e-4 * np.array([0.0, 30.0, 0.0, 60.0, 0.0, 0.0])
    result = identified(measured(values=values, name="press"))
    notes = [note for note in result.notes if note.startswith("value ")]
    sizes = [abs(float(note.split()[5])) for note in notes]
    assert notes[0].startswith("value 4 of press is +")
    assert sizes == sorted(sizes, reverse=True)
    assert min(sizes) > 4.0
    assert any("there are outliers (HeavyTailed)" in note for note in result.notes)
    assert result.misfit.widening == pytest.approx(result.spread, rel=1e-4)  # Birge's ratio
    assert any(note.startswith(f"bands are {result.misfit.widening:.3g} times as wide") for note in result.notes)
    notes = identified(measured(values=CONTACT.indentation * (1 + 0.2 * (-1.0) ** np.arange(6)))).notes
    assert sum(note.startswith("value ") for note in notes) == 5


def test_good_data_have_no_notes_on_the_fit():
    machine = Machine(offset=(-0.01, 0.01), compliance=(0.0, 1e-5), drift=(-1e-3, 1e-3))
    result = identified(measured(machine=machine), measured("area", uncertainty=0.1))
    assert not [note for note in result.notes if "uncertaint" in note or "search" in note or "would move" in note]
    offset = measured(values=CONTACT.indentation + 0.004, machine=Machine(offset=(-0.01, 0.01)))
    result = identified(offset, free={})  # the machine alone is unknown
    assert result.point == pytest.approx({"machine.offset": 0.004}, rel=1e-6)
    assert not any("would move" in note for note in result.notes)
    assert result.joint == JOINT


def test_the_best_value_at_the_end_of_a_range_is_noted():
    for free, end in (((0.11, 0.4), "0.11"), ((0.02, 0.09), "0.09")):
        result = identified(measured(uncertainty=2e-3), free={"clearance": free})
        note = f"the best clearance is {end}, the end of its range: widen the range, or check the data"
        assert note in result.notes
    machine = Machine(compliance=(0.0, 1e-5))  # which ends at a physical limit
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
    notes = bs.identify(MODEL, thick, measured(values=contact.indentation), FREE).notes
    assert set(contact.notes) - {contact.utilisation_note} <= set(notes)


def test_an_estimate_has_a_ratio_to_its_prior_and_a_summary():
    free = {"liner.young": Normal(mean=1000.0, deviation=5.0)}
    estimate = identified(measured("area", uncertainty=4.0), free=free)["liner.young"]
    assert (estimate.identifiable, estimate.limited_by, estimate.width_ratio < 1.0) == (True, (), True)
    summary = Estimate("clearance", "mm", nan, 0.1, 0.3, 0.9, ("clearance",)).summary()
    assert summary.pop("told") is summary["identifiable"] is False  # the earlier key
    assert (summary["value"], summary["low"], summary["high"]) == (None, 0.1, 0.3)
    assert (summary["name"], summary["unit"], summary["limited_by"]) == ("clearance", "mm", ["clearance"])


def test_a_sensitivity_is_described_with_its_unit_and_machine():
    for *error, title in (
        ("", "offset", 1e-3, "a zero offset of 1 µm"),
        ("frame", "compliance", 2e-6, "a compliance of 2 µm/kN in frame"),
        ("", "drift", 1e-4, "a drift of 0.1 µm per reading"),
    ):
        sensitivity = Sensitivity(*error, {"clearance": nan, "liner_young": 2.0})
        stated = dict(zip(("machine", "error", "size"), error, strict=True))
        assert sensitivity.title == title
        assert sensitivity.summary() == {**stated, "shifts": {"clearance": None, "liner_young": 2.0}}


def test_the_shift_ratio_is_the_shift_over_half_the_band():
    result = identified(measured())
    estimate = result["clearance"]
    for error in result.sensitivity:
        ratio = 2 * abs(error.shifts["clearance"]) / (estimate.high - estimate.low)
        assert result.shift_ratio(error, "clearance") == pytest.approx(ratio)
    assert [error.size for error in result.sensitivity] == [1e-3, 1e-6, 1e-4]
    pair = {"clearance": (0.05, 0.2), "liner.young": (500.0, 2000.0)}
    result = identified(measured("area", uncertainty=4.0), measured(uncertainty=0.1), free=pair)
    assert np.isnan(result.sensitivity[0].shifts["clearance"])  # the clearance is not identifiable
    assert result.shift_ratio(result.sensitivity[0], "clearance") == 0.0
    both = measured(machine=Machine(name="a")), measured(machine=Machine(name="b", offset=(-0.01, 0.01)))
    cases = [(error.machine, error.part) for error in identified(*both, measured("area")).sensitivity]
    assert cases == [("a", "offset"), ("a", "compliance"), ("a", "drift"), ("b", "compliance"), ("b", "drift")]


def test_earlier_names_warn():
    result, observable = identified(measured()), oscillation(1.0)
    for owner, name, value in (
        (result, "told", result.identifiable),
        (result, "scales", result.transform),
        (result.best, "places", result.best.theta),
        (result.information, "untold", result.information.unidentifiable),
        (result["clearance"], "left", result["clearance"].width_ratio),
        (result.next, "each_quantity", result.next.best_by_quantity),
        (measured("frequency", FORCE, observable=observable), "own", observable),
        (NormalScatter(), "told", NormalScatter().information),
    ):
        with pytest.warns(DeprecationWarning, match=name):
            assert getattr(owner, name) is value or getattr(owner, name) == value
    with pytest.warns(DeprecationWarning, match="'place'.*'index'"):
        result.curve(place=0)
    with pytest.warns(DeprecationWarning, match="'own'.*'observable'"):
        measured("frequency", FORCE, own=observable)
    with pytest.warns(DeprecationWarning, match="use censored"):
        assert NormalScatter().beyond(1.0) == NormalScatter().censored(1.0)


def test_earlier_modules_have_their_names():
    from ballsocket.identify.oscillation import oscillation as earlier
    from ballsocket.identify.tracing import by_tracing

    from ballsocket.identify import IdentificationResult, Identified, Own, observables, parameters

    assert (Identified, Own) == (IdentificationResult, observables.CustomObservable)
    assert (earlier, by_tracing.__module__) == (observables.oscillation, "ballsocket.identify.misfit")
    with pytest.warns(DeprecationWarning, match="Identified is deprecated"):
        assert parameters.Identified is IdentificationResult
