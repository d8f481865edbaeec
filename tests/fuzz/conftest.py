"""Fixtures of the tests with made-up input."""

from unittest import mock

import pytest
from typer.main import get_command

from ballsocket.cli import root


@pytest.fixture(scope="module", autouse=True)
def built_once():
    """Build the command line once instead of for each command, which halves the time."""
    root.load_commands()
    with mock.patch.object(root, "app", get_command(root.app)):
        yield
