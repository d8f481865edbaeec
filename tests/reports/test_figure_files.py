"""Figures as files."""

from types import SimpleNamespace

import pytest

from ballsocket.reports.figure_files import save


def test_a_figure_that_cannot_be_drawn_leaves_no_file(tmp_path):
    def fail(*_, **__):
        raise RuntimeError

    with pytest.raises(RuntimeError):
        save(SimpleNamespace(savefig=fail), tmp_path / "a.png")
    assert list(tmp_path.iterdir()) == []
