"""Cycles: what their key points say, how they are read, what is refused."""

from math import degrees, pi, radians, sin

import numpy as np
import pytest

from ballsocket.hip import (
    Cycle,
    constant_load,
    flexion,
    iso_14242_1,
    iso_14242_1_key_points,
    named_cycle,
    rocking,
    two_axis,
)
from ballsocket.hip.cycle import order_of
from ballsocket.hip.cycle_file import read_cycle
from ballsocket.hip.sliding import rotation_matrices, rotation_vectors, slide

UP = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("phase", "newton"), [(0.0, 300), (0.12, 3000), (0.32, 1500), (0.5, 3000), (0.62, 300), (0.8, 300), (1.0, 300)]
)
def test_the_standards_force(phase, newton):
    assert iso_14242_1().force(np.array([phase]))[0] == pytest.approx(newton, rel=1e-12)


@pytest.mark.parametrize(
    ("phase", "flexed", "adducted", "turned"),
    [(0.0, 25, None, -10), (0.21, None, 7, None), (0.5, -18, None, 2), (0.71, None, -4, None)],
)
@pytest.mark.parametrize("make", [iso_14242_1, iso_14242_1_key_points])
def test_the_standards_angles(make, phase, flexed, adducted, turned):
    angles = np.degrees(make().angles(np.array([phase])))[:, 0]
    for angle, expected in zip(angles, (flexed, adducted, turned), strict=True):
        assert expected is None or angle == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("radius", [11.1125, 14.0, 18.0])
@pytest.mark.parametrize("instants", [8, 72, 100])
def test_flexion_alone_slides_twice_its_range(radius, instants):
    cycle = flexion(instants)
    assert slide(radius, cycle.rotation_increments, UP) == pytest.approx(2 * radians(43.0) * radius, rel=1e-12)


def test_a_rotation_vector_is_what_the_rotation_was_made_of():
    rng = np.random.default_rng(3)
    axes = rng.normal(size=(50, 3))
    angles = rng.uniform(1e-9, 3.0, 50)
    vectors = axes / np.linalg.norm(axes, axis=1)[:, None] * angles[:, None]
    x, y, z = np.moveaxis(vectors, -1, 0)
    cross = np.stack([0 * x, -z, y, z, 0 * x, -x, -y, x, 0 * x], axis=-1).reshape(-1, 3, 3)
    from scipy.linalg import expm

    assert rotation_vectors(np.array([expm(each) for each in cross])) == pytest.approx(vectors, rel=1e-7, abs=1e-15)


def test_the_order_of_rotations_is_an_input():
    angles = np.radians([20.0, 10.0, -30.0])
    x, y, z = (rotation_matrices(angles * (np.arange(3) == axis), "xyz") for axis in range(3))
    assert rotation_matrices(angles, "zxy") == pytest.approx(z @ x @ y, abs=1e-15)
    slides = {order: slide(14.0, iso_14242_1(100, order).rotation_increments, UP) for order in ("xyz", "zyx", "yxz")}
    assert len({round(each, 3) for each in slides.values()}) == 3


@pytest.mark.parametrize(
    ("text", "axes"),
    [
        ("flexion, adduction, rotation", "xyz"),
        ("FE-AA-IER", "xyz"),
        ("zyx", "zyx"),
        (["rotation", "flexion", "adduction"], "zxy"),
    ],
)
def test_words_for_an_order(text, axes):
    assert order_of(text) == axes


def test_what_is_no_order_is_refused():
    with pytest.raises(ValueError, match="rotation_order = 'flexion, flexion, rotation' is not allowed"):
        order_of("flexion, flexion, rotation")


@pytest.mark.parametrize("name", ["iso-14242-1", "ISO 14242-1", "iso_14242_1"])
def test_cycles_by_name(name):
    assert named_cycle(name).name == "iso-14242-1"


