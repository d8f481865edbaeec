"""Fixtures that several test files of hips share."""

import pytest

from ballsocket.hip.hip_setup import HipSetup

from ..cli.command import answer
from .hips import SHORT, UNCERTAINTY, write_edited_file


@pytest.fixture
def short_film(monkeypatch):
    """Compute films over 2 cycles instead of 300, where a test reads other results."""
    film = HipSetup.film
    monkeypatch.setattr(HipSetup, "film", lambda use, *words, **names: film(use, *words, **{"cycles": 2} | names))


@pytest.fixture(scope="session")
def solved_file(tmp_path_factory):
    """Return a folder with a solved hip file, and its JSON; the folder has a report, a table and a store too."""
    folder = tmp_path_factory.mktemp("hip")
    file = write_edited_file(folder, *SHORT)
    tables = f'{UNCERTAINTY}count = 2\n[report]\ncustomer = "Acme <Ortho>"\nlogo = "logo.svg"\n'
    file.write_text(f"{file.read_text(encoding='utf-8')}\n{tables}", encoding="utf-8")
    (folder / "logo.svg").write_text("<svg/>", encoding="utf-8")
    files = ("--report", str(folder / "hip.html"), "--csv", str(folder / "hip.csv"), "--store", str(folder / "store"))
    return folder, answer("hip", str(file), *files)
