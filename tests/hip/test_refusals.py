"""Values, files and command lines of hips that are refused, each with its message."""

from dataclasses import replace
from math import inf, nan, pi, radians
from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket import hip as bh
from ballsocket.hip.cohort import sample_patients
from ballsocket.hip.config import read_hip, read_wear_test
from ballsocket.hip.creep_law import constrained_share
from ballsocket.hip.cycle import check_step_count
from ballsocket.hip.cycle_file import TableOptions
from ballsocket.hip.in_vivo_cycles import check_body_weight
from ballsocket.hip.wear_law import wear_factor, with_coefficient
from ballsocket.hip.wear_laws import read_ball_law, read_wear_law
from ballsocket.studies import LogNormal, Rectangular

from ..refusals import edited, refused_calls, text_tables
from .hips import QUICK, SHORT, TEXT, TILTED, WEAR_DATA, K, hip, history, write_edited_file
from .test_variability import COEFFICIENT, TIGHT, WEIGHT, variability

CUSTOM = bh.CustomWearLaw(function=lambda cycle: 1e-9 * cycle.work)
WALK, STAIRS = (bh.in_vivo(name, 750.0, 16) for name in ("walking", "stairs-up"))


def each(make, values, message):
    return [(lambda value=value: make(value), message) for value in values]


def mix(cycle, count=1.0):
    return bh.Mix(activities=(bh.Activity(cycle=cycle, per_year=count),))


def custom(function):
    return hip(wear=bh.CustomWearLaw(function=function), **QUICK).after(1e4)


def cycle_of(force, angle=lambda t: 0 * t):
    return bh.Cycle(name="own", force=force, angles=lambda t: np.stack([angle(t)] * 3))


def thrown(phases):
    """Force whose direction leaves a hemisphere."""
    angle = radians(95.0) * np.sin(pi * phases)
    return 1000.0 * np.stack([-np.sin(angle), 0 * phases, np.cos(angle)])


def cup(inclination, arc):
    return bs.Cup(inclination=radians(inclination), arc_of_cover=radians(arc))


def chain(compliances, times=(1.0,)):
    return bh.KelvinVoigtChain(compliances=compliances, times=times)


def measured(**words):
    return bh.MeasuredWear(**{"quantity": "volume", "values": 38.0, **words})


def patient(**values):
    rates = LogNormal(median=1e6, factor=2.0)
    return variability(body_weight=WEIGHT, coefficient=COEFFICIENT, cycles_per_year=rates).patient(values)


def bands_of(count=2, seed=0):
    return bh.uncertainty(variability(clearance=TIGHT), history(hip(**QUICK), 1e4), count=count, seed=seed)


def sample(count, seed=0):
    return sample_patients(variability(clearance=TIGHT), count, seed)


TURNING = {"law": "cross-shear", "coefficient": 1, "circular": 1, "ball_coefficient": 1}
LUBRICANT = ("ball_roughness", "cup_roughness", "viscosity", "friction")
WORN_BALL = {"ball_wear": bh.Archard(coefficient=K)}


