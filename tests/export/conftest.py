"""Tests compile in a hurry."""

import os

import pytest

os.environ.setdefault("CFLAGS", "-O0")


@pytest.fixture(scope="session")
def fmpy():
    return pytest.importorskip("fmpy", reason="fmpy is not installed")
