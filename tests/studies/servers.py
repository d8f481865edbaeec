"""A scheduler and workers of Dask as processes."""

import json
import subprocess
import sys
from contextlib import ExitStack, contextmanager

from ..processes import wait_until


@contextmanager
def cluster(folder, n_workers, log):
    """Start `dask scheduler` and several of `dask worker`; yield the processes and the address."""
    file, mark = folder / "scheduler.json", ("--no-dashboard", "--host", "127.0.0.1", "--scheduler-file")
    commands = [("scheduler", *mark, file, "--port", "0")]
    commands += [("worker", *mark, file, "--no-nanny", "--nthreads", "1")] * n_workers
    with ExitStack() as stack:
        processes = []
        for words in commands:
            command = [sys.executable, "-m", "dask", *map(str, words)]
            process = stack.enter_context(subprocess.Popen(command, cwd=folder, stdout=log, stderr=log))
            stack.callback(process.terminate)
            processes.append(process)
        wait_until(lambda: processes[0].poll() is not None or (file.exists() and file.read_text("utf-8")))
        yield processes, json.loads(file.read_text("utf-8"))["address"]
