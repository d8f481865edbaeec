"""Files written for version 1.0: read with the same numbers; those that it refused are still refused.

The files were drawn at random from the inputs of each kind; `read_files.py` wrote what version 1.0 makes of them.
"""

import json
import re

import pytest

from ..extent import some
from ..fuzz.limits import check_sentence
from ..places import DATA
from .read_files import outcome

CASES = json.loads((DATA / "files_of_1_0.json").read_text("utf-8"))
READ = [case for case in CASES if "refusal" not in case]
REFUSED = [case for case in CASES if "refusal" in case]
NOW_ALLOWED = "how uncertain is indentation\\?|with values needs its uncertainty"
"""Refusals of version 1.0 that a later version withdrew: it estimates an uncertainty that is not stated."""

KINDS = sorted({case["kind"] for case in CASES})


def of_kind(cases, kind):
    """Select the files of one kind."""
    return [case for case in cases if case["kind"] == kind]


@pytest.mark.parametrize("kind", KINDS)
def test_files_of_1_0_are_read_with_the_same_numbers(kind):
    assert len(of_kind(READ, kind)) == 40
    for case in of_kind(READ, kind):
        assert json.loads(json.dumps(outcome(kind, case["text"]).get("result"))) == case["result"], case["text"]


@pytest.mark.parametrize("kind", KINDS)
def test_files_that_1_0_refused_are_refused_in_one_sentence(kind):
    for case in some(of_kind(REFUSED, kind), 30):
        if re.search(NOW_ALLOWED, case["refusal"]):
            continue
        refusal = outcome(kind, case["text"]).get("refusal", "")
        assert refusal.startswith(("file.toml", "[Errno 2]")), case["text"]
        check_sentence(refusal)
