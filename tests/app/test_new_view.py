"""A new view of the explorer, as docs/contributing describes it, in a copy of the package."""

import pytest

from ..extended_package import extend_package, page_code, run_python

LAST = '    "evidence": "evidence.Evidence",\n'
OPENED = """
from ballsocket.app.server import page_files
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
def test_a_new_view_is_a_file_and_a_line(tmp_path):
    code = page_code("view")[0]
    assert code.count("\n") <= 31
    files = {"app/views/volume.py": code}
    extend_package(tmp_path, files, {"app/views/registry.py": {LAST: f'{LAST}    "volume": "volume.Volume",\n'}})
    done = run_python(tmp_path, "-c", OPENED)
    assert done.returncode == 0, done.stderr
