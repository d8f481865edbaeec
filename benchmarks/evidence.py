"""A pack of evidence for 3 x 3 x 3 x 3 cases, with and without finite elements, and one whose pieces are kept."""

from __future__ import annotations

import tempfile
from pathlib import Path
from time import perf_counter

from ballsocket.core.executors.processes import Processes
from ballsocket.evidence.pack import gather_evidence
from ballsocket.evidence.question import read_question

from .report import Report, Rows

ASKED = """
question = "Which head, which clearance?"
context_of_use = "A benchmark."
joint = "hip-36"
finite_elements = {elements}
[risk]
influence = "medium"
consequence = "medium"
[required]
accuracy = "10 %"
limits = ["max_pressure <= 25 MPa"]
[matrix]
head_diameter = [28, 32, 36]
clearance = [0.05, 0.1, 0.2]
force = [2000, 3000, 4000]
inclination = [35, 45, 55]
[tolerances]
clearance = "0.1 +- 0.05 mm"
liner_young = "750 +- 75 MPa"
[friction]
coefficient = 0.06
"""


def measure() -> Report:
    rows = Rows("81 cases off the axis, all cores", ("pack", "s"))
    with tempfile.TemporaryDirectory() as folder:
        for name, elements in {"without finite elements": "false", "with finite elements": "true"}.items():
            path = Path(folder) / f"{elements}.toml"
            path.write_text(ASKED.format(elements=elements), encoding="utf-8")
            question = read_question(path)
            for state in ("", ", all kept"):
                start = perf_counter()
                gather_evidence(question, Path(folder), engine=Processes())
                rows.add(f"{name}{state}", f"{perf_counter() - start:.3g}")
    return Report([rows], ["The aims are 30 s and 180 s. One run each; processes are started anew."])
