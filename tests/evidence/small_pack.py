"""Small question and its pack."""

from functools import reduce

from ballsocket.evidence.folder import write
from ballsocket.evidence.pack import gather_evidence
from ballsocket.evidence.question import read_question
from ballsocket.reports.evidence_page import evidence_page

from ..refusals import edited

CLEARANCE = 'clearance = ["0.05 mm", "0.15 mm"]'
FORCE = 'force = ["2 kN", "4 kN"]'
YOUNG = 'liner_young = "750 +- 75 MPa"'
QUESTION_TEXT = f"""
question = "May it be?"
context_of_use = "A test."
joint = "hip-36"
[risk]
influence = "low"
consequence = "high"
[required]
accuracy = "5 %"
limits = ["max_pressure <= 15 MPa", "edge_distance >= 1 mm"]
[matrix]
{CLEARANCE}
{FORCE}
[tolerances]
{YOUNG}
[friction]
coefficient = 0.06
"""


def question_of(folder, *replacements):
    text = reduce(lambda text, change: edited(text, *change), replacements, QUESTION_TEXT)
    (folder / "asked.toml").write_text(text, encoding="utf-8")
    return read_question(folder / "asked.toml")


def small_pack(folder):
    """Return the question, its record, and the folder with the pack in `out` and its stored results in `data`."""
    question = question_of(folder)
    record = gather_evidence(question, folder / "data")
    write(question, record, evidence_page, folder / "out")
    return question, record, folder
