"""Tests of calls and files that are refused, and tables of text: calls, edits of a file, files, and messages."""

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


def unescaped(cell):
    """Return a cell with its ends of lines and tabs."""
    return cell.replace("\\n", "\n").replace("\\t", "\t").replace("\\r", "\r")


def edited(text, old, new):
    """Replace a part of a text once, or add to its end."""
    old, new = unescaped(old), unescaped(new)
    if old == "(at the end)":
        return f"{text}\n{new}\n"
    assert old in text
    return text.replace(old, new, 1)
