"""Measurements from files: heads with units, uncertainties, gaps, and the command."""

import numpy as np
import pytest

import ballsocket as bs
from ballsocket.identify.columns import Gaps, head_of, read_measured
from ballsocket.identify.file import read_identify

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
    head = head_of(text)
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
    ("text", "said"),
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
        ("force_N,indentation_um\n0,2\n9,3\n", r"press.csv: force\[0\] = 0 is not allowed: at first touch the indentation is 0"),
    ],
)
def test_files_that_do_not_say_what_they_hold_are_refused(text, said, tmp_path):
    with pytest.raises(ValueError, match=said):
        read_measured(csv(tmp_path, text), uncertainty="1 um")


def test_a_file_needs_an_uncertainty(tmp_path):
    with pytest.raises(ValueError, match="press.csv: the uncertainty of indentation is missing"):
        read_measured(csv(tmp_path, "force_N,indentation_um\n100,2\n"))


def test_gaps_are_left_out_on_request(tmp_path):
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


def test_a_file_is_read_and_answered(question):
    given = read_identify(question)
    assert [each.quantity for each in given.data] == ["indentation", "area"]
    assert given.free == {"clearance": (0.02, 0.3), "liner_young": (400.0, 2000.0)}
    truth = {"clearance": HIP.clearance, "liner_young": HIP.liner.young, "frame.compliance": 5e-6}
    assert given.identified().point == pytest.approx(truth, rel=2e-3)


def test_the_drift_of_a_machine_is_read_with_the_order_of_the_readings(question):
    text = question.read_text("utf-8").replace('offset = "2 um"', 'offset = "2 um"\ndrift = "-1..1 um"')
    read = CONTACT.indentation + 5e-6 * FORCE + 0.002 + 3e-4 * np.arange(4.0, -1.0, -1.0)
    values = ", ".join(f'"{1e3 * value:.6f} um"' for value in read)
    force = ", ".join(f'"{each} N"' for each in FORCE)
    inline = f'quantity = "indentation"\nvalues = [{values}]\nforce = [{force}]\norder = [4, 3, 2, 1, 0]'
    question.write_text(text.replace('file = "press.csv"', inline), "utf-8")
    given = read_identify(question)
    assert given.data[0].machine.drift == pytest.approx((-1e-3, 1e-3))
    assert given.identified().point["frame.drift"] == pytest.approx(3e-4, rel=0.05)


SWING = """
[[data]]
quantity = "frequency"
values = "{frequency} Hz"
mass = "2 kg"
force = "3 kN"
uncertainty = "0.1 %"
"""


def test_a_mass_that_swings_tells_the_stiffness(question):
    frequency = (1e3 * CONTACT.stiffness[4] / 2.0) ** 0.5 / (2 * np.pi)
    question.write_text(question.read_text("utf-8") + SWING.format(frequency=frequency), "utf-8")
    given = read_identify(question)
    assert given.data[2].observable.described.unit == "Hz"
    truth = {"clearance": HIP.clearance, "liner_young": HIP.liner.young, "frame.compliance": 5e-6}
    assert given.identified().point == pytest.approx(truth, rel=2e-3)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("clearance =", "clearence =", "data.toml: 'clearence' in [free] is not known; did you mean 'clearance'?"),
        ('"0.02..0.3 mm"', "0.1", "data.toml: clearance = 0.1 must be two ends, such as '0.02..0.3 mm'"),
        ('machine = "frame"', 'machine = "fram"', "data.toml: machine 'fram' is not known; did you mean 'frame'?"),
        ('uncertainty = "1 %"\n', "", "data.toml: [[data]] with values needs its uncertainty"),
        ('uncertainty = "1 %"', 'uncertainty = "-1 %"', "data.toml: area_uncertainty[0] = "),
        (
            'compliance = "0..20 um/kN"',
            'compliance = "1 um"',
            "data.toml: frame.compliance = '1 um' is not a compliance",
        ),
        ('quantity = "area"', "", "data.toml: [[data]] with values needs its quantity"),
        (
            'uncertainty = "1 %"',
            'uncertainty = "1 %"\nmass = "2 kg"',
            "of a frequency needs its mass",
        ),
        ('file = "press.csv"', "", "data.toml: [[data]] needs either a file, or a quantity with its values"),
        ('model = "tabulated"', 'scatter = "cauchy"', "data.toml: scatter 'cauchy' is not known; known: normal"),
    ],
)
def test_files_about_measurements_are_read_strictly(question, old, new, said):
    text = question.read_text("utf-8")
    assert old in text
    question.write_text(text.replace(old, new, 1), "utf-8")
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        read_identify(question)
    assert said in str(refused.value)
