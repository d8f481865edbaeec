"""Folders of the repository that tests read."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DATA = ROOT / "tests" / "data"
EXAMPLES = ROOT / "examples"
CONTRIBUTING = ROOT / "docs" / "contributing"


def fenced(page, language):
    """List the blocks of a language on a page of Markdown."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)


def symlink_or_skip(link, target):
    """Make a symbolic link, or skip the test where the system or the user may not."""
    try:
        link.symlink_to(target)
    except (OSError, NotImplementedError):
        pytest.skip("symbolic links are not allowed here")
