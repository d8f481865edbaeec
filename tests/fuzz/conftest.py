"""Fixtures of the tests with made-up input."""

import shutil
from contextlib import contextmanager
from itertools import count
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


@pytest.fixture
def fresh(tmp_path):
    """Return a factory of folders, each removed after its use."""
    number = count()

    @contextmanager
    def folder():
        path = tmp_path / str(next(number))
        path.mkdir()
        try:
            yield path
        finally:
            shutil.rmtree(path)

    return folder