def test_a_cycle_that_is_none_is_told_its_neighbour():
    with pytest.raises(ValueError, match="cycle 'iso-14242' is not known; did you mean 'iso-14242-[14]'"):
        named_cycle("iso-14242")


def test_a_cycle_of_numbers_that_are_none_is_refused():
    with pytest.raises(ValueError, match="force.* = nan .*is not allowed: the numbers of a cycle are finite"):
        Cycle(name="own", force=lambda t: np.where(t > 0.5, np.nan, 1.0), angles=lambda t: np.zeros((3, len(t))))


def test_two_axes_cross_tracks():
    cycle = two_axis(1000)
    angles = np.degrees(cycle.angles(np.linspace(0.0, 1.0, 1001)))
    assert np.ptp(angles, axis=1) == pytest.approx([46.0, 12.0, 0.0], abs=1e-9)
    assert (cycle.force_magnitudes.min(), cycle.largest_force) == pytest.approx((400.0, 2000.0), rel=1e-6)


@pytest.mark.parametrize(("name", "percent"), [("walking", 247), ("stairs-down", 260), ("stumbling", 870)])
def test_loads_of_patients_are_multiples_of_their_weight(name, percent):
    cycle = named_cycle(name, body_weight=750.0)
    assert cycle.largest_force == pytest.approx(7.5 * percent, rel=1e-6)
    assert "Bergmann" in cycle.notes[0]
    assert "assumed" in cycle.notes[0]


def test_the_weight_of_a_body_belongs_to_loads_of_patients():
    with pytest.raises(ValueError, match="the loads of 'jogging' are multiples of the body's weight"):
        named_cycle("jogging")
    with pytest.raises(ValueError, match="the loads of 'two-axis' are a machine's: it takes no body_weight"):
        named_cycle("two-axis", body_weight=750.0)
    with pytest.raises(ValueError, match="body_weight = -1 is not allowed"):
        named_cycle("walking", body_weight=-1.0)


def test_rocking_goes_round_and_a_constant_load_is_constant():
    leaning = rocking(amplitude=radians(23.0)).rotations[:, 2]
    assert np.degrees(np.arccos(leaning[:, 2])) == pytest.approx(23.0, rel=1e-9)
    assert slide(14.0, rocking(1000).rotation_increments, UP) == pytest.approx(
        2 * pi * 14.0 * sin(radians(23.0)), rel=1e-4
    )
    assert np.ptp(constant_load().force_magnitudes) == 0


# a table of one's own


def written(path, change=lambda rows: rows, heads="time [s],force [N],flexion [deg],adduction [deg],rotation [deg]"):
    """ISO's cycle as a table of 201 lines."""
    phase = np.linspace(0.0, 1.0, 201)
    cycle = iso_14242_1()
    rows = np.column_stack([1.2 * phase, cycle.force(phase), *np.degrees(cycle.angles(phase))])
    lines = [",".join(f"{number:.9g}" for number in row) for row in rows]
    path.write_text("\n".join(["# a comment", heads, *change(lines)]) + "\n")
    return path


def test_a_table_of_ones_own_is_the_same_cycle(tmp_path):
    cycle, expected = read_cycle(written(tmp_path / "walk.csv")), iso_14242_1()
    assert cycle.duration == pytest.approx(1.2)
    assert cycle.forces == pytest.approx(expected.forces, abs=2.0)
    assert slide(14.0, cycle.rotation_increments, UP) == pytest.approx(
        slide(14.0, expected.rotation_increments, UP), rel=1e-3
    )


def test_units_and_body_weight(tmp_path):
    def other(lines):
        rows = np.array([[float(each) for each in line.split(",")] for line in lines])
        rows = rows * [1000.0, 100 / 750, pi / 180, pi / 180, pi / 180]
        return ["\t".join(f"{number:.12g}" for number in row) for row in rows]

    heads = "time [ms]\tforce [%BW]\tflexion [rad]\tadduction [rad]\trotation [rad]"
    path = written(tmp_path / "walk.tsv", other, heads)
    cycle = read_cycle(path, body_weight=750.0)
    assert cycle.forces == pytest.approx(read_cycle(written(tmp_path / "walk.csv")).forces, rel=1e-6)
    with pytest.raises(ValueError, match="the column force is in %BW, and no body_weight is given"):
        read_cycle(path)


