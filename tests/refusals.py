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


def text_tables(path):
    """Read tables of text, with an empty line between two; cells stand between arrows, the refusal in the last."""
    tables = path.read_text("utf-8").rstrip("\n").split("\n\n")
    return [[line.split(" => ") for line in table.splitlines()] for table in tables]


def edited(text, old, new):
    """Replace a part of a text once, or add to its end; `\\n` ends a line."""
    old, new = (part.replace("\\n", "\n") for part in (old, new))
    if old == "(at the end)":
        return f"{text}\n{new}\n"
    assert old in text
    return text.replace(old, new, 1)
