"""The report of the paper recomputed: one page that stands alone, and its numbers beside it."""

import csv
import json

import pytest

import ballsocket as bs
from ballsocket.paper import claims, curves
from ballsocket.paper.plan import quick_plan
from ballsocket.reports import accuracy_results, paper_report
from ballsocket.reports.paper_report import write_report

from ..places import DATA

ACCURACY = json.loads((DATA / "accuracy.json").read_text(encoding="utf-8"))
EXACT = bs.Exact(tolerance=1e-4)
FEW = {name: bs.catalogue[name] for name in ("hess-forsbach", "exact")}
JUDGED = {
    "about": ["By the exact solution."],
    "claims": [claims.judge(claim, EXACT).summary() for claim in claims.CLAIMS[:6]],
    "elsewhere": [],
    "table_3": [],
    "accuracy": [ACCURACY],
}


def read_table(path):
    with path.open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def check_page(path, *texts):
    page = path.read_text(encoding="utf-8")
    assert all(text in page for text in ("src='data:image/png;base64,", *texts))
    assert not any(text in page for text in ("<script", "src='http"))


def test_the_report_stands_alone_and_beside_it_lie_its_numbers(tmp_path, monkeypatch):
    monkeypatch.setattr(paper_report, "_write_picture", lambda *words: b"picture")  # drawn in the long form
    check_page(write_report(JUDGED, tmp_path), "does not hold", "holds", "Table 1")
    worst = max(read_table(tmp_path / "accuracy.csv"), key=lambda row: float(row["worst"]))
    assert worst["model"] == "cosine-limit"
    assert json.loads((tmp_path / "accuracy.json").read_text(encoding="utf-8")) == ACCURACY
    assert (tmp_path / "accuracy.md").read_text(encoding="utf-8") == accuracy_results.markdown(ACCURACY)


@pytest.mark.long
def test_the_figures_and_tables_of_the_paper_are_in_the_report(tmp_path):
    pieces = quick_plan().parts
    computed = {
        "elsewhere": [pieces["elsewhere"]["half_angles_of_jin"]()],
        "table_3": [pieces["table_3"]["exact 0.4"]()],
        "figure_3": [curves.figure_3_or_4(3, {name: model}).summary() for name, model in FEW.items()],
        "figure_6": [curves.figure_6("hess-forsbach", bs.HessForsbach(), points=7).summary()],
    }
    check_page(write_report({**JUDGED, **computed}, tmp_path), "Figure 3", "Table 3", "hess-forsbach", "Jin")
    assert {row["model"] for row in read_table(tmp_path / "figure_3.csv")} == set(FEW)
    assert (tmp_path / "figure_6.svg").stat().st_size > 5000
