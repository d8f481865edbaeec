"""The report of the paper recomputed: one page that stands alone, and its numbers beside it."""

import csv
import json

import pytest

import ballsocket as bs
from ballsocket.paper import claims, curves
from ballsocket.paper.plan import quick_plan
from ballsocket.reports import accuracy_results
from ballsocket.reports.paper_report import write_report

from ..places import DATA

ACCURACY = json.loads((DATA / "accuracy.json").read_text(encoding="utf-8"))
EXACT = bs.Exact(tolerance=1e-4)
FEW = {name: bs.catalogue[name] for name in ("hess-forsbach", "exact")}


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    pieces = quick_plan().parts
    results = {
        "about": ["By the exact solution."],
        "claims": [claims.judge(claim, EXACT).summary() for claim in claims.CLAIMS[:6]],
        "elsewhere": [pieces["elsewhere"]["half_angles_of_jin"]()],
        "table_3": [pieces["table_3"]["exact 0.4"]()],
        "figure_3": [curves.figure_3_or_4(3, {name: model}).summary() for name, model in FEW.items()],
        "figure_6": [curves.figure_6("hess-forsbach", bs.HessForsbach(), points=7).summary()],
        "accuracy": [ACCURACY],
    }
    return write_report(results, folder)


def test_the_report_stands_alone(report):
    page = report.read_text(encoding="utf-8")
    assert "src='data:image/png;base64," in page
    assert "<script" not in page
    assert "src='http" not in page
    for text in ("does not hold", "holds", "Figure 3", "Table 1", "Table 3", "hess-forsbach", "Jin"):
        assert text in page


def test_beside_the_report_lie_its_numbers(report):
    with (report.parent / "figure_3.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert {row["model"] for row in rows} == set(FEW)
    assert (report.parent / "figure_6.svg").stat().st_size > 5000
    with (report.parent / "accuracy.csv").open(encoding="utf-8") as stream:
        worst = max(csv.DictReader(stream), key=lambda row: float(row["worst"]))
    assert worst["model"] == "cosine-limit"
    assert json.loads((report.parent / "accuracy.json").read_text(encoding="utf-8")) == ACCURACY
    assert (report.parent / "accuracy.md").read_text(encoding="utf-8") == accuracy_results.markdown(ACCURACY)
