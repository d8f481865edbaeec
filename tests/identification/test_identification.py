"""Identification of a joint from measurements."""

from dataclasses import replace

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identification import HeavyTailed, Machine, Measured, NormalScatter
from ballsocket.identification.bands import trials
from ballsocket.identification.misfit import by_tracing
from ballsocket.studies import LogNormal, Normal

from .rigid import JOINT, MODEL

FREE = {"clearance": (0.02, 0.3), "liner.young": (400.0, 2000.0)}
FORCE = np.linspace(150.0, 3000.0, 20)
TRUTH = MODEL.press(JOINT, force=FORCE)
READ = TRUTH.indentation + 8e-6 * FORCE


def measured(quantity, values=None, share=0.02, random=None, force=FORCE, **words):
    values = getattr(TRUTH, quantity) if values is None else values
    uncertainty = share * np.max(values)
    scattered = values if random is None else values + uncertainty * random.standard_normal(len(values))
    return Measured(quantity=quantity, values=scattered, uncertainty=uncertainty, force=force, **words)


def by_depth(indentation, uncertainty, **words):
    return Measured(quantity="force", values=FORCE, uncertainty=uncertainty, indentation=indentation, **words)


def identified(*data, free=FREE, model=MODEL, **words):
    return bs.identify(model, JOINT, data, free, **words)


@pytest.mark.parametrize(
    "data",
    [
        [measured("indentation")],
        [measured("half_angle"), measured("indentation")],
        [measured("area"), measured("stiffness")],
        [by_depth(TRUTH.indentation, 20.0), measured("max_pressure")],
        [measured("area"), Measured(quantity="diametral_clearance", values=0.2, uncertainty=0.004)],
        [measured("pressure", TRUTH.pressure(0.2), angle=0.2), measured("indentation")],
        [measured("indentation", READ + 0.002, 1e-3, machine=Machine(compliance=8e-6, offset=0.002))],
        [measured("indentation", TRUTH.indentation[[3, 18]], 1e-3, force=FORCE[[3, 18]])],
    ],
    ids=["depth", "angle", "stiffness", "force", "free play", "pressure", "known machine", "as many as unknowns"],
)
def test_data_without_error_identify_the_true_joint(data):
    result = identified(*data)
    assert result.point == pytest.approx({"clearance": 0.1, "liner_young": 1000.0}, rel=1e-5)
    assert result.identifiable
    assert result.freedom == 0 or result.spread == pytest.approx(0.0, abs=1e-4)
    assert result.joint.clearance == pytest.approx(0.1, rel=1e-5)
    assert identified(*data, seed=5).point == pytest.approx(result.point, rel=1e-5)


def test_a_relative_uncertainty_is_a_share_of_the_fitted_value():
    """The mean of 15 % less and 15 % more is right; weights by the readings would give 4.4 % less."""
    play = Measured(quantity="diametral_clearance", values=[0.17, 0.23], relative_uncertainty=0.15)
    result = identified(play, free={"clearance": (0.02, 0.3)})
    assert result.point["clearance"] == pytest.approx(0.1, rel=1e-6)
    assert result.uncertainties[0] == pytest.approx([0.03, 0.03], rel=1e-6)


def test_errors_of_the_machine_are_identified_with_the_joint():
    machine = Machine(compliance=(0.0, 2e-5), offset=(-0.02, 0.02))
    by_force = measured("indentation", READ - 0.007, share=1e-3, machine=machine)
    truth = {"clearance": 0.1, "liner_young": 1000.0, "machine.compliance": 8e-6, "machine.offset": -0.007}
    for data in (by_force, by_depth(READ - 0.007, 2.0, machine=machine)):
        assert identified(data, measured("area", share=1e-3)).point == pytest.approx(truth, rel=1e-4)


def test_values_of_a_saturated_film_are_lower_bounds():
    """The modulus is too low if the values at the limit count as exact."""
    film = np.minimum(TRUTH.max_pressure, 7.0)
    honest, taken = (
        identified(measured("max_pressure", film, saturation=limit), free={"liner.young": (400.0, 2000.0)})
        for limit in (7.0, np.inf)
    )
    assert honest["liner.young"].value == pytest.approx(1000.0, rel=0.01)
    assert taken.point["liner_young"] < 900.0


def test_outliers_have_little_influence_with_a_heavy_tail():
    random = np.random.default_rng(3)
    values = TRUTH.indentation * (1 + 0.01 * random.standard_normal(20))
    values[[4, 11, 17]] *= 1.5
    data = measured("indentation", values, share=0.01)
    points = [identified(data, scatter=scatter).point["clearance"] for scatter in (NormalScatter(), HeavyTailed())]
    normal_error, heavy_error = abs(np.log(np.array(points) / 0.1))
    assert heavy_error < 0.5 * normal_error


