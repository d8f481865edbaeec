"""Printed text with computed numbers: words must be equal, numbers to one unit of their last digit.

Processors and BLAS kernels round the last bits of a result differently, which can change the last digit shown.
"""

import doctest
import re

_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w]|\.\d)")
_EXACT_DIGITS = 2
"""Digits of an integer that is a count or an input; it must be equal."""


def with_numbers_of(shown: str, printed: str) -> str:
    """Return a printed text in which numbers close to those of the shown text are replaced by them."""
    expected = _NUMBER.findall(shown)
    if len(expected) != len(_NUMBER.findall(printed)):
        return printed
    numbers = iter(expected)
    return _NUMBER.sub(lambda match: _closest(match[0], next(numbers)), printed)


def _closest(printed: str, shown: str) -> str:
    """Return the shown number if the printed one differs by at most one unit of its last digit."""
    mantissa, _, exponent = shown.partition("e")
    decimals = len(mantissa.partition(".")[2])
    if not decimals and not exponent and len(mantissa.lstrip("+-")) <= _EXACT_DIGITS:
        return printed
    unit = 10.0 ** (int(exponent or 0) - decimals)
    return shown if abs(float(printed) - float(shown)) <= 1.01 * unit else printed


class Checker(doctest.OutputChecker):
    """Comparison of examples with their output, numbers to one unit of their last digit."""

    def check_output(self, want: str, got: str, optionflags: int) -> bool:
        """Compare the shown output of an example with the printed one."""
        return super().check_output(want, with_numbers_of(want, got), optionflags)
