"""Schedulers and workers of Dask as processes."""

import subprocess
import sys
from contextlib import contextmanager


@contextmanager
def server(words, folder, log):
    """A command of Dask's that runs until it is no longer needed."""
    with subprocess.Popen([sys.executable, "-m", "dask", *words], cwd=folder, stdout=log, stderr=log) as running:
        try:
            yield running
        finally:
            running.terminate()
