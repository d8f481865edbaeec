"""Environment of the tests and of the commands that they start; read before numpy, which looks at it once."""

import os
import sys
from tempfile import TemporaryDirectory

from .places import ROOT

workplace = None if "BALLSOCKET_CACHE" in os.environ else TemporaryDirectory(prefix="ballsocket-tests-")
"""Folder of all caches of a run; workers inherit it from the process that starts them."""

if workplace is not None:
    os.environ["BALLSOCKET_CACHE"] = os.path.join(workplace.name, "cache")
    os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", os.path.join(workplace.name, "jax"))
    os.environ.setdefault("DASK_TEMPORARY_DIRECTORY", workplace.name)
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0.1")
os.environ.setdefault("XLA_FLAGS", "--xla_backend_optimization_level=0")  # JAX compiles longer than it computes here
os.environ["COLUMNS"] = "80"  # tables break their lines in a narrower terminal
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the cores are busy with other tests
if str(ROOT / "src") in sys.path:  # commands use the checkout too
    os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [str(ROOT / "src"), os.environ.get("PYTHONPATH")]))
