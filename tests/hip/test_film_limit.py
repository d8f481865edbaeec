"""Wear only where the film ratio is below a limit."""

import json
from math import inf

import numpy as np
import pytest

from ballsocket.hip import ContactAreaWear, CrossShear, FilmLimit, Lubricant, read_hip
from ballsocket.hip.simulation import make_checkpoint
from ballsocket.hip.wear_integrator import WearIntegrator

from ..extent import some
from .hips import QUICK, K, hip, history

SMOOTH = Lubricant(cup_roughness=1e-4)
"""Lubricant of a smooth cup, whose film ratios are below and above 1."""


def limited(ratio, cycles=5, **words):
    return hip(**QUICK, film_limit=FilmLimit(ratio=ratio, lubricant=SMOOTH, cycles=cycles), **words)


def worn(use, cycles=2e5):
    """Run a simulation without the estimate of its error, which needs the films of finer steps."""
    return WearIntegrator(setup=use).run_until(cycles, lambda count: None)


LAWS = {
    "archard": {},
    "area": {"wear": ContactAreaWear(coefficient=1e-9)},
    "cross-shear": {"wear": CrossShear(straight=K, circular=2 * K, exponent=-0.3)},
    "ball": {"ball_wear": ContactAreaWear(coefficient=1e-9)},
}


@pytest.mark.parametrize("law", LAWS)
def test_an_infinite_limit_wears_as_none(law):
    free, unlimited = (worn(use) for use in (hip(**QUICK, **LAWS[law]), limited(inf, **LAWS[law])))
    assert np.array_equal(free.depth, unlimited.depth)
    assert np.array_equal(free.ball, unlimited.ball)
    assert free.work == unlimited.work


@pytest.mark.parametrize("law", LAWS)
def test_a_limit_of_zero_wears_nothing(law):
    use = limited(0.0, **LAWS[law])
    last = worn(use)
    assert last.volume == last.ball_volume == 0
    assert use.excluded_work_share == 1
    assert last.work == pytest.approx(2e5 * 1e3 * use.first.work, rel=1e-9)


def test_wear_grows_with_the_limit():
    limits = some([0.0, 1.0, 2.0, inf])
    uses = [limited(ratio) for ratio in limits]
    volumes = [worn(use).volume for use in uses]
    shares = [use.excluded_work_share for use in uses]
    assert (np.diff(volumes) > 0).all()
    assert (np.diff(shares) < 0).all()
    assert shares[-1] == 0


def test_archard_wears_by_the_work_below_the_limit():
    """The film of every cell and instant decides."""
    use, free = limited(1.0), hip(**QUICK)
    assert 0.1 < use.excluded_work_share < 0.9
    assert use.first.volume == pytest.approx((1 - use.excluded_work_share) * free.first.volume, rel=1e-12)
    assert use.first.work == free.first.work
    thickness = use.film(SMOOTH, cycles=5).thickness
    wears = use.wearing_exposure(use.exposure(use.unworn)).pressure > 0
    assert np.array_equal(wears, (thickness < SMOOTH.roughness) & (use.unworn.pressure > 0))


def test_json_and_notes_state_the_limit_and_the_excluded_share(short_film):
    use = limited(1.0)
    limited_history = use.after(1e5)
    summary = json.loads(json.dumps(limited_history.summary(), allow_nan=False))
    share = use.excluded_work_share
    assert summary["laws"]["film_limit"] == {"lambda": 1.0, "excluded_work_share": share}
    assert any(
        note.startswith("wear counts only where λ is below 1") and f"{100 * share:.3g} %" in note
        for note in limited_history.notes
    )
    assert history(hip(**QUICK), 1e4).summary()["laws"]["film_limit"] is None


def test_a_run_with_another_limit_is_another_run(tmp_path):
    runs = [hip(**QUICK), limited(1.0), limited(2.0)]
    assert len({make_checkpoint(use, tmp_path).identity for use in runs}) == 3


FILE = """
cycles = 1e5
joint = "hip-28"
[cycle]
name = "iso-14242-1"
instants = 16
[wear]
coefficient = 1e-6
ring_width = "8 deg"
film_limit = {limit}
[film]
viscosity = 1e-3
"""


def test_a_file_has_the_limit_with_its_lubricant(tmp_path):
    path = tmp_path / "hip.toml"
    path.write_text(FILE.format(limit=1.5), encoding="utf-8")
    assert read_hip(path).use.film_limit == FilmLimit(ratio=1.5, lubricant=Lubricant(viscosity=1e-3))
