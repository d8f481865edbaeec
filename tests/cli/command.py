"""The command `ballsocket` for tests: called here, or as a process of its own where that is what is tested."""

import os
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import BytesIO, TextIOWrapper
from pathlib import Path
from subprocess import CompletedProcess
from subprocess import run as started
from unittest import mock

from ballsocket.cli import main


def environment(columns: int, encoding: str) -> dict[str, str]:
    return {"COLUMNS": str(columns), "PYTHONIOENCODING": encoding}


def run(*words: str, columns: int = 100, encoding: str = "utf-8", folder: Path | None = None) -> CompletedProcess[str]:
    """What `ballsocket WORDS` returns and prints, without the second that a process takes to start."""
    out, err = (TextIOWrapper(BytesIO(), encoding=encoding, write_through=True) for _ in range(2))
    with (
        chdir(folder or Path()),
        mock.patch.dict(os.environ, environment(columns, encoding)),
        mock.patch.object(sys, "argv", ["ballsocket", *words]),
        redirect_stdout(out),
        redirect_stderr(err),
    ):
        status = _status()
    said, complained = (stream.buffer.getvalue().decode() for stream in (out, err))
    return CompletedProcess(words, status, said, complained)


def _status() -> int:
    try:
        main()
    except SystemExit as ended:
        return int(ended.code or 0)
    return 0


def run_process(
    *words: str, columns: int = 100, encoding: str = "utf-8", folder: Path | None = None
) -> CompletedProcess[str]:
    """The same by `python -m ballsocket WORDS`."""
    return started(
        [sys.executable, "-m", "ballsocket", *words],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        timeout=600,
        check=False,
        env={**os.environ, **environment(columns, encoding)},
    )
