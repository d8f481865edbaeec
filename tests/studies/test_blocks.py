"""Blocks of a study, their progress, the samples that each block draws, and the memory that a study takes."""

import tracemalloc
from dataclasses import replace
from math import inf

import numpy as np
import pytest
from scipy.stats import qmc

import ballsocket as bs
from ballsocket.studies import Progress, axes, distributions, run
from ballsocket.studies.axes import ListedAxis
from ballsocket.studies.design import Design, Span, grid, sample
from ballsocket.studies.distributions import Method, Normal, Rectangular, draw_chunk, permute, tolerance
from ballsocket.studies.metadata import _as_plain_data
from ballsocket.studies.run import _create_task, memory_size
from ballsocket.studies.task import Blocks, divide_study, points_per_block

HIP = bs.joints["hess-forsbach"]
SCATTER = {"clearance": tolerance(0.1, 0.05), "liner_poisson": Rectangular(low=0.3, high=0.4)}
EVERYTHING = (slice(None),)


@pytest.mark.parametrize("shape", [(10**8,), (464, 464, 464), (10**4, 10**4), (10, 10, 10**6), (3162, 31623)])
def test_a_large_study_has_at_most_ten_thousand_blocks(shape):
    blocks = divide_study(shape, points_per_block(bs.Exact()))
    assert 2000 < len(blocks) <= 10_000
    assert tuple(section.stop for section in blocks[len(blocks) - 1]) == shape
    assert blocks.n_points(0) * len(blocks) < 1.3 * np.prod([float(length) for length in shape])


def test_a_small_study_has_blocks_of_half_a_second_and_closed_forms_of_a_million_points():
    """The blocks are those of earlier versions, so that several workers share them."""
    points = points_per_block(bs.Exact())
    for shape in ((10**6,), (100, 100, 100)):
        assert divide_study(shape, points) == Blocks.divide(shape, points)
    assert divide_study((10**11,), points_per_block(bs.HessForsbach())).n_points(0) <= 1 << 20
    for most, size in ((0, (1, 1)), (1, (1, 1)), (4, (1, 4)), (8, (2, 4))):
        assert Blocks.divide((3, 4), most).size == size


def test_an_enlarged_block_has_the_results_of_small_ones(monkeypatch):
    forces = np.linspace(500.0, 3000.0, 10).tolist()
    small = bs.study(bs.Exact(), HIP, force=forces)
    monkeypatch.setattr("ballsocket.studies.task.points_per_block", lambda model: 4)
    task = replace(_create_task(bs.Exact(), HIP, None, {"force": forces}, ()), blocks=Blocks((10,), (10,)))
    np.testing.assert_allclose(task(0)["max_pressure"], small.max_pressure, rtol=1e-12)


def test_the_time_left_is_the_rest_over_the_rate():
    """40 points in 80 s are half a point a second: 50 more take 100 s. Stored points count as done, not as computed."""
    progress = Progress(n_done=50, n_points=100, n_stored=10, seconds=80.0)
    assert (progress.rate, progress.seconds_left) == (0.5, 100.0)
    assert Progress(n_done=0, n_points=100, n_stored=0, seconds=8.0).seconds_left == inf
    described = _as_plain_data(np.arange(100_000.0) + 3)  # in the identity of a stored study
    assert (described["count"], described["first"], described["last"]) == (100_000, 3.0, 100_002.0)


@pytest.fixture
def small_chunks(monkeypatch):
    """Chunks of 64 samples, and hypercubes that are drawn in parts."""
    for module in (axes, distributions):
        monkeypatch.setattr(module, "CHUNK_SIZE", 64)
    monkeypatch.setattr(distributions, "_MAX_SCIPY_COUNT", 0)
    axes._draw_samples.cache_clear()
    yield
    axes._draw_samples.cache_clear()


@pytest.mark.parametrize("method", Method)
def test_any_section_of_samples_is_that_of_all_samples(method, small_chunks):
    design = sample(1000, seed=4, method=method, correlation={("clearance", "liner_poisson"): 0.5}, **SCATTER)
    every = design.values_in(EVERYTHING)
    for start, stop in ((999, 1000), (0, 1), (63, 65), (100, 900), (640, 704), (5, 6)):
        part = design.values_in([slice(start, stop)])
        for name, values in every.items():
            np.testing.assert_array_equal(part[name], values[start:stop])


