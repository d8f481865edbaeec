"""Measurements from files: heads with units, uncertainties and gaps."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify import HeavyTailed, Machine, NormalScatter
from ballsocket.identify.columns import Gaps, parse_head, read_measured
from ballsocket.identify.file import read_identify
from ballsocket.studies import Normal

HIP = bs.joints["hess-forsbach"]
FORCE = np.array([250.0, 500.0, 1000.0, 2000.0, 3000.0])
CONTACT = bs.Tabulated().press(HIP, force=FORCE)


def csv(folder, text, name="press.csv"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def rows(heads, *columns):
    lines = [",".join(f"{number:.6g}" for number in row) for row in zip(*columns, strict=True)]
    return "\n".join([heads, *lines]) + "\n"


@pytest.mark.parametrize(
    ("text", "name", "factor"),
    [
        ("force_N", "force", 1.0),
        ("force [kN]", "force", 1000.0),
        ("indentation_um", "indentation", 1e-3),
        ("indentation_uncertainty_um", "indentation_uncertainty", 1e-3),
        ("half_angle_deg", "half_angle", np.pi / 180),
        ("area_cm2", "area", 100.0),
        ("stiffness_kN_per_mm", "stiffness", 1000.0),
        ("liner_poisson", "liner_poisson", 1.0),
    ],
)
def test_heads_are_names_and_units(text, name, factor):
    head = parse_head(text)
    assert (head.name, head.factor) == (name, pytest.approx(factor))


def test_a_file_holds_several_quantities(tmp_path):
    heads = "# made by hand\n# not measured\nforce_kN,indentation_um,area_mm2,area_uncertainty_mm2"
    columns = (FORCE / 1e3, 1e3 * CONTACT.indentation, CONTACT.area, 0.02 * CONTACT.area)
    depth, area = read_measured(csv(tmp_path, rows(heads, *columns)), uncertainty="2 %")
    np.testing.assert_allclose(depth.values, CONTACT.indentation, rtol=1e-5)
    np.testing.assert_allclose(depth.uncertainty, 0.02 * CONTACT.indentation, rtol=1e-5)
    np.testing.assert_allclose(area.force, FORCE)
    assert (depth.quantity, area.quantity, area.name) == ("indentation", "area", "press.csv")
    (force,) = read_measured(tmp_path / "press.csv", quantities=["area"], load="force")
    assert force.quantity == "area"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("force,indentation_um\n1,2\n", "press.csv: column 'force' has no unit: use force_N, or another unit"),
        ("force_N,indentation_N\n1,2\n", "press.csv: the unit of indentation_N = '1 N' is not a length"),
        ("force_N,depth_mm\n1,2\n", "press.csv: column 'depth_mm' is not known: a head is a name and a unit"),
        ("force_N,force_kN\n1,2\n", "press.csv has two columns with the same name"),
        ("force_N\n1\n", "press.csv has no column of a measured quantity besides force"),
        (
            "force_N,indentation_um\n100,2\n200,\nx,4\n",
            "press.csv: no number for force, indentation in row 2, 3; add it, or omit such rows",
        ),
        ("force_N,indentation_um\n", "press.csv has no row"),
        (
            "force_N,indentation_um,indentation_uncertainty_um\n9,2,-1\n",
            r"press.csv: indentation_uncertainty\[0\] = -0.001",
        ),
        (
            "force_N,indentation_um\n0,2\n9,3\n",
            r"press.csv: force\[0\] = 0 is not allowed: at first touch the indentation is 0",
        ),
    ],
)
def test_incomplete_columns_are_refused(text, message, tmp_path):
    with pytest.raises(ValueError, match=message):
        read_measured(csv(tmp_path, text), uncertainty="1 um")


def test_without_an_uncertainty_it_is_estimated_later(tmp_path):
    (press,) = read_measured(csv(tmp_path, "force_N,displacement_um\n100,2\n200,3\n"))
    assert press.has_unknown_noise
    assert (press.quantity, press.name) == ("indentation", "press.csv")
    np.testing.assert_allclose(press.values, [0.002, 0.003])


def test_rows_with_gaps_are_omitted_on_request(tmp_path):
    path = csv(tmp_path, "force_N,indentation_um\n100,2\n200,\n300,4\n")
    (kept,) = read_measured(path, uncertainty="1 um", gaps=Gaps.LEAVE_OUT)
    np.testing.assert_allclose(kept.force, [100.0, 300.0])
    np.testing.assert_allclose(kept.order, [0.0, 2.0])


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


@pytest.fixture
def question(tmp_path):
    read = CONTACT.indentation + 5e-6 * FORCE + 0.002
    csv(tmp_path, rows("force_N,indentation_um", FORCE, 1e3 * read))
    areas = ", ".join(f'"{area:.4f} mm2"' for area in CONTACT.area[[2, 4]])
    return csv(tmp_path, QUESTION.replace("{areas}", areas), "data.toml")


def test_a_file_is_identified(question):
    given = read_identify(question)
    assert [each.quantity for each in given.data] == ["indentation", "area"]
    assert given.free == {"clearance": (0.02, 0.3), "liner_young": (400.0, 2000.0)}
    truth = {"clearance": HIP.clearance, "liner_young": HIP.liner.young, "frame.compliance": 5e-6}
    assert given.identify_unknowns().point == pytest.approx(truth, rel=2e-3)


def test_the_drift_of_a_machine_is_read_with_the_order_of_the_readings(question):
    text = question.read_text("utf-8").replace('offset = "2 um"', 'offset = "2 um"\ndrift = "-1..1 um"')
    read = CONTACT.indentation + 5e-6 * FORCE + 0.002 + 3e-4 * np.arange(4.0, -1.0, -1.0)
    values = ", ".join(f'"{1e3 * value:.6f} um"' for value in read)
    force = ", ".join(f'"{each} N"' for each in FORCE)
    inline = f'quantity = "indentation"\nvalues = [{values}]\nforce = [{force}]\norder = [4, 3, 2, 1, 0]'
    question.write_text(text.replace('file = "press.csv"', inline), "utf-8")
    given = read_identify(question)
    assert given.data[0].machine.drift == pytest.approx((-1e-3, 1e-3))
    assert given.identify_unknowns().point["frame.drift"] == pytest.approx(3e-4, rel=0.05)


SWING = """
[[data]]
quantity = "frequency"
values = "{frequency} Hz"
mass = "2 kg"
force = "3 kN"
uncertainty = "0.1 %"
"""


def test_the_frequency_of_a_mass_measures_the_stiffness(question):
    frequency = (1e3 * CONTACT.stiffness[4] / 2.0) ** 0.5 / (2 * np.pi)
    question.write_text(question.read_text("utf-8") + SWING.format(frequency=frequency), "utf-8")
    given = read_identify(question)
    assert given.data[2].observable.described.unit == "Hz"
    truth = {"clearance": HIP.clearance, "liner_young": HIP.liner.young, "frame.compliance": 5e-6}
    assert given.identify_unknowns().point == pytest.approx(truth, rel=2e-3)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("clearance =", "clearence =", "data.toml: 'clearence' in [free] is not known; did you mean 'clearance'?"),
        ('"0.02..0.3 mm"', "0.1", "data.toml: clearance = 0.1 must be two ends, such as '0.02..0.3 mm'"),
        ('machine = "frame"', 'machine = "fram"', "data.toml: machine 'fram' is not known; did you mean 'frame'?"),
        ('uncertainty = "1 %"', 'uncertainty = "-1 %"', "data.toml: area_uncertainty[0] = "),
        (
            'compliance = "0..20 um/kN"',
            'compliance = "1 um"',
            "data.toml: machine.frame.compliance = '1 um' is not a compliance",
        ),
        ('quantity = "area"', "", "data.toml: [[data]] with values needs its quantity"),
        (
            'uncertainty = "1 %"',
            'uncertainty = "1 %"\nmass = "2 kg"',
            "mass belongs to [[data]] of a frequency, not of area",
        ),
        ('file = "press.csv"', "", "data.toml: [[data]] needs either a file, or a quantity with its values"),
        (
            'model = "tabulated"',
            'scatter = "cauchy"',
            "data.toml: scatter = 'cauchy' is not known; known: normal, heavy-tailed",
        ),
    ],
)
def test_wrong_names_and_units_in_a_file_are_refused(question, old, new, message):
    text = question.read_text("utf-8")
    assert old in text
    question.write_text(text.replace(old, new, 1), "utf-8")
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        read_identify(question)
    assert message in str(refused.value)


def numbers(folder, text, **settings):
    return read_measured(csv(folder, text), **{"uncertainty": "1 um", **settings})


def test_the_first_load_of_force_indentation_and_half_angle_is_the_default(tmp_path):
    text = "indentation_um,half_angle_deg,area_mm2\n20,30,200\n30,35,300\n"
    half_angle, area = numbers(tmp_path, text, uncertainty=0.01)
    assert (half_angle.load, area.load) == ("indentation", "indentation")
    np.testing.assert_allclose(half_angle.values, np.radians([30.0, 35.0]))
    depth, area = numbers(tmp_path, text, load="half_angle", uncertainty=0.01)
    assert (depth.quantity, depth.load) == ("indentation", "half_angle")
    (free_play,) = numbers(tmp_path, "diametral_clearance_um\n200\n210\n")
    assert (free_play.load, free_play.values.tolist()) == ("", pytest.approx([0.2, 0.21]))


def test_uncertainties_have_columns_or_one_text(tmp_path):
    text = "force_N,force_uncertainty_N,indentation_um,indentation_uncertainty_um\n100,2,20,0.5\n200,3,30,0.7\n"
    (depth,) = read_measured(csv(tmp_path, text))
    np.testing.assert_allclose(depth.uncertainty, [5e-4, 7e-4])
    np.testing.assert_allclose(depth.load_uncertainty, [2.0, 3.0])
    plain = "force_N,indentation_um\n100,20\n200,30\n"
    for stated, expected in (("2 %", [4e-4, 6e-4]), ("1 um", [1e-3, 1e-3]), (2e-3, [2e-3, 2e-3])):
        (depth,) = numbers(tmp_path, plain, uncertainty=stated, load_uncertainty=4.0)
        np.testing.assert_allclose(depth.uncertainty, expected)
        assert depth.load_uncertainty.tolist() == [4.0, 4.0]
    assert numbers(tmp_path, plain)[0].load_uncertainty.tolist() == [0.0, 0.0]


def test_angles_belong_to_pressures_and_a_machine_to_indentations(tmp_path):
    machine = Machine(offset=0.01)
    text = "force_N,angle_deg,pressure_MPa,indentation_um,area_mm2\n900,0,5,20,100\n900,10,4,20,100\n"
    pressure, depth, area = numbers(tmp_path, text, uncertainty=0.1, machine=machine)
    np.testing.assert_allclose(pressure.angle, np.radians([0.0, 10.0]))
    assert depth.angle is area.angle is None
    assert depth.machine is machine
    assert not area.machine.name
    assert not pressure.machine.name
    assert [data.saturation for data in (depth, area)] == [np.inf, np.inf]


def test_a_saturation_makes_lower_bounds(tmp_path):
    (film,) = numbers(tmp_path, "force_N,max_pressure_MPa\n900,5\n1800,7\n", uncertainty=0.1, saturation=7.0)
    assert film.saturated.tolist() == [False, True]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"quantities": ["area"]}, "press.csv has no column of area; its columns are force, indentation"),
        ({"load": "half_angle"}, "press.csv has no load 'half_angle': it needs a column of force, indentation"),
        ({"load": "indentation", "quantities": ["indentation"]}, "both the measured quantity and the load"),
        ({"gaps": Gaps.LEAVE_OUT}, "press.csv has no row without a gap"),
    ],
)
def test_columns_that_are_missing_are_named(tmp_path, settings, message):
    with pytest.raises(ValueError, match=message):
        numbers(tmp_path, "force_N,indentation_um\n100,\n,30\n" if "gaps" in settings else ONE_ROW, **settings)


ONE_ROW = "force_N,indentation_um\n100,20\n"


def test_a_message_names_at_most_eight_rows_with_gaps(tmp_path):
    text = "force_N,indentation_um\n" + "100,\n" * 9
    with pytest.raises(ValueError, match=r"in row 1, 2, 3, 4, 5, 6, 7, 8 \.\.\.; add it"):
        numbers(tmp_path, text)
    with pytest.raises(ValueError, match="in row 1, 2, 3, 4, 5, 6, 7, 8; add it"):
        numbers(tmp_path, text.removesuffix("100,\n") + "100,20\n")


@pytest.mark.parametrize("text", ["force)", "force [kN", "(force", "liner_poisson_mm"])
def test_heads_with_half_a_bracket_or_a_wrong_unit_are_refused(text):
    with pytest.raises(ValueError, match=r"column|unit of|liner_poisson"):
        parse_head(text)


def test_heads_may_have_units_in_either_bracket():
    assert parse_head("area (mm2)").name == "area"
    assert parse_head("max pressure [MPa]").name == "max_pressure"
    assert parse_head(" max_pressure_uncertainty [kPa] ").factor == pytest.approx(1e-3)
    assert parse_head("liner_young_GPa").factor == pytest.approx(1e3)


def test_a_file_states_scatter_priors_and_options(question):
    text = question.read_text("utf-8").replace('model = "tabulated"', "")
    text = text.replace('"0.02..0.3 mm"', '{mean = "0.1 mm", deviation = "10 um"}')
    options = 'uncertainty = "1 %"\nload_uncertainty = "5 N"\nsaturation = 900\nname = "film"'
    text = text.replace('uncertainty = "1 %"', options)
    question.write_text(text, "utf-8")
    plain = read_identify(question)
    question.write_text('scatter = "heavy-tailed"\n' + text, "utf-8")
    heavy = read_identify(question)
    assert (plain.scatter, heavy.scatter) == (NormalScatter(), HeavyTailed())
    assert heavy.model.name == "tabulated"
    assert heavy.free["clearance"] == Normal(mean=0.1, deviation=0.01)
    depth, area = heavy.data
    assert (area.name, area.saturation, area.load_uncertainty.tolist()) == ("film", 900.0, [5.0, 5.0])
    assert depth.load_uncertainty.tolist() == [0.0] * 5
    assert depth.machine == Machine(compliance=(0.0, depth.machine.compliance[1]), offset=0.002, name="frame")
    assert depth.machine.compliance[1] == pytest.approx(2e-5)
    assert not area.machine.name
    np.testing.assert_allclose(area.uncertainty, 0.01 * area.values)


def test_loads_without_a_stated_uncertainty_are_exact(question):
    assert "load_uncertainty" not in question.read_text("utf-8")
    for data in read_identify(question).data:
        assert not data.load_uncertainty.any()


def test_a_file_chooses_columns_load_and_gaps(question):
    csv(question.parent, "force_N,indentation_um,area_mm2\n100,20,200\n200,,300\n300,30,400\n")
    text = question.read_text("utf-8").replace('machine = "frame"', 'gaps = "leave-out"\nquantities = "area"', 1)
    question.write_text(text.replace('uncertainty = "0.1 um"', 'uncertainty = "1 mm^2"\nload = "indentation"'), "utf-8")
    data = read_identify(question).data[0]
    assert (data.quantity, data.load, data.values.tolist()) == ("area", "indentation", [200.0, 400.0])
    np.testing.assert_allclose(data.loads, [0.02, 0.03])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[free]", "[fre]", "'fre' at the top is not known; did you mean 'free'?"),
        ("[machine.frame]", "[machine]\nframe2 = 3\n[machine.frame]", "machine.frame2 = 3 must be a table"),
        ("compliance =", "complianc =", "'complianc' in [machine.frame] is not known; did you mean 'compliance'?"),
        ('machine = "frame"', "values = 3", "[[data]] needs either a file, or a quantity with its values"),
        ('machine = "frame"', 'force = "3 kN"', "'force' in [[data]] with a file is not known"),
        ('quantity = "area"', 'quantity = "area"\ngaps = "refuse"', "'gaps' in [[data]] with values is not known"),
        (
            'uncertainty = "0.1 um"',
            'uncertainty = "0.1 um"\ngaps = "skip"',
            "gaps = 'skip' is not known; known: refuse, leave-out",
        ),
        ('"0.02..0.3 mm"', '"0.02 mm"', "clearance = '0.02 mm' is not a range"),
    ],
)
def test_keys_that_contradict_the_format_are_named(question, old, new, message):
    text = question.read_text("utf-8")
    assert old in text
    question.write_text(text.replace(old, new, 1), "utf-8")
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        read_identify(question)
    assert message in str(refused.value)


def test_a_file_without_data_is_refused(question):
    text = question.read_text("utf-8").partition("[[data]]")[0]
    for data in ("", "data = 3\n", "data = [3]\n"):
        question.write_text(data + text, "utf-8")
        with pytest.raises(ValueError, match=r"add \[\[data\]\] before each set|must be an? .*table.*: \[\[data\]\]"):
            read_identify(question)


def test_the_modulus_of_a_material_may_be_a_table_or_a_name(question):
    text = question.read_text("utf-8")
    question.write_text(text.replace("liner.young", "liner_young"), "utf-8")
    assert read_identify(question).free["liner_young"] == (400.0, 2000.0)
