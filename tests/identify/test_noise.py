"""Data without a stated uncertainty: it is estimated from the scatter, and displacement is another name."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import Measured

from .rigid import JOINT

FORCE = np.linspace(200.0, 3000.0, 12)
FREE = {"clearance": (0.02, 0.3)}
NOISE = 4e-4


def indentations(seed):
    noise = np.random.default_rng(seed).normal(0, NOISE, len(FORCE))
    return bs.Tabulated().press(JOINT, force=FORCE).indentation + noise


def identify(*data):
    return bs.identify(bs.Tabulated(), JOINT, list(data), FREE)


def test_an_unknown_noise_is_estimated_and_said():
    """Its bands are those of the estimated noise, wider by Student's quantile."""
    values = indentations(3)
    unknown = identify(Measured(quantity="displacement", values=values, force=FORCE, name="press"))
    (estimate,) = {float(sigma) for sigma in unknown.uncertainties[0]}
    residuals = values - unknown.results[0]
    assert estimate == pytest.approx((residuals @ residuals / (len(values) - 1)) ** 0.5, rel=2e-3)
    stated = identify(Measured(quantity="indentation", values=values, force=FORCE, uncertainty=estimate))
    widths = [result["clearance"].high - result["clearance"].low for result in (unknown, stated)]
    assert widths[0] / widths[1] == pytest.approx(2.201 / 1.960, rel=0.02)  # t(11)
    assert unknown["clearance"].value == pytest.approx(stated["clearance"].value, rel=1e-4)
    assert any("the uncertainty of press was not stated: it is estimated from the scatter" in n for n in unknown.notes)
    entry = unknown.summary()["data"][0]
    assert (entry["quantity"], entry["uncertainty_estimated"]) == ("indentation", True)
    assert entry["uncertainty"] == pytest.approx([estimate] * len(FORCE))
    assert not stated.summary()["data"][0]["uncertainty_estimated"]
    next_press = next(gain.candidate for gain in unknown.next.gains if gain.candidate.quantity == "indentation")
    assert next_press.uncertainty == pytest.approx(estimate, rel=1e-6)


def test_each_data_set_has_its_own_noise():
    areas = bs.Tabulated().press(JOINT, force=FORCE).area + np.random.default_rng(7).normal(0, 5.0, len(FORCE))
    both = identify(
        Measured(quantity="indentation", values=indentations(4), force=FORCE),
        Measured(quantity="area", values=areas, force=FORCE),
    )
    assert [float(sigma[0]) for sigma in both.uncertainties] == pytest.approx([NOISE, 5.0], rel=0.6)
    assert both["clearance"].low < 0.1 < both["clearance"].high
    mixed = identify(
        Measured(quantity="indentation", values=indentations(4), force=FORCE),
        Measured(quantity="diametral_clearance", values=0.2, uncertainty=0.002),
    )
    assert mixed["clearance"].value == pytest.approx(0.1, rel=0.02)
    assert [measured.has_unknown_noise for measured in mixed.data] == [True, False]


@pytest.mark.long
def test_bands_of_estimated_noise_hold_the_truth():
    data = [Measured(quantity="indentation", values=indentations(seed), force=FORCE) for seed in range(100)]
    estimates = [identify(measured)["clearance"] for measured in data]
    assert sum(estimate.low < 0.1 < estimate.high for estimate in estimates) >= 89