VALUES = [
    # wear and creep laws
    *each(lambda value: bh.Archard(coefficient=value), (-1e-9, inf, nan), "coefficient = .*at least 0, and finite"),
    *each(lambda value: bh.FrictionEnergyWear(coefficient=1, friction=value), (-0.1, 10.0), "friction = .*below 10"),
    (lambda: bh.ContactAreaWear(coefficient=-1.0), "coefficient = -1 is not allowed"),
    (lambda: bh.CrossShear(straight=-1.0, circular=1.0), "straight = -1 is not allowed"),
    (lambda: bh.CrossShear(straight=1.0, circular=-1.0), "circular = -1 is not allowed"),
    *each(lambda value: bh.CrossShear(straight=1, circular=1, exponent=value), (-1.0, 3.0), "above -1, and below 3"),
    (lambda: bh.CrossShear(straight=1, circular=1, reference=0.0), "reference = 0 .*MPa.* above 0, and"),
    (lambda: with_coefficient(bh.CrossShear(straight=0.0, circular=1e-6), 1e-6), "on a straight track is positive"),
    (lambda: with_coefficient(CUSTOM, 1e-6), "the wear law has no coefficient"),
    (lambda: custom(lambda cycle: np.nan * cycle.work), "returned a depth of nan mm"),
    (lambda: custom(lambda cycle: -1e-9 * cycle.work - 1e-9), "a depth of -.* mm: a depth is at least 0, and finite"),
    (lambda: custom(lambda cycle: 1e-9), r"returned depths of shape \(\); the points need \(\d+,\)"),
    (lambda: chain((1e-3,), (1.0, 2.0)), "as many compliances as times, .* got 1 .* and"),
    (lambda: chain((), ()), "at least one, got 0"),
    (lambda: chain((1e-3, -1e-3), (1.0, 1.0)), "compliances = -0.001 is not allowed"),
    *each(lambda value: chain((1e-3,), (value,)), (0.0, inf), "times = .* is not allowed"),
    *each(lambda value: bh.LogarithmicCreep(confinement=value), (-0.1, 1.5), "confinement = .* is not allowed"),
    (lambda: constrained_share(0.6), "poisson = 0.6 is not allowed"),
    (lambda: wear_factor("k", "1e-9 mm3/Nmm"), r"is for mm of sliding: .* is 1000 mm\^3/\(N m\), so that this is"),
    (lambda: wear_factor("k", "1e-9 mm^2/N"), r"1 mm\^2/N is 1000 mm\^3/\(N m\)"),
    (lambda: wear_factor("k", "1e-9 mm^3/(kN m)"), r"for another length of sliding|is 0.001 mm\^3/\(N m\)"),
    (lambda: wear_factor("k", "1 kg"), "has the wrong unit"),
    *each(lambda value: wear_factor("k", value), ("1e-6 __import__", "much", True), "is not a coefficient, such as"),
    *each(lambda value: wear_factor("k", value), ("-1e-6 mm^3/(N m)", nan), "k = .* is not allowed"),
    (lambda: read_ball_law(TURNING), "ball_coefficient is not allowed with the law 'cross-shear'; it belongs to"),
    (lambda: read_wear_law({"material": "pom"}), "no published wear factor of 'pom' is known here: state coefficient"),
    (lambda: read_wear_law({"material": "uhmwp"}), "material 'uhmwp' is not known; did you mean 'uhmwpe'"),
    (lambda: read_wear_law({"material": "uhmwpe", "coefficient": 1e-6}), "material and coefficient exclude each other"),
    (lambda: read_wear_law({"material": "uhmwpe", "law": "energy"}), "material gives the wear factor of the law"),
    # hips
    (lambda: hip(ring_width=3.0), "ring_width = 3 is not allowed: 0.5 to 10 degrees"),
    (lambda: hip(tolerance=0.0), "tolerance = 0 is not allowed"),
    (lambda: hip(clearance=np.array([0.1, 0.2])), "joint must have single numbers"),
    *each(hip, (1001.0, 0.9), "head_diameter = .* is not allowed: .* 1 mm to 1000 mm"),
    (lambda: hip(clearance=1000.0), "bore diameter = 2028 is not allowed"),
    (lambda: hip(liner=inf, creep=bh.logarithmic()), "liner_thickness = inf is not allowed: creep needs a liner of"),
    (lambda: hip(**WORN_BALL, creep=bh.logarithmic()), "ball_wear needs surface=Springs.. and no"),
    (lambda: hip(**WORN_BALL, surface=bs.ClosedShell()), "ball_wear needs surface=Springs.. and"),
    (lambda: hip(cycle=cycle_of(thrown), cup=bs.Cup()), r"dislocated at 40\.5 % .*: the load of 1000 N points 90\.\d°"),
    (lambda: hip(cup=replace(TILTED, arc_of_cover=radians(50.0))), r"dislocated at .*, and the bore ends at 25\.0°"),
    (lambda: hip(cycle=mix(STAIRS), cup=cup(45.0, 60.0)), r"dislocated at \d\.\d % of stairs-up"),
    (lambda: hip(cycle=bh.iso_14242_4(50, mismatch=8.0), cup=cup(80.0, 150.0)), "dislocated at .* % of the cycle"),
    *each(lambda value: hip().after(value), (0.0, nan), "cycles = .* is not allowed"),
    *each(lambda value: hip().after(1e6, [value]), (2e6, -1), "report_at = .* is not allowed"),
    (lambda: hip().after(1e12), r"1e\+12 cycles at the rate of the first one would wear [.\d]+e\+05 mm away"),
    # film
    *each(lambda name: bh.Lubricant(**{name: -1.0}), LUBRICANT, "[a-z_]+ = -1 is not allowed"),
    (lambda: bh.Lubricant(viscosity=0.0), "viscosity = 0 is not allowed"),
    (lambda: bh.Lubricant(cup_roughness=inf), "cup_roughness = inf is not allowed"),
    *each(lambda value: bh.FilmLimit(ratio=value), (-1.0, nan), "film_limit = .* is not allowed: a film ratio is at"),
    (lambda: bh.FilmLimit(cycles=0), "cycles = 0"),
    (lambda: hip(**QUICK, clearance=0.0, film_limit=bh.FilmLimit()), "clearance = 0.* not allowed: film_limit needs"),
    # cycles
    *each(lambda load: bh.iso_14242_4(swing_load=load), (0.0, inf), "swing_load = .* is not allowed"),
    *each(lambda value: bh.Spring(stiffness=value, mismatch=4.0), (0.0, inf), "stiffness = .* is not allowed"),
    *each(lambda value: bh.Spring(stiffness=9.0, mismatch=value), (0.0, inf), "mismatch = .* is not allowed"),
    (lambda: bh.rocking(order="xx"), "rotation_order = 'xx' is not allowed"),
    *each(check_body_weight, (0.0, 10_001.0, nan), "body_weight = .* is not allowed: .*above 0 and at most 10000 N"),
    (lambda: bh.named_cycle("jogging"), "'jogging' has loads in multiples of body weight: set body_weight"),
    (lambda: bh.named_cycle("two-axis", body_weight=750.0), "'two-axis' has loads in N: it does not take a body_weig"),
    (lambda: bh.named_cycle("iso-14242"), "cycle 'iso-14242' is not known; did you mean 'iso-14242-[14]'"),
    (lambda: bh.in_vivo("waking", 800.0), "load 'waking' is not known; did you mean 'walking'"),
    (lambda: cycle_of(lambda t: np.where(t > 0.5, nan, 1.0)), "force.* = nan .*: the numbers of a cycle are finite"),
    (lambda: cycle_of(lambda t: 1 + 0 * t, lambda t: nan * t), "angle.* is not allowed"),
    *each(check_step_count, (7, 10_001, 72.0, True, "8", None), "n_steps = .* is not allowed: .* from 8 to 10000"),
    (lambda: bh.iso_14242_1(7), "n_steps = 7 is not allowed"),
    (lambda: bh.Mix(activities=()), "a mix needs at least one activity"),
    (lambda: mix(bh.iso_14242_4(40)), "iso-14242-4 has forces in the cup's frame, or a spring: it cannot be part"),
    (lambda: mix(replace(WALK, frame=bh.Frame.CUP)), "walking has forces in the cup's frame"),
    *each(lambda count: mix(WALK, count), (0.0, inf), "per_year = .* is not allowed"),
    (lambda: TableOptions(frame="thigh"), "frame 'thigh' is not known"),
    (lambda: TableOptions(force_on="bone"), "force_on 'bone' is not known"),
    *each(lambda value: TableOptions(closing=value), (0.51, -0.01), "closing = .* is not allowed: 0 to 0.5 of the"),
    # patients
    *each(sample, (0, 1_000_001), "patients = .* is not allowed: it must be 1 to"),
    (lambda: sample(1, -1), "seed = -1 is not allowed: it must be at least 0"),
    (lambda: bands_of(count=1), "count = 1 is not allowed: it must be at least 2"),
    (lambda: bands_of(seed=-1), "seed = -1 is not allowed: it must be at least 0"),
    (lambda: patient(coefficient=-1e-9), "coefficient = -1e-09 is not allowed: it must be at least 0"),
    *each(lambda value: patient(body_weight=value), (0.0, inf), "body_weight = .* is not allowed: it must be positive"),
    (lambda: patient(cycles_per_year=-1.0), "cycles_per_year = -1 is not allowed: it must be positive"),
    (lambda: patient(coefficient=1.0).simulate([1e7]), "cycles at the rate of the first one would wear"),
    (lambda: variability(), "no quantity differs between patients: give one of coefficient, clearance"),
    (lambda: variability(weight=WEIGHT), "'weight'"),
    (lambda: variability(hip(wear=CUSTOM), coefficient=COEFFICIENT), "coefficient"),
    (lambda: variability(tilt=TIGHT, anteversion=TIGHT), "tilt and anteversion both orient the cup: give one of them"),
    (lambda: variability(body_weight=Rectangular(low=-3.0, high=1.0)), "the median of body_weight = -1 is not allowed"),
    (lambda: variability(cycles_per_year=Rectangular(low=-1.0, high=1.0)), "the median of cycles_per_year = 0 is not"),
    (lambda: bh.population(variability(clearance=TIGHT), [1e3], patients=2, method="serie"), "'serie'.* mean 'series'"),
    # measured wear
    (lambda: measured(quantity="weight"), "quantity 'weight' is not known"),
    (lambda: measured(rate="final"), "rate 'final' is not known; did you mean 'initial'"),
    (lambda: measured(), "volume needs the cycles of its values, or else the kind of its rate: initial, steady, mean"),
    (lambda: measured(cycles=[1e6, 2e6]), "volume has 1 value and cycles has 2"),
    (lambda: measured(cycles=1e6, rate="mean"), "a rate of volume takes from and to, not cycles"),
    (lambda: measured(rate="steady", end=2e6), "a steady rate of volume needs from and to"),
    (lambda: measured(rate="mean"), "a mean rate of volume needs to"),
    (lambda: measured(rate="mean", begin=1e6, end=2e6), "a mean rate is from 0 cycles"),
    (lambda: measured(rate="steady", begin=2e6, end=1e6), "to = 1e.06 is not allowed"),
    (lambda: measured(rate="initial", end=1e6), "an initial rate is that of the new bore"),
    (lambda: measured(rate="initial", quantity="penetration"), "an initial rate of penetration is not defined"),
    (lambda: measured(cycles=1e6, values=-1.0), "a measured wear is positive and finite"),
    (lambda: measured(cycles=1e6, uncertainty=0.0), "a standard uncertainty is positive"),
    (lambda: measured(cycles=1e6, begin=1.0), "from and to belong to a rate"),
]


