"""Cohorts by a series: accuracy against simulations, patients outside, the store, and the words of the command."""

import pickle
import re
from dataclasses import replace
from math import log, radians

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.core.chebyshev import chebyshev_points
from ballsocket.core.executors import Serial, processes
from ballsocket.hip import Archard, FilmLimit, iso_14242_4, logarithmic, population
from ballsocket.hip import cohort_series as module
from ballsocket.hip.cohort import CohortRun, check_cohort_memory, cohort_store, sample_patients
from ballsocket.hip.cohort_series import CohortSeries
from ballsocket.hip.patient_series import Box, basis, exponents_of, interpolation_weights
from ballsocket.hip.series_accuracy import TOLERANCES, SeriesAccuracy
from ballsocket.hip.similarity import Similarity, find_obstacle
from ballsocket.hip.variability import RESULT_COLUMNS, result_table
from ballsocket.hip.wear_laws import ContactAreaWear, CrossShear, CustomWearLaw, FrictionEnergyWear
from ballsocket.studies import LogNormal, Normal, Rectangular

from ..cli.command import answer, printed
from .hips import QUICK, UNCERTAINTY, K, hip
from .test_cohort import cohort_run
from .test_uncertainty import short_file
from .test_variability import COEFFICIENT, TIGHT, WEIGHT, variability

COUNTS = (2e5, 4e5)
NARROW = {"coefficient": LogNormal(median=K, factor=1.2), "body_weight": Normal(mean=800.0, deviation=60.0)}
FEW = 12
CUSTOM = CustomWearLaw(function=lambda cycle: 1e-9 * cycle.work)


@pytest.fixture
def few_held_out(monkeypatch):
    monkeypatch.setattr(module, "N_HELD_OUT", FEW)
    monkeypatch.setattr(module, "_SOBOL_COUNT", 512)


def series_of(run, **words):
    return CohortSeries(run=run, seed=0, engine=Serial(), **words)


def solve(run, **words):
    return series_of(run, **words).solve(lambda finished: None)


def test_polynomials_of_the_degree_are_fitted_and_interpolated_exactly():
    box = Box(ranges={"x": (-1.0, 3.0), "constant": (2.0, 2.0), "y": (0.0, 0.5)})
    points, exponents = box.sample(40), exponents_of([1, 2], 4)
    assert box.axes == ("x", "y")
    assert len(exponents) == 5 + 3 + 1
    columns = {name: np.array([point[name] for point in points]) for name in box.ranges}
    assert (columns["constant"] == 2.0).all()
    assert box.contains(columns).all()

    def polynomial(x, y):
        return 1 - x + 2 * x**4 + x**2 * y - 3 * y**2

    values = polynomial(columns["x"], columns["y"])
    coefficients = np.linalg.lstsq(basis(box.scale(columns), exponents), values, rcond=None)[0]
    other = {"x": np.array([0.3, 2.9]), "constant": np.full(2, 2.0), "y": np.array([0.1, 0.4])}
    np.testing.assert_allclose(basis(box.scale(other), exponents) @ coefficients, polynomial(other["x"], other["y"]))
    assert [point["x"] for point in box.sample(7)] == [point["x"] for point in points[:7]]
    nodes, at = 3.5 + 1.5 * chebyshev_points(6), np.array([2.0, 3.3, 5.0])
    np.testing.assert_allclose(interpolation_weights(at, 2.0, 5.0, 6) @ nodes**5, at**5, rtol=1e-12)
    np.testing.assert_array_equal(interpolation_weights(at, 2.0, 2.0, 1), np.ones((3, 1)))


