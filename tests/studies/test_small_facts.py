"""Parts of a study: blocks, times, identities of arrays, rows beside samples, and limits on a plane."""

from math import inf, radians

import numpy
import pytest
import xarray

from ballsocket import Cup, Sphere, joints
from ballsocket.core.kinds import Unit
from ballsocket.studies import Progress
from ballsocket.studies.derivatives import off_axis_uncertainty
from ballsocket.studies.distributions import Normal, Rectangular, check_nominal, tolerance
from ballsocket.studies.file import read_study
from ballsocket.studies.limits import Limit, margin_on_plane
from ballsocket.studies.metadata import _describe_array
from ballsocket.studies.parameters import vary_joint
from ballsocket.studies.run import _duration_text


def test_the_time_left_is_the_rest_over_the_rate():
    """40 points in 8 s are 5 a second: 50 more take 10 s. Stored points count as done, not as computed."""
    progress = Progress(n_done=50, n_points=100, n_stored=10, seconds=8.0)
    assert progress.rate == 5.0
    assert progress.seconds_left == 10.0
    assert Progress(n_done=0, n_points=100, n_stored=0, seconds=8.0).seconds_left == inf
    texts = {1 / 3600: "1 s", 1 / 60.5: "60 s", 1 / 59.5: "1 minutes", 0.5: "30 minutes", 2.0: "2 hours"}
    assert {hours: _duration_text(hours) for hours in texts} == texts


def test_a_nominal_value_may_lie_on_the_end_of_its_tolerance():
    """Rounding of an end does not count as outside, in either direction."""
    span = Rectangular(low=0.1, high=0.3)
    for value in (0.1, 0.3, 0.1 - 1e-12, 0.3 + 1e-12):
        check_nominal("clearance", value, span, Unit("mm"))
    for value in (0.1 - 1e-6, 0.3 + 1e-6):
        with pytest.raises(ValueError, match="lies outside its tolerance of 0.1 to 0.3 mm"):
            check_nominal("clearance", value, span, Unit("mm"))
    check_nominal("clearance", 0.1 + 3 * 0.01, Normal(mean=0.1, deviation=0.01), Unit("mm"))  # three deviations
    with pytest.raises(ValueError, match="lies outside"):
        check_nominal("clearance", 0.13, tolerance(0.1, 0.02), Unit("mm"))


def test_equal_radii_are_a_joint_without_clearance():
    joint, possible = vary_joint(
        joints["hip-36"], {"socket_radius": numpy.array([18.0, 17.9, 18.1]), "ball_radius": 18.0}
    )
    assert joint.clearance.tolist() == pytest.approx([0.0, 0.0, 0.1])
    assert joint.clearance[0] == 0.0
    assert possible.tolist() == [True, False, True]


def test_a_long_array_is_described_by_its_ends():
    described = _describe_array(numpy.arange(100_000.0) + 3)
    assert (described["count"], described["first"], described["last"]) == (100_000, 3.0, 100_002.0)


def test_a_limit_that_depends_on_one_axis_fills_the_plane():
    """Zero is a value like any other on the second axis."""
    study = xarray.Dataset(
        {"max_pressure": ("clearance", [8.0, 12.0])}, coords={"clearance": [0.1, 0.2], "friction": [0.0, 0.1, 0.2]}
    )
    margin = margin_on_plane(study, Limit(name="max_pressure", high=10.0), "clearance", "friction")
    assert margin.shape == (3, 2)
    assert numpy.isfinite(margin).all()
    assert (numpy.sign(margin) == [[1, -1]] * 3).all()


def test_rows_of_a_table_are_combined_with_samples(tmp_path):
    (tmp_path / "rows.csv").write_text("force\n1000\n2000\n")
    (tmp_path / "study.toml").write_text(
        'joint = "hip-36"\n[table]\npath = "rows.csv"\n[samples]\ncount = 4\n'
        'clearance = { low = "0.08 mm", high = "0.12 mm" }\n'
    )
    assert read_study(tmp_path / "study.toml").design.shape == (2, 4)


def test_tolerances_off_the_axis_have_the_band_of_presses_at_their_ends():
    """Results change in one direction with the force: ends of a band are presses at the ends of the force."""
    joint, force = joints["hip-36"], tolerance(2000.0, 600.0)
    model = Sphere(ring_width=radians(6.0), cup=Cup(inclination=radians(45.0), anteversion=radians(15.0)))
    effect = off_axis_uncertainty(joint, model, {"force": 2000.0}, {"force": force})
    ends = [float(force.frozen.ppf(share)) for share in (0.025, 0.5, 0.975)]
    pressed = model.press(joint, force=numpy.array(ends))
    for name in ("max_pressure", "indentation", "area"):
        assert effect.band[name] == pytest.approx(getattr(pressed, name), rel=3e-3)
    assert effect.band["edge_distance"][0] == pytest.approx(pressed.edge_distance[2], abs=0.05)
    assert effect.presses == 3
    assert 0.3 < effect.changes["max_pressure"]["force"] < 0.8