def test_three_components_of_the_force(tmp_path):
    heads = "phase [%],force_x [kN],force_y [kN],force_z [kN]"
    lines = [f"{100 * t},{0.1 * np.sin(2 * pi * t)},0.0,{2 + np.cos(2 * pi * t)}" for t in np.linspace(0, 1, 41)]
    cycle = read_cycle(written(tmp_path / "load.csv", lambda _: lines, heads))
    turn = 2 * pi * cycle.phases
    assert cycle.forces == pytest.approx(
        np.column_stack([100 * np.sin(turn), 0 * turn, 2000 + 1000 * np.cos(turn)]), abs=3.0
    )
    assert degrees(abs(cycle.rotation_increments).max()) == 0


@pytest.mark.parametrize(
    ("change", "refused"),
    [
        (
            lambda rows: [*rows[:-1], rows[100].replace(rows[100].split(",")[0], "1.2", 1)],
            r"does not close: force begins with 300 N and ends with 3000 N",
        ),
        (lambda rows: [*rows[:50], *rows[80:]], r"time has a gap from 0\.294 to 0\.48, 31 usual steps long"),
        (lambda rows: [*rows[:7], rows[7].split(",")[0] + ",nan,0,0,0", *rows[8:]], "line 10 has 'nan' for force"),
        (lambda rows: [*rows[:7], rows[7].split(",")[0] + ",,0,0,0", *rows[8:]], "line 10 has nothing for force"),
        (lambda rows: [*rows[:7], rows[7].split(",")[0] + ",300,0,0", *rows[8:]], "line 10 has nothing for rotation"),
        (lambda rows: [*rows[:9], rows[3], *rows[10:]], "time does not rise from row 9 to row 10"),
        (lambda rows: rows[:3], "3 lines below the heads; a cycle has 5 to"),
    ],
)
def test_a_table_that_is_no_cycle(tmp_path, change, refused):
    with pytest.raises(ValueError, match=f"walk.csv: .*{refused}"):
        read_cycle(written(tmp_path / "walk.csv", change))


@pytest.mark.parametrize(
    ("heads", "refused"),
    [
        (
            "time [s],force,flexion [deg],adduction [deg],rotation [deg]",
            r"the column force has no unit: write 'force \[N\]'",
        ),
        (
            "time [s],force [lbf],flexion [deg],adduction [deg],rotation [deg]",
            "the unit 'lbf' of the column force is not known",
        ),
        ("time [s],load [N],flexion [deg],adduction [deg],rotation [deg]", "'load' as a column is not known"),
        ("time [s],force [N],force [N],adduction [deg],rotation [deg]", "the column force is there twice"),
        (
            "flexion [deg],force [N],adduction [deg],force_x [N],rotation [deg]",
            r"a column time \[s\] or phase \[%\] is needed",
        ),
        ("time [s],force_x [N],flexion [deg],adduction [deg],rotation [deg]", r"a column force \[N\], or force_x"),
    ],
)
def test_heads_of_a_table_that_say_too_little(tmp_path, heads, refused):
    with pytest.raises(ValueError, match=refused):
        read_cycle(written(tmp_path / "walk.csv", heads=heads))


def test_a_cycle_has_a_sensible_number_of_instants():
    with pytest.raises(ValueError, match="n_steps = 7 is not allowed: a whole number from 8 to 10000"):
        iso_14242_1(7)
    with pytest.raises(ValueError, match="n_steps = 72.0 is not allowed"):
        iso_14242_1(72.0)