def test_a_series_agrees_with_simulations_of_held_out_patients(few_held_out):
    patients = variability(**NARROW)
    run, bands = population(patients, COUNTS, patients=400, method="series", seed=3)
    held_out = replace(run, values={name: values[FEW:30] for name, values in run.values.items()})
    simulated, table = held_out.simulate(), bands.cohort.table[FEW:30]
    for name, largest in (("volume", 5e-4), ("depth", 1e-2), ("penetration", 5e-3), ("max_pressure", 5e-3)):
        column = RESULT_COLUMNS[name]
        errors = abs(table[:, :, column] / simulated.table[:, :, column] - 1)
        assert np.quantile(errors, 0.95) < largest, name
        assert 0 < bands.accuracy.relative[name] <= bands.accuracy.largest[name]
    contact = bands.cohort.contact[FEW:30]
    np.testing.assert_allclose(contact[:, :, 0], simulated.contact[:, :, 0], rtol=2e-2)
    np.testing.assert_array_equal(contact[:, :, 1], simulated.contact[:, :, 1])
    assert bands.accuracy.within_tolerance
    assert bands.n_failed == 0
    assert bands.indices["total_order"].shape == (3, 2)


def test_a_series_has_the_indices_of_a_product(few_held_out):
    """The volume of few cycles is proportional to coefficient and cycles."""
    rates = Normal(mean=1.5e6, deviation=0.2 * 1.5e6)
    two = variability(coefficient=Normal(mean=K, deviation=0.1 * K), cycles_per_year=rates)
    bands = population(two, [1e3], patients=300)[1]
    assert bands.accuracy.n_simulations == 1  # the force and the cup are the same
    assert bands.accuracy.relative["volume"] < 1e-5
    for order in ("first_order", "total_order"):
        assert bands.indices[order][0] == pytest.approx([0.2, 0.8], abs=0.02)


def test_patients_are_simulated_where_the_error_of_their_series_is_too_large(few_held_out, monkeypatch):
    monkeypatch.setattr(module, "_FIRST_DEGREES", (0,) * 5)
    monkeypatch.setattr(module, "_MAX_MEMBERS", 15)
    bands = population(variability(**NARROW), [1e3], patients=40)[1]
    assert bands.accuracy is None
    assert "each of the patients was simulated, without a series: its error exceeds the tolerance" in bands.notes


def test_few_patients_and_those_who_are_not_similar_are_simulated_and_the_reason_is_stated():
    bands = population(variability(**NARROW), COUNTS[:1], patients=3)[1]
    assert (bands.accuracy, bands.obstacle) == (None, "")
    stated = bands.summary()["uncertainty"]
    assert (stated["method"], stated["series"]) == ("runs", None)
    patients = variability(hip(**QUICK, wear=CUSTOM), body_weight=WEIGHT)
    bands = population(patients, [1e3], patients=3)[1]
    note = "each of the patients was simulated, without a series: the wear law CustomWearLaw has no known degree"
    assert any(text.startswith(note) for text in bands.notes)
    with pytest.raises(ValueError, match="the method 'series' does not hold: the wear law CustomWearLaw has no known"):
        population(patients, [1e3], patients=3, method="series")


def test_a_series_ends_where_a_load_points_5_degrees_inside_the_rim():
    """Beyond that the rim changes the contact too much for a polynomial; these patients are simulated."""
    loose = variability(tilt=Rectangular(low=0.0, high=radians(89.0)))
    low, high = series_of(cohort_run(60, loose, (1e3,))).family.box.ranges["tilt"]
    assert low < radians(1.0)
    assert radians(84.0) < high <= radians(85.0)


@pytest.mark.long
def test_patients_outside_the_ranges_have_the_results_of_simulations(few_held_out):
    patients = variability(coefficient=COEFFICIENT)
    values = sample_patients(patients, 40, 0)
    values = {"coefficient": np.concatenate([values["coefficient"], [0.0, 50 * K, 1e5 * K]])}
    run = CohortRun(variability=patients, counts=COUNTS, values=values)
    solution = solve(run)
    outside = replace(run, values={"coefficient": values["coefficient"][40:]}).simulate()
    np.testing.assert_array_equal(solution.result.table[40:], outside.table)
    assert solution.accuracy.n_outside == 3
    assert "would wear" in solution.result.refused[-1]
    assert solution.result.refused[-1] == outside.refused[-1]


