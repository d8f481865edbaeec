"""Tables as machines and offices write them: every form of the same three readings has the same numbers."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

from ballsocket.files import columns
from ballsocket.files.columns import HeadChoice, read_columns
from ballsocket.files.tables import read_table
from ballsocket.hip.cycle_file import cycle_of
from ballsocket.hip.schema import CycleTables
from ballsocket.identification.file import read_identify

from ..cli.command import run
from ..refusals import text_tables, unescaped

NAMES = ("time", "force", "indentation", "indentation_uncertainty")
TRUTH = {"time": [0.0, 0.25, 0.5], "force": [300.0, 1250.5, 2000.0], "indentation": [0.01, 0.0255, 0.04]}
FACTORS = {"": 1, "s": 1, "ms": 1e-3, "N": 1, "kN": 1e3, "mm": 1, "um": 1e-3, "µm": 1e-3, "cm": 10, "m": 1e3}
(FORMS,) = text_tables(Path(__file__).parent / "forms.txt")
"""Texts of tables, their encoding, and the number of lines that are left out."""


def check_truth(read):
    """Check the numbers of a table."""
    assert {head.name for head in read.heads} >= {"force", "indentation"}
    for head, values in read.items():
        assert FACTORS[head.unit] * values == pytest.approx(TRUTH[head.name], rel=1e-12), head


def write(folder, text, encoding="utf-8", name="press.csv"):
    (folder / name).write_bytes(text.encode(encoding))
    return folder / name


@pytest.mark.parametrize(("text", "encoding", "n_left_out"), FORMS, ids=range(len(FORMS)))
def test_all_forms_have_the_same_numbers_and_count_the_lines_that_are_left_out(text, encoding, n_left_out, tmp_path):
    read = read_columns(write(tmp_path, unescaped(text), encoding), NAMES)
    check_truth(read)
    assert sum(read.left_out.values()) == int(n_left_out)
    assert bool(read.remark()) == (n_left_out != "0")


TWO = "force_N;indentation_mm\n"
CHOSEN = [  # text, choice, force in N
    ("K1;T;force_kN\n300;20;1\n", {"columns": {"K1": "force_N"}, "skip": ["T", "force_kN"]}, 300.0),
    ("K1 [kN];T [°C]\n0,3;20\n", {"columns": {"K1": "force"}, "skip": ["T"]}, 300.0),
    ("T;K1\n;kN\nA;0,3\n", {"columns": {"K1": "force"}, "skip": "T"}, 300.0),
    (";force_N\n1;300\n", {"skip": [""]}, 300.0),
]
*_, REFUSED = text_tables(Path(__file__).parent / "refused.txt")
REFUSED += [
    ("", "{}", "it has no line of column heads above lines of numbers"),
    ("force_N\n" + "1\n" * 5_000_000, "{}", "a table has at most 10 MB: cut it, or save it as Parquet"),
    ("\xd0\xcf\x11\xe0", "{}", "an old Excel file .*: save it as .xlsx or CSV"),
    ("PK\x03\x04", "{}", "it is not a readable .xlsx file"),
]


@pytest.mark.parametrize(("text", "choice", "force"), CHOSEN)
def test_columns_are_renamed_and_skipped(text, choice, force, tmp_path):
    ((head, values),) = read_columns(write(tmp_path, text), NAMES, HeadChoice(**choice)).items()
    assert FACTORS[head.unit] * values == pytest.approx([force])


@pytest.mark.parametrize(("text", "choice", "message"), REFUSED, ids=range(len(REFUSED)))
def test_a_table_with_two_meanings_is_refused_with_the_way_to_write_it(text, choice, message, tmp_path):
    with pytest.raises(ValueError, match=f"press.csv: .*{message}"):
        read_columns(write(tmp_path, unescaped(text), "latin-1"), NAMES, HeadChoice(**json.loads(choice)))


def test_a_gap_has_its_line(tmp_path):
    read = read_columns(write(tmp_path, TWO + "1;2\n# no\nn/a;2,5\n"), NAMES)
    assert np.isnan(read.columns[0]).tolist() == [False, True]
    with pytest.raises(ValueError, match="line 4 has 'n/a' for force"):
        read.numbers("force")


def test_an_excel_file_is_read_from_the_sheet_with_the_columns(tmp_path, monkeypatch):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.active.append(["Prüfer", "Mayer"])
    sheet = book.create_sheet("curve")
    for row in (["Zeit", "Kraft", "Weg"], ["s", "N", "mm"], *zip(*TRUTH.values(), strict=True), [], ["Ende"]):
        sheet.append(row)
    book.save(tmp_path / "press.xlsx")
    read = read_columns(tmp_path / "press.xlsx", NAMES)
    check_truth(read)
    assert read.remark() == "press.xlsx: 3 rows read, left out 1 line of text"
    book.create_sheet("mean of 5").append([1250])
    book.save(tmp_path / "press.xlsx")
    remark = "press.xlsx, sheet 'curve': 3 rows read, left out 1 line of text, 1 line in other sheets"
    assert read_columns(tmp_path / "press.xlsx", NAMES).remark() == remark
    book.copy_worksheet(sheet).title = "second"
    book.save(tmp_path / "press.xlsx")
    with pytest.raises(ValueError, match="the sheets 'curve' and 'second' have such columns: keep one of them"):
        read_columns(tmp_path / "press.xlsx", NAMES)
    del book["second"]
    sheet["B3"].number_format = "0.0%"
    book.save(tmp_path / "press.xlsx")
    with pytest.raises(ValueError, match="line 3 has '30000 %' for force"):
        read_columns(tmp_path / "press.xlsx", NAMES).numbers("force")
    monkeypatch.setattr(columns, "_MAX_BYTES", 100)
    with pytest.raises(ValueError, match="at most 0 MB"):
        read_columns(tmp_path / "press.xlsx", NAMES)


def test_all_files_that_name_a_table_have_the_keys_columns_and_skip(tmp_path):
    """The first line of a result counts the lines that are left out."""
    keys = 'columns = {Schritt = "%s"}\nskip = "T"\n'
    rows = ["0;300;20", "0,5;900;20", "1;1,5e3;20", "1,5;900;20", "2;300;20"]
    write(tmp_path, "\n".join(["Test 1", "Schritt;Last;T", "s;N;°C", *rows]), "cp1252", "walk.csv")
    content = tomllib.loads('[cycle]\nfile = "walk.csv"\ninstants = 8\n' + keys % "time")
    cycle = cycle_of(read_table(content, CycleTables), tmp_path)
    assert (cycle.duration, cycle.largest_force) == (2.0, 1500.0)
    assert cycle.remark == "walk.csv: 5 rows read, left out 1 line above the heads"
    write(tmp_path, "\n".join(["Test 1", "Last;Schritt;T", "N;um;°C", "300;10;1", "1250,5;;1", "2000;40;1"]), "utf-16")
    data = 'joint = "hip-28"\n[free]\nliner.young = "0.4..2 GPa"\n[[data]]\nfile = "press.csv"\ngaps = "leave-out"\n'
    (measured,) = read_identify(write(tmp_path, data + keys % "indentation", name="data.toml")).data
    assert (measured.force.tolist(), measured.values.tolist()) == ([300.0, 2000.0], pytest.approx([0.01, 0.04]))
    assert measured.remark == "press.csv: 2 rows read, left out 1 line above the heads, 1 line with a gap"
    write(tmp_path, "\n".join(["Test 1", "Last;Schritt;T", "kN;mm;°C", "0,3;0,1;20", "2;0,05;20"]), name="rows.csv")
    study = 'joint = "hip-28"\nmodel = "hertz"\n[table]\npath = "rows.csv"\n' + keys % "clearance"
    first = run("study", str(write(tmp_path, study, name="study.toml"))).stdout.splitlines()[0]
    assert first == "hertz, 2 rows; rows.csv: 2 rows read, left out 1 line above the heads"
    refused = run("study", str(write(tmp_path, study.replace('skip = "T"', ""), name="bad.toml"))).stderr
    assert "column 'T" in refused
    assert "joint file" not in refused  # it is the right command
