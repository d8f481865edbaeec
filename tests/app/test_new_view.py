"""A new view of the explorer, as docs/contributing describes it, in a copy of the package."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import ballsocket as bs

from ..places import CONTRIBUTING

LAST = '    "evidence": "evidence.Evidence",\n'
OPENED = """
from ballsocket.app.page import page_files
from ballsocket.app.session import Page
from ballsocket.app.view import make_file
page = Page("view=volume&preset=hip-28&load.force=3000")
assert page.screen.view == "volume"
assert "volume of the liner" in page.channel.shown_value("#volume-numbers")
assert 'data-view="volume">Volume</button>' in page_files()["page.html"][1]
assert make_file(page.seen(), "CSV")[1].startswith(b"volume_mm3\\n8722.42")
assert b"Volume: hip-28" in make_file(page.seen(), "HTML")[1]
"""


@pytest.mark.long
def test_a_new_view_is_a_folder_and_a_line(tmp_path):
    copy = tmp_path / "ballsocket"
    shutil.copytree(Path(bs.__file__).parent, copy, ignore=shutil.ignore_patterns("__pycache__"))
    text = (CONTRIBUTING / "view.md").read_text("utf-8")
    code = re.search(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)[1]
    assert code.count("\n") <= 31
    views = copy / "app" / "views"
    (views / "volume").mkdir()
    (views / "volume" / "__init__.py").touch()
    (views / "volume" / "view.py").write_text(code, "utf-8")
    lines = (views / "registry.py").read_text("utf-8")
    assert LAST in lines
    (views / "registry.py").write_text(lines.replace(LAST, f'{LAST}    "volume": "volume.Volume",\n'), "utf-8")
    env = {**os.environ, "PYTHONPATH": str(tmp_path), "PYTHONIOENCODING": "utf-8"}
    subprocess.run([sys.executable, "-c", OPENED], cwd=tmp_path, env=env, check=True)