def test_a_stored_series_is_not_simulated_again(tmp_path, few_held_out, monkeypatch):
    patients = variability(coefficient=COEFFICIENT)
    store = cohort_store(tmp_path / "store", patients, COUNTS, 0)
    first = population(patients, COUNTS, patients=300, store=store)[1].cohort
    names = sorted(path.name for path in (tmp_path / "store").iterdir())
    assert names == ["patients.json", "patients_000000.npz", "series_000000.npz"]

    def refuse(*arguments):
        raise AssertionError("simulated again")

    monkeypatch.setattr(Similarity, "simulate", refuse)
    monkeypatch.setattr(CohortRun, "_simulate_patient", refuse)
    again = solve(cohort_run(300, patients, COUNTS), store=store)
    np.testing.assert_array_equal(again.result.table, first.table)
    (tmp_path / "store" / "series_000000.npz").write_bytes(b"damaged")
    with pytest.raises(AssertionError, match="simulated again"):
        solve(cohort_run(300, patients, COUNTS), store=store)


def test_results_that_do_not_fit_into_memory_are_refused(monkeypatch):
    monkeypatch.setattr(processes, "available_memory", lambda: 10**8)
    with pytest.raises(ValueError, match="results of 1 000 000 patients take about .* and there are 100 MB of memory"):
        check_cohort_memory(1_000_000, 5, 2)
    check_cohort_memory(10_000, 5, 2)


def test_workers_can_simulate_the_members_of_a_family():
    """A scaled cycle has a local function, which no worker can import."""
    use = hip(**QUICK)
    patients = variability(replace(use, cycle=use.cycle.scaled(1.1)), coefficient=COEFFICIENT)
    family = series_of(cohort_run(4, patients, COUNTS[:1])).family
    sent = pickle.loads(pickle.dumps(family))
    np.testing.assert_array_equal(sent(0)["worn"], family(0)["worn"])


ANGLES = {
    "inclination": Normal(mean=radians(42.0), deviation=radians(6.0), low=radians(25.0), high=radians(60.0)),
    "anteversion": Normal(mean=radians(15.0), deviation=radians(5.0), low=0.0, high=radians(30.0)),
}


@pytest.mark.long
def test_a_series_of_oriented_cups_is_within_its_tolerance(few_held_out):
    weights = Normal(mean=780.0, deviation=130.0, low=400.0, high=1400.0)
    spread = {"coefficient": COEFFICIENT, "clearance": TIGHT, "body_weight": weights}
    accuracy = population(variability(hip(**QUICK), **spread, **ANGLES), [1e6], patients=1000)[1].accuracy
    assert accuracy.within_tolerance
    assert accuracy.relative["volume"] <= TOLERANCES["volume"]
    assert accuracy.wrong_edge_loading < 0.1


@pytest.mark.long
def test_a_series_of_creeping_patients_is_within_its_tolerance(few_held_out):
    creeping = hip(**QUICK, creep=logarithmic(), seconds_per_cycle=20.0)
    accuracy = population(variability(creeping, coefficient=COEFFICIENT), [1e6], patients=300)[1].accuracy
    assert accuracy.within_tolerance
    assert accuracy.relative["creep_depth"] < TOLERANCES["creep_depth"]


def test_the_command_states_method_and_error(tmp_path, few_held_out):
    file = short_file(tmp_path, extra=UNCERTAINTY.partition("clearance")[0])
    words = "hip", str(file), "--patients", "200"
    said = answer(*words)
    series = said["uncertainty"]["series"]
    assert (said["uncertainty"]["method"], series["simulations"], series["within_tolerance"]) == ("series", 1, True)
    assert series["error"]["volume"] <= series["tolerance"]["volume"]
    assert set(said["sobol"]["volume"]) == {"coefficient"}
    shown = " ".join(printed(*words).split())
    assert f"series of 1 simulation in place of 200: 95 % of the results of {FEW} simulated" in shown
    assert re.search(r"first order .* volume coefficient ", shown)
    simulated = answer(*words[:3], "30", "--method", "runs")
    assert simulated["uncertainty"]["series"] is None


