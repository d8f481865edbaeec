"""Tests of calls that are refused: one table of calls and messages each."""

import pytest


def refused_calls(*cases, error=ValueError):
    """Return a test that the call of each case raises an error of one line, which has the words of its message."""

    @pytest.mark.parametrize(("call", "message"), cases)
    def test(call, message):
        with pytest.raises(error, match=message) as refused:
            call()
        assert "\n" not in str(refused.value)

    return test
