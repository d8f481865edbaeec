"""Folders of the repository that tests read."""

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DATA = ROOT / "tests" / "data"
EXAMPLES = ROOT / "examples"
CONTRIBUTING = ROOT / "docs" / "contributing"


def symlink_or_skip(link, target):
    """Make a symbolic link, or skip the test where the system or the user may not."""
    try:
        link.symlink_to(target)
    except (OSError, NotImplementedError):
        pytest.skip("symbolic links are not allowed here")