# similarity: dimensionless numbers, members of a family, and where they do not hold

MANY = (3e5, 1e6)
RATE = LogNormal(median=1.5e6, factor=1.5)


def relative_difference(use, values, coefficient=K, **distributions):
    """Largest relative difference between a patient and the family member with the same dimensionless numbers."""
    spread = {"coefficient": LogNormal(median=coefficient, factor=1.5), "clearance": TIGHT, "body_weight": WEIGHT}
    patients = variability(use, **spread, cycles_per_year=RATE, **distributions)
    similarity = Similarity(variability=patients)
    arrays = {name: np.array([value]) for name, value in values.items()}
    numbers = {name: float(column[0]) for name, column in similarity.numbers(arrays).items()}
    exposures = [float(similarity.log_exposure(arrays)[0]) + log(count) for count in MANY]
    _, numbers_worn = similarity.simulate(numbers, exposures)
    reports = patients.patient(values).simulate(MANY)
    units = similarity.units(np.array([values["clearance"]]))
    worn = np.exp(numbers_worn[:, : len(similarity.results)])
    scaled = worn * np.array([float(units[name][0]) for name in similarity.results])
    columns = [RESULT_COLUMNS[name] for name in similarity.results]
    clearance, contacts = values["clearance"], numbers_worn[:, len(similarity.results) :]
    pressure_unit = float(similarity.modulus(clearance)) * clearance
    for (rim, _, indentation, half_angle, pressure), report in zip(contacts, reports, strict=True):
        distance = max(rim, 0.0) * float(similarity.socket_radius(clearance))
        assert distance == pytest.approx(report.edge_distance.min(), rel=1e-9, abs=1e-9)
        contact = np.exp(indentation) * clearance, half_angle, np.exp(pressure) * pressure_unit
        assert contact == pytest.approx(report.worst_contacts[0, 2:5], rel=1e-9)
    return abs(scaled / result_table(reports)[:, columns] - 1).max()


LAWS = [
    (Archard(coefficient=K), K),
    (FrictionEnergyWear(coefficient=2e-5, friction=0.05), 2e-5),
    (CrossShear(straight=K, circular=2 * K, exponent=-0.3), K),
    (ContactAreaWear(coefficient=1e-9), 1e-9),
]


@pytest.mark.parametrize(("wear", "coefficient"), LAWS, ids=lambda value: type(value).__name__)
def test_patients_with_the_same_dimensionless_numbers_wear_alike(wear, coefficient):
    values = {"clearance": 0.16, "body_weight": 900.0, "coefficient": coefficient / 2, "cycles_per_year": 2.1e6}
    tilt = Rectangular(low=0.0, high=1.0)
    assert relative_difference(hip(**QUICK, wear=wear), values | {"tilt": 0.5}, coefficient, tilt=tilt) < 1e-10


def test_creeping_patients_wear_alike_at_the_same_time_per_exposure():
    use = hip(**QUICK, creep=logarithmic(), seconds_per_cycle=20.0)
    values = {"clearance": 0.06, "body_weight": 650.0, "coefficient": 2 * K, "cycles_per_year": 1e6}
    angles = {"inclination": Rectangular(low=0.4, high=1.0), "anteversion": Rectangular(low=0.0, high=0.5)}
    assert relative_difference(use, values | {"inclination": 0.7, "anteversion": 0.2}, **angles) < 1e-10


