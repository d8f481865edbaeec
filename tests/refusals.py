"""Tests of calls and files that are refused: tables of calls, or of edits of a file, and messages."""

import pytest


def refused_calls(*cases, error=ValueError):
    """Return a test that the call of each case raises an error of one line, which has the words of its message."""

    @pytest.mark.parametrize(("call", "message"), cases)
    def test(call, message):
        with pytest.raises(error, match=message) as refused:
            call()
        assert "\n" not in str(refused.value)

    return test


def refused_edits(path):
    """Read tables of text: what an edit replaces in a file, by what, and words of the refusal; `\\n` ends a line."""
    tables = [table.splitlines() for table in path.read_text("utf-8").split("\n\n")]
    return [[tuple(cell.replace("\\n", "\n") for cell in line.split(" => ")) for line in table] for table in tables]


def edited(text, old, new):
    """Replace a part of a text once, or add to its end."""
    if old == "(at the end)":
        return f"{text}\n{new}\n"
    assert old in text
    return text.replace(old, new, 1)