test_values_that_are_not_allowed_are_refused = refused_calls(*VALUES)


test_other_kinds_of_values_are_type_errors = refused_calls(
    *each(lambda value: bh.Archard(coefficient=value), ("1e-6", True, None, [1e-6]), "coefficient must be one"),
    (lambda: bh.FilmLimit(ratio=[1.0, 2.0]), "film_limit must be one number"),
    (lambda: hip(**QUICK, film_limit=1.0), "film_limit must be a FilmLimit"),
    error=TypeError,
)


@pytest.mark.parametrize("words", [{"wear": CUSTOM}, {"ball_wear": CUSTOM}])
def test_a_run_by_a_custom_law_cannot_be_stored(words, tmp_path):
    with pytest.raises(ValueError, match="runs with a CustomWearLaw cannot be stored"):
        hip(**words, **QUICK).after(1e4, store=tmp_path)


# files

STATION_TABLES = {
    "cycles,A\n1,2\n": r"the column 'A' has no unit: write 'A \[mg\]'",
    "cycles,A [mm^3/Mc]\n1,2\n2,x\n": "line 3 has 'x' under 'A ",
    "cycles,A [mm/Mc]\n1,2\n": r"values = .2.0 mm/Mc. must be a number with mm\^3 or a unit that converts to it",
    "cycles,A [mm^3/Mc]\n1,-2\n": r"values = '-2.0 mm\^3/Mc' is not allowed: a measured wear and",
    "station,mass [mg]\nA,2\n": "the column volume is missing; the columns are station, mass",
}
EDITS, MEASURED, _ = text_tables(Path(__file__).parent / "refused.txt")
VALUES = 'values = "38 mm^3/Mc"\n'
MEASURED += [(VALUES, f'file = "{i}.csv"\n', f"{i}.csv: {text}") for i, text in enumerate(STATION_TABLES.values())]


@pytest.mark.parametrize(("old", "new", "message"), EDITS)
def test_wrong_files_are_refused_with_their_name(tmp_path, old, new, message):
    with pytest.raises(ValueError, match=f"hip.toml: .*{message}"):
        read_hip(write_edited_file(tmp_path, text=edited(TEXT, old, new)))


@pytest.mark.parametrize(("old", "new", "message"), [*MEASURED, (WEAR_DATA, "", "no measured wear: add ")])
def test_files_of_measured_wear_that_mean_nothing_are_refused(tmp_path, old, new, message):
    for i, table in enumerate(STATION_TABLES):
        (tmp_path / f"{i}.csv").write_text(table, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        read_wear_test(write_edited_file(tmp_path, *SHORT[1:], text=edited(f"{TEXT}\n{WEAR_DATA}", old, new)))