def test_a_family_does_not_depend_on_lengths():
    """The numbers of a bore of twice the size and clearance, under four times the load, are the same."""
    forces = []
    for scale in (1.0, 2.0):
        use = hip(28.0 * scale, 8.0 * scale, 0.1 * scale)
        similarity = Similarity(variability=variability(use, clearance=TIGHT, body_weight=WEIGHT))
        values = {"clearance": np.array([0.1 * scale]), "body_weight": np.array([800.0 * scale**2])}
        forces.append(similarity.numbers(values)["force"])
    assert forces[1] == pytest.approx(forces[0], abs=1e-12)


CHAMFERED = bs.Cup(inclination=radians(30.0), chamfer=1.0)
OBSTACLES = [
    ({"wear": CUSTOM}, "CustomWearLaw has no known degree"),
    ({"ball_wear": Archard(coefficient=K)}, "the ball wears too"),
    ({"film_limit": FilmLimit(ratio=1.0, lubricant=bs.Lubricant())}, "wear has a limit of the film ratio"),
    ({"cycle": iso_14242_4()}, "the cycle has a lateral spring"),
    ({"cup": CHAMFERED}, "the chamfer of the rim has a length"),
]


@pytest.mark.parametrize(("words", "message"), OBSTACLES)
def test_patients_who_are_not_similar_have_a_reason(words, message):
    assert message in find_obstacle(variability(hip(**(QUICK | words)), clearance=TIGHT), MANY)


def test_similar_patients_have_no_obstacle():
    similar = variability(hip(**QUICK), clearance=TIGHT)
    assert find_obstacle(variability(hip(**QUICK, cup=CHAMFERED), body_weight=WEIGHT), MANY) == ""
    assert find_obstacle(similar, MANY) == ""
    assert "a report is at 0 cycles" in find_obstacle(similar, (0.0, 1e6))
    closed = variability(hip(**QUICK), clearance=Normal(mean=-0.1, deviation=0.1))
    assert "the clearance is not positive" in find_obstacle(closed, MANY)


@pytest.mark.long
def test_more_patients_keep_the_first_ones(few_held_out):
    few, more = (
        population(variability(coefficient=COEFFICIENT), COUNTS, patients=n)[1].cohort.table for n in (150, 300)
    )
    np.testing.assert_allclose(more[:150], few, rtol=1e-12)


@pytest.mark.long
def test_the_error_is_that_of_the_held_out_patients(few_held_out, monkeypatch):
    """A series of a low degree is refined; without refinement its error is stated, or patients are simulated."""
    monkeypatch.setattr(module, "_FIRST_DEGREES", (0,) * 5)
    monkeypatch.setattr(module, "_DEGREE_STEP", 6)
    patients = variability(body_weight=Normal(mean=800.0, deviation=130.0, low=400.0, high=1400.0))
    refined = population(patients, COUNTS[:1], patients=200, method="series")[1].accuracy
    assert refined.degree == 6
    monkeypatch.setattr(module, "_MAX_MEMBERS", 8)
    bands = population(patients, COUNTS[:1], patients=200, method="series")[1]
    accuracy = bands.accuracy
    assert (accuracy.degree, accuracy.within_tolerance) == (0, False)
    assert accuracy.relative["volume"] > refined.relative["volume"]
    assert any("this exceeds the tolerance of 0.1 % in volume" in note for note in bands.notes)


def test_another_edge_loading_is_stated():
    """Above 5 % of the held-out results, as for cups whose contacts often just reach the rim."""
    errors = {"relative": {"volume": 1e-4}, "largest": {"volume": 1e-3}, "edge_distance": 0.1, "utilisation": 0.0}
    for fraction, stated in ((0.0, False), (0.03, False), (0.08, True)):
        wrong = {"wrong_edge_loading": fraction, "wrong_validity": 0.0}
        accuracy = SeriesAccuracy(n_simulations=8, degree=1, n_held_out=64, **errors, **wrong)
        assert ("edge loading differs in 8 % of these results" in accuracy.notes("patients", 100)[0]) == stated
