"""Tests compile in a hurry."""

import os

os.environ.setdefault("CFLAGS", "-O0")