@pytest.mark.parametrize(
    ("method", "scipy", "count"), [("sobol", "Sobol", 1024), ("latin-hypercube", "LatinHypercube", 1050)]
)
def test_sobol_samples_and_small_hypercubes_are_those_of_scipy(method, scipy, count, small_chunks, monkeypatch):
    monkeypatch.setattr(distributions, "_MAX_SCIPY_COUNT", 2000)
    values = sample(count, seed=7, method=Method(method), **SCATTER).values_in(EVERYTHING)
    points = getattr(qmc, scipy)(2, rng=7).random(count)
    for column, (name, distribution) in zip(points.T, SCATTER.items(), strict=True):
        np.testing.assert_array_equal(values[name], distribution.frozen.ppf(column))


def test_a_permutation_has_each_number_once_and_large_hypercubes_one_sample_in_each_stratum(small_chunks):
    count = 5003
    chunks = [draw_chunk(Method.LATIN_HYPERCUBE, count, 3, 1, number) for number in range(-(-count // 64))]
    points = np.concatenate(chunks, axis=1)
    for coordinate in points:
        assert sorted(np.floor(coordinate * count).astype(int)) == list(range(count))
    assert abs(np.corrcoef(points) - np.eye(3)).max() < 4 / count**0.5
    assert np.mean(points * count % 1.0) == pytest.approx(0.5, abs=0.02)
    other = draw_chunk(Method.LATIN_HYPERCUBE, count, 3, 2, 0)
    assert not np.isclose(other, chunks[0]).any()
    keys = np.random.SeedSequence(0).generate_state(8, np.uint64)
    for count in (1, 2, 65, 1000):
        assert sorted(permute(np.arange(count, dtype=np.uint64), count, keys).tolist()) == list(range(count))


def test_no_worker_draws_all_samples(monkeypatch, small_chunks):
    drawn = []
    draw = axes.draw_chunk
    monkeypatch.setattr(axes, "draw_chunk", lambda *inputs: drawn.append(inputs[-1]) or draw(*inputs))
    monkeypatch.setattr(run, "points_per_block", lambda model: 64)
    task = _create_task(bs.HessForsbach(), HIP, sample(1000, **SCATTER), {"force": 1e3}, ())
    task(5)
    first, count = task.blocks[5][0].start, task.blocks.n_points(5)
    assert set(drawn) == set(range(first // 64, -(-(first + count) // 64)))
    assert len(drawn) <= 2


def test_samples_outside_the_range_of_a_parameter_are_named_by_their_index(small_chunks):
    design = sample(640, clearance=Normal(mean=0.1, deviation=0.038))
    values = design.values_in(EVERYTHING)["clearance"]
    first = int(np.argmax(values <= 0))
    assert first > 64
    with pytest.raises(ValueError, match=rf"clearance\[{first}\] = -.* truncate the distribution"):
        bs.study(bs.HessForsbach(), HIP, design, force=1e3)


COUNT = 1 << 21
"""Points of the studies of memory: two blocks of closed forms."""

DESIGNS = {
    "span": lambda: grid(force=Span(1e3, 2e3, COUNT)),
    "samples": lambda: sample(COUNT, **SCATTER) * grid(force=1e3),
    "table": lambda: Design((ListedAxis("row", {"clearance": np.full(COUNT, 0.1), "force": np.full(COUNT, 1e3)}),)),
}


@pytest.mark.long
@pytest.mark.parametrize("name", DESIGNS)
def test_the_memory_check_is_true_to_twenty_percent(name):
    """The largest memory of a study against its estimate; one quantity keeps the test short."""
    bs.study(bs.Hertz(), HIP, clearance=0.1, force=[1e3])  # imports
    tracemalloc.start()
    design = DESIGNS[name]()
    bs.study(bs.Hertz(), HIP, design, quantities=["max_pressure"])
    measured = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    task = _create_task(bs.Hertz(), HIP, design, {}, ("max_pressure",))
    assert memory_size(task) == pytest.approx(measured, rel=0.2)
