"""Wrong designs, tables, samples, sensitivities and calibrations: each is refused with the reason."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.studies.derivatives import finite_differences, off_axis_uncertainty
from ballsocket.studies.design import Method, Span, sample, table
from ballsocket.studies.distributions import Normal, Rectangular, copula_matrix, tolerance
from ballsocket.studies.limits import Limit
from ballsocket.studies.variance_indices import shapley_effects
from ballsocket.studies.variance_shares import sensitivity

HIP = bs.joints["hess-forsbach"]
RIGID = HIP.replace(ball=None)
SCATTER = {"clearance": tolerance(0.1, 0.05)}
POISSON = {"liner_poisson": Rectangular(low=0.3, high=0.4)}
BOTH = {**SCATTER, **POISSON}
NORMAL = [Normal(mean=0.0, deviation=1.0)]
PAIR, OTHER = ("clearance", "force"), ("force", "liner_young")
CLASH = {PAIR: 0.9, OTHER: 0.9, ("clearance", "liner_young"): -0.9}
TWO = HIP.replace(liner_thickness=np.array([3.0, 5.0]))
MANY = sample(10**12, method=Method.LATIN_HYPERCUBE, clearance=Rectangular(low=0.05, high=0.15))


def press(joint=HIP, **axes):
    return bs.study(bs.HessForsbach(), joint, **axes)


def scattered(distributions=SCATTER, model=bs.Tabulated(), load=1000.0, **options):  # noqa: B008
    return sensitivity(model, HIP, distributions, load={"force": load}, **options)


def correlated(correlation):
    return copula_matrix(["clearance", "force", "liner_young"], correlation)


def off_axis(force=2000.0, /, **spread):
    return off_axis_uncertainty(HIP, bs.Sphere(cup=bs.Cup(inclination=0.8)), {"force": force}, spread)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: press(clearance=[0.1]), "one load is needed"),
        (lambda: press(clearence=[0.1], force=1.0), "did you mean 'clearance'"),
        (lambda: press(force=1.0, indentation=0.1), "one load is needed, got force, indentation"),
        (lambda: press(ball_radius=1.0, socket_radius=2.0, clearance=1.0, force=1.0), "any two of them fix the third"),
        (lambda: press(ball_radius=9, clearance=1, outer_radius=20, liner_thickness=2, force=1), "either fixes the"),
        (lambda: press(outer_radius=20.0, force=1.0), "add the one that stays, ball_radius = .* or liner_thickness = "),
        (lambda: press(head_diameter=[30.0], ball_radius=[15.0], force=1.0), "head_diameter.* ball_radius|ball_radius"),
        (lambda: press(clearance=[], force=1.0), "clearance has no values"),
        (lambda: press(head_diameter=[28.0, 32.0, 28.0], force=1.0), "head_diameter has 28 mm twice"),
        (lambda: press(clearance=[0.1, np.nan], force=1.0), r"clearance\[1\] = nan is not allowed"),
        (lambda: press(force=Span(-1.0, 5.0, 10**6)), r"force\[0\] = -1 is not allowed: a force .N. is 0 or more"),
        (lambda: press(force=["1 kN"]), "force must be a row of numbers"),
        (lambda: Span(1.0, 2.0, 0), "count = 0 is not allowed: a span has at least one value"),
        (lambda: Span(1.0, 2.0, 10**400), "count = 1000.*[.]{3} is not allowed: a span has .* at most 1e15"),
        (lambda: press(joint=RIGID, ball_young=[1e4, 1e5], force=1e3), "ball of this joint is rigid: .* no ball_young"),
        (lambda: press(joint=HIP.replace(clearance=np.array([0.1, 0.2])), force=[1e3]), "plain numbers"),
        (lambda: Limit(name="half_angle", high=45), "half_angle = 45 .*; 45 degrees are 0.7854 radians$"),
        # materials
        (lambda: press(liner=["uhmwpe"], force=1.0), r"liner must be a list of Materials, got \['uhmwpe'\]"),
        (lambda: press(liner=1000.0, force=1.0), "liner must be a Material or a list of Materials, got 1000"),
        (lambda: press(liner=[bs.POM, bs.POM], force=1.0), "liner has POM twice"),
        (lambda: press(liner=[bs.POM], liner_young=[1.0], force=1.0), "liner_young varies along two axes"),
        # samples
        (lambda: sample(4, **SCATTER) * sample(4, **POISSON), "two axes have the name sample"),
        (lambda: sample(2**30 + 1, **SCATTER), "count = 1073741825 is not allowed: Sobol's sequence has 2.30 points"),
        # memory
        (lambda: press(force=Span(1.0, 2.0, 10**12)), "1 000 000 000 000 points take about .* TB and .* hours on one"),
        (lambda: press(store="s", force=Span(1.0, 2.0, 10**12)), "of memory for the values along its axes; use fewer"),
        (lambda: press(store="s", design=MANY, force=1e3), "1 000 000 000 000 points take .* on the disk of the store"),
        (lambda: scattered(count=1 << 30), "indices of 1073741824 samples take about .* GB, and there are .* of mem"),
        # sensitivities
        (lambda: scattered({"force": tolerance(3e3, 5e2)}), "force scatters and is given as a load too"),
        (lambda: scattered({}), "at least one number must scatter"),
        (lambda: scattered({"liner_poisson": Rectangular(low=0.4, high=0.499999)}), "no answer for .* of 1024 samples"),
        (lambda: scattered(count=1), "count = 1 is not allowed: the number of samples is 2 to"),
        (lambda: scattered(confidence=1.0), "a confidence level is between 0 and 1"),
        (lambda: scattered(BOTH, second_order=True, correlation={tuple(BOTH): 0.5}), "second-order indices need indep"),
        (lambda: scattered(model=bs.HessForsbach(), quantities=["force"], count=64), "force does not change with"),
        (lambda: finite_differences(bs.Hertz(), HIP, ("area",), {"force": 0.0}), "force = 0 is first contact"),
        (lambda: shapley_effects(abs, NORMAL * 11, np.eye(11), 2, 0, None), "parameters = 11 .* ones are at most"),
        (lambda: off_axis(3000.0, force=tolerance(2000.0, 600.0)), "force = 3000 N lies outside its tolerance"),
        (lambda: off_axis(tilt=tolerance(0.5, 0.1)), "tilt has a tolerance, and the direction of the load is set by"),
        # correlations
        (lambda: correlated({("clearance", "young"): 0.5}), "'young' among the correlated parameters is not known"),
        (lambda: correlated({("clearance", "clearance"): 0.5}), "needs two parameters"),
        (lambda: correlated({PAIR: 1.0}), r"correlation of clearance and force = 1.* between -1 and 1"),
        (lambda: correlated({PAIR: 0.5, PAIR[::-1]: 0.4}), "is given twice"),
        (lambda: correlated(CLASH), "no joint distribution has .* clearance, force = 0.9; .*: reduce them"),
        # calibrations
        *((lambda f=f: bs.calibrate(HIP, force=f), "loads .N. above 0") for f in ([0.0, 1000.0], np.nan, [])),
        (lambda: bs.calibrate(HIP, force=1e9), "exact has no result for some joints or loads: .* not reach this load"),
        (lambda: bs.calibrate(TWO, form=bs.as_polynomial), "has 2 different values, but Eq. .18. has three constants"),
        # other kinds
        (lambda: press(joint="hip-28", force=1.0), "joint must be a Joint, got 'hip-28'"),
        (lambda: press(design=3000.0), r"design must be a Design, .* got 3000\.0; loads have names"),
    ],
)
def test_a_wrong_call_is_refused_with_the_reason(call, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises((ValueError, TypeError), match=message):
        call()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"ball_radius,clearence\n16,0.1\n", "did you mean 'clearance'"),
        (b"ball_radius,force,half_angle_deg\n16,,\n", r"force in line 2 of rows.csv = nan is not allowed"),
        (b"clearance_deg,force\n6,1000\n", "the unit of clearance_deg = '1 deg' is not a length"),
        (b"clearance,force\n0.1,1000,7\n", "rows.csv: line 2 has 3 cells, the line of heads 2"),
        (b'force\n"1\n2\n', "rows.csv: it is not a table in text: unexpected end of data, in line 4"),
        (b"force\n" + b"1" * 99_000 + b"\n", "force in line 2 of rows.csv = inf"),
        (b"force\n" + b"1" * 200_000 + b"\n", "rows.csv: it is not a table in text: field larger than field limit"),
        (b'force\n"' + b"1\n" * 80_000 + b'"', "rows.csv: it is not a table in text: field larger than field limit"),
        (b",".join([b"force"] * 16_000), "rows.csv: the column force appears twice"),
        (b"\x1b[31m\n1\n", r"rows.csv: column '.x1b\[31m' is not known"),
        (b"a" * 90_000 + b"\n1\n", "rows.csv: column 'a{39}... is not known"),
        (b"force\n\xff\n", "rows.csv has no rows of numbers"),
        (b"force\n1\0\n", "rows.csv: it is not text in UTF-8, UTF-16 or cp1252"),
    ],
    ids=range(13),
)
def test_a_file_that_is_no_table_is_refused_in_a_short_sentence(content, message, tmp_path):
    (tmp_path / "rows.csv").write_bytes(content)
    with pytest.raises(ValueError, match=message) as refused:
        table(tmp_path / "rows.csv")
    assert len(str(refused.value)) < 300