def test_the_gain_of_a_measurement_is_the_predicted_gain():
    areas = measured("area")
    result = identified(areas)
    gain = next(each for each in result.next.gains if each.candidate.quantity == "indentation")
    more = identified(areas, gain.candidate.measured(MODEL.press(result.joint, force=gain.candidate.force).indentation))
    before, after = (np.linalg.slogdet(each.information.matrix + np.eye(2))[1] for each in (result, more))
    assert gain.bits == pytest.approx((after - before) / np.log(4.0), rel=0.1)
    assert more.identifiable
    assert gain.identifies == ("clearance", "liner_young")
    assert "area" not in result.next.sufficient_quantities


def test_a_prior_distribution_makes_the_product_separable():
    known = {"clearance": Normal(mean=0.1, deviation=0.01), "liner.young": (400.0, 2000.0)}
    result = identified(measured("area"), free=known)
    assert result.identifiable
    assert result["clearance"].value == pytest.approx(0.1, abs=1e-3)
    assert result["clearance"].high - result["clearance"].low == pytest.approx(2 * 1.96 * 0.01, rel=0.02)
    assert result["liner.young"].value == pytest.approx(1000.0, rel=0.01)
    factor = identified(measured("area"), free={**FREE, "clearance": LogNormal(median=0.1, factor=1.1)})["clearance"]
    assert (factor.low, factor.high) == pytest.approx((0.1 / 1.1**1.96, 0.1 * 1.1**1.96), rel=0.01)


@pytest.mark.long
def test_coverage_and_bias_over_a_hundred_synthetic_sets():
    """100 sets scatter by 2.2 % about 95 %, and their mean by a fortieth of a band."""
    contact = bs.Tabulated().press(JOINT, force=FORCE)
    depth, film = (measured(name, getattr(contact, name), share=0.01) for name in ("indentation", "max_pressure"))
    result = identified(depth, replace(film, saturation=8.0), model=bs.Tabulated())
    tried = trials(result, 100)
    for name in ("clearance", "liner_young"):
        assert 0.906 <= tried.coverage[name] <= 0.994
        assert abs(tried.bias[name]) < 0.1


@pytest.mark.long
def test_the_posterior_agrees_with_the_bands_or_follows_the_product():
    pytest.importorskip("emcee")
    result = identified(measured("indentation", share=0.003, random=np.random.default_rng(8)))
    posterior = result.posterior(1000)
    assert posterior.converged
    assert min(posterior.effective.values()) >= 1000
    assert 0.2 < posterior.acceptance < 0.9
    for name, estimate in result.estimates.items():
        np.testing.assert_allclose(posterior.band(name), (estimate.low, estimate.high), rtol=0.05)
    assert posterior.samples.shape == (1000, 2)
    clearance, young = identified(measured("area")).posterior(500).samples.T
    assert clearance.max() > 2 * clearance.min()
    np.testing.assert_allclose(clearance * young, 100.0, rtol=0.06)


def test_modulus_and_poissons_ratio_are_not_identifiable_together():
    result = identified(measured("indentation"), free={**FREE, "liner.poisson": (0.3, 0.48)})
    assert result.information.unidentifiable == ("liner_young", "liner_poisson")
    assert result.information.rank == 2
    assert result.notes[0].startswith("liner_young and liner_poisson are not identifiable from these data; of the us")


@pytest.mark.long
def test_jax_and_differences_have_the_same_best_point():
    pytest.importorskip("jax")
    machine = Machine(compliance=(0.0, 2e-5), offset=0.002)
    free_play = Measured(quantity="diametral_clearance", values=0.2, uncertainty=0.004)
    data = measured("indentation", READ + 0.002, share=1e-3, machine=machine), by_depth(TRUTH.indentation, 20.0)
    traced, result = identified(*data, free_play, slopes=by_tracing), identified(*data, free_play)
    assert traced.point == pytest.approx(result.point, rel=1e-6)
    np.testing.assert_allclose(traced.information.matrix, result.information.matrix, rtol=1e-3)


def test_the_uncertainty_of_a_load_is_divided_by_the_stiffness():
    """Data without error: the slope at the best point is that of the true joint, and a load of 0 adds nothing."""
    force, sigma = np.array([0.0, 500.0, 1500.0, 3000.0]), np.array([40.0, 40.0, 60.0, 80.0])
    contact = MODEL.press(JOINT, force=force)
    row = {"quantity": "indentation", "values": contact.indentation, "uncertainty": 1e-4, "force": force}
    free_play = Measured(quantity="diametral_clearance", values=0.2, uncertainty=0.01)
    result = identified(Measured(**row, load_uncertainty=sigma), free_play, free={"clearance": (0.02, 0.3)})
    expected = np.hypot(1e-4, np.append(0.0, sigma[1:] / contact.stiffness[1:]))
    np.testing.assert_allclose(result.misfit.uncertainty, [*expected, 0.01], rtol=1e-4)
    plain = identified(measured("indentation"), free={"clearance": (0.02, 0.3)})
    np.testing.assert_array_equal(plain.misfit.uncertainty, plain.data[0].uncertainty)
