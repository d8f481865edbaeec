"""Measurements from files: heads with units, uncertainties and gaps."""

from pathlib import Path

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identification import HeavyTailed, Machine, NormalScatter
from ballsocket.identification.columns import Gaps, read_measured
from ballsocket.identification.file import read_identify
from ballsocket.studies import Normal

from ..refusals import text_tables, unescaped

HIP = bs.joints["hess-forsbach"]
FORCE = np.array([250.0, 500.0, 1000.0, 2000.0, 3000.0])
CONTACT = bs.Tabulated().press(HIP, force=FORCE)
READ = CONTACT.indentation + 5e-6 * FORCE + 0.002
TRUTH = {"clearance": HIP.clearance, "liner_young": HIP.liner.young, "frame.compliance": 5e-6}
HEADS = "force_N,indentation_um\n"


def csv(folder, text, name="press.csv"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def rows(heads, *columns):
    lines = [",".join(f"{number:.6g}" for number in row) for row in zip(*columns, strict=True)]
    return "\n".join([heads, *lines]) + "\n"


def numbers(folder, text, **settings):
    return read_measured(csv(folder, text), **{"uncertainty": "1 um", **settings})


def test_a_file_holds_several_quantities(tmp_path):
    heads = "# made by hand\n# not measured\nforce_kN,indentation_um,area_mm2,area_uncertainty_mm2"
    columns = (FORCE / 1e3, 1e3 * CONTACT.indentation, CONTACT.area, 0.03 * CONTACT.area)
    depth, area = numbers(tmp_path, rows(heads, *columns), uncertainty="2 %")
    np.testing.assert_allclose(depth.values, CONTACT.indentation, rtol=1e-5)
    np.testing.assert_allclose(depth.uncertainty, 0.02 * CONTACT.indentation, rtol=1e-5)
    np.testing.assert_allclose([area.force, area.uncertainty], [FORCE, 0.03 * CONTACT.area], rtol=1e-5)
    assert (depth.quantity, area.quantity, area.name) == ("indentation", "area", "press.csv")
    (chosen,) = read_measured(tmp_path / "press.csv", quantities=["area"], load="force")
    assert chosen.quantity == "area"


def test_the_first_load_of_force_indentation_and_half_angle_is_the_default(tmp_path):
    text = "indentation_um,half_angle_deg,area_mm2\n20,30,200\n30,35,300\n"
    half_angle, area = numbers(tmp_path, text, uncertainty=0.01)
    assert (half_angle.load, area.load) == ("indentation", "indentation")
    np.testing.assert_allclose(half_angle.values, np.radians([30.0, 35.0]))
    depth, area = numbers(tmp_path, text, load="half_angle", uncertainty=0.01)
    assert (depth.quantity, depth.load) == ("indentation", "half_angle")
    (free_play,) = numbers(tmp_path, "diametral_clearance_um\n200\n210\n")
    assert (free_play.load, free_play.values.tolist()) == ("", pytest.approx([0.2, 0.21]))


def test_uncertainties_have_columns_or_one_text_or_are_estimated_later(tmp_path):
    text = "force_N,force_uncertainty_N,indentation_um,indentation_uncertainty_um\n100,2,20,0.5\n200,3,30,0.7\n"
    (depth,) = read_measured(csv(tmp_path, text))
    np.testing.assert_allclose(depth.uncertainty, [5e-4, 7e-4])
    np.testing.assert_allclose(depth.load_uncertainty, [2.0, 3.0])
    plain = "force_N,displacement_um\n100,20\n200,30\n"
    for stated, expected in (("2 %", [4e-4, 6e-4]), ("1 um", [1e-3, 1e-3]), (2e-3, [2e-3, 2e-3])):
        (depth,) = numbers(tmp_path, plain, uncertainty=stated, load_uncertainty=4.0)
        np.testing.assert_allclose(depth.uncertainty, expected)
        assert depth.load_uncertainty.tolist() == [4.0, 4.0]
    (depth,) = read_measured(tmp_path / "press.csv")
    assert depth.load_uncertainty.tolist() == [0.0, 0.0]
    assert (depth.has_unknown_noise, depth.quantity, depth.name) == (True, "indentation", "press.csv")


def test_angles_belong_to_pressures_a_machine_to_indentations_and_a_saturation_to_films(tmp_path):
    machine = Machine(offset=0.01)
    text = "force_N,angle_deg,pressure_MPa,indentation_um,area_mm2\n900,0,5,20,100\n900,10,4,20,100\n"
    pressure, depth, area = numbers(tmp_path, text, uncertainty=0.1, machine=machine)
    np.testing.assert_allclose(pressure.angle, np.radians([0.0, 10.0]))
    assert depth.angle is area.angle is None
    assert depth.machine is machine
    assert (area.machine.name, pressure.machine.name) == ("", "")
    assert depth.saturation == area.saturation == np.inf
    (film,) = numbers(tmp_path, "force_N,max_pressure_MPa\n900,5\n1800,7\n", uncertainty=0.1, saturation=7.0)
    assert film.saturated.tolist() == [False, True]


EDITS, COLUMNS = text_tables(Path(__file__).with_name("refused.txt"))


@pytest.mark.parametrize(
    ("text", "settings", "message"),
    [
        *((unescaped(text), {}, message) for text, message in COLUMNS),
        (HEADS + "100,\n" * 9, {}, r"in line 2, 3, 4, 5, 6, 7, 8, 9 \.\.\.; add it"),
        (HEADS + "100,\n" * 8 + "100,20\n", {}, "in line 2, 3, 4, 5, 6, 7, 8, 9; add it"),
        (HEADS + "1,2\n", {"quantities": ["area"]}, "has no column of area; its columns are force, indentation"),
        (HEADS + "1,2\n", {"load": "half_angle"}, "has no load 'half_angle': it needs a column of force, indentation"),
        (HEADS + "1,2\n", {"load": "indentation", "quantities": ["indentation"]}, "both the measured quantity and the"),
        (HEADS + "100,\n,30\n", {"gaps": Gaps.LEAVE_OUT}, "press.csv has no row without a gap"),
    ],
)
def test_incomplete_columns_are_refused(text, settings, message, tmp_path):
    with pytest.raises(ValueError, match=f"press.csv.*{message}" if "press.csv" not in message else message):
        numbers(tmp_path, text, **settings)


QUESTION = """
model = "tabulated"
joint = "hess-forsbach"

[free]
clearance = "0.02..0.3 mm"
liner.young = "0.4..2 GPa"

[machine.frame]
compliance = "0..20 um/kN"
offset = "2 um"

[[data]]
file = "press.csv"
uncertainty = "0.1 um"
machine = "frame"

[[data]]
quantity = "area"
values = [{areas}]
force = ["1 kN", "3 kN"]
uncertainty = "1 %"
"""
PERCENT, FRAME, AREA = 'uncertainty = "1 %"', 'machine = "frame"', 'quantity = "area"'


@pytest.fixture
def question(tmp_path):
    """Function that writes the question, with some texts replaced, and reads it."""
    csv(tmp_path, rows("force_N,indentation_um", FORCE, 1e3 * READ))
    areas = ", ".join(f'"{area:.4f} mm2"' for area in CONTACT.area[[2, 4]])

    def read(*changes, before="", after=""):
        text = QUESTION.replace("{areas}", areas)
        for old, new in changes:
            assert old in text
            text = text.replace(old, new, 1)
        return read_identify(csv(tmp_path, before + text + after, "data.toml"))

    return read


@pytest.mark.parametrize("name", ["liner.young", "liner_young"])
def test_a_file_is_identified(question, name):
    given = question(("liner.young", name))
    assert [data.quantity for data in given.data] == ["indentation", "area"]
    assert given.free == {"clearance": (0.02, 0.3), "liner_young": (400.0, 2000.0)}
    assert not any(data.load_uncertainty.any() for data in given.data)
    assert given.identify_unknowns().point == pytest.approx(TRUTH, rel=2e-3)


def test_a_drift_is_read_with_the_order_of_readings_and_a_stiffness_as_the_frequency_of_a_mass(question):
    values = ", ".join(f'"{1e3 * value:.6f} um"' for value in READ + 3e-4 * np.arange(4.0, -1.0, -1.0))
    inline = f'quantity = "indentation"\nvalues = [{values}]\nforce = {FORCE.tolist()}\norder = [4, 3, 2, 1, 0]'
    given = question(('offset = "2 um"', 'offset = "2 um"\ndrift = "-1..1 um"'), ('file = "press.csv"', inline))
    assert given.data[0].machine.drift == pytest.approx((-1e-3, 1e-3))
    assert given.identify_unknowns().point["frame.drift"] == pytest.approx(3e-4, rel=0.05)
    frequency = (1e3 * CONTACT.stiffness[4] / 2.0) ** 0.5 / (2 * np.pi)
    swing = f'quantity = "frequency"\nvalues = "{frequency} Hz"\nmass = "2 kg"\nforce = "3 kN"\nuncertainty = "0.1 %"\n'
    given = question(after=f"\n[[data]]\n{swing}")
    assert given.data[2].observable.described.unit == "Hz"
    assert given.identify_unknowns().point == pytest.approx(TRUTH, rel=2e-3)


def test_a_file_states_scatter_priors_and_options(question):
    changes = (
        ('model = "tabulated"', ""),
        ('"0.02..0.3 mm"', '{mean = "0.1 mm", deviation = "10 um"}'),
        (PERCENT, PERCENT + '\nload_uncertainty = "5 N"\nsaturation = 900\nname = "film"'),
    )
    plain, heavy = question(*changes), question(*changes, before='scatter = "heavy-tailed"\n')
    assert (plain.scatter, heavy.scatter) == (NormalScatter(), HeavyTailed())
    assert heavy.model.name == "tabulated"
    assert heavy.free["clearance"] == Normal(mean=0.1, deviation=0.01)
    depth, area = heavy.data
    assert (area.name, area.saturation, area.load_uncertainty.tolist()) == ("film", 900.0, [5.0, 5.0])
    assert depth.load_uncertainty.tolist() == [0.0] * 5
    assert (depth.machine.name, depth.machine.offset, area.machine.name) == ("frame", 0.002, "")
    assert depth.machine.compliance == pytest.approx((0.0, 2e-5))
    np.testing.assert_allclose(area.uncertainty, 0.01 * area.values)


def test_a_file_chooses_columns_load_and_gaps(question, tmp_path):
    csv(tmp_path, "force_N,indentation_um,area_mm2\n100,20,200\n200,,300\n300,30,400\n")
    options = 'uncertainty = "1 mm^2"\nload = "indentation"\ngaps = "leave-out"\nquantities = "area"\n'
    data = question((FRAME, ""), ('uncertainty = "0.1 um"', options)).data[0]
    assert (data.quantity, data.load, data.values.tolist()) == ("area", "indentation", [200.0, 400.0])
    np.testing.assert_allclose(data.loads, [0.02, 0.03])
    assert data.order.tolist() == [0.0, 2.0]


@pytest.mark.parametrize(("old", "new", "message"), EDITS)
def test_wrong_keys_and_units_of_a_file_are_refused(question, old, new, message):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        question((unescaped(old), unescaped(new)))
    assert message in str(refused.value)


@pytest.mark.parametrize("data", ["", "data = 3\n", "data = [3]\n"])
def test_a_file_without_data_is_refused(tmp_path, data):
    path = csv(tmp_path, data + QUESTION.partition("[[data]]")[0], "data.toml")
    with pytest.raises(ValueError, match=r"add \[\[data\]\] before each set|must be an? .*table.*: \[\[data\]\]"):
        read_identify(path)
