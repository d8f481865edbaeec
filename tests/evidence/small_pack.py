"""Small question and its pack, computed once for all tests of one process."""

import json
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from ballsocket.evidence.folder import write
from ballsocket.evidence.pack import gather_evidence
from ballsocket.evidence.question import read_question
from ballsocket.reports.evidence_page import evidence_page

QUESTION_TEXT = """
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
clearance = ["0.05 mm", "0.15 mm"]
force = ["2 kN", "4 kN"]

[tolerances]
liner_young = "750 +- 75 MPa"

[friction]
coefficient = 0.06
"""


def question_text(*replacements):
    """Return the text of the question with parts of it replaced."""
    text = QUESTION_TEXT
    for old, new in replacements:
        assert old in text, old
        text = text.replace(old, new)
    return text


def question_of(folder, *replacements):
    """Write the question with parts of it replaced, and read it."""
    (folder / "asked.toml").write_text(question_text(*replacements), encoding="utf-8")
    return read_question(folder / "asked.toml")


@cache
def small_pack():
    """Return the question, its record, and a folder with the pack in `out` and its stored results in `data`."""
    folder = Path(mkdtemp(prefix="ballsocket-test-"))
    question = question_of(folder)
    record = gather_evidence(question, folder / "data")
    write(question, record, page, folder / "out")
    return question, record, folder


def page(record, digest):
    """Return the page, drawn once for each record and digest."""
    return _page(json.dumps(record), digest)


@cache
def _page(record, digest):
    return evidence_page(json.loads(record), digest)
