"""CalculiX, an independent solver: tests skip without it, or fail where the environment needs it."""

import os
import shutil

import pytest

NEEDED = os.environ.get("BALLSOCKET_CCX") == "needed"
needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None and not NEEDED, reason="no ccx")
